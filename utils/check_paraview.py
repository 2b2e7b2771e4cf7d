#!/usr/bin/python3
"""Reads snapshots as ParaView does, with VTK's own reader, and as h5py does, and compares.

usage: check_paraview.py [--particles N] SNAPSHOT.vtkhdf... [outlines.xdmf]

Needs python3-vtk9 and python3-h5py; of outlines.xdmf it looks whether what it names is there
(Debian's VTK has no reader of XDMF). Exit status 0 when every file is as docs/files.md says,
1 with one line for each thing that is not.
"""
import argparse
import os
import sys
from xml.etree import ElementTree

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkIOHDF import vtkHDFReader

ROOT_TEXTS = ("title", "software", "version", "git_id", "input")
ROOT_NUMBERS = ("time", "step", "reference_length", "spacing", "sound_speed", "density", "gravity")
VERTEX = 1  # VTK's number of the cell that is one point


def read_with_vtk(path):
    """The grid VTK makes of the file, and the errors it reported."""
    errors = []
    reader = vtkHDFReader()
    reader.AddObserver(vtkCommand.ErrorEvent, lambda caller, event: errors.append(event))
    if not reader.CanReadFile(path):
        return None, ["VTK does not recognise the file"]
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutputDataObject(0), errors


def vtk_arrays(data):
    """Arrays of a vtkFieldData by name."""
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def check_attributes(file, found):
    """The root group names the run."""
    for name in ROOT_TEXTS:
        if not isinstance(file.attrs.get(name), str):
            found.append(f"root attribute '{name}' is not a text")
    for name in ROOT_NUMBERS:
        if name not in file.attrs or not numpy.isfinite(file.attrs[name]):
            found.append(f"root attribute '{name}' is not a finite number")


def check_arrays(file, grid, found):
    """VTK and h5py see the same points and arrays; each array says what it is."""
    group = file["VTKHDF"]
    points = group["Points"][:]
    if not numpy.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), points):
        found.append("VTK and h5py read different points")
    if not numpy.isfinite(points).all() or points[:, 2].any():
        found.append("points are not finite, or not in the plane z = 0")
    seen = vtk_arrays(grid.GetPointData())
    if set(seen) != set(group["PointData"]):
        found.append(f"VTK sees {sorted(seen)}, the file has {sorted(group['PointData'])}")
    for name, dataset in group["PointData"].items():
        if not numpy.array_equal(seen.get(name), dataset[:]):
            found.append(f"VTK and h5py read different '{name}'")
        if len(dataset) != len(points):
            found.append(f"'{name}' has {len(dataset)} values for {len(points)} points")
        if not numpy.isfinite(dataset[:]).all():
            found.append(f"'{name}' is not finite everywhere")
    for dataset in [group["Points"], *group["PointData"].values()]:
        if not dataset.attrs.get("units") or not dataset.attrs.get("long_name"):
            found.append(f"'{dataset.name}' has no units or no long name")
    identity = group["PointData"]["id"][:] if "id" in group["PointData"] else []
    if len(numpy.unique(identity)) != len(points):
        found.append("'id' does not number the particles")


def check(path, particles):
    """Everything that is wrong with one snapshot."""
    grid, found = read_with_vtk(path)
    if grid is None:
        return found
    with h5py.File(path, "r") as file:
        number = len(file["VTKHDF/Points"])
        if particles is not None and number != particles:
            found.append(f"{number} particles, {particles} expected")
        if grid.GetNumberOfPoints() != number or grid.GetNumberOfCells() != number:
            found.append(f"VTK sees {grid.GetNumberOfPoints()} points in {grid.GetNumberOfCells()} cells, not {number}")
            return found
        if number and set(vtk_to_numpy(grid.GetCellTypesArray())) != {VERTEX}:
            found.append("not every cell is a vertex")
        check_attributes(file, found)
        check_arrays(file, grid, found)
        time = vtk_arrays(grid.GetFieldData()).get("TimeValue")
        if time is None or time[0] != file.attrs.get("time"):
            found.append("VTK does not see the time")
        if not found:
            names = ", ".join(f"{d.name.split('/')[-1]} [{d.attrs['units']}]" for d in file["VTKHDF/PointData"].values())
            print(f"{path}: {number} particles at time {time[0]:g}: {names}")
    return found


def check_outlines(path):
    """Everything that is wrong with the outlines of solids that an XDMF file leads to."""
    found = []
    collection = ElementTree.parse(path).getroot().find("Domain/Grid")
    for moment in collection:
        time = float(moment.find("Time").get("Value"))
        for solid in moment.findall("Grid"):
            arrays = []
            for item in solid.iter("DataItem"):
                name, dataset = item.text.split(":")
                with h5py.File(os.path.join(os.path.dirname(path), name), "r") as file:
                    arrays.append(file[dataset][:])
                    if file.attrs["time"] != time:
                        found.append(f"{name} is of another time than {time:g}")
                if arrays[-1].size != numpy.prod([int(n) for n in item.get("Dimensions").split()]):
                    found.append(f"{name}{dataset} has another extent")
            order, points = arrays
            if not (numpy.array_equal(order, range(len(points))) and numpy.array_equal(points[0], points[-1])):
                found.append(f"the outline of {solid.get('Name')} at time {time:g} is not closed")
    if not found:
        print(f"{path}: {len(moment.findall('Grid'))} solids at {len(collection)} times")
    return found


def main():
    """Checks the snapshots named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--particles", type=int, help="number every snapshot must have")
    parser.add_argument("snapshots", nargs="+")
    options = parser.parse_args()
    wrong = 0
    for path in options.snapshots:
        try:
            found = check_outlines(path) if path.endswith(".xdmf") else check(path, options.particles)
        except (OSError, KeyError) as error:
            found = [str(error)]
        for line in found:
            print(f"{path}: {line}", file=sys.stderr)
        wrong += bool(found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

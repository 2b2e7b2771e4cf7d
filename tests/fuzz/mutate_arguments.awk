# Writes mutants of command lines.
#
#    cat LISTS | LC_ALL=C awk -v seed=1 -v first=1 -v count=500 -v into=DIR -f random.awk -f mutate_arguments.awk
#
# LISTS is what dynsph --keys and the --help of each program print, with a line '== PROGRAM [COMMAND]' before each of the latter.
# Mutant number i is DIR/i.args: the program, then an argument on each line. They are for a directory with scene.nml and result/.

/^## &/ { listed_group = substr($2, 2) }
/^\| `/ {
   split($0, cell, "|")
   gsub(/[ `]/, "", cell[2])
   key[++keys] = listed_group "." cell[2]
}
/^== / { program = $2; if (NF > 2) program = program "\n" $3 }
/^ +--[a-z]/ {
   option[program, ++options[program]] = $1
   if ($2 ~ /^[A-Z]|=/ && $2 !~ /^[A-Z][a-z]/) takes_value[program, $1] = 1
}

END {
   list_odd_values()
   places = split("scene.nml|result|result/|result/snapshot_000000.vtkhdf|result/snapshot_000001.vtkhdf|result/probes.dat|" \
      "result/energy.dat|result/checkpoint_a.h5|result/input_used.nml|nowhere|nowhere.nml|.|..|scene.nml/below|new|new/deeper| |" \
      "\303\244\342\202\254|\377|-|--|---|--=|=|-h|--help|*|%s%n|$HOME|'|new.txt|P1|P2|1|0.5", place, "|")
   base[++bases] = "dynsph\n--check\nscene.nml"
   base[++bases] = "dynsph\n--shortest\n--set\ntime.cfl=1\nscene.nml"
   base[++bases] = "dynsph\n--quiet\n--output\nnew\nscene.nml"
   base[++bases] = "dynsph\n--overwrite\n--quiet\n--output=result\nscene.nml"
   base[++bases] = "dynsph\n--quiet\n--resume\nresult\n--set\ntime.max_steps=10"
   base[++bases] = "dynsph\n--quiet\n--resume=result\n--fork\nnew\n--set\nmodel.alpha=0.02\n--set=time.max_steps=10"
   base[++bases] = "dynsph\n--template"
   base[++bases] = "dynsph\n--keys"
   base[++bases] = "dynsph\n--version"
   base[++bases] = "dynsph-snapshot-to-text\nresult/snapshot_000001.vtkhdf\nnew.txt"
   base[++bases] = "dynsph-spectra\nvorticity\nresult/snapshot_000001.vtkhdf"
   base[++bases] = "dynsph-spectra\nvorticity\n--field\n--window=none\nresult/snapshot_000001.vtkhdf\nresult/snapshot_000000.vtkhdf"
   base[++bases] = "dynsph-spectra\nprobe\nresult/probes.dat"
   base[++bases] = "dynsph-spectra\nprobe\n--probe\nP2\n--output\nnew.txt\nresult/probes.dat"
   for (i = first; i < first + count; i++) {
      begin_random(seed, i)
      line = one_of(base, bases)
      n = split(line, argument, "\n")
      program = argument[1]
      if (program == "dynsph-spectra") program = program "\n" argument[2]
      for (k = 1 + random(3); k > 0; k--) mutate()
      bound()
      path = into "/" i ".args"
      printf "" > path
      for (k = 1; k <= n; k++) print argument[k] > path
      close(path)
   }
}

# Changes argument[2] to argument[n]; the first is the program.
function mutate(kind, at, chosen) {
   kind = random(11)
   at = 2 + random(n)
   if (kind == 0 && n > 1) take_out(2 + random(n - 1))
   else if (kind == 1 && n > 1) put_in(at, argument[2 + random(n - 1)])
   else if (kind == 2 && n > 1) argument[2 + random(n - 1)] = one_of(place, places)
   else if (kind == 3) put_in(at, one_of(place, places))
   else if (kind == 4 && n > 1) argument[2 + random(n - 1)] = repeated("x", 1 + random(100000))
   else if (kind == 5 && n > 1) argument[2 + random(n - 1)] = with_typing_error(argument[2 + random(n - 1)])
   else if (kind <= 8) {
      if (!(program in options)) program = "dynsph"
      chosen = option[program, 1 + random(options[program])]
      if (chosen == "--set") put_in(at, setting())
      else if ((program, chosen) in takes_value && random(5)) put_in(at, odd_value())
      if (random(3) == 0 && chosen != argument[at] && at <= n) argument[at] = chosen "=" argument[at]
      else put_in(at, chosen)
   } else if (kind == 9) put_in(at, "--set=" setting())
   else put_in(at, one_of(odd_number, odd_numbers))
}

function put_in(at, new, k) {
   for (k = n; k >= at; k--) argument[k + 1] = argument[k]
   argument[at] = new
   n++
}

function take_out(at, k) {
   for (k = at; k < n; k++) argument[k] = argument[k + 1]
   n--
}

function with_typing_error(chosen, at) {
   at = 1 + random(length(chosen))
   return substr(chosen, 1, at - 1) (random(2) ? "q" : "") substr(chosen, at + 1)
}

function odd_value() {
   return random(2) ? one_of(odd_number, odd_numbers) : one_of(place, places)
}

function setting(chosen) {
   chosen = one_of(key, keys)
   if (random(8) == 0) sub(/\./, "(" one_of(odd_number, odd_numbers) ").", chosen)
   if (random(8) == 0) chosen = with_typing_error(chosen)
   return chosen (random(12) ? "=" : " ") (random(3) ? one_of(odd_number, odd_numbers) : one_of(odd_word, odd_words))
}

# A scene with other values may be a large one: it is looked at only. Runs that go on have few steps left.
function bound(k, sets) {
   if (argument[1] != "dynsph") return
   for (k = 2; k <= n; k++) {
      if (argument[k] ~ /--set/) sets = 1
      if (argument[k] ~ /--resume/) return
   }
   if (sets) put_in(n + 1, "--check")
}

# The runs of the paper's campaign: a line NAME SCENE KEY=VALUE... each, in the order in which they are wanted.
#
# Names: dam_MODEL_ma_MA_D/DX and patch_MODEL_D/DX; bar_... are the same with starts that differ by 1e-12, reading_... with other
# readings of what the paper leaves unsaid. MODEL: alpha_VALUE (delta = 0.1), dynamic (Re = 1e6), strain_rate (its ||D|| clipped).

# Resolutions of a tier: three of dam breaks, that of the patch, and of single questions for both; how many starts, and which alphas
# questions of the patch are asked for.
case $tier in
smoke) coarse=12 middle=16 fine=24 patch=6 question=12 patch_question=5 starts=1 patch_alphas='0 0.01' ;;
quick) coarse=30 middle=40 fine=50 patch=20 question=25 patch_question=10 starts=3 patch_alphas='0 0.01 0.03' ;;
*) coarse=50 middle=100 fine=200 patch=50 question=50 patch_question=25 starts=4 patch_alphas='0 0.01 0.03' ;;
esac

model_settings() {
   case $1 in
   alpha_*) echo "model.diffusion=constant model.delta=0.1 model.alpha=${1#alpha_}" ;;
   dynamic) echo 'model.diffusion=dynamic fluid.reynolds=1e6' ;;
   strain_rate) echo 'model.diffusion=dynamic model.limiter=strain_rate fluid.reynolds=1e6' ;;
   esac
}
# Pictures and spectra need snapshots: fewer of the largest run.
snapshots() { # MODEL D/DX
   local fields=velocity,pressure,vorticity every=1
   case $1 in alpha_*) ;; *) fields+=,alpha,delta ;; esac
   if [ "$2" -gt 800 ]; then every=5; fi
   echo "'output.snapshots=$every time' output.fields=$fields"
}
dam() { # MODEL MA D/DX [KEY=VALUE...]
   echo "dam_$1_ma_$2_$3 dam_break scene.resolution=$3 fluid.mach=$2 $(model_settings "$1") $(snapshots "$1" "$3") ${*:4}"
}
# Viscosity is alpha h c0/8: at another d/dx than the paper's 100 alpha is changed so that this stays; delta is not. MODEL has the
# paper's alpha.
patch() { # MODEL D/DX [SCENE NAME KEY=VALUE...]
   local alpha
   alpha=$(awk -v a="${1#alpha_}" -v n="$2" 'BEGIN { print a*n/100 }')
   echo "${4:-patch}_$1_$2 ${3:-water_patch} scene.resolution=$2 model.diffusion=constant model.delta=0.1 model.alpha=$alpha" \
      "'output.snapshots=5 time' ${*:5}"
}
# Starts that differ by less than round-off does after some steps; 0 is the unchanged one. Pressures are compared at Ma 0.1.
bars() { # MODEL MA D/DX
   local k probes=
   [ "$2" = 0.1 ] || probes=output.probes=never
   for ((k = 0; k <= starts; k++)); do
      echo "bar_$1_ma_$2_$3_$k dam_break scene.resolution=$3 fluid.mach=$2 $(model_settings "$1") body(1).velocity=${k}e-12,0" \
         output.snapshots=never $probes
   done
}
# reading | what is read otherwise
readings() {
   cat <<'TABLE'
zero_pressure | body(1).pressure=zero
hydrostatic_pressure | body(1).pressure=hydrostatic
mirror_images | domain.images=mirror
strain_rate | model.limiter=strain_rate
no_viscosity | fluid.reynolds=0
cfl_0.75 | time.cfl=0.75
every_stage | time.diffusion=every_stage
h_1.5 | model.smoothing_ratio=1.5
closed_top | domain.top=free_slip
TABLE
}
reading_runs() {
   local name settings model mach
   while IFS='|' read -r name settings; do
      for model in alpha_0.01 dynamic; do
         case $model$name in alpha_*strain_rate* | alpha_*no_viscosity*) continue ;; esac
         for mach in 0.1 0.05; do
            echo "reading_${model}_ma_${mach}_${name% }_$question dam_break scene.resolution=$question fluid.mach=$mach $(model_settings $model) $settings" \
               output.snapshots=never output.probes=never
         done
      done
   done < <(readings)
}
# reading | scene | what is read otherwise
patch_readings() {
   cat <<'TABLE'
as_it_is | water_patch |
2_d_wide | water_patch_wide |
3_d_wide | water_patch | body(2).lower=3.5,1 body(2).upper=6.5,2
4_d_wide | water_patch | body(2).lower=3,1 body(2).upper=7,2
at_the_wall | water_patch | body(2).lower=0,1 body(2).upper=1,2
hydrostatic_patch | water_patch | body(2).pressure=hydrostatic
mirror_images | water_patch | domain.images=mirror
cfl_0.75 | water_patch | time.cfl=0.75
every_stage | water_patch | time.diffusion=every_stage
h_1.5 | water_patch | model.smoothing_ratio=1.5
TABLE
}
patch_reading_runs() {
   local name scene settings alpha
   while IFS='|' read -r name scene settings; do
      for alpha in $patch_alphas; do patch alpha_$alpha $patch_question $scene patchreading_${name% } $settings; done
   done < <(patch_readings)
}

alphas='0 0.005 0.01 0.02 0.03'
campaign() {
   local alpha size model
   if [ "$tier" = full ]; then
      dam dynamic 0.1 400              # L3, L4
      patch alpha_0.01 100             # W1, W2
      dam alpha_0.01 0.1 400           # D4, A1
      patch alpha_0 100                # W3
      patch alpha_0.03 100
      dam dynamic 0.05 480             # L1, L2
      for alpha in 0.01 0 0.005 0.03 0.02; do dam alpha_$alpha 0.05 480; done   # D1 to D3
      patch alpha_0.02 100
      for model in alpha_0.01 dynamic alpha_0; do dam $model 0.1 800; done      # A1, D4, L4
      dam dynamic 0.1 1600
      return
   fi
   # The longest first, so that all cores are busy to the end.
   dam dynamic 0.05 $fine                                            # L1, L2
   for model in dynamic alpha_0.01 alpha_0; do dam $model 0.1 $fine; done   # L3, L4, D4, A1
   for alpha in 0.03 0 0.01; do patch alpha_$alpha $patch; done      # W1 to W3
   patch alpha_0.01 $patch water_patch_wide patchwide
   for alpha in $alphas; do                                          # D1 to D3
      dam alpha_$alpha 0.05 $middle "$([ $alpha != 0.01 ] || echo output.fields=velocity,pressure,vorticity,dissipation)"
   done
   dam dynamic 0.05 $middle
   dam strain_rate 0.05 $middle
   for size in $middle $coarse; do
      for model in dynamic alpha_0.01 alpha_0; do dam $model 0.1 $size; done
   done
   for model in $(printf 'alpha_%s ' $alphas) dynamic; do bars "$model" 0.05 $question; done
   for model in alpha_0 alpha_0.01 dynamic; do bars "$model" 0.1 $question; done
   for model in alpha_0.01 dynamic; do bars "$model" 0.1 $middle; done   # A1, D4, L4
   reading_runs
   patch_reading_runs
}

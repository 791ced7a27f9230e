# One function for each command: what it needs, then what it runs.

# quote WORD: the word, so quoted that eval reads it back as it was.
quote() {
  printf "'%s' " "$(printf '%s' "$1" | sed "s/'/'\\\\''/g")"
}

# take_blender_option ARGUMENT...: sets MESOGRAIN_BLENDER and, in $remaining, the other arguments, quoted for eval.
take_blender_option() {
  remaining=
  while [ $# -gt 0 ]; do
    case $1 in
      --blender)
        [ $# -gt 1 ] || fail "$exit_usage" "--blender needs the path of Blender's executable."
        MESOGRAIN_BLENDER=$2
        shift
        ;;
      --blender=*) MESOGRAIN_BLENDER=${1#--blender=} ;;
      *) remaining="$remaining$(quote "$1")" ;;
    esac
    shift
  done
}

# in_background_blender COMMAND ROOM ARGUMENT...: a command of the add-on that takes a scene, by default the sphere.
in_background_blender() {
  name=$1
  room=$2
  shift 2
  take_blender_option "$@"
  eval "set -- $remaining"
  scene=
  arguments=
  while [ $# -gt 0 ]; do
    case $1 in
      *.blend)
        [ -z "$scene" ] || fail "$exit_usage" "$name takes one scene; it was given '$scene' and '$1'."
        scene=$1
        ;;
      *) arguments="$arguments$(quote "$1")" ;;
    esac
    shift
  done
  eval "set -- $arguments"
  case ${1:--} in
    -*) ;;
    *) fail "$exit_usage" "$name takes a .blend file; '$1' is none." ;;
  esac
  scene=${scene:-$source_folder/blend_files/sphere.blend}
  [ -f "$scene" ] || fail "$exit_usage" "There is no scene '$scene'."
  ensure_blender
  ensure_lists report
  ensure_product product
  ensure_referee "$@"
  mkdir -p "$logs"
  exec /usr/bin/python3 "$source_folder/.launcher/run_blender.py" "$logs/$name.log" "$blender" --background \
    --factory-startup --python-exit-code 1 --python "$source_folder/addon/mesograin/$room/command.py" -- \
    "$scene" "$@"
}

run_compare() {
  in_background_blender compare comparison "$@"
}

run_trade() {
  in_background_blender trade trade "$@"
}

run_sweep() {
  take_blender_option "$@"
  eval "set -- $remaining"
  [ $# -gt 0 ] || fail "$exit_usage" "sweep needs a file and a folder: ./mesograin sweep FILE.toml --out DIR"
  ensure_blender
  ensure_lists report
  ensure_product product
  ensure_referee "$(grep -hosw -e photon -- "$@" | head -n 1)"
  exec "$python" "$source_folder/addon/mesograin/sweep/command.py" "$@" --blender "$blender"
}

run_render() {
  take_blender_option "$@"
  eval "set -- $remaining"
  [ $# -gt 0 ] || fail "$exit_usage" "render needs a scene and an output: ./mesograin render SCENE.json -o OUT.exr"
  # The renderer itself needs no Blender, so none is installed for it; one that is there decides the module's Python.
  if [ -n "${MESOGRAIN_BLENDER:-}" ] || command -v blender >/dev/null; then
    ensure_blender
  else
    ensure_lists build
    python_version=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  fi
  ensure_product product
  exec "$build/native/tool/mesograin-render" "$@"
}

run_bake() {
  take_blender_option "$@"
  eval "set -- $remaining"
  case ${1:-} in
    *.json)
      run_render "$@" --bake
      ;;
    *.blend) ;;
    *) fail "$exit_usage" "bake needs a scene and an output: ./mesograin bake SCENE.blend -o OUT.exr" ;;
  esac
  [ -f "$1" ] || fail "$exit_usage" "There is no scene '$1'."
  ensure_blender
  ensure_product product
  ensure_referee "$@"
  mkdir -p "$logs"
  exec /usr/bin/python3 "$source_folder/.launcher/run_blender.py" "$logs/bake.log" "$blender" --background \
    --factory-startup --python-exit-code 1 --python "$source_folder/addon/mesograin/baking/command.py" -- "$@"
}

run_test() {
  take_blender_option "$@"
  eval "set -- $remaining"
  parts=
  blender_4=no
  while [ $# -gt 0 ]; do
    case $1 in
      lint | physics | native | python | blender | window) parts="$parts $1" ;;
      --blender-4) blender_4=yes ;;
      *) fail "$exit_usage" "There is no test part or option '$1'; the parts are lint, physics, native, python, blender and window." ;;
    esac
    shift
  done
  parts=${parts:- lint physics native python blender window}
  ensure_blender
  ensure_lists test
  case $parts in
    *lint* | *physics* | *native*) ensure_product all ;;
    *) ensure_product product ;;
  esac
  case $parts in
    *native*)
      ensure_built sanitize "$source_folder/build/sanitize" tests/native/all "the native tests with sanitizers"
      ;;
  esac
  case $parts in
    *lint*) ensure_lists lint ;;
  esac
  set -- "$source_folder/.launcher/run_tests.py" --build "$build" --python "$python" --blender "$blender" \
    --blender-version "$blender_version" --results "$build/test-results"
  if [ "$blender_4" = yes ]; then
    ensure_debian_13
    test_in_debian_13 "$parts"
    set -- "$@" --also "$debian_13_summary"
  fi
  # shellcheck disable=SC2086 # the parts are separate words
  exec /usr/bin/python3 "$@" $parts
}

run_build() {
  take_blender_option "$@"
  [ -z "$remaining" ] || fail "$exit_usage" "build takes no argument but --blender PATH."
  ensure_blender
  ensure_product product
}

run_bench() {
  take_blender_option "$@"
  eval "set -- $remaining"
  benchmark=${1:-frame}
  case $benchmark in
    frame | accuracy | false_alarms) ;;
    *) fail "$exit_usage" "There is no benchmark '$benchmark'; there are frame, accuracy and false_alarms." ;;
  esac
  [ $# -eq 0 ] || shift
  ensure_blender
  ensure_lists report
  ensure_product product
  [ "$benchmark" = false_alarms ] || exec "$python" "$source_folder/tests/bench/$benchmark.py" "$build" "$@"
  mkdir -p "$logs"
  exec /usr/bin/python3 "$source_folder/.launcher/run_blender.py" "$logs/bench.log" "$blender" --background \
    --factory-startup --python-exit-code 1 --python "$source_folder/tests/bench/false_alarms.py" -- "$@"
}

run_package() {
  take_blender_option "$@"
  eval "set -- $remaining"
  zip=
  blender_4=no
  while [ $# -gt 0 ]; do
    case $1 in
      --blender-4) blender_4=yes ;;
      -o)
        [ $# -gt 1 ] || fail "$exit_usage" "-o needs the path of the zip."
        zip=$2
        shift
        ;;
      *) fail "$exit_usage" "package knows no '$1'." ;;
    esac
    shift
  done
  ensure_blender
  ensure_product product
  [ "$blender_4" = no ] || build_in_debian_13
  exec "$python" "$source_folder/.launcher/package.py" "$source_folder" ${zip:+"$zip"}
}

run_install() {
  take_blender_option "$@"
  eval "set -- $remaining"
  case ${1:-} in
    '') ;;
    --remove)
      ensure_blender
      exec /usr/bin/python3 "$source_folder/.launcher/run_blender.py" "$logs/install.log" "$blender" --background \
        --python-exit-code 1 --python "$source_folder/.launcher/install_addon.py" -- --remove
      ;;
    *) fail "$exit_usage" "install knows no '$1'." ;;
  esac
  ensure_blender
  ensure_product product
  zip=$source_folder/build/package/mesograin.zip
  "$python" "$source_folder/.launcher/package.py" "$source_folder" "$zip" >/dev/null
  exec /usr/bin/python3 "$source_folder/.launcher/run_blender.py" "$logs/install.log" "$blender" --background \
    --python-exit-code 1 --python "$source_folder/.launcher/install_addon.py" -- "$zip"
}

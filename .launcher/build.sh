# Builds the native module with CMake, Ninja and ccache; silent when there is nothing to do.

# Sets $python: the interpreter, outside Blender, of the version that Blender embeds, with its headers.
ensure_python() {
  if [ -n "${MESOGRAIN_PYTHON:-}" ]; then
    python=$MESOGRAIN_PYTHON
    return
  fi
  if [ ! -x "/usr/bin/python$python_version" ] || [ ! -f "/usr/include/python$python_version/Python.h" ]; then
    if ! apt-cache show "python$python_version-dev" >/dev/null 2>&1; then
      as_root apt-get update >/dev/null 2>&1 || :
      apt-cache show "python$python_version-dev" >/dev/null 2>&1 ||
        fail "$exit_prerequisite" "$blender embeds Python $python_version, and this Debian has no python$python_version-dev:" \
          "take Debian's Blender, or name a Python $python_version that has its headers in MESOGRAIN_PYTHON."
    fi
    ensure_packages "python$python_version-dev"
  fi
  python=/usr/bin/python$python_version
}

configure() {
  cmake -S "$source_folder" -B "$2" --preset "$1" -DPython3_EXECUTABLE="$python" -DPython_EXECUTABLE="$python" \
    -DPYTHON_EXECUTABLE="$python"
}

compile() {
  NINJA_STATUS='[%f/%t] ' ninja -C "$1" "$2"
}

# ensure_built PRESET FOLDER TARGET TITLE
ensure_built() {
  if [ ! -f "$2/build.ninja" ] || [ "$(cat "$2/.python" 2>/dev/null)" != "$python" ]; then
    step "Configuring $4" "configure-$1" configure "$1" "$2" || {
      rm -f "$2/build.ninja"
      step_failed "$exit_failure" "CMake could not configure $4."
    }
    printf '%s' "$python" >"$2/.python"
  fi
  step "Building $4" "build-$1" compile "$2" "$3" || step_failed "$exit_failure" "Building $4 failed."
}

# Packages, Python and the release build: what every command but help starts with. $1: the Ninja target.
ensure_product() {
  ensure_lists build
  ensure_python
  ensure_built release "$build" "$1" "the native module"
}

# The photon renderer, which one kind of reference is rendered by.
ensure_referee() {
  ensure_built release "$build" mesograin-referee "the photon renderer"
  MESOGRAIN_REFEREE=${MESOGRAIN_REFEREE:-$build/tests/referee/mesograin-referee}
  export MESOGRAIN_REFEREE
}

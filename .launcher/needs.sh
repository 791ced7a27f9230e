# What main.py finds a command to need, made sure of.

# ensure_needs FILE: each line is a need and what it is about.
# shellcheck disable=SC2086 # the lists are separate words
ensure_needs() {
  while read -r need about <&3; do
    case $need in
      blender_path) MESOGRAIN_BLENDER=$about ;;
      blender) ensure_blender ;;
      any_python) ensure_any_python ;;
      lists) ensure_lists $about ;;
      product) ensure_product "$about" ;;
      portable) ensure_portable ;;
      referee) ensure_referee ;;
      sanitized) ensure_built sanitize "$source_folder/build/sanitize" "$about" "the native tests with sanitizers" ;;
      root_build) build_in_root $about ;;
      root_test) test_in_root $about ;;
      *) fail "$exit_failure" "The launcher knows no need '$need'." ;;
    esac
  done 3<"$1"
}

# The renderer needs no Blender, so none is installed for it; one that is there decides the module's Python.
ensure_any_python() {
  if [ -n "${MESOGRAIN_BLENDER:-}" ] || command -v blender >/dev/null; then
    ensure_blender
  else
    ensure_lists build
    python_version=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  fi
}

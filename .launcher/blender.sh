# Finds Blender and asks it which Python it embeds, since the native module must be built for that one.

# Sets $blender: --blender, then MESOGRAIN_BLENDER, then Debian's (installed where it is missing).
ensure_blender() {
  if [ -z "${MESOGRAIN_BLENDER:-}" ]; then
    ensure_lists blender
    MESOGRAIN_BLENDER=$(command -v blender) ||
      fail "$exit_prerequisite" "Blender is needed and there is no blender on the PATH; install it or give --blender PATH."
  fi
  blender=$(command -v "$MESOGRAIN_BLENDER") ||
    fail "$exit_prerequisite" "There is no Blender at '$MESOGRAIN_BLENDER'; give the path of Blender's executable."
  blender=$(readlink -f "$blender")
  export MESOGRAIN_BLENDER="$blender"
  ask_blender
}

# Sets $blender_version, $python_version (3.11) and $module_suffix (.cpython-311-x86_64-linux-gnu.so).
# The answer is kept for as long as the executable stays the same.
ask_blender() {
  answer=$cache/blender/$(printf '%s' "$blender $(stat -c '%Y %s' "$blender")" | cksum | tr ' ' '-').txt
  if [ ! -s "$answer" ]; then
    mkdir -p "$cache/blender"
    "$blender" --background --factory-startup --python-exit-code 1 --python "$source_folder/.launcher/say_python.py" \
      </dev/null 2>/dev/null | sed -n 's/^embedded_python //p' >"$answer.partial"
    [ -s "$answer.partial" ] ||
      fail "$exit_prerequisite" "'$blender' did not say which Python it embeds; is it a Blender that starts?"
    mv "$answer.partial" "$answer"
  fi
  read -r blender_version python_version module_suffix <"$answer"
}

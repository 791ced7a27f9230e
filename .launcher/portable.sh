# Makes what a zip for many machines holds beside the add-on: modules for each Python, and the libraries that they need.

portable_inputs=$source_folder/build/portable

# Who has the headers of which Python; pybind11 is the newest one's, which knows them all.
portable_pythons='3.11 bookworm
3.13 trixie
3.14 sid'

# portable_apt TOOL ARGUMENT...: apt with lists of its own. A mirror of sid that is a few days old calls itself out of date.
portable_apt() {
  tool=$1
  shift
  "$tool" -o Dir::Etc::SourceList="$portable_inputs/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null \
    -o Dir::State::Lists="$portable_inputs/apt/lists" -o Dir::Cache="$portable_inputs/apt/cache" \
    -o Acquire::Check-Valid-Until=false -o APT::Sandbox::User= "$@"
}

# unpack_headers PACKAGE/SUITE FOLDER: usr/include of a package.
unpack_headers() {
  rm -rf "$portable_inputs/apt/unpacked" && mkdir -p "$portable_inputs/apt/unpacked" "$2"
  (cd "$portable_inputs/apt/unpacked" && portable_apt apt-get download "$1") || return 1
  dpkg-deb --extract "$portable_inputs/apt/unpacked/"*.deb "$portable_inputs/apt/unpacked" &&
    cp -r "$portable_inputs/apt/unpacked/usr/include" "$2/"
}

fetch_headers() {
  rm -rf "$portable_inputs"
  mkdir -p "$portable_inputs/apt/lists/partial" "$portable_inputs/apt/cache/archives/partial"
  for suite in bookworm trixie sid; do
    printf 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] %s %s main\n' "$debian_mirror" "$suite"
  done >"$portable_inputs/apt/sources.list"
  portable_apt apt-get update && unpack_headers pybind11-dev/sid "$portable_inputs/libraries" || return 1
  while read -r version suite; do
    # The machine's own is made by every build.
    [ "$version" = "$python_version" ] ||
      unpack_headers "libpython$version-dev/$suite" "$portable_inputs/pythons/$version" || return 1
  done <<END
$portable_pythons
END
  rm -rf "$portable_inputs/apt"
}

ensure_portable() {
  [ "$(uname -m)" = x86_64 ] || fail "$exit_prerequisite" "A zip for many machines is made on x86-64 only; this is $(uname -m)."
  ensure_lists portable
  if [ ! -e "$portable_inputs/fetched" ]; then
    step "Fetching the headers of other Pythons" portable-headers fetch_headers ||
      step_failed "$exit_prerequisite" "The headers of other Pythons could not be fetched from $debian_mirror."
    touch "$portable_inputs/fetched"
  fi
  step "Configuring modules for other Pythons" portable-configure \
    cmake -S "$source_folder" -B "$build" -DMESOGRAIN_PORTABLE="$portable_inputs" ||
    step_failed "$exit_failure" "CMake could not configure the modules for other Pythons."
  step "Building modules for other Pythons" portable-build compile "$build" portable ||
    step_failed "$exit_failure" "Building the modules for other Pythons failed."
}

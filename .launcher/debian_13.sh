# A Debian 13 root in the cache folder: how Blender 4.3 and its Python 3.13 are built for and tested from another Debian.

debian_13_root=$cache/debian-13
debian_13_mirror=${MESOGRAIN_DEBIAN_MIRROR:-http://deb.debian.org/debian}

debian_13_packages() {
  package_names build blender report test
  printf 'python3-dev\n'
}

debootstrap_root() {
  as_root rm -rf "$1" && mkdir -p "$1" && as_root debootstrap --variant=minbase trixie "$1" "$debian_13_mirror" &&
    as_root touch "$1/.bootstrapped"
}

install_in_root() {
  root=$1
  shift
  as_root chroot "$root" env DEBIAN_FRONTEND=noninteractive sh -c \
    'dpkg --configure -a && apt-get update && apt-get install --yes --no-install-recommends "$@" && apt-get clean' sh "$@"
}

# Builds the root beside its final place and renames it when it is whole; a broken-off set-up goes on where it was.
ensure_debian_13() {
  # shellcheck disable=SC2046 # the names are separate words
  set -- $(debian_13_packages)
  wanted=$(printf '%s ' "$@")
  [ "$(cat "$debian_13_root/.packages" 2>/dev/null)" != "$wanted" ] || return 0
  ensure_lists debian_13
  may_become_root "A Debian 13 root" "$source_folder/mesograin test --blender-4"
  mkdir -p "$cache"
  root=$debian_13_root
  if [ ! -d "$root" ]; then
    root=$debian_13_root.partial
    [ -f "$root/.bootstrapped" ] || step "Setting up Debian 13" debian-13 debootstrap_root "$root" ||
      step_failed "$exit_prerequisite" "Debian 13 could not be set up from $debian_13_mirror."
  fi
  step "Installing Blender and $# packages in Debian 13" debian-13-packages install_in_root "$root" "$@" ||
    step_failed "$exit_prerequisite" "The packages could not be installed in Debian 13."
  printf '%s' "$wanted" | as_root tee "$root/.packages" >/dev/null
  [ "$root" = "$debian_13_root" ] || as_root mv "$root" "$debian_13_root"
}

# in_debian_13 ARGUMENT...: runs ./mesograin with these arguments in the root, as the calling user, on this very source
# folder, with a build folder of its own. The mounts live in a namespace of their own and end with the command.
in_debian_13() {
  # shellcheck disable=SC2016 # expanded by the inner shell
  as_root unshare --mount --propagation private sh -c '
    set -e
    root=$1 source=$2 user=$3
    shift 3
    mkdir -p "$root/mesograin"
    mount --bind "$source" "$root/mesograin"
    mount -t proc proc "$root/proc"
    mount --rbind /sys "$root/sys"
    mount --rbind /dev "$root/dev"
    mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
    mkdir -m 700 "$root/tmp/home"
    chown "$user" "$root/tmp/home"
    mkdir -m 1777 "$root/tmp/.X11-unix"
    exec chroot --userspec="$user" "$root" env -i PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin LANG=C.UTF-8 \
      HOME=/tmp/home CCACHE_DIR=/mesograin/build/debian-13/ccache MESOGRAIN_BUILD=/mesograin/build/debian-13 ${CI:+CI=$CI} \
      ${MESOGRAIN_GL_DEVICE:+MESOGRAIN_GL_DEVICE=$MESOGRAIN_GL_DEVICE} /mesograin/mesograin "$@"
  ' sh "$debian_13_root" "$source_folder" "$(id -u):$(id -g)" "$@"
}

build_in_debian_13() {
  ensure_debian_13
  step "Building the native module in Debian 13" debian-13-build in_debian_13 build ||
    step_failed "$exit_failure" "The native module did not build in Debian 13."
}

# test_in_debian_13 PARTS: runs those of the parts that need a Blender or its Python; failures are in $debian_13_summary.
test_in_debian_13() {
  debian_13_summary=$source_folder/build/debian-13/test-results/summary.json
  rm -f "$debian_13_summary"
  parts_inside=
  for part in python blender window; do
    case $1 in *"$part"*) parts_inside="$parts_inside $part" ;; esac
  done
  [ -n "$parts_inside" ] || fail "$exit_usage" "--blender-4 runs python, blender and window; none of these was asked for."
  # shellcheck disable=SC2086 # the parts are separate words
  step "Running$parts_inside in Debian 13" debian-13-test in_debian_13 test $parts_inside || [ -s "$debian_13_summary" ] ||
    step_failed "$exit_failure" "The tests did not run in Debian 13."
}

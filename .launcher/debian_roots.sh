# Roots of other Debians in the cache folder: how their Blenders and the Pythons in them are built for and tested from here.

debian_mirror=${MESOGRAIN_DEBIAN_MIRROR:-http://deb.debian.org/debian}

# choose_root NAME: all below is then about debian-13, which has Blender 4.3, or debian-sid, which has Blender 5.
choose_root() {
  root_name=$1
  root=$cache/$root_name
  case $root_name in
    debian-13) root_suite=trixie root_title="Debian 13" root_option=--blender-4 ;;
    debian-sid) root_suite=sid root_title="Debian sid" root_option=--blender-5 ;;
  esac
}

root_packages() {
  package_names build blender report test
  printf 'python3-dev\n'
  # What Blender 5's own extensions import, and Debian's package does not ask for.
  [ "$root_suite" != sid ] || printf 'python3-cattr\npython3-requests\n'
}

debootstrap_root() {
  as_root rm -rf "$1" && mkdir -p "$1" && as_root debootstrap --variant=minbase "$root_suite" "$1" "$debian_mirror" &&
    as_root touch "$1/.bootstrapped"
}

# install_in_root FOLDER NAME...: sid changes daily, so a mirror of it that is a few days old calls itself out of date.
install_in_root() {
  folder=$1
  shift
  as_root chroot "$folder" env DEBIAN_FRONTEND=noninteractive CHECK_DATE="$([ "$root_suite" = sid ] && echo no || echo yes)" sh -c \
    'dpkg --configure -a && apt-get -o Acquire::Check-Valid-Until="$CHECK_DATE" update &&
     apt-get install --yes --no-install-recommends "$@" && apt-get clean' sh "$@"
}

# Builds the root beside its final place and renames it when it is whole; a broken-off set-up goes on where it was.
ensure_root() {
  # shellcheck disable=SC2046 # the names are separate words
  set -- $(root_packages)
  wanted=$(printf '%s ' "$@")
  [ "$(cat "$root/.packages" 2>/dev/null)" != "$wanted" ] || return 0
  ensure_lists debian_roots
  may_become_root "A $root_title root" "$source_folder/mesograin test $root_option"
  mkdir -p "$cache"
  growing=$root
  if [ ! -d "$root" ]; then
    growing=$root.partial
    [ -f "$growing/.bootstrapped" ] || step "Setting up $root_title" "$root_name" debootstrap_root "$growing" ||
      step_failed "$exit_prerequisite" "$root_title could not be set up from $debian_mirror."
  fi
  step "Installing Blender and $# packages in $root_title" "$root_name-packages" install_in_root "$growing" "$@" ||
    step_failed "$exit_prerequisite" "The packages could not be installed in $root_title."
  printf '%s' "$wanted" | as_root tee "$growing/.packages" >/dev/null
  [ "$growing" = "$root" ] || as_root mv "$growing" "$root"
}

# in_root ARGUMENT...: runs ./mesograin with these arguments in the root, as the calling user, on this very source
# folder, with a build folder of its own. The mounts live in a namespace of their own and end with the command.
in_root() {
  # shellcheck disable=SC2016 # expanded by the inner shell
  as_root unshare --mount --propagation private sh -c '
    set -e
    root=$1 source=$2 user=$3 name=$4
    shift 4
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
      HOME=/tmp/home CCACHE_DIR="/mesograin/build/$name/ccache" MESOGRAIN_BUILD="/mesograin/build/$name" ${CI:+CI=$CI} \
      ${MESOGRAIN_GL_DEVICE:+MESOGRAIN_GL_DEVICE=$MESOGRAIN_GL_DEVICE} /mesograin/mesograin "$@"
  ' sh "$root" "$source_folder" "$(id -u):$(id -g)" "$root_name" "$@"
}

# build_in_root NAME: of choose_root.
build_in_root() {
  choose_root "$1"
  ensure_root
  step "Building the native module in $root_title" "$root_name-build" in_root build ||
    step_failed "$exit_failure" "The native module did not build in $root_title."
}

# test_in_root NAME PART...: runs them there; $root_summaries gets a line, the root's title = the file of what came of it.
test_in_root() {
  choose_root "$1"
  shift
  ensure_root
  summary=$source_folder/build/$root_name/test-results/summary.json
  rm -f "$summary"
  step "Running $* in $root_title" "$root_name-test" in_root test "$@" || [ -s "$summary" ] ||
    step_failed "$exit_failure" "The tests did not run in $root_title."
  root_summaries="${root_summaries:+$root_summaries
}$root_title=$summary"
}

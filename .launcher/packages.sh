# Makes sure of the Debian packages that a command needs.

# package_names LIST...: the names in .launcher/packages/LIST.txt.
package_names() {
  for list in "$@"; do
    sed '/^#/d;/^$/d' "$source_folder/.launcher/packages/$list.txt"
  done | sort -u
}

# missing_packages NAME...: those that are not installed.
missing_packages() {
  installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p')
  for name in "$@"; do
    printf '%s\n' "$installed" | grep -qx "$name" || printf '%s\n' "$name"
  done
}

install_packages() {
  set -- env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends -o DPkg::Lock::Timeout=600 "$@"
  # Package lists that are fresh enough spare the update; lists that are absent or stale show as a failed install.
  as_root "$@" || { as_root apt-get update && as_root "$@"; }
}

# ensure_packages NAME...: installs what is missing; says nothing when nothing is.
ensure_packages() {
  if ! command -v dpkg-query >/dev/null; then
    [ -n "${packages_note_given:-}" ] || printf 'This is not Debian: packages are not checked; .launcher/packages/*.txt names what is needed.\n' >&2
    packages_note_given=yes
    return
  fi
  missing=$(missing_packages "$@" | tr '\n' ' ')
  [ -n "$missing" ] || return 0
  may_become_root "Installing packages" "apt-get install --no-install-recommends $missing"
  # shellcheck disable=SC2086 # the names are separate words
  set -- $missing
  [ "$(id -u)" -eq 0 ] || sudo -v || fail "$exit_prerequisite" "sudo refused; as root, run: apt-get install --no-install-recommends $missing"
  what="$# Debian packages"
  [ $# -gt 3 ] || what=$*
  step "Installing $what" packages install_packages "$@" ||
    step_failed "$exit_prerequisite" "These packages could not be installed: $missing"
}

# ensure_lists LIST...: ensure_packages for all that is named in .launcher/packages/LIST.txt.
ensure_lists() {
  # shellcheck disable=SC2046 # the names are separate words
  ensure_packages $(package_names "$@")
}

# Sourced by packages.sh, debian.sh and aarch64.sh: a Debian with nothing but its base system, in a folder.

# The names that Debian gives its releases.
declare -A debian_suites=([12]=bookworm [13]=trixie)

suite_of_this_machine() { (. /etc/os-release && printf '%s\n' "${VERSION_CODENAME:-bookworm}"); }

# make_bare_debian SUITE FOLDER: makes it, from where this machine's apt has its packages; prints why it cannot.
make_bare_debian() {
  local suite=$1 folder=$2 mirror file log
  mirror=$(apt-get indextargets --format '$(RELEASE)|$(COMPONENT)|$(REPO_URI)' "Created-By: Packages" 2>/dev/null |
    sed -n "s/^$(suite_of_this_machine)|main|//p" | head -n 1)
  log=$(mktemp)
  if ((EUID != 0)); then
    echo "that needs root"
  elif ! has_debootstrap; then
    echo "debootstrap cannot be installed"
  elif [[ -z $mirror ]]; then
    echo "apt of this machine does not know where its packages are"
  elif ! debootstrap --variant=minbase "$suite" "$folder" "$mirror" >"$log" 2>&1; then
    echo "debootstrap fails: $(tail -n 1 "$log")"
  else
    # Ways to packages and keys are those of this machine; the lists of packages name the other release.
    cp -L /etc/resolv.conf /etc/hosts "$folder/etc/" 2>/dev/null || true
    cp -r /etc/apt/apt.conf.d /etc/apt/keyrings /etc/apt/trusted.gpg.d "$folder/etc/apt/" 2>/dev/null || true
    if [[ $suite == "$(suite_of_this_machine)" ]]; then
      rm -f "$folder/etc/apt/sources.list"
      cp -r /etc/apt/sources.list* "$folder/etc/apt/" 2>/dev/null || true
      cp -r /usr/share/keyrings "$folder/usr/share/" 2>/dev/null || true
    fi
  fi
  rm -f "$log"
}

# has_debootstrap: whether it is there, after installing it where it is not.
has_debootstrap() {
  command -v debootstrap >/dev/null && return
  local -a get=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -y)
  "${get[@]}" --no-install-recommends install debootstrap >/dev/null 2>&1 </dev/null ||
    { "${get[@]}" update && "${get[@]}" --no-install-recommends install debootstrap; } >/dev/null 2>&1 </dev/null
}

# inside COMMANDS: runs them in the Debian at $root, with /proc, /sys and /dev, which end with them. In a Debian that is
# itself in a folder, as ./check packages is of ./check debian, / is no mount point, and the mounts are hidden already.
inside() {
  local -a propagation=()
  awk '$5 == "/" { found = 1 } END { exit !found }' /proc/self/mountinfo || propagation=(--propagation unchanged)
  DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 unshare --mount "${propagation[@]}" bash -c '
    mount -t proc proc "$0/proc" && mount -t sysfs -o ro sysfs "$0/sys" && mount --rbind /dev "$0/dev" && exec chroot "$0" /bin/bash -euc "$1"' "$root" "$1"
}

# open_bare_debian SUITE: sets $root to a bare Debian, of the folder TRUESHADE_DEBIAN, which stays, or to one that goes with
# the script.
open_bare_debian() {
  if [[ -n ${TRUESHADE_DEBIAN:-} ]]; then
    root=$TRUESHADE_DEBIAN
  else
    work=$(mktemp -d)
    trap 'rm -rf --one-file-system "$work"' EXIT
    root=$work/root
  fi
  [[ -e $root/etc/debian_version ]] && return
  local why
  why=$(make_bare_debian "$1" "$root")
  [[ -z $why ]] || die "no bare Debian ($1) can be made here: $why"
}

# copy_tree: this checkout into /root/trueshade there.
copy_tree() { copy_checkout "$root/root/trueshade"; }

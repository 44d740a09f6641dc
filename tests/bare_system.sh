#!/usr/bin/env bash
# Proves the two commands of the README on a bare Debian 12: makes one in a temporary folder (debootstrap, minbase),
# clones the HEAD of this repository into it, and runs them there without any variable of this machine.
#
#   tests/bare_system.sh [quickstart|tests]     both without an argument
#
# Needs root, debootstrap, and about 6 GB in $TMPDIR (default /tmp). Packages come from the mirror that this
# machine's own apt uses for Debian 12; elsewhere name one: MIRROR=URL.
set -euo pipefail
release=bookworm
source=$(cd "$(dirname "$0")/.." && pwd)
case "${1:-all}" in
  quickstart) commands=(examples/quickstart.sh) ;;
  tests) commands=(tests/run.sh) ;;
  all) commands=(examples/quickstart.sh tests/run.sh) ;;
  *) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" >&2; exit 2 ;;
esac
[ "$(id -u)" -eq 0 ] || { echo "needs root, for debootstrap and chroot: sudo $0 $*" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "needs debootstrap: apt-get install debootstrap" >&2; exit 2; }

# Every archive of that release that apt knows here, as lines of a sources.list; the first is the mirror.
archives=$(apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
  awk -v release="$release" '($3 == release || index($3, release "-") == 1) && $4 == "main" && !seen[$0]++')
mirror=${MIRROR:-$(awk -v release="$release" '$3 == release {print $2; exit}' <<<"$archives")}
[ -n "$mirror" ] || { echo "apt knows no archive of $release here: MIRROR=URL $0" >&2; exit 2; }

root=$(mktemp -d "${TMPDIR:-/tmp}/bare-system.XXXXXX")
chmod 755 "$root"  # apt downloads as a user of its own
mounted=()
clean_up() {
  for ((i = ${#mounted[@]} - 1; i >= 0; i--)); do umount "${mounted[i]}" || umount -l "${mounted[i]}" || true; done
  rm -rf --one-file-system "$root"
}
trap clean_up EXIT
trap 'exit 130' INT TERM HUP

step() { printf '\n=== %s (%d s)\n' "$*" "$SECONDS"; }
step "Debian $release from $mirror"
include=()
[[ $mirror == https:* ]] && include=(--include=ca-certificates)
debootstrap --variant=minbase "${include[@]}" "$release" "$root" "$mirror" >"$root.log" 2>&1 ||
  { tail -20 "$root.log" >&2; rm -f "$root.log"; exit 1; }
rm -f "$root.log"

# How this machine reaches its archives: the archives, their keys, proxies, names.
[ -n "${MIRROR:-}" ] || printf '%s\n' "$archives" >"$root/etc/apt/sources.list"
cp -n /etc/apt/trusted.gpg.d/* "$root/etc/apt/trusted.gpg.d/" 2>/dev/null || true
apt-config dump | grep -E '^Acquire::(https?::|Check-|Retries)' >"$root/etc/apt/apt.conf.d/90host" || true
cp -L /etc/resolv.conf /etc/hosts "$root/etc/"

mount_in() { # mount_in TYPE FOLDER
  mkdir -p "$root$2"
  mount -t "$1" "$1" "$root$2"
  mounted+=("$root$2")
}
mount_in proc /proc
mount_in sysfs /sys
[ -c "$root/dev/null" ] || { echo "debootstrap made no devices: is $root on a file system mounted nodev?" >&2; exit 1; }
mount_in tmpfs /dev/shm
mount_in devpts /dev/pts

git clone --quiet --no-hardlinks "$source" "$root/root/eigengrain"
for command in "${commands[@]}"; do
  step "$command at $(git -C "$root/root/eigengrain" rev-parse --short HEAD)"
  # From another folder, as nobody promises that one stands in the right one.
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root chroot "$root" "/root/eigengrain/$command"
done
step "proven on a bare system: ${commands[*]}"

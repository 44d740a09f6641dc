#!/usr/bin/env bash
# Installs what Eigengrain needs on Debian 12, as root or through sudo: the packages of packages.txt, and of other such
# lists: dependencies.sh [LIST...]. Does nothing, and needs no rights, where all of them are there already.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mapfile -t packages < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$here/packages.txt" "$@")

missing=()
for package in "${packages[@]}"; do
  # npm may have come with another nodejs than Debian's, beside which Debian's npm cannot be installed.
  [ "$package" = npm ] && command -v npm >/dev/null && continue
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
[ "${#missing[@]}" -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install these packages first (no sudo here): ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null

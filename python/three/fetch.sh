#!/usr/bin/env bash
# Brings what eigengrain.page shows scenes with, three.js (MIT licence), from npm into a folder: fetch.sh FOLDER
# One version, held to its checksum; does nothing where it is there already.
set -euo pipefail
version=0.170.0
sha512=1502be2c4a587347c10fe27c83aa12132c8dce3a7e43b2acd42e7af1659aa0c44b5be4e434d5a67a759e1a0263575d3919dfa9ff6aa5d5972362f3623d9061b9
folder=$(realpath -m "$1")
[ "$(cat "$folder/VERSION" 2>/dev/null)" = "$version" ] && exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm pack --silent --prefer-offline --fetch-retries=1 --fetch-timeout=60000 "three@$version" >/dev/null
echo "$sha512  three-$version.tgz" | sha512sum --check --quiet
tar -xzf "three-$version.tgz" --strip-components=1 package/LICENSE package/build/three.module.min.js \
  package/examples/jsm/controls/OrbitControls.js
mkdir -p "$folder"
cp LICENSE build/three.module.min.js examples/jsm/controls/OrbitControls.js "$folder"
echo "$version" >"$folder/VERSION" # last: what is whole has it

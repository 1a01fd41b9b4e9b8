#!/usr/bin/env bash
# A tree of Debian's arm64 packages to build and link against: extracted only, nothing in it is run.
#   make_sysroot.sh DIRECTORY PACKAGE...
# Its package database is filled in, so that dpkg-shlibdeps finds which package a library is of.
set -euo pipefail
directory=$1
shift

if [[ $directory == --fill-database ]]; then  # called by mmdebstrap, while it still has the packages
  root=$1 database=$1/var/lib/dpkg
  echo arm64 >"$database/arch"
  echo 1 >"$database/info/format"
  for deb in "$root"/var/cache/apt/archives/*.deb; do
    control=$(mktemp -d)
    dpkg-deb --control "$deb" "$control"
    name=$(sed -n 's/^Package: //p' "$control/control")
    if grep -qx 'Multi-Arch: same' "$control/control"; then name+=:arm64; fi
    dpkg-deb --fsys-tarfile "$deb" | tar --list | sed 's,^\.,,; s,^/$,/.,; s,/$,,' \
      >"$database/info/$name.list"
    for file in shlibs symbols; do
      if [[ -f $control/$file ]]; then cp "$control/$file" "$database/info/$name.$file"; fi
    done
    sed '/^Package: /a Status: install ok installed' "$control/control" >>"$database/status"
    echo >>"$database/status"
    rm -rf "$control"
  done
  # Links such as libz.so name the library by its place on a running system. Where they lead nowhere, a
  # static library would be linked instead.
  find "$root" -type l -lname '/*' | while read -r link; do
    ln -sfn --relative "$root$(readlink "$link")" "$link"
  done
  exit
fi

wanted="$* $(sha256sum <"$0")"
if [[ -f $directory/.made && $(<"$directory/.made") == "$wanted" ]]; then exit; fi
rm -rf "$directory"
mkdir -p "$(dirname "$directory")"  # in a fresh clone there is none
self=$(readlink -f "$0")
mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$(IFS=, && echo "$*")" \
  --extract-hook="$self --fill-database \"\$1\"" bookworm "$directory"
printf '%s' "$wanted" >"$directory/.made"

#!/usr/bin/env bash
# The packages that ./dev package made: lintian finds no error, they hold what they shall, and they go
# onto a system and off it again without a trace.
#   packages_check.sh FOLDER_OF_PACKAGES
set -euo pipefail
packages=$1
here=$(dirname "$(readlink -f "$0")")
faults=0

fault() {
  printf 'packages: %s\n' "$*" >&2
  faults=1
}

echo "== lintian"
# This is no upload to Debian, and closes no bug there.
lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs \
  "$packages"/*.deb ||
  fault "lintian found faults"

for deb in "$packages"/*.deb; do
  name=$(dpkg-deb -f "$deb" Package)
  echo "== contents of $name"
  # Files and links but for the pages of the guide; the folder of a processor's libraries goes by the
  # name of LIBRARIES.
  dpkg-deb -c "$deb" | awk '$1 !~ /^d/ && $6 !~ /\/doc\/roundel\/guide\// { print $6 }' |
    sed -E 's,^\./,,; s,^usr/lib/[a-z0-9_]+-linux-gnu,usr/lib/LIBRARIES,' | LC_ALL=C sort |
    diff -u "$here/contents/$name" - || fault "$name does not hold what tests/packaging/contents/$name says"
done

if [[ $(dpkg --print-architecture) == $(dpkg-deb -f "$packages"/roundel_*.deb Architecture) ]]; then
  echo "== installation"
  "$here/installation_check.sh" "$packages" || fault "installation"
else
  echo "== installation: skipped, the packages are for another processor"
fi
exit $faults

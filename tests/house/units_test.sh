#!/bin/sh
# The units of systemd/: systemd takes every line of them, they keep their exposure below the ceiling, and
# one camera's sandbox is every camera's.
#   units_test.sh FOLDER
# Where there is no systemd, only the sandboxes are compared.
units=$1
ceiling=15 # tenths
faults=0
fail() {
  echo "$*"
  faults=1
}

sandbox() { sed -n '/^# The sandbox/,/^\[Install\]/p' "$1" | grep -v '^#'; }
[ "$(sandbox "$units/roundeld.service" | wc -l)" -gt 20 ] || fail "roundeld.service: no sandbox was found"
[ "$(sandbox "$units/roundeld.service")" = "$(sandbox "$units/roundeld@.service")" ] ||
  fail "roundeld.service and roundeld@.service have different sandboxes"

if ! command -v systemd-analyze >/dev/null; then
  echo "systemd-analyze is missing: the units are not analysed"
  exit $faults
fi

for unit in roundeld.service roundeld@.service; do
  if exposure=$(SYSTEMD_PAGER='' systemd-analyze security --offline=true --threshold=$ceiling "$units/$unit" 2>&1); then
    echo "$exposure" | grep 'Overall exposure level'
  else
    fail "$unit: the exposure is above the ceiling of $ceiling tenths:
$exposure"
  fi
done

# What is installed by the package (programs, man pages) is not here.
for unit in roundeld.service roundeld@east.service; do
  complaints=$(systemd-analyze verify --man=no --recursive-errors=no "$units/$unit" 2>&1 |
    grep -v 'Command /usr/bin/roundeld is not executable')
  [ -z "$complaints" ] || fail "$complaints"
done
exit $faults

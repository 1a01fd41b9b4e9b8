#!/usr/bin/env bash
# Two builds of same_figures agree: the kernels to the bit, poses to a millionth of what a camera can tell.
#   figures_test.sh PROGRAM OTHER_PROGRAM_OR_EMULATOR...
set -euo pipefail
here=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$here" film >"$work/film"

echo "== kernels"
"$here" kernels <"$work/film" | tee "$work/kernels"
"$@" kernels <"$work/film" | diff "$work/kernels" -

echo "== poses"
# Numbers are pixels, metres and parts of a quaternion.
"$here" poses <"$work/film" >"$work/poses"
"$@" poses <"$work/film" | paste -d ' ' "$work/poses" - | awk -v most=1e-9 '
  {
    half = NF / 2
    if (NF != 24) { print "line " NR ": a marker is missing: " $0; bad = 1; exit }
    for (i = 1; i <= half; ++i) {
      difference = $i - $(i + half)
      if (difference < 0) difference = -difference
      if (difference > worst) worst = difference
      if (i <= 3 && difference > 0) { print "line " NR ": another marker: " $0; bad = 1 }
      if (difference > 0 && i > 3) ++differing
    }
  }
  END {
    printf "%d markers; %d of %d numbers differ, by at most %g\n", NR, differing, 9 * NR, worst
    exit bad || NR == 0 || worst > most
  }'

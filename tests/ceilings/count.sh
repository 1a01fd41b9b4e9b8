#!/usr/bin/env bash
# Counts, by callgrind, what a tracked 41 px marker and a Full-HD frame without markers cost, and
# fails if that is more than the ceilings allow. Unlike times, instructions are the same in every run.
#   count.sh PROGRAM CEILINGS    check      (exit status 77: this processor has other instructions)
#   count.sh PROGRAM             only print, as lines for the file of ceilings
set -euo pipefail
program=$1 ceilings=${2:-}
few=2 many=12 frames=16  # ids are read again every sixteenth frame, a fifth of the picture is searched in each

if [[ -n $ceilings && $(uname -m) == x86_64 ]] && ! grep -qw avx2 /proc/cpuinfo ||
   [[ -n $ceilings && $(uname -m) != x86_64 ]]; then
  echo "the ceilings are those of x86-64 with AVX2; skipped" >&2
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# count MARKERS: instructions of all counted frames.
count() {
  local log="$work/log.$1" counted
  valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no \
    --toggle-collect=counted_frame "$program" "$1" "$frames" >"$log" 2>&1 || {
    cat "$log" >&2
    exit 1
  }
  counted=$(awk '/Collected :/ { print $NF }' "$log")
  [[ $counted =~ ^[1-9][0-9]*$ ]] || { echo "callgrind counted nothing" >&2; cat "$log" >&2; exit 1; }
  echo "$counted"
}

count 0 >"$work/none" &
none=$!
count "$few" >"$work/few" &
some=$!
count "$many" >"$work/many"
wait "$none"
wait "$some"
tracked_marker=$((($(<"$work/many") - $(<"$work/few")) / ((many - few) * frames)))
empty_frame=$(($(<"$work/none") / frames))

if [[ -z $ceilings ]]; then
  echo "tracked_marker $tracked_marker"
  echo "empty_frame $empty_frame"
  exit 0
fi
failed=0
for what in tracked_marker empty_frame; do
  ceiling=$(awk -v what="$what" '$1 == what { print $2 }' "$ceilings")
  [[ $ceiling =~ ^[1-9][0-9]*$ ]] || { echo "no ceiling for $what in $ceilings" >&2; exit 1; }
  printf '%s: %d instructions, %d %% of the ceiling of %d\n' \
    "$what" "${!what}" $((100 * ${!what} / ceiling)) "$ceiling"
  ((${!what} <= ceiling)) || failed=1
done
((failed == 0)) || echo "more instructions than allowed: make it cheaper, or say in the commit why it must cost more" >&2
exit $failed

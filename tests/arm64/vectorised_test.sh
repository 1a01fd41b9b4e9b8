#!/bin/sh
# The kernels use NEON, four floats or sixteen bytes an instruction, and fuse no product with a sum.
#   vectorised_test.sh BUILD_DIRECTORY
set -eu
folder=$1/core/CMakeFiles/roundel_core.dir
faults=0

# count FILE PATTERN: instructions that match.
count() {
  aarch64-linux-gnu-objdump --disassemble --no-show-raw-insn "$folder/$1.cpp.o" |
    grep -cE "^ *[0-9a-f]+:[[:space:]]+$2" || true
}

# expect AT_LEAST FILE PATTERN
expect() {
  found=$(count "$2" "$3")
  echo "$2: $found instructions are $3"
  if [ "$found" -lt "$1" ]; then faults=1; fi
}

expect 500 photometric_kernel 'f(add|sub|mul|div|sqrt|cmgt|neg|abs)[[:space:]]+v[0-9]+\.4s'
expect 15 row_scanner '[a-z0-9]+[[:space:]]+v[0-9]+\.16b'
for file in photometric_kernel row_scanner; do
  fused=$(count $file 'fn?m(add|sub|la|ls)[[:space:]]')
  echo "$file: $fused instructions are fused multiply-adds"
  if [ "$fused" -ne 0 ]; then faults=1; fi
done
exit $faults

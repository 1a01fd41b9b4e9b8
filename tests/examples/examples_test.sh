#!/bin/sh
# Builds and runs examples/ as a user would, against a roundeld on a simulated arena.
#   examples_test.sh SOURCE_DIR BUILD_DIR
# 77: not in a private network (./dev test makes one).
set -eu
source=$1 build=$2
if ! ip -o link show up 2>/dev/null | grep -qv ': lo:' && ip route | grep -q '^239.0.0.0/8 dev lo'; then
  :
else
  echo "skipped: not in a private network namespace"
  exit 77
fi
work=$(mktemp -d)
daemon=
cleanup() {
  [ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT

cmake --install "$build" --component dev --prefix "$work/usr" >"$work/log"
cmake -S "$source/examples/robot" -B "$work/robot" -DCMAKE_PREFIX_PATH="$work/usr" >>"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
cmake --build "$work/robot" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

# The id that the first robot wears is printed by whoever sees it.
"$build/bin/roundeld" --set simulator.width=640 --set simulator.height=480 --set simulator.robots=2 \
  --set control.socket= 2>"$work/daemon" &
daemon=$!
id=$("$build/bin/roundel" listen --json --seconds 20 2>/dev/null |
  grep -o -m 1 '"id":[0-9]\+' | head -n 1 | cut -d : -f 2)
[ -n "$id" ] || { echo "no robot was seen"; cat "$work/daemon"; exit 1; }

# First line, then gone.
timeout 30 "$work/robot/robot" "$id" | head -n 1 >"$work/robot.txt" || true
grep -q '^camera: x .* m, y .* m, z .* m; frame [0-9]*, .* ms old$' "$work/robot.txt" ||
  { echo "robot said:"; cat "$work/robot.txt"; exit 1; }

PYTHONPATH="$build/transport/lcm/python" timeout 30 python3 "$source/examples/python/follow.py" "$id" 20 \
  2>/dev/null | head -n 1 >"$work/python.txt" || true
grep -q '^camera: x .* m, y .* m, z .* m$' "$work/python.txt" ||
  { echo "follow.py said:"; cat "$work/python.txt"; exit 1; }

# A robot that is not there is told to stop.
timeout 5 "$work/robot/robot" 29 >"$work/absent.txt" || true
grep -qx 'not seen: stop' "$work/absent.txt" || { echo "absent robot:"; cat "$work/absent.txt"; exit 1; }

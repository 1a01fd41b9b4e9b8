#!/bin/sh
# What libroundel-dev and python3-roundel install is enough to build programs, by find_package and by
# pkg-config, and for Python.
#   development_test.sh BUILD_DIRECTORY THIS_FOLDER
set -eu
build=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/usr

for component in dev python; do
  cmake --install "$build" --component $component --prefix "$prefix" >"$work/log" || {
    cat "$work/log"
    exit 1
  }
done

echo "== find_package"
cmake -S "$folder/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/consumer" >"$work/log" 2>&1 || {
  cat "$work/log"
  exit 1
}
for program in tracks receives receives_c; do
  "$work/consumer/$program" >"$work/log" || {
    echo "$program fails: $(cat "$work/log")"
    exit 1
  }
done

echo "== pkg-config"
modules=$(dirname "$(find "$prefix" -name roundel.pc)")
sed -i "s,^prefix=.*,prefix=$prefix," "$modules"/*.pc
export PKG_CONFIG_PATH="$modules"
# shellcheck disable=SC2046  # flags are words
{
  c++ -std=c++20 "$folder/consumer/tracks.cpp" -o "$work/tracks" \
    $(pkg-config --cflags --libs roundel)
  c++ "$folder/consumer/receives.cpp" -o "$work/receives" $(pkg-config --cflags --libs roundel-lcm)
  cc "$folder/consumer/receives.c" -o "$work/receives_c" $(pkg-config --cflags --libs roundel-lcm)
}
for program in tracks receives receives_c; do "$work/$program" >/dev/null; done

command -v python3 >/dev/null || exit 0
echo "== Python"
PYTHONPATH=$prefix/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 python3 -c '
import roundel
frame = roundel.frame_t()
frame.markers = [roundel.marker_t(), roundel.marker_t()]
frame.num_markers = 2
frame.markers[1].id = 7
assert roundel.frame_t.decode(frame.encode()).markers[1].id == 7
assert roundel.header_t.CAMERA_LOST == 2
'

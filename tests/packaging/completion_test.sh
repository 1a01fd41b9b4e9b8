#!/usr/bin/env bash
# The completions, asked as bash asks them.
#   completion_test.sh FOLDER_OF_COMPLETIONS FOLDER_OF_PROGRAMS
set -uo pipefail
completions=$(readlink -f "$1") programs=$(readlink -f "$2")
. "$(dirname "$0")/help_words.sh"
. "$completions/roundel.bash"
. "$completions/roundeld.bash"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
touch picture.png 'two words.png'
faults=0

# offered WORD...: what is offered for the last word, one a line.
offered() {
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  "_$1"
  printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort
}

# expect WANTED WORD...
expect() {
  local wanted=$1 got
  shift
  got=$(offered "$@")
  if [[ $got != "$wanted" ]]; then
    printf 'completion of "%s": offered "%s" instead of "%s"\n' "$*" "$got" "$wanted"
    faults=1
  fi
}

complete -p roundel roundeld >/dev/null || faults=1

expect "$( (subcommands_of "$programs/roundel" && echo --help) | LC_ALL=C sort)" roundel ''
while read -r command; do
  # shellcheck disable=SC2086  # a command may be two words
  expect "$( (options_of "$programs/roundel" $command | grep -e '^--'
    echo --help) | LC_ALL=C sort)" roundel $command --
done < <(commands_of "$programs/roundel")
expect "$( (options_of "$programs/roundeld" && echo --help) | LC_ALL=C sort)" roundeld --

expect $'calibrate\ncameras\ncompare\ncontrols' roundel c
expect $'picture.png\ntwo words.png' roundel detect ''
expect 'two words.png' roundel detect --json picture.png two
expect $'picture.png\ntwo words.png' roundel track --camera ''
expect '3d' roundel track --arena-mode 3
expect '' roundel detect --bits ''
expect $'lcm.channel=\nlcm.copies=\nlcm.interface=\nlcm.max_datagram=\nlcm.per_marker=\nlcm.url=' roundeld --set lcm.
expect $'camera\nfiles\nsimulator' roundeld --set source = ''
expect 'true' roundeld --set lcm.per_marker = t
expect $'false\ntrue' roundeld --set lcm.per_marker =
expect 'picture.png' roundeld --set camera.calibration = pic
expect 'picture.png' roundeld --config p
exit $faults

#!/usr/bin/env bash
# The manual pages are proper ones, and name every subcommand, option, key and field that there is.
#   manual_test.sh FOLDER_OF_PAGES FOLDER_OF_PROGRAMS FOLDER_OF_LCM_TYPES
set -uo pipefail
pages=$1 programs=$2 types=$3
. "$(dirname "$0")/help_words.sh"
export LC_ALL=C.UTF-8 MANWIDTH=300
faults=0

fault() {
  echo "manual: $*"
  faults=1
}

rendered() {
  man --nj --nh -l "$pages/$1" | col -bx
}

# The lines of a subsection of a rendered page on standard input.
subsection() {
  awk -v heading="   $1" '$0 == heading { on = 1; next } on && /^ ? ? ?[^ ]/ { exit } on'
}

# same WHAT THAT_OF_THE_PROGRAM THAT_OF_THE_PAGE
same() {
  [[ -n $2 ]] || [[ $1 == *"without options"* ]] || fault "$1: the program names none"
  diff <(echo "$2") <(echo "$3") || fault "$1: the page (>) differs from the program (<)"
}

# Options at the tags of a page: "-o, --output FILE".
tags() {
  sed -nE 's/^ {7}(-.*)/\1/p' | grep -oE -e '(^|, )--?[a-zA-Z][a-z0-9-]*' | tr -d ', ' | LC_ALL=C sort
}

for page in roundel.1 roundeld.8 roundel.yaml.5 roundel-lcm.5; do
  warnings=$(man --warnings -l "$pages/$page" 2>&1 >/dev/null)
  [[ -z $warnings ]] || fault "man says of $page: $warnings"
  if command -v mandoc >/dev/null; then
    mandoc -T lint -W warning "$pages/$page" || fault "mandoc finds faults in $page"
  fi
done

tool=$(rendered roundel.1)
while read -r command; do
  what="roundel $command"
  # shellcheck disable=SC2086  # a command may be two words
  "$programs/roundel" $command --help | grep -q '^  -[^h]\|^  -h,[^-]\|^  --' || what+=" (without options)"
  # shellcheck disable=SC2086
  same "$what" "$(options_of "$programs/roundel" $command)" \
    "$(subsection "roundel $command" <<<"$tool" | tags)"
done < <(commands_of "$programs/roundel")
same "subcommands" "$(commands_of "$programs/roundel")" \
  "$(sed -n 's/^   roundel \([a-z ]*\)$/\1/p' <<<"$tool")"

same "roundeld" "$(options_of "$programs/roundeld")" \
  "$(rendered roundeld.8 | sed -n '/^OPTIONS/,/^[A-NP-Z]/p' | tags | grep -vxE -e '-h|--help')"

keys=$("$programs/roundeld" --print-config | awk '
  /^[a-z]/ { section = $1; if (NF > 1 && $2 !~ /^#/) print section }
  /^  [a-z]/ { print substr(section, 1, length(section) - 1) "." $1 }')
same "roundel.yaml" "$keys" \
  "$(rendered roundel.yaml.5 | sed -n '/^KEYS/,/^EXAMPLES/p' | sed -nE 's/^ {7}([a-z_.]+:) .*/\1/p')"

lcm=$(rendered roundel-lcm.5)
for type in "$types"/*.lcm; do
  name=$(basename "$type" .lcm)
  fields=$(sed -n '/^package/d; s,//.*,,; s/^ *\(const *[a-z0-9_]*\|[a-z0-9_]*\) *\([A-Za-z][^ ;=]*\) *[;=].*/\2/p' "$type" |
    LC_ALL=C sort)
  same "$name" "$fields" "$(subsection "$name" <<<"$lcm" |
    sed -nE 's/^ {7}((boolean|float|string|[a-z0-9]+_t) [a-z][a-z0-9_]*(\[[a-z0-9_]*\])?|[A-Z0-9_]+ = [0-9-]+)( +.*)?$/\1/p' |
    sed -E 's/ = .*//; s/^[a-z0-9_]+ //' | LC_ALL=C sort)"
done
exit $faults

# Sourced by tests: what a program's --help names.

# The subcommands below a command: subcommands_of PROGRAM [SUBCOMMAND...]
subcommands_of() {
  "$@" --help | sed -n '/^Subcommands:/,$p' | sed -n 's/^  \([a-z][a-z-]*\) .*/\1/p'
}

# The options of a command, one a line, without those for help.
options_of() {
  "$@" --help | sed -nE 's/^ +(-[^ ]+).*/\1/p' | tr ',' '\n' | grep -vxE -e '-h|--help' | LC_ALL=C sort
}

# Every command that can be called, one a line: "detect", "calibrate arena".
commands_of() {
  local program=$1 command below
  for command in $(subcommands_of "$program"); do
    below=$(subcommands_of "$program" "$command")
    if [[ -z $below ]]; then
      echo "$command"
    else
      sed "s/^/$command /" <<<"$below"
    fi
  done
}

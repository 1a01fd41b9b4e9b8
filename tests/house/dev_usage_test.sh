#!/bin/sh
# ./dev says what is wrong with its arguments and ends with 2, before it installs or builds anything.
dev=$1
faults=0

# expect STATUS TEXT ARGUMENT...: the exit status, and a part of what is printed.
expect() {
  status=$1 text=$2
  shift 2
  printed=$("$dev" "$@" 2>&1 </dev/null)
  got=$?
  if [ "$got" -ne "$status" ]; then
    echo "./dev $*: exit status $got instead of $status"
    faults=1
  fi
  case $printed in
    *"$text"*) ;;
    *)
      echo "./dev $*: printed \"$printed\", without \"$text\""
      faults=1
      ;;
  esac
}

expect 0 "run [--seconds N] [--robots N] [--host-network]" help
expect 0 "lab [--long]" help
expect 0 "boot [DOCTEST OPTIONS]" help
expect 0 "package          the Debian packages" help
expect 0 "usage: ./dev COMMAND"
expect 0 "usage: ./dev COMMAND" --help
expect 2 "unknown command 'tset'" tset
expect 2 "unknown preset 'fast': it must be release, debug, asan or tsan" test fast
expect 2 "unknown preset 'fast'" build fast
expect 2 "takes one preset" build release debug
expect 2 "--robots needs a whole number" run --robots many
expect 2 "--seconds needs a whole number" run --seconds
expect 2 "--seconds needs a whole number" run --seconds=-1
expect 2 "unknown option '--minutes'" run --minutes 3
expect 2 "package takes no arguments" package release
expect 2 "arm64 takes no arguments but --figures" arm64 release
expect 2 "ceilings takes no arguments" ceilings 3
expect 2 "lint: there is no folder 'cores'" lint cores
exit $faults

#!/usr/bin/env bash
# Man pages: there is one for every program and command, groff has nothing to say about any, and options are in them.
#   bash tests/documentation/man_pages_test.sh FOLDER PROGRAM...
set -euo pipefail
folder=$1
shift
failures=0
complain() {
  echo "$*"
  failures=$((failures + 1))
}

check() { # NAME PROGRAM [COMMAND]
  local file=$folder/$1.1 text warnings option
  shift
  [ -s "$file" ] || { complain "there is no $file"; return; }
  text=$(MANWIDTH=500 LC_ALL=C.UTF-8 man --warnings -l "$file" 2> "$scratch") || complain "man cannot show $file"
  warnings=$(cat "$scratch")
  [ -z "$warnings" ] || complain "$file: $warnings"
  for section in NAME SYNOPSIS OPTIONS "EXIT STATUS" "SEE ALSO"; do
    grep -q "^$section" <<< "$text" || complain "$file has no section $section"
  done
  for option in $("$@" --help | sed -n 's/^  \(-[^ {]*\).*/\1/p' | tr , '\n' | grep '^--'); do
    grep -q -e "^ .*$option" <<< "$text" || complain "$file lacks $option"
  done
}

scratch=$(mktemp)
trap 'rm -f "$scratch"' EXIT
for program in "$@"; do
  name=$(basename "$program")
  check "$name" "$program"
  for command in $("$program" --help | sed -n '/^Subcommands:/,/^ *$/s/^  \([a-z][a-z-]*\) .*/\1/p'); do
    check "$name-$command" "$program" "$command"
  done
done
[ "$failures" -eq 0 ] || exit 1
echo "$(ls "$folder" | wc -l) man pages"

# Completes commands, options and their words for the shell bash, from what --help prints, so that there is nothing to keep up
# to date. Installed as share/bash-completion/completions/freevoxels; `source apps/freevoxels/completion.bash` also works.

_freevoxels() {
  local program=$1 word=$2 previous=$3 help command words
  command=${COMP_WORDS[1]}
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$("$program" --help | sed -n '/^Subcommands:/,/^ *$/s/^  \([a-z][a-z-]*\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    return
  fi
  help=$("$program" "$command" --help 2>/dev/null)
  if [[ $word == -* ]]; then
    words=$(grep -oE -- '--[a-z][a-z-]*' <<<"$(sed -n 's/^  \(-[^ ]*\).*/\1/p' <<<"$help")")
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    return
  fi
  # Options of a few words show them as "--shading auto|scatter|gradient".
  words=$(sed -n "s/^  ${previous} \([a-z0-9]*|[a-z0-9|]*\).*/\1/p" <<<"$help")
  if [[ $previous == --* && -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${words//|/ }" -- "$word")
    return
  fi
  compopt -o filenames 2>/dev/null || true # fails outside of a completion, in tests
  mapfile -t COMPREPLY < <(compgen -f -- "$word")
}
complete -F _freevoxels freevoxels

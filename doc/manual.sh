#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the manual pages and the completion of bash from the program's own help, so that nothing is said twice.
# usage: manual.sh PROGRAM VERSION FOLDER
set -eu
program=$1 version=$2 folder=$3
mkdir -p "$folder"

# Text of the help as roff: a block that is indented stands as it is, an option with its words as a tagged paragraph.
roff() {
  awk '
    function plain(text) { gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); sub(/^[.'\'']/, "\\\\\\&&", text); return text }
    /^$/ { if (!table) gap = 1; else ended = 1; next }
    /^  / && match($0, /^  +[^ ]+( [^ ]+)*  +/) {
      tag = substr($0, RSTART, RLENGTH); words = substr($0, RLENGTH + 1)
      if (tag ~ /[^ ]/) {
        gsub(/^ +| +$/, "", tag)
        printf ".TP\n.B %s\n%s\n", plain(tag), plain(words); table = 1; ended = 0; next
      }
    }
    table && /^ / && !ended { sub(/^ +/, ""); print plain($0); next }
    { if (table || gap) print ".PP"; table = gap = ended = 0; print plain($0) }'
}

# The commands with their sentences, from the overview.
commands() {
  "$program" --help | awk '/^  easeoff / { name = $2; sub(/^  easeoff [^ ]+ +/, ""); print name "\t" $0 }'
}

head() {
  printf '.\\" Made from the help of the program.\n.TH %s 1 "" "easeoff %s" "User Commands"\n' "$1" "$version"
}

page() {
  name=$1 sentence=$2
  help=$("$program" "$name" --help)
  head "EASEOFF-$(printf %s "$name" | tr '[:lower:]' '[:upper:]')"
  printf '.SH NAME\neaseoff\\-%s \\- %s\n.SH SYNOPSIS\n' "$name" "$(printf %s "$sentence" | sed 's/-/\\-/g')"
  printf '%s\n' "$help" | awk '/^$/ { exit } { sub(/^usage: /, ""); gsub(/-/, "\\-"); print ".B " $0; print ".br" }'
  printf '.SH DESCRIPTION\n'
  printf '%s\n' "$help" | sed '1,/^$/d' | roff
  printf '.SH "SEE ALSO"\n.BR easeoff (1)\n'
}

overview() {
  head EASEOFF
  printf '.SH NAME\neaseoff \\- quiet herringbone gears by tooth micro\\-geometry\n.SH SYNOPSIS\n.B easeoff\n.I COMMAND\n[...]\n'
  printf '.SH DESCRIPTION\nTakes a gear pair and its duty cycle, computes how it meshes, vibrates and is stressed, and finds the tooth\n'
  printf 'micro\\-geometry that makes it quiet.\n.SH COMMANDS\n'
  commands | while IFS="$(printf '\t')" read -r name sentence; do
    printf '.TP\n.BR easeoff\\-%s (1)\n%s\n' "$name" "$(printf %s "$sentence" | sed 's/-/\\-/g')"
  done
  printf '.SH "EXIT STATUS"\n0 done, 1 the input is wrong, 2 it failed.\n'
  printf '.SH ENVIRONMENT\n.TP\n.B EASEOFF_DATA\nfolder of the history and of prepared gear pairs, where no option names one\n'
  printf '.TP\n.B EASEOFF_TOKEN\ntoken of the service\n.TP\n.B EASEOFF_WEB\nfolder of the page\n'
}

# Every option that the help of a command names.
options_of() {
  "$program" "$1" --help | grep -oE '(^|[^a-z-])--[a-z][A-Za-z-]*' | grep -oE -- '--[a-z][A-Za-z-]*' | sort -u | tr '\n' ' '
}

completion() {
  printf '# Made from the help of the program.\n_easeoff() {\n'
  # shellcheck disable=SC2016
  printf '  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]-} words=\n  COMPREPLY=()\n'
  # shellcheck disable=SC2016
  printf '  if [ "$COMP_CWORD" = 1 ]; then\n    words="%s --help --version"\n  else\n    case $command in\n' \
    "$(commands | cut -f 1 | tr '\n' ' ' | sed 's/ $//')"
  commands | cut -f 1 | while read -r name; do
    printf '    %s) words="%s--help" ;;\n' "$name" "$(options_of "$name" | sed 's/--help //')"
  done
  printf '    esac\n  fi\n'
  # shellcheck disable=SC2016
  printf '  while IFS= read -r match; do COMPREPLY+=("$match"); done < <(compgen -W "$words" -- "$word")\n'
  # shellcheck disable=SC2016
  printf '  if [ "$COMP_CWORD" != 1 ] && [ "${word#-}" = "$word" ]; then\n'
  # shellcheck disable=SC2016
  printf '    while IFS= read -r match; do COMPREPLY+=("$match"); done < <(compgen -f -- "$word")\n  fi\n}\n'
  printf 'complete -o filenames -F _easeoff easeoff\n'
}

overview >"$folder/easeoff.1"
commands | while IFS="$(printf '\t')" read -r name sentence; do
  page "$name" "$sentence" >"$folder/easeoff-$name.1"
done
completion >"$folder/easeoff.bash"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The manual pages and the completion, made of the help: every command has a page, every option of its help is in it.
folder=$(mktemp -d) count=0
trap 'rm -rf "$folder"' EXIT

# ok LABEL: of the status before it.
ok() {
  status=$?
  count=$((count + 1))
  if [ "$status" = 0 ]; then echo "ok $count - $1"; else echo "not ok $count - $1"; fi
}

sh "$SOURCES/doc/manual.sh" "$EASEOFF" 1.2.3 "$folder"
commands=$("$EASEOFF" --help | awk '/^  easeoff / { print $2 }')
[ "$(echo "$commands" | wc -w)" -ge 12 ]
ok "the commands are listed"
for command in $commands; do
  page=$folder/easeoff-$command.1
  missing=
  for option in $("$EASEOFF" "$command" --help | grep -oE -- '--[a-z][A-Za-z-]*' | sort -u); do
    sed 's/\\-/-/g' "$page" | grep -q -- "$option" || missing="$missing $option"
  done
  [ -s "$page" ] && [ -z "$missing" ]
  ok "$command: each option of its help is in its manual page$missing"
  grep -q "easeoff.-$command (1)" "$folder/easeoff.1"
  ok "$command: the overview names its page"
done
if command -v groff >/dev/null; then
  warnings=$(for page in "$folder"/*.1; do groff -man -ww -Tutf8 -z "$page" 2>&1; done)
  [ -z "$warnings" ]
  ok "no page makes groff complain$warnings"
fi
if command -v bash >/dev/null; then
  completed=$(bash -c ". $folder/easeoff.bash; COMP_WORDS=(easeoff optimize --bu); COMP_CWORD=2; _easeoff; echo \"\${COMPREPLY[*]}\"")
  [ "$completed" = --budget ]
  ok "bash completes an option: $completed"
  completed=$(bash -c ". $folder/easeoff.bash; COMP_WORDS=(easeoff ana); COMP_CWORD=1; _easeoff; echo \"\${COMPREPLY[*]}\"")
  [ "$completed" = analyze ]
  ok "bash completes a command: $completed"
fi
echo "1..$count"

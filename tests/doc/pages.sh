#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The manuals as pages: a page per text, every link and picture of them there, nothing loaded from elsewhere.
. "$(dirname "$0")/../support/tap.sh"
if [ ! -f "${PAGE:=web/page}/doc/index.html" ]; then
  echo "1..0 # SKIP the manuals are not built here"
  exit 0
fi
texts=$(cd "$SOURCES/doc" && ls ./*.md theory/*.md | sed 's/^\.\///; s/\.md$/.html/' | sort)
pages=$(cd "$PAGE/doc" && ls ./*.html theory/*.html | sed 's/^\.\///' | sort)
[ "$texts" = "$pages" ]
result $? "each text has a page"
for page in $pages; do
  grep -oE '(href|src)="[^"#]+' "$PAGE/doc/$page" | sed 's/^[a-z]*="//' | sort -u | while read -r target; do
    case $target in
      *://*) ;;
      */) [ -f "$PAGE/doc/$(dirname "$page")/${target}index.html" ] || echo "$page: $target" ;;
      *) [ -f "$PAGE/doc/$(dirname "$page")/$target" ] || echo "$page: $target" ;;
    esac
  done
done >"$folder/out"
[ ! -s "$folder/out" ]
result $? "every link leads somewhere"
grep -lE '<script|<(img|link)[^>]*://| style="' "$PAGE"/doc/*.html "$PAGE"/doc/theory/*.html >"$folder/out"
[ ! -s "$folder/out" ]
result $? "the pages have no script, no style in a line, nothing from elsewhere"
wanted=$(cat "$SOURCES"/doc/theory/*.md | grep -c '\\tag{')
shown=$(cat "$PAGE"/doc/theory/*.html | grep -c 'class="equation" id=')
[ "$wanted" = "$shown" ]
result $? "$shown of $wanted equations can be linked to"
echo "1..$count"
exit $failed

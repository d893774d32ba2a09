#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Data flows down the floors: a file includes its own folder and those above it in src/README.md's list, never below. The core prints
# nothing and reads no environment; each library has its one floor.
: "${SOURCES:=.}"
cd "$SOURCES/src" && [ -f README.md ] || exit 99
floors="base numerics gear flexibility contact dynamics rating optimizer tolerance design evaluation recording measurement format crew document library exchange report store study variants reproduction service http reference app"
core="base numerics gear flexibility contact dynamics rating optimizer tolerance design evaluation recording measurement"
count=0 failed=0

result() # status, what
{
  count=$((count + 1))
  if [ "$1" -eq 0 ]; then echo "ok $count - $2"; else
    failed=1
    echo "not ok $count - $2"
  fi
}

allowed=
for floor in $floors; do
  allowed="$allowed $floor"
  [ -d "$floor" ] || continue
  wrong=$(grep -hoE '^ *# *include "[a-z]+/' "$floor"/*.[ch] | sed 's/.*"\(.*\)\//\1/' | sort -u | while read -r used; do
    case " $allowed " in *" $used "*) ;; *) printf ' %s' "$used" ;; esac
  done)
  [ "$floor" = optimizer ] && wrong="$wrong$(grep -hoE '"(gear|flexibility|contact|dynamics|rating)/' optimizer/*.[ch])"
  [ "$floor" = format ] && wrong="$wrong$(grep -hoE 'include "[a-z]+/' format/*.[ch] | grep -vE '(base|format)/')"
  [ -z "$wrong" ]
  result $? "$floor includes nothing from below:$wrong"
done

# what is not in the list is not in a release, and does not have the page built again
wrong=$(cd ../web/src && find . -type f | sed 's,^\./,,' | while read -r file; do
  grep -qE "web/src/$file( |\$)" ../web.am || printf ' %s' "$file"
done)
[ -z "$wrong" ]
result $? "every file of the page is in web/web.am:$wrong"

only() # LIBRARY PATTERN FOLDERS
{
  wrong=$(grep -lE "# *include <($2)" ./*/*.[ch] | grep -vE "^\./($3)/")
  [ -z "$wrong" ]
  result $? "only $3 uses $1: $wrong"
}
only SuiteSparse 'cholmod|klu' numerics
only SUNDIALS 'kinsol|cvode|sundials|nvector|sunlinsol|sunmatrix' numerics
only jansson 'jansson' 'format|document|exchange|report|study|variants|reproduction|http|reference|app'
wrong=$(grep -lE '\bjson_[a-z]' service/*.[ch])
[ -z "$wrong" ]
result $? "the service speaks structs and text, no JSON values:$wrong"
only libmatio 'matio' recording
only HDF5 'hdf5' recording
only libarchive 'archive' 'recording|exchange|store'
only expat 'expat' 'recording|exchange'
only SQLite 'sqlite3' store
only libmicrohttpd 'microhttpd' http

# every file of http/ is named like the header that declares what it gives, so includes are its calls too
wrong=$(grep -oE '^#include "http/[a-z_0-9]+' http/*.[ch] | sed 's/^http\/\([a-z_0-9]*\)\.[ch]:#include "http\//\1 /' | tsort 2>&1 >/dev/null | grep -v 'loop:' | sed 's/.*: //')
[ -z "$wrong" ]
result $? "no files of http include each other in a circle:$(echo $wrong)"

wrong=$(for file in */*.[ch]; do echo "${file##*/}"; done | sort | uniq -d | tr '\n' ' ')
[ -z "$wrong" ]
result $? "no two files have one name: $wrong"

# A name that stands twice, declared and defined, is called by nobody but perhaps a test.
wrong=$(for name in $(cat ./*/*.[ch] | grep -oE '\beo_[a-z0-9_]+\b' | sort | uniq -c | awk '$1 < 3 { print $2 }'); do
  grep -hE "^[a-z][a-z_ *]*[ *]$name\(" ./[!l]*/*.h ./library/[!e]*.h 2>/dev/null | grep -qvE "^(typedef|static)" && printf " %s" "$name"
done)
[ -z "$wrong" ]
result $? "the program calls what its headers declare:$wrong"

for floor in $core; do
  [ -d "$floor" ] || continue
  wrong=$(grep -lE '\b(printf|fprintf|puts|getenv|rand|srand|exit)\(' "$floor"/*.c)
  [ -z "$wrong" ]
  result $? "$floor neither prints nor reads the environment:$wrong"
done

echo "1..$count"
exit $failed

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The bill of materials (doc/sbom.py): every library that is linked, every package of the page, a sound SPDX document, twice the same.
. "$(dirname "$0")/../support/tap.sh"
command -v python3 >/dev/null && command -v dpkg >/dev/null || {
  echo "1..0 # SKIP python3 and dpkg are needed"
  exit 0
}
make_it() { python3 "$SOURCES/doc/sbom.py" "$EASEOFF" "$SOURCES/web/package-lock.json" 1.2.3; }
make_it >"$folder/bill" 2>"$folder/err"
result $? "the bill of materials is made"
make_it 2>"$folder/err" | cmp -s - "$folder/bill"
result $? "a second bill has the same bytes"
python3 - "$folder/bill" >"$folder/out" 2>"$folder/err" <<'END'
import json, sys
bill = json.load(open(sys.argv[1], encoding="utf-8"))
names = {package["SPDXID"]: package["name"] for package in bill["packages"]}
assert len(names) == len(bill["packages"]), "identities are not unique"
for relation in bill["relationships"][1:]:
    assert relation["spdxElementId"] in names and relation["relatedSpdxElement"] in names, relation
related = {relation["relatedSpdxElement"] for relation in bill["relationships"]}
assert related == set(names), "a package that nothing relates to"
assert "uplot" in names.values() and "esbuild" not in names.values(), "of the page what is in it, and no more"
for word in ("cholmod", "jansson", "sqlite3", "microhttpd", "sundials", "openblas"):
    assert any(word in name for name in names.values()), word
END
result $? "each package stands once, related, and those that are linked are there"
echo "1..$count"
exit $failed

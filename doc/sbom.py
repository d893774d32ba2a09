#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the program is made of, as an SPDX 2.3 document: sbom.py PROGRAM LOCKFILE VERSION > FILE (`make sbom`)

The Debian packages of the libraries it is linked with, as the dynamic loader finds them here, and the npm packages
whose code is in the page. The same tree on the same machine gives the same bytes; $SOURCE_DATE_EPOCH is the date, else
1970."""

import hashlib
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def linked_packages(program):
    """{name: (version, source, licence)} of the Debian packages that hold what the program loads."""
    files = sorted({os.path.realpath(path) for path in re.findall(r"=> (/\S+)", output("ldd", program))})
    # dpkg may know a file below /lib or below /usr/lib; it is asked once, as it reads all its lists for every question
    names = {file: (file, file.removeprefix("/usr"), "/usr" + file) for file in files}
    asked = ["dpkg", "-S", *(name for each in names.values() for name in each)]
    owner_of = {}
    for line in subprocess.run(asked, capture_output=True, text=True, check=False).stdout.splitlines():
        owners, _, path = line.rpartition(": ")
        owner_of.setdefault(path, re.split("[:,]", owners)[0])
    owners = set()
    for file, each in names.items():
        owner = next((owner_of[name] for name in each if name in owner_of), None)
        if owner is None:
            raise SystemExit(f"no Debian package holds {file}")
        owners.add(owner)
    found = {}
    form = "${Package}\t${Version}\t${source:Package}\t${source:Version}\n"
    for line in output("dpkg-query", "-W", "-f", form, *sorted(owners)).splitlines():
        name, version, source, source_version = line.split("\t")
        found.setdefault(name, (version, f"{source} {source_version}"))
    return found


def bundled_packages(lockfile):
    """{name: entry} of the packages whose code the page's bundle takes in: those that are not for building alone."""
    entries = json.loads(Path(lockfile).read_text(encoding="utf-8"))["packages"]
    return {name.split("node_modules/")[-1]: entry for name, entry in entries.items() if name and not entry.get("dev")}


def package(name, version, **more):
    identity = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)
    return {
        "SPDXID": identity,
        "name": name,
        "versionInfo": version,
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",
        "licenseDeclared": "NOASSERTION",
        "copyrightText": "NOASSERTION",
    } | more


def reference(locator):
    return [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}]


def relation(one, kind, other):
    return {"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}


def document(program, lockfile, version):
    own = package("easeoff", version, licenseDeclared="GPL-3.0-or-later", licenseConcluded="GPL-3.0-or-later")
    parts = []
    for name, (found, source) in sorted(linked_packages(program).items()):
        locator = reference(f"pkg:deb/debian/{name}@{found}")
        parts.append((package(name, found, sourceInfo=f"Debian source {source}", externalRefs=locator), "DYNAMIC_LINK"))
    for name, entry in sorted(bundled_packages(lockfile).items()):
        more = {"licenseDeclared": entry.get("license", "NOASSERTION")}
        locator = reference(f"pkg:npm/{name}@{entry['version']}")
        parts.append((package(name, entry["version"], externalRefs=locator, **more), "CONTAINS"))
    relationships = [relation("SPDXRef-DOCUMENT", "DESCRIBES", own["SPDXID"])]
    relationships += [relation(own["SPDXID"], kind, part["SPDXID"]) for part, kind in parts]
    made = {"packages": [own] + [part for part, _ in parts], "relationships": relationships}
    stamp = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", "0"))))
    digest = hashlib.sha256(json.dumps(made, sort_keys=True).encode()).hexdigest()
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"easeoff-{version}",
        "documentNamespace": f"https://easeoff.invalid/spdx/easeoff-{version}-{digest}",
        "creationInfo": {"created": stamp, "creators": ["Tool: easeoff-sbom", "Organization: Easeoff developers"]},
    } | made


if __name__ == "__main__":
    print(json.dumps(document(*sys.argv[1:4]), indent=2))

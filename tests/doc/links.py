#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links inside the repository's texts: every file and heading that is pointed at is there. Prints what is not, and ends
with 1 then.
usage: links.py FILE.md..."""

import re
import sys
from pathlib import Path


def slug(heading):
    return re.sub(r"[^\w -]", "", re.sub(r"[`*]", "", heading).lower()).replace(" ", "-")


def places(path, known={}):
    if path not in known:
        text = path.read_text(encoding="utf-8")
        outside = re.sub(r"(?ms)^```.*?^```", "", text)
        headings = re.findall(r"(?m)^#+ (.+)$", outside)
        known[path] = {slug(heading) for heading in headings} | set(re.findall(r"\\tag\{(\w+)\}", text))
    return known[path]


def faults(path):
    text = re.sub(r"`[^`\n]*`", "", re.sub(r"(?ms)^```.*?^```", "", path.read_text(encoding="utf-8")))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, place = target.partition("#")
        file = (path.parent / name) if name else path
        if not file.exists():
            yield f"{path}: {target}: no such file"
        elif place and file.suffix == ".md" and place not in places(file.resolve()):
            yield f"{path}: {target}: no such heading"


def main():
    found = [fault for name in sys.argv[1:] for fault in faults(Path(name))]
    print("\n".join(found))
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())

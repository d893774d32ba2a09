#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command of the manuals, run in the order of the text.

Blocks of the kind `sh` of README.md, doc/guide.md, doc/api.md and doc/cluster.md are run by one shell per document, in an empty folder
of its own; blocks of the kind `python` in between by the interpreter, with the client of clients/python at hand. A
document passes when every command ends with 0. So that this takes seconds, `easeoff` is a front that asks for a coarse
mesh in every design; the numbers that the texts quote are those of the usual one. Blocks of other kinds (`console`,
`text`, `json`) are to be read."""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCES = Path(os.environ.get("SOURCES", ".")).resolve()
PROGRAM = Path(os.environ.get("EASEOFF", "./easeoff")).resolve()
DOCUMENTS = ["README.md", "doc/guide.md", "doc/api.md", "doc/cluster.md"]
PATIENCE = 500  # seconds of one document, on a busy machine
COARSE = {
    "body": "sector",
    "sector_teeth": 3,
    "neighbour_coupling": False,
    "layers": 6,
    "flank_rows": 4,
    "fillet_elements": 6,
    "positions": 16,
    "cells_per_line": 8,
    "harmonics": 12,
    "te_harmonics": 8,
}
FRONT = '''#!/usr/bin/env python3
import json, os, subprocess, sys, tempfile
coarse = {coarse!r}
program = {program!r}
kept = []
def coarser(design):
    if isinstance(design, dict) and "gear_pair" in design:
        design["resolution"] = design.get("resolution", {{}}) | coarse
    return design
def argument(word):
    if not word.endswith(".json") or not os.path.isfile(word):
        return word
    try:
        design = coarser(json.load(open(word, encoding="utf-8")))
    except ValueError:
        return word
    file = tempfile.NamedTemporaryFile("w", suffix=".json", delete=False)
    json.dump(design, file)
    file.close()
    kept.append(file.name)
    return file.name
words = [argument(word) for word in sys.argv[1:]]
if words[:1] in (["serve"], ["verify"], ["stage"]):
    os.execv(program, [program, *words])
example = words[:1] == ["example"] and len(words) == 2
done = subprocess.run([program, *words], stdout=subprocess.PIPE if example else None)
if example and done.returncode == 0:
    print(json.dumps(coarser(json.loads(done.stdout)), indent=2))
for file in kept:
    os.remove(file)
sys.exit(done.returncode)
'''


def script_of(text, folder):
    """The document's blocks as one shell script that says on descriptor 3 which block begins; how many there are."""
    parts, count = ["set -eu"], 0
    for kind, block in re.findall(r"(?ms)^```(\w+)[^\n]*\n(.*?)^```$", text):
        if kind not in ("sh", "python"):
            continue
        count += 1
        parts.append(f"echo {count} >&3")
        if kind == "python":
            path = folder / f"block-{count}.py"
            path.write_text(block, encoding="utf-8")
            block = f"python3 {path}\n"
        parts.append(block)
    return "\n".join(parts) + "\nexit 0\n", count


def run(document):
    text = (SOURCES / document).read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "bin").mkdir()
        (folder / "home").mkdir()
        (folder / "work").mkdir()
        front = folder / "bin" / "easeoff"
        front.write_text(FRONT.format(coarse=COARSE, program=str(PROGRAM)), encoding="utf-8")
        front.chmod(0o755)
        script, count = script_of(text, folder)
        (folder / "script").write_text(script, encoding="utf-8")
        environment = os.environ | {
            "PATH": f"{folder / 'bin'}:{os.environ['PATH']}",
            "HOME": str(folder / "home"),
            "PYTHONPATH": str(SOURCES / "clients" / "python"),
        }
        for leftover in ("EASEOFF_DATA", "XDG_DATA_HOME", "XDG_CACHE_HOME"):
            environment.pop(leftover, None)
        (folder / "steps").touch()
        with open(folder / "out", "w", encoding="utf-8") as out:
            # In a session of its own, so that a server that a text left running goes with it.
            shell = subprocess.Popen(
                ["sh", "-c", 'exec 3>>"$1"; . "$2"', "sh", str(folder / "steps"), str(folder / "script")],
                cwd=folder / "work",
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                status = shell.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                status = "none in time"
            left = not ends_soon(shell.pid)
            if left:
                os.killpg(shell.pid, signal.SIGKILL)
        reached = (folder / "steps").read_text(encoding="utf-8").split()
        last = (folder / "out").read_text(encoding="utf-8", errors="replace").splitlines()[-12:]
        return count, status, reached[-1] if reached else "0", last, left


def ends_soon(group):
    """What a text started and told to stop has some seconds for it."""
    for _ in range(100):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


def main():
    failed = 0
    for number, document in enumerate(DOCUMENTS, 1):
        count, status, block, last, left = run(document)
        good = status == 0 and count > 0 and not left
        failed += not good
        print("ok" if good else "not ok", number, "-", f"{document}: {count} blocks of commands")
        if not good:
            print(f"# block {block} of {count}: status {status}{', something was left running' if left else ''}")
            print("\n".join("# " + line for line in last))
    print(f"1..{len(DOCUMENTS)}")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())

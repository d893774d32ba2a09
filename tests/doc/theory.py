#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The theory manual against the source and the program.

Each numbered equation of doc/theory/ names the function that computes it:

    $$ ... \\tag{C1} $$

    > (C1): `load_points()` in src/contact/loaded.c.

and that function, or the comment above it, says "theory (C1)". Nothing else in the source may say "theory (X)" of an
equation that is not there. Each function that a chapter names is defined in the source.

Worked examples are blocks of the kind `worked`, for people to follow with a calculator:

    ```worked design paper
    m_t = 6 / cos(24*deg) = 6.567818      # geometry.transverse_module_mm
    ```

The number must be the value of the expression, and the program's number at the place, both rounded to its digits. A
name without an expression takes the program's number. After `worked`: `design EXAMPLE`, `analyze EXAMPLE` (on a coarse
mesh), or `stage NAME`, whose input is the json block before it."""

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

SOURCES = Path(os.environ.get("SOURCES", "."))
PROGRAM = os.environ.get("EASEOFF", "./easeoff")
COARSE = {
    "body": "sector",
    "sector_teeth": 3,
    "layers": 6,
    "flank_rows": 6,
    "fillet_elements": 8,
    "positions": 32,
    "cells_per_line": 16,
    "te_harmonics": 12,
}
MATHEMATICS = {name: getattr(math, name) for name in "sin cos tan asin acos atan sqrt hypot log exp pi".split()}
MATHEMATICS |= {"deg": math.pi / 180}
LABEL = r"\(([A-Z]+\d+)\)"
LABELS = r"((?:\([A-Z]+\d+\) ?)+)"
count = failures = 0


def result(good, what, notes=()):
    global count, failures
    count += 1
    failures += not good
    for note in notes:
        print("#", note)
    print("ok" if good else "not ok", count, "-", what)


def chapters():
    return sorted((SOURCES / "doc" / "theory").glob("*.md"))


def read_equations():
    """{label: (chapter, function or None, file or None)}"""
    found, faults = {}, []
    for chapter in chapters():
        text = chapter.read_text(encoding="utf-8")
        for label in re.findall(r"\\tag\{([A-Z]+\d+)\}", text):
            if label in found:
                faults.append(f"{chapter.name}: ({label}) is numbered twice")
            found[label] = (chapter.name, None, None)
        for labels, function, path in re.findall(rf"(?m)^> {LABELS}: `(\w+)\(\)` in (src/\S+?\.[ch])\b", text):
            for label in re.findall(LABEL, labels):
                if label not in found:
                    faults.append(f"{chapter.name}: names a function for ({label}), which is not numbered")
                found[label] = (chapter.name, function, path)
    return found, faults


def body_of(function, text):
    """A function's definition in C text laid out as this source is, with the comment above it."""
    match = re.search(rf"(?m)^(?!\s|#|/|return)[^\n;]*\b{function}\([^;{{]*\)\n\{{\n(.*?)^\}}", text, re.S)
    if not match:
        return None
    return text[max(0, text.rfind("\n\n", 0, match.start())):match.end()]


def check_citations():
    equations, faults = read_equations()
    result(len(equations) >= 60 and not faults, f"{len(equations)} equations are numbered, each once", faults)
    sources = {path: path.read_text(encoding="utf-8") for path in (SOURCES / "src").rglob("*.[ch]")}
    for chapter in chapters():
        faults = []
        for label, (where, function, path) in equations.items():
            if where != chapter.name:
                continue
            text = sources.get(SOURCES / path) if path else None
            body = body_of(function, text) if text else None
            if not function:
                faults.append(f"({label}) names no function")
            elif body is None:
                faults.append(f"({label}): {path} defines no {function}()")
            elif not any(f"({label})" in run for run in re.findall(rf"theory {LABELS}", body)):
                faults.append(f"({label}): {function}() in {path} does not say \"theory ({label})\"")
        result(not faults, f"{chapter.name}: each equation is named by the function that computes it", faults)
    faults = []
    for path, text in sources.items():
        for run in re.findall(rf"theory {LABELS}", text):
            unknown = [label for label in re.findall(LABEL, run) if label not in equations]
            faults += [f"{path.relative_to(SOURCES)} cites ({label})" for label in unknown]
    result(not faults, "the source cites no equation that is not there", faults)
    check_names(sources.values())


def check_names(sources):
    defined = {name for text in sources for name in re.findall(r"(?m)^(?!\s|#|/)[^\n;=]*?\b(\w+)\([^;{]*\)\n\{", text)}
    faults = []
    for chapter in chapters():
        named = re.findall(r"`(\w+)\(\)`", chapter.read_text(encoding="utf-8"))
        faults += [f"{chapter.name} names {name}()" for name in named if name not in defined]
    result(not faults, "each function that a chapter names is defined in the source", faults)


def pick(document, place):
    for key in re.findall(r"[^.\[\]]+", place):
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document


class Program:
    def __init__(self):
        self.known = {}

    def run(self, arguments, text=""):
        done = subprocess.run([PROGRAM, *arguments], input=text, capture_output=True, text=True, check=False)
        if done.returncode:
            raise ValueError(done.stderr.strip())
        return done.stdout

    def answer(self, words, text):
        key = (tuple(words), text if words[0] == "stage" else "")
        if key not in self.known:
            if words[0] == "stage":
                answer = self.run(["stage", words[1], "-"], text)
            else:
                design = json.loads(self.run(["example", words[1]]))
                if words[0] == "analyze":
                    design["resolution"] |= COARSE
                options = ["--json", "--no-cache"] if words[0] == "analyze" else ["--json"]
                answer = self.run([words[0], "-", *options], json.dumps(design))
            self.known[key] = json.loads(answer)
        return self.known[key]


def agrees(value, printed):
    """Whether a value is the printed one, to its last digit."""
    digits = re.fullmatch(r"-?\d*\.?(\d*)(?:e([+-]?\d+))?", printed)
    step = 10.0 ** (int(digits[2] or 0) - len(digits[1]))
    return abs(value - float(printed)) <= 0.5000001 * step + 1e-12 * abs(value)


def check_line(line, names, document):
    """None, or what is wrong with a line of a worked example."""
    statement, _, place = (part.strip() for part in line.partition("#"))
    name, *parts = (part.strip() for part in re.split(r"(?<![=<>])=(?!=)", statement))
    printed = parts[-1]
    if not re.fullmatch(r"-?\d*\.?\d+(?:e[+-]?\d+)?", printed):
        return f"{line}: no number stands at the end"
    value = float(printed)
    if len(parts) > 1:
        value = eval(parts[0], {"__builtins__": {}}, names)  # the repository's own text
    names[name] = value
    if not agrees(value, printed):
        return f"{line}: by hand it is {value:.9g}"
    if place:
        computed = pick(document, place)
        if not agrees(computed, printed):
            return f"{line}: the program has {computed:.9g}"
        if len(parts) == 1:
            names[name] = computed
    return None


def check_examples():
    program = Program()
    for chapter in chapters():
        text, faults, lines, given = chapter.read_text(encoding="utf-8"), [], 0, ""
        for kind, block in re.findall(r"(?ms)^```(\S[^\n]*)\n(.*?)^```", text):
            if kind == "json":
                given = block
            if not kind.startswith("worked "):
                continue
            names = dict(MATHEMATICS)
            try:
                document = program.answer(kind.split()[1:], given)
            except (ValueError, KeyError) as error:
                faults.append(f"{kind}: {error}")
                continue
            for line in filter(None, block.splitlines()):
                lines += 1
                try:
                    fault = check_line(line, names, document)
                except (KeyError, IndexError, TypeError, NameError, SyntaxError, ZeroDivisionError) as error:
                    fault = f"{line}: {error!r}"
                faults += [fault] if fault else []
        if lines or faults:
            result(not faults, f"{chapter.name}: {lines} lines of worked examples, by hand and by the program", faults)


def main():
    check_citations()
    check_examples()
    print(f"1..{count}")
    return failures > 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The validation book: validation.py PROGRAM CASES FILE [paper] writes the parts of FILE that stand between marks
(`make validation`), or the comparison with the paper alone.

Every number comes from `easeoff verify --json` and `easeoff analyze --json` of this program; the expected ones from the
case files, whose sources are named. What the words around them say is written by hand."""

import json
import statistics
import subprocess
import sys
from pathlib import Path

NEAR = 0.8  # of the tolerance: what is listed among the disagreements
# What a file's numbers come from, where the file itself has no line for it.
ORIGIN = {
    "calculix.json": "contact of the same bricks by CalculiX, three-dimensional finite elements",
    "contact.json": "an independent computation of geometry, gaps, loaded contact, impact; ISO 6336 formulae; CalculiX",
    "deviations.json": "an independent computation: gap by search over generated sections, closed-form flexibility",
    "dynamics.json": "an independent model of the twelve freedoms; published folds of one freedom with backlash",
    "encoder.json": "recordings made from formulae with known transmission error",
    "evaluation.json": "an independent computation of the whole chain",
    "gear-public.json": "gears as drawings and public reports state them",
    "optimizer.json": "an independent run of the paper's algorithm, generation by generation",
    "rating.json": "published rating reports, row by row",
    "ring.json": "an independent finite-element model of whole bodies",
    "standards.json": "ISO/TR 6336-30, FZG reports, closed forms",
    "exchange/cases.json": "files in the formats of other programs",
    "rig-public/cases.json": "recordings in the shapes people report, with known truth",
}
PAPER = {"unmodified": ("paper", (26.13, 31.89, 35.27)), "case A": ("paper-case-a", (21.17, 23.21, 31.01)),
         "case B": ("paper-case-b", (22.43, 23.87, 30.65))}
PAPER_SOURCE = "Journal of Vibroengineering 18 (2016), doi:10.21595/jve.2016.17179, section 5.4"


def run(program, arguments, text=""):
    """verify ends with 1 where a number is out of tolerance, and prints all the same."""
    done = subprocess.run([program, *arguments], input=text, capture_output=True, text=True, check=False)
    if done.returncode > 1 or not done.stdout:
        raise SystemExit(f"{arguments}: {done.stderr}")
    return json.loads(done.stdout)


def number(value):
    return f"{value:.6g}" if isinstance(value, (int, float)) and not isinstance(value, bool) else str(value)


def table(heads, rows):
    lines = ["| " + " | ".join(cells) + " |" for cells in [heads, *rows]]
    lines.insert(1, "|" + "---|" * len(heads))
    return "\n".join(lines) + "\n"


def share(check):
    """What a check takes of its tolerance; None where that has no meaning (exact counts and flags)."""
    if not check["tolerance"] or check["value"] is None:
        return None
    return abs(check["value"] - check["expected"]) / check["tolerance"]


def relative(check):
    """Deviation in per cent of what is expected; None of zero."""
    return 100 * (check["value"] / check["expected"] - 1) if check["expected"] and check["value"] is not None else None


def shown(value, form):
    return "-" if value is None else format(value, form)


def shown_deviation(value, form):
    """In per cent; what is below this differs from machine to machine."""
    return "rounding" if value is not None and 0 < abs(value) < 1e-10 else shown(value, form)


def blocks_of(name, report):
    rows = []
    for block in report["blocks"]:
        checks = [c for c in report["checks"] if c["pointer"].split("/")[1] == block]
        shares = [s for s in map(share, checks) if s is not None]
        deviations = [abs(r) for r in map(relative, checks) if r is not None]
        median = statistics.median(deviations) if deviations else None
        largest = f"{max(shares):.2f}" if shares else "exact"
        out = sum(not c["pass"] for c in checks)
        rows.append([name, block, str(len(checks)), str(out), shown_deviation(median, ".2g"), largest])
    return rows


def disagreements(reports):
    rows = []
    for name, report in reports.items():
        for check in report["checks"]:
            taken = share(check)
            if not check["pass"] or (taken or 0) > NEAR:
                cells = [f"{name}: {check['case'].split(': ', 1)[-1]}", check["quantity"].replace("|", "/")]
                cells += [number(check["expected"]), number(check["value"]), shown_deviation(relative(check), "+.2g")]
                cells += [shown(taken, ".2f"), "" if check["pass"] else "**out**"]
                rows.append((-(taken or 99), cells))
    rows.sort(key=lambda row: (row[1][-1] == "", row[0]))
    return [row for _, row in rows]


def published(reports, cases):
    """Rows whose expected number somebody printed, by source."""
    sources = {}
    for name in ("rating.json", "gear-public.json"):
        entries = json.loads((cases / name).read_text(encoding="utf-8"))
        entries = entries.get("rows", entries.get("cases"))
        for check in reports[name]["checks"]:
            place = check["pointer"].split("/")
            if check["quantity"].endswith((".formula", ": length")) or not check["quantity"].startswith("expected."):
                continue
            entry = entries[int(place[2])]
            quantity = check["quantity"].removeprefix("expected.").removesuffix(".printed")
            values = [number(check["expected"]), number(check["value"]), shown_deviation(relative(check), "+.2g")]
            sources.setdefault(entry["source"], []).append([entry["id"], quantity, *values])
    for check in reports["standards.json"]["checks"]:
        block, row = check["case"].split(": ", 1)[0], check["case"].split(": ", 1)[-1]
        values = [number(check["expected"]), number(check["value"]), shown_deviation(relative(check), "+.2g")]
        sources.setdefault(f"standards.json: {block}", []).append([row, check["quantity"], *values])
    parts = []
    for source in sorted(sources):
        rows = sources[source]
        parts.append(f"### {source}\n\n" + table(["row", "quantity", "published", "Easeoff", "deviation, %"], rows))
    return "\n".join(parts)


def paper(program):
    torque, laws, ours, rows = (621, 828, 1035), ("tangent", "secant"), {}, []
    for label, (example, _) in PAPER.items():
        for law in laws:
            design = run(program, ["example", example])
            design["resolution"]["mesh_law"] = law
            result = run(program, ["analyze", "-", "--json"], json.dumps(design))
            ours[label, law] = [case["vibration"]["rms_m_per_s2"]["normal"] for case in result["load_cases"]]
    for label, (_, printed) in PAPER.items():
        for k, load in enumerate(torque):
            rows.append([f"RMS, {label}, {load} N m", f"{printed[k]:.2f} m/s2"])
            for law in laws:
                value = ours[label, law][k]
                rows[-1] += [f"{value:.2f} m/s2", f"{100 * (value / printed[k] - 1):+.0f} %"]
    for label in ("case A", "case B"):
        for k, load in enumerate(torque):
            theirs = 100 * (1 - PAPER[label][1][k] / PAPER["unmodified"][1][k])
            rows.append([f"reduction, {label}, {load} N m", f"{theirs:.1f} %"])
            for law in laws:
                own = 100 * (1 - ours[label, law][k] / ours["unmodified", law][k])
                rows[-1] += [f"{own:.1f} %", f"{own - theirs:+.0f} points"]
    return (f"Source: {PAPER_SOURCE}. The tangent law is the default here, the secant law the paper's.\n\n"
            + table(["quantity", "paper", "tangent law", "difference", "secant law", "difference"], rows))


def put(text, mark, part):
    before, opening, rest = text.partition(f"<!-- {mark} -->\n")
    if not opening:
        raise SystemExit(f"no mark {mark}")
    return before + opening + part + "<!-- end -->" + rest.partition("<!-- end -->")[2]


def main():
    program, cases, book = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    if sys.argv[4:] == ["paper"]:
        book.write_text(put(book.read_text(encoding="utf-8"), "paper", paper(program)), encoding="utf-8")
        return
    reports = {}
    for name in ORIGIN:
        print(name, flush=True)
        reports[name] = run(program, ["verify", str(cases / name), "--json"])["files"][0]
    checks = [check for report in reports.values() for check in report["checks"]]
    text = book.read_text(encoding="utf-8")
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    out = sum(not check["pass"] for check in checks)
    summary = f"{version}: {len(checks)} numbers compared in {len(reports)} files, {out} out of tolerance.\n\n"
    origins = table(["file", "its numbers come from"], [list(row) for row in ORIGIN.items()])
    text = put(text, "summary", summary + origins)
    heads = ["case", "quantity", "expected", "Easeoff", "deviation, %", "of tolerance", ""]
    text = put(text, "disagreements", table(heads, disagreements(reports)))
    text = put(text, "paper", paper(program))
    heads = ["file", "block", "numbers", "out", "median deviation, %", "largest, of tolerance"]
    rows = [row for name, report in reports.items() for row in blocks_of(name, report)]
    text = put(text, "cases", table(heads, rows))
    text = put(text, "published", published(reports, cases))
    book.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

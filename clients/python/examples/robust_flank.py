#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A flank that stays quiet when it is made: a nominal search, a search that sees the scatter, and both as pairs are made.

usage: robust_flank.py DESIGN.json [ADDRESS] [EVALUATIONS] [PAIRS]
"""

import json
import sys

from easeoff import Client

SEEN = 8  # pairs as they are made that each candidate of the second search is evaluated on


def show(job):
    progress = job["progress"]
    best = f"{job['best']['J']:.4f}" if job["best"] else "none"
    print(f"{job['state']:10} {progress['true_evaluations'] or 0:5} evaluations, best J {best}", file=sys.stderr)


def search(client, design, evaluations):
    """The design with the flank that a search finds."""
    order = {**design, "optimization": {**design.get("optimization", {}), "true_evaluations": evaluations}}
    found = client.optimize(order, progress=show)
    return {**design, "modification": found["best"]["modification"]}


def swing_of(client, design, pairs):
    """Peak-to-peak transmission error of the first load case in um: as drawn, and below which 95 of 100 pairs stay."""
    spread = client.tolerance(design, pairs=pairs)
    output = next(row for row in spread["outputs"] if row["key"] == "peak_to_peak_um")
    return output["nominal"], next(p["value"] for p in output["percentiles"] if p["percent"] == 95)


def main(path, address="http://127.0.0.1:8080", evaluations="60", pairs="64"):
    client = Client(address)
    with open(path, encoding="utf-8") as file:
        design = json.load(file)
    plain = {key: value for key, value in design.items() if key != "objective"}
    robust = {**plain, "objective": {"robust": "percentile", "robust_percent": 90, "scatter_pairs": SEEN}}
    flanks = {"nominal": search(client, plain, int(evaluations)), "robust": search(client, robust, int(evaluations))}
    for name, flank in flanks.items():
        drawn, most = swing_of(client, {**flank, "objective": {}}, int(pairs))
        print(f"{name:8} optimum: {drawn:.3f} um as drawn, 95 of 100 pairs as made below {most:.3f} um")
    with open("robust.json", "w", encoding="utf-8") as file:
        json.dump(flanks["robust"], file, indent=1)


if __name__ == "__main__":
    main(*sys.argv[1:])

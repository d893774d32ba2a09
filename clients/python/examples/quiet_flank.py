#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""From a gear pair to a quieter flank: search, compare with the unmodified pair, write the curves as CSV.

usage: quiet_flank.py DESIGN.json [ADDRESS] [EVALUATIONS]
"""

import csv
import json
import sys

from easeoff import Client


def show(job):
    progress = job["progress"]
    best = job["best"]["J"] if job["best"] else None
    print(f"{job['state']:10} {progress['true_evaluations'] or 0:5} evaluations, best J {best}", file=sys.stderr)


def main(path, address="http://127.0.0.1:8080", evaluations="200"):
    client = Client(address)
    with open(path, encoding="utf-8") as file:
        design = json.load(file)
    design.setdefault("optimization", {})["true_evaluations"] = int(evaluations)
    found = client.optimize(design, progress=show)
    quiet = client.analyze({**design, "modification": found["best"]["modification"]})
    plain = client.analyze({key: value for key, value in design.items() if key != "modification"})
    for before, after in zip(plain["load_cases"], quiet["load_cases"]):
        print(
            f"{after['torque_Nm']:g} N m, {after['speed_rpm']:g} rpm: transmission error "
            f"{before['lte']['peak_to_peak_um']:.3f} -> {after['lte']['peak_to_peak_um']:.3f} um peak to peak"
        )
    with open("transmission_error.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["position"] + [f"{case['torque_Nm']:g} N m, um" for case in quiet["load_cases"]])
        curves = [case["lte"]["pair_um"] for case in quiet["load_cases"]]
        table.writerows(zip(quiet["load_cases"][0]["position"], *curves))


if __name__ == "__main__":
    main(*sys.argv[1:])

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each assumption is worth: the paper's pair with case A, one thing changed at a time.

effects.py PROGRAM FILE writes the table between the marks of doc/theory/assumptions.md (`make effects`; a minute or two
of finite elements)."""

import copy
import json
import subprocess
import sys
from pathlib import Path

CHANGES = [
    ("gear_pair.fillet_radius_coefficient", 0.25, "fillet radius 0.25 m_n in place of 0.38"),
    ("gear_pair.gear_bore_mm", 200, "gear bore 200 mm in place of 90"),
    ("material.poissons_ratio", 0.28, "Poisson's ratio 0.28 in place of 0.3"),
    ("resolution.body", "sector", "bodies as sectors of five teeth with held cut faces"),
    ("resolution.neighbour_coupling", False, "no elastic coupling between neighbouring pairs"),
    ("resolution.tip_edge_contact", False, "no contact of tip edges"),
    ("resolution.mesh_law", "secant", "secant mesh law, as in the paper"),
    ("resolution.mesh_law", "table", "mesh law as a table over loads"),
    ("resolution.te_harmonics", 24, "24 mesh harmonics of TE and stiffness in place of 16"),
    ("resolution.impact_in_dynamics", "paper", "entering impacts act in the vibration, as in the paper"),
    ("resolution.impact_patch_mm", 10, "impact patch 10 mm in place of 5"),
    ("alignment.shaft_angle_error_in_plane_deg", 0, "aligned, in place of 0.1 deg in the plane of the axes"),
    ("alignment.pinion_axial", "fixed", "pinion held along its axis"),
    ("shafts.enabled", True, "elastic shafts and bodies"),
    ("supports.mesh_damping_ratio", 0.035, "half the mesh damping"),
    ("supports.pinion_bearing_stiffness_N_per_um", 400, "half the pinion's bearing stiffness"),
    ("supports.torsional_coupling", "on", "ends coupled by the groove's torsion"),
    ("supports.driver_inertia_kg_m2", (0.05, 100000), "a driver of 0.05 kg m2 behind a coupling of 100 kN m/rad"),
]


def output(command, text=None):
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


def analyse(program, design):
    case = json.loads(output([program, "analyze", "-", "--json"], json.dumps(design)))["load_cases"][1]
    return {
        "mean TE": case["lte"]["mean_um"],
        "PPLTE": case["lte"]["peak_to_peak_um"],
        "impact": max(case["impact"][end]["general_force_N"] for end in ("left", "right")),
        "root stress": case["root_stress"]["pinion"]["max_MPa"],
        "RMS": case["vibration"]["rms_m_per_s2"]["normal"],
    }


def change(design, place, value):
    room, key = place.split(".")
    changed = copy.deepcopy(design)
    if isinstance(value, tuple):
        changed[room]["driver_inertia_kg_m2"], changed[room]["driver_stiffness_Nm_per_rad"] = value
    else:
        changed[room][key] = value
    return changed


def main():
    program, path = sys.argv[1], Path(sys.argv[2])
    design = json.loads(output([program, "example", "paper-case-a"]))
    stated = analyse(program, design)
    units = {"mean TE": "um", "PPLTE": "um", "impact": "N", "root stress": "MPa", "RMS": "m/s2"}
    rows = ["| changed | " + " | ".join(f"{name}, %" for name in units) + " |", "|---|" + "---|" * len(units),
            "| as stated | " + " | ".join(f"{stated[name]:.4g} {unit}" for name, unit in units.items()) + " |"]
    for place, value, words in CHANGES:
        now = analyse(program, change(design, place, value))
        cells = [f"{100 * (now[name] / stated[name] - 1):+.1f}" for name in units]
        rows.append(f"| {words} | " + " | ".join("0" if cell in ("+0.0", "-0.0") else cell for cell in cells) + " |")
        print(rows[-1], flush=True)
    before, _, rest = path.read_text(encoding="utf-8").partition("<!-- effects -->\n")
    _, _, after = rest.partition("<!-- end -->")
    path.write_text(before + "<!-- effects -->\n" + "\n".join(rows) + "\n<!-- end -->" + after, encoding="utf-8")


if __name__ == "__main__":
    main()

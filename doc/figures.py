#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of the manuals, drawn from the program's own numbers: figures.py PROGRAM FOLDER [NAME...]

`make figures` writes all of them; the check draws those that need no finite elements again and compares
(tests/doc/figures.sh)."""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

INK, FAINT, BLUE, ORANGE, GREEN, GREY = "#1f2933", "#c4ccd4", "#1d5fa6", "#c2571a", "#2d7a46", "#7b8794"
PAIR = {"pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55}


class Program:
    def __init__(self, path):
        self.path, self.kept = path, {}

    def run(self, arguments, document=None):
        key = (tuple(arguments), json.dumps(document))
        if key not in self.kept:
            text = json.dumps(document) if document else ""
            done = subprocess.run([self.path, *arguments], input=text, capture_output=True, text=True, check=True)
            self.kept[key] = json.loads(done.stdout)
        return self.kept[key]

    def example(self, name):
        return self.run(["example", name])

    def geometry(self):
        return self.run(["design", "-", "--json"], self.example("paper"))["geometry"]

    def analysis(self, name):
        return self.run(["analyze", "-", "--json"], self.example(name))


class Sheet:
    """An SVG picture; with axes(), data coordinates."""

    def __init__(self, width, height, title):
        self.size, self.title, self.parts = (width, height), title, []
        self.box = (0, 0, width, height)
        self.range = (0, width, 0, height)
        self.down = True

    def axes(self, box, x, y, down=False):
        self.box, self.range, self.down = box, (*x, *y), down

    def at(self, x, y):
        left, top, right, bottom = self.box
        low, high, below, above = self.range
        v = (y - below) / (above - below)
        return left + (x - low) / (high - low) * (right - left), top + (v if self.down else 1 - v) * (bottom - top)

    def line(self, points, colour=INK, width=1.5, dash="", close=False, fill="none"):
        places = " ".join(f"{'L' if i else 'M'}{x:.1f} {y:.1f}" for i, (x, y) in enumerate(self.at(*p) for p in points))
        end = "Z" if close else ""
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<path d="{places}{end}" fill="{fill}" stroke="{colour}" stroke-width="{width}"{dashes}/>')

    def circle(self, x, y, radius, colour=INK, width=1.5, fill="none"):
        """radius in the units of x."""
        px, py = self.at(x, y)
        size = abs(self.at(x + radius, y)[0] - px)
        look = f'fill="{fill}" stroke="{colour}" stroke-width="{width}"'
        self.parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{size:.1f}" {look}/>')

    def dot(self, x, y, colour=INK, size=3):
        px, py = self.at(x, y)
        self.parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{size}" fill="{colour}"/>')

    def text(self, x, y, text, colour=INK, anchor="middle", shift=(0, 0), size=13, turn=0):
        px, py = self.at(x, y)
        px, py = px + shift[0], py + shift[1]
        turned = f' transform="rotate({turn} {px:.1f} {py:.1f})"' if turn else ""
        look = f'fill="{colour}" font-size="{size}" text-anchor="{anchor}"'
        self.parts.append(f'<text x="{px:.1f}" y="{py:.1f}" {look}{turned}>{text}</text>')

    def arrow(self, start, end, colour=INK, width=1.5):
        self.line([start, end], colour, width)
        (ax, ay), (bx, by) = self.at(*start), self.at(*end)
        angle = math.atan2(by - ay, bx - ax)
        tips = [(bx - 8 * math.cos(angle + turn), by - 8 * math.sin(angle + turn)) for turn in (0.35, -0.35)]
        places = "L".join(f"{x:.1f} {y:.1f}" for x, y in (tips[0], (bx, by), tips[1]))
        self.parts.append(f'<path d="M{places}Z" fill="{colour}"/>')

    def frame(self, x_label, y_label, x_ticks, y_ticks):
        low, high, below, above = self.range
        for x in x_ticks:
            self.line([(x, below), (x, above)], FAINT, 0.7)
            self.text(x, below, f"{x:g}", GREY, shift=(0, 16), size=12)
        for y in y_ticks:
            self.line([(low, y), (high, y)], FAINT, 0.7)
            self.text(low, y, f"{y:g}", GREY, "end", (-6, 4), 12)
        self.line([(low, below), (high, below), (high, above), (low, above)], GREY, 1, close=True)
        self.text((low + high) / 2, below, x_label, shift=(0, 34))
        self.text(low, (below + above) / 2, y_label, shift=(-44, 0), turn=-90)

    def save(self, folder, name):
        width, height = self.size
        size = f'width="{width}" height="{height}"'
        text = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" {size} role="img"'
            f' font-family="sans-serif"><title>{self.title}</title><rect {size} fill="#ffffff"/>\n'
            + "\n".join(self.parts)
            + "\n</svg>\n"
        )
        (Path(folder) / f"{name}.svg").write_text(text, encoding="utf-8")


def line_of_action(program):
    """The transverse section at the pitch point, to scale."""
    g = program.geometry()
    sheet = Sheet(640, 470, "Transverse section of the paper's pair at the pitch point")
    (r1, r2), (b1, b2), (a1, a2) = g["working_radius_mm"], g["base_radius_mm"], g["tip_radius_mm"]
    alpha = math.radians(g["working_pressure_angle_deg"])
    sheet.axes((20, 20, 620, 450), (-62, 62), (-44.43, 44.43))
    e = (math.cos(alpha), math.sin(alpha))

    def arc(centre, radius, colour, width, dash=""):
        angles = [i * math.pi / 180 for i in range(-180, 181)]
        points = [(radius * math.sin(t), centre + radius * math.cos(t)) for t in angles]
        inside = [p for p in points if abs(p[0]) < 61 and abs(p[1]) < 44]
        runs, last = [[]], None
        for p in inside:
            if last and math.dist(p, last) > 0.1 * radius:
                runs.append([])
            runs[-1].append(p)
            last = p
        for run in runs:
            if len(run) > 1:
                sheet.line(run, colour, width, dash)

    for centre, radii, colour in ((-r1, (r1, b1, a1), BLUE), (r2, (r2, b2, a2), ORANGE)):
        arc(centre, radii[0], colour, 1, "6 4")
        arc(centre, radii[1], colour, 1, "2 3")
        arc(centre, radii[2], colour, 1.6)
    t1, t2, s_a, s_e = *g["tangent_length_mm"], g["path_start_mm"], g["path_end_mm"]
    sheet.line([(-t1 * e[0], -t1 * e[1]), (t2 * e[0], t2 * e[1])], GREY, 1)
    sheet.line([(s_a * e[0], s_a * e[1]), (s_e * e[0], s_e * e[1])], GREEN, 3)
    places = [(-t1, "T1", (-14, 2)), (t2, "T2", (14, 2)), (s_a, "A", (2, 20)), (s_e, "E", (2, -10)), (0, "C", (12, 16))]
    for s, name, shift in places:
        sheet.dot(s * e[0], s * e[1], GREEN if name in "AE" else INK)
        sheet.text(s * e[0], s * e[1], name, shift=shift)
    sheet.arrow((17, 17 * e[1] / e[0] - 5), (26, 26 * e[1] / e[0] - 5), GREEN)
    sheet.text(27, 27 * e[1] / e[0] - 6, "s", GREEN, shift=(8, 4))
    sheet.text(0, -24, "pinion (drives)", BLUE)
    sheet.text(-60, 41, "gear", ORANGE, "start")
    sheet.text(60, -40, "full: tip, dashed: pitch, dotted: base circle; green: path of contact", GREY, "end", size=12)
    return sheet


def ends(program):
    """One herringbone member from above, from the stated widths and helix angle."""
    pair = program.example("paper")["gear_pair"]
    b, groove, beta = pair["face_width_mm"], pair["groove_width_mm"], math.radians(pair["helix_angle_deg"])
    module = pair["normal_module_mm"] / math.cos(beta)
    sheet = Sheet(640, 330, "A herringbone pinion from above")
    reach = groove / 2 + b
    sheet.axes((20, 20, 620, 290), (-105, 105), (-47.25, 47.25))
    for side in (-1, 1):
        inner, outer = side * groove / 2, side * reach
        sheet.line([(inner, -35), (outer, -35), (outer, 35), (inner, 35)], INK, 1.5, close=True)
        pitch = math.pi * module
        for k in range(-4, 5):
            middle = k * pitch
            lean = math.tan(beta) * b / 2
            points = [(inner, middle + lean), (outer, middle - lean)]
            if all(abs(y) < 35 for _, y in points):
                sheet.line(points, BLUE, 1)
        sheet.arrow(((inner + outer) / 2, 41), ((inner + outer) / 2 + side * 18, 41), GREEN)
        sheet.text((inner + outer) / 2 + side * 22, 41, "&#951;", GREEN, shift=(0, 4))
        sheet.text((inner + outer) / 2, -41, "left end" if side < 0 else "right end", shift=(0, 5))
        sheet.line([((inner + outer) / 2, -35), ((inner + outer) / 2, 41)], GREY, 0.8, "4 4")
        sheet.text(outer, -41, "meets first", GREY, "end" if side < 0 else "start", (side * 4, 0), 12)
    sheet.line([(-groove / 2, -27), (groove / 2, -27), (groove / 2, 27), (-groove / 2, 27)], GREY, 1, close=True)
    sheet.text(0, 0, "groove", GREY, shift=(0, 4))
    sheet.line([(-105, 0), (-reach, 0)], GREY, 1, "8 3 2 3")
    sheet.line([(reach, 0), (105, 0)], GREY, 1, "8 3 2 3")
    sheet.axes((0, 0, 640, 330), (0, 640), (0, 330), down=True)
    words = "the apex trails: outer face ends meet first, so &#951; points outwards on both ends"
    sheet.text(320, 318, words, GREY, size=12)
    return sheet


def plane_of_action(program):
    """The rectangle of contact of one end and the lines of one mesh position."""
    g = program.geometry()
    b, s_a, s_e, p = g["face_width_mm"], g["path_start_mm"], g["path_end_mm"], g["transverse_base_pitch_mm"]
    lean = math.tan(math.radians(g["base_helix_angle_deg"]))
    sheet = Sheet(640, 330, "Plane of action of one end")
    sheet.axes((90, 20, 610, 270), (s_a - 6, s_e + 6), (-34, 34))
    sheet.line([(s_a, -b / 2), (s_e, -b / 2), (s_e, b / 2), (s_a, b / 2)], INK, 1.5, close=True)
    for k in range(-3, 4):
        ends_of = []
        for eta in [-b / 2 + i * b / 200 for i in range(201)]:
            s = k * p + 2 + eta * lean
            if s_a <= s <= s_e:
                ends_of.append((s, eta))
        if ends_of:
            sheet.line([ends_of[0], ends_of[-1]], BLUE, 2.5)
            s, eta = ends_of[len(ends_of) // 2]
            sheet.text(s, eta, f"pair {k:+d}" if k else "pair 0", BLUE, "start", (8, 14))
    sheet.arrow((s_a - 4, -31), (s_a + 3, -31), GREEN)
    sheet.text(s_a + 4, -31, "s", GREEN, shift=(4, 4))
    sheet.arrow((s_a - 4, -31), (s_a - 4, -18), GREEN)
    sheet.text(s_a - 4, -17, "&#951;", GREEN, shift=(0, -6))
    sheet.text(s_a, b / 2, "A, gear's tip", shift=(0, -8))
    sheet.text(s_e, b / 2, "E, pinion's tip", shift=(0, -8))
    words = f"path of contact {s_e - s_a:.1f} mm, base pitch {p:.1f} mm, face width {b:g} mm"
    sheet.text((s_a + s_e) / 2, -b / 2, words, GREY, shift=(0, 36), size=12)
    return sheet


def flank_a(program):
    return program.example("paper-case-a")["modification"]


def modification(program):
    """Profile and lead of case A."""
    g = program.geometry()
    u = [g["rack_bottom_mm"] + (g["rack_top_mm"] - g["rack_bottom_mm"]) * i / 120 for i in range(121)]
    design = {"gear_pair": PAIR, "modification": flank_a(program)}
    profile = program.run(["stage", "modification", "-"], design | {"u_mm": u})["profile_um"]
    eta = [-27.5 + 55 * i / 80 for i in range(81)]
    lead = program.run(["stage", "modification", "-"], design | {"u_mm": [0] * 81, "eta_mm": eta})["lead_um"]
    sheet = Sheet(640, 300, "What case A takes off the pinion")
    charts = [
        (70, u, profile, "u along the rack, mm", range(-4, 6, 2)),
        (390, eta, lead, "&#951;, mm", range(-20, 30, 10)),
    ]
    for left, x, y, label, ticks in charts:
        sheet.axes((left, 30, left + 235, 245), (x[0], x[-1]), (0, 20))
        sheet.frame(label, "taken off, &#181;m", ticks, range(0, 21, 5))
        sheet.line(list(zip(x, y)), BLUE, 2)
    sheet.axes((0, 0, 640, 300), (0, 640), (0, 300), down=True)
    sheet.text(187, 20, "profile", GREY)
    sheet.text(507, 20, "lead", GREY)
    return sheet


def slice_gap(program):
    """Exact slice gap of case A beside relief laid on the involute."""
    g = program.geometry()
    low, high = g["path_start_mm"], g["path_end_mm"]
    phase = [low + (high - low) * i / 160 for i in range(161)]
    design = {"gear_pair": PAIR, "modification": flank_a(program), "alignment": {"shaft_angle_error_in_plane_deg": 0}}
    exact = program.run(["stage", "gap", "-"], design | {"phase_mm": phase})["slice_gap_um"]
    laid_on = {"gear_pair": PAIR, "modification": flank_a(program), "s_mm": phase}
    laid = program.run(["stage", "modification", "-"], laid_on)["profile_um"]
    sheet = Sheet(640, 300, "Slice gap of case A")
    sheet.axes((70, 20, 610, 245), (low, high), (0, 20))
    sheet.frame("phase c along the path of contact, mm", "gap, &#181;m", range(-10, 11, 5), range(0, 21, 5))
    sheet.line(list(zip(phase, laid)), ORANGE, 1.5, "6 4")
    sheet.line(list(zip(phase, exact)), BLUE, 2)
    sheet.text(-11.5, 16, "relief laid on the involute", ORANGE, "start")
    sheet.text(-13.9, 3, "exact", BLUE, "start")
    return sheet


def lumped_model(program):
    """Masses and springs of the dynamic model; stiffnesses as derived for the paper's pair."""
    law = {"kind": "fourier", "mean_N_per_um": 1100, "cosine_N_per_um": [0], "sine_N_per_um": [0]}
    running = {"torque_Nm": 828, "speed_rpm": 2000, "pinion_teeth": 17, "harmonics": 2}
    p = program.run(["stage", "dynamics", "-"], {"gear_pair": PAIR, "law": law} | running)["params"]
    sheet = Sheet(640, 380, "The lumped model")
    sheet.axes((0, 0, 640, 380), (0, 640), (0, 380), down=True)

    def body(x, y, name, colour):
        corners = [(x - 60, y - 28), (x + 60, y - 28), (x + 60, y + 28), (x - 60, y + 28)]
        sheet.line(corners, colour, 2, close=True, fill="#f5f7fa")
        sheet.text(x, y, name, colour, shift=(0, 5))

    def spring(start, end, label, shift, colour=GREY):
        (ax, ay), (bx, by) = start, end
        length, turns = math.dist(start, end), 6
        nx, ny = -(by - ay) / length, (bx - ax) / length
        points = [start]
        for i in range(2 * turns + 1):
            t, side = 0.2 + 0.6 * i / (2 * turns), 0 if i in (0, 2 * turns) else 5 if i % 2 else -5
            points.append((ax + t * (bx - ax) + side * nx, ay + t * (by - ay) + side * ny))
        sheet.line([*points, end], colour, 1.4)
        sheet.text((ax + bx) / 2, (ay + by) / 2, label, colour, "start" if shift[0] > 0 else "middle", shift, 12)

    for x, side in ((190, "left"), (450, "right")):
        body(x, 110, f"pinion {side}", BLUE)
        body(x, 270, f"gear {side}", ORANGE)
        spring((x, 138), (x, 242), "mesh X" + ("&#8321;" if side == "left" else "&#8322;"), (12, 4), GREEN)
        spring((x, 82), (x, 34), f"k_py {p['kpy'] / 1e6:.0f} N/&#181;m", (12, 4))
        spring((x, 298), (x, 346), f"k_gy {p['kgy'] / 1e6:.0f} N/&#181;m", (12, 4))
        for y in (34, 346):
            sheet.line([(x - 22, y), (x + 22, y)], GREY, 2)
    spring((250, 110), (390, 110), f"k_pz {p['kpz'] / 1e9:.1f} kN/&#181;m", (0, -14))
    spring((250, 270), (390, 270), f"k_gz {p['kgz'] / 1e9:.0f} kN/&#181;m", (0, -14))
    spring((130, 270), (50, 270), f"k_gjz {p['kg1z'] / 1e6:.0f} N/&#181;m", (0, -14))
    spring((510, 270), (590, 270), "", (0, -14))
    for x in (50, 590):
        sheet.line([(x, 248), (x, 292)], GREY, 2)
    sheet.text(320, 195, "each body: y, z, &#952;", GREY)
    words = "groove springs couple the ends; torsion of the groove where asked for or where ends differ"
    sheet.text(320, 372, words, GREY, size=12)
    return sheet


def transmission_error(program):
    """Loaded transmission error of the unmodified pair and case A at three torques."""
    sheet = Sheet(640, 320, "Loaded transmission error over one mesh cycle")
    sheet.axes((70, 20, 610, 265), (0, 1), (-1.2, 1.2))
    sheet.frame("mesh position", "TE less its mean, &#181;m", (0, 0.25, 0.5, 0.75, 1), (-1, -0.5, 0, 0.5, 1))
    for name, colour, label in (("paper", GREY, "unmodified"), ("paper-case-a", BLUE, "case A")):
        for case, dash in zip(program.analysis(name)["load_cases"], ("2 3", "", "7 4")):
            values = case["lte"]["pair_um"]
            values = [v - case["lte"]["mean_um"] for v in values + values[:1]]
            sheet.line([(i / (len(values) - 1), v) for i, v in enumerate(values)], colour, 2, dash)
    words = "grey: unmodified, blue: case A; dotted 621, full 828, dashed 1035 N m"
    sheet.text(0.03, 1.02, words, GREY, "start", size=12)
    return sheet


def vibration(program):
    """Mesh orders of the normal acceleration at 828 N m."""
    sheet = Sheet(640, 300, "Mesh orders of the vibration")
    sheet.axes((70, 20, 610, 245), (0.4, 12.6), (0, 80))
    sheet.frame("mesh order", "amplitude, m/s&#178;", range(1, 13), range(0, 81, 20))
    for name, colour, shift in (("paper", GREY, -0.16), ("paper-case-a", BLUE, 0.16)):
        orders = program.analysis(name)["load_cases"][1]["vibration"]["orders_normal_m_per_s2"]
        for k in range(1, 13):
            sheet.line([(k + shift, 0), (k + shift, min(80, orders[k]))], colour, 9)
    sheet.text(12.4, 72, "grey: unmodified, blue: case A; 828 N m, 2000 rpm", GREY, "end", size=12)
    return sheet


def contact_pattern(program):
    """Clearance under no load, and where the flank is marked, of the left end of case A."""
    contact = program.analysis("paper-case-a")["unloaded_contact"]
    s, eta, clearance = contact["s_mm"], contact["eta_mm"], contact["left"]["clearance_um"]
    sheet = Sheet(640, 320, "Unloaded contact pattern of the left end, case A")
    sheet.axes((70, 20, 610, 265), (eta[0], eta[-1]), (s[0], s[-1]))
    smallest = min(min(row) for row in clearance)
    marking = contact["marking_thickness_um"]

    def shade(gap):
        level = 8 * round(min(gap, 32) / 4)
        return BLUE if gap < marking else f"#{160 + level + level // 3:02x}{180 + level:02x}f8"

    for i in range(len(s) - 1):
        colours, start = [shade(value - smallest) for value in clearance[i][:-1]] + [""], 0
        for j in range(1, len(colours)):
            if colours[j] != colours[start]:
                cell = [(eta[start], s[i]), (eta[j], s[i]), (eta[j], s[i + 1]), (eta[start], s[i + 1])]
                sheet.line(cell, "none", 0, "", True, colours[start])
                start = j
    sheet.frame("&#951; over the face, mm", "s on the path of contact, mm", range(-20, 30, 10), range(-10, 15, 5))
    return sheet


def search(program):
    """Best J over true evaluations: the default search with 200 of them, and the published flanks beside it."""
    with tempfile.TemporaryDirectory() as folder:
        design = Path(folder) / "design.json"
        design.write_text(json.dumps(program.example("paper-case-a")), encoding="utf-8")
        command = [program.path, "optimize", str(design), "--budget", "200", "--fresh", "--json", "--data", folder]
        found = subprocess.run(command, capture_output=True, text=True, check=True)
    spent, best = [], []
    for generation in json.loads(found.stdout)["generations"]:
        spent.append((spent[-1] if spent else 0) + generation["true"])
        best.append(generation["best"])
    sheet = Sheet(640, 300, "A search: best objective over true evaluations")
    sheet.axes((70, 20, 610, 245), (0, 200), (0, 1))
    sheet.frame("true evaluations", "best J (unmodified 1)", range(0, 201, 50), (0, 0.25, 0.5, 0.75, 1))
    steps = [(spent[0], best[0])]
    for i in range(1, len(spent)):
        steps += [(spent[i], best[i - 1]), (spent[i], best[i])]
    sheet.line(steps, BLUE, 2)
    for name, colour, below in (("paper-case-a", ORANGE, -4), ("paper-case-b", GREEN, 13)):
        value = program.analysis(name)["objectives"]["J"]
        sheet.line([(0, value), (200, value)], colour, 1.2, "6 4")
        sheet.text(198, value, f"published case {name[-1].upper()}", colour, "end", (0, below), 12)
    return sheet


def rig(program):
    """A synthetic recording of case A with noise, measured, beside the prediction: orders of the acceleration."""
    with tempfile.TemporaryDirectory() as folder:
        design, file = Path(folder) / "design.json", Path(folder) / "run.csv"
        design.write_text(json.dumps(program.example("paper-case-a")), encoding="utf-8")
        stated = ["--torque", "828", "--speed", "2000", "--noise-urad", "5"]
        record = [program.path, "rig", "--design", str(design), *stated, "-o", str(file)]
        subprocess.run(record, capture_output=True, check=True)
        measure = [program.path, "measure", str(design), str(file), "--torque", "828", "--json"]
        measured = subprocess.run(measure, capture_output=True, text=True, check=True)
    answer = json.loads(measured.stdout)
    result, orders = answer["measurements"][0]["result"], answer["comparison"]["details"][0]["orders"]
    sheet = Sheet(640, 300, "Measured and predicted orders of a synthetic recording")
    sheet.axes((70, 20, 610, 245), (0.4, 8.6), (0, 25))
    sheet.frame("mesh order", "amplitude, m/s&#178;", range(1, 9), range(0, 26, 5))
    for k in range(8):
        measured, predicted = orders["measured_m_per_s2"][k], orders["predicted_m_per_s2"][k]
        sigma = result["mesh"]["sigma_um"][k] / result["mesh"]["amplitude_um"][k] * measured
        sheet.line([(k + 1.16, 0), (k + 1.16, min(25, predicted))], BLUE, 12)
        sheet.line([(k + 0.84, 0), (k + 0.84, min(25, measured))], ORANGE, 12)
        sheet.line([(k + 0.84, max(0, measured - 2 * sigma)), (k + 0.84, min(25, measured + 2 * sigma))], INK, 1.5)
    rms = result["rms_m_per_s2"]
    size = f"{rms['value']:.1f} &#177; {rms['sigma']:.1f} m/s&#178;"
    sheet.text(8.5, 23, f"orange: measured, RMS {size}; blue: predicted; bars: two sigmas", GREY, "end", size=12)
    return sheet


QUICK = {
    "line-of-action": line_of_action,
    "ends": ends,
    "plane-of-action": plane_of_action,
    "modification": modification,
    "slice-gap": slice_gap,
    "lumped-model": lumped_model,
}
ALL = QUICK | {
    "transmission-error": transmission_error,
    "vibration": vibration,
    "contact-pattern": contact_pattern,
    "search": search,
    "rig": rig,
}


def main():
    program, folder, names = Program(sys.argv[1]), sys.argv[2], sys.argv[3:]
    for name, draw in (QUICK if names == ["quick"] else {n: ALL[n] for n in names} if names else ALL).items():
        draw(program).save(folder, name)


if __name__ == "__main__":
    main()

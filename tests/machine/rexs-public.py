#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports against the public REXS schemas, by hand: nothing of them is kept here.

usage: rexs-public.py EASEOFF FOLDER [DESIGN.json ...]

FOLDER holds, anywhere in it, rexs-file.xsd, rexs-file.json and the attribute tables rexs_schema_VERSION.xml, as the public
readers of REXS have them. Without designs every example is written. Needs xmllint and python3-jsonschema. What the JSON
schema says of the version "2.0.0", which it does not know, is passed over."""

import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree
from pathlib import Path

import jsonschema


class Table:
    """What one version allows: components, their attributes with type, unit, range and words, relations."""

    def __init__(self, path):
        root = tree.parse(path).getroot()
        units = {unit.get("id"): unit.get("name") for unit in root.iter("unit")}
        types = {kind.get("id"): kind.get("name") for kind in root.iter("valueType")}
        self.attributes = {a.get("attributeId"): a for a in root.iter("attribute")}
        self.unit = {name: units[a.get("unit")] for name, a in self.attributes.items()}
        self.type = {name: types[a.get("valueType")] for name, a in self.attributes.items()}
        self.components = {c.get("componentId") for c in root.iter("component")}
        self.on = {(m.get("componentId"), m.get("attributeId")) for m in root.iter("componentAttributeMapping")}
        self.relations = {
            relation.get("relationId"): {
                frozenset((r.get("roleId"), r.get("componentId")) for r in combination.iter("allowedCombinationRole"))
                for combination in relation.iter("allowedCombination")
            }
            for relation in root.iter("relation")
        }

    def value_faults(self, name, element, ids):
        text, kind, rule = (element.text or "").strip(), self.type[name], self.attributes[name]
        if kind in ("floating_point", "integer"):
            value, low, high = float(text), rule.get("rangeMin"), rule.get("rangeMax")
            if kind == "integer" and value != int(value):
                yield f"{name} = {text} is not whole"
            if low and (value < float(low) or (rule.get("rangeMinIntervalOpen") == "true" and value == float(low))):
                yield f"{name} = {text} is below {low}"
            if high and (value > float(high) or (rule.get("rangeMaxIntervalOpen") == "true" and value == float(high))):
                yield f"{name} = {text} is above {high}"
        elif kind == "enum" and text not in {word.get("value") for word in rule.iter("enumValue")}:
            yield f"{name} = {text} is no word of the list"
        elif kind == "boolean" and text not in ("true", "false"):
            yield f"{name} = {text} is no boolean"
        elif kind == "reference_component" and text not in ids:
            yield f"{name} names component {text}"
        elif kind.endswith("array") and element.find("array") is None:
            yield f"{name} is no array"

    def component_faults(self, component, ids):
        kind = component.get("type")
        if kind not in self.components:
            yield f"there is no component {kind}"
        for element in component:
            name = element.get("id")
            if name.startswith("custom_"):
                continue
            if (kind, name) not in self.on:
                yield f"{name} does not stand on {kind}"
            elif element.get("unit", "none") != self.unit[name]:
                yield f"{name} in {element.get('unit')}, not {self.unit[name]}"
            else:
                yield from self.value_faults(name, element, ids)

    def faults(self, model):
        components = {c.get("id"): c for c in model.find("components")}
        for component in [*components.values(), *(c for case in model.iter("load_case") for c in case)]:
            yield from self.component_faults(component, components)
        for relation in model.find("relations"):
            roles = frozenset((ref.get("role"), components[ref.get("id")].get("type")) for ref in relation)
            allowed = self.relations.get(relation.get("type"))
            if allowed is None or (allowed and roles not in allowed):
                yield f"{relation.get('type')} of {sorted(roles)}"


def main(program, folder, *designs):
    folder = Path(folder)
    tables = {p.stem.split("_")[2]: p for p in sorted(folder.rglob("rexs_schema_*.xml"))}
    schema = json.loads(next(folder.rglob("rexs-file.json")).read_text(encoding="utf-8"))
    xsd = next(folder.rglob("rexs-file.xsd"))
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        for example in [] if designs else ["paper", "paper-case-a", "paper-case-b", "narrow", "shifted", "single"]:
            path = Path(name) / f"{example}.json"
            path.write_bytes(subprocess.run([program, "example", example], check=True, capture_output=True).stdout)
            designs += (str(path),)
        for design in designs:
            for form in ("rexs", "rexs-2.0.0", "rexs-json", "rexs-2.0.0-json"):
                out = Path(name) / "model"
                subprocess.run([program, "export", design, "--format", form, "-o", out], check=True)
                if form.endswith("json"):
                    model = json.loads(out.read_text(encoding="utf-8-sig"))
                    found = [e.message for e in jsonschema.Draft7Validator(schema).iter_errors(model)
                             if list(e.path) != ["model", "version"]]  # fmt: skip
                else:
                    done = subprocess.run(["xmllint", "--noout", "--schema", xsd, out], capture_output=True, text=True)
                    model = tree.parse(out).getroot()
                    found = [done.stderr] if done.returncode else []
                    found += Table(tables[model.get("version")]).faults(model)
                failed += bool(found)
                print("not ok" if found else "ok", Path(design).name, form, *sorted(set(found)))
    return failed > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes easeoff/documents.py from the API's description: one TypedDict per schema, for type checkers and editors.

usage: make_documents.py [ADDRESS] > easeoff/documents.py   (of a running service, http://127.0.0.1:8080 by default)
"""

import sys
import textwrap
from keyword import iskeyword

from easeoff import Client

HEAD = '''# SPDX-License-Identifier: GPL-3.0-or-later
# Written by make_documents.py; not kept in the repository.
"""What the documents of the API hold. For type checkers and editors; at run time they are plain dicts."""

from __future__ import annotations

from typing import Any, Literal, Mapping, Sequence, TypedDict, Union

'''
PLAIN = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}


def type_of(schema):
    """The annotation of a schema."""
    if "$ref" in schema:
        return f'"{schema["$ref"].rsplit("/", 1)[1]}"'
    if "enum" in schema:
        values = ", ".join(repr(value) for value in schema["enum"])
        return f"Literal[{values}]"
    if "anyOf" in schema:
        return union([type_of(choice) for choice in schema["anyOf"]])
    kinds = schema.get("type")
    if isinstance(kinds, list):
        return union([type_of({**schema, "type": kind}) for kind in kinds])
    if kinds == "array":
        return f"Sequence[{type_of(schema.get('items', {}))}]"
    if kinds == "object":
        others = schema.get("additionalProperties")
        return f"Mapping[str, {type_of(others) if isinstance(others, dict) else 'Any'}]"
    return PLAIN.get(kinds, "Any")


def union(choices):
    unique = list(dict.fromkeys(choices))
    return unique[0] if len(unique) == 1 else "Union[" + ", ".join(unique) + "]"


def comment(schema):
    unit = schema.get("x-unit")
    text = schema.get("description", "") + (f" [{unit}]" if unit else "")
    return ["    # " + line for line in textwrap.wrap(text, 112)]


def fields_of(schema):
    """The members of an object in both groups: (name, schema, required)."""
    required = set(schema.get("required", []))
    return [(name, member, name in required) for name, member in schema.get("properties", {}).items()]


def write_class(name, schema):
    """A class of the required members and, below it, one with the others; empty groups are left out."""
    fields = fields_of(schema)
    always = [field for field in fields if field[2]]
    sometimes = [field for field in fields if not field[2]]
    lines = []
    if always and sometimes:
        lines += [f"class _{name}(TypedDict):"] + body(always) + ["", "", f"class {name}(_{name}, total=False):"]
        lines += body(sometimes)
    else:
        lines += [f"class {name}(TypedDict{'' if always else ', total=False'}):"] + (body(fields) or ["    pass"])
    return "\n".join(lines)


def body(fields):
    lines = []
    for name, schema, _ in fields:
        lines += comment(schema) + [f"    {name}: {type_of(schema)}"]
    return lines


def main():
    schemas = Client(*sys.argv[1:2]).openapi()["components"]["schemas"]
    def plain(schema):
        """Whether a class can spell it: no member is called as a word of the language is."""
        names = schema.get("properties", {})
        return schema.get("type") == "object" and all(name.isidentifier() and not iskeyword(name) for name in names)

    parts = [
        write_class(name, schema) if plain(schema) else f"{name} = {type_of(schema)}"
        for name, schema in schemas.items()
    ]
    sys.stdout.write(HEAD + "\n" + "\n\n\n".join(parts) + "\n")


if __name__ == "__main__":
    main()

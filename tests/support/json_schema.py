"""A validator for the part of JSON Schema that the schemas of smachac use."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

Schema = dict[str, Any]

TYPES: dict[str, tuple[type, ...]] = {
    "object": (dict,),
    "array": (list,),
    "string": (str,),
    "integer": (int,),
    "number": (int, float),
    "boolean": (bool,),
    "null": (type(None),),
}

ANNOTATIONS = {"$schema", "$id", "title", "description", "default", "definitions", "examples"}


def load_schema(name: str) -> Schema:
    """A schema of the package by its file name without the ending."""
    text = files("smachac.grammars").joinpath(f"{name}.schema.json").read_text("utf-8")
    schema: Schema = json.loads(text)
    return schema


def faults(data: Any, schema: Schema, root: Schema | None = None, at: str = "$") -> list[str]:
    """Where data does not fit a schema; a keyword that is not known here is an error."""
    root = schema if root is None else root
    found: list[str] = []
    for keyword, wanted in schema.items():
        if keyword not in ANNOTATIONS:
            found += _judge(keyword, wanted, data, schema, root, at)
    return found


def _judge(
    keyword: str, wanted: Any, data: Any, schema: Schema, root: Schema, at: str
) -> Iterator[str]:
    match keyword:
        case "$ref":
            part: Any = root
            for step in wanted.removeprefix("#/").split("/"):
                part = part[step]
            yield from faults(data, part, root, at)
        case "type":
            names = [wanted] if isinstance(wanted, str) else wanted
            if not any(_has_type(data, name) for name in names):
                yield f"{at}: not {' or '.join(names)}"
        case "const":
            if data != wanted:
                yield f"{at}: not {wanted!r}"
        case "enum":
            if data not in wanted:
                yield f"{at}: none of {wanted}"
        case "anyOf" | "oneOf":
            fitting = sum(not faults(data, option, root, at) for option in wanted)
            if fitting == 0 or (keyword == "oneOf" and fitting > 1):
                yield f"{at}: fits {fitting} of the possibilities"
        case "allOf":
            for option in wanted:
                yield from faults(data, option, root, at)
        case "if":
            branch = "else" if faults(data, wanted, root, at) else "then"
            yield from faults(data, schema.get(branch, {}), root, at)
        case "then" | "else":
            pass
        case "pattern":
            if isinstance(data, str) and not re.search(wanted, data):
                yield f"{at}: does not look like {wanted}"
        case "not":
            if not faults(data, wanted, root, at):
                yield f"{at}: fits what is excluded"
        case "minimum" | "maximum" | "exclusiveMinimum" | "exclusiveMaximum":
            if _is_outside(data, keyword, wanted):
                yield f"{at}: {keyword} {wanted}"
        case "minLength":
            if isinstance(data, str) and len(data) < wanted:
                yield f"{at}: shorter than {wanted}"
        case _:
            yield from _judge_parts(keyword, wanted, data, schema, root, at)


def _judge_parts(
    keyword: str, wanted: Any, data: Any, schema: Schema, root: Schema, at: str
) -> Iterator[str]:
    match keyword:
        case "required":
            if isinstance(data, dict):
                yield from (f"{at}: lacks {name}" for name in wanted if name not in data)
        case "properties":
            for name in wanted.keys() & data.keys() if isinstance(data, dict) else ():
                yield from faults(data[name], wanted[name], root, f"{at}.{name}")
        case "additionalProperties":
            for name in data if isinstance(data, dict) else ():
                if name not in schema.get("properties", {}):
                    yield from _judge_other(wanted, data[name], root, f"{at}.{name}")
        case "items":
            parts = list(enumerate(data)) if isinstance(data, list) else []
            parts = parts[: len(wanted)] if isinstance(wanted, list) else parts
            for index, item in parts:
                part = wanted[index] if isinstance(wanted, list) else wanted
                yield from faults(item, part, root, f"{at}[{index}]")
        case "propertyNames":
            for name in data if isinstance(data, dict) else ():
                yield from faults(name, wanted, root, f"{at}.{name}")
        case "uniqueItems":
            if isinstance(data, list) and any(each in data[:k] for k, each in enumerate(data)):
                yield f"{at}: an item is there twice"
        case "minItems" | "minProperties":
            if isinstance(data, list if keyword == "minItems" else dict) and len(data) < wanted:
                yield f"{at}: fewer than {wanted}"
        case "maxItems" | "maxProperties":
            if isinstance(data, list if keyword == "maxItems" else dict) and len(data) > wanted:
                yield f"{at}: more than {wanted}"
        case _:
            raise AssertionError(f"{keyword} is not known here")


def _is_outside(data: Any, keyword: str, bound: float) -> bool:
    if isinstance(data, bool) or not isinstance(data, int | float):
        return False
    if keyword.startswith("exclusive"):
        return data <= bound if keyword == "exclusiveMinimum" else data >= bound
    return data < bound if keyword == "minimum" else data > bound


def _judge_other(wanted: Any, data: Any, root: Schema, at: str) -> Iterator[str]:
    if wanted is False:
        yield f"{at}: not expected"
    elif wanted is not True:
        yield from faults(data, wanted, root, at)


def _has_type(data: Any, name: str) -> bool:
    if isinstance(data, bool):
        return name == "boolean"
    return isinstance(data, TYPES[name])

"""JSON Schemas of the files that users write, for editors, generated from the tables of the front
end (scripts, interfaces of state types, project files, scenarios) and of the room robots (robots,
scenes, faults).

Each schema accepts every file that the compiler accepts. The compiler checks more.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias, get_args

from smachac.diagnostics.diagnostic import Code
from smachac.frontend import schema
from smachac.frontend.config import LEVELS, SETTINGS
from smachac.frontend.schema import CONTAINERS, REQUIRED, VARIABLES, FieldOwner
from smachac.frontend.text.unquoted import VARIABLE_SHAPES
from smachac.frontend.types.interface_code import CLASS_FIELDS
from smachac.frontend.types.value_facts import NAMES
from smachac.interpreter.scenario import SCENARIO_FIELDS, STEP_FIELDS
from smachac.ir.nodes import FunctionResult, KeyRole, StateKind, VariableRole
from smachac.ir.types import MOST_BOUND, WORDS
from smachac.pysource.modules.ros_names import ROS_VERSIONS
from smachac.robots import description, faults, scene

Schema: TypeAlias = dict[str, Any]

DRAFT = "http://json-schema.org/draft-07/schema#"

_NAME = ["string", "number", "array"]

TYPE: Schema = {
    "description": "As float<rad>[7] or Pose; a mapping of fields to types is a record.",
    "type": ["string", "object"],
    "examples": [*WORDS, "float<rad>[7]"],
}

SHAPES: Mapping[str, Schema] = {
    "name": {
        "description": "A name, or a look-up or string construct that gives one.",
        "type": _NAME,
    },
    "names": {"type": "array", "items": {"$ref": "#/definitions/name"}},
    "outcomes": {
        "anyOf": [
            {"$ref": "#/definitions/names"},
            {"type": "object", "additionalProperties": {"$ref": "#/definitions/outcome"}},
        ]
    },
    "text": {"type": ["string", "number", "boolean", "array"]},
    "flag": {"type": "boolean"},
    "value": {},
    "items": {"type": ["array", "string"]},
    "map": {"type": "object"},
    "pairs": {"type": "object", "additionalProperties": {"$ref": "#/definitions/name"}},
    "rules": {
        "anyOf": [
            {"$ref": "#/definitions/rule"},
            {"type": "array", "items": {"$ref": "#/definitions/rule"}},
        ]
    },
    "rule": {"type": "object", "additionalProperties": {"$ref": "#/definitions/pairs"}},
    "keys": {
        "anyOf": [
            {"$ref": "#/definitions/names"},
            {"type": "object", "additionalProperties": {"type": [*_NAME, "object"]}},
        ]
    },
    "userdata": {
        "type": "object",
        "additionalProperties": {"anyOf": [{"$ref": "#/definitions/preset"}, {}]},
    },
}
"""What each shape of a field accepts (frontend/text/fields.py)."""

PRESET: Schema = {
    "type": "object",
    "required": ["value"],
    "additionalProperties": False,
    "properties": {
        "type": TYPE,
        "value": {},
        "doc": {"type": "string"},
        "secret": {"type": "boolean", "description": schema.KEY_FACTS["secret"]},
    },
}
"""The long form of a userdata key."""


OUTCOME: Schema = {
    "type": "object",
    "additionalProperties": False,
    "properties": {
        name: {"description": doc, "type": "boolean" if name == "failure" else "string"}
        for name, doc in schema.OUTCOME_FACTS.items()
        if name not in ("optional", "needs")
    },
}
"""What a script can state about an outcome."""


def generated_schemas(codes: Mapping[str, Code]) -> dict[str, Callable[[], Schema]]:
    """The generated schemas by name. `codes` are those whose severity a project file may set."""
    return {
        "script": script_schema,
        "interface": interface_schema,
        "project": lambda: project_schema(codes),
        "scenario": scenario_schema,
        "robot": lambda: _titled("A robot for smachac", description.SCHEMA),
        "scene": lambda: _titled("A scene for smachac", scene.SCHEMA),
        "faults": lambda: _titled("Faults for `smachac run --faults`", faults.SCHEMA),
    }


def _titled(title: str, schema: Schema) -> Schema:
    return {"$schema": DRAFT, "title": title, **schema}


def script_schema() -> Schema:
    """The schema of scripts and sub-scripts."""
    only_base = set(schema.names_for("base")) - {
        name for owner in CONTAINERS.values() for name in schema.names_for(owner)
    }
    of_states = [name for name in VARIABLES if name not in only_base]
    return {
        "$schema": DRAFT,
        "title": "A smachac script",
        "description": "The compiler checks more: also the variables of state types.",
        "oneOf": [{"$ref": "#/definitions/base"}, {"$ref": "#/definitions/sub_script"}],
        "definitions": {
            **SHAPES,
            **{f"field_{name}": _field(name) for name in VARIABLES},
            "preset": PRESET,
            "outcome": OUTCOME,
            "base": {
                "description": "A script: one machine. Its base may have variables of its own.",
                "type": "object",
                "properties": _references(schema.names_for("base")),
                "allOf": _required("base"),
            },
            "state": {
                "description": "A state, a container or the call of a sub-script."
                " State types have variables of their own.",
                "type": "object",
                "properties": _references(of_states),
                "anyOf": [
                    {"required": [name]}
                    for field in ("template", "script")
                    for name in _spellings(field)
                ],
                "allOf": [_if_container(kind) for kind in CONTAINERS],
            },
            **{
                kind: {"description": "What this container must have.", "allOf": _required(kind)}
                for kind in CONTAINERS.values()
            },
            **_STATES,
        },
    }


_STATES: Schema = {
    "item": {
        "description": "One state: {NAME: {its variables}}, or NAME with nothing and its variables"
        " beside it.",
        "type": "object",
        "minProperties": 1,
        "anyOf": [
            {"maxProperties": 1, "additionalProperties": {"$ref": "#/definitions/state"}},
            {"minProperties": 2, "allOf": [{"$ref": "#/definitions/state"}]},
        ],
    },
    "sub_script": {
        "description": "A sub-script: a list of one state.",
        "type": "array",
        "minItems": 1,
        "maxItems": 1,
        "items": {"$ref": "#/definitions/item"},
    },
}


def _field(name: str) -> Schema:
    """The schema of a field: its description, its shape, its choices and its default."""
    row = VARIABLES[name]
    found: Schema = {"description": schema.FIELD_DOCS[name]}
    if name == "states":
        found |= {"type": "array", "items": {"$ref": "#/definitions/item"}}
    elif name in schema.FIELD_CHOICES:
        choices: Schema = {"enum": list(schema.FIELD_CHOICES[name])}
        is_name = row.shape == "name"
        found |= choices if is_name else {"type": "object", "additionalProperties": choices}
    else:
        found |= {"allOf": [{"$ref": f"#/definitions/{row.shape}"}]}
    if name in schema.FIELD_DEFAULTS:
        found["default"] = schema.FIELD_DEFAULTS[name]
    return found


def _spellings(name: str) -> list[str]:
    """The long and the short name of a field."""
    return [spelling for spelling in (name, VARIABLES[name].short) if spelling]


def _references(fields: list[str]) -> Schema:
    return {
        spelling: {"$ref": f"#/definitions/field_{name}"}
        for name in fields
        for spelling in _spellings(name)
    }


def _required(owner: FieldOwner) -> list[Schema]:
    return [
        {"anyOf": [{"required": [spelling]} for spelling in _spellings(name)]}
        for name in REQUIRED[owner]
    ]


def _if_container(kind: str) -> Schema:
    """The demands on a state whose template is a container type."""
    cases = [
        {"required": [name], "properties": {name: {"const": kind}}}
        for name in _spellings("template")
    ]
    return {"if": {"anyOf": cases}, "then": {"$ref": f"#/definitions/{kind}"}}


FLAGS = ("blocking", "stand_in", "simulation", "checks_grasp")
"""The fields of an interface that are true or false."""


INTERFACE_TITLE = "The interface of a state type of smachac"

OTHER_NAMES: Schema = {
    "type": "object",
    "additionalProperties": {"type": "object", "additionalProperties": {"type": "string"}},
}
"""The names of a type in other frameworks, each with words there and here."""


def interface_schema() -> Schema:
    """The schema of the interfaces of state types."""

    def facts(docs: Mapping[str, str], shapes: Schema) -> Schema:
        return {
            "type": "object",
            "additionalProperties": False,
            "properties": {
                name: {"description": doc, **shapes.get(name, {})} for name, doc in docs.items()
            },
        }

    flag, text, number = ({"type": name} for name in ("boolean", "string", "number"))
    common: Schema = {
        "type": TYPE,
        "doc": text,
        "optional": flag,
        "secret": flag,
        "failure": flag,
        "frame": text,
        "min": number,
        "max": number,
        "exclusive": flag,
        "unit": text,
        "one_of": {"type": "array", "items": {"type": ["string", "number"]}, "minItems": 1},
        "names": {"enum": list(NAMES)},
    }
    type_only: Schema = {
        "type": ["string", "null"],
        "description": "A type, as float<rad>[7].",
        "examples": [*WORDS, "float<rad>[7]"],
    }

    def section(of: Schema) -> Schema:
        return {"type": "object", "additionalProperties": {"anyOf": [type_only, of]}}

    of_variables = common | {
        "role": {"enum": list(get_args(VariableRole))},
        "keys": text,
        "called_first": flag,
        "arguments": {"type": "array", "items": text},
        "returns": {"enum": list(get_args(FunctionResult))},
        "unquoted": {"enum": list(VARIABLE_SHAPES)},
    }
    of_keys = common | {"role": {"enum": list(get_args(KeyRole))}}
    keys = section(facts(schema.KEY_FACTS, of_keys))
    names: Schema = {"type": "array", "items": {"type": "string"}}
    of_outcomes = common | {"needs": {"anyOf": [text, names]}}
    outcomes = section(facts(schema.OUTCOME_FACTS, of_outcomes))
    class_: Schema = {
        "type": "object",
        "required": list(CLASS_FIELDS[:2]),
        "additionalProperties": False,
        "properties": dict.fromkeys(CLASS_FIELDS, text),
    }
    shapes: Schema = {
        "name": text,
        "doc": text,
        "kind": {"enum": list(get_args(StateKind)), "default": "state"},
        "variables": section(facts(schema.VARIABLE_FACTS, of_variables)),
        **{key: {"anyOf": [keys, names]} for key in ("input_keys", "output_keys")},
        "outcomes": {"anyOf": [outcomes, names]},
        "writes": {"type": "object", "additionalProperties": names},
        "claims": names,
        **dict.fromkeys(FLAGS, flag | {"default": False}),
        "adds_frames": names,
        "other_names": OTHER_NAMES,
        "code": {"type": "object", "additionalProperties": {"anyOf": [text, class_]}},
    }
    return {"$schema": DRAFT, "title": INTERFACE_TITLE, **facts(schema.INTERFACE_FIELDS, shapes)}


def project_schema(codes: Mapping[str, Code]) -> Schema:
    """The schema of smachac.toml, and of the table `[tool.smachac]` of a pyproject.toml."""
    levels = {"enum": list(LEVELS)}
    severity: Schema = {
        "type": "object",
        "additionalProperties": levels,
        "properties": {
            name: {
                "description": f"{code.name}: {code.explanation.strip().partition(chr(10))[0]}",
                "default": code.severity.value,
                "enum": ["error"] if code.unsuppressible else list(LEVELS),
            }
            for name, code in codes.items()
        },
    }
    texts: Schema = {"type": "array", "items": {"type": "string"}, "default": []}
    bound: Schema = {"type": "integer", "minimum": 1, "maximum": MOST_BOUND}
    bounds: Schema = {
        "type": "object",
        "additionalProperties": False,
        "properties": {"text": bound, "list": bound},
    }
    type_: Schema = {"type": ["string", "object"]}
    class_: Schema = {
        "type": "object",
        "additionalProperties": False,
        "required": ["class", "header"],
        "properties": {"class": {"type": "string"}, "header": {"type": "string"}},
    }
    shapes = {
        "severity": severity,
        "ros": {"enum": list(ROS_VERSIONS)},
        "bounds": bounds,
        "types": {"type": "object", "additionalProperties": type_},
        "cpp_types": {"type": "object", "additionalProperties": class_},
    }
    return {
        "$schema": DRAFT,
        "title": "The project file of smachac",
        "type": "object",
        "additionalProperties": False,
        "properties": {
            name: {"description": doc, **shapes.get(name, texts)} for name, doc in SETTINGS.items()
        },
    }


def scenario_schema() -> Schema:
    """The schema of scenarios: the files of `smachac run --mock`."""
    outcome: Schema = {"type": ["string", "boolean"]}
    chances: Schema = {
        "type": "object",
        "minProperties": 1,
        "additionalProperties": {"type": "number", "minimum": 0, "maximum": 1},
    }
    shapes: Schema = {
        "outcome": {"anyOf": [outcome, chances]},
        "set": {"type": ["object", "null"]},
        "error": {},
        "after": {"type": ["string", "number"]},
        "run": {"type": "boolean", "default": False},
        "wait": {"type": "boolean", "default": False},
        "stop": {"type": "boolean", "default": False},
    }
    step: Schema = {
        "description": "One visit of a state: its outcome, or more.",
        "anyOf": [
            outcome,
            {
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    name: {"description": doc, **shapes[name]} for name, doc in STEP_FIELDS.items()
                },
            },
        ],
    }
    steps = {"anyOf": [step, {"type": "array", "minItems": 1, "items": step}]}
    return {
        "$schema": DRAFT,
        "title": "A scenario for `smachac run --mock`",
        "type": "object",
        "required": ["states"],
        "additionalProperties": False,
        "properties": {
            "states": {
                "description": SCENARIO_FIELDS["states"],
                "type": "object",
                "additionalProperties": steps,
            },
            "fill": {"description": SCENARIO_FIELDS["fill"], "type": "boolean", "default": False},
        },
    }

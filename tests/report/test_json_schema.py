"""The JSON Schemas for editors: every file of the repository fits, and faults do not."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import pytest

from smachac.commands.cli import main
from smachac.commands.schema import SCHEMAS, schema_text
from smachac.driver import CODES
from smachac.frontend import schema
from smachac.frontend.config import SETTINGS
from smachac.frontend.schema import (
    CONTAINER_DOCS,
    CONTAINERS,
    FIELD_CHOICES,
    FIELD_DEFAULTS,
    FIELD_DOCS,
    LONG,
    REQUIRED,
    VARIABLES,
    FieldOwner,
)
from smachac.ir import nodes
from smachac.ir.nodes import Container
from smachac.report.json_schema import SHAPES, generated_schemas
from smachac.robots.files import plain
from tests.support.json_schema import faults

GENERATED = {name: make() for name, make in generated_schemas(CODES).items()}
SCHEMA = GENERATED["script"]
DEFINITIONS = SCHEMA["definitions"]
ROOT = Path(__file__).parents[2]
SHORT = {long: short for short, long in LONG.items()}
DATA = {"bodies:": "scene", "faults:": "faults"}
"""First words of lines in files that are no scripts, and their schemas."""

YAML_FILES = [
    *sorted((ROOT / "examples").rglob("*.yml")),
    *(p for p in sorted((ROOT / "tests/cases").rglob("*.yml")) if "bad_" not in str(p)),
    *sorted((ROOT / "smachac/stdlib").glob("*.yml")),
    *sorted((ROOT / "smachac/robots").glob("*.yml")),
]


def kind(path: Path) -> str:
    """The schema of a file of the repository."""
    if path.parent.name == "robots":
        return "robot"
    lines = path.read_text("utf-8").splitlines()
    if next((line for line in lines if not line.startswith("#")), "") == "states:":
        return "scenario"
    for line in lines:
        for word, name in DATA.items():
            if line.startswith(word):
                return name
    return "interface" if path.parent.name in ("templates", "stdlib") else "script"


def test_the_tables_have_every_kind_of_container() -> None:
    kinds = {kind.__name__ for kind in get_args(Container)}
    assert set(CONTAINERS) == set(CONTAINER_DOCS) == set(REQUIRED) - {"base", "state"} == kinds


def test_every_field_has_a_description_and_a_shape() -> None:
    assert list(FIELD_DOCS) == list(VARIABLES)
    assert all(FIELD_DOCS.values())
    assert {row.shape for row in VARIABLES.values()} <= set(SHAPES)


def test_the_defaults_are_those_of_the_graph() -> None:
    concurrence, iterator = nodes.Concurrence, nodes.Iterator
    assert {
        "join": concurrence.__dataclass_fields__["join"].default,
        "it_label": iterator.__dataclass_fields__["item_key"].default,
        "exhausted_outcome": iterator.__dataclass_fields__["exhausted_outcome"].default,
    } == FIELD_DEFAULTS
    assert FIELD_DEFAULTS["join"] in FIELD_CHOICES["join"]


@pytest.mark.parametrize("owner", ["base", *CONTAINERS])
def test_each_owner_lacks_nothing_that_it_must_have(owner: FieldOwner) -> None:
    whole = {name: [] if name == "states" else "x" for name in REQUIRED[owner]}
    whole["outcomes"] = ["x"]
    assert faults(whole, DEFINITIONS[owner], SCHEMA) == []
    for name in REQUIRED[owner]:
        less = {other: value for other, value in whole.items() if other != name}
        assert faults(less, DEFINITIONS[owner], SCHEMA) != []
        if name in SHORT:
            assert faults(less | {SHORT[name]: whole[name]}, DEFINITIONS[owner], SCHEMA) == []


def script(*states: Any, **more: Any) -> dict[str, Any]:
    return {"name": "sm", "outcomes": ["done"], "states": list(states), **more}


BOTH = {"template": "Concurrence", "outcomes": ["a"], "default_outcome": "a", "states": []}


@pytest.mark.parametrize(
    "data",
    [
        script({"A": {"template": "SleepState", "time": 1, "transitions": {"succeeded": "done"}}}),
        script({"A": {"T": "SleepState", "t": {"succeeded": "done"}, "p": {"x": [1]}}}),
        script({"A": None, "template": "SleepState", "transitions": {"succeeded": "done"}}),
        script({"A": {"script": "pick", "remapping": {"a": [["x"]]}}}),
        script({"A": BOTH | {"outcome_map": {"a": {"B": "done"}}, "join": "any"}}),
        script(userdata={"q": {"type": "Pose", "value": [1]}, "n": 1}, input_keys={"a": "float"}),
        [{"PICK": {"template": "StateMachine", "outcomes": ["a"], "states": []}}],
    ],
)
def test_good_scripts_fit(data: Any) -> None:
    assert faults(data, SCHEMA) == []


@pytest.mark.parametrize(
    "data",
    [
        None,
        "text",
        {"name": "sm", "outcomes": ["done"]},
        script() | {"outcomes": "done"},
        script() | {"userdata": None},
        script("A"),
        script({}),
        script({"A": None}),
        script({"A": {"time": 1}}),
        script({"A": {"template": "T", "transitions": ["done"]}}),
        script({"A": {name: value for name, value in BOTH.items() if name != "states"}}),
        script({"A": BOTH | {"join": "some"}}),
        [],
        [{"A": {"template": "T"}}, {"B": {"template": "T"}}],
    ],
)
def test_bad_scripts_do_not(data: Any) -> None:
    assert faults(data, SCHEMA) != []


@pytest.mark.parametrize("path", YAML_FILES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_files_of_the_repository_fit(path: Path) -> None:
    data = plain(path.read_text("utf-8"))
    assert faults(data, GENERATED[kind(path)]) == []


@pytest.mark.parametrize(
    "data",
    [
        {"inputs": {"a": "Pose"}},
        {"kind": "machine"},
        {"variables": {"a": {"type": "float", "role": "goal_pose"}}},
        {"input_keys": {"a": {"role": "callbacks"}}},
        {"variables": {"a": {"defalt": 1}}},
        {"code": {"cpp": {"header": "a.hpp"}}},
        {"blocking": "yes"},
    ],
)
def test_wrong_interfaces_do_not_fit(data: Any) -> None:
    assert faults({"outcomes": {"done": {}}}, GENERATED["interface"]) == []
    assert faults({"outcomes": ["done"], "input_keys": ["n"]}, GENERATED["interface"]) == []
    assert faults({"outcomes": {"done": {}}, **data}, GENERATED["interface"]) != []


@pytest.mark.parametrize(
    "data",
    [
        {"script": ["a"]},
        {"templates": "templates"},
        {"severity": {"SM204": "fatal"}},
        {"severity": {"SM001": "off"}},
    ],
)
def test_wrong_project_files_do_not_fit(data: Any) -> None:
    assert set(GENERATED["project"]["properties"]) == set(SETTINGS)
    good = {"templates": ["templates"], "severity": {"SM204": "error", "SM3": "off"}}
    assert faults(good, GENERATED["project"]) == []
    assert faults(data, GENERATED["project"]) != []


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"states": ["A"]},
        {"states": {"A": []}},
        {"states": {"A": 1}},
        {"states": {"A": [{"outcom": "done"}]}},
        {"states": {}, "seed": 1},
    ],
)
def test_wrong_scenarios_do_not_fit(data: Any) -> None:
    steps = [{"outcome": "aborted"}, "done", {"set": {"w": 0.05}, "stop": True}, {"error": "no"}]
    good = {"states": {"sm/PICK/GRASP": steps, "CHECK": "succeeded", "TIMER": {"wait": True}}}
    assert faults(good, GENERATED["scenario"]) == []
    assert faults(data, GENERATED["scenario"]) != []


def test_descriptions_are_in_every_schema() -> None:
    for name in ("interface", "project"):
        assert all(entry["description"] for entry in GENERATED[name]["properties"].values())
    facts = schema.KEY_FACTS, schema.VARIABLE_FACTS, schema.OUTCOME_FACTS
    assert all(text for fact in facts for text in fact.values())


def test_the_command_prints_each_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(SCHEMAS)
    assert set(GENERATED) < set(SCHEMAS)
    for name in SCHEMAS:
        assert main(["schema", name]) == 0
        assert capsys.readouterr().out == schema_text(name)
    assert main(["schema", "scrip"]) == 2
    assert "did you mean `script`?" in capsys.readouterr().err

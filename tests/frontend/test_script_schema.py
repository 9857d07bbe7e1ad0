"""The schema of scripts for editors: what the compiler knows stands in it, and nothing else."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import pytest
from ruamel.yaml import YAML

from smachac.frontend.schema import (
    CONTAINER_DOCS,
    CONTAINERS,
    LONG,
    REQUIRED,
    VARIABLES,
    FieldOwner,
    names_for,
)
from smachac.ir.nodes import Container
from tests.support.json_schema import faults, load_schema

SCHEMA = load_schema("script")
DEFINITIONS = SCHEMA["definitions"]
ROOT = Path(__file__).parents[2]
SHORT = {long: short for short, long in LONG.items()}
SCRIPTS = [
    *sorted((ROOT / "examples").rglob("*.yml")),
    *(p for p in sorted((ROOT / "tests/cases").rglob("*.yml")) if "bad_" not in str(p)),
]


def with_short(names: list[str]) -> set[str]:
    return {*names, *(SHORT[name] for name in names if name in SHORT)}


def test_the_tables_have_every_kind_of_container() -> None:
    kinds = {kind.__name__ for kind in get_args(Container)}
    assert set(CONTAINERS) == set(CONTAINER_DOCS) == set(REQUIRED) - {"base", "state"} == kinds


def test_it_has_every_variable_and_says_what_it_is() -> None:
    assert list(DEFINITIONS["variables"]) == list(VARIABLES)
    assert all(entry["description"] for entry in DEFINITIONS["variables"].values())


@pytest.mark.parametrize("owner", ["base", "state"])
def test_each_name_is_that_of_its_variable(owner: str) -> None:
    for name, entry in DEFINITIONS[owner]["properties"].items():
        assert entry == {"$ref": f"#/definitions/variables/{LONG.get(name, name)}"}


def test_a_script_may_have_what_its_base_has() -> None:
    assert set(DEFINITIONS["base"]["properties"]) == with_short(names_for("base"))


def test_a_state_may_have_what_any_container_or_call_has() -> None:
    only_base = set(names_for("base")) - {n for owner in CONTAINERS for n in names_for(owner)}
    wanted = [name for name in VARIABLES if name not in only_base]
    assert set(DEFINITIONS["state"]["properties"]) == with_short(wanted)


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


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_scripts_of_the_repository_fit(path: Path) -> None:
    if path.parent.name == "templates":
        return
    assert faults(YAML(typ="safe", pure=True).load(path.read_text("utf-8")), SCHEMA) == []

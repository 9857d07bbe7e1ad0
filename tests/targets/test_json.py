"""The json target: every script of the tests fits the schema, and nothing of the graph is lost."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, get_args

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.driver import read_machine
from smachac.frontend.files import disk_library, read_source
from smachac.ir.nodes import (
    Checked,
    Expression,
    Key,
    Leaf,
    Machine,
    Node,
    Outcome,
    Remap,
    StateMachine,
    Struct,
    Transition,
    Value,
    Variable,
)
from smachac.ir.traversal import walk
from smachac.ir.types import Type
from smachac.targets import BuildContext
from smachac.targets.json import TARGET, to_json
from tests.support.json_schema import faults, load_schema

SCHEMA = load_schema("machine")
ROOT = Path(__file__).parents[2]
SCRIPTS = [
    *sorted((ROOT / "examples").glob("*/main.yml")),
    *(p for p in sorted((ROOT / "tests/cases").glob("*/main.yml")) if "bad_" not in str(p)),
]

SOURCE = Source("folder/main.yml", "name: sm\nGO: there\n")


def machine() -> Machine:
    data = (1, "a", None, Expression(text="ud.x", span=NOWHERE), float("nan"), 0.5)
    leaf = Leaf(
        name="GO",
        type="Move",
        writes=(("done", ("joints",)),),
        outcomes=(Outcome(name="done", span=NOWHERE),),
        inputs=(Key(name="q", type=Type("array", (Type("float", ("rad",)), 7)), span=NOWHERE),),
        transitions=(Transition(outcome="done", target="done", origin="implicit", span=NOWHERE),),
        remaps=(Remap(key="q", to="home", span=NOWHERE),),
        variables=(
            Variable(
                name="speed",
                value=Value(data=Struct(entries=(("z", data), ("a", True))), span=NOWHERE),
                span=Span(SOURCE, 13, 18),
            ),
        ),
        span=Span(SOURCE, 9, 11),
        via=(Span(SOURCE, 0, 4),),
    )
    root = StateMachine(
        name="sm",
        type="StateMachine",
        outcomes=(Outcome(name="done", doc="Well done.", span=NOWHERE),),
        children=(leaf,),
        initial="GO",
        span=Span(SOURCE, 6, 8),
    )
    return Machine(root=root, source="main.yml", digest="0" * 64)


def test_the_schema_has_every_kind_of_node() -> None:
    kinds = [kind.__name__ for kind in get_args(Node)]
    definitions = load_schema("machine")["definitions"]
    assert definitions["state"]["oneOf"] == [{"$ref": f"#/definitions/{name}"} for name in kinds]
    assert set(kinds) <= set(definitions)


def test_a_leaf_in_full() -> None:
    assert to_json(machine())["states"][1] == {
        "kind": "Leaf",
        "path": "sm/GO",
        "name": "GO",
        "type": "Move",
        "doc": "",
        "outcomes": [{"name": "done", "doc": "", "place": None}],
        "inputs": [{"name": "q", "type": "float<rad>[7]", "doc": "", "place": None}],
        "outputs": [],
        "transitions": [
            {
                "outcome": "done",
                "target": "done",
                "origin": "implicit",
                "place": None,
                "target_place": None,
            }
        ],
        "remaps": [{"key": "q", "to": "home", "place": None}],
        "claims": [],
        "catches": "",
        "place": "main.yml:2:1",
        "via": ["main.yml:1:1"],
        "variables": [
            {
                "name": "speed",
                "value": {
                    "struct": [
                        ["z", [1, "a", None, {"expression": "ud.x"}, {"float": "nan"}, 0.5]],
                        ["a", True],
                    ]
                },
                "type": "any",
                "place": "main.yml:2:5",
            }
        ],
        "writes": [["done", ["joints"]]],
        "open": False,
        "blocking": False,
    }


def test_one_file_with_the_mark_of_its_maker(no_library: Any) -> None:
    context = BuildContext(library=no_library)
    files = TARGET.emit(Checked(machine()), context, [])
    assert list(files) == ["sm.json"]
    assert json.loads(files["sm.json"]) == to_json(machine())
    assert "Made by smachac" in files["sm.json"].splitlines()[1]
    assert files["sm.json"].isascii()


@pytest.fixture(scope="module")
def no_library() -> object:
    return disk_library(Path("main.yml"), [])


def test_the_schema_refuses_what_does_not_fit() -> None:
    data = to_json(machine())
    assert faults(data, SCHEMA) == []
    data["states"][1]["initial"] = "X"
    del data["base"]
    assert faults(data, SCHEMA) == ["$: lacks base", "$.states[1]: fits 0 of the possibilities"]


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.parent.name)
def test_every_script_fits_the_schema(path: Path) -> None:
    report: Report = []
    source = read_source(path, report)
    assert source is not None
    built = read_machine(source, disk_library(path, report), report)
    assert built is not None
    data = to_json(built)
    assert faults(data, SCHEMA) == []
    assert [state["path"] for state in data["states"]] == [p for p, _ in walk(built.root)]
    assert str(ROOT) not in json.dumps(data)


def test_nesting_has_no_limit() -> None:
    inner = machine().root
    for _ in range(500):
        inner = StateMachine(name="M", type="StateMachine", children=(inner,), span=NOWHERE)
    data = to_json(Machine(root=inner))
    assert len(json.loads(json.dumps(data))["states"]) == 502

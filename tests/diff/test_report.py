"""The differences for programs: each comparison fits the schema of `smachac schema diff`."""

from __future__ import annotations

import json
from typing import Any, get_args

from hypothesis import given

from smachac.commands.schema import schema_text
from smachac.diff.comparison import Kind, compare
from smachac.diff.report import VERSION, render_json
from smachac.diff.states import FactKind
from smachac.driver import Analysis
from smachac.ir.nodes import Machine
from tests.diff.test_comparison import SCRIPT, of_text
from tests.strategies.machines import machines
from tests.support.json_schema import faults

SCHEMA: dict[str, Any] = json.loads(schema_text("diff"))
CHANGE = SCHEMA["definitions"]["change"]["properties"]


def printed(before: Analysis | None, after: Analysis | None) -> Any:
    return json.loads(render_json([compare(before, after)]))


def test_the_schema_has_every_kind_of_change() -> None:
    assert SCHEMA["properties"]["version"]["const"] == VERSION
    assert set(CHANGE["change"]["enum"]) == set(get_args(Kind))
    assert set(CHANGE["what"]["enum"]) == {"state", *get_args(FactKind)}


@given(machines(), machines())
def test_differences_of_machines_fit(one: Machine, other: Machine) -> None:
    before, after = (
        Analysis(script=name, machine=whole, report=[])
        for name, whole in (("one.yml", one), ("other.yml", other))
    )
    assert faults(printed(before, after), SCHEMA) == []


def test_new_removed_unreadable_and_wrong_scripts_fit() -> None:
    good, wrong, unreadable = map(of_text, (SCRIPT, SCRIPT.replace(": done", ": dne"), "name: ["))
    for before, after in ((None, good), (good, None), (good, unreadable), (wrong, good)):
        assert faults(printed(before, after), SCHEMA) == []
    data = printed(good, wrong)
    assert faults(data, SCHEMA) == []
    (script,) = data["scripts"]
    assert script["findings"]["added"]
    script["findings"]["added"][0].pop("message")
    script["changes"][0]["change"] = "replaced"
    assert len(faults(data, SCHEMA)) == 2

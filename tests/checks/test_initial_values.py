"""SM313: states of one container that give a key of it different values."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library

BUILT_IN = disk_library(Path("main.yml"), [])
SCRIPT = """
name: sm
outcomes: [succeeded]
userdata: {OWN}
states:
  - A: {template: PrintUserdataState, userdata: {ONE}, input_keys: [x], transitions: {succeeded: B}}
  - B: {template: PrintUserdataState, userdata: {TWO}, input_keys: [x], transitions: {succeeded: C}}
  - C: {template: PrintUserdataState, userdata: {THREE}, input_keys: [x]}
"""
WAVE = """
- WAVE:
    template: PrintUserdataState
    params: {speed: 1.0}
    userdata: {x: [params, speed]}
    input_keys: [x]
"""
CALLS = """
name: sm
outcomes: [done]
states:
  - A: {script: wave, params: {speed: ONE}, transitions: {succeeded: B}}
  - B: {script: wave, params: {speed: TWO}, transitions: {succeeded: done}}
"""


def found(own: str = "", one: str = "", two: str = "", three: str = "") -> list[Diagnostic]:
    text = SCRIPT
    for word, value in (("OWN", own), ("ONE", one), ("TWO", two), ("THREE", three)):
        text = text.replace(word, value)
    return said(text)


def said(text: str, **files: str) -> list[Diagnostic]:
    library = memory_library({f"{name}.yml": text for name, text in files.items()}, BUILT_IN)
    report = analyse(Source("main.yml", text), library, []).report
    return [item for item in report if item.code == "SM313"]


def test_both_places_are_told() -> None:
    (item,) = found(one="x: 1", two="x: 2")
    assert item.finding.message == (
        "the initial value of `x` in `A` is never used: `B` overwrites it"
    )
    assert item.span.line == 6
    assert [one.span.line for one in item.finding.related] == [7]


def test_the_userdata_of_the_container_itself() -> None:
    (item,) = found(own="x: 1", three="x: [1]")
    assert "value of `x` in `sm` is never used: `C` overwrites it" in item.finding.message
    assert [item.span.line, *(one.span.line for one in item.finding.related)] == [4, 8]


def test_all_places_of_one_key_are_one_finding() -> None:
    (item,) = found(own="x: 1", one="x: 2", two="x: 3", three="x: 2")
    assert [item.span.line, *(one.span.line for one in item.finding.related)] == [4, 7, 8]


@pytest.mark.parametrize(
    ("one", "two"),
    [
        ("x: 1", "x: 1"),
        ("x: 1", "y: 2"),
        ("x: .nan", "x: .nan"),
        ("x: 1", "x: {type: int, value: 1}"),
        ("x: 1.0", "x: 1"),
        ("x: [1, {a: b}]", "x: [1, {a: b}]"),
        ("x: '`math.pi`'", "x: '`math.pi`'"),
    ],
)
def test_the_same_value_twice_is_no_fault(one: str, two: str) -> None:
    assert found(one=one, two=two) == []


def test_each_container_has_userdata_of_its_own() -> None:
    inner = (
        SCRIPT.replace("OWN", "x: 1").replace("ONE", "x: 1").replace("TWO", "").replace("THREE", "")
    )
    state = inner.partition("states:\n")[2].replace("\n", "\n    ").rstrip()
    text = f"""
name: sm
outcomes: [succeeded]
userdata: {{x: 2}}
states:
  - ALL:
      template: StateMachine
      outcomes: [succeeded]
      states:
    {state}
"""
    assert said(text) == []


@pytest.mark.parametrize(("one", "two", "lines"), [("1.0", "1.0", []), ("1.0", "2.0", [5, 6])])
def test_calls_of_one_sub_script(one: str, two: str, lines: list[int]) -> None:
    """The value stands at one place, so the calls are shown."""
    report = said(CALLS.replace("ONE", one).replace("TWO", two), wave=WAVE)
    assert len(report) == bool(lines)
    for item in report:
        assert [item.span.line, *(each.span.line for each in item.finding.related)] == lines
        assert "value of `x` in `A` is never used: `B` overwrites it" in item.finding.message


def test_each_value_that_is_lost_is_named() -> None:
    (item,) = found(one="x: 1", two="x: 2", three="x: 3")
    assert item.finding.message == (
        "the initial values of `x` in `A` and `B` are never used: `C` overwrites them"
    )
    assert item.help == (
        "rename the key: write `userdata: {x_2: 1}` and `remapping: {x: x_2}` at `A`;"
        " `userdata: {x_3: 2}` and `remapping: {x: x_3}` at `B`"
    )
    assert found(one="x_2: 1", two="x_3: 2", three="x: 3") == []


def test_a_container_keeps_its_value_if_the_states_get_other_keys() -> None:
    (item,) = found(own="x: 0", one="x: 1", three="x: 3")
    assert item.help == (
        "rename the key: write `userdata: {x_2: 1}` and `remapping: {x: x_2}` at `A`;"
        " `userdata: {x_3: 3}` and `remapping: {x: x_3}` at `C`, or set `x` only once"
    )
    assert found(own="x: 0", one="x_2: 1", three="x_3: 3") == []

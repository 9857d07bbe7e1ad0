"""Depth is a limit with a report, never an escaped RecursionError."""

from __future__ import annotations

import pytest

from smachac.diagnostics import Report
from smachac.driver import analyse, build, memory_library
from smachac.files import disk_library
from smachac.source import Source
from smachac.states import Library
from smachac.targets import load_target, target_names


def library(files: dict[str, str]) -> Library:
    from pathlib import Path

    return memory_library(files, disk_library(Path("main.yml"), []))


def nested(levels: int, inside: str = "{T: ScriptedState, o: [done]}") -> str:
    for number in range(levels):
        inside = f"{{T: StateMachine, o: [done], s: [{{C{number}: {inside}}}]}}"
    return inside


def codes(script: str, files: dict[str, str] | None = None) -> set[str]:
    found = analyse(Source("main.yml", script), library(files or {}), []).report
    return {item.code.code for item in found if item.severity.value == "error"}


HEAD = "name: sm\noutcomes: [done]\nstates:\n  - X: "


@pytest.mark.parametrize("target", target_names())
def test_deep_machines_are_built(target: str) -> None:
    analysis = analyse(Source("main.yml", HEAD + nested(95)), library({}), [])
    assert analysis.checked is not None
    found = load_target(target)
    assert found is not None
    report: Report = []
    (text,) = build(analysis.checked, found, library({}), report).values()
    assert report == []
    assert "C94" in text
    if target == "python":
        compile(text, "x.py", "exec")


def test_too_deep_a_text() -> None:
    assert codes(HEAD + nested(200)) == {"SM006"}
    deep = "[" * 390 + "]" * 390
    value = HEAD.replace("states", f"userdata: {{x: {deep}}}\nstates") + nested(1)
    assert codes(value) == set()


def test_too_deep_a_chain_of_sub_scripts() -> None:
    files = {f"s{n}.yml": f"- S: {nested(5, f'{{script: s{n + 1}}}')}\n" for n in range(40)}
    files["s40.yml"] = "- S: {T: ScriptedState, o: [done]}\n"
    assert "SM006" in codes(HEAD + "{script: s0}", files)
    assert codes(HEAD + "{script: s14}", files) == set()

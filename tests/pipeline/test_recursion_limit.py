"""Depth is a limit with a report, never an escaped RecursionError."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.targets import load_target, target_names


def library(files: dict[str, str]) -> Library:
    from pathlib import Path

    return memory_library(files, disk_library(Path("main.yml"), []))


def nested(levels: int, inside: str = "{T: ScriptedState, o: [done]}", first: int = 0) -> str:
    for number in range(first, first + levels):
        inside = f"{{T: StateMachine, o: [done], s: [{{C{number}: {inside}}}]}}"
    return inside


def deep() -> tuple[str, Library]:
    """A script with 998 containers inside one another, and its sub-scripts: one text has at most
    900 levels of YAML."""
    files = {f"s{n}.yml": nested(200, f"{{script: s{n - 1}}}", 200 * n) for n in range(1, 4)}
    files["s0.yml"] = nested(200)
    files = {name: f"- S: {text}\n" for name, text in files.items()}
    return HEAD + nested(198, "{script: s3}", 800), library(files)


def codes(script: str, files: dict[str, str] | None = None) -> set[str]:
    found = analyse(Source("main.yml", script), library(files or {}), []).report
    return {item.code for item in found if item.severity.value == "error"}


HEAD = "name: sm\noutcomes: [done]\nstates:\n  - X: "


@pytest.mark.parametrize("target", target_names())
@pytest.mark.slow
def test_deep_machines_are_built(target: str) -> None:
    script, scripts = deep()
    analysis = analyse(Source("main.yml", script), scripts, [])
    assert analysis.checked is not None
    found = load_target(target)
    assert found is not None
    report: Report = []
    texts = build(analysis.checked, found, scripts, report).values()
    assert report == []
    text = next(text for text in texts if "C997" in text)
    if target == "python":
        compile(text, "x.py", "exec")


def test_too_deep_a_text() -> None:
    assert codes(HEAD + nested(1001)) == {"SM006"}
    assert codes(HEAD + nested(1200)) == {"SM006"}


@pytest.mark.parametrize("shape", ["[{}]", "{{a: {}}}"])
@pytest.mark.parametrize("name", ["userdata", "params"])
def test_too_deep_a_value(shape: str, name: str) -> None:
    opening, closing = shape.format("|").split("|")
    for levels, found in ((98, set()), (101, {"SM006"}), (3000, {"SM006"})):
        deep = opening * levels + "1" + closing * levels
        script = HEAD.replace("states", f"{name}: {{x: {deep}}}\nstates") + nested(1)
        assert codes(script) == found, levels


def test_values_that_look_ups_make_deep() -> None:
    deep = "[" * 90 + "1" + "]" * 90
    script = HEAD.replace("states", f"params: {{x: {deep}}}\nuserdata: {{y: {{z: @}}}}\nstates")
    assert codes(script.replace("@", "[[x]]") + nested(1)) == set()
    more = "[" * 15 + "[[x]], 1" + "]" * 15
    assert codes(script.replace("@", more) + nested(1)) == {"SM006"}


def test_too_deep_a_chain_of_sub_scripts() -> None:
    files = {f"s{n}.yml": f"- S: {nested(26, f'{{script: s{n + 1}}}')}\n" for n in range(40)}
    files["s40.yml"] = "- S: {T: ScriptedState, o: [done]}\n"
    assert "SM006" in codes(HEAD + "{script: s0}", files)
    assert codes(HEAD + "{script: s4}", files) == set()


def test_deep_machines_are_interpreted() -> None:
    script, scripts = deep()
    analysis = analyse(Source("main.yml", script), scripts, [])
    assert analysis.checked is not None
    assert run(analysis.checked, builtin_behaviour()).outcome == "done"


def test_too_deep_an_expression() -> None:
    """Found by fuzzing: the program that was printed could not be compiled."""
    state = '{T: CallbacksState, output_keys: [n], callbacks: {n: "lambda ud: CODE"}}'
    for levels, found in ((190, set()), (210, {"SM016"}), (3000, {"SM016"})):
        script = HEAD.replace("done", "succeeded") + state.replace("CODE", "-" * levels + "1")
        assert codes(script) == found
        analysis = analyse(Source("main.yml", script), library({}), [])
        target = load_target("python")
        assert target is not None
        if analysis.checked is not None:
            (text,) = build(analysis.checked, target, library({}), []).values()
            compile(text, "x.py", "exec")

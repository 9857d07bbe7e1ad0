"""Names with `/`, and keys that are there twice: a finding with its place, never an exception."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
- A: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""
WRONG = "name: Own\nvariables: {a: [1, 2]}\noutcomes: [1]\ncode: {python: [1]}\n"
READS = """\
import smach
class Own(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])
    def execute(self, ud):
        ud.n = ud.key
        return "ok"
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "templates").mkdir()
    return tmp_path


@pytest.mark.parametrize("name", ["a/b", "/", "a//b", "a/", "sm/A", "../b"])
@pytest.mark.parametrize("kind", ["wrong interface", "class", "function", "timeout", "loop"])
def test_a_slash_in_the_name_of_a_state(
    name: str, kind: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "own.py").write_text(READS + "def f(ud):\n    return ud.nothing\n")
    interface = "name: Own\ncode: {python: 'own:Own'}\noutcomes: {ok: {}}\n"
    (folder / "templates" / "Own.yml").write_text(WRONG if "wrong" in kind else interface)
    fields = {
        "function": "template: CallbacksState, output_keys: [x], callbacks: {x: own.f}",
        "timeout": "template: Own, timeout: 2, retry: {on: [ok], max: 2}",
        "loop": "template: Own, for_each: {item: i, in: k}",
    }.get(kind, "template: Own")
    state = f"- '{name}': {{{fields}, transitions: {{ok: done}}}}\n"
    (folder / "main.yml").write_text(SCRIPT.replace("ok: done", f"ok: '{name}'") + state)
    for words in (["check"], ["build", "-t", "python"], ["explain", name], ["diff", "main.yml"]):
        assert main([words[0], "main.yml", *words[1:]]) in (0, 1, 2)
    shown = capsys.readouterr()
    assert f"'{name}' is not a valid name of a state" in shown.out
    assert "Traceback" not in shown.err


@pytest.mark.parametrize(
    ("states", "place"),
    [
        ("{A: [ok], A: [ok, nope, nope]}", "s.yml:1:19"),
        ("{A: [nope], A: [ok, nope]}", "s.yml:1:14"),
        ("{A: [{outcome: nope}], A: ok}", "s.yml:1:14"),
        ("{sm/A: [ok], A: [ok, nope]}", "s.yml:1:22"),
    ],
)
def test_a_scenario_with_one_state_twice(
    states: str, place: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "main.yml").write_text(SCRIPT)
    (folder / "s.yml").write_text(f"states: {states}\n")
    for words in (["run", "main.yml", "--mock", "s.yml"], ["sweep", "main.yml", "--mock", "s.yml"]):
        assert main(words) == 1
        shown = capsys.readouterr()
        assert place in shown.out + shown.err
        assert "Traceback" not in shown.err


@pytest.mark.parametrize("states", ['{1: [ok], "1": [ok, nope]}', "{~: [x], null: [x, y]}"])
def test_keys_of_a_scenario_that_read_alike(
    states: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "main.yml").write_text(SCRIPT.replace("- A", "- '1'"))
    (folder / "s.yml").write_text(f"states: {states}\n")
    assert main(["run", "main.yml", "--mock", "s.yml"]) == 1
    assert "Traceback" not in capsys.readouterr().err

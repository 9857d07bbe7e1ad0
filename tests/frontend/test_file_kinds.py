"""Files of other kinds that are given in place of a script."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.frontend.text.file_kinds import kind_of_tree
from smachac.frontend.text.yaml_tree import parse

KINDS = {
    "name: Wave\nvariables: {times: int}\noutcomes: [done]\n": "interface",
    "name: Wave\noutcomes: {done: {}}\ncode: {python: 'a.b:Wave'}\n": "interface",
    "doc: It waits.\nblocking: true\n": "interface",
    "states: {A: [done], B: {outcome: done}}\n": "scenario",
    "states:\n  A: {outcome: {done: 0.5, lost: 0.5}}\n": "scenario",
    "name: arm\nurdf: arm.urdf\narms: {}\n": "robot",
    "arms: {left: {}}\n": "robot",
    "bodies: {box: {size: [1, 1, 1]}}\n": "scene",
    "faults: []\n": "faults",
    "name: sm\nstates: []\n": "script",
    "name: sm\noutcomes: [done]\n": "script",
    "name: sm\noutcomes: [done]\nparts: [1]\n": "script",
    "states: {A: {template: ScriptedState}}\n": "script",
    "name: sm\nvariables: {a: 1}\nstates: []\n": "script",
    "n: sm\ns: []\n": "script",
    "- A: {template: ScriptedState}\n": "script",
    "": "script",
}


@pytest.mark.parametrize("text", KINDS)
def test_the_kind_of_a_text(text: str) -> None:
    assert kind_of_tree(parse(Source("main.yml", text), [])) == KINDS[text]


@pytest.mark.parametrize("text", [text for text, kind in KINDS.items() if kind != "script"])
@pytest.mark.parametrize("command", ["check", "run", "build -t python -o out"])
def test_a_file_that_is_no_script_is_one_finding(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    text: str,
    command: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("part.yml").write_text(text)
    name, *options = command.split()
    assert main([name, "part.yml", *options]) == 1
    printed = "".join(capsys.readouterr())
    assert printed.count("error[") == 1
    assert "error[SM004]: a script is expected; this is " in printed
    assert "help: add" not in printed
    assert not Path("out").exists()

"""Names of files and texts of scripts cannot control a terminal or a CI log, in any command."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from smachac.commands.cli import main

TEXT = "a\u202e##[group]b\x1b[31m\u0085::error::c"
FOLDER = "f\n::error::x\u202e##[group]\x1b[31m"
CONTROLS = "\x00-\x08\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff"
UNSAFE = re.compile(rf"[{CONTROLS}]|##\[|^ *::(?!(?:error|warning) )", re.M)
"""Control characters, invisible ones, and commands of GitHub Actions that are not of smachac."""

GOOD = f"""\
name: sm
template: Base
outcomes: [done]
userdata: {{k: {{type: str, value: {json.dumps(TEXT)}}}}}
states:
- A: {{template: ScriptedState, outcomes: [ok], transitions: {{ok: B}}, doc: {json.dumps(TEXT)}}}
- B: {{template: ScriptedState, outcomes: [ok], transitions: {{ok: done}}, x: {json.dumps(TEXT)}}}
"""

COMMANDS = [
    ["check", FOLDER],
    ["check", FOLDER, "--format", "github"],
    ["check", FOLDER, "--format", "junit"],
    ["check", FOLDER, "--format", "json"],
    ["check", FOLDER, "--format", "sarif"],
    ["check", f"{FOLDER}/none.yml"],
    ["check", f"{FOLDER}/main.yml", "--select", TEXT],
    ["check", f"{FOLDER}/main.yml", "--baseline", f"{FOLDER}/main.yml"],
    ["check", f"--{TEXT}"],
    ["build", f"{FOLDER}/main.yml", "-t", "dot", "-o", f"{FOLDER}/out"],
    ["build", f"{FOLDER}/main.yml", "-t", "dot", "-o", f"{FOLDER}/main.yml"],
    ["build", f"{FOLDER}/main.yml", "-t", TEXT],
    ["fmt", FOLDER, "--check"],
    ["fmt", FOLDER],
    ["run", f"{FOLDER}/main.yml", "--mock", f"{FOLDER}/scenario.yml"],
    ["run", f"{FOLDER}/main.yml", "--trace", f"{FOLDER}/main.yml"],
    ["explain", f"{FOLDER}/main.yml", TEXT],
    ["explain", f"{FOLDER}/main.yml", "--failures"],
    ["explain", f"{FOLDER}/main.yml", "A"],
    ["rename", f"{FOLDER}/main.yml", "A", TEXT],
    ["rename", f"{FOLDER}/main.yml", "A", "X"],
    ["extract", f"{FOLDER}/main.yml", TEXT],
    ["states", "--templates", FOLDER],
    ["migrate", FOLDER],
    ["migrate", FOLDER, "--format", "md"],
    ["migrate", FOLDER, "--format", "json"],
    ["new", FOLDER],
]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: f"{words[0]} {words[-1][:9]!a}")
def test_no_name_controls_what_is_printed(
    words: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder = tmp_path / FOLDER
    folder.mkdir()
    (folder / "main.yml").write_text(GOOD, "utf-8")
    (folder / f"{FOLDER}.yml").write_text(GOOD.replace("name: sm", "name:   sm"), "utf-8")
    (folder / "bad.yml").write_text(GOOD.replace("ok: B", f"ok: {json.dumps(TEXT)}"), "utf-8")
    (folder / "Own.tpl.py").write_text("{% block class_defs %}{% endblock %}", "utf-8")
    scenario = f"states: {{A: [{json.dumps(TEXT)}]}}\n"
    (folder / "scenario.yml").write_text(scenario, "utf-8")
    monkeypatch.chdir(tmp_path)
    try:
        code = main(words)
    except SystemExit as ended:
        code = int(ended.code or 0)
    assert code in (0, 1, 2)
    shown = capsys.readouterr()
    assert shown.out + shown.err
    assert UNSAFE.findall(shown.out + shown.err) == []

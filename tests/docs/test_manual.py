"""The manual page: that of the parsers, and valid roff."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from scripts.manual import render_manual
from smachac.commands.cli import COMMANDS, command_line
from tests.support.golden import compare_file

PAGE = Path(__file__).parents[2] / "docs" / "smachac.1"


def test_golden_manual_is_that_of_the_parsers() -> None:
    compare_file(render_manual(), PAGE)


def test_the_manual_has_every_command_and_option(capsys: pytest.CaptureFixture[str]) -> None:
    text = render_manual().replace(r"\-", "-")
    assert re.findall(r"^\.SS smachac (.+)$", text, re.MULTILINE) == list(COMMANDS)
    for name in COMMANDS:
        with pytest.raises(SystemExit):
            command_line(name).parse_args([name, "--help"])
        options = re.findall(r"^  (--[a-z-]+)", capsys.readouterr().out, re.MULTILINE)
        assert [option for option in options if rf"\fB{option}\fR" not in text] == []


def test_the_manual_does_not_depend_on_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    narrow = render_manual()
    monkeypatch.setenv("COLUMNS", "200")
    assert render_manual() == narrow


def test_groff_has_no_warning() -> None:
    groff = shutil.which("groff")
    if groff is None:
        pytest.skip("no groff")
    call = [groff, "-man", "-Tutf8", "-ww", "-rLL=100n", str(PAGE)]
    done = subprocess.run(call, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    shown = re.sub(r"\x1b\[[0-9;]*m|.\x08", "", done.stdout)
    assert "smachac check main.yml --format concise" in shown
    assert "\nNAME\n" in shown

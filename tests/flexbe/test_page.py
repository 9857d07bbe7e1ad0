"""The example of docs/frameworks.md on SMACH, on FlexBE and in C++."""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import smachac
from tests.cpp.compilers import COMPILERS, Compiler
from tests.flexbe.programs import loaded, ready

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "frameworks.md").read_text("utf-8")
BLOCK = re.compile(
    r"^```(?:yaml|python|cpp)\n(?:#|//) (\S+\.\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL
)
LOOKED = "looking at the shelf\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The files of the page, with their names as comments."""
    (tmp_path / "templates").mkdir()
    for name, text in BLOCK.findall(PAGE):
        mark = "//" if name.endswith(".hpp") else "#"
        (tmp_path / name).write_text(f"{mark} {name}\n{text}", "utf-8")
    return tmp_path


def is_shown(text: str, start: str) -> bool:
    """Whether the page shows the part of a generated file that starts with a line."""
    found = re.search(rf"^```\w+\n({re.escape(start)}\n.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert found is not None
    return found[1] in text


def test_smach(folder: Path) -> None:
    ((name, text),) = smachac.compile(folder / "deliver.yml", "python").items()
    assert is_shown(text, "        smach.StateMachine.add(  # deliver.yml:14")
    (folder / name).write_text(text, "utf-8")
    found = subprocess.run(
        [sys.executable, name],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        encoding="utf-8",
    )
    assert (found.returncode, found.stdout.count(LOOKED)) == (0, 2)
    assert found.stdout.endswith("outcome: delivered\n")


def test_flexbe(folder: Path, monkeypatch: pytest.MonkeyPatch, silent_smach: None) -> None:
    files = smachac.compile(folder / "deliver.yml", "flexbe")
    behavior, *_ = files.values()
    assert is_shown(behavior, "            # deliver.yml:14")
    assert is_shown(behavior, "        # [MANUAL_CREATE]")
    package = "deliver_flexbe_states"
    state = files[f"{package}/{package}/look_state.py"]
    assert is_shown(state, f"from {package}.smachac_flexbe import EventState")
    monkeypatch.syspath_prepend(str(folder))
    output = io.StringIO()
    with loaded(files) as made, contextlib.redirect_stdout(output):
        assert ready(made).execute() == "delivered"
    assert output.getvalue().count(LOOKED) == 2
    del sys.modules["robot"]


@pytest.mark.slow
@COMPILERS
def test_cpp(folder: Path, compiler: Compiler) -> None:
    files = smachac.compile(folder / "deliver.yml", "cpp", options={"main": "true"})
    assert is_shown(files["deliver.hpp"], "    case State::DRIVE: // deliver.yml:14")
    (folder / "deliver.hpp").write_text(files["deliver.hpp"], "utf-8")
    found = compiler.run(files["main.cpp"], folder, "-pthread", f"-I{folder}")
    assert found == f"{LOOKED}{LOOKED}outcome: delivered\n"

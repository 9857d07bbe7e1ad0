"""Programs whose states do what no state should: `run` has no failure of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {template: Own, transitions: {done: done}}
"""

STATE = """\
{% block class_defs %}
class Odd(Exception):
    def __str__(self):
        raise ValueError("no words")


class Own(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        CODE
        return "done"
{% endblock %}
"""


def run(folder: Path, code: str) -> subprocess.CompletedProcess[str]:
    (folder / "templates").mkdir()
    (folder / "templates" / "Own.tpl.py").write_text(STATE.replace("CODE", code))
    (folder / "templates" / "Own.yml").write_text(
        "outcomes: {done: {}}\ncode: {python: Own.tpl.py}\n"
    )
    (folder / "main.yml").write_text(MAIN)
    return subprocess.run(
        [sys.executable, "-m", "smachac", "run", "main.yml"],
        cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip


@pytest.mark.parametrize("code", ["import os; os.chdir('/')", "import sys; sys.path.clear()"])
def test_a_state_may_change_the_working_folder(code: str, tmp_path: Path) -> None:
    done = run(tmp_path, code)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr


def test_an_exception_without_words_is_a_failure_of_the_program(tmp_path: Path) -> None:
    done = run(tmp_path, "raise Odd")
    assert done.returncode == 1, done.stderr
    assert "Odd" in done.stderr
    assert "bug in smachac" not in done.stderr

"""Scripts for sweeps, with states that end their process, or never end."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from pathlib import Path

SCRIPT = """\
name: sm
outcomes: [succeeded, aborted]
states:
  - FIND:
      template: ScriptedState
      outcomes: [found, failed]
      transitions: {found: GRASP, failed: aborted}
  - GRASP:
      template: ScriptedState
      outcomes: [held, failed]
      retry: {on: [failed], max: 3}
      transitions: {held: succeeded, exhausted: aborted, preempted: aborted}
"""

CHANCES = """\
states:
  FIND: {outcome: {found: 0.95, failed: 0.05}}
  GRASP: {outcome: {held: 0.6, failed: 0.4}}
"""

OWN_STATE = """\
name: sm
outcomes: [succeeded]
states:
  - WORK: {template: Work, transitions: {done: succeeded}}
"""

INTERFACE = """\
name: Work
outcomes: {done: {}}
code: {python: "work:Work"}
"""

MODULE = """\
import os, random, signal, threading
from pathlib import Path
from smachac.runtime.smach import State

HERE = Path(__file__).parent

class Work(State):
    def __init__(self):
        State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        number = random.random()
        with open(HERE / "begun", "a") as stream:
            stream.write(f"{{number}}\\n")
        {action}
        return "done"
"""


def work_folder(folder: Path, action: str, seed: int = 3) -> Path:
    """A folder with a script whose state does `action`, a statement, in the run with a seed."""
    number = random.Random(seed).random()
    (folder / "main.yml").write_text(OWN_STATE, "utf-8")
    (folder / "templates").mkdir()
    (folder / "templates" / "Work.yml").write_text(INTERFACE, "utf-8")
    text = MODULE.format(action=f"if number == {number!r}: {action}")
    (folder / "work.py").write_text(text, "utf-8")
    return folder


ONCE = "not (HERE / 'once').exists() and ((HERE / 'once').touch(), {})"
"""A statement for the first run only; to be formatted."""


def smachac(*words: str, folder: Path, **more: object) -> subprocess.CompletedProcess[str]:
    """Run the command line in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done: subprocess.CompletedProcess[str] = subprocess.run(
        [sys.executable, "-m", "smachac", *words],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        **more,  # type: ignore[call-overload]
    )
    return done

"""SMACH itself without ROS, the distribution `standalone-smach` 0.0.9, in a process of its own.

`scripts/setup.sh dev` installs it in a folder of its own in the virtual environment: among the
other packages its `smach` would take the place of the bundled runtime in every program.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
FOLDER = Path(sys.prefix) / "standalone-smach"

START = """\
import sys, threading
sys.path[:0] = [{root!r}, {folder!r}]
threading.Thread.isAlive = threading.Thread.is_alive  # the name in Python 2, which it uses
"""
"""The first lines of a program that runs on it."""


def run_python(code: str, *arguments: str, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """The run of Python code in a process whose `smach` is SMACH itself."""
    start = START.format(root=str(ROOT), folder=str(FOLDER))
    return subprocess.run(
        [sys.executable, "-c", start + code, *arguments],
        capture_output=True, text=True, cwd=cwd, check=False, timeout=600,
    )  # fmt: skip


REPLAY = "from tests.conformance.standalone_smach import main; main(sys.argv[1])"


def results(cases: Sequence[Any], file: Path) -> dict[str, Any]:
    """The results of recorded cases on SMACH itself, by name; `file` is written for the process."""
    file.write_text(json.dumps(list(cases)), "utf-8")
    done = run_python(REPLAY, str(file))
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def main(file: str) -> None:
    """Replay the recorded cases in a JSON file on SMACH itself, and print the results as JSON, by
    the name of the case. The modules that replay them import the bundled runtime by its name, which
    is given to SMACH itself."""
    import smach

    import smachac.runtime

    sys.modules["smachac.runtime.smach"] = smach
    smachac.runtime.smach = smach
    from tests.conformance.vector_replay import replay

    def silent(*words: object) -> None:
        """Drop a message."""

    smach.set_loggers(silent, silent, silent, silent)
    found = {case["id"]: replay(case) for case in json.loads(Path(file).read_text("utf-8"))}
    print(json.dumps(found), flush=True)
    os._exit(0 if threading.active_count() else 1)  # threads of cases that hang do not end

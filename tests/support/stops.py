"""Programs whose states print what they do, and signals that are sent when a line was printed."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from smachac.commands.cli import main

ROOT = Path(__file__).parents[2]

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

SCRIPT = """\
name: sm
template: {base}
outcomes: [succeeded]
states:
  - WALK:
      template: Step
      retry: {{on: [again], max: 30}}
      transitions: {{preempted: TIDY, exhausted: WORK}}
  - WORK: {{template: {last}, transitions: {{done: TIDY, preempted: TIDY}}}}
  - TIDY: {{template: Tidy, transitions: {{done: succeeded}}}}
"""
"""30 steps, then a state that waits. The outcome is always `succeeded`."""

BRANCHES = """\
name: sm
template: Base
outcomes: [succeeded]
states:
  - BOTH:
      template: Concurrence
      outcomes: [succeeded]
      default_outcome: succeeded
      outcome_map: {succeeded: {LEFT: preempted, RIGHT: preempted}}
      states:
        - LEFT: {template: Work}
        - RIGHT: {template: Work}
      transitions: {succeeded: TIDY}
  - TIDY: {template: Tidy, transitions: {done: succeeded}}
"""

TYPES = {"Step": "again, preempted", "Work": "done, preempted", "Deaf": "done, preempted",
         "Tidy": "done"}  # fmt: skip

MODULE = """\
import sys, threading
try:
    import smach
except ImportError:
    from smachac.runtime import smach

class Step(smach.State):
    def __init__(self):
        smach.State.__init__(self, ["again", "preempted"])

    def execute(self, userdata):
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        print("step", flush=True)
        return "again"

class Work(smach.State):
    def __init__(self):
        smach.State.__init__(self, ["done", "preempted"])
        self.requested = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.requested.set()

    def execute(self, userdata):
        sys.stdout.write("working\\n")  # in one piece, as two branches write it
        sys.stdout.flush()
        self.requested.wait()
        self.service_preempt()
        return "preempted"

class Deaf(smach.State):
    "It waits for a line, whatever is requested."
    def __init__(self):
        smach.State.__init__(self, ["done", "preempted"])

    def request_preempt(self):
        super().request_preempt()
        print("requested", flush=True)

    def execute(self, userdata):
        print("working", flush=True)
        sys.stdin.readline()
        return "done"

class Tidy(smach.State):
    def __init__(self):
        smach.State.__init__(self, ["done"])

    def execute(self, userdata):
        print("tidied", flush=True)
        return "done"
"""


def folder_of(folder: Path, script: str = "", *, base: str = "Base", last: str = "Work") -> Path:
    """A folder with a script, its state types and their module."""
    (folder / "templates").mkdir()
    (folder / "main.yml").write_text(script or SCRIPT.format(base=base, last=last), "utf-8")
    for name, outcomes in TYPES.items():
        text = f'name: {name}\noutcomes: [{outcomes}]\ncode: {{python: "steps:{name}"}}\n'
        (folder / "templates" / f"{name}.yml").write_text(text, "utf-8")
    (folder / "steps.py").write_text(MODULE, "utf-8")
    return folder


def built(folder: Path) -> None:
    """Build the Python program of the script in a folder."""
    script = folder / "main.yml"
    assert main(["build", str(script), "-t", "python", "-o", str(folder)]) == 0


class Running:
    """A process that is followed line by line."""

    def __init__(
        self, folder: Path, *words: object, environment: Mapping[str, str] | None = None
    ) -> None:
        self.process = subprocess.Popen(
            [sys.executable, *map(str, words)],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(ROOT), **(environment or {})},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            # below `nohup`, as which tests may run, a process starts with this signal ignored
            preexec_fn=partial(signal.signal, signal.SIGHUP, signal.SIG_DFL),
        )
        self.lines: list[str] = []

    def until(self, line: str, times: int = 1) -> None:
        """Read until a line was printed so often."""
        assert self.process.stdout is not None
        while self.lines.count(line) < times:
            text = self.process.stdout.readline()
            assert text, self.lines
            if is_own(text):
                self.lines.append(text.rstrip("\n"))

    def send(self, number: int) -> None:
        self.process.send_signal(number)

    def end(self, answer: str = "") -> tuple[int, str]:
        """The exit code and what was printed to stderr, after the last line of stdin."""
        out, err = self.process.communicate(answer, timeout=120)
        self.lines += filter(is_own, out.splitlines())
        return self.process.returncode, err


def is_own(line: str) -> bool:
    """Whether a line is of the program, not of SMACH's log."""
    return not line.startswith("[")


class OnTerminal:
    """A program on a terminal of its own, which can be closed."""

    def __init__(self, folder: Path, *words: object) -> None:
        self.child, self._terminal = pty.fork()
        if self.child == 0:
            os.chdir(folder)
            os.environ["PYTHONPATH"] = str(ROOT)
            os.execv(sys.executable, [sys.executable, *map(str, words)])
        self._shown = b""

    def until(self, text: bytes) -> None:
        """Read until a text was printed."""
        while text not in self._shown:
            self._shown += os.read(self._terminal, 1000)

    def close(self) -> int:
        """Close the terminal; the exit code of the program."""
        os.close(self._terminal)
        return os.waitstatus_to_exitcode(os.waitpid(self.child, 0)[1])

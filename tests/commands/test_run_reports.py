"""What `run` and a generated program report: an exception once, outputs that are not written."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main

MAIN = """\
name: sm
template: Base
outcomes: [done, lost]
states:
  - OUTER:
      template: StateMachine
      outcomes: [done, lost]
      output_keys: [pose]
      states:
        - BOTH:
            template: Concurrence
            outcomes: [done, lost]
            output_keys: [pose]
            default_outcome: lost
            outcome_map: {done: {FIND: found}}
            states:
              - FIND: {template: Find}
              - WAIT: {template: SleepState, time: 0.01}
"""
FIND = """\
name: Find
outcomes: {found: {}, lost: {}}
output_keys: {pose: float}
writes: {found: [pose]}
code: {python: "cell.find:Find"}
"""
CLASS = """\
from smachac.runtime import smach


class Find(smach.State):
    def __init__(self):
        super().__init__(outcomes=["found", "lost"], output_keys=["pose"])

    def execute(self, userdata):
        BODY

    def keep(self, target):
        target.pose = 1.0
"""


def project(body: str, main_text: str = MAIN) -> None:
    for name, text in (
        ("main.yml", main_text),
        ("templates/Find.yml", FIND),
        ("cell/find.py", CLASS.replace("BODY", body)),
    ):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


RAISING = [
    ("raise ValueError('kaputt')", "kaputt"),
    ("return {}['kaputt']", "KeyError: 'kaputt'"),
    ("return [][3]", "list index out of range"),
]


@pytest.mark.parametrize(("body", "words"), RAISING)
@pytest.mark.parametrize("options", [[], ["--quiet"]])
def test_an_exception_is_reported_once(
    body: str, words: str, options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    project(body)
    assert main(["run", "main.yml", *options]) == 1
    printed = capsys.readouterr()
    assert words not in printed.out
    assert printed.err.replace(body, "").count(words) == 1
    assert "the run failed in sm/OUTER/BOTH/FIND (main.yml:17)" in printed.err


def test_an_error_of_a_scenario_is_reported_once(capsys: pytest.CaptureFixture[str]) -> None:
    project("return 'found'")
    Path("s.yml").write_text("states: {FIND: [{error: kaputt}]}\n")
    assert main(["run", "main.yml", "--mock", "s.yml"]) == 1
    printed = capsys.readouterr()
    assert (printed.out + printed.err).count("kaputt") == 1


def test_an_error_that_becomes_an_outcome_has_its_message_in_the_progress(
    capsys: pytest.CaptureFixture[str],
) -> None:
    state = "  - FIND: {template: Find, transitions: {found: done, error: lost}}\n"
    plain = MAIN.partition("  - OUTER")[0] + state
    project("return 'found'", plain)
    Path("s.yml").write_text("states: {FIND: [{error: kaputt}]}\n")
    assert main(["run", "main.yml", "--mock", "s.yml"]) == 0
    assert capsys.readouterr().out.count("kaputt") == 1


@pytest.mark.parametrize(("body", "words"), RAISING)
def test_a_generated_program_has_one_report(body: str, words: str) -> None:
    project(body)
    assert main(["build", "main.yml", "-t", "python", "-o", "."]) == 0
    done = subprocess.run(
        [sys.executable, "sm.py"], capture_output=True, text=True, check=False, timeout=100
    )
    assert done.returncode == 1
    assert words not in done.stdout
    assert done.stderr.count("Traceback") == 2  # the exception, and the error of the machine


@pytest.mark.parametrize(
    ("body", "is_warned"),
    [
        ("self.keep(**{'target': userdata}); return 'found'", False),
        ("self.keep(*[self]); return ['found'][0]", True),
        ("self.keep(*[self]); return ['lost'][0]", False),
    ],
)
def test_an_output_that_is_not_written_names_the_state(
    body: str, is_warned: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    project(body)
    assert main(["run", "main.yml"]) == 0
    printed = capsys.readouterr().err
    assert "never written" not in printed
    warning = "`sm/OUTER/BOTH/FIND` ended with `found` and did not write its output key `pose`"
    assert (warning in printed) == is_warned


STOP = (
    "import os, signal; os.kill(os.getpid(), signal.SIGTERM);"
    " next(filter(None, iter(self.preempt_requested, None))); "
)
"""Stop the run as `docker stop` does, and wait for the request."""


@pytest.mark.parametrize(
    ("body", "is_warned"),
    [
        (f"{STOP} return 'found'", False),
        (f"{STOP} self.service_preempt(); return 'found'", False),
        ("return 'found'", True),
    ],
)
def test_a_state_that_is_stopped_need_not_write_its_outputs(body: str, is_warned: bool) -> None:
    project(body)
    done = subprocess.run(
        [sys.executable, "-m", "smachac", "run", "main.yml"],
        capture_output=True, text=True, check=False, timeout=100,
    )  # fmt: skip
    assert done.returncode == (0 if is_warned else 143), done.stderr
    assert ("did not write" in done.stderr) == is_warned

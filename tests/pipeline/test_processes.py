"""Scripts that are checked in several processes have the results of one process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.driver import MachineCheck
from smachac.driver.batch import LEAST_SCRIPTS, Batch, check_scripts, processes_for
from smachac.frontend.files import Disk
from smachac.ir.nodes import Machine
from smachac.repair.search import clusters_of
from smachac.report.json import render_json

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs copies of a process")

MAIN = """\
name: {name}
template: Base
outcomes: [done, stuck]
states:
- GO: {{template: {template}, time: 1.0, transitions: {{succeeded: CALL, preempted: stuck}}}}
- CALL: {{script: {script}, transitions: {{{outcome}: done, bad: stuck}}}}
"""

PART = """\
- PART:
    template: StateMachine
    outcomes: [ok, bad]
    userdata: {unread: 1}
    states:
    - REST: {template: SleepState, time: 2.0, transitions: {succeeded: ok, preempted: bad}}
"""

DAMAGED = PART.replace("succeeded: ok", "suceeded: ok")


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Correct and wrong scripts with shared sub-scripts: one that is correct, one with a fault, one
    that is not UTF-8, one that no script calls, and one that is missing."""
    monkeypatch.chdir(tmp_path)
    rows = [
        ("SleepState", "part", "ok"),
        ("SleepState", "damaged", "ok"),
        ("SlepState", "part", "ok"),
        ("SleepState", "part", "okay"),
        ("SleepState", "latin", "ok"),
        ("SleepState", "missing", "ok"),
    ]
    Path("part.yml").write_text(PART, "utf-8")
    Path("damaged.yml").write_text(DAMAGED, "utf-8")
    Path("uncalled.yml").write_text(DAMAGED, "utf-8")
    Path("latin.yml").write_bytes(b"# M\xfcller\n" + PART.encode())
    for number in range(12):
        template, script, outcome = rows[number % len(rows)]
        text = MAIN.format(name=f"m{number}", template=template, script=script, outcome=outcome)
        Path(f"main{number:02}.yml").write_text(text, "utf-8")
    return sorted(Path().glob("*.yml"))


def checked(
    paths: list[Path], processes: int, extra: MachineCheck | None = None
) -> tuple[str, Batch]:
    """The findings with their clusters as JSON, and the batch."""
    batch = check_scripts(paths, Disk(), extra=extra, processes=processes)
    return render_json(batch.report, clusters_of(batch, batch.report)), batch


@pytest.mark.parametrize("processes", [2, 4])
def test_the_results_are_those_of_one_process(project: list[Path], processes: int) -> None:
    one, batch = checked(project, 1)
    several, other = checked(project, processes)
    assert several == one
    assert list(other.reports) == list(batch.reports)
    assert other.uses == batch.uses
    assert [len(report) for report in other.reports.values()] == [
        len(report) for report in batch.reports.values()
    ]
    assert {"damaged.yml", "latin.yml", "main02.yml"} <= {
        item.span.source.name for item in batch.report
    }


def test_another_process_has_read_a_shared_text_as_the_same_text(project: list[Path]) -> None:
    """A fault in a shared sub-script is one finding, and its text is read by this process."""
    batch = checked(project, 3)[1]
    found = [item for item in batch.report if item.span.source.name == "damaged.yml"]
    assert len({id(item.span.source) for item in found}) == 1
    assert sum(item.code == "SM102" for item in found) == 1


def in_others(action: str) -> MachineCheck:
    """A check that does something to each other process, at one machine."""
    main = os.getpid()

    def extra(machine: Machine) -> Iterable[Diagnostic]:
        if os.getpid() != main and machine.source == "main03.yml":
            if action == "raise":
                raise RuntimeError(machine.source)
            os.kill(os.getpid(), getattr(signal, action))
        return ()

    return extra


@pytest.mark.parametrize("action", ["raise", "SIGKILL", "SIGTERM"])
def test_no_report_is_lost_with_a_process(project: list[Path], action: str) -> None:
    assert checked(project, 2, in_others(action))[0] == checked(project, 1)[0]


def test_an_exception_is_that_of_one_process(project: list[Path]) -> None:
    def extra(machine: Machine) -> Iterable[Diagnostic]:
        if machine.source == "main10.yml":
            raise RuntimeError(machine.source)
        return ()

    with pytest.raises(RuntimeError, match=r"main10\.yml"):
        checked(project, 2, extra)


BLOCKED = """
import os, signal, sys
from pathlib import Path
from smachac.driver.batch import check_scripts
from smachac.commands.interrupts import end_at_interrupts
from smachac.frontend.files import Disk

end_at_interrupts()
main = os.getpid()

def extra(machine):
    if os.getpid() != main:
        os.write(int(sys.argv[1]), b"x")
        signal.pause()
    return ()

check_scripts(sorted(Path().glob("*.yml")), Disk(), extra=extra, processes=2)
"""


def test_ctrl_c_ends_all_processes_at_once(project: list[Path]) -> None:
    reading, writing = os.pipe()
    command = [sys.executable, "-c", BLOCKED, str(writing)]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, pass_fds=[writing], start_new_session=True
    )
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        assert pipe.read(2) == b"xx"  # both check a script now
        os.killpg(process.pid, signal.SIGINT)
        assert process.communicate()[1] == b"interrupted\n"
        assert process.returncode == 130
        assert pipe.read() == b""  # no process is left that has it open


def test_few_scripts_are_checked_in_one_process() -> None:
    assert processes_for(LEAST_SCRIPTS - 1) == 1
    assert 1 <= processes_for(200) <= (os.cpu_count() or 1)

"""Generated modules for YASMIN: their form, their start, and requests to stop from outside."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.ir.nodes import Checked
from smachac.targets.yasmin import TARGET
from tests.yasmin import stand_in
from tests.yasmin.programs import RUNTIME, loaded

ROOT = Path(__file__).parents[2]
LIBRARY = disk_library(ROOT / "main.yml", [])

WAITING = """\
name: wait
outcomes: [done, preempted]
userdata: {n: 0}
states:
  - COUNT:
      template: CallbacksState
      input_keys: [n]
      output_keys: [n]
      callbacks: {n: 'lambda ud: ud.n + 1'}
      transitions: {succeeded: BOTH}
  - BOTH:
      template: Concurrence
      outcomes: [over, stopped]
      default_outcome: stopped
      outcome_map: {over: {SLEEP: succeeded}}
      states:
        - SLEEP: {template: SleepState, time: 60.0}
        - OTHER: {template: SleepState, time: 60.0}
      transitions: {over: done, stopped: preempted}
"""

SIX = """\
name: fetch
outcomes: [succeeded, aborted, preempted]
userdata: {place: shelf}
states:
  - CALL:
      template: Call
      transitions: {succeeded: DRIVE, aborted: aborted}
  - DRIVE:
      template: Drive
      transitions: {succeeded: LOOK, aborted: aborted, preempted: preempted}
  - LOOK:
      template: Look
      transitions: {found: GRASP, nothing: CALL}
  - GRASP:
      template: Grasp
      remapping: {pose: box}
      transitions: {succeeded: RETURN, aborted: LOOK}
  - RETURN:
      template: Drive
      transitions: {succeeded: DROP, aborted: aborted, preempted: preempted}
  - DROP:
      template: Call
      transitions: {succeeded: succeeded, aborted: aborted}
"""


def files_of(text: str, **options: str) -> tuple[dict[str, str], Report]:
    checked = analyse(Source("main.yml", text), LIBRARY, []).checked
    assert checked is not None
    report: Report = []
    return build(checked, TARGET, LIBRARY, report, options=options), report


def test_states_that_a_stop_request_reaches_through_yasmin() -> None:
    """`cancel_state` of the machine reaches the state that runs; the machine goes on."""
    files, _ = files_of(WAITING)
    with loaded(files) as module:
        run = module.run()
        events: list[str] = []

        def observe(event: dict[str, str]) -> None:
            events.append(f"{event['event']} {event['path']}")
            if event["event"] == "enter" and event["path"].endswith("OTHER"):
                run.machine.cancel_state()

        run.observe(observe)
        assert run.execute() == "preempted"
        assert run.blackboard["n"] == 1
    assert {"preempt wait/BOTH", "preempt wait/BOTH/SLEEP"} <= set(events)


def test_a_cancelled_machine_ends_as_preempted() -> None:
    """YASMIN ends a run with an exception after `cancel_state_machine`."""
    files, _ = files_of(WAITING)
    with loaded(files) as module:
        run = module.run()

        def observe(event: dict[str, str]) -> None:
            if event["event"] == "enter" and event["path"].endswith("OTHER"):
                run.machine.cancel_state_machine()

        run.observe(observe)
        assert run.execute() == "preempted"


def test_the_handler_of_stop_signals_of_a_node_finds_the_machine_running() -> None:
    """Its loop waits until the machine has ended."""
    files, _ = files_of(WAITING)
    with loaded(files) as module:
        run = module.run()
        running = [run.is_running()]

        def observe(event: dict[str, str]) -> None:
            running.append(run.is_running())
            if event["event"] == "enter" and event["path"].endswith("OTHER"):
                run.request_preempt()

        run.observe(observe)
        assert run.execute() == "preempted"
        assert running[0] is False
        assert all(running[1:])
        assert run.is_running() is False


def test_a_request_between_the_last_state_and_the_end_is_not_lost() -> None:
    """YASMIN has no current state then: the machine around gets the request."""
    files, _ = files_of(AROUND)
    with loaded(files) as module:
        runs: list[Any] = []
        machine = sys.modules["smachac_yasmin"].Machine
        end = machine._end

        def asking(self: Any, blackboard: object, outcome: str) -> None:
            if self.path == "sm/IN":
                runs[0].request_preempt()
            end(self, blackboard, outcome)

        machine._end = asking
        runs.append(module.run())
        assert runs[0].execute() == "preempted"


AROUND = """\
name: sm
outcomes: [done, preempted]
states:
  - IN:
      template: StateMachine
      outcomes: [succeeded]
      states: [{A: {template: CallbacksState, callbacks: {}, transitions: {succeeded: succeeded}}}]
      transitions: {succeeded: WAIT}
  - WAIT: {template: SleepState, time: 60.0, transitions: {succeeded: done, preempted: preempted}}
"""


def test_an_exception_is_no_cancel() -> None:
    files, _ = files_of(WAITING)
    with loaded(files) as module:
        run = module.run()
        del run.blackboard["n"]
        with pytest.raises(KeyError, match="'n' holds nothing"):
            run.execute()


def test_a_state_that_nothing_leads_to_is_left_out() -> None:
    checked = analyse(Source("main.yml", WAITING), LIBRARY, []).checked
    assert checked is not None
    lost = replace(checked.root.children[0], name="LOST")
    root = replace(checked.root, children=(*checked.root.children, lost))
    files = build(Checked(replace(checked, root=root)), TARGET, LIBRARY, [])
    assert "No transition leads to 'LOST'" in files["wait_yasmin.py"]
    with loaded(files) as module:
        module.run().machine.validate()


ITEMS = """\
name: sm
outcomes: [done]
states:
  - EACH:
      template: Iterator
      outcomes: [done]
      it: CODE
      it_label: item
      loop_outcomes: [succeeded]
      exhausted_outcome: done
      states: [{GO: {template: CallbacksState, input_keys: [item], outcomes: [succeeded]}}]
      transitions: {done: done}
"""


@pytest.mark.parametrize(
    ("code", "refused"),
    [
        ("[1, 2]", False),
        ("'`lambda: [1, 2]`'", False),
        ("'`lambda ud: [n * 2 for n in range(3)]`'", False),
        ("'`lambda ud: [math.pi]`'", True),
    ],
)
def test_items(code: str, refused: bool) -> None:
    files, report = files_of(ITEMS.replace("CODE", code))
    assert [finding.code for finding in report] == ["SM601"] * refused
    if refused:
        assert report[0].span.line == 7
    else:
        with loaded(files) as module:
            assert module.run().execute() == "done"


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_program_is_started_and_stopped(tmp_path: Path, number: int, code: int) -> None:
    """As a user starts it; the stand-in is the module `yasmin`."""
    script = tmp_path / "main.yml"
    script.write_text(WAITING, "utf-8")
    files = {**smachac.compile(script, "yasmin"), "smachac_yasmin.py": RUNTIME.read_text("utf-8")}
    files["yasmin.py"] = Path(stand_in.__file__).read_text("utf-8")
    for name, text in files.items():
        (tmp_path / name).write_text(text, "utf-8")
    code_of_start = (
        "import os, wait_yasmin as module\n"
        "made = module.program.run\n"
        "def watched():\n"
        "    run = made()\n"
        "    run.observe(lambda event: os.write(1, (event['path'] + chr(10)).encode()))\n"
        "    return run\n"
        "module.program.run = watched\n"
        "raise SystemExit(module.start())\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code_of_start],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
    assert process.stdout is not None
    for line in process.stdout:
        if line == "wait/BOTH/OTHER\n":
            break
    process.send_signal(number)
    out, err = process.communicate()
    assert (process.returncode, out.splitlines()[-1:]) == (code, ["outcome: preempted"]), err


NAMES = """\
name: build
outcomes: [done]
states:
  - states: {template: SleepState, time: 0.0, transitions: {succeeded: class, preempted: done}}
  - class:
      template: StateMachine
      outcomes: [done]
      states:
        - parts: {template: SleepState, time: 0.0, transitions: {succeeded: done, preempted: done}}
"""


def test_names_of_the_module_itself() -> None:
    files, report = files_of(NAMES)
    assert report == []
    with loaded(files) as module:
        assert module.run().execute() == "done"


def test_a_program_that_hides_yasmin_is_refused() -> None:
    files, report = files_of(NAMES.replace("name: build", "name: yasmin"))
    assert files == {}
    assert [finding.code for finding in report] == ["SM611"]


def test_a_package() -> None:
    files, _ = files_of(WAITING, package="fetching")
    assert [*files] == [
        "fetching/wait_yasmin.py",
        "fetching/wait.py",
        "fetching/__init__.py",
        "package.xml",
        "setup.py",
        "setup.cfg",
        "resource/fetching",
    ]
    assert "from fetching import wait as smach_program\n" in files["fetching/wait_yasmin.py"]
    assert "<exec_depend>yasmin</exec_depend>" in files["package.xml"]
    assert '"wait = fetching.wait_yasmin:start"' in files["setup.py"]


PAGE = (ROOT / "docs" / "frameworks.md").read_text("utf-8")
BLOCK = re.compile(r"^```(?:yaml|python)\n# (\S+\.\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_the_example_of_the_page(tmp_path: Path) -> None:
    """The files of the page, and what the page shows of the module and of its start."""
    (tmp_path / "templates").mkdir()
    for name, text in BLOCK.findall(PAGE):
        (tmp_path / name).write_text(f"# {name}\n{text}", "utf-8")
    files = smachac.compile(tmp_path / "deliver.yml", "yasmin")
    shown = re.search(r"^```python\n(    # deliver.yml.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert shown is not None
    assert shown[1] in files["deliver_yasmin.py"]
    files["smachac_yasmin.py"] = RUNTIME.read_text("utf-8")
    files["yasmin.py"] = Path(stand_in.__file__).read_text("utf-8")
    for name, text in files.items():
        (tmp_path / name).write_text(text, "utf-8")
    found = subprocess.run(
        [sys.executable, "deliver_yasmin.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        encoding="utf-8",
    )
    assert (found.returncode, found.stderr) == (0, "")
    printed = re.sub(r"^\[ DEBUG \].*\n", "", found.stdout, flags=re.MULTILINE)  # SMACH's own log
    assert f"deliver_yasmin.py\n{printed}```" in PAGE


HAND_WRITTEN = 51
"""The lines of a program for YASMIN with six states as a user writes it, without its states."""


def test_a_module_is_as_long_as_one_written_by_hand(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    outcomes = {
        "Call": "{succeeded: {}, aborted: {}}",
        "Drive": "{succeeded: {}, aborted: {}, preempted: {}}",
        "Look": "{found: {}, nothing: {failure: true}}",
        "Grasp": "{succeeded: {}, aborted: {}}",
    }
    keys = {
        "Drive": "input_keys: {place: {type: str}}\n",
        "Look": "output_keys: {box: {type: int}}\n",
        "Grasp": "input_keys: {pose: {type: int}}\n",
    }
    for name, found in outcomes.items():
        text = f"name: {name}\noutcomes: {found}\n{keys.get(name, '')}"
        text += f"code: {{python: 'robot:{name}'}}\n"
        (tmp_path / "templates" / f"{name}.yml").write_text(text, "utf-8")
    classes = "".join(f"class {name}(smach.State):\n    pass\n\n\n" for name in outcomes)
    (tmp_path / "robot.py").write_text(f"import smach\n\n\n{classes}", "utf-8")
    script = tmp_path / "main.yml"
    script.write_text(SIX, "utf-8")
    text = smachac.compile(script, "yasmin")["fetch_yasmin.py"]
    lines = [line for line in text.splitlines() if line.strip() and line.strip()[0] != "#"]
    assert len(lines) <= 1.3 * HAND_WRITTEN, text


def test_a_program_without_a_function_for_its_machine_is_refused(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Own.yml").write_text("name: Own\noutcomes: {done: {}}\n", "utf-8")
    (tmp_path / "templates" / "Own.tpl.py").write_text(
        '{% extends "State.tpl.py" %}\n'
        "{% block class_defs %}\n"
        "class Own(smach.State):\n"
        "    def __init__(self):\n"
        "        smach.State.__init__(self, ['done'])\n"
        "{% endblock %}\n"
        "{% block execute %}print('before the run'){% endblock %}\n",
        "utf-8",
    )
    script = tmp_path / "main.yml"
    script.write_text(
        "name: sm\noutcomes: [done]\nstates:\n  - A: {template: Own, transitions: {done: done}}\n",
        "utf-8",
    )
    with pytest.raises(smachac.ScriptError) as raised:
        smachac.compile(script, "yasmin")
    assert "SM601" in {finding.code for finding in raised.value.report}

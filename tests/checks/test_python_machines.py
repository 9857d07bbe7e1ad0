"""Findings about machines that are written in Python: their words, and what SMACH itself does."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from smachac.driver.python_machines import PythonFile, PythonProject
from smachac.frontend.files import Disk
from smachac.report.text import render_text
from tests.conformance.standalone_smach import FOLDER, run_python
from tests.support.golden import compare_file

CASES = Path(__file__).parent / "python_machines"
NAMES = sorted(path.stem for path in CASES.glob("*.py"))

YAML = re.compile(
    r"interface|template|\.ya?ml|script|\bforever: |\bretry: "
    r"|\{\w+: |`[a-z]\w*: [\w\[{]|\w: \{|`\?`"
)
"""Words of scripts, and YAML. Code in Python has quotes around names; `LEFT: seen` in a message is
a state with its outcome."""


def read(name: str, folder: Path, *, everything: bool) -> PythonFile:
    shutil.copy(CASES / f"{name}.py", folder / f"{name}.py")
    return PythonProject(Disk()).read(Path(f"{name}.py"), everything=everything)


@pytest.mark.parametrize("name", NAMES)
def test_golden_report(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = read(name, tmp_path, everything=False)
    compare_file(render_text(found.report), CASES / f"{name}.txt")


@pytest.mark.parametrize("name", NAMES)
def test_no_words_of_scripts(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for item in read(name, tmp_path, everything=True).report:
        finding = item.finding
        texts = [finding.message, finding.help or "", finding.effect or "", item.effect]
        texts += [part.message for part in finding.related]
        assert not [text for text in texts if YAML.search(text)], item.code
        assert (finding.edits, finding.repairs) == ((), ())


MACHINES = """\
import importlib, inspect, logging
sys.path.insert(0, sys.argv[1])
import smach
quiet = lambda *words: None
smach.set_loggers(quiet, quiet, quiet, quiet)
module = importlib.import_module(sys.argv[2])
for name, function in inspect.getmembers(module, inspect.isfunction):
    if function.__module__ != module.__name__ or inspect.signature(function).parameters:
        continue
    try:
        sm = function()
        if sm is not None:
            sm.check_consistency()
            for _, child in sorted(sm.get_children().items()):
                if hasattr(child, "check_consistency"):
                    child.check_consistency()
            sm.execute()
    except Exception as error:
        print(name, type(error).__name__)
    else:
        print(name, "runs")
"""

STATES = """\
import importlib, inspect
sys.path.insert(0, sys.argv[1])
import smach
quiet = lambda *words: None
smach.set_loggers(quiet, quiet, quiet, quiet)
module = importlib.import_module(sys.argv[2])
for name, cls in inspect.getmembers(module, inspect.isclass):
    if not issubclass(cls, smach.State) or issubclass(cls, smach.container.Container):
        continue
    try:
        state = cls()
        sm = smach.StateMachine(outcomes=["end"])
        for key in state.get_registered_input_keys():
            sm.userdata[key] = 1
        with sm:
            sm.add("STATE", state, dict.fromkeys(state.get_registered_outcomes(), "end"))
        sm.execute()
    except Exception as error:
        print(name, type(error).__name__)
    else:
        print(name, "runs")
"""


REFUSED = {"sm101", "sm102", "sm103", "sm104", "sm106", "sm301", "sm403", "sm808"}
"""The codes with whose faults a machine ends with an error."""


def results(program: str, name: str) -> dict[str, str]:
    """The results of the machines or states of a case on SMACH itself, by name: an error, or
    `runs`."""
    if not FOLDER.exists():
        pytest.skip("standalone-smach is not installed: scripts/setup.sh dev")
    done = run_python(program, str(CASES), name)
    assert done.returncode == 0, done.stderr
    return dict(line.split() for line in done.stdout.splitlines() if line.count(" ") == 1)


@pytest.mark.parametrize(
    "name", [name for name in NAMES if name[:5] in REFUSED and name != "sm104_action"]
)
def test_smach_refuses_the_machines(name: str) -> None:
    found = results(MACHINES, name)
    runs = {machine for machine, result in found.items() if result == "runs"}
    assert found
    assert runs == ({"branches"} if name == "sm106_duplicate_state" else set())


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("sm308_lossy_write", {"Counter", "Look", "Misspelt"}),  # the value is discarded
        ("sm309_undeclared_return", {"Other"}),  # one path
        ("sm310_undeclared_access", set()),
        ("sm609_unusable_class", set()),
    ],
)
def test_smach_refuses_the_states(name: str, expected: set[str]) -> None:
    found = results(STATES, name)
    assert found
    assert {state for state, result in found.items() if result == "runs"} == expected


def test_a_class_of_several_machines_is_one_finding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    report = read("sm609_unusable_class", tmp_path, everything=False).report
    assert len({item.span for item in report}) == len(report) == 6


def test_machines_that_work_have_no_finding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = read("valid", tmp_path, everything=False)
    assert render_text(file.report) == ""
    assert len(file.graphs) == 4
    assert set(results(MACHINES, "valid").values()) == {"runs"}


def test_a_module_of_a_package_is_a_name_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An import of a module binds its name in its package."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "__init__.py").write_text("from .checks import *\n", "utf-8")
    (tmp_path / "robot" / "checks.py").write_text("def check(): pass\n", "utf-8")
    (tmp_path / "main.py").write_text(
        "import robot\nimport smach\nrobot.checks.check()\nrobot.chekcs.check()\n"
        "sm = smach.StateMachine(outcomes=['done'])\nsm.execute()\n",
        "utf-8",
    )
    report = PythonProject(Disk()).read(Path("main.py")).report
    assert [(item.code, item.finding.arguments[1]) for item in report] == [("SM803", "chekcs")]

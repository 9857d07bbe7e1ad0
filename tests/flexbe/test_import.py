"""Behaviors of FlexBE as scripts: their programs for FlexBE do what the behaviors do."""

from __future__ import annotations

import contextlib
import importlib
import io
import shutil
import sys
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.driver import analyse_script, build
from smachac.frontend.files import disk_library
from smachac.targets.flexbe import TARGET
from tests.flexbe import stand_in
from tests.flexbe.programs import engine_modules, loaded, ready
from tests.flexbe.test_read_back import compare_generated
from tests.refactor.test_python_import import CASES
from tests.support.framework_imports import (
    compare_second_imports,
    imported_output,
    proven_machine,
)

MODULES = ("machine", "place_sm", "arm_states")
STATES = ("Look", "Note", "Close", "Hold")
OUTCOMES = {"Look": ["seen", "nothing"], "Note": ["noted"], "Close": ["closed", "lost"],
            "Hold": ["slipped"]}  # fmt: skip
RUNS = 60


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The project of an import of the case `flexbe`, whose modules can be imported."""
    for path in (CASES / "flexbe").glob("*.py"):
        shutil.copy(path, tmp_path)
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 0
    monkeypatch.setattr(stand_in.EventState, "PERIOD", 0)
    for name, module in engine_modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    node: Any = ModuleType("smachac.runtime.smach_ros2")  # of the program without FlexBE
    node.program = None
    monkeypatch.setitem(sys.modules, node.__name__, node)
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    yield tmp_path / "project"
    for name in MODULES:
        sys.modules.pop(name, None)


def files_of(project: Path) -> dict[str, str]:
    assert main(["build", str(project / "main.yml"), "--target", "flexbe", "-o", "out", "-q"]) == 0
    out = project.parent / "out"
    paths = sorted(out.rglob("*"), key=lambda path: not path.name.endswith("_sm.py"))
    return {path.relative_to(out).as_posix(): path.read_text("utf-8")
            for path in paths if path.is_file()}  # fmt: skip


def run(made: Any) -> tuple[str, dict[str, Any]]:
    """The outcome of a behavior, and the userdata of its machine at the end."""
    with contextlib.redirect_stdout(io.StringIO()):
        behavior = ready(made)
        outcome: str = behavior.execute()
        return outcome, dict(behavior._state_machine._userdata._data)


def test_the_program_does_what_the_behavior_does(project: Path) -> None:
    outcome, held = run(importlib.import_module("machine").DeliverySM)
    assert outcome == "finished"
    assert held["log"] == ["HELLO", "placed"]
    assert (held["spot"], held["held"]) == (7, False)
    with loaded(files_of(project)) as made:
        assert run(made) == (outcome, held)


class Calls:
    """The calls of the states, with outcomes and ticks without one by `seed`. The behavior gets a
    request to stop in the call of the number `preempted`."""

    def __init__(self) -> None:
        self.made: list[str] = []
        self.seed, self.preempted = 0, -1

    def execute(self, state: Any) -> str | None:
        if len(self.made) == self.preempted:
            stand_in.PreemptableState.preempt = True
        name = type(state).__name__
        number = len(self.made)
        ends = [*([None] if number < 300 else []), *OUTCOMES[name]]
        outcome = ends[zlib.crc32(f"{self.seed} {number} {state.path}".encode()) % len(ends)]
        self.made.append(f"execute {state.path} {outcome}")
        return outcome

    def called(self, event: str) -> Any:
        def call(state: Any, userdata: Any = None) -> None:
            self.made.append(f"{event} {state.path}")
            if event == "on_enter" and type(state).__name__ == "Look":
                userdata.place = len(self.made)

        return call

    def of(self, made: Any) -> tuple[str, dict[str, Any], list[str]]:
        """The outcome, the userdata and the calls of a run."""
        self.made.clear()
        return (*run(made), [*self.made])


@pytest.fixture
def calls(project: Path, monkeypatch: pytest.MonkeyPatch) -> Calls:
    states, found = importlib.import_module("arm_states"), Calls()
    for name in STATES:
        cls = getattr(states, name)
        monkeypatch.setattr(cls, "execute", lambda self, userdata: found.execute(self))
        for event in ("on_enter", "on_exit", "on_start", "on_stop"):
            monkeypatch.setattr(cls, event, found.called(event), raising=False)
    return found


def test_random_outcomes(project: Path, calls: Calls) -> None:
    """All calls of the states are the same."""
    ends = set()
    behavior = importlib.import_module("machine").DeliverySM
    with loaded(files_of(project)) as made:
        for calls.seed in range(RUNS):
            expected = calls.of(behavior)
            assert calls.of(made) == expected
            ends.add(expected[0])
    assert ends == {"finished", "failed"}


def test_requests_to_stop(project: Path, calls: Calls) -> None:
    """FlexBE ends the behavior with `preempted`: the states are left without their `on_exit`."""
    behavior = importlib.import_module("machine").DeliverySM
    ends = set()
    with loaded(files_of(project)) as made:
        for calls.seed in range(RUNS):
            calls.preempted = 4 + calls.seed % 12
            expected = calls.of(behavior)
            assert calls.of(made) == expected
            ends.add(expected[0])
    assert "preempted" in ends


@pytest.mark.parametrize("name", ["flexbe", "flexbe_rare"])
def test_the_program_has_the_containers_of_the_behavior(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The graph of Python is that of the script (the proof), and that is the one of the program."""
    shutil.copytree(CASES / name, tmp_path, dirs_exist_ok=True)
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)
    main(["import", "machine.py", "-o", "project", "-q"])
    machine = proven_machine()
    compare_generated(machine, files_of(tmp_path / "project"), tmp_path / "back")


def test_a_second_import(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compare_second_imports(project, "PlaceSM.yml", ('"hello"', '"good day"'), capsys)


HEAD = """\
from flexbe_core import (
    Autonomy, Behavior, ConcurrencyContainer, EventState, OperatableStateMachine, PriorityContainer
)


class Go(EventState):
    def __init__(self, to=1):
        super().__init__(outcomes=["there", "lost"], io_keys=["way"])

    def execute(self, userdata):
        return "there"


class TourSM(Behavior):
    def __init__(self, node):
        super().__init__()
        self.add_parameter("speed", 1)

    def create(self):
        sm = OperatableStateMachine(outcomes=["end"])
        sm.userdata.way = 1
"""

ENDS = {"there": "end", "lost": "end"}
SAME = {"there": "there", "lost": "lost"}


def added(name: str, state: str, targets: dict[str, str], autonomy: str = "{}") -> str:
    call = f"OperatableStateMachine.add({name!r}, {state}, transitions={targets},"
    return f"    {call} autonomy={autonomy})\n"


def behavior(state: str, before: str = "", autonomy: str = "{}") -> str:
    """A behavior with one state, and code before that is added."""
    body = f"{before}with sm:\n{added('A', state, ENDS, autonomy)}return sm\n"
    return HEAD + "".join(f"        {line}\n" for line in body.splitlines())


def container(name: str, kind: str, arguments: str, *states: str) -> str:
    """The code of a container with some states, which have the names B, C, ..."""
    rows = (added(label, state, SAME) for label, state in zip("BCD", states, strict=False))
    made = f"{name} = {kind}(outcomes=['there', 'lost'], {arguments})\n"
    return f"{made}with {name}:\n{''.join(rows)}"


MACHINE, PARALLEL = "OperatableStateMachine", "ConcurrencyContainer"
BOTH = "conditions=[('there', [('B', 'there'), ('C', 'there')])]"
FIRST = "conditions=[('there', [('B', 'there')]), ('lost', [('B', 'lost')])]"

LISTED = {
    "priority": (behavior("inner", container("inner", "PriorityContainer", "", "Go()")),
                 "the priority of the container"),
    "conditions that never hold": (
        behavior("inner", container("inner", PARALLEL, BOTH, "Go()", "Go()")),
        "no condition of `A` holds: FlexBE does not end it"),
    "value that is set again": (
        behavior("inner", container("inner", MACHINE, "", "Go()") + "inner.userdata.way = 1\n")
        .replace("'lost': 'end'", "'lost': 'A'"),
        "`way` of `A` has this value again at each entry"),
    "value of an input": (
        behavior("inner", container("inner", MACHINE, "input_keys=['x']", "Go()")
                 + "inner.userdata.x = 1\n"),
        "`x` of `A` keeps this value, although it is an input"),
    "output of a branch": (
        behavior("inner", container("deep", MACHINE, "output_keys=['way']", "Go()")
                 + container("inner", PARALLEL, FIRST, "Go()", "deep")),
        "the other states of `A` get `way` of `C` at once, in a script at its end"),
    "unknown levels": (behavior("Go()", "import sys\n", "{'there': len(sys.argv)}"),
                       "levels of autonomy that are not known"),
    "unknown argument": (behavior("Go(self.speed + 1)"), "`self.speed + 1` is not known"),
    "rate": (behavior("go", "import sys\ngo = Go()\ngo.set_rate(len(sys.argv))\n"),
             "the call of `set_rate`"),
    "behavior that is not found": (
        behavior("self.use_behavior(OtherSM, 'A')").replace(
            "\n\nclass Go", "\nfrom other_behaviors.other_sm import OtherSM\n\n\nclass Go", 1)
        .replace('self.add_parameter("speed", 1)', "self.add_behavior(OtherSM, 'A', node)"),
        "the code of the state: its class is not known"),
    "ROS 1": (behavior("Go()").replace("from flexbe", "import rospy\nfrom flexbe", 1),
              "this module is code for ROS 1"),
}  # fmt: skip
"""Behaviors, and what the import lists for each."""


def test_an_outcome_without_a_transition_has_no_proof(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It ends a container of FlexBE never, that of a script by its name."""
    monkeypatch.chdir(tmp_path)
    code = behavior("Go()").replace('["there", "lost"]', '["there", "end"]')
    Path("machine.py").write_text(code.replace(", 'lost': 'end'", ""), "utf-8")
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 1
    out = capsys.readouterr().out
    assert "after `end` of `A` FlexBE logs an error, and a script ends `TourSM`" in out
    assert "no proof: the graph of main.yml differs" in out


@pytest.mark.parametrize("name", LISTED)
def test_what_is_not_taken_over_is_listed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text = LISTED[name]
    monkeypatch.chdir(tmp_path)
    assert text in imported_output(code, capsys)


TAKEN = {
    "parameter": (behavior("Go(self.speed)"), "params: {speed: 1}"),
    "level by its number": (behavior("Go()", autonomy="{'there': 2}"), "autonomy: {there: High}"),
    "levels of other names": (behavior("Go()", autonomy="{'x': Autonomy.Full}"), ""),
    "inherited level": (behavior("Go()", autonomy="{'there': Autonomy.Inherit}"), ""),
    "rate": (behavior("go", "go = Go()\ngo.set_rate(5)\n"), "template: Go"),
}
"""Behaviors that lose nothing, and what the script has then."""


@pytest.mark.parametrize("name", TAKEN)
def test_what_is_taken_over(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text = TAKEN[name]
    monkeypatch.chdir(tmp_path)
    assert "not taken over" not in imported_output(code, capsys)
    script = Path("project/main.yml").read_text("utf-8")
    assert text in script
    assert ("autonomy" in script) is ("autonomy" in text)


# --- states of FlexBE in scripts

GRASP = """\
from flexbe_core import EventState

CALLS = []


class Grasp(EventState):
    def __init__(self, ticks=1, fails=False):
        super().__init__(outcomes=["held", "lost"], input_keys=["part"], output_keys=["count"])
        self.ticks, self.fails = ticks, fails

    def on_enter(self, userdata):
        self.left = self.ticks

    def execute(self, userdata):
        CALLS.append(userdata.part)
        if self.fails:
            self.fails = False
            raise ValueError("no gripper")
        self.left -= 1
        userdata.count = self.left
        return "held" if self.left <= 0 else None

    def on_exit(self, userdata):
        CALLS.append("exit")
"""

INTERFACE = """\
name: Grasp
variables: {ticks: {default: 1}, fails: {default: false}}
input_keys: {part: {}}
output_keys: {count: {}}
outcomes: {held: {}, lost: {}}
code: {flexbe: "grasping:Grasp"}
"""

HEAD_OF_SCRIPT = "name: pick\noutcomes: [done, failed, preempted]\nuserdata: {part: 7}\nstates:\n"
STEPS = "transitions: {held: done, lost: failed"

SCRIPTS = {
    "plain": (f"- A: {{template: Grasp, ticks: 3, {STEPS}}}}}\n", "done", [7, 7, 7, "exit"]),
    "exception that FlexBE logs": (
        f"- A: {{template: Grasp, fails: true, {STEPS}}}}}\n", "done", [7, 7, "exit"]),
    "exception with a transition": (
        f"- A: {{template: Grasp, fails: true, {STEPS}, error: failed}}}}\n", "failed",
        [7, "exit"]),
    "time limit": (
        f"- A: {{template: Grasp, ticks: 1.0e+9, timeout: 0.01, {STEPS}, timeout: failed,"
        " preempted: preempted}}\n", "failed", None),
    "retry": (
        "- A: {template: Grasp, retry: {on: [held], max: 2}, "
        "transitions: {exhausted: done, lost: failed, preempted: preempted}}\n",
        "done", [7, "exit", 7, "exit"]),
    "branch that another one stops": (
        "- A:\n    template: Concurrence\n    join: any\n    outcomes: [first, other]\n"
        "    input_keys: [part]\n    default_outcome: other\n    outcome_map: {first: {B: held}}\n"
        "    transitions: {first: done, other: failed}\n    states:\n"
        "    - B: {template: Grasp, ticks: 2}\n"
        "    - C: {template: Grasp, ticks: 9, remapping: {count: other}}\n",
        "done", [7, 7, 7, "exit", "exit"]),
}  # fmt: skip
"""The states of a script, its outcome, and what the states of FlexBE do; None: it depends on the
time."""


@pytest.fixture
def grasping(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], Path]]:
    """Writes a script whose state type `Grasp` has a class of FlexBE."""

    def written(states: str) -> Path:
        (tmp_path / "templates").mkdir()
        (tmp_path / "templates" / "Grasp.yml").write_text(INTERFACE, "utf-8")
        (tmp_path / "grasping.py").write_text(GRASP, "utf-8")
        (tmp_path / "main.yml").write_text(HEAD_OF_SCRIPT + states, "utf-8")
        return tmp_path / "main.yml"

    monkeypatch.setattr(stand_in.EventState, "PERIOD", 0)
    for name, module in engine_modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    yield written
    sys.modules.pop("grasping", None)


@pytest.mark.parametrize("name", SCRIPTS)
def test_states_of_flexbe(name: str, grasping: Callable[[str], Path], silent_smach: None) -> None:
    states, outcome, calls = SCRIPTS[name]
    script = grasping(states)
    checked = analyse_script(script).checked
    assert checked is not None
    with loaded(build(checked, TARGET, disk_library(script, []), [])) as made:
        assert run(made)[0] == outcome
    found = importlib.import_module("grasping").CALLS
    assert calls in (None, found)


def test_other_targets_name_the_way(
    grasping: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    script = grasping(SCRIPTS["plain"][0])
    assert main(["check", str(script), "-q"]) == 0
    assert main(["build", str(script), "--target", "python", "-o", str(script.parent / "out")]) == 1
    error = capsys.readouterr().err
    assert "the state type `Grasp` has no code for Python" in error
    assert "it is a class of FlexBE: build it with `--target flexbe`" in error


def test_verify_plays_the_paths_of_an_imported_behavior(
    project: Path, capsys: pytest.CaptureFixture[str], silent_smach: None
) -> None:
    assert main(["verify", "project/main.yml", "--targets", "flexbe"]) == 0
    assert "flexbe: agrees\n" in capsys.readouterr().out

"""Machines in Python for YASMIN as scripts: their programs for YASMIN do what the machines do."""

from __future__ import annotations

import importlib
import shutil
import sys
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.driver import analyse_script, build
from smachac.frontend.files import disk_library
from smachac.targets.yasmin import TARGET
from tests.refactor.test_python_import import CASES
from tests.support.framework_imports import (
    compare_second_imports,
    imported_output,
    proven_machine,
)
from tests.yasmin.programs import ENGINE, loaded
from tests.yasmin.test_read_back import compare_generated

MODULES = ("machine", "grippers", "imported_states")
RUNS = 60


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The project of an import of the case `yasmin`, whose modules can be imported."""
    for path in (CASES / "yasmin").glob("*.py"):
        shutil.copy(path, tmp_path)
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 0
    monkeypatch.setitem(sys.modules, "yasmin", ENGINE)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.syspath_prepend(str(tmp_path / "project"))
    importlib.invalidate_caches()
    yield tmp_path / "project"
    for name in MODULES:
        sys.modules.pop(name, None)


def files_of(script: Path) -> dict[str, str]:
    checked = analyse_script(script).checked
    assert checked is not None
    return build(checked, TARGET, disk_library(script, []), [])


def values(blackboard: Any) -> dict[str, Any]:
    return {key: blackboard[key] for key in blackboard.keys()}  # noqa: SIM118


def original() -> tuple[str, dict[str, Any]]:
    """The outcome of the machine in Python, and what its blackboard holds then."""
    machine: Any = importlib.import_module("machine")
    blackboard = ENGINE.Blackboard()
    for key, value in {"weight": 1, "other": 4, "log": [], "last": "bye"}.items():
        blackboard[key] = value
    return machine.build()(blackboard), values(blackboard)


def imported(files: dict[str, str]) -> tuple[str, dict[str, Any]]:
    """The same of the program of the script."""
    with loaded(files) as module:
        run = module.run()
        return run.execute(), values(run.blackboard)


def test_the_program_does_what_the_machine_does(project: Path) -> None:
    outcome, held = original()
    assert outcome == "finished"
    assert held["log"] == ["first kg"] * 3 + ["note hello", "look 2 4", "look 1 4", "note bye"]
    assert (held["beep 3"], held["force"]) == (3, 2.5)
    assert imported(files_of(project / "main.yml")) == (outcome, held)


def test_random_outcomes(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = files_of(project / "main.yml")
    visits: Counter[str] = Counter()
    seed = 0

    def execute(self: Any, _blackboard: Any) -> str:
        name = next(cls.__name__ for cls in type(self).__mro__ if cls.__name__ in outcomes)
        visits[name] += 1
        number = zlib.crc32(f"{seed} {name} {visits[name]}".encode())
        return outcomes[name][number % len(outcomes[name])]

    machine, grippers = (importlib.import_module(name) for name in MODULES[:2])
    owners = {"Weigh": machine, "Beep": machine, "Close": grippers, "Look": grippers}
    outcomes = {"Weigh": ["light", "heavy"], "Beep": ["DONE"], "Close": ["closed", "lost"],
                "Look": ["seen", "NEXT"], "CbState": ["noted"]}  # fmt: skip
    for name, owner in owners.items():
        monkeypatch.setattr(getattr(owner, name), "execute", execute)
    ends = set()
    for number in range(RUNS):
        seed = number
        visits.clear()
        outcome, _ = original()
        expected = Counter(visits)
        visits.clear()
        assert imported(files)[0] == outcome
        assert visits == expected
        ends.add(outcome)
    assert ends == {"finished", "failed"}


@pytest.mark.parametrize("name", ["yasmin", "yasmin_rare"])
def test_the_program_has_the_containers_of_the_machine(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The graph of Python is that of the script (the proof), and that is the one of the program."""
    shutil.copytree(CASES / name, tmp_path, dirs_exist_ok=True)
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)
    main(["import", "machine.py", "-o", "project", "-q"])
    machine = proven_machine()
    compare_generated(machine, files_of(Path("project/main.yml")), tmp_path / "out")


HEAD = """\
from yasmin import Blackboard, CbState, Concurrence, JoinState, OrthogonalState, State, StateMachine


class Go(State):
    def __init__(self, to=1):
        super().__init__(["there"])


sm = StateMachine(["end"])
go = Go()
sm.add_state("GO", go, {"there": "end"})
"""

LISTED = {
    "parameter of a machine": ('sm.set_parameter("x", 1)', "the call of `set_parameter`"),
    "parameters of states": ('sm.set_parameter_mappings("GO", {"x": "y"})',
                             "the call of `set_parameter_mappings`"),
    "mappings of a state": ('sm.add_state("B", Go(), {"there": "end"}, {}, {"x": "y"})',
                            "the call of `set_parameter_mappings`"),
    "mappings of a concurrence": ('sm.add_state("B", Concurrence({"A": Go()}, "end",'
                                  ' parameter_mappings={"A": {"x": "y"}}))',
                                  "the call of `set_parameter_mappings`"),
    "unknown argument": ('import sys\ngo.set_parameter("x", len(sys.argv))',
                         "the call of `set_parameter`"),
    "condition": ('import sys\nif sys.argv:\n    go.set_parameter("x", 1)',
                  "the call of `set_parameter`"),
    "too many": ('for at in range(200):\n    go.set_parameter("x", at)',
                 "the call of `set_parameter`"),
    "callbacks": ("sm.add_start_cb(print)\nsm.add_transition_cb(print)",
                  "the function of `add_transition_cb`"),
    "blackboard": ("import sys\nsm(sys.argv)", "the values of the blackboard"),
    "second blackboard": ('a, b = Blackboard(), Blackboard()\nb["x"] = 2\nsm(a)\nsm(b)',
                          "the values of the blackboard"),
    "value": ('import sys\na = Blackboard()\na["x"] = sys.argv\nsm(a)', "`x` is not known"),
    "default of a machine that is not run": ('sm.add_input_key("x", "", 1)',
                                             "the default value of a key"),
    "default with `execute`": ('sm.add_input_key("x", "", 1)\nsm.execute(Blackboard())',
                               "the default value of a key"),
    "rules": ('sm.add_state("B", Concurrence({"A": Go(), "C": Go()}, "end",'
              ' {"a": {"A": "there"}, "c": {"C": "there"}}), {"a": "end", "c": "end"})',
              "can both hold"),
}  # fmt: skip
"""Code behind HEAD, and what the import lists for it."""


@pytest.mark.parametrize("name", LISTED)
def test_what_is_not_taken_over_is_listed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text = LISTED[name]
    monkeypatch.chdir(tmp_path)
    assert text in imported_output(f"{HEAD}{code}\n", capsys)
    own = Path("project/imported_states.py")
    assert not own.exists() or "set_parameter" not in own.read_text("utf-8")


def test_the_node_of_a_state_is_an_argument(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(
        "from yasmin import StateMachine\nfrom yasmin_ros import GetParametersState\n\n\n"
        'def build(node):\n    sm = StateMachine(["end"])\n'
        '    state = GetParametersState({"x": 1}, node=node)\n'
        '    sm.add_state("B", state, {"succeeded": "end", "aborted": "end"})\n',
        "utf-8",
    )
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 0
    assert "node: [params, node]" in Path("project/main.yml").read_text("utf-8")
    assert "NotImplementedError" not in Path("project/imported_states.py").read_text("utf-8")


def test_calls_keep_their_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    calls = [f'go.set_parameter("x", {number})\n' for number in (1, 2, 1)]
    Path("machine.py").write_text(HEAD + "".join(calls), "utf-8")
    main(["import", "machine.py", "-o", "project", "-q"])
    written = Path("project/imported_states.py").read_text("utf-8")
    assert [line[-2] for line in written.split("\n") if "set_parameter" in line] == ["1", "2", "1"]


TAKEN = {
    "two runs": ("sm()\nsm()", ""),
    "two runs with an empty blackboard": ("sm(Blackboard())\nsm(Blackboard())", ""),
    "copy": ('a = Blackboard()\nb = Blackboard(a)\nb["x"] = 1\na.set("y", 2)\na.remove("x")\nsm(b)',
             'userdata: {"y": 2}'),
    "default": ('sm.add_input_key("x", "", 1)\nsm.add_input_key("y", "", 2)\n'
                'a = Blackboard()\na["y"] = 3\nsm(a)', 'userdata: {x: 1, "y": 3}'),
    "key without a default": ('sm.add_input_key("x", "what it is")\nsm()', ""),
    "calls that only describe": ('go.set_description("x")\nsm.add_output_key("x", "y")', ""),
    "one rule": ('sm.add_state("B", Concurrence({"A": Go(), "C": Go()}, "end",'
                 ' {"a": {"A": "there"}}), {"a": "end"})', "outcome_map: {a: {A: there}}"),
}  # fmt: skip
"""Code behind HEAD that loses nothing, and what the script has then."""


@pytest.mark.parametrize("name", TAKEN)
def test_what_is_taken_over(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text = TAKEN[name]
    monkeypatch.chdir(tmp_path)
    main_part = "".join(f"    {line}\n" for line in code.split("\n"))
    out = imported_output(f'{HEAD}if __name__ == "__main__":\n{main_part}', capsys)
    assert "not taken over" not in out
    script = Path("project/main.yml").read_text("utf-8")
    assert text in script
    assert text or "userdata" not in script


def test_states_of_unknown_classes_in_a_concurrence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Their outcomes are those in the rules, and their classes those that the file imports."""
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(
        "from arm_states import Drive, Grip\n"
        "from yasmin import Concurrence, StateMachine\n\n"
        'sm = StateMachine(["end"])\n'
        'pair = Concurrence({"A": Drive(speed=2), "B": Grip()}, "no", {"got": {"A": "there",\n'
        '                   "B": "held"}})\n'
        'sm.add_state("PAIR", pair, {"got": "end", "no": "end"})\n',
        "utf-8",
    )
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 0
    assert "not taken over" not in capsys.readouterr().out
    drive = Path("project/templates/Drive.yml").read_text("utf-8")
    assert "variables: {speed: {}}\n" in drive
    assert "outcomes: {there: {}}\n" in drive
    assert 'code: {yasmin: "arm_states:Drive"}\n' in drive
    assert "outcomes: {held: {}}\n" in Path("project/templates/Grip.yml").read_text("utf-8")
    assert main(["check", "project/main.yml", "-q"]) == 0


def test_a_class_that_waits_for_another_region_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    code = 'class Meet(JoinState):\n    pass\n\n\nsm.add_state("M", Meet("x"), {"joined": "end"})\n'
    Path("machine.py").write_text(HEAD + code, "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 1
    error = capsys.readouterr().err
    assert "`sm` was not imported: it cannot become a script" in error
    assert ": `M`: it waits for another region of an orthogonal state" in error
    assert not Path("project").exists()


def test_a_second_import(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compare_second_imports(project, "imported_states.py", ('label="first"', 'label="new"'), capsys)


# --- states of YASMIN in scripts

GRASP = """\
from yasmin import State


class Grasp(State):
    def __init__(self, times=1, fails=False):
        super().__init__(outcomes=["held", "lost"])
        self.times, self.fails = times, fails

    def execute(self, blackboard):
        if self.fails:
            raise ValueError("no gripper")
        blackboard["log"] = [*blackboard["log"], f"{self.times} {blackboard['part']}"]
        blackboard["part"] = blackboard["part"] * 10
        return "held"
"""

INTERFACE = """\
name: Grasp
variables: {times: {default: 1}, fails: {default: false}}
input_keys: {"*": {}}
outcomes: {held: {}, lost: {}}
code: {yasmin: "arm:Grasp"}
"""

SCRIPT = """\
name: pick
outcomes: [done, failed]
userdata: {box: 7, part: 9, log: []}
states:
- FIRST: {template: Grasp, times: 1, transitions: {held: INSIDE, lost: failed}}
- INSIDE:
    template: StateMachine
    outcomes: [over]
    remapping: {part: box}
    states:
    - SECOND: {template: Grasp, times: 2, transitions: {held: THIRD, lost: THIRD}}
    - THIRD: {template: Grasp, times: 3, remapping: {part: bin, bin: part}, \
transitions: {held: over, lost: over}}
    transitions: {over: FOURTH}
- FOURTH: {template: Grasp, times: 4, fails: true, \
transitions: {held: failed, lost: failed, error: done}}
"""


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str, str], Path]]:
    """Writes a script whose state type `Grasp` has a class of YASMIN."""

    def written(script: str, interface: str = INTERFACE) -> Path:
        (tmp_path / "templates").mkdir()
        (tmp_path / "templates" / "Grasp.yml").write_text(interface, "utf-8")
        (tmp_path / "arm.py").write_text(GRASP, "utf-8")
        (tmp_path / "main.yml").write_text(script, "utf-8")
        importlib.invalidate_caches()
        return tmp_path / "main.yml"

    monkeypatch.setitem(sys.modules, "yasmin", ENGINE)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield written
    sys.modules.pop("arm", None)


def test_states_have_the_blackboard_with_the_remappings_around_them(
    arm: Callable[..., Path],
) -> None:
    files = files_of(arm(SCRIPT))
    with loaded(files) as module:
        run = module.run()
        run.blackboard["bin"] = 5
        assert run.execute() == "done"
        assert values(run.blackboard)["log"] == ["1 9", "2 7", "3 5"]
        assert values(run.blackboard)["box"] == 70


def test_declared_keys_are_those_of_the_container(arm: Callable[..., Path]) -> None:
    interface = INTERFACE.replace('{"*": {}}', "{part: {}}\noutput_keys: {part: {}}")
    script = SCRIPT.replace("userdata: {box: 7, part: 9, log: []}", "userdata: {box: 7, part: 9}")
    script = script.replace("    remapping: {part: box}\n",
                            "    input_keys: [part]\n    remapping: {part: box}\n")  # fmt: skip
    script = script.replace("remapping: {part: bin, bin: part}, ", "")
    files = files_of(arm(script, interface))
    assert 'Native(states["pick/INSIDE/SECOND"], inputs=["part"], outputs=["part"])' in next(
        iter(files.values())
    )
    with loaded(files) as module:
        run = module.run()
        run.blackboard["log"] = []
        assert run.execute() == "done"
        held = values(run.blackboard)
        assert held["log"] == ["1 9", "2 7", "3 70"]
        assert (held["box"], held["INSIDE/part"], held["part"]) == (7, 700, 90)


def test_outcomes_that_no_script_names_give_no_message(
    arm: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    interface = INTERFACE.replace("lost: {}", "").replace("{held: {}, }", "{held: {}}")
    script = "name: pick\noutcomes: [done]\nuserdata: {part: 1, log: []}\nstates:\n"
    files = files_of(
        arm(f"{script}- A: {{template: Grasp, transitions: {{held: done}}}}\n", interface)
    )
    with loaded(files) as module:
        assert module.run().execute() == "done"
    out, err = capsys.readouterr()
    assert "inconsistent" not in out + err


def test_a_request_reaches_the_state_that_runs(arm: Callable[..., Path]) -> None:
    files = files_of(arm(SCRIPT))
    with loaded(files) as module:
        run = module.run()
        run.blackboard["bin"] = 5
        grasp: Any = sys.modules["arm"].Grasp
        seen: list[tuple[int, bool]] = []
        before = grasp.execute

        def execute(self: Any, blackboard: Any) -> str:
            if self.times == 2:
                run.request_preempt()
            seen.append((self.times, self.is_canceled()))
            outcome: str = before(self, blackboard)
            return outcome

        grasp.execute = execute
        assert run.execute() == "done"
        assert seen == [(1, False), (2, True), (3, False), (4, False)]


WAITING = """\
import threading

from yasmin import State


class Grasp(State):
    def __init__(self, times=1, fails=False):
        super().__init__(outcomes=["held", "lost"])
        self.end = threading.Event()

    def cancel_state(self):
        super().cancel_state()
        self.end.set()

    def execute(self, blackboard):
        self.end.wait()
        return "held"
"""


def test_a_time_limit_cancels_the_state(arm: Callable[..., Path]) -> None:
    script = arm(
        "name: pick\noutcomes: [done, late, preempted]\nstates:\n"
        "- WAIT: {template: Grasp, timeout: 0.01,\n"
        "    transitions: {held: done, lost: done, timeout: late, preempted: preempted}}\n"
    )
    (script.parent / "arm.py").write_text(WAITING, "utf-8")
    with loaded(files_of(script)) as module:
        assert module.run().execute() == "late"


def test_sugar_around_a_state(arm: Callable[..., Path]) -> None:
    """The item of a loop is a key that the script lists."""
    files = files_of(arm(
        "name: pick\noutcomes: [done, failed, preempted]\n"
        "userdata: {parts: [1, 2], part: 5, log: []}\nstates:\n"
        "- EACH: {template: Grasp, for_each: {item: part, in: parts, on: [held]}, "
        "input_keys: [part],\n"
        "    transitions: {held: AGAIN, lost: failed, preempted: preempted}}\n"
        "- AGAIN: {template: Grasp, retry: {max: 2, on: [held]},\n"
        "    transitions: {exhausted: done, lost: failed, preempted: preempted}}\n"
    ))  # fmt: skip
    with loaded(files) as module:
        run = module.run()
        assert run.execute() == "done"
        assert values(run.blackboard)["log"] == ["1 1", "1 2", "1 5", "1 50"]


@pytest.mark.parametrize(
    ("text", "help"),
    [
        ("Grasp", "write it as `my_robot.states:Grasp`"),
        ("arm.Grasp", "write it as `my_robot.states:Grasp`"),
        ("arm:no class", "write it as `my_robot.states:Grasp`"),
        ("Grasp.tpl.py", "write it as `my_robot.states:Grasp`"),
    ],
)
def test_a_wrong_reference_is_reported(text: str, help: str, arm: Callable[..., Path]) -> None:
    report = analyse_script(arm(SCRIPT, INTERFACE.replace("arm:Grasp", text))).report
    (found,) = [item for item in report if "class in a Python module" in item.message]
    assert found.finding.help == help


def test_other_targets_name_the_way(
    arm: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    script = arm(SCRIPT)
    assert main(["check", str(script), "-q"]) == 0
    assert main(["build", str(script), "--target", "python", "-o", str(script.parent / "out")]) == 1
    error = capsys.readouterr().err
    assert "the state type `Grasp` has no code for Python" in error
    assert "build it with `--target yasmin`" in error


def test_verify_plays_the_paths_of_an_imported_machine(
    project: Path, capsys: pytest.CaptureFixture[str], silent_smach: None
) -> None:
    assert main(["verify", "project/main.yml", "--targets", "yasmin"]) == 0
    assert "yasmin: agrees\n" in capsys.readouterr().out

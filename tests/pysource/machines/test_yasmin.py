"""Machines in Python for YASMIN: the faults with which they cannot work, and no false alarm."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.driver.python_machines import PythonFile, PythonProject
from smachac.frontend.files import Disk
from tests.pysource.machines.test_python_cases import graph_lines

HEAD = """\
import vendor
import yasmin
import yasmin_ros
from yasmin import CbState, Concurrence, JoinState, OrthogonalState, State, StateMachine
from yasmin_ros import ActionState, MonitorState, PublisherState, ServiceState
from yasmin_ros.basic_outcomes import ABORT, CANCEL, SUCCEED, TIMEOUT
from yasmin_viewer import YasminViewerPub

class Do(State):
    def __init__(self, *outcomes):
        super().__init__(outcomes=list(outcomes) or [SUCCEED])

    def execute(self, blackboard):
        return vendor.result(blackboard["part"])

sm = StateMachine(outcomes=["done", "failed"])
"""


def read(code: str, folder: Path, *, everything: bool = False) -> PythonFile:
    path = folder / "machine.py"
    path.write_text(HEAD + code, "utf-8")
    return PythonProject(Disk()).read(path, everything=everything)


def found(code: str, folder: Path, *, everything: bool = False) -> list[str]:
    """The codes of the findings, each with the code of its line."""
    report = read(code, folder, everything=everything).report
    return [f"{item.code} {item.span.source.line(item.span.line).strip()}" for item in report]


TARGET = {
    "a misspelt one": 'sm.add_state("A", Do(), {SUCCEED: "dine"})  # !',
    "by name, in a machine in another one": """
inner = StateMachine({"over"})
inner.add_state(name="A", state=Do(), transitions={SUCCEED: "done"})  # !
sm.add_state("INNER", inner, {"over": "done"})
""",
    "in a class of the user": """
class Task(StateMachine):
    def __init__(self):
        super().__init__(outcomes=["over"])
        self.add_state("A", Do(), transitions={SUCCEED: "B"})  # !
sm.add_state("TASK", Task(), {"over": "done"})
""",
    "of a machine that a method builds": """
class Robot:
    def __init__(self):
        self.sm = StateMachine(outcomes=["over"])
    def build(self):
        self.sm.add_state("A", Do(), {SUCCEED: "B"})  # !
""",
}
RETURN = {
    "a misspelt one": """
class Grasp(State):
    def __init__(self):
        super().__init__(["held"])
    def execute(self, blackboard):
        return "hold"  # !
sm.add_state("A", Grasp(), {"held": "done"})
""",
    "a constant of yasmin_ros": """
class Grasp(State):
    def __init__(self):
        State.__init__(self, [SUCCEED, ABORT])
    def execute(self, blackboard):
        if blackboard["part"]:
            return SUCCEED
        return CANCEL  # !
sm.add_state("A", Grasp(), {SUCCEED: "done", ABORT: "failed"})
""",
    "of a function": """
def grasp(blackboard):
    return "hold"  # !
sm.add_state("A", CbState({"held"}, grasp), {"held": "done"})
""",
}
UNREACHED = {
    "no transition leads to it": """
sm.add_state("A", Do(), {SUCCEED: "done"})
sm.add_state("B", Do(), {SUCCEED: "done"})  # !
""",
    "only itself": """
sm.add_state("A", Do(), {SUCCEED: "done"})
sm.add_state("B", Do("again", "done"), {"again": "B"})  # !
""",
    "it is before the start state": """
sm.add_state("A", Do(), {SUCCEED: "B"})  # !
sm.add_state("B", Do(), {SUCCEED: "done"})
sm.set_start_state("B")
""",
}
NOTHING = {
    "no return": """
class Wait(State):
    def __init__(self):
        super().__init__([SUCCEED])
    def execute(self, blackboard):  # !
        blackboard["ready"] = True
sm.add_state("A", Wait(), {SUCCEED: "done"})
""",
    "return without a value": """
class Wait(State):
    def __init__(self):
        super().__init__([SUCCEED])
    def execute(self, blackboard):
        vendor.wait()
        return  # !
sm.add_state("A", Wait(), {SUCCEED: "done"})
""",
    "a function": """
def wait(blackboard):  # !
    vendor.wait()
sm.add_state("A", CbState([SUCCEED], wait), {SUCCEED: "done"})
""",
}
UNKNOWN_OUTCOME = {
    "a misspelt one": 'sm.add_state("A", Do("done"), {"dine": "done"})  # !',
    "of a machine": """
inner = StateMachine(["over"])
inner.add_state("A", Do(), {SUCCEED: "over"})
sm.add_state("INNER", inner, transitions={"over": "done", "ovr": "failed"})  # !
""",
    "of a ready-made state": """
sm.add_state("A", PublisherState(vendor.Int, "n", vendor.make),
             {SUCCEED: "done", ABORT: "failed"})  # !
""",
    "of a concurrence": """
both = Concurrence({"L": Do(), "R": Do()}, "no", {"yes": {"L": SUCCEED, "R": SUCCEED}})
sm.add_state("BOTH", both, {"yes": "done", "no": "failed", "maybe": "failed"})  # !
""",
}
UNMAPPED = {
    "of a state": 'sm.add_state("A", Do("held", "lost"), {"held": "done"})  # !',
    "of a machine": """
inner = StateMachine(["over", "late"])
inner.add_state("A", Do("over", "late"))
sm.add_state("INNER", inner, {"over": "done"})  # !
""",
    "of a ready-made state": """
sm.add_state("A", ServiceState(vendor.Srv, "srv", vendor.make), {SUCCEED: "done"})  # !
""",
    "the default outcome of a concurrence": """
both = Concurrence(states={"L": Do()}, default_outcome="no", outcome_map={"yes": {"L": SUCCEED}})
sm.add_state("BOTH", both, {"yes": "done"})  # !
""",
}
OUTCOME_NAME = {
    "a text": 'sm.add_state("done", Do(), {SUCCEED: "failed"})  # !',
    "a constant": """
DONE = "done"
sm.add_state(DONE, Do(), {SUCCEED: "failed"})  # !
""",
    "by name, after a set": """
sm = StateMachine({SUCCEED, ABORT}, True)
sm.add_state(state=Do(), name="aborted", transitions={SUCCEED: SUCCEED})  # !
""",
}
TWICE = {
    "one after the other": """
sm.add_state("A", Do(), {SUCCEED: "done"})
sm.add_state("A", Do(), {SUCCEED: "failed"})  # !
""",
    "in a loop": """
sm.add_state("B", Do(), {SUCCEED: "done"})
for name in ("B",):
    sm.add_state(name, Do(), {SUCCEED: "done"})  # !
""",
    "regions": """
region = StateMachine(["over"])
region.add_state("A", Do(), {SUCCEED: "over"})
other = StateMachine(["over"])
other.add_state("A", Do(), {SUCCEED: "over"})
both = OrthogonalState("no", {"yes": {"L": "over"}})
both.add_region("L", region)
both.add_region("L", other)  # !
sm.add_state("BOTH", both, {"yes": "done", "no": "failed"})
""",
}
START = {
    "a misspelt one": """
sm.add_state("A", Do(), {SUCCEED: "done"})
sm.set_start_state("B")  # !
""",
    "it is added later": """
sm.add_state("A", Do(), {SUCCEED: "B"})
sm.set_start_state("B")  # !
sm.add_state("B", Do("again", "done"), {"again": "A"})
""",
    "an outcome, by name": """
sm.add_state("A", Do(), {SUCCEED: "done"})
sm.set_start_state(state_name="done")  # !
""",
}
NO_WAY_OUT = {
    "of the machine": """
sm.add_state("A", Do(), {SUCCEED: "B"})  # !
sm.add_state("B", Do(), {SUCCEED: "A"})
""",
    "one state": 'sm.add_state("A", Do(), {SUCCEED: "A"})  # !',
    "of a machine in it": """
inner = StateMachine(["over"])
inner.add_state("A", Do("B"))  # !
inner.add_state("B", Do("A"))
sm.add_state("INNER", inner, {"over": "done"})
""",
}
CALL = {
    "class": 'sm.add_state("A", Do, {SUCCEED: "done"})  # !',
    "name": 'sm.add_state("A", Do(), transition={SUCCEED: "done"})  # !',
}
KINDS = {
    "SM101": TARGET, "SM309 returns": RETURN, "SM201": UNREACHED, "SM309": NOTHING,
    "SM102": UNKNOWN_OUTCOME, "SM104": UNMAPPED, "SM806": OUTCOME_NAME, "SM106": TWICE,
    "SM807": START, "SM202": NO_WAY_OUT,
}  # fmt: skip
"""The ten kinds of faults in docs/existing.md, by code; `# !` marks the line of each."""
FAULTS = {**KINDS, "SM808": CALL}
CASES = [(kind, name) for kind, cases in FAULTS.items() for name in cases]


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_what_cannot_work_is_found_at_its_line(kind: str, name: str, tmp_path: Path) -> None:
    code, text = kind.partition(" ")[0], FAULTS[kind][name]
    report = read(text, tmp_path, everything=code == "SM202").report
    (item,) = report
    last = item.span.source.line(item.span.source.position(item.span.end)[0])
    assert item.code == code
    assert "# !" in item.span.source.line(item.span.line) + last


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_the_words_are_those_of_yasmin(kind: str, name: str, tmp_path: Path) -> None:
    for item in read(FAULTS[kind][name], tmp_path, everything=True).report:
        texts = [item.message, item.help or "", item.effect]
        texts += [part.message for part in item.related]
        assert not [text for text in texts if re.search(r"SMACH|userdata|\badd\(", text)]


RIGHT = {
    "an outcome that leads to the state of its name": """
sm.add_state("A", Do("B", "again"), {"again": "A"})
sm.add_state("B", Do("done"))
""",
    "what the blackboard has is not known": """
class Use(State):
    def __init__(self):
        super().__init__(["done"])
        self.add_input_key("part", "its name", "bolt")
        self.add_output_key("place")
    def execute(self, blackboard):
        if "part" in blackboard:
            blackboard["place"] = blackboard["other"]
        return "done"
sm.add_state("A", Use(), remappings={"part": "bolt", "unused": "nut"})
sm(yasmin.Blackboard())
""",
    "the outcomes that only some versions have": """
sm.add_state("A", ActionState(vendor.Move, "move", vendor.goal, None, vendor.result),
             {SUCCEED: "B", ABORT: "failed"})
sm.add_state("B", ActionState(vendor.Move, "move", vendor.goal, timeout=3),
             {SUCCEED: "C", ABORT: "failed", CANCEL: "failed", TIMEOUT: "failed"})
sm.add_state("C", MonitorState(vendor.Pose, "pose", {"near", "far"}, vendor.monitor),
             {"near": "D", "far": "C"})
sm.add_state("D", MonitorState(vendor.Pose, "pose", ["near"], vendor.monitor, timeout=1),
             {"near": "E", TIMEOUT: "D"})
sm.add_state("E", PublisherState(vendor.Int, "n", vendor.make), {SUCCEED: "F"})
sm.add_state("F", yasmin_ros.ServiceState(vendor.Srv, "s", vendor.make, ["late"]),
             {SUCCEED: "done", ABORT: "failed", "late": "failed"})
""",
    "a ready-made state without outcomes of its own, or one that a condition selects": """
sm.add_state("A", MonitorState(vendor.Pose, "pose", set(), vendor.monitor), {CANCEL: "B"})
sm.add_state("B", ServiceState(vendor.Srv, "s", vendor.make) if vendor.fast()
             else ActionState(vendor.Move, "move", vendor.goal),
             {SUCCEED: "done", ABORT: "failed", CANCEL: "failed"})
""",
    "a state that another one replaces after an exception": """
try:
    sm.add_state("A", Do(), {SUCCEED: vendor.after()})
except RuntimeError:
    sm.add_state("A", Do("done"))
""",
    "code of a state that is derived from a ready-made one": """
class Move(ActionState):
    def __init__(self):
        super().__init__(vendor.Move, "move", self.goal, set(), self.result)
    def goal(self, blackboard):
        return vendor.Move.Goal()
    def execute(self, blackboard):
        return TIMEOUT if vendor.late() else super().execute(blackboard)
sm.add_state("A", Move(), {SUCCEED: "done", ABORT: "failed"})
""",
    "a start state that is not known": """
sm.add_state("A", Do(), {SUCCEED: "B"})
sm.add_state("B", Do(), {SUCCEED: "done"})
sm.set_start_state(vendor.first())
""",
    "a start state that a condition selects": """
sm.add_state("A", Do(), {SUCCEED: "B"})
sm.add_state("B", Do(), {SUCCEED: "done"})
if vendor.fast():
    sm.set_start_state("B")
""",
    "a start state among states that are not known": """
vendor.fill(sm)
sm.set_start_state("A")
""",
    "states that a loop over unknown names adds": """
for name in vendor.names():
    sm.add_state(name, Do(), {SUCCEED: vendor.after(name)})
sm.set_start_state("A")
""",
    "outcomes that are not known": """
sm = StateMachine(vendor.outcomes())
sm.add_state("A", Do("held", "lost"), {"held": "B"})
sm.add_state("B", vendor.Do(), {"ok": "done"})
""",
    "a state of a class that is not known": """
sm.add_state("A", vendor.Do(), {"ok": "done", "bad": "failed"})
""",
    "a name that a condition selects": """
sm.add_state("A" if vendor.fast() else "done", Do(), {SUCCEED: "done"})
""",
    "states that two branches add": """
if vendor.fast():
    sm.add_state("A", Do("ok"), {"ok": "done"})
else:
    sm.add_state("A", Do("no"), {"no": "failed"})
""",
    "a method adds the states": """
class Robot:
    def __init__(self):
        self.sm = StateMachine(outcomes=["over"])
        self.sm.add_state("A", Do(), {SUCCEED: "B"})
    def more(self):
        self.sm.add_state("B", Do(), {SUCCEED: "over"})
""",
    "a class that changes how states are added": """
class Safe(StateMachine):
    def add_state(self, name, state, transitions):
        super().add_state(name, state, {**transitions, ABORT: "over"})
safe = Safe(["over"])
safe.add_state("A", Do(SUCCEED, ABORT), {SUCCEED: "B"})
sm.add_state("SAFE", safe, {"over": "done"})
""",
    "a machine with a name": """
sm = StateMachine("pick", ["done"], True)
sm.add_state("A", Do("done"))
other = StateMachine(name="place", outcomes=["done"])
other.add_state("A", Do("done"))
""",
    "a concurrence with states and rules that are not known": """
both = Concurrence(vendor.states(), "no", {"yes": {"L": "ok"}})
sm.add_state("A", both, {"yes": "B", "no": "B"})
sm.add_state("B", Concurrence({"L": Do(), "R": vendor.Do()}, "no", vendor.rules()),
             {"yes": "done", "no": "failed"})
""",
    "a concurrence whose rules name outcomes of ready-made states": """
both = Concurrence({"L": ServiceState(vendor.Srv, "s", vendor.make), "R": Do()}, ABORT,
                   {SUCCEED: {"L": SUCCEED}, CANCEL: {"L": CANCEL, "R": SUCCEED}})
sm.add_state("BOTH", both, {SUCCEED: "done", ABORT: "failed", CANCEL: "failed"})
""",
    "regions that wait for each other": """
both = OrthogonalState(default_outcome="no", outcome_map={"yes": {"L": "over", "R": "over"}})
for name in "LR":
    region = StateMachine(["over"])
    region.set_name(name)
    region.add_state("A", Do(), {SUCCEED: "JOIN"})
    region.add_state("JOIN", JoinState("middle"), {"joined": "over"})
    both.add_region(name, region)
sm.add_state("BOTH", both, {"yes": "done", "no": "failed"})
""",
    "what is no part of the machine": """
pub = YasminViewerPub(sm, "TASK")
sm.add_start_cb(vendor.call)
sm.set_description("a task")
yasmin_ros.set_ros_loggers()
yasmin.YASMIN_LOG_INFO(str(sm))
sm.add_state("A", Do(), {SUCCEED: "done"})
sm.validate(True)
""",
    "an endless loop, which can be wanted": """
sm.add_state("A", Do(), {SUCCEED: "A"})
""",
    "a member that code examines first": """
import machine
if hasattr(machine, "prepare"):
    machine.prepare()
sm.add_state("A", Do("done"))
""",
}


@pytest.mark.parametrize("name", RIGHT)
def test_what_can_work_gets_no_finding(name: str, tmp_path: Path) -> None:
    assert found(RIGHT[name], tmp_path) == []


def test_all_rules_of_smach_are_not_about_yasmin(tmp_path: Path) -> None:
    names = [name for name in RIGHT if "endless" not in name]
    assert [found(RIGHT[name], tmp_path, everything=True) for name in names] == [[]] * len(names)


def test_a_wrong_rule_of_a_concurrence(tmp_path: Path) -> None:
    code = """
both = Concurrence({"L": Do(), "R": Do()}, "no", {"yes": {"L": SUCCEED, "R": "okk"}})
sm.add_state("BOTH", both, {"yes": "done", "no": "failed"})
"""
    (item,) = read(code, tmp_path).report
    assert item.code == "SM403"
    assert item.effect.startswith("YASMIN raises an exception")


GRAPH = """
inner = StateMachine({"over"})
inner.add_state("LOOK", Do("WAIT", "over"))
inner.add_state("WAIT", Do(), {SUCCEED: "LOOK"})
both = Concurrence({"L": Do(), "R": inner}, "no", {"yes": {"L": SUCCEED, "R": "over"}})
sm.add_state("BOTH", both, {"yes": "MOVE", "no": "failed"})
sm.add_state("MOVE", ActionState(vendor.Move, "move", vendor.goal), {SUCCEED: "done",
             ABORT: "BOTH", CANCEL: "failed"}, {"pose": "place"})
sm.set_start_state("MOVE")
sm()
"""


def test_the_graph(tmp_path: Path) -> None:
    file = read(GRAPH, tmp_path)
    (graph,) = file.graphs
    assert file.coverage is not None
    assert (file.coverage.states, file.coverage.exact) == (6, 6)
    assert (
        "\n".join(graph_lines(graph))
        == """\
sm: StateMachine [done, failed]
  first MOVE
  BOTH: Concurrence [yes, no]
    - yes -> MOVE
    - no -> failed
    ends with all, else no
    yes after L/succeeded, R/over
    L: Do [succeeded]
    R: StateMachine [over]
      first LOOK
      LOOK: Do (WAIT, over) [WAIT, over]
        - WAIT -> WAIT
        - over -> over
      WAIT: Do [succeeded]
        - succeeded -> LOOK
  MOVE: ActionState [canceled, succeeded, aborted]
    - succeeded -> done
    - aborted -> BOTH
    - canceled -> failed
    - pose = place"""
    )


def test_import_proves_the_script(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    read(GRAPH, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["import", "machine.py", "-o", "project"]) == 0
    assert "proof: the graph of main.yml is the graph of machine.py" in capsys.readouterr().out
    assert main(["check", "project/main.yml", "-q"]) == 0


def test_folders_and_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    read(GRAPH, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["check", ".", "--python"]) == 0
    assert "6 of 6 states exact" in capsys.readouterr().out
    assert main(["build", "machine.py", "--target", "dot", "-o", "-"]) == 0
    assert "MOVE" in capsys.readouterr().out

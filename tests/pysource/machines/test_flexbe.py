"""Behaviors in Python for FlexBE: the faults with which they cannot work, and no false alarm."""

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
from flexbe_core import Autonomy, Behavior, ConcurrencyContainer, EventState, Logger
from flexbe_core import OperatableStateMachine, PriorityContainer
from flexbe_states.calculation_state import CalculationState
from flexbe_states.decision_state import DecisionState
from flexbe_states.input_state import InputState
from flexbe_states.log_state import LogState
from flexbe_states.wait_state import WaitState

add = OperatableStateMachine.add

class Do(EventState):
    def __init__(self, *outcomes):
        super().__init__(outcomes=list(outcomes) or ["done"])

    def execute(self, userdata):
        return vendor.result()

class Use(EventState):
    def __init__(self):
        super(Use, self).__init__(outcomes=["done"], input_keys=["part"])

    def on_enter(self, userdata):
        vendor.start(userdata.part)

    def execute(self, userdata):
        if vendor.ready():
            return "done"

class Make(EventState):
    def __init__(self):
        EventState.__init__(self, outcomes=["done"], output_keys=["part"])

    def execute(self, userdata):
        return "done"

    def on_exit(self, userdata):
        userdata.part = vendor.part()
"""

BEHAVIOR = """
class TaskSM(Behavior):
    def __init__(self, node):
        super().__init__()
        self.name = "Task"
        self.add_parameter("speed", 2.0)
        OperatableStateMachine.initialize_ros(node)
        Logger.initialize(node)

    def create(self):
        _state_machine = OperatableStateMachine(outcomes=["finished", "failed"])
"""


def read(code: str, folder: Path, *, everything: bool = False, head: str = "") -> PythonFile:
    """The machines of a behavior; `code` is the end of `create`, with classes before `---`."""
    before, found, body = code.rpartition("---\n")
    lines = "".join(f"        {line}\n" for line in body.splitlines())
    end = "        return _state_machine\n"
    path = folder / "machine.py"
    path.write_text(f"{HEAD}{before if found else head}{BEHAVIOR}{lines}{end}", "utf-8")
    return PythonProject(Disk()).read(path, everything=everything)


def found(code: str, folder: Path, *, everything: bool = False) -> list[str]:
    """The codes of the findings, each with the code of its line."""
    report = read(code, folder, everything=everything).report
    return [f"{item.code} {item.span.source.line(item.span.line).strip()}" for item in report]


TARGET = {
    "a misspelt one": """
with _state_machine:
    add("A", Do(), transitions={"done": "finishd"}, autonomy={"done": Autonomy.Off})  # !
""",
    "the outcome of another container": """
inner = OperatableStateMachine(outcomes=["over"])
with inner:
    add("A", WaitState(1), transitions={"done": "finished"})  # !
with _state_machine:
    add("I", inner, transitions={"over": "finished"})
""",
    "in a priority container": """
inner = PriorityContainer(outcomes=["over"])
with inner:
    PriorityContainer.add("A", LogState("go", Logger.REPORT_HINT), {"done": "B"})  # !
with _state_machine:
    add("I", inner, {"over": "finished"})
""",
}
RETURN = {
    "a misspelt one": """
class Grasp(EventState):
    def __init__(self):
        super().__init__(outcomes=["held"])
    def execute(self, userdata):
        return "hold"  # !
---
with _state_machine:
    add("A", Grasp(), transitions={"held": "finished"})
""",
    "of a base class": """
class Grasp(EventState):
    def __init__(self, *more):
        super().__init__(outcomes=["held", *more])
    def execute(self, userdata):
        return "hold" if vendor.held() else None  # !
class Grip(Grasp):
    def __init__(self):
        super(Grip, self).__init__("lost")
---
with _state_machine:
    add("A", Grip(), {"held": "finished", "lost": "failed"})
""",
    "in a concurrency container": """
class Grasp(EventState):
    def __init__(self):
        super().__init__(outcomes=["held"])
    def execute(self, userdata):
        return "hold"  # !
---
both = ConcurrencyContainer(outcomes=["over"], conditions=[("over", [("A", "held")])])
with both:
    add("A", Grasp(), transitions={"held": "over"})
with _state_machine:
    add("BOTH", both, transitions={"over": "finished"})
""",
}
UNMAPPED = {
    "of a state": """
with _state_machine:
    add("A", Do("held", "lost"), transitions={"held": "finished"})  # !
""",
    "with the name of an outcome of the container": """
with _state_machine:
    add("A", Do("failed", "held"), transitions={"held": "finished"})  # !
""",
    "of a ready-made state": """
with _state_machine:
    add("A", InputState(0, "?"), {"received": "finished", "aborted": "failed",
        "no_connection": "failed"})  # !
""",
    "of classes that modules of flexbe_core define": """
import flexbe_core.core.operatable_state_machine as machines
from flexbe_core.core.event_state import EventState as Base
class Grasp(Base):
    def __init__(self):
        super().__init__(outcomes=["held", "lost"])
    def execute(self, userdata):
        return "held"
---
with _state_machine:
    machines.OperatableStateMachine.add("A", Grasp(), {"held": "finished"})  # !
""",
}
OTHER_OUTCOME = {
    "a misspelt one": """
with _state_machine:
    add("A", Do("held", "lost"), transitions={"held": "finished", "lots": "failed"})  # !
""",
    "of a container": """
inner = OperatableStateMachine(outcomes=["over"])
with inner:
    add("A", Do(), transitions={"done": "over"})
with _state_machine:
    add("I", inner, transitions={"ovr": "finished"})  # !
""",
    "of a ready-made state": """
_state_machine.userdata.side = 1
with _state_machine:
    add("A", DecisionState(["left", "right"], lambda x: x), {"left": "finished",
        "rihgt": "failed"}, remapping={"input_value": "side"})  # !
""",
}
OUTCOME_NAME = {
    "a text": """
with _state_machine:
    add("finished", Do(), transitions={"done": "failed"})  # !
""",
    "a constant": """
name = "failed"
with _state_machine:
    add(name, Do(), transitions={"done": "finished"})  # !
""",
    "in a concurrency container": """
both = ConcurrencyContainer(conditions=[("over", [("over", "done")])], outcomes=["over"])
with both:
    add("over", Do(), transitions={"done": "over"})  # !
with _state_machine:
    add("BOTH", both, {"over": "finished"})
""",
}
TWICE = {
    "one after the other": """
with _state_machine:
    add("A", Do(), transitions={"done": "finished"})
    add("A", Do(), transitions={"done": "failed"})  # !
""",
    "in a loop": """
with _state_machine:
    add("A", Do(), transitions={"done": "finished"})
    for name in ("A",):
        add(name, Do(), transitions={"done": "failed"})  # !
""",
    "in a concurrency container": """
both = ConcurrencyContainer(outcomes=["over"], conditions=[("over", [("A", "done")])])
with both:
    add("A", Do(), {"done": "over"})
    add("A", Do(), {"done": "over"})  # !
with _state_machine:
    add("BOTH", both, {"over": "finished"})
""",
}
UNSET = {
    "it is set later": """
with _state_machine:
    add("A", Use(), transitions={"done": "B"})  # !
    add("B", Make(), transitions={"done": "finished"})
""",
    "by another name": """
with _state_machine:
    add("A", Use(), {"done": "finished"}, {"done": Autonomy.Off}, {"part": "bolt"})  # !
""",
    "its container has it": """
_state_machine.userdata.part = 3
inner = OperatableStateMachine(outcomes=["over"])
with inner:
    add("A", Use(), transitions={"done": "over"})  # !
with _state_machine:
    add("I", inner, transitions={"over": "finished"})
""",
}
UNDECLARED = {
    "reads in on_enter": """
class Read(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"], output_keys=["part"])
    def on_enter(self, userdata):
        vendor.start(userdata.part)  # !
    def execute(self, userdata):
        return "done"
---
with _state_machine:
    add("A", Read(), transitions={"done": "finished"})
""",
    "reads in on_exit": """
class Read(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])
    def execute(self, userdata):
        return "done"
    def on_exit(self, userdata):
        vendor.stop(userdata["part"])  # !
---
with _state_machine:
    add("A", Read(), transitions={"done": "finished"})
""",
    "reads before it sets": """
class Count(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"], output_keys=["count"])
    def execute(self, userdata):
        userdata.count = userdata.count + 1  # !
        return "done"
---
with _state_machine:
    add("A", Count(), transitions={"done": "finished"})
""",
}
WRITES = {
    "in execute": """
class Write(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["part"])
    def execute(self, userdata):
        userdata.part = 3  # !
        return "done"
---
_state_machine.userdata.part = 2
with _state_machine:
    add("A", Write(), transitions={"done": "finished"})
""",
    "in on_enter": """
class Write(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])
    def on_enter(self, userdata):
        userdata.part = 3  # !
    def execute(self, userdata):
        return "done"
---
with _state_machine:
    add("A", Write(), transitions={"done": "finished"})
""",
    "in a method that execute calls": """
class Write(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])
    def execute(self, userdata):
        self._keep(userdata)
        return "done"
    def _keep(self, userdata):
        userdata.part = 3  # !
---
with _state_machine:
    add("A", Write(), transitions={"done": "finished"})
""",
}
CONDITION = {
    "an unknown outcome": """
both = ConcurrencyContainer(outcomes=["over"], conditions=[
    ("over", [("A", "done")]),
    ("over", [("B", "dine")]),  # !
])
with both:
    add("A", Do(), transitions={"done": "over"})
    add("B", Do(), transitions={"done": "over"})
with _state_machine:
    add("BOTH", both, transitions={"over": "finished"})
""",
    "an unknown state": """
both = ConcurrencyContainer(outcomes=["over"], conditions=[
    ("over", [("A", "done"), ("C", "done")]),  # !
])
with both:
    add("A", Do(), transitions={"done": "over"})
    add("B", Do(), transitions={"done": "over"})
with _state_machine:
    add("BOTH", both, transitions={"over": "finished"})
""",
    "no state": """
both = ConcurrencyContainer([("over", [])], outcomes=["over"])  # !
with both:
    add("A", Do(), transitions={"done": "over"})
with _state_machine:
    add("BOTH", both, transitions={"over": "finished"})
""",
}
CALL = {
    "an argument that is missing": """
with _state_machine:
    OperatableStateMachine.add("A", Do())  # !
""",
    "a parameter that does not exist": """
with _state_machine:
    add("A", Do(), {"done": "finished"}, remappings={"part": "bolt"})  # !
""",
    "a class in place of a state": """
with _state_machine:
    add("A", Make, transitions={"done": "finished"})  # !
""",
}
KINDS = {
    "SM101": TARGET, "SM309": RETURN, "SM104": UNMAPPED, "SM102": OTHER_OUTCOME,
    "SM806": OUTCOME_NAME, "SM106": TWICE, "SM301": UNSET, "SM310": UNDECLARED, "SM308": WRITES,
    "SM403": CONDITION, "SM808": CALL,
}  # fmt: skip
"""Kinds of faults by code, the first ten as in docs/existing.md; `# !` marks the line of each."""
OTHER_CODES = {"by another name": "SM302", "its container has it": "SM303"}
CASES = [(kind, name) for kind, cases in KINDS.items() for name in cases]


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_what_cannot_work_is_found_at_its_line(kind: str, name: str, tmp_path: Path) -> None:
    (item,) = read(KINDS[kind][name], tmp_path).report
    last = item.span.source.line(item.span.source.position(item.span.end)[0])
    assert item.code == OTHER_CODES.get(name, kind)
    assert "# !" in item.span.source.line(item.span.line) + last


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_the_words_are_those_of_flexbe(kind: str, name: str, tmp_path: Path) -> None:
    for item in read(KINDS[kind][name], tmp_path, everything=True).report:
        texts = [item.message, item.help or "", item.effect]
        texts += [part.message for part in item.related]
        assert not [text for text in texts if re.search(r"SMACH|smach|add_state", text)]


RIGHT = {
    "None means that a state stays active": """
class Wait(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])
    def execute(self, userdata):
        if not vendor.ready():
            return None
        if vendor.late():
            return
        return "done"
class Never(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])
    def execute(self, userdata):
        pass
---
with _state_machine:
    add("A", Wait(), transitions={"done": "B"})
    add("B", Never(), transitions={"done": "finished"})
""",
    "a state reads what it has set": """
class Make2(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"], output_keys=["parts", "place"])
    def on_enter(self, userdata):
        userdata.place = 3
    def execute(self, userdata):
        userdata.parts = []
        userdata.parts.append(userdata.place)
        return "done"
    def on_exit(self, userdata):
        vendor.keep(userdata.parts)
---
with _state_machine:
    add("A", Make2(), transitions={"done": "finished"})
""",
    "a state sets a key of a try before it reads it": """
class Make2(EventState):
    def __init__(self):
        super().__init__(outcomes=["done", "failed"], output_keys=["parts"])
    def execute(self, userdata):
        try:
            userdata.parts = vendor.parts()
        except Exception as error:
            return "failed"
        return "done" if userdata.parts else "failed"
---
with _state_machine:
    add("A", Make2(), transitions={"done": "finished", "failed": "failed"})
""",
    "a key by item need not be declared": """
class Keep(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])
    def execute(self, userdata):
        userdata["part"] = 3
        return "done"
---
with _state_machine:
    add("A", Keep(), transitions={"done": "finished"})
""",
    "preempted needs no transition and is always a target": """
inner = OperatableStateMachine(outcomes=["over"])
with inner:
    add("A", Do("done", "preempted"), transitions={"done": "preempted"})
    add("B", Do(), transitions={"done": "over"})
with _state_machine:
    add("I", inner, transitions={"over": "finished"})
""",
    "a transition makes an outcome": """
class Odd(EventState):
    def __init__(self):
        super().__init__(["done"])  # FlexBE accepts names only
    def execute(self, userdata):
        return "odd" if vendor.odd() else "done"
---
with _state_machine:
    add("A", Odd(), transitions={"done": "finished", "odd": "failed", "more": "failed"})
""",
    "an input key of the behavior": """
_state_machine = OperatableStateMachine(outcomes=["finished", "failed"], input_keys=["part"])
with _state_machine:
    add("A", Use(), transitions={"done": "finished"}, remapping={"part": "part", "odd": "even"})
""",
    "a key of the behavior in a container": """
_state_machine.userdata.bolt = None
inner = OperatableStateMachine(outcomes=["over"], input_keys=["part"], output_keys=["part"])
with inner:
    add("A", Use(), transitions={"done": "B"})
    add("B", Make(), transitions={"done": "over"})
with _state_machine:
    add("I", inner, {"over": "finished"}, {"over": Autonomy.Inherit}, {"part": "bolt"})
""",
    "a state that no path reaches": """
with _state_machine:
    add("A", Do(), transitions={"done": "finished"})
    add("B", Do(), transitions={"done": "A"})
""",
    "parameters select outcomes": """
with _state_machine:
    if self.speed > 1:
        add("A", Do("left", "right"), {"left": "B", "right": "finished"})
    else:
        add("A", Do("up"), {"up": "B"})
    add("B", WaitState(self.speed), transitions={"done": "finished"})
    add("C", DecisionState(self.choices, lambda x: x), {"left": "A", "right": "B"})
""",
    "a state of a class that is not known": """
with _state_machine:
    add("A", vendor.Do(), {"ok": "finished", "bad": "failed"})
    add("B", CalculationState(lambda x: x), {"done": "finished"}, remapping={"input_value": "x"})
""",
    "the first condition that holds, and no condition for an outcome": """
both = ConcurrencyContainer(outcomes=["one", "two", "none"], conditions=[
    ("one", [("A", "done")]), ("two", [("A", "done"), ("B", "done")])])
with both:
    add("A", Do(), transitions={"done": "one"})
    add("B", Do(), transitions={"done": "two"})
with _state_machine:
    add("BOTH", both, transitions={"one": "C", "two": "D", "none": "failed"})
    add("C", Do(), transitions={"done": "finished"})
    add("D", Do(), transitions={"done": "finished"})
""",
    "keys that are not known": """
_state_machine.userdata.bolt = 1
inner = OperatableStateMachine(outcomes=["over"], input_keys=vendor.keys())
with inner:
    add("A", Use(), transitions={"done": "over"})
maker = OperatableStateMachine(outcomes=["over"], output_keys=vendor.keys())
with maker:
    add("A", Make(), transitions={"done": "over"})
_state_machine.userdata.bolt = 1
with _state_machine:
    add("I", inner, transitions={"over": "M"}, remapping={"part": "bolt"})
    add("M", maker, transitions={"over": "USE"})
    add("USE", Use(), transitions={"done": "finished"})
""",
    "conditions that are not known": """
both = ConcurrencyContainer(outcomes=["over"], conditions=vendor.conditions())
with both:
    add("A", Do(), transitions={"done": "over"})
with _state_machine:
    add("BOTH", both, transitions={"over": "finished"})
""",
    "outcomes that some versions have": """
with _state_machine:
    add("A", InputState(0, "?"), {"received": "finished", "aborted": "failed",
        "no_connection": "failed", "data_error": "failed", "timeout": "A"})
""",
    "another behavior that is not known": """
with _state_machine:
    add("A", self.use_behavior(vendor.OtherSM, "A"), transitions={"finished": "finished"})
""",
}


@pytest.mark.parametrize("name", RIGHT)
def test_what_can_work_gets_no_finding(name: str, tmp_path: Path) -> None:
    assert found(RIGHT[name], tmp_path) == []


def test_all_rules_of_smach_are_not_about_flexbe(tmp_path: Path) -> None:
    for name in RIGHT:
        codes = {line.partition(" ")[0] for line in found(RIGHT[name], tmp_path, everything=True)}
        assert codes <= {"SM201", "SM202"}, name


EMBEDDED = """
class PartSM(Behavior):
    def create(self):
        _state_machine = OperatableStateMachine(outcomes=["over"], input_keys=["part", "side"])
        _state_machine.userdata.part = 1
        _state_machine.userdata.side = 2
        with _state_machine:
            add("USE", Use(), transitions={"done": "over"})
        return _state_machine
class WholeSM(Behavior):
    def __init__(self, node):
        super().__init__()
        self.add_behavior(PartSM, "First/Part", node)
        self.add_behavior(PartSM, "Second", node)
    def create(self):
        _state_machine = OperatableStateMachine(outcomes=["finished"])
        with _state_machine:
            add("FIRST", self.use_behavior(PartSM, "First/Part", default_keys=["part"]),
                transitions={"over": "SECOND"})
            add("SECOND", self.use_behavior(PartSM, "Second", parameters={"speed": 1}),
                transitions={"over": "finished"})  # !
        return _state_machine
"""


def test_another_behavior_is_a_container(tmp_path: Path) -> None:
    file = read("with _state_machine:\n    add('A', Do(), {'done': 'finished'})", tmp_path,
                head=EMBEDDED)  # fmt: skip
    graphs = {graph.machine.root.name: graph for graph in file.graphs}
    assert [*graphs] == ["PartSM", "WholeSM", "TaskSM"]
    assert (
        "\n".join(graph_lines(graphs["WholeSM"]))
        == """\
WholeSM: StateMachine [finished]
  first FIRST
  FIRST: StateMachine [over] reads side;
    - over -> SECOND
    first USE
    USE: Use [done] reads part;
      - done -> over
  SECOND: StateMachine [over] reads part, side;
    - over -> finished
    first USE
    USE: Use [done] reads part;
      - done -> over"""
    )
    (item,) = file.report
    assert (item.code, item.finding.node) == ("SM301", "WholeSM/SECOND")


GRAPH = """
both = ConcurrencyContainer(outcomes=["yes", "no"], input_keys=["part"], conditions=[
    ("yes", [("L", "done"), ("R", "done")]), ("no", [("R", "preempted")]), ("no", [("L", "lost")])])
with both:
    add("L", Do("done", "lost"), transitions={"done": "yes", "lost": "no"})
    add("R", Do("done", "preempted"), transitions={"done": "yes"})
_state_machine.userdata.bolt = 3
with _state_machine:
    add("BOTH", both, {"yes": "USE", "no": "failed"}, remapping={"part": "bolt"})
    add("USE", Use(), {"done": "finished", "odd": "failed"}, remapping={"part": "bolt"})
"""


def test_the_graph(tmp_path: Path) -> None:
    file = read(GRAPH, tmp_path)
    (graph,) = file.graphs
    assert file.coverage is not None
    assert (file.coverage.states, file.coverage.exact) == (4, 4)
    assert (
        "\n".join(graph_lines(graph))
        == """\
TaskSM: StateMachine [finished, failed, preempted]
  first BOTH
  BOTH: Concurrence [yes, no, preempted] reads part;
    - yes -> USE
    - no -> failed
    - preempted -> preempted
    - part = bolt
    ends with rule, else \n\
    preempted after R/preempted
    yes after L/done, R/done
    no after R/preempted
    no after L/lost
    L: Do [done, lost]
    R: Do (done, preempted) [done, preempted]
  USE: Use [done] reads part;
    - done -> finished
    - part = bolt"""
    )


@pytest.mark.parametrize("target", ["dot", "mermaid", "html"])
def test_pictures(target: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read(GRAPH, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["build", "machine.py", "--target", target, "-o", "out"]) == 0
    (text,) = [path.read_text("utf-8") for path in (tmp_path / "out").iterdir()]
    assert ('"rule"' if target == "html" else "first rule that holds") in text

"""Generated behaviors of FlexBE: their form, their operator, and requests to stop from outside."""

from __future__ import annotations

import logging
import sys
import threading
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import smachac
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.ir.nodes import Checked
from smachac.runtime import smach
from smachac.targets.flexbe import TARGET
from tests.flexbe import stand_in
from tests.flexbe.programs import loaded, ready, trace
from tests.verify.test_executives import OWN

ROOT = Path(__file__).parents[2]
LIBRARY = disk_library(ROOT / "main.yml", [])
CONTROLLED = 3
"""The highest level of autonomy: each outcome is accepted, and an operator is connected."""


@pytest.fixture(autouse=True)
def _no_log(silent_smach: None) -> None:
    logging.getLogger("flexbe").setLevel(logging.CRITICAL)


def files_of(text: str, library: Any = LIBRARY, **options: str) -> tuple[dict[str, str], Report]:
    checked = analyse(Source("main.yml", text), library, []).checked
    assert checked is not None
    report: Report = []
    return build(checked, TARGET, library, report, options=options), report


def text_of(files: dict[str, str], name: str) -> str:
    (found,) = (text for path, text in files.items() if path.rpartition("/")[2] == name)
    return found


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


def at_visit(machine: Any, path: str, function: Any) -> list[str]:
    """Call a function when a state is entered; the events of the run."""
    events: list[str] = []

    def observe(event: dict[str, Any]) -> None:
        events.append(f"{event['event']} {event['path']}")
        if (event["event"], event["path"]) == ("enter", path):
            function()

    machine.observe(observe)
    return events


def by_flag() -> None:
    stand_in.Behavior.preempt()


def by_topic() -> None:
    stand_in.TOPICS["preempt"] = None


@pytest.mark.parametrize(
    ("ask", "level"), [(by_flag, 255), (by_flag, CONTROLLED), (by_topic, CONTROLLED)]
)
@pytest.mark.parametrize("where", ["wait/BOTH/SLEEP", "wait/BOTH/OTHER", "wait/COUNT"])
def test_a_preempt_of_flexbe_is_a_request_to_the_machine(ask: Any, level: int, where: str) -> None:
    """FlexBE alone would end the behavior as `preempted` before a state can react."""
    files, _ = files_of(WAITING)
    with loaded(files) as made:
        behavior = ready(made, level)
        events = at_visit(behavior._state_machine, where, ask)
        assert behavior.execute() == "preempted"
        assert stand_in.PreemptableState.preempt is False
        assert events[-3:-1] == ["exit wait/BOTH", "transition wait/BOTH"]
        assert {"exit wait/BOTH/SLEEP", "exit wait/BOTH/OTHER"} <= set(events)


INTERFACES = {
    "Work": "outcomes: {done: {}, left: {}, preempted: {}}\n",
    "Fails": "outcomes: {done: {}}\n",
}

ONE = """\
name: sm
outcomes: [done, left, preempted]
states:
  - A: {template: Work, transitions: {done: done, left: left, preempted: preempted}}
"""


class Work(smach.State):
    """A state that works until `go` is set, or until it is to stop."""

    entered: threading.Event
    go: threading.Event
    outcome = "done"

    def __init__(self) -> None:
        smach.State.__init__(self, ["done", "left", "preempted"])

    def execute(self, userdata: Any) -> str:
        Work.entered.set()
        Work.go.wait()
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return Work.outcome

    def request_preempt(self) -> None:
        smach.State.request_preempt(self)
        Work.go.set()


class Fails(smach.State):
    text = "50 % of %s"

    def __init__(self) -> None:
        smach.State.__init__(self, ["done"])

    def execute(self, userdata: Any) -> str:
        raise ValueError(self.text)


@contextmanager
def behavior_of(text: str, level: int = 255, **inputs: Any) -> Iterator[Any]:
    """A behavior whose states are the classes above."""
    templates = {
        f"templates/{name}.yml": f"name: {name}\n{found}code: {{python: 'robot_states:{name}'}}\n"
        for name, found in INTERFACES.items()
    }
    module = sys.modules["robot_states"] = ModuleType("robot_states")
    vars(module).update(Work=Work, Fails=Fails)
    Work.entered, Work.go = threading.Event(), threading.Event()
    try:
        files, report = files_of(text, memory_library(templates, LIBRARY))
        assert report == []
        with loaded(files) as made:
            yield ready(made, level, inputs)
    finally:
        Work.go.set()
        del sys.modules["robot_states"]


def test_a_tick_does_not_wait_for_the_work() -> None:
    with behavior_of(ONE) as behavior:
        machine = behavior._state_machine
        assert machine.execute(None) is None
        Work.entered.wait()
        assert machine.execute(None) is None
        Work.go.set()
        assert behavior.execute() == "done"


def test_an_operator_chooses_an_outcome() -> None:
    """The work is requested to stop, and the behavior goes on."""
    with behavior_of(ONE, CONTROLLED) as behavior:
        machine = behavior._state_machine
        assert machine.execute(None) is None
        Work.entered.wait()
        stand_in.TOPICS["transition"] = ("A", 1)
        assert behavior.execute() == "left"
        assert Work.go.is_set()


def test_a_preempt_reaches_a_paused_state() -> None:
    with behavior_of(ONE, CONTROLLED) as behavior:
        machine = behavior._state_machine
        assert machine.execute(None) is None
        stand_in.TOPICS["pause"] = True
        assert machine.execute(None) is None
        assert stand_in.PriorityContainer.active_container == "/A"
        by_topic()
        assert behavior.execute() == "preempted"
        assert stand_in.PriorityContainer.active_container is None


@pytest.mark.parametrize("answers", [True, False])
def test_an_operator_leaves_a_state_and_comes_back(
    monkeypatch: pytest.MonkeyPatch, answers: bool
) -> None:
    """The next visit waits for the work that was left; the request to stop was for that alone."""
    if not answers:
        monkeypatch.setattr(Work, "preempt_requested", lambda self: False)
    again = ONE.replace("left: left", "left: A")
    with behavior_of(again, CONTROLLED) as behavior:
        machine = behavior._state_machine
        entered: list[str] = []
        machine.observe(lambda event: entered.append(event["event"]))
        assert machine.execute(None) is None
        Work.entered.wait()
        stand_in.TOPICS["transition"] = ("A", 1)
        assert machine.execute(None) is None
        assert behavior.execute() == "done"
        assert entered.count("enter") == 2
        (state,) = machine._states
        assert smach.State.preempt_requested(state.work) is False


def test_an_outcome_waits_for_its_level_of_autonomy() -> None:
    with behavior_of(ONE, 0) as behavior:
        machine = behavior._state_machine
        Work.go.set()
        for _ in range(3):
            assert machine.execute(None) is None
            machine._states[0].visit.join()
        stand_in.OperatableStateMachine.autonomy_level = CONTROLLED
        assert behavior.execute() == "done"


FAILING = """\
name: sm
outcomes: [done, caught]
states:
  - A: {template: Fails, transitions: {done: done}}
"""


def test_an_exception_ends_the_behavior() -> None:
    """FlexBE alone would keep the state active; its log cannot print a message with `%`."""
    with behavior_of(FAILING) as behavior, pytest.raises(ValueError, match="50 % of %s"):
        behavior.execute()


@pytest.mark.parametrize("text", ["", "100 %", "%d"])
def test_an_exception_in_a_concurrence_ends_the_behavior(text: str) -> None:
    script = """\
name: sm
outcomes: [done]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      states:
        - A: {template: Fails}
        - B: {template: Work}
      transitions: {done: done}
"""
    Fails.text = text
    with behavior_of(script) as behavior, pytest.raises(ValueError, match=f"^{text}$"):
        behavior.execute()
    Fails.text = "50 % of %s"


def test_an_exception_becomes_an_outcome() -> None:
    caught = FAILING.replace("{done: done}}", "{done: done, error: caught}}")
    with behavior_of(caught) as behavior:
        assert behavior.execute() == "caught"


def test_an_outcome_that_is_not_declared_ends_the_behavior() -> None:
    Work.outcome = "strange"
    try:
        with behavior_of(ONE) as behavior:
            Work.go.set()
            with pytest.raises(stand_in.StateError, match="'strange' is not registered"):
                behavior.execute()
    finally:
        Work.outcome = "done"


def test_a_stop_of_the_engine_stops_the_work() -> None:
    with behavior_of(ONE) as behavior:
        assert behavior._state_machine.execute(None) is None
        behavior._state_machine.destroy()
        assert Work.go.is_set()


NAMES = """\
name: sm
outcomes: [done, "None"]
userdata: {_hidden: 1, class: 2}
states:
  - IN:
      template: StateMachine
      outcomes: ["None", preempted]
      states:
        - preempted_one:
            template: ScriptedState
            outcomes: ["None", preempted]
            steps: [{outcome: preempted}, {outcome: "None"}]
            transitions: {preempted: NEXT, "None": "None"}
        - NEXT:
            template: ScriptedState
            outcomes: ["None"]
            transitions: {"None": preempted}
      transitions: {"None": "None", preempted: IN}
"""


def test_outcomes_with_a_meaning_of_their_own_in_flexbe() -> None:
    """A state ends with `preempted` and with `None`, and the machine goes on."""
    files, report = files_of(NAMES)
    assert report == []
    behavior = text_of(files, "sm_sm.py")
    assert "OperatableStateMachine(outcomes=['None_', 'preempted_'])" in behavior
    assert "_state_machine.userdata['_hidden'] = 1" in behavior
    with loaded(files) as made:
        run = ready(made)
        events: list[dict[str, Any]] = []
        run._state_machine.observe(events.append)
        assert run.execute() == "None"
        assert events[-2] == {
            "event": "transition",
            "path": "sm/IN",
            "outcome": "None",
            "to": "sm:None",
        }


def test_a_state_with_the_name_of_an_outcome() -> None:
    """FlexBE refuses its label."""
    checked = analyse(Source("main.yml", NAMES), LIBRARY, []).checked
    assert checked is not None
    (inside,) = checked.root.children
    edges = tuple(
        replace(edge, target="done") if edge.outcome == "preempted" else edge
        for edge in inside.transitions
    )
    root = replace(
        checked.root,
        initial="done",
        children=(replace(inside, name="done", transitions=edges),),
    )
    files = build(Checked(replace(checked, root=root)), TARGET, LIBRARY, [])
    behavior = text_of(files, "sm_sm.py")
    assert "OperatableStateMachine.add('done (state)'" in behavior
    assert "'preempted_': 'done (state)'" in behavior
    assert 'labels={"/done (state)": "done"}' in behavior
    with loaded(files) as made:
        run = ready(made)
        events = at_visit(run._state_machine, "", None)
        assert run.execute() == "None"
        assert events.count("enter sm/done") == 2


@pytest.mark.parametrize("name", ["preempted_", "None_"])
def test_names_that_stand_for_others_are_refused(name: str) -> None:
    text = f"""\
name: sm
outcomes: [done]
states:
  - A: {{template: ScriptedState, outcomes: [{name}], transitions: {{{name}: done}}}}
"""
    files, report = files_of(text)
    assert files == {}
    assert [(finding.code, finding.span.line) for finding in report] == [("SM601", 4)]


def test_an_input_of_the_behavior() -> None:
    script = """\
name: sm
outcomes: [succeeded]
userdata: {size: 1}
output_keys: [size]
states:
  - A:
      template: CallbacksState
      input_keys: [size]
      output_keys: [size]
      callbacks: {size: 'lambda ud: ud.size * 2'}
      transitions: {succeeded: succeeded}
"""
    files, _ = files_of(script)
    with loaded(files) as made:
        for inputs, expected in (({}, 2), ({"size": 21}, 42), ({"unknown": 1}, 2)):
            run = ready(made, inputs=inputs)
            assert run.execute() == "succeeded"
            assert run._state_machine.userdata.size == expected


ROS = """\
name: fetch
template: ROSBase
outcomes: [succeeded, aborted, preempted]
params: {patience: 2.5, name: 'a "b"', careful: true}
userdata: {x: [params, patience], y: [params, name], z: [params, careful], plain: [1, 2]}
output_keys: [x, y, z, plain]
states:
  - CALL:
      template: ServiceState
      service_namespace: open
      service: std_srvs/srv/Trigger
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""


def test_params_of_a_node_are_parameters_of_the_behavior() -> None:
    files, _ = files_of(ROS)
    behavior = text_of(files, "fetch_sm.py")
    for line in (
        "self.add_parameter('patience', 2.5)",
        "self.add_parameter('name_parameter', 'a \"b\"')",
        "self.add_parameter('careful', True)",
        "_state_machine.userdata.plain = [1, 2]",
        "self.node = node",
        "name=self.name_parameter",
    ):
        assert line in behavior
    assert "userdata.x" not in behavior  # the program sets what a parameter can change
    manifest = ElementTree.fromstring(text_of(files, "fetch.xml"))
    found = {
        one.get("name"): (one.get("type"), one.get("default")) for one in manifest.iter("param")
    }
    assert found == {
        "patience": ("numeric", "2.5"),
        "name_parameter": ("text", 'a "b"'),
        "careful": ("boolean", "True"),
    }
    executable = manifest.find("executable")
    assert executable is not None
    assert executable.attrib == {
        "package_path": "fetch_flexbe_behaviors.fetch_sm",
        "class": "FetchSM",
    }
    package = text_of(
        {path: text for path, text in files.items() if path.startswith("fetch_flexbe_states/")},
        "package.xml",
    )
    assert "<exec_depend>std_srvs</exec_depend>" in package
    assert ElementTree.fromstring(package).find("export/flexbe_states") is not None


def test_packages() -> None:
    files, _ = files_of(WAITING, package="robot")
    behaviors, states = "robot_flexbe_behaviors", "robot_flexbe_states"
    assert [*files] == [
        f"{behaviors}/{behaviors}/wait_sm.py",
        f"{behaviors}/manifest/wait.xml",
        f"{behaviors}/{behaviors}/__init__.py",
        f"{behaviors}/package.xml",
        f"{behaviors}/setup.py",
        f"{behaviors}/setup.cfg",
        f"{behaviors}/resource/{behaviors}",
        f"{states}/{states}/wait_smach.py",
        f"{states}/{states}/callbacks_state.py",
        f"{states}/{states}/sleep_state.py",
        f"{states}/{states}/__init__.py",
        f"{states}/package.xml",
        f"{states}/setup.py",
        f"{states}/setup.cfg",
        f"{states}/resource/{states}",
    ]
    assert (
        '("lib/robot_flexbe_behaviors/manifest", ["manifest/wait.xml"])'
        in files[f"{behaviors}/setup.py"]
    )


def test_each_state_type_has_a_class_with_its_interface() -> None:
    """States of one type with different interfaces pass it to their class."""
    text = """\
name: sm
outcomes: [done]
userdata: {a: 1}
states:
  - A: {template: SleepState, time: 0.0, transitions: {succeeded: B, preempted: done}}
  - B:
      template: CallbacksState
      input_keys: [a]
      output_keys: [b]
      callbacks: {b: 'lambda ud: ud.a'}
      transitions: {succeeded: C}
  - C:
      template: CallbacksState
      input_keys: [b]
      callbacks: {}
      transitions: {succeeded: done}
"""
    files, _ = files_of(text)
    behavior = text_of(files, "sm_sm.py")
    assert "SleepState()," in behavior
    assert (
        "CallbacksState(outcomes=['succeeded'], input_keys=['a'], output_keys=['b'])," in behavior
    )
    assert "super().__init__(outcomes=['succeeded', 'preempted_'])" in text_of(
        files, "sleep_state.py"
    )
    assert "def __init__(self, outcomes, input_keys, output_keys):" in text_of(
        files, "callbacks_state.py"
    )
    with loaded(files) as made:
        assert ready(made).execute() == "done"


TYPES = ("EventState", "PickUp", "Pick_up", "pickup", "lambda", "Behavior")


def test_types_whose_names_are_taken() -> None:
    templates = {
        f"templates/{name}.yml": f"name: {name}\noutcomes: {{done: {{}}}}\n"
        f"code: {{python: 'robot_states:Quick'}}\n"
        for name in TYPES
    }
    states = "".join(
        f"  - S{at}: {{template: {name}, transitions: {{done: {to}}}}}\n"
        for at, (name, to) in enumerate(
            zip(TYPES, ["S1", "S2", "S3", "S4", "S5", "done"], strict=True)
        )
    )

    class Quick(smach.State):
        def __init__(self) -> None:
            smach.State.__init__(self, ["done"])

        def execute(self, userdata: Any) -> str:
            return "done"

    module = sys.modules["robot_states"] = ModuleType("robot_states")
    vars(module).update(Quick=Quick)
    try:
        text = f"name: sm\noutcomes: [done]\nstates:\n{states}"
        files, _ = files_of(text, memory_library(templates, LIBRARY))
        with loaded(files) as made:
            assert ready(made).execute() == "done"
    finally:
        del sys.modules["robot_states"]


def test_items_that_need_names_of_the_program_are_refused() -> None:
    text = """\
name: sm
outcomes: [done]
states:
  - EACH:
      template: Iterator
      outcomes: [done]
      it: '`lambda ud: [math.pi]`'
      it_label: item
      loop_outcomes: [succeeded]
      exhausted_outcome: done
      states: [{GO: {template: CallbacksState, input_keys: [item], outcomes: [succeeded]}}]
      transitions: {done: done}
"""
    files, report = files_of(text)
    assert files == {}
    assert [(finding.code, finding.span.line) for finding in report] == [("SM601", 7)]


@pytest.mark.parametrize(
    ("name", "package", "class_"),
    [
        ("2 go", "go", "Behavior2GoSM"),
        ("Größe", "gr__e", "GrESM"),
        ("Arm-1", "arm_1", "Arm1SM"),
        ("42", "machine", "Behavior42SM"),
        ("flexbe_core", "flexbe_core", "FlexbeCoreSM"),
    ],
)
def test_names_of_machines(name: str, package: str, class_: str) -> None:
    files, report = files_of(WAITING.replace("name: wait", f"name: '{name}'"))
    assert report == []
    assert next(iter(files)).startswith(f"{package}_flexbe_behaviors/")
    with loaded(files) as made:
        assert made.__name__ == class_
        run = ready(made)
        at_visit(run._state_machine, f"{name}/BOTH/SLEEP", by_flag)
        assert run.execute() == "preempted"


def test_a_state_whose_class_is_a_container(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the script it is one state; it also runs as one."""
    script = tmp_path / "main.yml"
    state = "{template: Mine, transitions: {ok: done}}"
    script.write_text(f"name: own\noutcomes: [done]\nstates:\n  - X: {state}\n", "utf-8")
    (tmp_path / "templates").mkdir()
    interface = 'outcomes: [ok]\ncode: {python: "own_container_flexbe:Mine"}\n'
    (tmp_path / "templates" / "Mine.yml").write_text(interface, "utf-8")
    (tmp_path / "own_container_flexbe.py").write_text(OWN, "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    events = trace(smachac.compile(script, "flexbe"))
    assert [event["path"] for event in events] == ["own", "own/X", "own/X", "own/X", "own"]
    assert events[-1]["outcome"] == "done"

"""Programs generated from SMACHA scripts and templates, built without ROS, and their outlines."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest.mock import patch

import smachac
from smachac.runtime import smach, smach_ros

FOLDER = Path(__file__).parent
TEMPLATES = FOLDER / "templates"


class Anything(ModuleType):
    """A module of ROS as far as code touches it when a machine is built: it has every name."""

    def __getattr__(self, name: str) -> Any:
        if name == "__all__":
            return ["Point"]
        if name.startswith("__"):
            raise AttributeError(name)
        kinds = (smach_ros.ServiceState, smach_ros.SimpleActionState)
        return {kind.__name__: Named for kind in kinds}.get(name, self)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        return self

    def __add__(self, other: Any) -> Any:
        return self


MESSAGES = (
    *("actionlib.msg", "actionlib_msgs", "actionlib_msgs.msg", "geometry_msgs"),
    *("geometry_msgs.msg", "my_msgs", "my_msgs.msg", "my_msgs.srv"),
    *("roslib.message", "sensor_msgs", "sensor_msgs.msg", "std_msgs", "std_msgs.msg"),
    *("arm_msgs", "arm_msgs.srv", "std_srvs", "std_srvs.srv", "tf2_geometry_msgs"),
)


class Named(smach.State):
    """In place of a state of smach_ros, which wants a node: its outcomes and keys alone."""

    def __init__(self, name: str, kind: Any, **given: Any) -> None:
        inputs = [*given.get("request_slots", []), *given.get("input_keys", [])]
        super().__init__(["succeeded", "aborted", "preempted"], input_keys=inputs)
        self.given = (name, kind, given)


ROS = (
    *MESSAGES,
    "genpy",
    "rospy",
    "roslib",
    "rospkg",
    "rostopic",
    "actionlib",
    "tf2_ros",
    "rosbag",
    "smach_ros",
)


@contextmanager
def stand_ins(*more: str) -> Iterator[None]:
    """SMACH's runtime under its name, and modules of ROS that do nothing."""
    names = [*ROS, *more]
    before = {name: sys.modules.get(name) for name in ("smach", *names)}
    sys.modules["smach"] = smach
    sys.modules.update({name: Anything(name) for name in names})
    try:
        yield
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module


def text_of(script: str, *templates: Path, **options: str) -> str:
    """The program of a script."""
    path = FOLDER / "scripts" / f"{script}.yml"
    folders = templates or (TEMPLATES,)
    ((_, text),) = smachac.compile(path, "python", templates=folders, options=options).items()
    return text


def machine_of(text: str, *more: str) -> Any:
    """The machine that a program builds, before it runs."""
    module = ModuleType("program")
    with stand_ins(*more):
        exec(compile(text, "program.py", "exec"), module.__dict__)
        if "build" in module.__dict__:
            return module.__dict__["build"]()
        built: list[Any] = []

        def caught(self: Any, *_: Any) -> str:
            built.append(self)
            return "caught"

        with patch.object(smach.StateMachine, "execute", caught):
            module.__dict__["main"]()
    return built[0]


def outline(machine: Any, name: str = "sm", depth: int = 0) -> str:
    """Everything that SMACH knows of a machine: a line for each state, below it what it has."""
    pad = "  " * depth
    lines = [
        f"{pad}{name}: {type(machine).__name__} -> {_listed(machine.get_registered_outcomes())}"
    ]
    facts: dict[str, Any] = {
        "in": _listed(machine.get_registered_input_keys()),
        "out": _listed(machine.get_registered_output_keys()),
    }
    children = dict(getattr(machine, "get_children", dict)())
    if children:
        keys = sorted(machine.userdata.keys())
        facts["userdata"] = ", ".join(f"{key}={machine.userdata[key]!r}" for key in keys)
        facts["first"] = _listed(machine.get_initial_states()) if not is_split(machine) else ""
    if is_split(machine):
        facts["default"], facts["map"] = machine._default, machine._outcome_map or ""
    lines += [f"{pad}  {key} {value}" for key, value in facts.items() if value]
    table = machine if is_split(machine) else getattr(machine, "_table", None)
    for child, state in children.items():
        lines.append(outline(state, child, depth + 1))
        assert table is not None
        edges = {} if is_split(machine) else table.targets[child]
        remaps = (table._remappings if is_split(machine) else table.remappings)[child]
        lines += [f"{pad}    on {key} {edges[key] or '(same name)'}" for key in sorted(edges)]
        lines += [f"{pad}    {key} is {remaps[key]}" for key in sorted(remaps)]
    return "\n".join(lines)


def is_split(machine: Any) -> bool:
    return isinstance(machine, smach.Concurrence)


def _listed(names: Any) -> str:
    return ", ".join(sorted(names))

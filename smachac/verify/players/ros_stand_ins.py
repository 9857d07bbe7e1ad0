"""Stand-ins for the modules of ROS, so that a machine with ROS states is built without a node.

The states are played by a scenario, so that of each state only outcomes and keys are needed. The
packages of messages that are installed are used; those that are absent have stand-ins too.
"""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from types import ModuleType
from typing import Any

from smachac.ir.nodes import Machine, StateType
from smachac.ir.python_code import parse_module

ALWAYS = (
    *("rclpy", "rospy", "roslib", "rosgraph", "rostopic", "rosbag", "actionlib", "smach_ros"),
    *("smachac.runtime.smach_ros", "smachac.runtime.smach_ros2"),
)
"""The modules that have stand-ins also where they are installed."""

OPTIONAL = ("genpy", "tf2_ros", "tf2_geometry_msgs", "tf2_sensor_msgs")
"""The modules that have stand-ins where they are not installed, as packages of messages have."""

MESSAGE_MODULES = ("msg", "srv", "action")

READ_SLOTS = ("goal_slots", "request_slots")
WRITTEN_SLOTS = ("result_slots", "response_slots")


class _AnyType(type):
    """A type that every value has: a value for a message that is not installed is not converted."""

    def __instancecheck__(cls, instance: object) -> bool:
        return True


class StandIn(metaclass=_AnyType):
    """Any object of ROS, as far as the code that builds a machine touches it."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return StandIn()

    def __call__(self, *_: Any, **__: Any) -> Any:
        return StandIn()

    def __mro_entries__(self, _: Any) -> tuple[type]:
        return (object,)


@contextmanager
def ros_stand_ins(text: str, machine: Machine) -> Iterator[None]:
    """Stand-ins for the modules of ROS that the program `text` of a machine imports."""
    states = {
        name: _state_class(type_)
        for name, type_ in machine.state_types.items()
        if type_.kind == "state" and type_.built_in
    }
    names = (*OPTIONAL, *_message_packages(text))
    first, last = _Finder(ALWAYS, states), _Finder(names, states)
    before = _taken_out(ALWAYS)
    sys.meta_path.insert(0, first)
    sys.meta_path.append(last)
    try:
        yield
    finally:
        sys.meta_path.remove(first)
        sys.meta_path.remove(last)
        for name in [name for name, module in sys.modules.items() if isinstance(module, _Module)]:
            del sys.modules[name]
        runtime = import_module("smachac.runtime")
        for name in ("smach_ros", "smach_ros2"):
            vars(runtime).pop(name, None)
            if f"smachac.runtime.{name}" in before:
                setattr(runtime, name, before[f"smachac.runtime.{name}"])
        sys.modules.update(before)


def built(build: Callable[..., Any]) -> Any:
    """The machine that a function `build` returns; a parameter without a default is the node."""
    required = [
        parameter
        for parameter in inspect.signature(build).parameters.values()
        if parameter.default is parameter.empty
        and parameter.kind is parameter.POSITIONAL_OR_KEYWORD
    ]
    return build(*(StandIn() for _ in required))


def _taken_out(names: Sequence[str]) -> dict[str, ModuleType]:
    """Remove modules, and those below them, from the imported ones; the removed ones."""
    found = {name: module for name, module in sys.modules.items() if _is_below(name, names)}
    for name in found:
        del sys.modules[name]
    runtime = import_module("smachac.runtime")
    for name in ("smach_ros", "smach_ros2"):
        vars(runtime).pop(name, None)
    return found


def _is_below(name: str, names: Sequence[str]) -> bool:
    return any(name == text or name.startswith(f"{text}.") for text in names)


class _Module(ModuleType):
    """A stand-in for a module: it has every name; those of state types are classes."""

    states: Mapping[str, type]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return self.states.get(name) or StandIn()


class _Finder(MetaPathFinder, Loader):
    """Finds stand-ins for modules of some names, and for those below them."""

    def __init__(self, names: Sequence[str], states: Mapping[str, type]) -> None:
        self._names = names
        self._states = states

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        if not _is_below(name, self._names):
            return None
        return spec_from_loader(name, self, is_package=True)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = _Module(spec.name)
        module.states = self._states
        return module

    def exec_module(self, module: ModuleType) -> None:
        pass


def _message_packages(text: str) -> list[str]:
    """The packages of messages that a program imports."""
    try:
        tree = parse_module(text)
    except SyntaxError:  # the player reports it
        return []
    modules = [
        node.module
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module is not None
    ]
    parts = [module.partition(".") for module in modules]
    return sorted({package for package, _, module in parts if module in MESSAGE_MODULES})


def _state_class(type_: StateType) -> type:
    """A class for the states of a built-in type, with its outcomes and keys."""
    try:
        smach: Any = import_module("smach")
    except ImportError:
        smach = import_module("smachac.runtime.smach")

    class StandInState(smach.State):  # type: ignore[misc]
        def __init__(self, *_: Any, outcomes: Sequence[str] = (), **given: Any) -> None:
            inputs = [key.name for key in type_.input_keys] + list(given.get("input_keys", ()))
            outputs = [key.name for key in type_.output_keys] + list(given.get("output_keys", ()))
            for names, slots in ((inputs, READ_SLOTS), (outputs, WRITTEN_SLOTS)):
                names += [name for slot in slots for name in given.get(slot) or ()]
            super().__init__(
                list(outcomes) or [outcome.name for outcome in type_.outcomes], inputs, outputs
            )

    return StandInState

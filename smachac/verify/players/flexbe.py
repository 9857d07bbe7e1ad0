"""Player of the FlexBE target: the generated packages run on the FlexBE that this Python imports.

The packages are written to a temporary folder and imported once; each trace makes the behavior
anew. The states perform the steps of the test case; the containers are those of the packages, over
FlexBE's. FlexBE needs a node of ROS 2: its topics are below `smachac_verify`, where no robot has a
behavior, and it receives nothing.
"""

from __future__ import annotations

import copy
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from importlib import import_module
from pathlib import Path, PurePosixPath
from typing import Any

from smachac.ir.nodes import Machine
from smachac.records import replace
from smachac.runtime.tracing import trace
from smachac.targets.flexbe.behavior import class_name
from smachac.targets.python.runner import hidden, loaded, quiet
from smachac.verify.players.python import prepared, silent, unplayable_errors, without_secret
from smachac.verify.players.ros_stand_ins import built, ros_stand_ins
from smachac.verify.python_values import ITEMS
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError, record_read

MISSING = (
    "FlexBE is not here: build flexbe_core and flexbe_msgs from its repository"
    " (github.com/FlexBE/flexbe_behavior_engine) with colcon, and run smachac in the terminal in"
    " which its workspace was sourced"
)

NODE = "smachac_verify"

UNCONTROLLED = 255
"""FlexBE's level of autonomy at which no operator is connected."""


def player(files: Mapping[str, str], machine: Machine, *, folders: Sequence[Path]) -> Player:
    """A player of the generated packages `files`, the behavior first and with their runtime, which
    may import modules from `folders`.

    Raises UnplayableError if FlexBE is missing or the packages cannot be imported.
    """

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        with (
            _node() as node,
            unplayable_errors("the packages for FlexBE"),
            ros_stand_ins("\n".join(files.values()), machine),
            _behavior_module(files, *folders) as module,
            quiet(module.smach_program.smach, hidden),
            silent("flexbe"),
        ):
            behavior = getattr(module, class_name(machine))
            for case in cases:
                yield _trace(behavior, module.smach_program, node, machine.root.name, case)

    return play


@contextmanager
def _node() -> Iterator[Any]:
    """A node for FlexBE, which prints nothing and is not spun. FlexBE and ROS are imported here,
    before their modules have stand-ins."""
    try:
        core, rclpy = import_module("flexbe_core"), import_module("rclpy")
        severity = import_module("rclpy.logging").LoggingSeverity
        options = import_module("rclpy.signals").SignalHandlerOptions
    except ImportError as error:
        raise UnplayableError(f"{MISSING} ({error})") from error
    mine = not rclpy.ok()
    if mine:
        rclpy.init(args=[], signal_handler_options=options.NO)
    try:
        node = rclpy.create_node(NODE, namespace=NODE)
        node.get_logger().set_level(severity.FATAL)
        core.set_node(node)
        try:
            yield node
        finally:
            node.destroy_node()
    finally:
        if mine:
            rclpy.shutdown()


@contextmanager
def _behavior_module(files: Mapping[str, str], *folders: Path) -> Iterator[Any]:
    """The module of the behavior, the first of the files. Inside the context its packages can be
    imported, and modules of the user from `folders`."""
    with tempfile.TemporaryDirectory(prefix="smachac-") as home:
        for name, text in files.items():
            path = Path(home, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")
        first = PurePosixPath(next(iter(files)))
        packages = dict.fromkeys(Path(home, PurePosixPath(name).parts[0]) for name in files)
        text = f"from {first.parent.name} import {first.stem} as behavior"
        with loaded(NODE, text, *packages, *folders) as module:
            yield module["behavior"]


def _trace(behavior_class: Any, program: Any, node: Any, name: str, case: TestCase) -> list[Event]:
    """The trace of one run; an error that ends the run is an event of it."""
    events: list[Event] = []
    strict = trace.StrictScript(case.reads, partial(record_read, events), case.most)
    build = program.build
    states = prepared(built(build), name, case, strict)
    _without_native(states)
    program.build = lambda *_, **__: states
    try:
        behavior = behavior_class(node)
        behavior.set_up(0, UNCONTROLLED, False)
        behavior.prepare_for_execution(None)
    finally:
        program.build = build
    root = behavior._state_machine
    states.request_preempt = root.request_preempt  # steps request a stop of this machine
    root.wake.set()  # FlexBE waits for listeners to its topics: nobody listens
    behavior.confirm()

    def observe(event: Event) -> None:
        events.append(without_secret(event, case))

    root.observe(observe)
    for path, key, value in case.samples:
        if key == ITEMS:
            container = _container_at(root, path)
            container.loop = replace(container.loop, items=copy.deepcopy(value))
    if case.stopped:
        root.request_preempt()
    try:
        with suppress(Exception):
            root.spin()
    finally:
        root.destroy()
    return events


def _without_native(machine: Any) -> None:
    """Let states of FlexBE perform their steps as the others do."""
    todo = [machine]
    while todo:
        for state in todo.pop().get_children().values():
            vars(state).pop("native", None)
            todo += [state] if getattr(state, "get_children", None) else []


def _container_at(root: Any, path: str) -> Any:
    """The container at a path of the script."""
    todo = [root]
    while todo:
        node = todo.pop()
        if node.where == path:
            return node
        todo += getattr(node, "_states", ())
    raise KeyError(path)

"""The main program of a node: start it, run a machine with it, stop it."""

from __future__ import annotations

import re
import sys
import threading
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

from smachac.runtime import signals
from smachac.runtime.smach_ros2 import delivery, parameters, ros
from smachac.runtime.smach_ros2.node import SmachNode
from smachac.runtime.smach_ros2.signals import GRACE, PreemptHandler


def start_node(
    name: str, args: list[str] | None = None, node_class: Any = SmachNode, **kwargs: Any
) -> Any:
    """Initialize rclpy and start a node that a thread spins.

    From now on SIGINT, SIGTERM and SIGHUP preempt the machine of `run`; rclpy gets no signal
    handlers, because they end the node before goals can be cancelled. `args` are the arguments of
    the program (default: sys.argv); other arguments are those of `node_class`.

    If ROS refuses to start, as with arguments that are not valid, this ends the program as argparse
    does: one line with the reason, SystemExit with exit code 2.
    """
    return start(lambda: node_class(name, **kwargs), args)


def start(make: Callable[[], Any], args: list[str] | None = None) -> Any:
    """Initialize rclpy as `start_node` does, and start the node that `make` returns."""
    arguments = sys.argv if args is None else args
    _refuse_misread(arguments)
    handler = None
    if threading.current_thread() is threading.main_thread():
        handler = PreemptHandler(ros.rclpy.get_default_context())
        handler.install()
    try:
        options = ros.load("rclpy.signals").SignalHandlerOptions
        with _ended_by_errors():
            with _silent_rcl():
                ros.rclpy.init(args=args, signal_handler_options=options.NO)
            node = make()
        node.signal_handler, node.arguments = handler, arguments
        node.start()
    except BaseException:
        ros.rclpy.try_shutdown()
        if handler is not None:
            handler.remove()
        raise
    return node


def _refuse_misread(args: list[str]) -> None:
    """End the program with exit code 2 for parameters from which ROS 2 reads other values than the
    ones that are written.

    It reads 010 as 8, 07 as 7, and 08 as a float. Of values of one parameter it takes the last one
    if all have one type; else the one whose type comes first in its own order: 0 of `-p x:=0 -p
    x:=0.5`.
    """
    given: dict[str, tuple[str, object]] = {}
    for before, rule in pairwise(args):
        name, _, value = rule.partition(":=")
        if before not in ("-p", "--param"):
            continue
        items = value.strip("[]").split(",") if value.startswith("[") else [value]
        if any(re.fullmatch(r"[-+]?0[0-9]+", item.strip()) for item in items):
            reason = "a number that begins with 0 is read as octal or as a float; write it without"
            _refuse(f"'-p {rule}': {reason} the 0, or in quotes if it is a text")
        kind = _type_of(value)
        first, known = given.setdefault(name, (rule, kind))
        if kind != known:
            reason = "ROS 2 does not take the last of two values of different types"
            _refuse(f"'-p {first}' and '-p {rule}': {reason}; write one of them")


def _refuse(reason: str) -> None:
    print(f"ROS 2 cannot start: {reason}", file=sys.stderr)
    raise SystemExit(2)


def _type_of(value: str) -> object:
    """The type of the value of a parameter, with that of the items of a list; None if it is no
    YAML."""
    import yaml  # rclpy has it

    try:
        data = yaml.safe_load(value)
    except yaml.YAMLError:
        return None
    return frozenset(map(type, data)) if isinstance(data, list) else type(data)


@contextmanager
def _ended_by_errors() -> Iterator[None]:
    """Print the error with which ROS refuses to start, and end the program with exit code 2."""
    errors = ros.load("rclpy.impl.implementation_singleton").rclpy_implementation
    refused = ros.load("rclpy.exceptions").ParameterException
    try:
        yield
    except errors.UnknownROSArgsError as error:
        reason = f"unknown arguments {error}"
    except (errors.RCLError, refused) as error:
        # After the reason come the places in the source of ROS: `, at src/rcl/arguments.c:380`.
        reason = str(error).partition(", at ")[0].removeprefix("failed to initialize rcl: ")
    else:
        return
    _refuse(reason)


@contextmanager
def _silent_rcl() -> Iterator[None]:
    """The library rcl logs nothing: its errors are exceptions too."""
    logging = ros.load("rclpy.logging")
    level = logging.get_logger_level("rcl")
    logging.set_logger_level("rcl", logging.LoggingSeverity.FATAL)
    try:
        yield
    finally:
        if logging.get_logger_level("rcl") == logging.LoggingSeverity.FATAL:
            logging.set_logger_level("rcl", level)


def run(node: Any, machine: Any, grace: float = GRACE) -> str | None:
    """Execute a machine in this thread and return its outcome; the node is one of `start_node`.

    The first stop signal preempts it; after `grace` seconds the node shuts down, and states that
    wait for ROS end. The second one ends the program at once.
    """
    handler: PreemptHandler | None = node.signal_handler
    outcome: str | None
    if handler is None:
        outcome = machine.execute()
        return outcome
    handler.grace, handler.is_executing = grace, True
    handler.add(machine)
    try:
        outcome = machine.execute()
    finally:
        handler.is_executing = False
        handler.discard(machine)
    return outcome


def run_once(
    name: str,
    build: Callable[..., Any],
    args: list[str] | None = None,
    choices: Mapping[str, Sequence[Any]] | None = None,
) -> str | None:
    """Start a node, run the machine that `build` makes of it and of the parameters of the node, and
    stop the node; the outcome.

    `args` are those of `start_node`, `choices` those of `parameters.declared`. Raises
    ParameterError.
    """
    node = start_node(name, args)
    try:
        return run(node, build(node, **parameters.declared(node, build, choices)))
    finally:
        stop_node(node)


def run_main(
    main: Callable[[], str | None], failures: Collection[str] = ("aborted", "preempted")
) -> int:
    """Call the main function of a node and print the outcome; the exit code for it. Parameters that
    do not fit end the program with exit code 1 and one line with the reason."""
    try:
        outcome = main()
    except parameters.ParameterError as error:
        raise SystemExit(str(error)) from None
    print(f"outcome: {outcome}")
    return exit_code(outcome, failures)


def stop_node(node: Any) -> None:
    """Stop the thread of a node of `start_node`, destroy the node and shut rclpy down.

    Messages that are under way get up to a second to arrive. Signals are ignored meanwhile; after
    that the former handlers are in place again.
    """
    handler: PreemptHandler | None = node.signal_handler
    if handler is not None:
        handler.ignore()
    if node.context.ok():
        delivery.await_acknowledgements(node.publishers)
    node.stop()
    node.destroy_node()
    node.context.try_shutdown()
    if handler is not None:
        handler.remove()
        node.signal_handler = None


def exit_code(outcome: str | None, failures: Collection[str] = ("aborted", "preempted")) -> int:
    """The exit code of a program: after a stop signal 128 + its number, else that of an outcome: 1
    for none and for one of `failures`."""
    return signals.exit_code(1 if outcome is None or outcome in failures else 0)


def stop_code() -> int:
    """The exit code of a program without an outcome: after a stop signal 128 + its number, else
    0."""
    return signals.exit_code()

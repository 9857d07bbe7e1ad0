"""Runs machines with stand-in states: `python import_runs.py RUNS FILE:EXPRESSION...` prints JSON.

The expression is the code in a Python file that makes the machine, or runs it; with `@` before it
the file is the main program. The module `smach` is that of the interpreter, or the bundled one.

The stand-in of a state ends with an outcome that depends on the number of the run, its path and its
visit alone, so that two machines of the same structure end alike, in whatever order threads run.
"""

from __future__ import annotations

import json
import random
import sys
import threading
import types
from pathlib import Path
from typing import Any

MOST_VISITS = 300
"""The most visits of all states in a run: a loop need not end."""


class CapturedError(Exception):
    """In place of the first run of a machine; `machine` is that machine."""

    def __init__(self, machine: Any) -> None:
        super().__init__()
        self.machine = machine


class LongRunError(Exception):
    """A run has visited too many states."""


class _Anything:
    """In place of what a package of ROS has."""

    def __init__(self, *given: object, **named: object) -> None: ...
    def __getattr__(self, name: str) -> Any:
        return _Anything()

    def __call__(self, *given: object, **named: object) -> Any:
        return _Anything()


class _Package(types.ModuleType):
    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return type(name, (_Anything,), {})


def provide(smach: Any) -> None:
    """Stand-ins for packages of ROS that machines import."""

    def ready(*outcomes: str) -> Any:
        def construct(self: Any, *given: object, **named: Any) -> None:
            inputs = [*named.get("input_keys", ()), *named.get("request_slots", ())]
            outputs = [*named.get("output_keys", ())]
            whole = {*outcomes, *named.get("outcomes", ())}
            for word, function in named.items():
                if word.endswith("_cb") and hasattr(function, "get_registered_outcomes"):
                    whole.update(function.get_registered_outcomes())
                    inputs += function.get_registered_input_keys()
                    outputs += function.get_registered_output_keys()
            smach.State.__init__(self, sorted(whole), inputs, outputs)

        return type("Ready", (smach.State,), {"__init__": construct})

    smach_ros = types.ModuleType("smach_ros")
    smach_ros.SimpleActionState = smach_ros.ServiceState = ready(  # type: ignore[attr-defined]
        "succeeded", "aborted", "preempted"
    )
    smach_ros.MonitorState = ready("valid", "invalid", "preempted")  # type: ignore[attr-defined]
    sys.modules["smach_ros"] = smach_ros
    names = ("rospy", "rosgraph_msgs", "std_srvs", "std_msgs", "nav_of_mine")
    for name in [f"{package}{part}" for package in names for part in ("", ".srv", ".msg")]:
        sys.modules[name] = package = _Package(name)
        package.__path__ = []
    vendor = types.ModuleType("voice_of_vendor")
    vendor.Speak = type(  # type: ignore[attr-defined]
        "Speak", (smach.State,),
        {"__init__": lambda self, text: smach.State.__init__(self, ["said"])},
    )  # fmt: skip
    sys.modules["voice_of_vendor"] = vendor


def made(file: Path, expression: str, smach: Any) -> Any:
    """The machine that the code in a file makes, or that it runs first."""
    sys.path.insert(0, str(file.parent))
    module = types.ModuleType("__main__" if expression.startswith("@") else file.stem)
    module.__file__ = str(file)
    sys.modules[file.stem] = module
    execute = smach.StateMachine.execute

    def captured(self: Any, *given: object) -> None:
        raise CapturedError(self)

    smach.StateMachine.execute = captured
    try:
        exec(compile(python3(file), str(file), "exec"), vars(module))
        return eval(expression.lstrip("@"), vars(module))
    except CapturedError as error:
        return error.machine
    finally:
        smach.StateMachine.execute = execute


def python3(file: Path) -> str:
    """The text of a file; that of Python 2 is translated."""
    text = file.read_text("utf-8")
    try:
        compile(text, str(file), "exec")
    except SyntaxError:
        from fissix.refactor import RefactoringTool, get_fixers_from_package

        return str(RefactoringTool(get_fixers_from_package("fissix.fixes")).refactor_string(
            text, str(file)
        ))  # fmt: skip
    return text


def structure(machine: Any) -> dict[str, Any]:
    """The containers below a machine as plain data."""
    found: dict[str, Any] = {
        "outcomes": sorted(machine.get_registered_outcomes()),
        "inputs": sorted(machine.get_registered_input_keys()),
        "outputs": sorted(machine.get_registered_output_keys()),
    }
    if hasattr(machine, "get_children"):
        if not hasattr(machine, "_outcome_map"):  # an `outcome_cb` may have become rules
            edges = machine.get_internal_edges()
            found["edges"] = sorted([name, start, end or name] for name, start, end in edges)
        found["initial"] = sorted(machine.get_initial_states())
        found["keys"] = sorted(machine.userdata._data)
        children = machine.get_children()
        found["states"] = {name: structure(children[name]) for name in children}
    return found


def run(machine: Any, seed: int) -> list[Any]:
    """The outcome of a machine with stand-in states, and the outcomes of each, by path."""
    visited: dict[str, list[str]] = {}

    def stand_in(path: str, state: Any) -> None:
        def execute(userdata: Any) -> str:
            before = visited.setdefault(path, [])
            if sum(map(len, visited.values())) > MOST_VISITS:
                raise LongRunError
            choice = random.Random(f"{seed} {path} {len(before)}")
            before.append(choice.choice(sorted(state.get_registered_outcomes())))
            return before[-1]

        state.execute = execute

    def replace(path: str, container: Any) -> None:
        children = container.get_children()
        for name in children:
            child, below = children[name], f"{path}/{name}"
            if hasattr(child, "get_children"):
                replace(below, child)
            else:
                stand_in(below, child)

    replace("", machine)
    try:
        outcome = machine.execute()
    except Exception as error:  # SMACH raises errors of its own around that of a state
        outcome = f"raised {'LongRun' if 'LongRun' in repr(error) + str(error) else error}"
    return [outcome, dict(sorted(visited.items()))]


def main(runs: int, machines: list[str]) -> None:
    """Print the structure of each machine and what it does in each run."""
    try:
        import smach
    except ImportError:
        from smachac.runtime import smach

        sys.modules["smach"] = smach
    smach.set_loggers(*[lambda *words: None] * 4)
    if not hasattr(threading.Thread, "isAlive"):  # SMACH before 2.5 uses this name of Python 2
        threading.Thread.isAlive = threading.Thread.is_alive  # type: ignore[attr-defined]
    provide(smach)
    found = []
    for machine in machines:
        file, _, expression = machine.rpartition(":")
        built = made(Path(file), expression, smach)
        done = [run(built, seed) for seed in range(runs)]
        found.append({"structure": structure(built), "runs": done})
    sys.stdout.write(json.dumps({"smach": smach.__file__, "machines": found}))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:])

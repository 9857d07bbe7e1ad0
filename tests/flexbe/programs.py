"""Generated behaviors of FlexBE on the stand-in."""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from types import ModuleType
from typing import Any

from smachac.diagnostics.diagnostic import Report
from smachac.driver import build
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked, Machine
from smachac.targets.flexbe import TARGET
from tests.flexbe import stand_in
from tests.support.typed_machines import with_state_types

RUNTIME = Path(__file__).parents[2] / "smachac" / "runtime" / "flexbe" / "smachac_flexbe.py"

UNCONTROLLED = 255
"""The level of autonomy at which no operator is connected."""


def files_of(machine: Machine, library: Library) -> dict[str, str] | None:
    """The files of a machine; None where FlexBE refuses it."""
    report: Report = []
    files = build(Checked(with_state_types(machine, library)), TARGET, library, report)
    assert {item.code for item in report} <= {"SM601"}, report
    return files or None


def engine_modules() -> dict[str, ModuleType]:
    """The modules of FlexBE, and of the ROS 2 that it needs, by name."""
    public = {name: value for name, value in vars(stand_in).items() if name[0] != "_"}
    names = ("flexbe_core.core", "rclpy", "rclpy.logging", "rclpy.signals")
    made = {name: ModuleType(name) for name in names}
    for module in made.values():
        vars(module).update(public)
    return {"flexbe_core": stand_in, **made}


@contextmanager
def loaded(files: dict[str, str]) -> Iterator[Any]:
    """The class of the behavior; its packages can be imported meanwhile."""
    engine = engine_modules()
    texts = {
        ".".join(PurePosixPath(path).parts[1:])[: -len(".py")]: text
        for path, text in files.items()
        if PurePosixPath(path).parent.name == PurePosixPath(path).parts[0]
        and path.endswith(".py")
        and not path.endswith(("setup.py", "__init__.py"))
    }
    (behavior, *_) = texts
    packages = {name.partition(".")[0] for name in texts}
    (states,) = {name for name in packages if name.endswith("_states")}
    runtime = f"{states}.smachac_flexbe"
    texts = {runtime: RUNTIME.read_text("utf-8"), **texts}
    order = [runtime, *sorted(name for name in texts if name not in (runtime, behavior)), behavior]
    names = [*engine, *packages, *texts]
    before = {name: sys.modules.get(name) for name in names}
    sys.modules.update(engine)
    try:
        for name in packages:
            sys.modules[name] = ModuleType(name)
        for name in order:
            module = sys.modules[name] = ModuleType(name)
            exec(compile(texts[name], f"{name}.py", "exec"), vars(module))
            package, _, word = name.partition(".")
            setattr(sys.modules[package], word, module)
        found = vars(sys.modules[behavior]).values()
        (made,) = (
            value for value in found if isinstance(value, type) and value.__module__ == behavior
        )
        yield made
    finally:
        stand_in.TOPICS.clear()
        stand_in.PriorityContainer.active_container = None
        for name, earlier in before.items():
            if earlier is None:
                sys.modules.pop(name, None)
            else:
                sys.modules[name] = earlier


def ready(made: Any, level: int = UNCONTROLLED, inputs: dict[str, Any] | None = None) -> Any:
    """A behavior before its run, as the engine makes it."""
    behavior = made(None)
    behavior.set_up(1, level, False)
    behavior.prepare_for_execution(inputs)
    behavior.confirm()
    return behavior


def trace(files: dict[str, str], asked: tuple[str, int] = ("", 0)) -> list[dict[str, Any]]:
    """The events of a run; `asked` is the visit in which the machine gets a request to stop."""
    events: list[dict[str, Any]] = []
    entered: list[str] = []
    with loaded(files) as made, contextlib.redirect_stdout(io.StringIO()):
        behavior = ready(made)
        machine = behavior._state_machine

        def observe(event: dict[str, Any]) -> None:
            events.append(event)
            if event["event"] == "enter":
                entered.append(event["path"])
                if (event["path"], entered.count(event["path"])) == asked:
                    machine.request_preempt()

        machine.observe(observe)
        with contextlib.suppress(Exception):
            behavior.execute()
    return events

"""Player of the YASMIN target: the generated modules run on the YASMIN that this Python imports.

The states of the program perform the steps of the test case, as those of the Python target do; the
containers are those of YASMIN. The modules are loaded once; each trace builds the machine anew.
"""

from __future__ import annotations

import copy
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from smachac.ir.nodes import Machine
from smachac.runtime.tracing import trace
from smachac.targets.python.runner import hidden, loaded, quiet
from smachac.targets.runtime_files import runtime_files
from smachac.targets.yasmin import RUNTIME
from smachac.verify.players.python import prepared, silent, unplayable_errors, without_secret
from smachac.verify.players.ros_stand_ins import built, ros_stand_ins
from smachac.verify.python_values import ITEMS
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError, record_read

MISSING = (
    "YASMIN is not here: build it from its repository (github.com/uleroboticsgroup/yasmin) with"
    " colcon, and run smachac in the terminal in which its workspace was sourced"
)


def player(files: Mapping[str, str], machine: Machine, *, folders: Sequence[Path]) -> Player:
    """A player of the generated modules `files`, which may import modules from `folders`: the
    module for YASMIN, and the program with the states.

    Raises UnplayableError if YASMIN is missing or the modules cannot be loaded.
    """

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        try:
            import_module("yasmin")
        except ImportError as error:
            raise UnplayableError(f"{MISSING} ({error})") from error
        with (
            unplayable_errors("the program for YASMIN"),
            ros_stand_ins("\n".join(files.values()), machine),
            modules(files, *folders) as module,
            quiet(module.smach_program.smach, hidden),
            silent("yasmin"),
        ):
            for case in cases:
                yield _trace(module, machine.root.name, case)

    return play


@contextmanager
def modules(files: Mapping[str, str], *folders: Path) -> Iterator[Any]:
    """The first of generated modules, which imports the others and the runtime for YASMIN. Inside
    the context they can import modules of the user from `folders`."""
    runtime = runtime_files({RUNTIME: f"yasmin/{RUNTIME}"})
    texts = {**runtime, **dict(reversed([*files.items()]))}
    names = [Path(name).stem for name in texts]
    before = {name: sys.modules.pop(name) for name in names if name in sys.modules}
    with ExitStack() as stack:
        stack.callback(sys.modules.update, before)
        for name, text in texts.items():
            stack.enter_context(loaded(name, text, *folders, importable=True))
        yield sys.modules[names[-1]]


def _trace(module: Any, name: str, case: TestCase) -> list[Event]:
    """The trace of one run; an error that ends the run is an event of it."""
    events: list[Event] = []
    runtime: Any = import_module(Path(RUNTIME).stem)  # the one that the module has imported
    strict = trace.StrictScript(case.reads, partial(record_read, events), case.most)
    states = prepared(built(module.smach_program.build), name, case, strict)
    if hasattr(module, "Native"):  # states of YASMIN perform their steps as the others do
        module.Native = lambda state, catches="", **_keys: runtime.Skill(state, catches)
    root = module.build(runtime.Parts(states, name))
    for path, key, value in case.samples:
        if key == ITEMS:
            _container_at(root, path).items = value
    run = runtime.Run(root, copy.deepcopy(case.userdata))
    states.request_preempt = run.request_preempt  # steps request a stop of this machine

    def observe(event: Event) -> None:
        events.append(without_secret(event, case))

    run.observe(observe)
    if case.stopped:
        run.request_preempt()
    with suppress(Exception):
        run.execute()
    return events


def _container_at(root: Any, path: str) -> Any:
    """The container at a path of a machine of YASMIN."""
    for name in path.split("/")[1:]:
        root = root.children[name]
    return root

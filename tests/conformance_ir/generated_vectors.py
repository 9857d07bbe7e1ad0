"""Recorded SMACH machines as generated Python: compiled from the state graph, built and run.

The leaves have a state type from a library, as the state types of users do.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from smachac.diagnostics.source import NOWHERE
from smachac.driver import build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.ir.nodes import Checked, Leaf, Node, Value, Variable
from smachac.targets.python import TARGET
from tests.conformance import vector_leaf, vector_replay
from tests.conformance_ir.ir_vectors import data_of, leaves_of, machine_of
from tests.support.silent_smach import silent_smach
from tests.support.typed_machines import with_state_types

Json = Any

INTERFACE = """
name: Vector
variables: {node: {doc: The description of the leaf.}}
input_keys: {"*": {}}
output_keys: {"*": {}}
outcomes: {"*": {}}
"""

TEMPLATE = """
{% block imports %}
from tests.conformance.vector_leaf import Follower
{% endblock %}
{% block class_defs %}
class Vector(Follower, smach.State):
    def __init__(self, outcomes, node, input_keys=(), output_keys=()):
        smach.State.__init__(self, outcomes, list(input_keys), list(output_keys))
        self.node = node
{% endblock %}
"""

LIBRARY = memory_library(
    {"templates/Vector.yml": INTERFACE, "templates/Vector.tpl.py": TEMPLATE},
    disk_library(Path("main.yml"), []),
)

RUNTIMES = ["smachac.runtime.smach"]
if importlib.util.find_spec("smach"):
    RUNTIMES.append("smach")
"""The modules that generated code can run on here."""


def replay(case: Json, runtime: str = RUNTIMES[0]) -> Json:
    """What generated code does, in the form of the recorded expectations."""

    def make(_: Json, path: str, recording: Any) -> Any:
        with _only(runtime):
            module: dict[str, Any] = {"__name__": "generated"}
            exec(compile(module_of(case), "generated.py", "exec"), module)
            root = module["build"]()
        _attach(root, path, recording)
        return root

    library = importlib.import_module(runtime)
    with silent_smach(library):
        return vector_replay.replay(case, make, library)


def module_of(case: Json) -> str:
    """The text of the generated module."""
    machine = machine_of(case)
    root: Any = _with_scripts(machine.root, "", leaves_of(case))
    typed = with_state_types(replace(machine, root=root), LIBRARY)
    report: list[Any] = []
    files = build(Checked(typed), TARGET, LIBRARY, report)
    assert report == []
    (text,) = files.values()
    return text


def _with_scripts(node: Node, path: str, leaves: dict[str, Json]) -> Node:
    """The graph with the descriptions of leaves as a variable of theirs."""
    if isinstance(node, Leaf):
        value = Value(data=data_of(leaves[path]), span=NOWHERE)
        return replace(node, variables=(Variable(name="node", value=value, span=NOWHERE),))
    children = (_with_scripts(one, f"{path}/{one.name}", leaves) for one in node.children)
    return replace(node, children=tuple(children))


@contextmanager
def _only(runtime: str) -> Iterator[None]:
    """Let `import smach` find what is asked for."""
    before = sys.modules.get("smach")
    if runtime != "smach":
        sys.modules["smach"] = None  # type: ignore[assignment]  # so that importing fails
    yield
    sys.modules.pop("smach", None)
    if before is not None:
        sys.modules["smach"] = before


def _attach(state: Any, path: str, recording: Any) -> None:
    """Have all that a built machine does recorded, and give its leaves their scripts."""
    recording.nodes[path] = state
    if not hasattr(state, "get_children"):
        recording.types[path] = "leaf"
        state.script = vector_leaf.Script(state.node, path, recording)
        state.script.state = state
        return
    recording.types[path] = KINDS[type(state).__name__]
    vector_replay.watch(state, path, recording)
    for label, child in state.get_children().items():
        _attach(child, vector_leaf.join(path, label), recording)


KINDS = {
    "StateMachine": "state_machine",
    "Sequence": "sequence",
    "Concurrence": "concurrence",
    "Iterator": "iterator",
}

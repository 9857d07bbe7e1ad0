"""The output keys that states of a running program do not write, although their interfaces promise
them for the outcome."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from smachac.analysis.accesses import leaf_writes
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.script_paths import script_paths
from smachac.ir.traversal import walk


def output_check(machine: Machine) -> Callable[[Mapping[str, Any]], list[str]]:
    """A function that receives each event of a trace, with paths of the script, and returns the
    sentences to print: one for each state and key, the first time that the state ends with an
    outcome that promises the key and has never written it. A state that was stopped, itself or
    with a container around it, may leave its work undone."""
    shown = script_paths(machine.root)
    leaves = {shown.get(path, path): node for path, node in walk(machine.root)
              if isinstance(node, Leaf) and node.outputs}  # fmt: skip
    settled: dict[str, set[str]] = {
        path: {key.name for key in leaf.inputs} for path, leaf in leaves.items()
    }

    stopped: set[str] = set()

    def check(event: Mapping[str, Any]) -> list[str]:
        path, kind = event["path"], event["event"]
        if kind == "preempt":
            stopped.add(path)
        elif kind == "enter":
            stopped.discard(path)
        if path not in leaves:
            return []
        if kind == "write":
            settled[path].add(event["key"])
        if kind != "exit" or event.get("forced"):
            return []
        if any(path == place or path.startswith(f"{place}/") for place in stopped):
            return []
        missing = sorted(leaf_writes(leaves[path], event["outcome"]).sure - settled[path])
        settled[path].update(missing)
        outcome = event["outcome"]
        return [f"`{path}` ended with `{outcome}` and did not write its output key `{key}`"
                for key in missing]  # fmt: skip

    return check

"""Paths of states as the script shows them, and what the containers made of sugar are for.

`timeout`, `retry` and `for_each` put containers around a state (frontend/script/desugar.py). The
state has the path that the script shows, `sm/DRIVE`, whatever its depth in the graph. A container
around it has that path and its role, `sm/DRIVE (retry)`; a state that was added to it is below that
path: `sm/DRIVE (timeout)/TIMER`. Paths of the graph are called full paths.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import PathStep
from smachac.ir.nodes import Container, Leaf, Node, StateMachine
from smachac.ir.traversal import containers


def role(node: Node) -> str:
    """The role of a container that was made of sugar; empty for all other nodes. `try` is one try
    of a retry with a delay."""
    if isinstance(node, Leaf) or not node.sugar:
        return ""
    return "try" if isinstance(node, StateMachine) else node.sugar


def sugared_child(container: Container) -> Node | None:
    """The state for which a container was made of sugar, or the next container around it. None for
    a container of the script."""
    if not container.sugar or not container.children:
        return None
    return container.children[-1 if isinstance(container, StateMachine) else 0]


class ScriptPath(NamedTuple):
    """A node with its full path, its path in the script (`shown`), and that without roles
    (`plain`), which containers made of sugar share with their state. `added`: a timer or pause of
    sugar."""

    full: str
    shown: str
    plain: str
    node: Node
    added: bool


def walk_script(root: Node) -> Iterator[ScriptPath]:
    """All nodes with their paths, parents before children."""
    stack = [ScriptPath(root.name, root.name, root.name, root, False)]
    while stack:
        here = stack.pop()
        yield here
        if isinstance(here.node, Leaf):
            continue
        inside = sugared_child(here.node)
        for child in reversed(here.node.children):
            added = inside is not None and child is not inside
            if child is inside:
                shown = plain = here.plain
            else:
                shown, plain = f"{here.shown}/{child.name}", f"{here.plain}/{child.name}"
            shown = f"{plain} ({what})" if (what := role(child)) else shown
            stack.append(ScriptPath(f"{here.full}/{child.name}", shown, plain, child, added))


def script_paths(root: Node) -> dict[str, str]:
    """The paths in the script by full path; only those that differ."""
    if not _has_sugar(root):
        return {}
    return {path.full: path.shown for path in walk_script(root) if path.shown != path.full}


class PlainPaths(dict[str, str]):
    """The paths in the script without roles, by full path; only those that differ. `added` are the
    full paths of the timers and pauses of sugar."""

    def __init__(self) -> None:
        super().__init__()
        self.added: set[str] = set()


NO_SUGAR = PlainPaths()
"""The plain paths of a machine without sugar."""


def plain_paths(root: Node) -> PlainPaths:
    """The plain paths of a machine."""
    found = PlainPaths()
    if isinstance(root, Leaf) or not _has_sugar(root):
        return found
    stack: list[tuple[str, str, Container]] = [(root.name, root.name, root)]
    while stack:
        full, plain, container = stack.pop()
        inside = sugared_child(container)
        for child in container.children:
            if full == plain and child is not inside and isinstance(child, Leaf):
                continue  # most states, whose paths do not differ
            below = f"{full}/{child.name}"
            shown = plain if child is inside else f"{plain}/{child.name}"
            if shown != below:
                found[below] = shown
            if inside is not None and child is not inside:
                found.added.add(below)
            if not isinstance(child, Leaf):
                stack.append((below, shown, child))
    return found


def _has_sugar(root: Node) -> bool:
    return any(node.sugar for _, node in containers(root))


def name_in_script(node: Node) -> str:
    """The name of a node in the script: for a container made of sugar, that of its state."""
    while not isinstance(node, Leaf) and (inside := sugared_child(node)) is not None:
        node = inside
    return node.name


def steps_in_script(plain: PlainPaths, steps: Sequence[PathStep]) -> list[tuple[int, str]]:
    """The steps of a path as the script shows them: their numbers and labels. `plain` are the plain
    paths.

    A state and the containers of its sugar are one step, where they are entered together or end
    with the same outcome; timers and pauses are none.
    """
    if not plain:
        return [(at, step.label) for at, step in enumerate(steps)]
    kept: list[int] = []
    skipped = False
    last = ""  # the full path of the state of the last step
    for at, step in enumerate(steps):
        if step.is_outcome or step.node is None:
            if not (skipped and step.is_outcome):
                kept.append(at)
            skipped = False
            continue
        if step.node in plain.added:
            skipped = True
            continue
        same = plain.get(step.node, step.node) == plain.get(last, last)
        if same and not steps[kept[-1]].is_outcome:
            kept.pop()
        skipped = (
            same
            and last.startswith(f"{step.node}/")
            and steps[kept[-1] : kept[-1] + 1] == steps[at + 1 : at + 2]
        )
        if not skipped:
            kept.append(at)
            last = step.node
    return [(at, _label(plain, steps[at])) for at in kept]


def _label(plain: PlainPaths, step: PathStep) -> str:
    path = plain.get(step.node) if step.node is not None else None
    return step.label if path is None else path.rpartition("/")[2]

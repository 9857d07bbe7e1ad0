"""Name resolution for commands: a state by its path or the end of it, an outcome or key by that of
its state."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Leaf, Machine, Node
from smachac.ir.traversal import remapping, walk


class NotFoundError(Exception):
    """A name has no meaning, or several; the message lists candidates."""


def find_state(machine: Machine, name: str) -> tuple[str, Node]:
    """A state by its path or the end of it. Raises NotFoundError."""
    found = {path: node for path, node in walk(machine.root)
             if path == name or path.endswith(f"/{name}")}  # fmt: skip
    if name in found:
        return name, found[name]
    if not found:
        paths = [path for path, _ in walk(machine.root)]
        names = dict.fromkeys(path.rpartition("/")[2] for path in paths)
        near = did_you_mean(name.rpartition("/")[2], names) or ""
        raise NotFoundError(f"there is no state `{name}`\n{near}".rstrip())
    if len(found) > 1:
        lines = [f"there are {len(found)} states `{name}`; name one by its path:"]
        raise NotFoundError("\n".join([*lines, *(f"  {path}" for path in list(found)[:20])]))
    return next(iter(found.items()))


def find_named(machine: Machine, path: str, kind: str | None) -> tuple[str, Span, str]:
    """The meaning of a path: a state, or an outcome or key of the state before its last part.

    Returns the kind, the span of the declaration and the name. Raises NotFoundError.
    """
    around, _, name = path.rpartition("/")
    found: dict[tuple[str, int, int], tuple[str, Span, str, str]] = {}
    known: dict[str, None] = {}

    def note(what: str, where: str, span: Span) -> None:
        found.setdefault((what, id(span.source), span.start), (what, span, name, where))

    for here, node in walk(machine.root):
        known.setdefault(node.name)
        if here == path or here.endswith(f"/{path}"):
            note("state", here, node.span)
        known.update(dict.fromkeys(outcome.name for outcome in node.outcomes))
        if not (here == around or here.endswith(f"/{around}") or (not around and "/" not in here)):
            continue
        for outcome in node.outcomes:
            if outcome.name == name:
                note("outcome", f"{here}/{name}", outcome.span)
        if isinstance(node, Leaf) or node.sugar or not node.children:
            continue
        keys = {key.name for key in (*node.inputs, *node.outputs)}
        keys |= {preset.key for preset in node.userdata}
        for child in node.children:
            outer = remapping(child)
            keys |= {outer.get(key.name, key.name) for key in (*child.inputs, *child.outputs)}
        known.update(dict.fromkeys(sorted(keys)))
        if name in keys:
            note("key", f"{here}/{name}", node.children[0].span)
    meant = [each for each in found.values() if kind in (None, each[0])]
    if not meant:
        near = did_you_mean(name, known) or ""
        what = kind or "state, outcome or key"
        raise NotFoundError(f"there is no {what} `{path}`\n{near}".rstrip())
    if len(meant) > 1:
        lines = [f"`{path}` is ambiguous: {len(meant)} matches; give more of the path, or --kind:"]
        lines += [f"  {where} ({what})" for what, _, _, where in meant[:20]]
        raise NotFoundError("\n".join(lines))
    return meant[0][:3]


def different_container_error(
    machine: Machine, above: str, name: str, known: Iterable[str]
) -> NotFoundError:
    """The error for a state that is not in the container at `above`."""
    other = next((path for path, node in walk(machine.root) if node.name == name), None)
    if other is not None:
        words = f"`{name}` is in `{other.rpartition('/')[0]}`, the first state in `{above}`"
        return NotFoundError(f"{words}\nall states must be in the same container")
    near = did_you_mean(name, known) or f"it has {listed(known)}"
    return NotFoundError(f"`{above}` has no state `{name}`\n{near}")

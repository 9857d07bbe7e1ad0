"""Name resolution for commands: a state by its path or the end of it, an outcome or key by that of
its state."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Iterator, Leaf, Machine, Node, Outcome
from smachac.ir.script_paths import ScriptPath, sugared_child, walk_script
from smachac.ir.traversal import outer_inputs, outer_outputs, walk
from smachac.refactor.editor import RefusedError


class NotFoundError(Exception):
    """A name has no meaning, or several; the message lists candidates."""


def find_state(machine: Machine, name: str) -> tuple[str, Node]:
    """A state by its path in the script or the end of it, with its full path; of a state with sugar
    the outermost container. Raises NotFoundError, and RefusedError for a state that sugar adds."""
    found: dict[str, ScriptPath] = {}
    exact: dict[str, ScriptPath] = {}
    outermost: dict[str, ScriptPath] = {}
    for path in walk_script(machine.root):
        outer = outermost.setdefault(path.plain, path)
        if any(_ends(path, name) for path in (path.plain, path.shown, path.full)):
            found.setdefault(path.plain, outer)
            exact |= {path.plain: outer} if name in (path.plain, path.shown, path.full) else {}
    if not found:
        paths = [path for path, _ in walk(machine.root)]
        names = dict.fromkeys(path.rpartition("/")[2] for path in paths)
        near = did_you_mean(name.rpartition("/")[2], names) or ""
        raise NotFoundError(f"there is no state `{name}`\n{near}".rstrip())
    written = [path for path in found.values() if not path.added] or list(found.values())
    if len(exact.values() or written) > 1:
        lines = [f"there are {len(written)} states `{name}`; name one by its path:"]
        raise NotFoundError("\n".join([*lines, *(f"  {path.plain}" for path in written[:20])]))
    (one,) = exact.values() or written
    if one.added:
        raise _added_error(one)
    return one.full, one.node


def _ends(path: str, name: str) -> bool:
    return path == name or path.endswith(f"/{name}")


def _added_error(state: ScriptPath) -> RefusedError:
    """The error for a timer or pause that sugar adds to the states of the script."""
    around, _, name = state.plain.rpartition("/")
    owner = around.rpartition("/")[2]
    field = "retry" if state.shown.rpartition("/")[0].endswith("(try)") else "timeout"
    message = f"the script has no state `{name}`: `{field}` of `{owner}` adds it"
    return RefusedError(state.node.span, message)


def find_named(machine: Machine, path: str, kind: str | None) -> tuple[str, Span, str]:
    """The meaning of a path: a state, or an outcome or key of the state before its last part.

    Returns the kind, the span of the declaration and the name. Raises NotFoundError.
    """
    around, _, name = path.rpartition("/")
    found: dict[tuple[str, int, int], tuple[str, Span, str, str]] = {}
    known: dict[str, str] = {}  # names, each with a path

    def note(what: str, where: str, span: Span) -> None:
        found.setdefault((what, id(span.source), span.start), (what, span, name, where))

    added: ScriptPath | None = None
    fixed: RefusedError | None = None
    for other in walk_script(machine.root):
        here, node = other.plain, other.node
        known.setdefault(node.name, here)
        if other.added:
            added = other if _ends(here, path) else added
            continue
        if _ends(here, path):
            note("state", here, node.span)
        for outcome in node.outcomes:
            known.setdefault(outcome.name, f"{here}/{outcome.name}")
        if not (_ends(here, around) or (not around and "/" not in here)):
            continue
        fixed = fixed or _fixed_name(node, name)
        for outcome in own_outcomes(node):
            if outcome.name == name:
                note("outcome", f"{here}/{name}", outcome.span)
        if isinstance(node, Leaf) or node.sugar or not node.children:
            continue
        keys = {key.name for key in (*node.inputs, *node.outputs)}
        keys |= {preset.key for preset in node.userdata}
        for child in node.children:
            keys.update(outer_inputs(child), outer_outputs(child))
        for key in sorted(keys):
            known.setdefault(key, f"{here}/{key}")
        if name in keys:
            note("key", f"{here}/{name}", node.children[0].span)
    meant = [row for row in found.values() if kind in (None, row[0])]
    if not meant and fixed is not None:
        raise fixed
    if not meant and added is not None:
        raise _added_error(added)
    if not meant:
        near = did_you_mean(name, known) or ""
        if name in known:
            near = f"did you mean `{known[name]}`?"
        what = kind or "state, outcome or key"
        raise NotFoundError(f"there is no {what} `{path}`\n{near}".rstrip())
    if len(meant) > 1:
        lines = [f"`{path}` is ambiguous: {len(meant)} matches; give more of the path, or --kind:"]
        lines += [f"  {where} ({what})" for what, _, _, where in meant[:20]]
        raise NotFoundError("\n".join(lines))
    return meant[0][:3]


def own_outcomes(node: Node) -> tuple[Outcome, ...]:
    """The outcomes of a node without those that its sugar adds."""
    while not isinstance(node, Leaf) and (inside := sugared_child(node)) is not None:
        node = inside
    return node.outcomes


def _fixed_name(node: Node, name: str) -> RefusedError | None:
    """The error for a name that sugar gives to an outcome, or to the item of a loop."""
    if isinstance(node, Leaf) or not node.sugar:
        return None
    field = node.sugar
    mine = next((outcome for outcome in node.outcomes if outcome.name == name), None)
    if mine is not None and all(outcome.name != name for outcome in own_outcomes(node)):
        inside = sugared_child(node)
        if inside is not None and any(outcome.name == name for outcome in inside.outcomes):
            return _fixed_name(inside, name)
        message = f"`{field}` gives the outcome `{name}` its name"
        return RefusedError(mine.span, message, "lead it elsewhere in `transitions`")
    if isinstance(node, Iterator) and field == "for_each" and name == node.item_key:
        message = f"`{name}` is the item of `for_each` and a key of the state, which may be a name"
        help = "rename the two by hand, or give the state a remapping"
        return RefusedError(node.items.span if node.items else node.span, f"{message} of its type",
                            help)  # fmt: skip
    return None


def different_container_error(
    machine: Machine, above: str, name: str, known: Iterable[str]
) -> NotFoundError:
    """The error for a state that is not in the container at `above`."""
    other = next((path.plain for path in walk_script(machine.root) if path.node.name == name), None)
    if other is not None:
        words = f"`{name}` is in `{other.rpartition('/')[0]}`, the first state in `{above}`"
        return NotFoundError(f"{words}\nall states must be in the same container")
    near = did_you_mean(name, known) or f"it has {listed(known)}"
    return NotFoundError(f"`{above}` has no state `{name}`\n{near}")

"""The resources that states hold while they run, as far as they are known before the run."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from smachac.analysis.accesses import accesses, inside
from smachac.analysis.context import containers, states
from smachac.ir.nodes import Data, Machine, Node
from smachac.ir.traversal import remapping

Held = dict[int, dict[str, Node]]
"""By `id` of a state what it or something in it claims, with the innermost that does."""

Constants = dict[str, "str | None"]
"""The keys that a container's userdata may hold; None where the value is not known."""

_KEY = re.compile(r"\{(\w+)\}")


def prefixes(claim: str) -> Iterator[str]:
    """The resources that cover a claim, the widest first, itself last: `arm`, `arm.left`."""
    parts = claim.split(".")
    for end in range(1, len(parts) + 1):
        yield ".".join(parts[:end])


def claims(machine: Machine) -> Held:
    """The claims of every state. One that is not known keeps its key in braces: two such claims
    may be of different things."""
    values = _constants(machine) if _have_keys(machine) else {}
    found: Held = {id(machine.root): {}}
    for _, container in containers(machine):
        for child in container.children:
            keys = values.get(id(container), {})
            own = (_filled(claim, child, keys) for claim in child.claims)
            found[id(child)] = dict.fromkeys(own, child)
    for _, container in reversed(containers(machine)):
        held = found[id(container)]
        for child in container.children:
            for claim, origin in found[id(child)].items():
                held.setdefault(claim, origin)
    return found


def _have_keys(machine: Machine) -> bool:
    return any("{" in claim for _, node in states(machine) for claim in node.claims)


def _filled(claim: str, node: Node, keys: Mapping[str, str | None]) -> str:
    names = remapping(node)
    inputs = {key.name for key in node.inputs}

    def value(found: re.Match[str]) -> str:
        key = found[1]
        known = keys.get(names.get(key, key)) if key in inputs else None
        return known if known is not None else found[0]

    return _KEY.sub(value, claim)


def _constants(machine: Machine) -> dict[int, Constants]:
    """By `id` of a container what its userdata holds whenever something in it runs."""
    known = accesses(machine)
    found: dict[int, Constants] = {}
    parents: dict[int, Node] = {}
    for _, container in containers(machine):
        parents.update((id(child), container) for child in container.children)
        own: Constants = {preset.key: _text(preset.value.data) for preset in container.userdata}
        outside = found[id(parents[id(container)])] if id(container) in parents else None
        names = remapping(container)
        for key in container.inputs:
            outer = names.get(key.name, key.name)
            if outside is None:
                own.setdefault(key.name, None)
            elif outer in outside:
                own[key.name] = outside[outer]
        own.update(dict.fromkeys(inside(container, known).writes))
        found[id(container)] = own
    return found


def _text(data: Data) -> str | None:
    """A constant as a part of a claim."""
    return str(data) if isinstance(data, str | int) and not isinstance(data, bool) else None

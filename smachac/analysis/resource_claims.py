"""Resource claims: the resources that each state holds while it runs, as far as they are static."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from smachac.analysis.accesses import Accesses, inside
from smachac.ir.nodes import Container, Data, Leaf, Node
from smachac.ir.traversal import remapping

Held = dict[str, dict[str, Node]]
"""By path of a state the claims of it and of the nodes inside, with the innermost claimant."""

Constants = dict[str, "str | None"]
"""The keys that a container's userdata may hold; None where the value is not known."""

_KEY = re.compile(r"\{(\w+)\}")


def prefixes(claim: str) -> Iterator[str]:
    """The resources that cover a claim, the widest first, itself last: `arm`, `arm.left`."""
    parts = claim.split(".")
    for end in range(1, len(parts) + 1):
        yield ".".join(parts[:end])


def claims(
    states: Iterable[tuple[str, Node]],
    containers: Sequence[tuple[str, Container]],
    accesses: Callable[[], Mapping[str, Accesses]],
) -> Held:
    """The claims of every state. A claim with an unknown key keeps the key in braces: two such
    claims can be of different resources. `accesses` returns those of every state, which few
    machines need."""
    values = _constants(containers, accesses()) if _have_keys(states) else {}
    found: Held = {path: {} for path, _ in containers[:1]}
    for path, container in containers:
        keys = values.get(path, {})
        for child in container.children:
            own = [_filled(claim, child, keys) for claim in child.claims] if child.claims else ()
            found.setdefault(f"{path}/{child.name}", dict.fromkeys(own, child))
    for path, container in reversed(containers):
        held = found[path]
        for child in container.children:
            if isinstance(child, Leaf) and not child.claims:
                continue
            for claim, origin in found[f"{path}/{child.name}"].items():
                held.setdefault(claim, origin)
    return found


def _have_keys(states: Iterable[tuple[str, Node]]) -> bool:
    return any("{" in claim for _, node in states for claim in node.claims)


def _filled(claim: str, node: Node, keys: Mapping[str, str | None]) -> str:
    names = remapping(node)
    inputs = {key.name for key in node.inputs}

    def value(found: re.Match[str]) -> str:
        key = found[1]
        known = keys.get(names[key]) if key in inputs else None
        return known if known is not None else found[0]

    return _KEY.sub(value, claim)


def _constants(
    containers: Iterable[tuple[str, Container]], known: Mapping[str, Accesses]
) -> dict[str, Constants]:
    """By path of a container the constant keys of its userdata, while something in it runs."""
    found: dict[str, Constants] = {}
    for path, container in containers:
        own: Constants = {preset.key: _text(preset.value.data) for preset in container.userdata}
        outside = found.get(path.removesuffix(f"/{container.name}"))
        names = remapping(container)
        for key in container.inputs:
            outer = names[key.name]
            if outside is None:
                own.setdefault(key.name, None)
            elif outer in outside:
                own[key.name] = outside[outer]
        own.update(dict.fromkeys(inside(path, container, known).writes))
        found[path] = own
    return found


def _text(data: Data) -> str | None:
    """A constant as a part of a claim."""
    return str(data) if isinstance(data, str | int) and not isinstance(data, bool) else None

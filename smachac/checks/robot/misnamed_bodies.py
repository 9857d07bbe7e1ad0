"""A body that a state loads under a name which nothing uses, while others read another name."""

from __future__ import annotations

from collections.abc import Sequence

from smachac.analysis.context import Context
from smachac.analysis.type_inference import TypeFlow
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.findings.literals import reader
from smachac.checks.findings.value_places import place_of_part
from smachac.checks.robot.literal_parts import names_in, part_named, role_of
from smachac.diagnostics.diagnostic import Finding, Related
from smachac.diagnostics.spelling import guesser
from smachac.ir.nodes import Leaf


def misnamed_body(
    context: Context, wrong: Sequence[TypeFlow], known: frozenset[str]
) -> tuple[Finding, list[TypeFlow]] | None:
    """The finding on the only unknown name of a body that several states read, and a body whose
    name nothing uses; with the reads that it explains."""
    about = [flow for flow in wrong if role_of(flow.cell) == "body"]
    names = {name for flow in about for name in names_in(flow.value) if name not in known}
    if len(about) < 2 or len(names) != 1:
        return None
    (name,) = names
    found = _unused_loader(context, name) if guesser(sorted(known))(name) is None else None
    if found is None:
        return None
    path, leaf, body = found
    held = next((variable for variable in leaf.variables if variable.name == "body"), None)
    given = held is not None and held.value.data is not None
    span = held.value.span if held is not None and given else leaf.span
    related: list[Related] = []
    for flow in about:
        part = part_named(flow.value, name)
        place = place_of_part(flow.origin.span, part.steps, key=part.key)
        related += other_place(place, f"{reader(flow)} reads the body `{name}`")
    finding = Finding(
        span=span,
        message=f"`{leaf.name}` loads a body `{body}`, but the other states read a body `{name}`",
        arguments=(name, body),
        help=f"write `body: {name}` in `{leaf.name}`, or `{body}` where `{name}` is read",
        related=(*related, *calls(leaf, span)),
        node=path,
        effect=f"there is no body `{name}`: {reader(about[0])} fails at its first visit",
    )
    return finding, about


def _unused_loader(context: Context, name: str) -> tuple[str, Leaf, str] | None:
    """The state that loads a body whose name nothing uses: the one with a name that is the unknown
    name, else the only one."""
    used = {
        name
        for flow in context.types.constants
        if role_of(flow.cell) in ("body", "frame")
        for name in names_in(flow.value)
    }
    found = []
    for path, body in (context.bodies_loaded or {}).items():
        leaf = context.routes.nodes.get(path)
        if body not in used and isinstance(leaf, Leaf) and leaf.built_in:
            found.append((path, leaf, body))
    alike = [row for row in found if row[1].name.casefold() == name.casefold()]
    for some in (alike, found):
        if len(some) == 1:
            return some[0]
    return None

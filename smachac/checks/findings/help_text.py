"""Parts of findings that many rules share: help lines, and the calls of sub-scripts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import takewhile

from smachac.checks.findings import notation
from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Leaf, Node, VariableRole
from smachac.ir.outcome_names import OF_SMACH
from smachac.ir.traversal import outcome_names

ROS_KINDS: Mapping[VariableRole, str] = {"action_type": "an action", "service_type": "a service"}
"""The kinds of states that call a server, by the role of the variable with its type."""

CALLED_HERE = "in the sub-script called here"


def did_you_mean(name: str | None) -> str | None:
    """The help line for a guess."""
    return f"did you mean `{name}`?" if name else None


def ends_of(node: Node) -> str | None:
    """The help for an outcome that a state of an action or a service of ROS does not have, if the
    state has those of SMACH only."""
    if not isinstance(node, Leaf) or {*outcome_names(node)} != {*OF_SMACH}:
        return None
    kinds = [kind for role, kind in ROS_KINDS.items() if variable_of(node, role) is not None]
    ends = "ends with `succeeded`, `aborted` or `preempted`"
    return f"{kinds[0]} state {ends}" if kinds else None


def calls(node: Node, span: Span) -> tuple[Related, ...]:
    """The calls of sub-scripts that lead to the file of `span`, outermost first."""
    outside = takewhile(lambda call: call.source is not span.source, node.via)
    return tuple(Related(span=call, message=CALLED_HERE) for call in outside)


def other_place(span: Span, message: str) -> tuple[Related, ...]:
    """A related place, if there is one."""
    return () if span.source is NOWHERE.source else (Related(span=span, message=message),)


def names_apart(paths: Sequence[str]) -> list[str]:
    """The names of some states by their paths; where two of them are equal, with so many of the
    names around them that they are not."""
    shown = {path: path.rpartition("/")[2] for path in paths}
    for path in shown:
        parts = path.split("/")
        same = [text for text in shown if text != path and text.endswith(f"/{parts[-1]}")]
        count = 1
        while count < len(parts) and any(text.split("/")[-count:] == parts[-count:]
                                         for text in same):  # fmt: skip
            count += 1
        shown[path] = "/".join(parts[-count:])
    return [shown[path] for path in paths]


def in_quotes_for(code: str, span: Span) -> str:
    """Code to write into a scalar of a script, with the quotes that the scalar can contain."""
    given, other = ("'", '"') if span.text[:1] != '"' else ('"', "'")
    return code if given not in code or other in code else code.replace(given, other)


def own_name(node: Node, span: Span) -> str:
    """The name of a state as an argument of a finding at `span`; empty where a call of a sub-script
    in another file gives the name."""
    return node.name if node.span.source is span.source else ""


def added_remapping(node: Node, key: str, to: str) -> str:
    """The help that remaps a key of a state: a new field, or an entry of that which it has."""
    if node.remaps:
        return f"add `{notation.entry(node, key, to)}` to the `remapping` of `{node.name}`"
    return f"write `{notation.mapping(node, 'remapping', [(key, to)])}` in `{node.name}`"


def in_conditions(combination: Mapping[str, str]) -> str:
    """A combination of outcomes of a concurrence, as a script writes its conditions."""
    return ", ".join(f"`{child}: {outcome}`" for child, outcome in combination.items())

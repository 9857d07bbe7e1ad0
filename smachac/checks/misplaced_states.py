"""The finding on a state in a wrong container (SM101), or beside its concurrence (SM403)."""

from __future__ import annotations

from smachac.analysis.misplaced_states import Misplaced
from smachac.checks.messages import calls, other_place
from smachac.checks.rule_slips import UNKNOWN_BRANCH
from smachac.diagnostics.diagnostic import Finding
from smachac.ir.nodes import Concurrence


def misplaced_finding(found: Misplaced) -> Finding:
    """SM101 at a state in a wrong container, or SM403 at one that is beside its concurrence."""
    name, owner, meant = found.child.name, found.container.name, found.meant.name
    deeper = found.meant_path.startswith(f"{found.path.rpartition('/')[0]}/")
    way = f"indent `{name}` as a state of `{meant}`"
    if not deeper:
        way = f"write `{name}` with the indentation of the states of `{meant}`"
    is_branch = isinstance(found.meant, Concurrence)
    leads = f"a transition in `{meant}` leads to `{name}`"
    if is_branch:
        leads = f"a rule of `{meant}` is about `{name}`"
        columns = found.meant.children[0].span.column - found.child.span.column \
            if found.meant.children else 0  # fmt: skip
        if columns > 0 and found.meant.children[0].span.line != found.child.span.line:
            way = f"indent `{name}` by {columns} more column{'s' * (columns > 1)}, as a state of"
            way += f" `{meant}`"
    only = f"the `outcome_map` of `{meant}` names it" if is_branch \
        else f"only transitions in `{meant}` lead to it"  # fmt: skip
    return Finding(
        span=found.child.span,
        message=f"`{name}` is a state of `{owner}`, but {only}",
        arguments=(name, meant, "container"),
        help=way,
        effect=UNKNOWN_BRANCH
        if is_branch
        else "SMACH refuses to run such a container: none of its states runs",
        related=(
            *other_place(found.place, leads),
            *calls(found.child, found.child.span),
        ),
        node=found.path,
    )

"""The finding on a state in a wrong container (SM101)."""

from __future__ import annotations

from smachac.analysis.misplaced_states import Misplaced
from smachac.checks.messages import calls, other_place
from smachac.diagnostics.diagnostic import Finding


def misplaced_finding(found: Misplaced) -> Finding:
    """SM101 at a state in a wrong container."""
    name, owner, meant = found.child.name, found.container.name, found.meant.name
    deeper = found.meant_path.startswith(f"{found.path.rpartition('/')[0]}/")
    way = f"indent `{name}` as a state of `{meant}`"
    if not deeper:
        way = f"write `{name}` with the indentation of the states of `{meant}`"
    return Finding(
        span=found.child.span,
        message=f"`{name}` is a state of `{owner}`, but only transitions in `{meant}` lead to it",
        arguments=(name, meant, "container"),
        help=way,
        effect="SMACH refuses to run such a container: none of its states runs",
        related=(
            *other_place(found.step.target_span, f"a transition in `{meant}` leads to `{name}`"),
            *calls(found.child, found.child.span),
        ),
        node=found.path,
    )

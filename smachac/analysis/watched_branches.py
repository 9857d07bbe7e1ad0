"""Branches of a concurrence that wait without a limit, and that another branch has to stop."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Concurrence, Data, Leaf, OutcomeRule, StateType, VariableType
from smachac.ir.outcome_names import PREEMPTED, fails
from smachac.ir.traversal import outcome_names

TIMEOUTS = frozenset(["timeout", "timed_out"])


def is_limited(leaf: Leaf, limits: Collection[VariableType]) -> bool:
    """Whether a wait ends by itself. `limits` are those of its type that limit it."""
    names = frozenset(outcome_names(leaf))
    if leaf.open or not TIMEOUTS.isdisjoint(names):
        return True
    values = {one.name: one.default.data if one.default else None for one in limits}
    given = [one for one in leaf.variables if one.name in values or one.name.endswith("timeout")]
    values.update((one.name, one.value.data) for one in given)
    tries = {one.name for one in limits if one.role == "tries"}
    if any(_limits(value, name in tries) for name, value in values.items()):
        return True
    return PREEMPTED in names and not values and len(names) > 2


def _limits(value: Data, tries: bool) -> bool:
    """Whether a value is a limit: a negative number of tries is none."""
    return value is not None and not (tries and isinstance(value, int) and value < 0)


def time_limits(types: Mapping[str, StateType]) -> dict[str, list[VariableType]]:
    """By state type the variables for a time limit or a limit of tries."""
    return {
        name: [
            one
            for one in type_.variables.values()
            if one.role == "tries" or one.name.endswith("timeout")
        ]
        for name, type_ in types.items()
    }


STOPS = (PREEMPTED, "cancelled", "canceled", "interrupted", "stopped")
"""The names of outcomes of a container that was stopped."""


class Watched(NamedTuple):
    """A concurrence at `path` that waits for all branches, of which the one at `branch` waits
    without a limit. `other` is a rule without it, and another rule is about this branch only; or
    `other` requires that this branch was preempted, although another one has ended by itself."""

    path: str
    container: Concurrence
    branch: str
    leaf: Leaf
    other: OutcomeRule


def watched_branches(context: Context) -> tuple[Watched, ...]:
    """The concurrences whose rules are meant for `join: any`, which they lack."""
    limits: dict[str, list[VariableType]] | None = None
    found: list[Watched] = []
    for path, container in context.containers:
        if not isinstance(container, Concurrence) or container.sugar or container.join == "any":
            continue
        for child in container.children:
            if not isinstance(child, Leaf) or not child.blocking:
                continue
            if variable_of(child, "duration"):  # it ends by itself
                continue
            rules = [({part.child for part in rule.when}, rule) for rule in container.rules]
            alone = [rule for names, rule in rules if names == {child.name}
                     and rule.when[0].outcome != PREEMPTED]  # fmt: skip
            others = [rule for names, rule in rules if names and child.name not in names]
            others = others if alone else []
            others += [rule for rule in container.rules if _stops(container, rule, child.name)]
            if not others or PREEMPTED not in outcome_names(child):
                continue
            if limits is None:
                limits = time_limits(context.machine.state_types)
            if not is_limited(child, limits.get(child.type, ())):
                branch = f"{path}/{child.name}"
                found.append(Watched(path, container, branch, child, others[0]))
    return tuple(found)


def _stops(container: Concurrence, rule: OutcomeRule, name: str) -> bool:
    """Whether a rule requires that the branch `name` was preempted and that another one has ended
    by itself; not a rule for a failure or a stop of the whole concurrence."""
    ends = {part.child: part.outcome for part in rule.when}
    return (
        ends.get(name) == PREEMPTED
        and any(outcome != PREEMPTED for outcome in ends.values())
        and not fails(container, rule.outcome)
        and rule.outcome not in (*STOPS, container.default_outcome)
    )


def missing_joins(context: Context) -> frozenset[str]:
    """The paths of the concurrences that wait for all branches, of which one never ends or is meant
    to be stopped by another one (SM407)."""
    ever, unstopped = context.endings
    found = {branch.path for branch in watched_branches(context)}
    for path, container in context.containers:
        if isinstance(container, Concurrence) and container.join == "all":
            branches = [f"{path}/{child.name}" for child in container.children]
            if any(unstopped[here] for here in branches) and any(
                ever[here] and not unstopped[here] for here in branches
            ):
                found.add(path)
    return frozenset(found)

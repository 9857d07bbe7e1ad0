"""What the children of a concurrence have written when it ends."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping

from smachac.ir.accesses import ANYTHING, NONE, NOTHING, Writes
from smachac.ir.graph import Place, exit_place
from smachac.ir.nodes import Concurrence, Leaf, Node, OutcomeRule
from smachac.ir.walk import outcome_names

Endings = Mapping[str, Writes]
"""The outcomes that a child can have, and what it writes on each; `*` is any outcome at all."""

ANY = "*"

MOST_ROUNDS = 10
"""So often the rules are gone through for what their failing to match tells."""

MOST_WORK = 5_000_000
"""Rules times keys: beyond that the rules are not told apart, which is on the safe side."""


def joined(
    container: Concurrence, writes: Callable[[str, str], Writes | None]
) -> Iterator[tuple[Place, Writes]]:
    """Where a concurrence goes from its start: into each child, and to each outcome.

    With an outcome comes what all children together have written. They all run to their end, also
    where the first to end preempts the others: `join` makes no difference.
    """
    every = {child.name: _endings(child, writes) for child in container.children}
    yield from ((name, NOTHING) for name in every)
    if not all(every.values()):
        return
    exits = frozenset(outcome_names(container))
    base = _Base(every)
    exact = len(container.rules) * len(base.perhaps) <= MOST_WORK
    ways = [(rule.outcome, _given(every, rule)) for rule in container.rules if rule.when]
    ways.append((container.default_outcome, _otherwise(every, container.rules)))
    for outcome, left in ways:
        if outcome in exits and left is not None:
            yield exit_place(outcome), base.writes(left if exact else {})


def _endings(child: Node, writes: Callable[[str, str], Writes | None]) -> Endings:
    is_open = isinstance(child, Leaf) and child.open
    found = ((name, writes(child.name, name)) for name in outcome_names(child) or (ANY,) * is_open)
    endings = {name: written for name, written in found if written is not None}
    return {ANY: next(iter(endings.values()), ANYTHING)} if is_open else endings


def _either(several: Iterable[Writes]) -> Writes:
    """What is written when one of several things happens."""
    ways = list(several)
    return Writes(
        frozenset.intersection(*(each.sure for each in ways)),
        frozenset.intersection(*(each.trusted for each in ways)),
        frozenset.union(*(each.perhaps for each in ways)),
        all(each.anything for each in ways),
    )


class _Base:
    """What the children write whichever outcome they have, and with fewer outcomes left."""

    def __init__(self, every: Mapping[str, Endings]) -> None:
        self._every = every
        self._of = {name: _either(endings.values()) for name, endings in every.items()}
        self._sure = NONE.union(*(each.sure for each in self._of.values()))
        self._trusted = NONE.union(*(each.trusted for each in self._of.values()))
        self.perhaps = Counter(key for each in self._of.values() for key in each.perhaps)
        self._anything = any(each.anything for each in self._of.values())

    def writes(self, left: Mapping[str, Endings]) -> Writes:
        """What is written when the children in `left` have one of those outcomes.

        Fewer outcomes write more for sure, and less perhaps.
        """
        fewer = {name: _either(endings.values()) for name, endings in left.items()}
        lost = Counter(
            key for name, writes in fewer.items() for key in self._of[name].perhaps - writes.perhaps
        )
        never = frozenset(key for key, times in lost.items() if times == self.perhaps[key])
        return Writes(
            self._sure.union(*(each.sure for each in fewer.values())),
            self._trusted.union(*(each.trusted for each in fewer.values())),
            frozenset(self.perhaps).difference(never),
            self._anything,
        )


def _given(every: Mapping[str, Endings], rule: OutcomeRule) -> dict[str, Endings] | None:
    """The outcomes left to children when a rule matches; None where it never does."""
    left: dict[str, Endings] = {}
    for condition in rule.when:
        known = left.get(condition.child) or every.get(condition.child, {})
        writes = known.get(condition.outcome) or known.get(ANY)
        if writes is None:
            return None
        left[condition.child] = {condition.outcome: writes}
    return left


def _otherwise(
    every: Mapping[str, Endings], rules: tuple[OutcomeRule, ...]
) -> dict[str, Endings] | None:
    """The outcomes left to children when no rule matches; None where one always does.

    A rule with one condition that is not certain, beside others that are, shows an outcome that
    the child did not have. Rules say more together than that; what is left out here is safe.
    """
    left: dict[str, Endings] = {}
    conditions = [{(each.child, each.outcome) for each in rule.when} for rule in rules if rule.when]
    for _ in range(MOST_ROUNDS):
        before = sum(map(len, left.values())), len(left)
        for pairs in conditions:
            unsure = [
                (child, outcome)
                for child, outcome in pairs
                if (left.get(child) or every.get(child, {})).keys() != {outcome}
            ]
            if not unsure:
                return None
            child, outcome = unsure[0]
            known = left.get(child) or every.get(child, {})
            if len(unsure) == 1 and outcome in known:
                left[child] = {name: each for name, each in known.items() if name != outcome}
        if before == (sum(map(len, left.values())), len(left)):
            break
    return left

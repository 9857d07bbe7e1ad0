"""Concurrences as their rules can be judged: what is asked of whom, and how branches may end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from smachac.checks.combinations import Combination, Rules, bits
from smachac.checks.hints import PREEMPTED, good_first, guesser
from smachac.checks.outline import fails, is_open
from smachac.ir.nodes import Concurrence, Node, OutcomeRule
from smachac.ir.walk import outcome_names

OTHER = ""
"""An outcome of an open leaf that is not known."""

Known = Mapping[int, tuple[str, ...]]
"""The possible outcomes of states by `id`."""

Space = dict[str, tuple[str, ...]]
"""The outcomes that each branch may end with, independent of the others; good ones first."""


@dataclass(frozen=True, slots=True)
class Study:
    """A concurrence whose rules have no fault of their own: misspelt names are put right."""

    node: Concurrence
    children: Mapping[str, Node]
    written: tuple[OutcomeRule, ...]
    rules: Rules

    def failures(self, child: str, ends: Sequence[str]) -> list[str]:
        """Those of the outcomes of a branch with which it has failed."""
        return [end for end in ends if fails(self.children[child], end)]

    def neutral(self, child: str, ends: Sequence[str]) -> tuple[str, ...]:
        """Those with which it has neither failed nor been preempted."""
        node = self.children[child]
        return tuple(end for end in ends if end != PREEMPTED and not fails(node, end))

    def larger(self, number: int) -> int:
        """The rules that win over one wherever both hold, as bits."""
        return self.rules.larger_than(len(self.rules.conditions[number]))

    def winners(self, combination: Combination) -> list[int]:
        """Of the rules that hold those with most conditions; ties are several."""
        holding = self.rules.all
        for child, outcome in combination.items():
            holding &= ~self.rules.struck_out(child, outcome)
        found = list(bits(holding))
        most = max((len(self.rules.conditions[number]) for number in found), default=0)
        return [number for number in found if len(self.rules.conditions[number]) == most]


def study(node: Concurrence) -> Study | None:
    """What the rules of a concurrence say; None where it has no states, two of one name, or a rule
    that says nothing which can be understood."""
    children = {child.name: child for child in node.children}
    if not children or len(children) < len(node.children):
        return None
    ends = {
        name: None if is_open(child) else frozenset(outcome_names(child))
        for name, child in children.items()
    }
    written = []
    for rule in node.rules:
        understood = rule if _is_sound(rule, ends) else _understood(rule, children)
        if understood is None:
            return None
        written.append(understood)
    conditions = ({one.child: one.outcome for one in rule.when} for rule in written)
    return Study(node, children, tuple(written), Rules(conditions))


def _is_sound(rule: OutcomeRule, ends: Mapping[str, frozenset[str] | None]) -> bool:
    """Whether a rule asks each of some children once, for an outcome that it may have."""
    for condition in rule.when:
        known = ends.get(condition.child, frozenset())
        if known is not None and condition.outcome not in known:
            return False
    return 0 < len({condition.child for condition in rule.when}) == len(rule.when)


def _understood(rule: OutcomeRule, children: Mapping[str, Node]) -> OutcomeRule | None:
    when = []
    for condition in rule.when:
        name = condition.child
        if name not in children:
            name = guesser(children)(name) or ""
        if not name:
            return None
        outcomes = outcome_names(children[name])
        outcome = condition.outcome
        if outcome not in outcomes and not is_open(children[name]):
            outcome = guesser(outcomes)(outcome) or ""
        if not outcome:
            return None
        when.append(replace(condition, child=name, outcome=outcome))
    understood = replace(rule, when=tuple(when))
    once = len({condition.child for condition in when}) == len(when)
    return understood if when and once else None


def space(read: Study, known: Known) -> Space:
    """How the branches may end. One that never does ends here with an outcome that is not known
    where the others do not wait for it: that it does not end is told elsewhere."""
    asked: dict[str, list[str]] = {}
    for rule in read.written:
        for condition in rule.when:
            asked.setdefault(condition.child, []).append(condition.outcome)
    found: Space = {}
    for child in read.node.children:
        names = known[id(child)]
        if is_open(child):
            names = tuple(dict.fromkeys([*good_first(names), *asked.get(child.name, ()), OTHER]))
        elif not names and read.node.join == "any":
            names = (OTHER,)
        found[child.name] = good_first(names)
    return found


def calm_spaces(read: Study, ever: Known, calm: Known) -> Iterator[tuple[Space, str]]:
    """How the branches may end while nobody asks the concurrence to stop, and for `join: any` the
    branch that ends first. The others are preempted; one that answers has no other outcome here,
    though it may have one in the moment in which two end at once."""
    whole = space(read, ever)
    own = space(read, calm)
    if read.node.join == "all":
        yield own, ""
        return
    others: Space = {
        name: (PREEMPTED,) if PREEMPTED in outcomes else outcomes
        for name, outcomes in whole.items()
    }
    for child in read.node.children:
        if calm[id(child)] or is_open(child):
            yield {**others, child.name: own[child.name]}, child.name


def without_other(whole: Space) -> Space:
    """Only outcomes that are known, where there are any."""
    return {
        name: tuple(outcome for outcome in outcomes if outcome != OTHER) or outcomes
        for name, outcomes in whole.items()
    }

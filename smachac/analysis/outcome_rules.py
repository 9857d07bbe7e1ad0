"""Outcome rules of a concurrence: which combinations of outcomes match, without enumeration.

Rules are conjunctions of `child: outcome`; each is one bit of a number, so that a choice for one
child excludes in one step all rules that require another. Every query is of one kind: find a
combination, with some outcomes given, in which none of certain rules holds. A child with an outcome
that no rule requires excludes all rules about it; the search branches only where each outcome of a
child is required by some rule.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial

from smachac.analysis.control_flow import has_no_interface
from smachac.ir.nodes import Concurrence, Node, OutcomeRule
from smachac.ir.outcome_names import PREEMPTED, fails, good_first
from smachac.ir.traversal import outcome_names
from smachac.records import dataclass

Combination = dict[str, str]
"""Children with the outcome each has ended with."""

Domains = Mapping[str, Sequence[str]]
"""The outcomes that each child can end with, those to show first in front."""

MOST_LOOKED_AT = 300_000
"""The most children that one rule of the checker looks at for one concurrence. Forty
branches with forty rules take some thousands."""


class UndecidedError(Exception):
    """The search needs more than MOST_LOOKED_AT."""


class Rules:
    """The rules of one concurrence by number, and what is struck out by which outcome."""

    def __init__(self, conditions: Iterable[Mapping[str, str]]) -> None:
        self.conditions = [dict(one) for one in conditions]
        self.all = (1 << len(self.conditions)) - 1
        self._about: dict[str, int] = {}
        self._asking: dict[tuple[str, str], int] = {}
        self.looked_at = 0
        for number, rule in enumerate(self.conditions):
            for child, outcome in rule.items():
                bit = 1 << number
                self._about[child] = self._about.get(child, 0) | bit
                self._asking[child, outcome] = self._asking.get((child, outcome), 0) | bit

    def larger_than(self, size: int) -> int:
        """The rules with more conditions, as bits."""
        sizes = enumerate(map(len, self.conditions))
        return sum(1 << number for number, own in sizes if own > size)

    def struck_out(self, child: str, outcome: str) -> int:
        """The rules that do not hold when a child ends so, as bits."""
        return self._about.get(child, 0) & ~self._asking.get((child, outcome), 0)

    def compatible(self, number: int) -> int:
        """The rules that can hold together with one, as bits."""
        found = self.all
        for child, outcome in self.conditions[number].items():
            found &= ~self.struck_out(child, outcome)
        return found

    def find(self, domains: Domains, given: Mapping[str, str], avoided: int) -> Combination | None:
        """A combination with the given outcomes in which no avoided rule holds, if there is one.

        Raises:
            UndecidedError: after MOST_LOOKED_AT, counted over all calls.
        """
        if any(outcome not in domains[child] for child, outcome in given.items()):
            return None
        if not all(domains.values()):
            return None
        for child, outcome in given.items():
            avoided &= ~self.struck_out(child, outcome)
        todo = [(avoided, dict(given))]
        while todo:
            self._look_at(1)
            left, chosen = todo.pop()
            left = self._settle(domains, left, chosen)
            if not left:
                return {child: chosen.get(child, domains[child][0]) for child in domains}
            name = self._next(left, chosen)
            if name is not None:
                todo += (
                    (left & ~self.struck_out(name, outcome), {**chosen, name: outcome})
                    for outcome in reversed(domains[name])
                )
        return None

    def _settle(self, domains: Domains, left: int, chosen: Combination) -> int:
        """Choose outcomes that no remaining rule requires; return the rules that then remain."""
        before = 0
        while left and left != before:
            before = left
            self._look_at(len(self._about))
            for child, about in self._about.items():
                if about & left and child not in chosen:
                    for outcome in domains[child]:
                        if not self._asking.get((child, outcome), 0) & left:
                            chosen[child] = outcome
                            left &= ~about
                            break
        return left

    def _next(self, left: int, chosen: Mapping[str, str]) -> str | None:
        """A child to try, of the rule with fewest conditions open; None when a rule holds."""
        best: list[str] | None = None
        for number in bits(left):
            self._look_at(1)
            open_ = [child for child in self.conditions[number] if child not in chosen]
            if not open_:
                return None
            if best is None or len(open_) < len(best):
                best = open_
        return best[0] if best else None

    def _look_at(self, children: int) -> None:
        self.looked_at += children
        if self.looked_at > MOST_LOOKED_AT:
            raise UndecidedError

    def shown(
        self, combination: Mapping[str, str], given: Mapping[str, str], avoided: int
    ) -> Combination:
        """The part of a combination that decides: what is given, and as little more as excludes
        the avoided rules, whatever the other children do. None of it can be left out."""
        for child, outcome in given.items():
            avoided &= ~self.struck_out(child, outcome)
        effects = {
            child: self.struck_out(child, outcome) & avoided
            for child, outcome in combination.items()
            if child not in given
        }
        needed: list[str] = []
        left = avoided
        for child in sorted(effects, key=lambda child: -effects[child].bit_count()):
            if effects[child] & left:
                needed.append(child)
                left &= ~effects[child]
        self._look_at(len(combination))
        after = [0]
        for child in reversed(needed):
            after.append(after[-1] | effects[child])
        kept, before = {*given}, 0
        for child in needed:
            after.pop()
            if before | after[-1] != avoided:
                kept.add(child)
                before |= effects[child]
        return {child: outcome for child, outcome in combination.items() if child in kept}


def bits(number: int) -> Iterator[int]:
    """The places of the ones in a number, lowest first."""
    while number:
        low = number & -number
        yield low.bit_length() - 1
        number ^= low


OTHER = ""
"""An outcome of an open leaf that is not known."""

OutcomesByPath = Mapping[str, tuple[str, ...]]
"""The possible outcomes of states by path."""

Space = dict[str, tuple[str, ...]]
"""The outcomes that each branch may end with, independent of the others; good ones first."""


@dataclass(frozen=True, slots=True)
class SoundConcurrence:
    """A concurrence, at its path, whose rules have no fault of their own."""

    path: str
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


def rules_of(node: Concurrence) -> Rules:
    """The rules of a concurrence, by number."""
    return Rules({condition.child: condition.outcome for condition in rule.when}
                 for rule in node.rules)  # fmt: skip


def without_end(node: Concurrence, rules: Rules) -> Combination | None:
    """A combination of outcomes after which no rule of a concurrence with `join: rule` holds, where
    it has no default outcome and its branches have interfaces."""
    domains = {child.name: outcome_names(child) for child in node.children}
    known = all(part.child in domains for one in node.rules for part in one.when)
    if node.default_outcome or not known or any(map(has_no_interface, node.children)):
        return None
    try:
        return rules.find(domains, {}, rules.all)
    except UndecidedError:
        return None


def sound_concurrence(path: str, node: Concurrence) -> SoundConcurrence | None:
    """The rules of a concurrence; None if it has no states, two states of one name, or a rule with
    an unknown name, or if it ends with the first rule that holds: any of them can be it."""
    children = {child.name: child for child in node.children}
    if not children or len(children) < len(node.children) or node.join == "rule":
        return None
    ends = {
        name: None if has_no_interface(child) else frozenset(outcome_names(child))
        for name, child in children.items()
    }
    if not all(_is_sound(rule, ends) for rule in node.rules):
        return None
    return SoundConcurrence(path, node, children, node.rules, rules_of(node))


def _is_sound(rule: OutcomeRule, ends: Mapping[str, frozenset[str] | None]) -> bool:
    """Whether the conditions of a rule have different children and possible outcomes of these."""
    for condition in rule.when:
        known = ends.get(condition.child, frozenset())
        if known is not None and condition.outcome not in known:
            return False
    return 0 < len({condition.child for condition in rule.when}) == len(rule.when)


def space(concurrence: SoundConcurrence, known: OutcomesByPath) -> Space:
    """The possible outcomes of each branch. Under `join: any` a branch that never ends has an
    unknown outcome here; SM407 reports that it never ends."""
    asked: dict[str, list[str]] = {}
    for rule in concurrence.written:
        for condition in rule.when:
            asked.setdefault(condition.child, []).append(condition.outcome)
    found: Space = {}
    for child in concurrence.node.children:
        names = known[f"{concurrence.path}/{child.name}"]
        if has_no_interface(child):
            names = tuple(
                dict.fromkeys(
                    [*good_first(names, partial(fails, child)), *asked.get(child.name, ()), OTHER]
                )
            )
        elif not names and concurrence.node.join == "any":
            names = (OTHER,)
        found[child.name] = good_first(names, partial(fails, child))
    return found


def unstopped_spaces(
    concurrence: SoundConcurrence, ever: OutcomesByPath, unstopped: OutcomesByPath
) -> Iterator[tuple[Space, str]]:
    """The possible outcomes of the branches without a request to stop from outside, and for
    `join: any` the branch that ends first. The other branches are preempted: one with the outcome
    `preempted` has no other outcome here, although two branches can end at the same moment."""
    whole = space(concurrence, ever)
    own = space(concurrence, unstopped)
    if concurrence.node.join == "all":
        yield own, ""
        return
    others: Space = {
        name: (PREEMPTED,) if PREEMPTED in outcomes else outcomes
        for name, outcomes in whole.items()
    }
    for child in concurrence.node.children:
        if unstopped[f"{concurrence.path}/{child.name}"] or has_no_interface(child):
            yield {**others, child.name: own[child.name]}, child.name


def without_other(whole: Space) -> Space:
    """Only outcomes that are known, where there are any."""
    return {
        name: tuple(outcome for outcome in outcomes if outcome != OTHER) or outcomes
        for name, outcomes in whole.items()
    }


def has_dead_rule(container: Concurrence) -> bool:
    """Whether a rule of a concurrence has a state or an outcome that does not exist (SM403)."""
    children = {child.name: child for child in container.children}
    return any(
        condition.child
        and (
            (child := children.get(condition.child)) is None
            or not (has_no_interface(child) or condition.outcome in outcome_names(child))
        )
        for rule in container.rules
        for condition in rule.when
    )

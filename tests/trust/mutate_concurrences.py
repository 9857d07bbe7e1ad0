"""Mutations of concurrences: SM4xx."""

from __future__ import annotations

import itertools

from smachac.ir.nodes import Concurrence, Leaf
from smachac.ir.traversal import outcome_names
from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.mutate_names import renamed, swap_letters
from tests.trust.project_text import Site


def concurrences(subject: Subject) -> list[tuple[Site, Concurrence]]:
    found = []
    for site in subject.sites():
        node = subject.node(site)
        if isinstance(node, Concurrence) and site.template == "Concurrence":
            found.append((site, node))
    return found


def rules(subject: Subject) -> list[tuple[Site, str, str]]:
    """The conditions of rules: concurrence, outcome, child."""
    return [
        (site, outcome, child)
        for site, _ in concurrences(subject)
        for outcome, when in site.pairs("outcome_map").items()
        if isinstance(when, dict)
        for child in when
    ]


@mutation
def empty_a_concurrence(subject: Subject) -> Mutant | None:
    found = concurrences(subject)
    if not found:
        return None
    site, _ = subject.draw.choice(found)
    site.body["states"] = []
    return Mutant(codes=("SM408",), owners=(site,))


@mutation
def rename_a_child_in_a_rule(subject: Subject) -> Mutant | None:
    found = rules(subject)
    if not found:
        return None
    site, outcome, child = subject.draw.choice(found)
    new = swap_letters(child)
    renamed(site.body["outcome_map"][outcome], child, new)
    place = (*site.path, "outcome_map", outcome, new)
    return Mutant(codes=("SM403",), places=((site.file, place),))


@mutation
def rename_an_outcome_in_a_rule(subject: Subject) -> Mutant | None:
    found = rules(subject)
    if not found:
        return None
    site, outcome, child = subject.draw.choice(found)
    when = site.body["outcome_map"][outcome]
    when[child] = swap_letters(when[child])
    place = (*site.path, "outcome_map", outcome, child)
    return Mutant(codes=("SM403",), places=((site.file, place),))


@mutation
def overlap_two_rules(subject: Subject) -> Mutant | None:
    """Each of two rules speaks of another child, and none of both."""
    found = [
        (site, node)
        for site, node in concurrences(subject)
        if len(node.children) > 1 and len(node.outcomes) > 1 and node.join == "all"
    ]
    if not found:
        return None
    site, node = subject.draw.choice(found)
    first, second = (outcome.name for outcome in node.outcomes[:2])
    left, right = node.children[:2]
    site.body["outcome_map"] = {
        first: {left.name: outcome_names(left)[0]},
        second: {right.name: outcome_names(right)[0]},
    }
    places = [(site.file, (*site.path, "outcome_map", outcome)) for outcome in (first, second)]
    return Mutant(codes=("SM402",), places=tuple(places))


@mutation
def drop_the_default_outcome(subject: Subject) -> Mutant | None:
    """A fault where some combination of outcomes has no rule."""
    found = [
        (site, node)
        for site, node in concurrences(subject)
        if "default_outcome" in site.body and not covered(node)
    ]
    if not found:
        return None
    site, _ = subject.draw.choice(found)
    del site.body["default_outcome"]
    return Mutant(codes=("SM401",), owners=(site,))


def covered(node: Concurrence) -> bool:
    """Whether the rules speak of every combination of outcomes."""
    ends = [[(child.name, name) for name in outcome_names(child)] for child in node.children]
    return all(
        any(all((item.child, item.outcome) in ended for item in rule.when) for rule in node.rules)
        for ended in itertools.product(*ends)
    )


@mutation
def make_success_the_default(subject: Subject) -> Mutant | None:
    """A child that failed is passed over."""
    found = [
        (site, good)
        for site, node in concurrences(subject)
        for good in ("succeeded", "ready", "done", "both")
        if good in site.pairs("outcome_map") and site.body.get("default_outcome") != good
        if any("aborted" in outcome_names(child) for child in node.children)
        if set(site.pairs("outcome_map")[good].values()) <= {"succeeded", "done"}
        if len(site.pairs("outcome_map")) == 1
    ]
    if not found:
        return None
    site, good = subject.draw.choice(found)
    site.body["default_outcome"] = good
    return Mutant(codes=("SM404",), owners=(site,))


def branches(subject: Subject) -> list[tuple[Site, list[tuple[Site, Leaf]]]]:
    """Concurrences with at least two branches that are leaves."""
    found = []
    for site, _ in concurrences(subject):
        pairs = [(child, subject.node(child)) for child in site.states()]
        leaves = [(child, node) for child, node in pairs if isinstance(node, Leaf)]
        if len(leaves) > 1:
            found.append((site, leaves))
    return found


@mutation
def add_a_racing_writer(subject: Subject) -> Mutant | None:
    """A branch writes, under its own name for it, what another branch reads or writes."""
    found = [
        (child, other, remaps.get(key.name, key.name))
        for _, leaves in branches(subject)
        for (child, node), (other, _) in itertools.permutations(leaves, 2)
        if other.template == "ScriptedState"
        for remaps in [child.pairs("remapping")]
        for key in (*node.inputs, *node.outputs)
    ]
    if not found:
        return None
    child, other, key = subject.draw.choice(found)
    held = other.body.setdefault("output_keys", [])
    if isinstance(held, dict):
        held["stolen"] = "any"
    else:
        held.append("stolen")
    other.body.setdefault("remapping", {})["stolen"] = key
    return Mutant(codes=("SM405",), owners=(child, other))


@mutation
def add_a_second_claim(subject: Subject) -> Mutant | None:
    found = [
        (child, other, claim)
        for _, leaves in branches(subject)
        for (child, node), (other, _) in itertools.permutations(leaves, 2)
        for claim in node.claims
        if "{" not in claim
    ]
    if not found:
        return None
    child, other, claim = subject.draw.choice(found)
    other.body["claims"] = [*other.body.get("claims", ()), claim]
    return Mutant(codes=("SM406",), owners=(child, other))

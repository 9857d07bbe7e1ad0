"""Mutations of the control flow: SM2xx."""

from __future__ import annotations

from smachac.ir.nodes import Leaf
from smachac.ir.traversal import outcome_names
from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.mutate_names import MACHINES, transitions
from tests.trust.project_text import Site


def leaves(subject: Subject) -> list[tuple[Site, Leaf]]:
    """The leaves in machines whose every outcome has a transition in the script."""
    found = []
    for site in subject.sites():
        node = subject.node(site)
        if not isinstance(node, Leaf) or site.around is None:
            continue
        whole = set(site.pairs("transitions")) == set(outcome_names(node))
        if whole and site.around.target in MACHINES:
            found.append((site, node))
    return found


@mutation
def make_a_state_unreachable(subject: Subject) -> Mutant | None:
    """Whatever led to it leads to where it leads."""
    found = [
        site
        for site in subject.sites()
        if site.around is not None and site.around.target == "StateMachine"
        if site.pairs("transitions") and site.name != site.around.states()[0].name
        if site.around.body.get("initial") != site.name
        if any(to != site.name for to in site.pairs("transitions").values())
    ]
    site = subject.pick(found)
    if site is None:
        return None
    onward = next(to for to in site.pairs("transitions").values() if to != site.name)
    for other in site.siblings():
        if other.name != site.name:
            steps = other.pairs("transitions")
            steps.update({outcome: onward for outcome, to in steps.items() if to == site.name})
    return Mutant(codes=("SM201",), places=((site.file, site.path),))


@mutation
def make_a_trap(subject: Subject) -> Mutant | None:
    """All ways out of a state lead back to it."""
    found = [
        (site, node)
        for site, node in leaves(subject)
        if site.around is not None and not site.around.body.get("forever")
    ]
    if not found:
        return None
    site, _ = subject.draw.choice(found)
    site.body["transitions"] = dict.fromkeys(site.body["transitions"], site.name)
    return Mutant(codes=("SM202",), places=((site.file, site.path),))


@mutation
def declare_an_outcome_that_never_comes(subject: Subject) -> Mutant | None:
    site = subject.pick(
        site
        for site in subject.sites()
        if site.target in (*MACHINES, "Concurrence") and isinstance(site.body.get("outcomes"), list)
        if subject.node(site) is not None
    )
    if site is None:
        return None
    site.body["outcomes"].append("lost_for_ever")
    if site.around is not None and site.around.target in MACHINES:
        first = next(iter(site.pairs("transitions").values()), None)
        if first is None:
            return None
        site.body["transitions"]["lost_for_ever"] = first
    place = (*site.path, "outcomes", len(site.body["outcomes"]) - 1)
    return Mutant(codes=("SM203",), places=((site.file, place),))


@mutation
def retry_without_a_bound(subject: Subject) -> Mutant | None:
    found = [
        site
        for site, node in leaves(subject)
        if set(outcome_names(node)) == {"succeeded", "aborted"}
        if site.pairs("transitions").get("succeeded") != site.name
        if "retry" not in site.body and "timeout" not in site.body
    ]
    site = subject.pick(found)
    if site is None:
        return None
    site.body["transitions"]["aborted"] = site.name
    places = [(site.file, site.path), (site.file, (*site.path, "transitions", "aborted"))]
    return Mutant(codes=("SM204",), places=tuple(places))


@mutation
def end_a_failure_in_success(subject: Subject) -> Mutant | None:
    """On the outermost level, where nothing comes after."""
    found = [
        (site, outcome)
        for site, outcome in transitions(subject)
        if outcome in ("aborted", "timeout", "failed", "exhausted")
        if site.around is not None and site.around.path == () and site.file == "main.yml"
        if "succeeded" in site.around.keys("outcomes") and "states" not in site.body
        if isinstance(subject.node(site), Leaf)
    ]
    if not found:
        return None
    site, outcome = subject.draw.choice(found)
    if site.body["transitions"][outcome] == "succeeded":
        return None
    site.body["transitions"][outcome] = "succeeded"
    place = (*site.path, "transitions", outcome)
    return Mutant(codes=("SM206",), places=((site.file, place), (site.file, site.path)))


@mutation
def forget_how_an_iterator_stops(subject: Subject) -> Mutant | None:
    site = subject.pick(site for site in subject.sites() if "final_outcome_map" in site.body)
    if site is None:
        return None
    del site.body["final_outcome_map"]
    return Mutant(codes=("SM208",), owners=(site,))

"""Mutations that violate a property of the script: SM701, and wrong properties: SM702, SM703.

Each gives the outermost machine a property that holds, and then changes a transition so that it no
longer does; the finding must be at the property.
"""

from __future__ import annotations

from collections.abc import Iterator

from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names
from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.project_text import MAIN, Data, Site, judged


def outer(subject: Subject) -> list[Site]:
    """The states of the outermost machine that are written in the main script."""
    return [
        site
        for site in subject.sites()
        if site.file == MAIN and site.around is not None and site.around.path == ()
        if site.pairs("transitions") and f"{site.name}".isidentifier()
    ]


def steps(subject: Subject) -> Iterator[tuple[Site, str, Site]]:
    """The transitions between these states, other than those after a stop."""
    sites = {site.name: site for site in outer(subject)}
    for site in sites.values():
        for outcome, target in site.pairs("transitions").items():
            if target in sites and outcome != PREEMPTED:
                yield site, outcome, sites[target]


def planted(subject: Subject, form: Data) -> tuple[int, bool]:
    """Add a property to the script; its number, and whether no property has a finding then."""
    body = subject.project[MAIN]
    listed = body.setdefault("properties", [])
    if not isinstance(listed, list):
        return 0, False
    listed.append(form)
    report = judged(subject.project).report
    return len(listed) - 1, not any(item.code.startswith("SM7") for item in report)


def at_property(number: int, form: Data, *codes: str) -> Mutant:
    """The mutant with a finding at the property with a number, on any of its lines."""
    whole = ("properties", number)
    inner: list[tuple[str | int, ...]] = [(*whole, key) for key in form]
    inner += [(*whole, key, part) for key, value in form.items() for part in _parts(value)]
    return Mutant(codes=codes, places=tuple((MAIN, place) for place in (whole, *inner)))


def _parts(value: Data) -> list[str]:
    return [*value] if isinstance(value, dict) else []


def full(subject: Subject, name: str) -> str:
    return f"{subject.machine.root.name}/{name}"


def violated(subject: Subject, form: Data, site: Site, outcome: str, target: str) -> Mutant | None:
    """A mutant in which a transition leads elsewhere; None if the property was violated before."""
    number, holds = planted(subject, form)
    if not holds:
        return None
    site.body["transitions"][outcome] = target
    return at_property(number, form, "SM701")


@mutation
def skip_what_a_property_requires_before(subject: Subject) -> Mutant | None:
    found = [
        (site, outcome, middle, last)
        for site, outcome, middle in steps(subject)
        for start, _, last in steps(subject)
        if start.name == middle.name and last.name not in (middle.name, site.name)
    ]
    if not found:
        return None
    site, outcome, middle, last = subject.draw.choice(found)
    form = {"before": {full(subject, last.name): full(subject, middle.name)}}
    return violated(subject, form, site, outcome, last.name)


@mutation
def leave_out_what_a_property_requires_after(subject: Subject) -> Mutant | None:
    found = [*steps(subject)]
    exits = subject.project[MAIN].get("outcomes", [])
    if not found or not exits:
        return None
    site, outcome, target = subject.draw.choice(found)
    form = {"after": {f"{full(subject, site.name)}:{outcome}": full(subject, target.name)}}
    return violated(subject, form, site, outcome, subject.draw.choice(exits))


@mutation
def enter_what_a_property_forbids(subject: Subject) -> Mutant | None:
    sites = outer(subject)
    found = [
        (site, outcome, other)
        for site in sites
        for outcome in site.pairs("transitions")
        for other in sites
        if outcome != PREEMPTED and other.name != site.name
    ]
    if not found:
        return None
    site, outcome, other = subject.draw.choice(found)
    event = f"{full(subject, site.name)}:{outcome}"
    form = {"never": {"after": event, "enter": full(subject, other.name)}}
    return violated(subject, form, site, outcome, other.name)


@mutation
def repeat_more_often_than_a_property_allows(subject: Subject) -> Mutant | None:
    found = [(site, outcome) for site, outcome, _ in steps(subject)]
    if not found:
        return None
    site, outcome = subject.draw.choice(found)
    form = {"at_most": {full(subject, site.name): 1}}
    return violated(subject, form, site, outcome, site.name)


@mutation
def loop_for_ever_against_a_property(subject: Subject) -> Mutant | None:
    found = [(site, outcome, target) for site, outcome, target in steps(subject)]
    if not found:
        return None
    first, _, last = subject.draw.choice(found)
    outcome = subject.draw.choice([*last.pairs("transitions")])
    if outcome == PREEMPTED:
        return None
    return violated(subject, {"always_ends": True}, last, outcome, first.name)


@mutation
def name_an_unknown_state_in_a_property(subject: Subject) -> Mutant | None:
    site = subject.pick(outer(subject))
    if site is None:
        return None
    form = {"at_most": {full(subject, f"{site.name}x"): 1}}
    number, _ = planted(subject, form)
    return at_property(number, form, "SM703")


@mutation
def ask_for_what_never_happens(subject: Subject) -> Mutant | None:
    """A property about the answer to a stop, without stops."""
    site = subject.pick(
        site
        for site in outer(subject)
        if isinstance(node := subject.node(site), Leaf) and PREEMPTED in outcome_names(node)
        if not {"timeout", "retry", "for_each"} & site.body.keys()
    )
    if site is None:
        return None
    event = f"{full(subject, site.name)}:{PREEMPTED}"
    form = {"after": {event: full(subject, site.name)}, "stops": False}
    number, _ = planted(subject, form)
    return at_property(number, form, "SM702")

"""Mutations of failures: SM206, SM404."""

from __future__ import annotations

from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import successes
from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.project_text import Site


@mutation
def continue_a_loop_after_a_failure(subject: Subject) -> Mutant | None:
    """The state is repeated for items, and the loop ends with a success, whatever they did."""
    site = subject.pick(
        site
        for site in subject.sites()
        if {"succeeded", "aborted"} <= {*site.keys("outcomes")} and site.template == "ScriptedState"
        if {"succeeded", "aborted"} <= {*site.pairs("transitions")}
        if site.pairs("transitions")["succeeded"] != "aborted"
        if not {"retry", "timeout", "for_each"} & {*site.body}
    )
    if site is None:
        return None
    site.body["for_each"] = {"item": "number", "in": [1, 2], "on": ["succeeded", "aborted"]}
    site.body["transitions"]["preempted"] = site.body["transitions"].pop("aborted")
    return Mutant(codes=("SM404",), owners=(site,))


@mutation
def continue_an_iterator_after_a_failure(subject: Subject) -> Mutant | None:
    found = []
    for site in subject.sites():
        inside = site.states() if site.template == "Iterator" else []
        leads = site.pairs("transitions").get("all")
        if inside and "aborted" in inside[0].keys("outcomes") and leads not in (None, "aborted"):
            found.append(site)
    if not found:
        return None
    site = subject.draw.choice(found)
    site.body["loop_outcomes"] = [*site.keys("loop_outcomes"), "aborted"]
    site.body["exhausted_outcome"] = "done"
    for names in (site.body["outcomes"], site.body["transitions"]):
        if isinstance(names, list):
            names[names.index("all")] = "done"
        else:
            names["done"] = names.pop("all")
    return Mutant(codes=("SM404",), owners=(site,))


def leading_to_a_success(subject: Subject) -> list[tuple[Site, str]]:
    """The outcomes of leaves of the machine that end it with a success, and have no other meaning
    by their names."""
    good = successes(subject.machine.root)
    return [
        (site, outcome)
        for site in subject.sites()
        if site.around is not None and not site.around.path and site.file == "main.yml"
        if isinstance(subject.node(site), Leaf) and isinstance(site.body.get("outcomes"), list)
        for outcome, target in site.pairs("transitions").items()
        if target in good and outcome in site.keys("outcomes")
    ]


@mutation
def declare_a_failure_that_ends_as_a_success(subject: Subject) -> Mutant | None:
    found = leading_to_a_success(subject)
    if not found:
        return None
    site, outcome = subject.draw.choice(found)
    names = site.keys("outcomes")
    site.body["outcomes"] = {
        name: {"failure": True} if name == outcome else {"doc": "another"} for name in names
    }
    return Mutant(codes=("SM206",), places=((site.file, (*site.path, "transitions", outcome)),))


def can_fail(child: Site) -> bool:
    """Whether a leaf can end with `aborted` by itself."""
    if child.template == "ConditionalOutcomeState":
        return child.body.get("default_outcome") == "aborted"
    return child.template == "ScriptedState" and "aborted" in child.keys("outcomes")


@mutation
def hide_the_failure_of_a_branch(subject: Subject) -> Mutant | None:
    """The rule for the success no longer lists a branch that can fail."""
    found = []
    for site in subject.sites():
        rules = site.pairs("outcome_map")
        inside = site.states() if site.template == "Concurrence" else []
        for good in ("succeeded", "done", "ready", "both"):
            listed = rules.get(good)
            if isinstance(listed, dict) and len(listed) > 1 and site.body.get("join") != "any":
                found += [
                    (site, good, child)
                    for child in inside
                    if child.name in listed and can_fail(child)
                    if len(rules) == 1 and site.body.get("default_outcome") != good
                ]
    if not found:
        return None
    site, good, child = subject.draw.choice(found)
    del site.body["outcome_map"][good][child.name]
    return Mutant(codes=("SM404",), owners=(site,))

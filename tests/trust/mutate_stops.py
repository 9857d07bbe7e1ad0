"""Mutations of what happens after a stop, and of limits: SM207, SM209 to SM213, SM319, SM403,
SM407."""

from __future__ import annotations

from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names
from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.mutate_concurrences import concurrences
from tests.trust.mutate_names import MACHINES, renamed, transitions
from tests.trust.project_text import Data, Quoted, Site


def answering(subject: Subject) -> list[Site]:
    """The leaves in machines that lead `preempted` somewhere."""
    return [
        site
        for site in subject.sites()
        if site.around is not None and site.around.target in MACHINES
        if isinstance(subject.node(site), Leaf) and PREEMPTED in site.pairs("transitions")
    ]


def led(site: Site, target: str, *codes: str) -> Mutant:
    site.body["transitions"][PREEMPTED] = target
    place = (*site.path, "transitions", PREEMPTED)
    return Mutant(codes=codes, places=((site.file, place),))


def leads_back(site: Site) -> bool:
    """Whether a transition leads to a state that stands before this one."""
    names = [sibling.name for sibling in site.siblings()]
    earlier = names[: names.index(site.name)] if site.name in names else []
    return any(target in earlier for target in site.pairs("transitions").values())


@mutation
def start_again_after_a_stop(subject: Subject) -> Mutant | None:
    site = subject.pick(
        site for site in answering(subject) if site.pairs("transitions")[PREEMPTED] != site.name
    )
    return None if site is None else led(site, site.name, "SM209", "SM407", "SM202")


@mutation
def call_a_stop_a_success(subject: Subject) -> Mutant | None:
    found = [
        (site, target)
        for site in answering(subject)
        for outcome, target in site.pairs("transitions").items()
        if outcome != PREEMPTED and target == "succeeded"
        if site.around is not None and "aborted" in site.around.keys("outcomes")
    ]
    if not found:
        return None
    site, target = subject.draw.choice(found)
    return led(site, target, "SM210")


@mutation
def make_a_race_need_both(subject: Subject) -> Mutant | None:
    """The first branch to end preempts the other, but the rule needs both. Not with the arm, whose
    branches can end with success after a request: their last states cannot be stopped."""
    if subject.machine.base == "PyBulletBase":
        return None
    found = [
        (site, [child for child in node.children if PREEMPTED in outcome_names(child)])
        for site, node in concurrences(subject)
        if len(node.outcomes) > 1
    ]
    found = [(site, leaves) for site, leaves in found if len(leaves) > 1]
    if not found:
        return None
    site, leaves = subject.draw.choice(found)
    site.body["join"] = "any"
    outcome = next(iter(site.keys("outcomes")))
    site.body["outcome_map"] = {
        outcome: {leave.name: outcome_names(leave)[0] for leave in leaves[:2]}
    }
    return Mutant(codes=("SM403",), places=((site.file, (*site.path, "outcome_map", outcome)),))


@mutation
def move_on_after_a_stop(subject: Subject) -> Mutant | None:
    """A stop leads where a success leads: to a state that holds a resource."""
    found = [
        (site, other.name)
        for site in answering(subject)
        for other in site.siblings()
        if getattr(subject.node(other), "claims", ())
        if other.name != site.name and site.pairs("transitions").get("succeeded") == other.name
        if other.name
        not in [to for out, to in site.pairs("transitions").items() if out != "succeeded"]
    ]
    if not found:
        return None
    site, target = subject.draw.choice(found)
    return led(site, target, "SM211", "SM209")


@mutation
def shorten_a_time_limit(subject: Subject) -> Mutant | None:
    site = subject.pick(
        site
        for site in answering(subject)
        if site.template == "SleepState" and isinstance(site.body.get("time"), int | float)
        if not {"timeout", "retry", "for_each"} & set(site.body)
    )
    if site is None:
        return None
    site.body["timeout"] = f"{site.body['time'] / 2}s"
    site.body["transitions"]["timeout"] = site.body["transitions"][PREEMPTED]
    return Mutant(codes=("SM212",), places=((site.file, (*site.path, "timeout")),))


@mutation
def forget_to_count(subject: Subject) -> Mutant | None:
    """A loop counts under another name than its condition reads."""
    found = [
        (site, other, key)
        for site in subject.sites()
        if site.template == "ConditionalOutcomeState" and leads_back(site)
        for other in site.siblings()
        if other.template == "CallbacksState" and "remapping" not in other.body
        if isinstance(other.body.get("output_keys"), list)
        for key in other.pairs("callbacks")
        if key in site.keys("input_keys") and key in other.body["output_keys"]
    ]
    if not found:
        return None
    site, other, key = subject.draw.choice(found)
    renamed(other.body["callbacks"], key, f"{key}_too")
    other.body["output_keys"].append(f"{key}_too")
    other.body["output_keys"].remove(key)
    return Mutant(codes=("SM213",), owners=(site, other))


def counting(name: str, target: str) -> tuple[dict[str, Data], dict[str, Data]]:
    """A machine that tries something three times, and the state that lets it begin again. The
    names of its states are made of `name`."""
    act, count, again, wait = (f"{name}_{word}" for word in ("ACT", "COUNT", "AGAIN", "WAIT"))
    tries = {"input_keys": ["tries"]}
    inside: list[dict[str, Data]] = [
        {
            act: {
                "template": "ScriptedState",
                "outcomes": ["held", "slipped"],
                "transitions": {"held": "held", "slipped": count},
            }
        },
        {
            count: {
                "template": "CallbacksState",
                **tries,
                "output_keys": ["tries"],
                "callbacks": {"tries": Quoted("lambda ud: ud.tries + 1")},
                "transitions": {"succeeded": again},
            }
        },
        {
            again: {
                "template": "ConditionalOutcomeState",
                **tries,
                "outcomes": ["more"],
                "callbacks": {"more": Quoted("lambda ud: ud.tries < 3")},
                "default_outcome": "enough",
                "transitions": {"more": act, "enough": "gone"},
            }
        },
    ]
    machine = {
        "template": "StateMachine",
        "outcomes": ["held", "gone"],
        "userdata": {"tries": 0},
        "states": inside,
        "transitions": {"held": target, "gone": wait},
    }
    pause = {
        "template": "ScriptedState",
        "outcomes": ["rested"],
        "transitions": {"rested": name},
    }
    return {name: machine}, {wait: pause}


@mutation
def leave_a_counter_at_its_limit(subject: Subject) -> Mutant | None:
    """On the way to a state there are three tries of something, and then three more."""
    found = [
        (site, outcome)
        for site, outcome in transitions(subject, "StateMachine")
        if site.pairs("transitions")[outcome] in [sibling.name for sibling in site.siblings()]
        if outcome != PREEMPTED
    ]
    if not found:
        return None
    site, outcome = subject.draw.choice(found)
    assert site.around is not None
    steps = site.body["transitions"]
    states = site.around.body["states"]
    steps[outcome], target = "TRY_IT", steps[outcome]
    states += counting("TRY_IT", target)
    place = (*site.around.path, "states", len(states) - 2, "TRY_IT", "userdata", "tries")
    return Mutant(codes=("SM319",), places=((site.file, place),))

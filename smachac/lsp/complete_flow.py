"""Completion of outcomes, and of the states and outcomes to which they lead."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from smachac.ir.outcome_names import GOOD, GOOD_OUTCOMES, PREEMPTED, SUCCESSES, is_failure
from smachac.lsp.place import ITEM, KEY, VALUE, Body
from smachac.lsp.word import Completion, Request


def transitions(here: Request) -> Iterable[Completion]:
    place = here.place
    if place.role == VALUE and place.inner and here.around is not None:
        return targets(here, place.inner[0], here.around)
    if place.role in (KEY, VALUE):
        given = [*here.facts.outcomes(here.body)]
        left = [text for text in given if text not in place.siblings]
        return [Completion(word=text, kind="outcome", doc=outcome_doc(here, text))
                for text in (success_first(left))]  # fmt: skip
    return []


def outcome_doc(here: Request, name: str) -> str:
    type_ = here.facts.type_named(here.body.template)
    found = [outcome.doc for outcome in type_.outcomes if outcome.name == name] if type_ else []
    return found[0] if found else ""


def targets(here: Request, outcome: str, around: Body) -> Iterable[Completion]:
    """The states and outcomes to which an outcome may lead, likely ones first."""
    states = around.states
    mine = next((at for at, state in enumerate(states) if state.start == here.body.start), -1)
    names = [str(state.name.value) for state in states if state.name is not None]
    ends = here.facts.outcomes(around) if around.name is not None else around.names("outcomes")
    others = Counter(
        target
        for at, state in enumerate(states)
        for word, target in state.pairs("transitions").items()
        if at != mine and word == outcome
    )
    targeted = {target for state in states for target in state.pairs("transitions").values()}
    following = names[mine + 1] if 0 <= mine < len(names) - 1 else ""
    own = here.body.pairs("transitions")
    first_way = following and following in own.values()
    bad = is_failure(outcome) or outcome == PREEMPTED or (
        bool(first_way) and outcome not in GOOD_OUTCOMES
    )  # fmt: skip
    alike = targets_of_alike(here, outcome, states, mine)

    def score(name: str) -> float:
        total = 3.0 * alike[name] if bad else 0.0
        if name in ends:
            total += 2.0 * (name == outcome)
            total += (3.0 if bad else -2.0) * is_failure(name)
            total -= (3.0 if bad else 0.0) * (name in GOOD_OUTCOMES)
            total += 1.0 * (not bad and not following)
            total += 0.3 * (name not in targeted)
            total += 4.0 * (name in GOOD_OUTCOMES and not bad and name not in targeted
                            and is_recovery(here, following, states))  # fmt: skip
        else:
            total += 6.0 * (name == following and not bad)
            total += 3.0 * (name == following and not bad and name not in targeted)
            total += (3.5 if bad else 1.5) * (name not in targeted and name != names[0])
            total -= 3.0 * (mine >= 0 and name == names[mine])
            total -= 0.8 * bad + 0.5 * (name in names[: mine + 1])
        if bad:
            total += min(others[name], 4) * 0.5
            total += 1.5 * sum(to == name and (is_failure(by) or by == PREEMPTED)
                               for by, to in own.items())  # fmt: skip
        return total

    ranked = sorted([*names, *ends], key=lambda name: -score(name))
    kinds = dict.fromkeys(ends, "outcome") | dict.fromkeys(names, "state")
    return [Completion(word=text, kind=kinds[text]) for text in ranked]


def targets_of_alike(here: Request, outcome: str, states: list[Body], mine: int) -> Counter[str]:
    """Where the outcome leads in the nearest states that are of the same kind, weighted."""
    found: Counter[str] = Counter()
    before = [state for at, state in enumerate(states) if at < mine]
    after = [state for at, state in enumerate(states) if at > mine]
    for body in [*reversed(before[-2:]), *after[:1]]:
        target = body.pairs("transitions").get(outcome)
        if target is not None:
            found[target] += 1
    kind = "script" if "script" in here.body.fields else "template"
    same = [state for state in states if kind in state.fields and state.start != here.body.start]
    if kind == "script":
        for body in same:
            found.update(body.pairs("transitions").get(outcome, "").split())
    return found


def is_recovery(here: Request, name: str, states: list[Body]) -> bool:
    """Whether only failures lead to a state."""
    ways = [by for state in states for by, to in state.pairs("transitions").items() if to == name]
    return bool(ways) and all(is_failure(by) or by == PREEMPTED for by in ways)


def missing_states(here: Request) -> list[str]:
    """The names that transitions lead to and that no state has."""
    container = here.place.body if here.place.word is not here.body.name else here.around
    if container is None:
        return []
    names = {str(state.name.value) for state in container.states if state.name is not None}
    ends = {*here.facts.outcomes(container), *container.names("outcomes")}
    wanted = [
        target for state in container.states for target in state.pairs("transitions").values()
    ]
    return [fromkey for fromkey in dict.fromkeys(wanted) if fromkey not in names | ends]


def children(here: Request) -> Iterable[Completion]:
    return [Completion(word=str(state.name.value), kind="state")
            for state in here.body.states if state.name is not None]  # fmt: skip


def on_error(here: Request) -> Iterable[Completion]:
    ends = [Completion(word=name, kind="outcome") for name in here.body.names("outcomes")]
    failing = [end for end in ends if is_failure(end.word)]
    return [*failing, *children(here), *ends]


def outcomes(here: Request) -> Iterable[Completion]:
    """Outcomes that something leads to and that are not declared yet."""
    known = {*here.place.siblings}
    type_ = here.facts.type_named(here.body.template)
    wanted: list[str] = []
    if here.body.states:
        names = {str(state.name.value) for state in here.body.states if state.name is not None}
        for state in here.body.states:
            wanted += [to for to in state.pairs("transitions").values() if to not in names]
        wanted += here.body.names("outcome_map")
        wanted += here.body.pairs("final_outcome_map").values()
        wanted += [here.body.text("exhausted_outcome")]
    wanted += [*here.body.pairs("transitions")]
    steps = here.body.names("callbacks") if here.body.text("default_outcome") else []
    wanted += steps
    if type_ is not None and "outcomes" not in type_.given:
        wanted += [outcome.name for outcome in type_.outcomes]
    usual = ["succeeded", "aborted", PREEMPTED]
    taken = known | {here.body.text("default_outcome")}
    found = [text for text in success_first(dict.fromkeys(wanted)) if text not in taken]
    return [Completion(word=text, kind="outcome")
            for text in [*found, *(word for word in usual if word not in known)]]  # fmt: skip


def outcome_map(here: Request) -> Iterable[Completion]:
    """The parts of a concurrence's rules: outcome, child, outcome of the child."""
    place = here.place
    if place.role == KEY and not place.inner:
        left = [name for name in here.body.names("outcomes") if name not in place.siblings]
        default = here.body.text("default_outcome")
        return [Completion(word=text, kind="outcome")
                for text in sorted(left, key=lambda word: word == default)]  # fmt: skip
    if place.role == KEY and len(place.inner) == 1:
        return [child for child in children(here) if child.word not in place.siblings]
    if place.role == VALUE and len(place.inner) == 2:
        child = child_named(here, place.inner[1])
        outcomes = here.facts.outcomes(child) if child is not None else []
        bad = is_failure(place.inner[0])
        ranked = sorted(success_first(outcomes), key=lambda text: is_failure(text) != bad)
        same = [text for text in ranked if text == place.inner[0]]
        return [Completion(word=text, kind="outcome") for text in [*same, *ranked]]
    return []


def child_named(here: Request, name: str) -> Body | None:
    return next((state for state in here.body.states
                 if state.name is not None and str(state.name.value) == name), None)  # fmt: skip


def default_outcome(here: Request) -> Iterable[Completion]:
    declared = here.body.names("outcomes")
    if here.body.owner == "Concurrence":
        mapped = {*here.body.names("outcome_map")}
        ranked = sorted(declared, key=lambda text: (text in mapped, not is_failure(text)))
    else:
        led = [pair for pair in here.body.pairs("transitions") if pair not in declared]
        ranked = [*led, *declared]
    return [Completion(word=text, kind="outcome") for text in ranked]


def connector(here: Request) -> Iterable[Completion]:
    count = Counter(outcome for state in here.body.states for outcome in here.facts.outcomes(state))
    led = Counter(outcome for state in here.body.states for outcome in state.pairs("transitions"))
    ranked = sorted(count, key=lambda text: (led[text] - count[text], is_failure(text)))
    return [Completion(word=text, kind="outcome") for text in ranked]


def endings(here: Request) -> Iterable[Completion]:
    """What an Iterator can end with."""
    taken = {*here.body.pairs("final_outcome_map").values()}
    inner = [o for state in here.body.states for o in here.facts.outcomes(state)]
    words = [name for name in here.body.names("outcomes") if name not in (*inner, *taken)]
    ranked = [*success_first(words), *here.body.names("outcomes")]
    return [Completion(word=text, kind="outcome") for text in ranked]


def inner_outcomes(here: Request) -> list[str]:
    found = [outcome for child in here.body.states for outcome in here.facts.outcomes(child)]
    return list(dict.fromkeys(found))


def loop_outcomes(here: Request) -> Iterable[Completion]:
    own = {*here.body.names("outcomes")}
    ending = here.place.field == "break_outcomes"
    left = [outcome for outcome in inner_outcomes(here) if outcome not in here.place.siblings]
    ranked = sorted(left, key=lambda text: ((text in own) != ending, is_failure(text)))
    return [Completion(word=text, kind="outcome") for text in ranked]


def final_map(here: Request) -> Iterable[Completion]:
    if here.place.role == KEY:
        looped = here.body.names("loop_outcomes")
        words = [*looped, *inner_outcomes(here), here.body.text("exhausted_outcome")]
        left = [word for word in words if word not in here.place.siblings]
        return [Completion(word=text, kind="outcome") for text in left]
    inner = {*inner_outcomes(here), here.body.text("exhausted_outcome")}
    words = here.body.names("outcomes")
    ranked = sorted(words, key=lambda word: word in inner)
    return [Completion(word=text, kind="outcome") for text in ranked]


def retry(here: Request) -> Iterable[Completion]:
    place = here.place
    if place.role in (ITEM, VALUE) and place.inner[:1] == ("on",):
        known = here.facts.outcomes(here.body)
        left = [text for text in known if text not in (*place.siblings, "exhausted")]
        ranked = sorted(left, key=lambda text: not is_failure(text))
        return [Completion(word=text, kind="outcome") for text in ranked]
    if place.role == KEY:
        left = [name for name in ("on", "max", "delay") if name not in place.siblings]
        return [Completion(word=text, kind="field", text=f"{text}: ") for text in left]
    return []


def success_first(outcomes: Iterable[str]) -> list[str]:
    """Outcomes by their names: success first, failure and preemption last."""

    def rank(name: str) -> int:
        if name.lower() in SUCCESSES | GOOD:
            return 0
        return 3 if name == PREEMPTED else 2 if is_failure(name) else 1

    return sorted(outcomes, key=rank)

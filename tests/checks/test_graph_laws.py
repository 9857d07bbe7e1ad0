"""The rules over the graph against their definitions, spelt out over sets, for random machines."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from smachac.ir.nodes import StateMachine
from smachac.ir.outcome_names import is_failure
from tests.support.examples import examples
from tests.support.ir_machines import leaf, machine
from tests.support.rule_findings import found, report

EXITS = ("out", "lost")
Steps = dict[str, dict[str, str]]
"""State to outcome to target."""


@st.composite
def flows(draw: st.DrawFn) -> Steps:
    names = [f"S{number}" for number in range(draw(st.integers(1, 6)))]
    # Mostly siblings: loops are what is looked for.
    targets = st.sampled_from([*names, *names, *EXITS])
    outcomes = st.sampled_from(["ok", "other", "failed", "timeout", "preempted"])
    steps = st.dictionaries(outcomes, targets, min_size=1, max_size=3)
    return {name: draw(steps) for name in names}


def built(flow: Steps, forever: bool = False) -> StateMachine:
    root = machine("sm", " ".join(EXITS), *(leaf(name, to) for name, to in flow.items()))
    return replace(root, forever=forever)


def closure(start: str, flow: Steps) -> set[str]:
    """What can be reached from a place, itself included."""
    seen = {start}
    while True:
        more = {to for name in seen for to in flow.get(name, {}).values()} - seen
        if not more:
            return seen
        seen |= more


def endless(flow: Steps) -> set[str]:
    return {name for name in flow if closure(name, flow).isdisjoint(EXITS)}


def without(flow: Steps, *names: str) -> Steps:
    return {
        state: {outcome: to for outcome, to in steps.items() if outcome not in names}
        for state, steps in flow.items()
    }


def failing(flow: Steps) -> Steps:
    """A flow in which every state that a failure leads back to itself fails each time."""
    retries = {
        name
        for name, steps in flow.items()
        for outcome, to in steps.items()
        if is_failure(outcome) and to in flow and name in closure(to, flow)
    }
    return {
        name: {o: to for o, to in steps.items() if is_failure(o) or name not in retries}
        for name, steps in flow.items()
    }


@settings(max_examples=examples(60))
@given(flows())
def test_the_unreachable_states_lead_to_what_the_closure_lacks(flow: Steps) -> None:
    hidden = {name for name in flow if name not in closure("S0", flow)}
    first = {line.rpartition("/")[2] for line in found(built(flow), "SM201")}
    assert first <= hidden
    assert hidden <= set().union(*(closure(name, flow) for name in first))
    assert all(a not in closure(b, flow) for a in first for b in first if a != b)


@settings(max_examples=examples(60))
@given(flows())
def test_every_trap_is_found_and_nothing_else(flow: Steps) -> None:
    stuck = endless(flow) & closure("S0", flow)
    trapped = {line.rpartition("/")[2] for line in found(built(flow), "SM202")}
    assert trapped <= stuck
    assert all(closure(name, flow) & trapped for name in stuck)
    assert all(closure(a, flow).isdisjoint({b}) for a in trapped for b in trapped if a != b)


@settings(max_examples=examples(60))
@given(flows())
def test_a_loop_without_a_bound_is_one_that_failures_never_leave(flow: Steps) -> None:
    entered = closure("S0", flow) & flow.keys()
    unstopped = without(flow, "preempted")
    assume(endless(unstopped).isdisjoint(entered))
    lasting = endless(failing(unstopped)) & entered
    tries = {line.rpartition("/")[2] for line in found(built(flow), "SM204")}
    assert tries <= lasting
    assert bool(tries) == bool(lasting)


@settings(max_examples=examples(60))
@given(flows())
def test_a_machine_that_goes_on_spins_only_where_it_is_never_left(flow: Steps) -> None:
    spinning = {line.rpartition("/")[2] for line in found(built(flow, forever=True), "SM204")}
    assert spinning <= endless(failing(without(flow, "preempted")))


@settings(max_examples=examples(60))
@given(flows(), st.booleans())
def test_witnesses_follow_transitions(flow: Steps, forever: bool) -> None:
    for item in report(built(flow, forever)):
        path = item.finding.path_labels
        for state, outcome, target in zip(path[::2], path[1::2], path[2::2], strict=False):
            assert flow[state][outcome.strip("()")] == target


@settings(max_examples=examples(60))
@given(flows())
def test_rules_find_the_same_wherever_the_states_stand(flow: Steps) -> None:
    root = built(flow)
    turned = replace(root, children=root.children[::-1])
    codes = [sorted({item.code for item in report(one)}) for one in (root, turned)]
    assert codes[0] == codes[1]

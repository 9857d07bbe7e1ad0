"""Iterators: rules I1 to I10, P9."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.runtime import smach
from tests.support.examples import examples

OUTCOMES = ["go", "stop"]


def leaf(do: Callable[[Any], Any] = lambda ud: None) -> smach.State:
    """A state that ends with what `do(userdata)` returns, or else with `go`."""
    return smach.CBState(lambda ud: do(ud) or "go", outcomes=OUTCOMES)


def iterate(
    items: Any, do: Callable[[Any], Any] = lambda ud: None, **contained: Any
) -> smach.Iterator:
    """An iterator over `items` that looks at each under `item`; `go` loops."""
    iterator = smach.Iterator(["stop"], [], [], it=items, it_label="item")
    with iterator:
        smach.Iterator.set_contained_state(
            "EACH", leaf(do), **{"loop_outcomes": ["go"], **contained}
        )
    return iterator


def test_every_item_up_to_the_end() -> None:
    seen: list[int] = []
    iterator = iterate((1, 2, 3), lambda ud: seen.append(ud.item))
    assert iterator.execute() == "exhausted"
    assert seen == [1, 2, 3]
    assert iterator.userdata.item == 3


def test_the_exhausted_outcome_is_registered_once() -> None:
    assert smach.Iterator(["a"], [], []).get_registered_outcomes() == ("a", "exhausted")
    iterator = smach.Iterator(("over",), [], [], it=[], exhausted_outcome="over")
    assert iterator.get_registered_outcomes() == ("over",)


@settings(max_examples=examples(40))
@given(
    results=st.lists(st.sampled_from(["go", "stop", "odd"]), max_size=6),
    loop=st.lists(st.sampled_from(OUTCOMES), unique=True),
    breaking=st.lists(st.sampled_from(OUTCOMES), unique=True),
    final=st.dictionaries(st.sampled_from(["go", "stop", "odd", "exhausted"]), st.just("renamed")),
)
def test_the_first_breaking_outcome_ends_the_loop(
    results: list[str], loop: list[str], breaking: list[str], final: dict[str, str]
) -> None:
    def breaks(outcome: str) -> bool:
        if breaking:
            looping = [o for o in OUTCOMES if o not in breaking]
            return outcome not in looping if looping else outcome in breaking
        return outcome not in loop if loop else outcome in OUTCOMES

    taken = next((n for n, result in enumerate(results) if breaks(result)), len(results))
    outcome = results[taken] if taken < len(results) else "exhausted"
    seen: list[str] = []

    def work(ud: Any) -> str:
        seen.append(ud.item)
        return str(ud.item)

    iterator = iterate(
        list(results),
        work,
        loop_outcomes=loop,
        break_outcomes=breaking,
        final_outcome_map=final,
    )
    assert iterator.execute() == final.get(outcome, outcome)
    assert seen == results[: taken + 1]


def test_a_callable_is_asked_at_each_run() -> None:
    seen: list[int] = []
    iterator = iterate([], lambda ud: seen.append(ud.item))
    with iterator:
        smach.Iterator.set_iteritems(lambda: iterator.userdata.todo, "item")
    iterator.register_input_keys(["todo"])
    iterator.execute({"todo": [1]})
    iterator.execute({"todo": [2, 3]})
    assert seen == [1, 2, 3]


def test_an_error_of_the_items_passes_unchanged() -> None:
    def broken() -> Iterator[int]:
        yield 1
        raise ValueError("no more")

    for items in (broken(), broken, 5):
        iterator = iterate(items)
        with pytest.raises((ValueError, TypeError)):
            iterator.execute()
        assert not iterator.is_running()


def test_an_error_of_the_child_is_user_code() -> None:
    def fail(ud: Any) -> None:
        raise ValueError("broken")

    iterator = iterate([1], fail)
    ended: list[object] = []
    iterator.register_termination_cb(lambda *args: ended.append(args))
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        iterator.execute()
    assert isinstance(caught.value.__cause__, ValueError)
    assert (ended, iterator.get_active_states()) == ([], [])


def test_setting_the_child_again_starts_afresh() -> None:
    iterator = iterate([1, 2])
    with iterator:
        smach.Iterator.set_contained_state("EACH", leaf())
    other = iterate([1, 2], loop_outcomes=[])
    assert iterator.execute() == other.execute() == "go"


def test_the_child_sees_the_iterators_own_userdata() -> None:
    iterator = iterate([1], lambda ud: setattr(ud, "undeclared", ud.secret))
    iterator.userdata.secret = 7
    iterator.execute()
    assert iterator.userdata.undeclared == 7


def test_callbacks_and_active_states() -> None:
    calls: list[Any] = []
    iterator = iterate([1, 2], lambda ud: calls.append(iterator.get_active_states()))
    iterator.register_output_keys(["item"])
    parent: dict[str, int] = {}
    iterator.register_start_cb(lambda ud, labels: calls.append(("start", labels)))
    iterator.register_transition_cb(lambda ud, labels: calls.append(("to", labels)))
    iterator.register_termination_cb(lambda ud, *a: calls.append(("end", *a, dict(parent))))
    iterator.execute(parent)
    step = [["EACH"], ("to", ["EACH"])]
    end = ("end", "EACH", "exhausted", {"item": 2})
    assert calls == [("start", ["EACH"]), *step, *step, end]
    assert iterator.get_active_states() == []


def test_edges_and_children() -> None:
    iterator = iterate([], final_outcome_map={"stop": "ended"})
    assert list(iterator.get_children()) == iterator.get_initial_states() == ["EACH"]
    assert iterator.get_internal_edges() == [["go", "EACH", "EACH"], ("stop", "EACH", "ended")]
    assert smach.Iterator(["a"], [], []).get_internal_edges() == []


def test_set_initial_state_merges_userdata() -> None:
    iterator, ud = iterate([]), smach.UserData()
    ud.k = 1
    iterator.set_initial_state(["EACH"], ud)
    assert iterator.userdata.k == 1
    with pytest.raises(KeyError):
        iterator.set_initial_state(["OTHER"], ud)


def test_shutdown_ends_with_the_last_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    down: list[bool] = []
    monkeypatch.setattr(smach, "is_shutdown", lambda: bool(down))
    iterator = iterate([1, 2], lambda ud: down.append(True))
    assert iterator.execute() == "go"
    assert iterator.execute() == "exhausted"


def test_a_request_ends_the_loop_after_the_item() -> None:
    def work(ud: Any) -> None:
        iterator.request_preempt()
        flags.append(iterator["EACH"].preempt_requested())

    flags: list[bool] = []
    iterator = iterate([1, 2], work)
    assert iterator.execute() == "go"
    assert flags == [True]
    assert not iterator.preempt_requested()


def test_a_request_before_the_run_reaches_the_first_item() -> None:
    seen: list[bool] = []

    def work(ud: Any) -> str:
        seen.append(iterator["EACH"].preempt_requested())
        return "go"

    iterator = iterate([1, 2], work, loop_outcomes=["go"])
    iterator.request_preempt()
    assert iterator.execute() == "go"
    assert seen == [True]


def test_an_outcome_outside_both_lists_goes_on_where_neither_is_given() -> None:
    """Rule I6: only registered outcomes end such an iterator."""
    iterator = iterate(["other", "stop", "go"], lambda ud: str(ud.item), loop_outcomes=[])
    assert iterator.execute() == "stop"


def test_an_unanswered_request_does_not_reach_the_next_run() -> None:
    flags: list[bool] = []

    def work(ud: Any) -> None:
        flags.append(iterator["EACH"].preempt_requested())
        if len(flags) == 1:
            iterator.request_preempt()

    iterator = iterate([1, 2], work)
    assert iterator.execute() == "go"
    assert iterator.execute() == "exhausted"
    assert flags == [False, False, False]


def test_a_request_without_items_stays() -> None:
    iterator = iterate([])
    iterator.request_preempt()
    assert iterator.execute() == "exhausted"
    assert iterator.preempt_requested()


def test_an_iterator_is_not_re_entrant() -> None:
    iterator = iterate([1], lambda ud: iterator.execute())
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        iterator.execute()
    assert isinstance(caught.value.__cause__, smach.InvalidStateError)

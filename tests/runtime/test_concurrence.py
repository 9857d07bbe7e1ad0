"""Concurrences: rules N1 to N15, T3, T5, P10."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.runtime import smach
from tests.support.examples import examples


def leaf(
    outcome: str | None = "done", do: Callable[[Any], object] = lambda ud: None, **keys: list[str]
) -> smach.State:
    """A state that does something to the userdata and ends."""

    def run(ud: Any) -> str | None:
        do(ud)
        return outcome

    return smach.CBState(run, outcomes=["done", "other"], **keys)  # type: ignore[arg-type]


def fail(ud: Any) -> None:
    raise ValueError("broken")


def concurrence(*states: smach.State, **policy: Any) -> smach.Concurrence:
    """A concurrence of states labelled A, B, ..., with outcomes ok and no (the default)."""
    container = smach.Concurrence(["ok", "no"], "no", **policy)
    with container:
        for label, state in zip("ABCDEFGH", states, strict=False):
            smach.Concurrence.add(label, state)
    return container


@pytest.mark.parametrize(
    "policy",
    [
        {"default_outcome": "gone"},
        {"default_outcome": None},
        {"outcome_map": {"gone": {}}},
        {"outcome_cb": "no function"},
        {"child_termination_cb": 1},
    ],
)
def test_a_wrong_policy_is_refused(policy: dict[str, Any]) -> None:
    with pytest.raises(smach.InvalidStateError):
        smach.Concurrence(**{"outcomes": ["ok"], "default_outcome": "ok", **policy})


def test_an_empty_concurrence_raises() -> None:
    with pytest.raises(smach.InvalidStateError):
        concurrence().execute()


def test_adding() -> None:
    container = smach.Concurrence(["ok"], "ok")
    with container:
        first, second = leaf(), leaf()
        assert smach.Concurrence.add("A", first, {"x": "y"}) is first
        smach.Concurrence.add("A", second)
        smach.Concurrence.add("B", first)
    assert container.get_children() == {"A": second, "B": first}
    assert container.get_initial_states() == ["A", "B"]
    assert container.get_active_states() == []


def test_a_map_that_names_no_child_escapes_as_key_error() -> None:
    container = smach.Concurrence(["ok"], "ok", outcome_map={"ok": {"GONE": "done"}})
    with pytest.raises(KeyError), container:
        smach.Concurrence.add("A", leaf())
    assert not container.is_opened()
    with pytest.raises(KeyError):
        container.execute()


def test_a_map_with_an_unknown_outcome_never_holds() -> None:
    container = concurrence(leaf(), outcome_map={"ok": {"A": "gone"}})
    with pytest.raises(smach.InvalidTransitionError):
        container.check_consistency()
    assert container.execute() == "no"


def test_children_run_at_the_same_time() -> None:
    meeting = threading.Barrier(5)
    states = [leaf(do=lambda ud: meeting.wait(10)) for _ in range(5)]
    assert concurrence(*states, outcome_map={"ok": {}}).execute() == "ok"


@settings(max_examples=examples(40))
@given(
    ended=st.lists(st.sampled_from(["done", "other"]), min_size=1, max_size=3),
    rules=st.lists(
        st.tuples(
            st.sampled_from(["x", "y", "z"]),
            st.dictionaries(st.sampled_from("ABC"), st.sampled_from(["done", "other"])),
        ),
        max_size=4,
    ),
)
def test_the_last_rule_that_holds_decides(
    ended: list[str], rules: list[tuple[str, dict[str, str]]]
) -> None:
    outcomes = dict(zip("ABC", ended, strict=False))
    rule_map = {name: {k: v for k, v in rule.items() if k in outcomes} for name, rule in rules}
    container = smach.Concurrence(["x", "y", "z", "default"], "default", outcome_map=rule_map)
    with container:
        for label, outcome in outcomes.items():
            smach.Concurrence.add(label, leaf(outcome))
    holding = [name for name, rule in rule_map.items() if rule.items() <= outcomes.items()]
    assert container.execute() == ([*holding][-1] if holding else "default")


@pytest.mark.parametrize(
    ("chosen", "result"), [("free", "free"), (None, "ok"), ("", "ok"), (5, "ok")]
)
def test_outcome_cb_overrides_with_a_string(chosen: Any, result: str) -> None:
    seen: list[Any] = []

    def choose(outcomes: dict[str, str | None]) -> Any:
        seen.append(dict(outcomes))
        outcomes.clear()
        return chosen

    container = concurrence(leaf(), leaf("other"), outcome_map={"ok": {}}, outcome_cb=choose)
    assert container.execute() == result
    assert seen == [{"A": "done", "B": "other"}]


def test_a_raising_outcome_cb_is_user_code() -> None:
    container = concurrence(leaf(), outcome_cb=fail)
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        container.execute()
    assert isinstance(caught.value.__cause__, ValueError)


def test_children_share_the_userdata_through_their_remappings() -> None:
    written = threading.Event()

    def write(ud: Any) -> None:
        ud.out = 5
        written.set()

    def read(ud: Any) -> None:
        written.wait(10)
        ud.copy = ud.inp

    container = smach.Concurrence(["ok"], "ok", output_keys=["copied"])
    with container:
        smach.Concurrence.add("W", leaf(do=write, output_keys=["out"]), {"out": "shared"})
        reader = leaf(do=read, input_keys=["inp"], output_keys=["copy"])
        smach.Concurrence.add("R", reader, {"inp": "shared", "copy": "copied"})
    parent: dict[str, int] = {}
    container.execute(parent)
    assert parent == {"copied": 5}


def test_a_failing_child_preempts_the_others_and_is_the_cause() -> None:
    told = threading.Event()

    class Waiting(smach.State):
        def request_preempt(self) -> None:
            super().request_preempt()
            told.set()

        def execute(self, ud: Any, /) -> str:
            assert told.wait(10)
            return "done"

    ended: list[object] = []
    waiting, failing = Waiting(["done"]), leaf(do=fail)
    container = concurrence(failing, waiting, output_keys=["x"], outcome_cb=ended.append)
    container.userdata.x = 1
    container.register_termination_cb(lambda *args: ended.append(args))
    parent: dict[str, int] = {}
    with pytest.raises(
        smach.InvalidStateError, match="state 'A' of type CBState failed: ValueError: broken"
    ) as caught:
        container.execute(parent)
    assert isinstance(caught.value.__cause__, ValueError)
    assert (ended, parent) == ([], {})
    assert container.get_active_states() == ["A"]
    assert not container.is_running()


def test_a_run_after_a_failure_starts_afresh() -> None:
    errors = [ValueError()]
    flags: list[bool] = []

    def work(ud: Any) -> None:
        flags.append(state.preempt_requested())
        if errors:
            raise errors.pop()

    state = leaf(do=work)
    container = concurrence(state)
    with pytest.raises(smach.InvalidStateError):
        container.execute()
    assert container.execute() == "no"
    assert flags == [False, False]


@pytest.mark.parametrize("kind", [KeyboardInterrupt, SystemExit])
def test_what_stops_the_process_passes(kind: type[BaseException]) -> None:
    def stop(ud: Any) -> None:
        raise kind

    with pytest.raises(kind):
        concurrence(leaf(do=stop), leaf()).execute()


def test_a_child_without_an_outcome_has_failed() -> None:
    inconsistent = smach.StateMachine(["done"])
    for state in (leaf(None), inconsistent):
        with pytest.raises(smach.InvalidStateError, match="without an outcome"):
            concurrence(state, leaf()).execute()


def test_child_termination_cb_sees_the_live_outcomes() -> None:
    seen: list[list[str | None]] = []

    def changed(outcomes: dict[str, str | None]) -> None:
        seen.append(sorted(outcomes.values(), key=str))
        outcomes["A"] = "other"

    container = concurrence(
        leaf(), leaf(), outcome_map={"ok": {"A": "other"}}, child_termination_cb=changed
    )
    assert container.execute() == "ok"
    assert len(seen) == 2
    assert None in seen[0]


def test_a_raising_child_termination_cb_fails_the_run() -> None:
    with pytest.raises(smach.InvalidStateError) as caught:
        concurrence(leaf(), leaf(), child_termination_cb=fail).execute()
    assert str(caught.value) == "child_termination_cb failed: ValueError: broken"
    assert isinstance(caught.value.__cause__, ValueError)


def test_callbacks_of_a_concurrence() -> None:
    calls: list[Any] = []
    container = concurrence(leaf(), outcome_map={"ok": {}})
    container.register_start_cb(lambda ud, *a: calls.append(("start", *a)), ["x"])
    container.register_transition_cb(lambda ud, *a: calls.append(("to", *a)))
    container.register_termination_cb(lambda ud, *a: calls.append(("end", *a)))
    container.execute()
    assert calls == [("start", ["A"], "x"), ("to", ["A"]), ("to", []), ("end", ["A"], "ok")]
    assert container.get_active_states() == []


def test_set_initial_state_merges_userdata() -> None:
    container, ud = concurrence(leaf()), smach.UserData()
    ud.k = 1
    container.set_initial_state(["A"], ud)
    assert container.userdata.k == 1
    with pytest.raises(KeyError):
        container.set_initial_state(["GONE"], ud)


def test_edges_of_a_concurrence() -> None:
    rules = {"no": {"A": "done"}, "ok": {"A": "other", "B": "done"}}
    container = concurrence(leaf(), leaf(), outcome_map=rules)
    edges = [("done", "A", "no"), ("other", "A", "ok"), ("done", "B", "ok")]
    assert container.get_internal_edges() == edges


def test_a_concurrence_is_not_re_entrant() -> None:
    container = smach.Concurrence(["ok"], "ok")
    with container:
        smach.Concurrence.add("A", leaf(do=lambda ud: container.execute()))
    with pytest.raises(smach.InvalidStateError):
        container.execute()
    assert not container.is_running()

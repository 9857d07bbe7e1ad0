"""Building containers: rules K1 to K13, M1 to M3, A1 to A4, Q1 to Q5, T1, T2."""

from __future__ import annotations

import copy
import pickle
import threading
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.runtime import smach
from tests.support.examples import examples


def leaf(*outcomes: str) -> smach.State:
    """A state that always ends with the first of its outcomes."""
    return smach.CBState(lambda ud: outcomes[0], outcomes=outcomes)


class Done(smach.State):
    """A state that can be pickled."""

    def __init__(self) -> None:
        super().__init__(["done"], io_keys=["n"])

    def execute(self, ud: Any, /) -> str:
        ud.n = ud.n + 1
        return "done"


def test_with_gives_none_and_opened_gives_the_container() -> None:
    machine = smach.StateMachine(["done"])
    with machine as nothing:
        smach.StateMachine.add("A", leaf("done"))
    assert nothing is None
    with machine.opened(transitions={"ignored": "too"}) as same:
        smach.StateMachine.add("B", leaf("done"))
    assert same is machine
    assert list(machine.get_children()) == ["A", "B"]


def test_add_acts_on_the_innermost_container_whatever_it_is_called_on() -> None:
    outer, inner = smach.StateMachine(["done"]), smach.StateMachine(["done"])
    with outer:
        with inner:
            state = outer.add("A", leaf("done"))
        outer.add("IN", inner)
    assert inner["A"] is state
    assert list(outer.get_children()) == ["IN"]


def test_a_container_opens_twice_at_once() -> None:
    machine = smach.StateMachine(["done"])
    with machine, machine:
        smach.StateMachine.add("A", leaf("done"))
    assert not machine.is_opened()


def test_add_needs_an_open_container_of_its_kind() -> None:
    state = leaf("done")
    with pytest.raises(smach.InvalidStateError):
        smach.StateMachine.add("A", state)
    with smach.StateMachine(["done"]):
        with pytest.raises(smach.InvalidStateError):
            smach.Sequence.add("A", state)
        with pytest.raises(smach.InvalidStateError):
            smach.Concurrence.add("A", state)
        with pytest.raises(smach.InvalidStateError):
            smach.Iterator.set_contained_state("A", state)
    sequence = smach.Sequence(["done"], "done")
    with sequence:
        smach.StateMachine.add("A", leaf("done"))
        smach.StateMachine.add("B", leaf("done"))
    assert ("done", "A", None) in sequence.get_internal_edges()


@pytest.mark.parametrize("error", [ValueError, smach.InvalidStateError, KeyboardInterrupt])
def test_an_exception_while_building_leaves_nothing_open(error: Any) -> None:
    outer, inner = smach.StateMachine(["done"]), smach.StateMachine(["done"])

    def build() -> None:
        with inner:
            smach.StateMachine(["done"]).open()
            raise error("while building")

    with outer:
        with pytest.raises(error):
            build()
        smach.StateMachine.add("A", leaf("done"))
    assert list(outer.get_children()) == ["A"]
    with pytest.raises(smach.InvalidStateError):
        smach.StateMachine.add("B", leaf("done"))


def test_threads_build_independently() -> None:
    machine = smach.StateMachine(["done"])
    added: list[str] = []

    def build() -> None:
        other = smach.StateMachine(["done"])
        with other:
            smach.StateMachine.add("B", leaf("done"))
        added.extend(other.get_children())

    with machine:
        thread = threading.Thread(target=build)
        thread.start()
        thread.join(10)
        smach.StateMachine.add("A", leaf("done"))
    assert (added, list(machine.get_children())) == (["B"], ["A"])


def test_closing_out_of_order() -> None:
    with pytest.raises(IndexError):
        smach.StateMachine(["done"]).close()
    outer, inner = smach.StateMachine(["done"]), smach.StateMachine(["done"])
    outer.open()
    inner.open()
    with pytest.raises(smach.InvalidStateError):
        outer.close()
    inner.close()
    outer.close()
    with pytest.raises(smach.InvalidStateError), outer:
        inner.open()
    assert not inner.is_opened()


def test_assert_opened() -> None:
    machine = smach.StateMachine(["done"])
    with pytest.raises(smach.InvalidConstructionError):
        machine.assert_opened("not open")
    with machine:
        machine.assert_opened()


def test_closing_an_inconsistent_machine_only_logs(monkeypatch: pytest.MonkeyPatch) -> None:
    errors: list[str] = []
    monkeypatch.setattr(smach, "logerr", errors.append)
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", leaf("done"), {"done": "LATER"})
    assert any("LATER" in error for error in errors)
    with machine:
        smach.StateMachine.add("LATER", leaf("done"))
    machine.check_consistency()


def test_order_of_the_checks_of_add() -> None:
    machine = smach.StateMachine(["done"])
    with machine:
        with pytest.raises(smach.InvalidTransitionError):
            smach.StateMachine.add("FIRST", leaf("done"), {"nope": "done"})
        smach.StateMachine.add("A", leaf("done"))
        with pytest.raises(smach.InvalidTransitionError):
            smach.StateMachine.add("A", leaf("done"), {"nope": "done"})
        with pytest.raises(smach.InvalidStateError):
            smach.StateMachine.add("A", leaf("done"))
    assert machine.get_initial_states() == ["FIRST"]


def test_the_callers_collections_are_not_written_to() -> None:
    transitions = {"ok": "B"}
    machine = smach.StateMachine(["no"])
    with machine:
        smach.StateMachine.add("A", leaf("ok", "no"), transitions)
        smach.StateMachine.add("B", leaf("ok", "x"), transitions)
    assert transitions == {"ok": "B"}
    shared: dict[str, str | None] = {}
    with smach.Sequence(["ok"], "ok"):
        smach.Sequence.add("A", leaf("ok"), shared)
        smach.Sequence.add("B", leaf("ok"), shared)
    assert shared == {}
    outcomes = ["brk"]
    smach.Iterator(outcomes, [], [], it=[])
    assert outcomes == ["brk"]


def test_a_remapping_is_kept_by_reference() -> None:
    remapping: dict[str, str] = {}
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", Done(), remapping=remapping)
    machine.userdata.n, machine.userdata.m = 0, 10
    machine.execute()
    remapping["n"] = "m"
    machine.execute()
    assert (machine.userdata.n, machine.userdata.m) == (1, 11)


def test_consistency_names_all_faults() -> None:
    machine = smach.StateMachine(["done"])
    with pytest.raises(smach.InvalidTransitionError, match="no initial state"):
        machine.check_consistency()
    with machine:
        smach.StateMachine.add("A", leaf("done", "other"), {"done": "NOWHERE"})
    machine.set_initial_state(["GONE"])
    with pytest.raises(smach.InvalidTransitionError) as caught:
        machine.check_consistency()
    for part in ("GONE", "NOWHERE", "other"):
        assert part in str(caught.value)
    machine.register_outcomes(["NOWHERE", "other"])
    machine.set_initial_state(["A"])
    machine.check_consistency()


def test_set_initial_state() -> None:
    machine = smach.StateMachine(["done"])
    ud = smach.UserData()
    ud.k = 1
    machine.set_initial_state(["B"], ud)
    with machine:
        smach.StateMachine.add("A", leaf("done"))
        smach.StateMachine.add("B", leaf("done"))
    machine.set_initial_state([])
    assert machine.get_initial_states() == ["B"]
    assert machine.userdata.k == 1
    machine.set_initial_state("AB")
    assert machine.get_initial_states() == ["A"]


def test_edges_of_a_machine() -> None:
    machine = smach.StateMachine(["done", "no"])
    with machine:
        smach.StateMachine.add("A", leaf("no", "ok"), {"ok": "B"})
        smach.StateMachine.add("B", leaf("done"), {"done": "done"})
    edges = [("ok", "A", "B"), ("no", "A", None), ("done", "B", "done")]
    assert machine.get_internal_edges() == edges


def test_connectors_lead_to_the_next_state() -> None:
    machine = smach.StateMachine(["done", "ok"])
    with machine:
        smach.StateMachine.add_auto("A", leaf("ok", "no"), ["ok", "no"], {"ok": "done"})
        smach.StateMachine.add_auto("B", leaf("ok"), ["ok"])
    edges = machine.get_internal_edges()
    assert edges == [("ok", "A", "B"), ("no", "A", "B"), ("ok", "B", None)]


def test_an_unknown_connector_is_refused_after_adding() -> None:
    machine = smach.StateMachine(["done"])
    with machine:
        with pytest.raises(smach.InvalidStateError):
            smach.StateMachine.add_auto("A", leaf("done"), ["nope"])
        smach.StateMachine.add("B", leaf("done"))
    assert list(machine.get_children()) == ["A", "B"]


def test_edges_of_a_sequence() -> None:
    sequence = smach.Sequence(["ok", "no"], connector_outcome="ok")
    with sequence:
        smach.Sequence.add("A", leaf("ok", "no"))
        smach.Sequence.add("B", leaf("ok"), {"ok": ""})
        smach.Sequence.add("C", leaf("no"), {"no": "no"})
        smach.Sequence.add("D", leaf("ok"), {"ok": None})
    assert sequence.get_internal_edges() == [
        ("ok", "A", "B"),
        ("no", "A", None),
        ("ok", "B", ""),
        ("no", "C", "no"),
        ("ok", "C", "D"),
        ("ok", "D", None),
    ]


def test_a_duplicate_in_a_sequence_is_linked_before_it_is_refused() -> None:
    sequence = smach.Sequence(["ok"], "ok")
    with sequence:
        smach.Sequence.add("A", leaf("ok"))
        with pytest.raises(smach.InvalidStateError):
            smach.Sequence.add("A", leaf("ok"))
    assert sequence.get_internal_edges() == [("ok", "A", "A")]


def test_containers_have_no_io_keys_argument() -> None:
    arguments: dict[str, Any] = {"io_keys": ["k"]}
    with pytest.raises(TypeError):
        smach.StateMachine(["done"], **arguments)
    machine = smach.StateMachine(["done"])
    machine.register_io_keys(["k"])
    assert machine.get_registered_input_keys() == machine.get_registered_output_keys() == ("k",)


def test_a_plain_container_is_abstract() -> None:
    container = smach.Container(["done"])
    for call in (
        container.get_children,
        container.get_initial_states,
        container.get_active_states,
        container.get_internal_edges,
        container.check_consistency,
    ):
        with pytest.raises(NotImplementedError):
            call()
    with pytest.raises(NotImplementedError):
        container.set_initial_state([], None)
    with pytest.raises(NotImplementedError):
        container["A"]


def test_machines_can_be_pickled_and_copied_also_after_a_run() -> None:
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", Done(), remapping={"n": "m"})
    machine.userdata.m = 0
    machine.execute()
    for twin in (pickle.loads(pickle.dumps(machine)), copy.deepcopy(machine)):
        assert twin.execute() == "done"
        assert (twin.userdata.m, machine.userdata.m) == (2, 1)


@settings(max_examples=examples(40))
@given(
    explicit=st.lists(
        st.dictionaries(st.sampled_from(["ok", "no"]), st.sampled_from([None, "", "ok", "no"])),
        min_size=1,
        max_size=5,
    )
)
def test_a_sequence_is_a_machine_with_the_links_written_out(
    explicit: list[dict[str, str | None]],
) -> None:
    sequence = smach.Sequence(["ok", "no"], "ok")
    machine = smach.StateMachine(["ok", "no"])
    with sequence:
        for n, transitions in enumerate(explicit):
            smach.Sequence.add(str(n), leaf("ok", "no"), transitions)
    with machine:
        for n, transitions in enumerate(explicit):
            linked = dict(transitions)
            if linked.get("ok") is None and n + 1 < len(explicit):
                linked["ok"] = str(n + 1)
            smach.StateMachine.add(str(n), leaf("ok", "no"), linked)
    assert set(sequence.get_internal_edges()) == set(machine.get_internal_edges())
    assert sequence.execute() == machine.execute()

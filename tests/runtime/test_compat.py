"""The switch that takes back what scripts may depend on: rules M9, I2, R7, R8, P2, P7 to P10."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from smachac.runtime import smach


@pytest.fixture(autouse=True)
def _as_smach(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(smach, "compat", True)
    for name in ("loginfo", "logwarn", "logdebug", "logerr"):
        monkeypatch.setattr(smach, name, smach.log.quiet)


class Leaf(smach.State):
    """Acts on its userdata, and notes whether it was preempted."""

    def __init__(self, act: Any = lambda ud: "done", **keys: Any) -> None:
        super().__init__(["done"], **keys)
        self.act = act
        self.flags: list[bool] = []

    def execute(self, ud: Any, /) -> str:
        self.flags.append(self.preempt_requested())
        return str(self.act(ud))


def concurrence(**children: smach.State) -> smach.Concurrence:
    with (container := smach.Concurrence(["done"], "done")):
        for label, child in children.items():
            smach.Concurrence.add(label, child)
    return container


def iterator(child: smach.State, items: Any) -> smach.Iterator:
    with (container := smach.Iterator(["done"], [], [], it=items, exhausted_outcome="done")):
        smach.Iterator.set_contained_state("A", child, loop_outcomes=["done"])
    return container


def machine(child: smach.State, remapping: Any = None) -> smach.StateMachine:
    with (container := smach.StateMachine(["done"])):
        smach.StateMachine.add("A", child, remapping=remapping)
    return container


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit])
def test_what_stops_the_process_is_an_error_of_the_state(error: type[BaseException]) -> None:
    def act(ud: Any) -> str:
        raise error

    for container in (machine(Leaf(act)), iterator(Leaf(act), [1])):
        with pytest.raises(smach.InvalidUserCodeError) as caught:
            container.execute()
        assert isinstance(caught.value.__cause__, error)
        assert not container.is_running()
    with pytest.raises(smach.InvalidStateError):
        concurrence(A=Leaf(act)).execute()


def test_an_exception_of_the_items_is_their_end() -> None:
    def items() -> Iterator[int]:
        yield 1
        raise ValueError

    leaf = Leaf()
    assert iterator(leaf, items).execute() == "done"
    assert len(leaf.flags) == 1


def test_keys_and_update_speak_of_the_container() -> None:
    seen: list[Any] = []

    def act(ud: Any) -> str:
        seen.extend(ud.keys())
        more = smach.UserData()
        more.a, more.undeclared = 5, 6
        ud.update(more)
        return "done"

    container = machine(Leaf(act, input_keys=["a", "b"], output_keys=["a"]), {"a": "x"})
    for key, value in (("x", 1), ("a", 2), ("b", 3)):
        container.userdata[key] = value
    container.execute()
    assert seen == ["x", "b"]
    assert [container.userdata[key] for key in ("x", "a", "undeclared")] == [1, 5, 6]


@pytest.mark.parametrize("early", [True, False])
def test_a_request_before_the_branches_run_reaches_none(early: bool) -> None:
    leaf = Leaf()
    container = concurrence(A=leaf)
    if early:
        container.request_preempt()
    else:
        container.register_start_cb(lambda *given: container.request_preempt())
    assert container.execute() == "done"
    assert leaf.flags == [False]
    assert not container.preempt_requested()


def test_a_branch_keeps_a_request_that_it_did_not_answer() -> None:
    leaf = Leaf()
    container = concurrence(A=leaf)

    def act(ud: Any) -> str:
        leaf.request_preempt()
        return "done"

    leaf.act = act
    container.execute()
    leaf.act = lambda ud: "done"
    container.execute()
    assert leaf.flags == [False, True]


@pytest.mark.parametrize(("given", "set_to"), [(None, "False"), ("1", "True"), ("0", "False")])
def test_the_environment_sets_the_switch(given: str | None, set_to: str) -> None:
    environment = {key: value for key, value in os.environ.items() if key != "SMACHAC_COMPAT"}
    environment |= {"PYTHONPATH": str(Path(__file__).parents[2])}
    environment |= {} if given is None else {"SMACHAC_COMPAT": given}
    code = "from smachac.runtime import smach; print(smach.compat)"
    said = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert said.stdout.strip() == set_to


def test_p9_a_request_before_the_run_does_not_reach_the_first_item() -> None:
    leaf = Leaf()
    loop = iterator(leaf, [1, 2])
    loop.request_preempt()
    assert loop.execute() == "done"
    assert leaf.flags == [False]


def test_p7_an_unanswered_request_in_an_iterator_stays() -> None:
    def act(ud: Any) -> str:
        if len(leaf.flags) == 1:
            loops[0].request_preempt()
        return "done"

    leaf = Leaf(act)
    loops = [iterator(leaf, [1, 2])]
    loops[0].execute()
    loops[0].execute()
    assert leaf.flags == [False, True, True]


def test_p2_a_second_request_is_not_passed_on_to_the_same_child() -> None:
    def act(ud: Any) -> str:
        outer.request_preempt()
        leaf.service_preempt()
        outer.request_preempt()
        asked.append(leaf.preempt_requested())
        return "done"

    asked: list[bool] = []
    leaf = Leaf(act)
    outer = machine(leaf)
    outer.execute()
    assert asked == [False]

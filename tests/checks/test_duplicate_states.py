"""Two states of one name are told once (SM106), and no rule stumbles over them."""

from __future__ import annotations

import pytest

from tests.support.ir_machines import concurrence, leaf, machine
from tests.support.rule_findings import found


@pytest.mark.parametrize("turned", [False, True])
def test_no_rule_stumbles_over_two_states_of_one_name(turned: bool) -> None:
    both = [
        machine("A", "out", leaf("B", {"done": "out"}), to={"out": "done"}),
        leaf("A", {"out": "done"}, ins="k"),
    ]
    root = machine("sm", "done", *(reversed(both) if turned else both))
    assert "SM106 sm/A" in found(root)


@pytest.mark.parametrize("turned", [False, True])
def test_nor_where_one_of_them_is_unknown_and_the_other_never_ends(turned: bool) -> None:
    both = [
        machine("A", "out", leaf("B", {"done": "B"})),
        leaf("A", open=True),
    ]
    inner = concurrence(
        "C", "done", *(reversed(both) if turned else both), default="done", to={"done": "done"}
    )
    assert "SM106 sm/C/A" in found(machine("sm", "done", inner))

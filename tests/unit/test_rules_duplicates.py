"""Two states of one name are told once (SM106), and no rule stumbles over them."""

from __future__ import annotations

import pytest
from ir_machines import leaf, machine
from rule_findings import found


@pytest.mark.parametrize("turned", [False, True])
def test_no_rule_stumbles_over_two_states_of_one_name(turned: bool) -> None:
    both = [
        machine("A", "out", leaf("B", {"done": "out"}), to={"out": "done"}),
        leaf("A", {"out": "done"}, ins="k"),
    ]
    root = machine("sm", "done", *(reversed(both) if turned else both))
    assert "SM106 sm/A" in found(root)

"""The graph of containers that were evaluated: what ends a loop over items, and a concurrence."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk
from smachac.ir.nodes import Concurrence, Iterator

HEAD = """\
import smach

class Do(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok", "bad", "ugly"])

    def execute(self, userdata):
        return "ok"

sm = smach.StateMachine(outcomes=["end"])
"""


def child(text: str, tmp_path: Path) -> Any:
    """The only state of the machine in a file."""
    path = tmp_path / "machine.py"
    path.write_text(HEAD + text, "utf-8")
    (graph,) = PythonProject(Disk()).read(path).graphs
    (node,) = graph.machine.root.children
    return node


@pytest.mark.parametrize(
    ("arguments", "loops"),
    [
        ("loop_outcomes=['ok']", {"ok"}),
        ("break_outcomes=['bad']", {"ok", "ugly"}),
        ("['ok'], ['bad']", {"ok", "ugly"}),
        ("loop_outcomes=[], break_outcomes=['ok', 'bad', 'ugly']", set()),
    ],
)
def test_the_outcomes_that_loop(arguments: str, loops: set[str], tmp_path: Path) -> None:
    node = child(
        "it = smach.Iterator(outcomes=['end'], input_keys=[], output_keys=[], it=[1, 2])\n"
        f"with it:\n    smach.Iterator.set_contained_state('DO', Do(), {arguments})\n"
        "with sm:\n    sm.add('IT', it, {'end': 'end'})\n",
        tmp_path,
    )
    assert isinstance(node, Iterator)
    assert set(node.loop_outcomes) == loops


@pytest.mark.parametrize(
    ("function", "join"),
    [
        ("    return True\n", "any"),
        ("    return False\n", "all"),
        ("    seen.append(ended)\n    return False\n", "all"),
        ("    return ended['A'] == 'ok'\n", "any"),
    ],
)
def test_a_function_that_ends_the_branches(function: str, join: str, tmp_path: Path) -> None:
    node = child(
        f"seen = []\ndef ended(ended):\n{function}"
        "both = smach.Concurrence(outcomes=['end'], default_outcome='end',"
        " child_termination_cb=ended)\n"
        "with both:\n    smach.Concurrence.add('A', Do())\n"
        "with sm:\n    sm.add('BOTH', both, {'end': 'end'})\n",
        tmp_path,
    )
    assert isinstance(node, Concurrence)
    assert node.join == join

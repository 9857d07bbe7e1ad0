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


OPEN_NAMES = {
    "an f-string": ('f"GO_{place}"', "GO_{place}"),
    "a part with a method": ('f"GO_{place.upper()}_NOW"', "GO_{place.upper()}_NOW"),
    "a filled-in text": ('"GO_%s_%d" % (place, 2)', "GO_{place}_2"),
    "format": ('"GO_{}".format(place)', "GO_{place}"),
    "a sum": ('"GO_" + str(place) + "!"', "GO_{place}!"),
    "join": ('"_".join(["GO", place])', "GO_{place}"),
}


@pytest.mark.parametrize("name", OPEN_NAMES)
def test_a_parameter_is_a_part_of_names(name: str, tmp_path: Path) -> None:
    code, text = OPEN_NAMES[name]
    path = tmp_path / "machine.py"
    path.write_text(
        f"{HEAD}def tour(place, robot):\n    tour = smach.StateMachine(outcomes=['ok'])\n"
        "    with tour:\n"
        f"        tour.add('A', smach.State(outcomes=['ok']), {{'ok': {code}}})\n"
        f"        tour.add({code}, smach.State(outcomes=['ok']), {{'ok': 'ok'}})\n",
        "utf-8",
    )
    read = PythonProject(Disk()).read(path)
    (graph,) = read.graphs
    assert [(node.name, node.transitions[0].target) for node in graph.machine.root.children] == [
        ("A", text), (text, "ok"),
    ]  # fmt: skip
    assert [reason for _, reason in graph.coverage.unknown] == ["a part of its name is not known"]
    assert read.report == []


@pytest.mark.parametrize(
    ("label", "target"),
    [
        ('f"GO_{place}"', '"GO_1"'),  # it can be this state
        ('"GO_1"', 'f"GO_{place}"'),
        ('f"GO_{place}"', 'f"GO_{robot}"'),
        ('f"GO_{place.split()}"', 'f"GO_{place.split()}"'),
        ('f"GO_{place:>9}"', 'f"GO_{place:>9}"'),
        ("place + robot", "place + robot"),  # these can be numbers
    ],
)
def test_names_that_can_be_others_are_not_known(label: str, target: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(
        f"{HEAD}def tour(place, robot):\n    tour = smach.StateMachine(outcomes=['ok'])\n"
        "    with tour:\n"
        f"        tour.add('A', smach.State(outcomes=['ok']), {{'ok': {target}}})\n"
        f"        tour.add({label}, smach.State(outcomes=['ok']), {{'ok': 'ok'}})\n",
        "utf-8",
    )
    read = PythonProject(Disk()).read(path)
    assert read.report == []
    assert read.graphs[0].machine.root.children[-1].name == "?"


def test_a_parameter_of_a_method_is_another_one_in_each_call(tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(
        f"{HEAD}class Tour(smach.StateMachine):\n    def __init__(self):\n"
        "        smach.StateMachine.__init__(self, ['ok'])\n"
        "    def more(self, place):\n        with self:\n"
        "            smach.StateMachine.add('GO_' + place, Do(), {'ok': 'ok'})\n",
        "utf-8",
    )
    read = PythonProject(Disk()).read(path)
    assert read.coverage is not None
    assert [place.reason for place in read.coverage.unknown] == ["its name is not known"]


def test_a_changed_parameter_is_no_part_of_names(tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(
        f"{HEAD}def tour(at):\n    tour = smach.StateMachine(outcomes=['ok', 'bad', 'ugly'])\n"
        "    with tour:\n        tour.add(f'GO_{at}', Do(), {'ok': f'GO_{at + 1}'})\n"
        "        at += 1\n        tour.add(f'GO_{at}', Do())\n",
        "utf-8",
    )
    read = PythonProject(Disk()).read(path)
    assert read.report == []
    assert read.graphs[0].machine.root.children[-1].name == "?"

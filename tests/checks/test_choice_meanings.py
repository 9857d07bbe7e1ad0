"""The help for a value that is none of the choices of a variable names the one that means it."""

from __future__ import annotations

import pytest

from smachac.diagnostics.meanings import MEANINGS, by_words, of_same_meaning
from tests.trust.project_text import MAIN, analysed

SCRIPT = """name: m
template: Base
outcomes: [done, bad]
states:
- A:
    template: GripperState
    command: %s
    transitions: {succeeded: done, aborted: bad, preempted: bad}
"""


@pytest.mark.parametrize(
    ("command", "help"),
    [
        ("grasp", "did you mean `close`?"),
        ("Released", "did you mean `open`?"),
        ("sideways", "use one of `open`, `close`"),
    ],
)
def test_the_choice_of_the_same_meaning_is_named(command: str, help: str) -> None:
    report = analysed({MAIN: SCRIPT % command}).report
    found = [item for item in report if item.code == "SM304"]
    assert [item.finding.help for item in found] == [help]


def test_a_word_has_one_meaning() -> None:
    words = [word for group in MEANINGS for word in group]
    assert len(words) == len(set(words))


def test_two_choices_of_one_meaning_are_no_guess() -> None:
    assert of_same_meaning("begin", ["start", "on", "stop"]) is None
    assert of_same_meaning("begin", ["start", "stop"]) == "start"


@pytest.mark.parametrize(
    ("word", "names", "meant"),
    [
        ("charge_percent", ["charge", "percentage", "current"], "percentage"),
        ("level", ["voltage", "percentage"], "percentage"),
        ("velocity", ["speed", "force"], "speed"),
        ("max_velocity", ["speed_limit", "speed"], "speed_limit"),
        ("left_width", ["right_width", "force"], None),
        ("max_speed", ["min_speed"], None),
        ("speed", ["max_speed", "min_speed"], None),
        ("pose", ["start_position", "force"], "start_position"),
        ("colour", ["speed"], None),
        ("cond_cb", ["msg_cb", "topic"], None),
        ("topic_name", ["topic", "frame_name"], "topic"),
    ],
)
def test_a_name_with_words_of_the_same_meaning(
    word: str, names: list[str], meant: str | None
) -> None:
    assert by_words(word, names) == meant


def test_opposite_sides_are_no_choice_of_one_meaning() -> None:
    assert of_same_meaning("back", ["front", "rear", "inside"]) == "rear"
    assert of_same_meaning("ahead", ["front", "rear", "inside"]) == "front"

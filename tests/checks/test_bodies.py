"""Bodies of the simulated world that are loaded twice (SM514)."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

LOADS = """\
name: sm
template: PyBulletBase
outcomes: [done, failed]
userdata: {place: [0.5, 0.2, 0.1], name: brick}
states:
  - CHOOSE:
      template: RandomOutcomeState
      outcomes: [one, other]
      transitions: {one: ONE, other: OTHER}
  - ONE:
      template: LoadModelState
      model_name: block
      remapping: {pose: place}
      transitions: {succeeded: LAST, aborted: AGAIN}
  - AGAIN:
      template: LoadModelState
      model_name: block
      remapping: {pose: place}
      transitions: {succeeded: LAST, aborted: failed}
  - OTHER:
      template: LoadModelState
      model_name: brick
      body: block
      remapping: {pose: place}
      transitions: {succeeded: LAST, aborted: failed}
  - LAST:
      template: LoadModelState
      model_name: block
      remapping: {pose: place}
      transitions: {succeeded: done, aborted: failed}
"""


@pytest.mark.parametrize(
    ("before", "after", "states"),
    [
        ("", "", ["LAST"]),
        ("body: block", "body: brick", []),
        ("{succeeded: LAST, aborted: failed}", "{succeeded: LAST, aborted: LAST}", []),
        (
            "{succeeded: LAST, aborted: AGAIN}",
            "{succeeded: AGAIN, aborted: failed}",
            ["AGAIN", "LAST"],
        ),
        ("{succeeded: done,", "{succeeded: LAST,", ["LAST"]),
        ("template: PyBulletBase", "template: Base", []),
    ],
)
def test_a_body_is_loaded_twice_on_every_path(before: str, after: str, states: list[str]) -> None:
    text = LOADS.replace(before, after, 1)
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    assert [item.span.text for item in report if item.code == "SM514"] == states


EARLY = """\
name: sm
template: PyBulletBase
outcomes: [done, failed]
userdata: {place: [0.5, 0.2, 0.1], ref: table, there: [0.6, 0.0, 0.0]}
states:
  - LOAD:
      template: LoadModelState
      model_name: block
      remapping: {pose: place, reference_frame: ref}
      transitions: {succeeded: TABLE, aborted: failed}
  - TABLE:
      template: LoadModelState
      model_name: table
      remapping: {pose: there}
      transitions: {succeeded: done, aborted: failed}
"""

READS = """\
name: sm
template: PyBulletBase
outcomes: [done, failed]
userdata: {there: [0.6, 0.0, 0.0]}
states:
  - LOAD:
      template: ReadBodyPoseState
      body: table
      transitions: {succeeded: TABLE, aborted: failed}
  - TABLE:
      template: LoadModelState
      model_name: table
      remapping: {pose: there}
      transitions: {succeeded: done, aborted: failed}
"""

BRANCHES = """\
name: sm
template: PyBulletBase
outcomes: [done, failed]
userdata: {there: [0.6, 0.0, 0.0]}
states:
  - BOTH:
      template: Concurrence
      outcomes: [done, failed]
      input_keys: [there]
      default_outcome: failed
      outcome_map: {done: {LOAD: succeeded, TABLE: succeeded}}
      states:
        - LOAD:
            template: ReadBodyPoseState
            body: table
        - TABLE:
            template: LoadModelState
            model_name: table
            remapping: {pose: there}
      transitions: {done: done, failed: failed}
"""


def order(text: str, *changes: tuple[str, str]) -> list[tuple[str, str, str | None]]:
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    late = [item for item in report if item.code in ("SM505", "SM521")]
    return [(item.message, item.span.text, item.help) for item in late]


def test_a_frame_of_a_body_that_is_loaded_later() -> None:
    assert order(EARLY) == [
        (
            "the simulation has no frame `table` before `LOAD`: `TABLE` loads it later",
            "table",
            "run `TABLE` before `LOAD`: the frame exists only after it",
        )
    ]


def test_a_body_that_is_loaded_later() -> None:
    assert order(READS) == [
        (
            "there is no body `table` before `LOAD`: `TABLE` loads it later",
            "table",
            "run `TABLE` before `LOAD`: the body exists only after it",
        )
    ]


FIRST = "pose: there}\n      transitions: {succeeded: LOAD"
FRAMES = "template: PyBulletBase\nframes: [table]"

IN_ORDER = {
    "the help": [
        ("pose: there}\n      transitions: {succeeded: done", FIRST),
        ("{succeeded: TABLE,", "{succeeded: done,"),
        ("states:\n", "initial: TABLE\nstates:\n"),
    ],
    "a loop": [("{succeeded: done,", "{succeeded: LOAD,")],
    "a test for the body": [("aborted: failed}\n  - TABLE", "aborted: TABLE}\n  - TABLE")],
    "a frame of the script": [("template: PyBulletBase", FRAMES)],
}


@pytest.mark.parametrize("text", [EARLY, READS], ids=["frame", "body"])
@pytest.mark.parametrize("changes", IN_ORDER.values(), ids=IN_ORDER)
def test_a_body_that_can_be_there_before(text: str, changes: list[tuple[str, str]]) -> None:
    assert order(text, *changes) == []


def test_a_body_that_another_branch_loads() -> None:
    assert order(BRANCHES) == []


def test_a_state_that_needs_the_body_that_it_loads() -> None:
    own = ("pose: there}", "pose: there, reference_frame: ref}")
    (late,) = order(EARLY, own, ("place, reference_frame: ref}", "place}"))
    assert late[0] == "the simulation has no frame `table` before `TABLE` itself loads it"
    assert late[2] == "write another frame, such as `base`"

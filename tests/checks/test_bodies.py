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

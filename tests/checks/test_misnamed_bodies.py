"""A body that is loaded under another name than the one that states read."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

SCRIPT = """
name: sm
template: PyBulletBase
robot: panda
outcomes: [done, failed]
userdata: {{place: [[0.5, 0.0, 0.02], [0.0, 0.0, 0.0, 1.0]], ground: base}}
states:
  - ONE:
      template: LoadModelState
      model_name: block
      {own}
      remapping: {{pose: place, reference_frame: ground}}
      transitions: {{succeeded: TWO, aborted: failed}}
  - TWO:
      template: LoadModelState
      model_name: block
      body: two
      apart: {{{apart}: 0.12}}
      remapping: {{pose: place, reference_frame: ground}}
      transitions: {{succeeded: SEE, aborted: failed}}
  - SEE:
      template: ReadBodyPoseState
      body: {body}
      remapping: {{pose: found}}
      transitions: {{succeeded: SHOW, aborted: failed}}
  - SHOW: {{template: PrintUserdataState, input_keys: [found], transitions: {{succeeded: done}}}}
"""


@pytest.mark.parametrize(
    ("own", "apart", "body", "count", "help"),
    [
        ("", "one", "one", 1, "write `body: one` in `ONE`, or `block` where `one` is read"),
        ("", "one", "block", 1, "use one of"),
        ("body: one", "one", "one", 0, ""),
        ("body: one", "ones", "ones", 2, "did you mean `one`?"),
        ("", "block", "two", 0, ""),
    ],
)
def test_one_finding_at_the_state_that_loads_it(
    own: str, apart: str, body: str, count: int, help: str
) -> None:
    report = analysed({"main.yml": SCRIPT.format(own=own, apart=apart, body=body)}).report
    found = [item.help or "" for item in report if item.code == "SM521"]
    assert len(found) == count
    assert all(item.startswith(help) for item in found)

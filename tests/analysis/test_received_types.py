"""The types of keys that receive fields of results and responses, in later code."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

SCRIPT = """
name: sm
template: ROSBase
outcomes: [hot, fine, failed]
states:
  - SCAN:
      template: SimpleActionState
      action_server_namespace: scan
      action: cell_msgs/Scan
      result_slots: [SLOT]
      output_keys: [SLOT]
      MORE
      transitions: {succeeded: JUDGE, aborted: failed, preempted: failed}
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [hot]
      input_keys: [SLOT]
      callbacks: {hot: 'lambda ud: CODE'}
      default_outcome: fine
      transitions: {hot: hot, fine: fine}
"""
ACTION = (
    "string zone\n---\nfloat64 temperature\nuint8[] image\nbool[] flags\n---\nfloat32 progress\n"
)


def codes(slot: str, code: str, more: str = "doc: x") -> list[str]:
    text = SCRIPT.replace("SLOT", slot).replace("CODE", code).replace("MORE", more)
    files = {
        "main.yml": text,
        "cell_msgs/package.xml": "<package><name>cell_msgs</name></package>",
        "cell_msgs/action/Scan.action": ACTION,
    }
    return [item.code for item in analysed(files).report if item.code in ("SM311", "SM312")]


def test_a_field_is_used_as_another_type() -> None:
    assert codes("temperature", 'ud.temperature > "80"') == ["SM311"]
    assert codes("temperature", 'ud.temperature == "80"') == ["SM312"]


@pytest.mark.parametrize(
    ("slot", "code", "more"),
    [
        ("temperature", "ud.temperature > 80", "doc: x"),
        ("image", "ud.image > 80", "doc: x"),
        ("flags", "ud.flags > 80", "doc: x"),
        ("temperature", 'ud.temperature > "80"', "result_cb: read_it"),
    ],
)
def test_types_that_are_right_or_not_known(slot: str, code: str, more: str) -> None:
    assert codes(slot, code, more) == []

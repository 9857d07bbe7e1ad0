"""Two branches that set one output of a concurrence, while nothing sets another one (SM405)."""

from __future__ import annotations

import pytest

from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      output_keys: [pin_slot, plate_slot]
      states:
        - PLATE: {template: ScriptedState, outcomes: [ok], output_keys: [slot], remapping: {slot: pin_slot}}
        - PIN: {template: ScriptedState, outcomes: [ok], output_keys: [slot], remapping: {slot: pin_slot}}
      transitions: {done: USE}
  - USE: {template: ScriptedState, outcomes: [ok], input_keys: [pin_slot, plate_slot], transitions: {ok: done}}
"""  # noqa: E501


def found(script: str) -> list[tuple[str, str, str | None]]:
    report = analysed({"main.yml": script}).report
    return [(item.code, item.span.text, item.help) for item in report
            if item.code in ("SM405", "SM301", "SM306")]  # fmt: skip


def test_the_key_of_the_other_branch() -> None:
    help = (
        "write `slot: plate_slot` in the `remapping` of `PLATE`: nothing sets `plate_slot`, which"
        " is an output of `BOTH`"
    )
    assert ("SM405", "pin_slot", help) in found(SCRIPT)
    assert [item[:2] for item in printed({"main.yml": SCRIPT})] == [("SM405", "pin_slot")]


@pytest.mark.parametrize(
    ("old", "new", "codes"),
    [
        ("PLATE: {template: ScriptedState, outcomes: [ok], output_keys: [slot], remapping: {slot:"
         " pin_slot}", "PLATE: {template: ScriptedState, outcomes: [ok]", ["SM306"]),
        ("[pin_slot, plate_slot]\n      states", "[pin_slot, plate_slot, x]\n      states",
         ["SM306", "SM306", "SM405"]),
        ("[ok], output_keys: [slot], remapping: {slot: pin_slot}}\n        - PIN",
         "[ok], output_keys: [slot], remapping: {slot: plate_slot}}\n        - PIN", []),
    ],
)  # fmt: skip
def test_other_scripts(old: str, new: str, codes: list[str]) -> None:
    assert old in SCRIPT
    assert [code for code, _, _ in found(SCRIPT.replace(old, new))] == codes

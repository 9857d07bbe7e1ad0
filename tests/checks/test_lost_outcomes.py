"""Outcomes that `execute` makes and does not return, names without a value after an `except`, and
attributes that a plain class of the project does not have."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed, stopped]
states:
  - WEIGH: {template: Weigh, transitions: {weighed: done, error: failed, preempted: stopped}}
"""
TYPE = """\
outcomes: {weighed: {}, error: {}, preempted: {}}
code: {python: "cell.states:Weigh"}
"""
CLASS = """\
import smach

from cell.drivers import Scale


class CellState(smach.State):
    def stopped(self):
        self.service_preempt()
        return "preempted"

    def limit(self, weight):
        if weight > 3.0:
            return "error"

    def log(self, text):
        print(text)
        return "logged"


class Weigh(CellState):
    def __init__(self):
        super().__init__(outcomes=["weighed", "error", "preempted"])
        self._scale = Scale()

    def execute(self, userdata):
        if self.preempt_requested():
            return self.stopped()
        try:
            weight = self._scale.read()
        except OSError:
            return "error"
        self.log(weight)
        print(weight)
        return "weighed"
"""
SCALE = """\
class Scale:
    def read(self):
        return 0.0

    def tare(self):
        self.zero = 1.0
"""


def findings(old: str, new: str, scale: str = SCALE) -> list[tuple[str, str, str, str]]:
    assert old in CLASS
    files = {
        "main.yml": MAIN,
        "templates/Weigh.yml": TYPE,
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace(old, new),
        "cell/drivers.py": scale,
    }
    return [
        (item.code, item.span.text, item.message, item.help or "")
        for item in analysed(files).report
        if item.severity.value != "info"
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("return self.stopped()", "self.stopped()",
         ("self.stopped()", "the result of `self.stopped()` (`preempted`) is not used",
          "write `return self.stopped()`")),
        ('            return "error"\n        self.log(weight)',
         "            return self.stopped()\n        self.limit(weight)",
         ("self.limit(weight)", "the result of `self.limit(weight)` (`error`) is not used",
          "write `outcome = self.limit(weight)`, and return `outcome` if it is not `None`")),
        ('            return "error"\n        self.log', '            "error"\n        self.log',
         ('"error"', 'the line `"error"` does nothing: `execute` goes on',
          'write `return "error"`')),
        ('            return "error"\n        self.log', "            pass\n        self.log",
         ("weight", "`weight` has no value here if `except OSError` was taken",
          'end the `except OSError` with `return "error"`, or set `weight` in it')),
        ("_scale.read()", "_scale.read_weight()",
         ("read_weight", "`Scale` in `cell/drivers.py` has no `read_weight`",
          "did you mean `read`?")),
        ("_scale.read()", "_scale.grams()",
         ("grams", "`Scale` in `cell/drivers.py` has no `grams`",
          "its methods are `read`, `tare`")),
    ],
)  # fmt: skip
def test_one_fault(old: str, new: str, expected: tuple[str, str, str]) -> None:
    ((code, *found),) = findings(old, new)
    assert code == "SM609"
    assert tuple(found) == expected


END = '            return "error"\n        self.log(weight)\n        print(weight)'


@pytest.mark.parametrize(
    ("old", "new", "scale"),
    [
        ("", "", SCALE),
        ("        self.log(weight)", "        self.limit(weight)", SCALE),
        (END, '            return "error" if userdata else "weighed"', SCALE),
        ("        try:", "        weight = 0.0\n        try:", SCALE),
        (END, "            weight = None\n        print(weight)\n        if weight is None:\n"
         '            return "error"', SCALE),
        (END, "            userdata = None\n        if userdata is None:\n"
         '            return "error"\n        print(weight)', SCALE),
        ("_scale.read()", "_scale.zero", SCALE),
        ("_scale.read()", "_scale.grams()", SCALE.replace("Scale:", "Scale(Base):")),
        ("_scale.read()", "_scale.grams()", SCALE + "\n    def __getattr__(self, name): ...\n"),
        ("self._scale = Scale()", "self._scale = Scale()\n        self._scale.log = print\n"
         "        self._scale.log(1)", SCALE),
    ],
)  # fmt: skip
def test_code_that_is_right_or_cannot_be_judged(old: str, new: str, scale: str) -> None:
    assert [
        finding for finding in findings(old, new, scale) if finding[0] in ("SM609", "SM315")
    ] == []

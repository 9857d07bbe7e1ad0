"""Functions of the project that a class does not call, and names that its modules do not have."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
output_keys: [mass]
states:
  - WEIGH: {template: Weigh, output_keys: [mass], transitions: {weighed: done, empty: failed}}
"""
TYPE = """\
output_keys: {mass: any}
outcomes: {weighed: {}, empty: {}}
code: {python: "cell.states:Weigh"}
"""
CLASS = """\
import smach

from cell import hardware
from cell.hardware import tare


def offset():
    return 0.1


class Weigh(smach.State):
    def __init__(self):
        super().__init__(outcomes=["weighed", "empty"], output_keys=["mass"])
        self.read = hardware.scale

    def execute(self, userdata):
        if not hardware.ready():
            return "empty"
        tare()
        reading = hardware.scale()
        userdata.mass = reading + hardware.LIMIT
        return "weighed"
"""
HARDWARE = """\
LIMIT = 2.0


def ready():
    return True


def scale():
    return 0.2


def tare():
    print(weigh(1))


def weigh(part, arm=None):
    return part
"""


def findings(old: str, new: str, hardware: str = HARDWARE) -> list[tuple[str, str, str]]:
    assert old in CLASS
    files = {
        "main.yml": MAIN,
        "templates/Weigh.yml": TYPE,
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace(old, new),
        "cell/hardware.py": hardware,
    }
    return [
        (item.code, item.span.text, item.help or "")
        for item in analysed(files).report
        if item.severity.value != "info"
    ]


@pytest.mark.parametrize(
    ("old", "new", "place", "help"),
    [
        ("hardware.scale()", "hardware.scale", "hardware.scale", "write `hardware.scale()`"),
        ("hardware.scale()", "hardware.weigh", "hardware.weigh", "write `hardware.weigh(...)`"),
        ("hardware.ready()", "hardware.ready", "hardware.ready", "write `hardware.ready()`"),
        ("        tare()", "        tare", "tare", "write `tare()`"),
        ("reading + hardware.LIMIT", "reading + offset", "offset", "write `offset()`"),
        ("reading + hardware.LIMIT", "hardware.scale", "hardware.scale",
         "write `hardware.scale()`"),
        ("hardware.scale()", "hardware.scales()", "scales", "did you mean `scale`?"),
        ("hardware.LIMIT", "hardware.LIMITS", "LIMITS", "did you mean `LIMIT`?"),
        ("hardware.scale()", "hardware.grams()", "grams",
         "its functions are `ready`, `scale`, `tare`, `weigh`"),
    ],
)  # fmt: skip
def test_one_fault(old: str, new: str, place: str, help: str) -> None:
    assert findings(old, new) == [("SM609", place, help)]


@pytest.mark.parametrize(
    ("old", "new", "hardware"),
    [
        ("", "", HARDWARE),
        ("hardware.scale()\n", "hardware.scale\n        reading = reading()\n", HARDWARE),
        ("hardware.scale()", "(hardware.scale or offset)()", HARDWARE),
        ("reading + hardware.LIMIT", "[hardware.scale, reading]", HARDWARE),
        ("hardware.ready()", "hardware.ready", HARDWARE.replace("def ready", "@cached\ndef ready")),
        ("(self, userdata):", "(self, userdata):\n        hardware = open('box')", HARDWARE),
        ("hardware.scale()", "hardware.grams()", HARDWARE + "globals()['grams'] = scale\n"),
        ("hardware.scale()", "hardware.grams()", "from arm import *\n" + HARDWARE),
        ("hardware.scale()", "hardware.grams()", HARDWARE + "def __getattr__(name): return 1\n"),
        ("hardware.scale()", "getattr(hardware, 'grams', None) and hardware.grams()", HARDWARE),
        ("from cell import hardware", "from arm import hardware", HARDWARE),
    ],
)
def test_code_that_is_right_or_cannot_be_judged(old: str, new: str, hardware: str) -> None:
    found = findings(old, new, hardware)
    assert [item for item in found if item[0] == "SM609"] == []

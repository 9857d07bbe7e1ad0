"""Members of enumerations, and constants of plain classes, that do not exist."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
output_keys: [mode]
states:
  - CHOOSE: {template: Choose, output_keys: [mode], transitions: {fast: done, slow: failed}}
"""
TYPE = """\
output_keys: {mode: any}
outcomes: {fast: {}, slow: {}}
code: {python: "cell.states:Choose"}
"""
CLASS = """\
import sensor, smach

from cell.modes import Mode


class Choose(smach.State):
    def __init__(self):
        super().__init__(outcomes=["fast", "slow"], output_keys=["mode"])

    def execute(self, userdata):
        if sensor.is_near():
            userdata.mode = 1
            return "slow"
        userdata.mode = VALUE
        return "fast"
"""
ENUM = """\
from enum import Enum


class Mode(Enum):
    FAST = 1
    SLOW = 2

    def turned(self):
        return self
"""
PLAIN = """\
class Mode:
    FAST = 1
    SLOW = 2
"""


def reported(value: str, modes: str = ENUM) -> list[tuple[str, str, str]]:
    files = {
        "main.yml": MAIN,
        "templates/Choose.yml": TYPE,
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("VALUE", value),
        "cell/modes.py": modes,
    }
    report = analysed(files).report
    return [(item.code, item.span.text, item.help or "") for item in report]


MEMBERS = "its members are `FAST`, `SLOW`"


@pytest.mark.parametrize(
    ("value", "modes", "help"),
    [
        ("Mode.FASTT", ENUM, "did you mean `FAST`?"),
        ("Mode.FASTT.value", ENUM, "did you mean `FAST`?"),
        ("Mode.CREEP", ENUM, MEMBERS),
        ("Mode.CREEP", ENUM.replace("(Enum)", "(str, Enum)"), MEMBERS),
        ("Mode.CREEP", ENUM.replace("Enum", "IntFlag"), MEMBERS),
        ("Mode.CREEP", ENUM.replace("from enum import Enum", "import enum")
         .replace("(Enum)", "(enum.Enum)"), MEMBERS),
        ("Mode.CREEP", ENUM.replace("class", "@unique\nclass")
         .replace("import Enum", "import Enum, unique"), MEMBERS),
        ("Mode.FASTT", PLAIN, "did you mean `FAST`?"),
        ("Mode.CREEP", PLAIN, MEMBERS),
    ],
)  # fmt: skip
def test_a_member_that_does_not_exist(value: str, modes: str, help: str) -> None:
    (item,) = reported(value, modes)
    member = value.split(".")[1]
    assert item == ("SM609", member, help)


@pytest.mark.parametrize(
    ("value", "modes"),
    [
        ("Mode.FAST", ENUM),
        ("Mode.FAST.value", ENUM),
        ("Mode.FAST.turned()", ENUM),
        ("Mode.turned", ENUM),
        ("Mode.__members__", ENUM),
        ("Mode.__name__", PLAIN),
        ("Mode.mro()", PLAIN),
        ("Mode.maketrans", ENUM.replace("(Enum)", "(str, Enum)")),
        ("Mode.CREEP if hasattr(Mode, 'CREEP') else 1", ENUM),
        ("Mode.CREEP", ENUM.replace("(Enum)", "(Base)")),  # a base that is not read
        ("Mode.CREEP", ENUM.replace("(Enum)", "(Enum, metaclass=Other)")),
        ("Mode.CREEP", ENUM.replace("class", "@extended\nclass")),
        ("Mode.CREEP", ENUM + "\n\nMode.CREEP = Mode.SLOW\n"),
        ("Mode.CREEP", ENUM + "\n    exec('CREEP = 3')\n"),
        ("Mode.CREEP", PLAIN + "\n\nsetattr(Mode, 'CREEP', 3)\n"),
        ("Mode.CREEP", PLAIN.replace("    FAST", "    SLOW, CREEP = 2, 3\n    FAST")),
        ("[Mode.CREEP for Mode in sensor.every()]", ENUM),
    ],
)
def test_no_finding(value: str, modes: str) -> None:
    assert reported(value, modes) == []

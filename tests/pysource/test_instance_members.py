"""Methods of objects of plain classes of the project, written without `()`."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - MOVE: {template: Move, transitions: {there: done, stopped: failed}}
"""
TYPE = """\
outcomes: {there: {}, stopped: {}}
code: {python: "cell.states:Move"}
"""
CLASS = """\
import smach

from cell.driver import Arm


class Move(smach.State):
    def __init__(self):
        super().__init__(outcomes=["there", "stopped"])
        self.arm = Arm()

    def execute(self, userdata):
        while not self.arm.done():
            if self.arm.halted():
                return "stopped"
        self.arm.stop()
        return "there"
"""
DRIVER = """\
class Arm:
    def done(self):
        return True

    def halted(self):
        return False

    def stop(self):
        self.target = None
"""


def reported(old: str, new: str, driver: str = DRIVER) -> list[tuple[str, str, str | None]]:
    assert old in CLASS
    files = {
        "main.yml": MAIN,
        "templates/Move.yml": TYPE,
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace(old, new),
        "cell/driver.py": driver,
    }
    found = [each for each in analysed(files).report if each.code == "SM609"]
    return [(each.span.text, each.message, each.help) for each in found]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("self.arm.done()", "`self.arm.done` without `()` does not call the method"),
        ("self.arm.halted()", "`self.arm.halted` without `()` does not call the method"),
        ("self.arm.stop()",
         "the line `self.arm.stop` does nothing: without `()` a method is not called"),
    ],
)  # fmt: skip
def test_a_method_that_is_not_called(call: str, message: str) -> None:
    ((place, text, help),) = reported(call, call[:-2])
    assert (place, text) == (call[:-2], message)
    assert help is not None
    assert help.startswith(f"write `{call}`")


@pytest.mark.parametrize(
    ("old", "new", "driver"),
    [
        ("self", "self", DRIVER),
        ("self.arm.done()", "self.arm.done",
         DRIVER.replace("    def done", "    @property\n    def done")),
        ("self.arm.done()", "self.arm.done", DRIVER.replace("self.target", "self.done")),
        ("self.arm.done()", "self.arm.done", DRIVER.replace("class Arm:", "class Arm(Base):")),
        ("self.arm.done()", "self.arm.done", DRIVER.replace("class Arm:", "@fast\nclass Arm:")),
        ("        while not self.arm.done()",
         "        self.arm.done = print()\n        while not self.arm.done", DRIVER),
        ("self.arm = Arm()", "self.arm = Arm() or print()", DRIVER),
        ("self.arm.done()", "callable(self.arm.done)", DRIVER),
    ],
)  # fmt: skip
def test_no_finding(old: str, new: str, driver: str) -> None:
    assert reported(old, new, driver) == []


OF_MODULE = (
    DRIVER
    + """
    def move(self, position, rotation, speed=1.0):
        return position or rotation


ARM = Arm()
"""
)


@pytest.mark.parametrize(
    ("call", "place", "help"),
    [
        ("ARM.dune()", "dune", "did you mean `done`?"),
        ("ARM.done", "ARM.done", "write `ARM.done()`"),
        ("ARM.move(1)", "ARM.move(1)",
         "its parameters are those of `ARM.move(position, rotation, speed)`"),
        ("self.arm.move(1)", "self.arm.move(1)",
         "its parameters are those of `self.arm.move(position, rotation, speed)`"),
        ("ARM.move(rotation=1, speed=3)", "ARM.move(rotation=1, speed=3)",
         "its parameters are those of `ARM.move(position, rotation, speed)`"),
        ("self.arm.move(1, 2, 3, 4)", "4",
         "its parameters are those of `self.arm.move(position, rotation, speed)`"),
        ("ARM.move(1, 2)", "", ""),
        ("ARM.move(*self.x)", "", ""),
        ("(lambda ARM: ARM.dune())(1)", "", ""),
    ],
)  # fmt: skip
def test_an_object_of_a_module(call: str, place: str, help: str) -> None:
    new = f"{call}:\n                self.x = (1, 2)\n            if self.arm.halted()"
    files = {
        "main.yml": MAIN,
        "templates/Move.yml": TYPE,
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("import Arm", "import ARM, Arm")
        .replace("self.arm.halted()", new),
        "cell/driver.py": OF_MODULE,
    }  # fmt: skip
    found = [each for each in analysed(files).report if each.code == "SM609"]
    assert [each.span.text for each in found] == ([place] if help else [])
    assert all((each.help or "").startswith(help) for each in found)

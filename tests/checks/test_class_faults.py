"""Slips in Python classes of a user, each found once, at the token that is wrong, with its cure."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {parts: [a, b]}
states:
  - FIND:
      template: Find
      input_keys: [parts]
      transitions: {found: SHOW, nothing: failed}
  - SHOW: {template: PrintUserdataState, input_keys: [part], transitions: {succeeded: done}}
"""

FIND = """\
variables: {tries: {type: int, default: 2}}
input_keys: {parts: "list[str]"}
output_keys: {part: str}
outcomes: {found: {}, nothing: {}}
writes: {found: [part]}
code: {python: "cell.find:FindPart"}
"""

CLASS = """\
import time

import smach

from cell.camera import Camera

FOUND = "found"


class FindPart(smach.State):
    def __init__(self, tries=2):
        super().__init__(
            outcomes=[FOUND, "nothing"], input_keys=["parts"], output_keys=["part"]
        )
        self.tries = tries
        self.camera = Camera()

    def execute(self, userdata):
        if not userdata.parts:
            return "nothing"
        userdata.part = userdata.parts[0]
        return FOUND
"""

CAMERA = """\
class Camera:
    def look(self):
        return 1
"""

FILES = {
    "main.yml": MAIN,
    "templates/Find.yml": FIND,
    "cell/__init__.py": "",
    "cell/find.py": CLASS,
    "cell/camera.py": CAMERA,
}


def report(*changes: tuple[str, str], files: dict[str, str] | None = None) -> list[Diagnostic]:
    """The findings of the project with other parts in some of its files."""
    found = {**FILES, **(files or {})}
    for old, new in changes:
        assert any(old in text for text in found.values())
        found = {name: text.replace(old, new, 1) for name, text in found.items()}
    return [each for each in analysed(found).report if each.code not in ("SM305", "SM306")]


def only(*changes: tuple[str, str], files: dict[str, str] | None = None) -> Diagnostic:
    (item,) = report(*changes, files=files)
    return item


def test_the_project_has_no_finding() -> None:
    assert report() == []


# --- names of other objects

ENUM = """\
class FindPart(smach.State):
    class Out(enum.Enum):
        FOUND = "found"

        def __str__(self):
            self.execute = "x"
            return self.value if self.execute else self.vale

"""


def test_self_of_an_inner_class_is_another_object() -> None:
    changes = [("import time\n", "import enum\n"), ("class FindPart(smach.State):\n", ENUM)]
    assert report(*changes) == []


def test_self_of_an_inner_function_is_another_object() -> None:
    inner = "def execute(self, userdata):\n        def look(self):\n            return self.trees\n"
    assert report(("def execute(self, userdata):\n", inner)) == []
    assert report(("self.tries = tries", "self.tries = tries + self.trees"))[0].span.text == "trees"


@pytest.mark.parametrize("name", ["is_preempt_requested", "prempt_requested"])
def test_private_names_of_smach_are_not_suggested(name: str) -> None:
    item = only(("if not userdata.parts:", f"if self.{name}() or not userdata.parts:"))
    assert (item.code, item.span.text) == ("SM609", name)
    assert item.help == "did you mean `preempt_requested`?"


# --- variables with the name of a field


@pytest.mark.parametrize(
    ("name", "type_", "value"),
    [("it", "int", "3"), ("join", "int", "3"), ("initial", "list[str]", "[a]")],
)
def test_a_variable_has_its_own_type_also_under_the_name_of_a_field(
    name: str, type_: str, value: str
) -> None:
    variable = f'variables: {{tries: {{type: int}}, {name}: {{type: "{type_}"}}}}\n'
    changes = [
        ("variables: {tries: {type: int, default: 2}}\n", variable),
        ("tries=2", f"{name}, tries=2"),
        ("template: Find\n", f"template: Find\n      tries: 2\n      {name}: {value}\n"),
    ]
    assert report(*changes) == []
    (item,) = report(*changes, (f"{name}: {value}\n", f"{name}: {{a: 1}}\n"))
    assert item.code == "SM304"

"""Names that nothing defines, lists and values in the Python class of a state type."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - FIND: {template: Find, transitions: {found: SHOW, nothing: failed}}
  - SHOW: {template: PrintUserdataState, input_keys: [part], transitions: {succeeded: done}}
"""

FIND = """\
output_keys: {part: Pose, width: float}
outcomes: {found: {}, nothing: {}}
writes: {found: [part]}
code: {python: "find_part:FindPart"}
"""

CLASS = """\
import math
from robot_arm import arm

import smach

HEIGHT = 0.1


class Camera(smach.State):
    def __init__(self, **lists):
        super().__init__(**lists)
        self.looks = 0

    def search(self):
        self.looks += 1


class FindPart(smach.State):
    def __init__(self):
        super().__init__(outcomes=["found", "nothing"], output_keys=["part", "width"])
        self.looks = 0

    def execute(self, userdata):
        BODY
        return "found"

    def search(self):
        self.looks += 1
        return self.looks > 1
"""

PART = "userdata.part = [[0.5, 0.0, HEIGHT], [0.0, 0.0, 0.0, 1.0]]"


def report(body: str, old: str = "", new: str = "") -> list[Diagnostic]:
    text = CLASS.replace("BODY", f"{body}\n        {PART}").replace(old, new, 1)
    files = {"main.yml": MAIN, "templates/Find.yml": FIND, "find_part.py": text}
    return [item for item in analysed(files).report if item.code in ("SM609", "SM304")]


@pytest.mark.parametrize(
    ("body", "name", "help"),
    [
        ("return found", "found", 'write `"found"`'),
        ("x = maths.sqrt(2)", "maths", "did you mean `math`?"),
        ("self.serch()", "serch", "did you mean `search`?"),
        ("search()", "search", "did you mean `self.search`?"),
        ("self.grip()", "grip", "define `grip` in the class, or correct the name"),
        ("self.loks += self.look", "look", "did you mean `looks`?"),
        ("if self.prempt_requested(): return 'nothing'", "prempt_requested", "preempt_requested"),
    ],
)
def test_names_that_nothing_defines(body: str, name: str, help: str) -> None:
    (item,) = report(body)
    assert (item.code, item.span.text) == ("SM609", name)
    assert help in (item.help or "")


@pytest.mark.parametrize(
    ("body", "old", "new"),
    [
        ("self.search()", "", ""),
        ("print(len(str(HEIGHT)), math.pi, __file__)", "", ""),
        ("x = [y for y in range(3)]; self.z = lambda a: a + x[0]; self.z(1)", "", ""),
        ("exec('found = 1'); print(found)", "", ""),
        ("look_around(HEIGHT)", "", ""),
        ("print(found)", "import math", "from math import *"),
        ("print(found)", "import math", "try:\n    found\nexcept NameError:\n    found = 1"),
        ("setattr(self, 'grip', print); self.grip()", "", ""),
        ("if hasattr(self, 'grip'): self.grip()", "", ""),
        ("arm.close(self); self.grip()", "class FindPart(smach.State)", "class FindPart(arm.Base)"),
        ("self.grip()", "class FindPart(smach.State)", "class FindPart(smach.State, arm.Mixin)"),
        ("self.grip()", "HEIGHT = 0.1", "def equip(one):\n    one.grip = print\nHEIGHT = 0.1"),
        ("self.search()", "def execute(self, userdata)", "def execute(self, userdata: 'Later')"),
        ("self.known", "def search(self)", "def __getattr__(self, name)"),
        ("x: unknown = 1", "", ""),
        ("while not self._preempt_requested: break", "", ""),
        ("if (n := 3) > 2: print(n)", "", ""),
        ("global later; later = 1; print(later)", "", ""),
    ],
)
def test_names_that_can_be_defined(body: str, old: str, new: str) -> None:
    assert [item.message for item in report(body, old, new)] == []


def test_a_method_of_a_base_class_is_known() -> None:
    assert report("self.search()", "class FindPart(smach.State)", "class FindPart(Camera)") == []
    (item,) = report("self.serch()", "class FindPart(smach.State)", "class FindPart(Camera)")
    assert item.span.text == "serch"


@pytest.mark.parametrize(
    ("given", "help"),
    [
        ('output_keys=("part", "width")', '`output_keys=["part", "width"]`'),
        ('output_keys={"part", "width"}', '`output_keys=["part", "width"]`'),
        ('output_keys=["part", "width"], input_keys="part"', '`input_keys=["part"]`'),
    ],
)
def test_keys_must_be_in_a_list(given: str, help: str) -> None:
    found = report("pass", 'output_keys=["part", "width"]', given)
    assert [help in (item.help or "") for item in found if item.code == "SM609"] == [True]


def test_outcomes_may_be_in_any_collection_but_a_string() -> None:
    assert report("pass", '["found", "nothing"]', '("found", "nothing")') == []
    (item,) = report("pass", '["found", "nothing"]', '"found"')
    assert (item.code, item.span.text) == ("SM609", '"found"')


@pytest.mark.parametrize("value", ['"left"', "3.0", "[0.5, 0.0]", "f'{HEIGHT}'", "str(HEIGHT)"])
def test_literals_that_do_not_fit_the_interface(value: str) -> None:
    (item,) = report(f"userdata.part = {value}")
    assert (item.code, item.span.text) == ("SM304", value)
    assert "[[x, y, z], [qx, qy, qz, qw]]" in (item.help or "")


@pytest.mark.parametrize(
    "value",
    ["[0.5, 0.0, 0.1]", "None", "arm.pose()", "HEIGHT", "[arm.x, 0.0]", "{1: 2}", "HEIGHT == 1"],
)
def test_values_that_fit_or_are_not_known(value: str) -> None:
    assert report(f"userdata.part = {value}") == []


def test_super_without_a_call_is_no_constructor_call() -> None:
    (finding,) = report("pass", "super().__init__(outcomes", "super.__init__(outcomes")
    assert finding.code == "SM609"
    assert report("pass", "super().__init__(outcomes", "smach.State.__init__(self, outcomes") == []


@pytest.mark.parametrize(
    "definition",
    ["def search():\n    return 1\n\n\nclass Camera", "from arm import search\n\n\nclass Camera"],
)
def test_a_function_with_the_name_of_a_method_can_be_called(definition: str) -> None:
    assert report("search()", "class Camera", definition) == []


UNSET = ("def __init__(self)", "def __init__(self, grip=1.0)")


def test_an_argument_that_the_constructor_does_not_keep() -> None:
    (item,) = report("print(self.grip)", *UNSET)
    assert (item.code, item.span.text) == ("SM609", "grip")
    assert item.finding.help == "write `self.grip = grip` in `__init__`"


@pytest.mark.parametrize(
    "body",
    [
        "self.grip = 2; print(self.grip)",
        "print(self.looks)",
        "setattr(self, 'grip', 1); print(self.grip)",
        "print(self.force)",
    ],
)
def test_an_argument_that_is_set_elsewhere_or_not_read(body: str) -> None:
    assert report(body, *UNSET) == []

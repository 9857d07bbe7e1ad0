"""Names that nothing defines, lists and values in the Python class of a state type."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
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
        ("search()", "search", "write `self.search`"),
        ("self.grip()", "grip", "define `grip` in the class, or correct the name"),
        ("self.loks += self.look", "look", "did you mean `looks`?"),
        ("if self.prempt_requested(): return 'nothing'", "prempt_requested", "preempt_requested"),
        ("if preempt_requested(): return 'nothing'", "preempt_requested", "write `self.preempt"),
        ("return null", "null", "write `None`: Python has no `null`"),
        ("while true: break", "true", "write `True`: Python has no `true`"),
        ("print(preempted)", "preempted", 'write `"preempted"`'),
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
        ("print(found)", "import math", "from math import *"),
        ("print(found)", "import math", "try:\n    found\nexcept NameError:\n    found = 1"),
        ("try: look_around()\n        except NameError: pass", "", ""),
        ("setattr(self, 'grip', print); self.grip()", "", ""),
        ("if hasattr(self, 'grip'): self.grip()", "", ""),
        ("arm.close(self); self.grip()", "class FindPart(smach.State)", "class FindPart(arm.Base)"),
        ("self.grip()", "class FindPart(smach.State)", "class FindPart(smach.State, arm.Mixin)"),
        ("self.grip()", "HEIGHT = 0.1", "def equip(one):\n    one.grip = print\nHEIGHT = 0.1"),
        ("self.search()", "def execute(self, userdata)", "def execute(self, userdata: 'Later')"),
        ("print(self.known)", "def execute", "def __getattr__(self, n): ...\n\n    def execute"),
        (
            "try:\n            x = self.known\n        except AttributeError:\n            pass",
            "",
            "",
        ),
        ("x: unknown = 1", "", ""),
        ("while not self._preempt_requested: break", "", ""),
        ("if (n := 3) > 2: print(n)", "", ""),
        ("global later; later = 1; print(later)", "", ""),
        ("null = None; print(null)", "", ""),
        ("service_preempt()", "import math", "from arm_tools import service_preempt"),
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


@pytest.mark.parametrize(
    "value",
    [
        '"left"',
        "3.0",
        "[0.5, 0.0]",
        "f'{HEIGHT}'",
        "str(HEIGHT)",
        "'%.1f' % HEIGHT",
        "'{:.1f}'.format(HEIGHT)",
    ],
)
def test_literals_that_do_not_fit_the_interface(value: str) -> None:
    (item,) = report(f"userdata.part = {value}")
    assert (item.code, item.span.text) == ("SM304", value)
    assert "[[x, y, z], [qx, qy, qz, qw]]" in (item.help or "")


@pytest.mark.parametrize(
    "value",
    [
        "[0.5, 0.0, 0.1]",
        "None",
        "arm.pose()",
        "HEIGHT",
        "[arm.x, arm.y]",
        "{1: 2}",
        "HEIGHT == 1",
        "HEIGHT % 2",
        "arm.format(1)",
    ],
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
        "setattr(self, 'force', 1); print(self.force)",
    ],
)
def test_an_argument_that_is_set_elsewhere_or_not_read(body: str) -> None:
    assert report(body, *UNSET) == []


@pytest.mark.parametrize(
    ("body", "old", "new", "help"),
    [
        ("print(self.force)", "", "", "write `self.force = ...` in `__init__`"),
        ("print(self.gripper.force)", "import math", "from tools import Gripper",
         "write `self.gripper = Gripper(...)` in `__init__`"),
        ("print(self.force)", "self.looks = 0\n\n    def exec",
         "self.looks = 0\n        self.wait = 1\n\n    def exec", "did you mean `wait`?"),
    ],
)  # fmt: skip
def test_an_attribute_that_nothing_sets(body: str, old: str, new: str, help: str) -> None:
    (item,) = report(body, old, new)
    assert (item.code, item.help) == ("SM609", help)


def test_an_attribute_that_another_state_of_the_module_sets() -> None:
    text = "self.looks = 0\n        self.lens = len('ab')\n\n    def search(self):\n"
    (item,) = report("print(self.lens)", "self.looks = 0\n\n    def search(self):\n", text)
    assert item.help == "write `self.lens = len('ab')` in `__init__`"


SLIPS = [
    # names in the scope of another function
    ("return looks", "looks", "write `self.looks`"),
    ("print(HIGHT)", "HIGHT", "did you mean `HEIGHT`?"),
    ("x = part", "part", "write `userdata.part`"),
    # methods that are not called
    ("if self.search: return 'nothing'", "self.search", "write `self.search()`"),
    ("if not self.preempt_requested and 1: print()", "self.preempt_requested",
     "write `self.preempt_requested()`"),
    ("while self.search == 3: pass", "self.search", "write `self.search()`"),
    ("self.search", "self.search", "write `self.search()`, or remove the line"),
    ("userdata.part.clear", "userdata.part.clear",
     "write `userdata.part.clear()`, or remove the line"),
    ("x = userdata.part.copy; print(x)", "userdata.part.copy", "write `userdata.part.copy()`"),
    # comparisons
    ("if userdata.part is 'x': print()", "is", "write `userdata.part == 'x'`"),
    ("print(userdata.part is not 3)", "is not", "write `userdata.part != 3`"),
    ("self.looks == 3", "==", "write `self.looks = 3`"),
    ("self.last == 3; print(self.last)", "==", "write `self.last = 3`"),
    ("userdata.width == 0.1", "==", "write `userdata.width = 0.1`"),
]  # fmt: skip


@pytest.mark.parametrize(("body", "name", "help"), SLIPS)
def test_a_slip_of_python(body: str, name: str, help: str) -> None:
    lists = '"part", "width"]'
    (item,) = analysed_text(body, lists, f'{lists}, input_keys=["part"]')
    assert (item.code, item.span.text, item.help) == ("SM609", name, help)


def analysed_text(body: str, old: str = "", new: str = "") -> list[Diagnostic]:
    """The findings on the class with a body of `execute`, without those of the class as it is."""
    text = CLASS.replace("BODY", f"{body}\n        {PART}").replace(old, new, 1)
    files = {"main.yml": MAIN, "templates/Find.yml": FIND, "find_part.py": text}
    as_it_is = [("SM314", "execute"), ("SM315", "execute"), ("SM310", "part")]
    return [
        item
        for item in analysed(files).report
        if item.severity is not Severity.INFO
        and item.code != "SM603"
        and (item.code, item.span.text) not in as_it_is
    ]


@pytest.mark.parametrize(
    ("old", "new", "name", "help"),
    [
        ("self, userdata", "self, ud", "ud", "write `def execute(self, userdata):`"),
        ("def search(self):\n        self.looks += 1\n        return",
         "def search():\n        self.looks += 1\n        return",
         "search", "write `def search(self):`"),
        ("self.looks > 1", "userdata.part", "userdata",
         "write `def search(self, userdata):`, and pass `userdata` in `execute`"),
        ("self.looks = 0\n\n    def execute", "self.looks = userdata.part\n\n    def execute",
         "userdata", "a state has no userdata before it runs: write `userdata.part` in `execute`"),
        ("self.looks = 0\n\n    def execute", "self.looks = ud\n\n    def execute",
         "ud", "a state has no userdata before it runs: write `userdata` in `execute`"),
        ("self.looks = 0\n\n    def execute", "self.looks = self.look()\n\n    def look(self):\n"
         "        return userdata.part\n\n    def execute",
         "userdata", "a state has no userdata before it runs: write `userdata.part` in `execute`"),
        ("super().__init__(outcomes", "super.__init__(outcomes", "super", "write `super()`"),
        ("return self.looks > 1", "return super.search()", "super", "write `super()`"),
        ("super().__init__(outcomes", "super().init(outcomes", "init", "did you mean `__init__`?"),
        ("super().__init__(outcomes", "super().__int__(outcomes", "__int__",
         "did you mean `__init__`?"),
        ("outcomes=", "outcome=", "outcome", "did you mean `outcomes`?"),
        ('"found", "nothing"', '"found" "nothing"', '"found" "nothing"',
         'write `"found", "nothing"`'),
        ("FindPart(smach.State)", "FindPart(smach.state)", "smach.state", "write `smach.State`"),
        ("FindPart(smach.State)", "FindPart(State)", "State", "write `smach.State`"),
        ("import smach", "import smatch", "smatch", "write `import smach`"),
        ("import smach\n", "", "smach", "write `import smach` at the top of the file"),
        ("class FindPart(smach.State):\n    def __init__(self):",
         "class FindPart(smach.State):\n    def __init__(self, force=2):",
         "force", "write `self.force = force` in `__init__`, and `self.force` here"),
    ],
)  # fmt: skip
def test_a_slip_in_the_class(old: str, new: str, name: str, help: str) -> None:
    body = "print(force)" if name == "force" else "self.search()"
    items = analysed_text(body, old, new)
    assert [(item.code, item.span.text, item.help) for item in items] == [("SM609", name, help)]


@pytest.mark.parametrize(
    "body",
    [
        "print(super, super.__name__, super.mro())",
        "x = self.search; print(x() or self.search is None)",
        "print(callable(self.search))",
        "if userdata.part is None or userdata.part is True: print()",
        "try:\n            userdata.part.position\n        except AttributeError: pass",
        "userdata.part",
        "self.camera = arm; self.camera.ready",  # perhaps a property with an effect
        "looks = 3; print(looks)",
        "global HEIGHT; HEIGHT = 3",
        "class Inner:\n            x = 1\n        print(Inner.x)",
        "def twice(n): return n * looks\n        looks = 3; print(twice(1))",
        "self.search = lambda: 3\n        if self.search: print()",
    ],
)
def test_python_that_is_no_slip(body: str) -> None:
    lists = '"part", "width"]'
    found = analysed_text(body, lists, f'{lists}, input_keys=["part"]')
    assert [item.message for item in found] == []


def test_a_local_variable_in_place_of_an_output_key() -> None:
    found = analysed_text("pass", "userdata.part = [[", "part = [[")
    (item,) = [one for one in found if one.code == "SM314"]
    assert (item.span.text, item.help) == ("part", "write `userdata.part`")


def test_a_fault_of_a_module_is_found_once_for_all_its_classes() -> None:
    runs = '    def execute(self, userdata):\n        return "succeeded"\n\n    def search'
    text = CLASS.replace("BODY", PART).replace("import smach\n", "")
    text = text.replace("    def search", runs, 1)
    files = {
        "main.yml": MAIN.replace("PrintUserdataState, input_keys: [part]", "Look"),
        "templates/Find.yml": FIND,
        "templates/Look.yml": 'outcomes: {succeeded: {}}\ncode: {python: "find_part:Camera"}\n',
        "find_part.py": text,
    }
    found = [item.span.text for item in analysed(files).report if item.code == "SM609"]
    assert found == ["smach"]


PARTS = """\
input_keys: {at: 'float[3]', name: str, poses: 'list[Pose]', where: Pose}
outcomes: {done: {}}
code: {python: "look:Look"}
"""
READER = """\
import smach


class Look(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["at", "name", "poses", "where"])

    def execute(self, userdata):
        BODY
        return "done"
"""
LOOK = """\
name: sm
template: Base
outcomes: [done]
input_keys: [at, name, poses, where]
states:
  - LOOK: {template: Look, transitions: {done: done}}
"""


@pytest.mark.parametrize(
    ("body", "found", "help"),
    [
        ("print(userdata.at.y)", "userdata.at.y",
         "write `userdata.at[1]`, or correct the type in the interface"),
        ("print(userdata.at[3])", "userdata.at[3]",
         "use an index from 0 to 2, or correct the type in the interface"),
        ("print(userdata.name.data)", "userdata.name.data",
         "correct the type of the key in the interface, or write `userdata.name`"),
        ("print(userdata.at[2], userdata.at[-3], userdata.at.copy(), userdata.at.shape)", "", ""),
        ("print(userdata.poses[7], userdata.where.position.x, userdata.name.upper())", "", ""),
        ("userdata.at = make(); print(userdata.at.x)", "", ""),
        ("try:\n            print(userdata.at.x)\n        except AttributeError: pass", "", ""),
    ],
)  # fmt: skip
def test_parts_that_the_type_of_a_key_does_not_have(body: str, found: str, help: str) -> None:
    text = READER.replace("BODY", body)
    files = {"main.yml": LOOK, "templates/Look.yml": PARTS, "look.py": text}
    report = [item for item in analysed(files).report if item.code == "SM311"]
    assert [(item.span.text, item.help) for item in report] == ([(found, help)] if found else [])

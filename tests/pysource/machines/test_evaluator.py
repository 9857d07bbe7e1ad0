"""Machines that the evaluator reads from Python: exact or possible, never wrong."""

from __future__ import annotations

import pytest

from smachac.pysource.machines import evaluator
from tests.support.python_sources import ReadMachine, evaluated, read_machines

HEAD = """\
import smach
import vendor

class Do(smach.State):
    def __init__(self, outcomes=("ok",)):
        smach.State.__init__(self, outcomes=list(outcomes))

    def execute(self, userdata):
        return "ok"

"""

CHAIN = {"A": {"ok": "B"}, "B": {"ok": "done"}}
"""The machine of most cases: A leads to B, and B to the outcome `done`."""


def read(code: str, **files: str) -> ReadMachine:
    """The only root container of a file."""
    (machine,) = read_machines(HEAD + code, {f"{name}.py": text for name, text in files.items()})
    return machine


EXACT = {
    "methods of a list": """
names = []
names.append("A")
names += ["B"]
names.insert(0, names.pop())
names.reverse()
sm = smach.StateMachine(outcomes=["done"])
with sm:
    for name, after in zip(names, names[1:] + ["done"]):
        smach.StateMachine.add(name, Do(), {"ok": after})
""",
    "partial": """
from functools import partial
sm = smach.StateMachine(outcomes=["done"])
add = partial(smach.StateMachine.add, state=Do())
first = partial(partial(add, "A"), transitions={"ok": "B"})
with sm:
    first()
    add("B", transitions={"ok": "done"})
""",
    "a function adds to the container of its caller": """
def tail(name, after="done"):
    smach.StateMachine.add(name, Do(), {"ok": after})

def build():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        tail("A", after="B")
        tail("B")
    return sm
""",
    "dataclass": """
from dataclasses import dataclass, field

@dataclass
class Row:
    name: str
    after: str = "done"
    tags: list = field(default_factory=list)

sm = smach.StateMachine(outcomes=["done"])
with sm:
    for row in (Row("A", after="B"), Row("B")):
        smach.StateMachine.add(row.name, Do(), {"ok": row.after})
""",
    "named tuple": """
from collections import namedtuple
Row = namedtuple("Row", "name after")
sm = smach.StateMachine(outcomes=["done"])
with sm:
    for row in [Row("A", "B"), Row(after="done", name="B")]:
        smach.StateMachine.add(row.name, Do(), {"ok": row.after})
""",
    "enumeration": """
from enum import Enum
class Name(Enum):
    FIRST = "A"
    LAST = "B"
sm = smach.StateMachine(outcomes=["done"])
with sm:
    after = "B" if Name("A") is Name.FIRST else "wrong"
    smach.StateMachine.add(Name.FIRST.value, Do(), {"ok": after})
    smach.StateMachine.add(Name["LAST"].value, Do(), {"ok": "done"})
""",
    "match, walrus and comprehensions": """
sm = smach.StateMachine(outcomes=["done"])
table = {name.upper(): after for name, after in [("a", "B"), ("b", "done")]}
with sm:
    for name in [key for key in table if (seen := key) != "C"]:
        match name:
            case "C":
                after = "wrong"
            case "A" | "B":
                after = table[seen] if name == "B" else table[name]
        smach.StateMachine.add(name, Do(), {"ok": after})
""",
    "closures, global and nonlocal": """
count = 0
def counter():
    at = 0
    def following():
        nonlocal at
        global count
        at += 1
        count += 1
        return "AB"[at - 1]
    return following

following = counter()
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add(following(), Do(), {"ok": "B"})
    smach.StateMachine.add(following(), Do(), {"ok": "done" if count == 2 else "wrong"})
""",
    "class attributes, properties and setters": """
class Names:
    first = "A"
    def __init__(self):
        self._after = "wrong"
    @property
    def after(self):
        return self._after
    @after.setter
    def after(self, value):
        self._after = value.upper()

class Others(Names):
    last = "B"

names = Others()
names.after = "b"
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add(names.first, Do(), {"ok": names.after})
    smach.StateMachine.add(Others.last, Do(), {"ok": "done"})
""",
    "a chain of super calls in a diamond": """
class Base(smach.StateMachine):
    def __init__(self, outcomes):
        super().__init__(outcomes=outcomes)
        self.names = []
        self.fill()
    def fill(self):
        self.names.append("done")

class Left(Base):
    def fill(self):
        self.names.append("A")
        super().fill()

class Right(Base):
    def fill(self):
        self.names.append("B")
        super(Right, self).fill()

class Both(Left, Right):
    def __init__(self):
        super().__init__(["done"])
        with self:
            for name, after in zip(self.names, self.names[1:]):
                self.add(name, Do(), {"ok": after})
""",
    "while, break, continue and else": """
sm = smach.StateMachine(outcomes=["done"])
at = 0
with sm:
    while True:
        at += 1
        if at == 2:
            continue
        if at > 3:
            break
        smach.StateMachine.add("AB"[at // 2], Do(), {"ok": "B" if at == 1 else "done"})
    else:
        smach.StateMachine.add("C", Do(), {"ok": "done"})
""",
    "a context manager of the project": """
class Opened:
    def __init__(self, sm):
        self.sm = sm
    def __enter__(self):
        self.sm.open()
        return self.sm
    def __exit__(self, *error):
        self.sm.close()

with Opened(smach.StateMachine(outcomes=["done"])) as sm:
    sm.add("A", Do(), {"ok": "B"})
    sm.add("B", Do(), {"ok": "done"})
""",
    "a try that fails at most at its end": """
try:
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Do(), {"ok": "B"})
        smach.StateMachine.add("B", Do(), {"ok": "done"})
    vendor.spin(sm.execute())
except vendor.Interrupted:
    print("stopped")
""",
    "an unknown condition around a whole machine": """
if vendor.flag():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Do(), {"ok": "B"})
        smach.StateMachine.add("B", Do(), {"ok": "done"})
""",
    "an endless loop at the end": """
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {"ok": "B"})
    smach.StateMachine.add("B", Do(), {"ok": "done"})
while True:
    vendor.sleep()
""",
    "add_auto": """
sm = smach.StateMachine(outcomes=["done", "ok"])
with sm:
    smach.StateMachine.add("A", Do(), transitions=dict(ok="B"))
    smach.StateMachine.add("B", Do(), transitions={**{"ok": "wrong"}, "ok": "done"})
""",
    "a function that a loop runs an unknown number of times": """
def main():
    sm = smach.StateMachine(outcomes=["done"])
    names = []
    for name in "AB":
        names.append(name)
    with sm:
        smach.StateMachine.add(names[0], Do(), {"ok": names[1]})
        smach.StateMachine.add(names[1], Do(), {"ok": "done"})
    sm.execute()

while not vendor.is_shutdown():
    main()
""",
    "objects of one branch": """
if vendor.flag():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.a = 1
    with sm:
        smach.StateMachine.add("A", Do(), {"ok": "B"})
        smach.StateMachine.add("B", Do(), {"ok": "done"})
    found = {}
    found["A"] = "B"
else:
    found = vendor.found()
""",
    "the items of a dictionary as in Python 2": """
after = {"A": "B", "B": "done"}
sm = smach.StateMachine(outcomes=["done"])
with sm:
    for name in after.iterkeys():
        smach.StateMachine.add(name, Do(), {"ok": after[name]})
    del after["A"]
    for target in after.itervalues():
        assert target == "done"
""",
    "a method that ROS calls, of an object of the main part": """
class Tour:
    def __init__(self, name):
        self.name = name
        vendor.serve(self.run)
    def run(self, goal):
        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("A", Do(), {"ok": "B"})
            smach.StateMachine.add("B", Do(), {"ok": "done"})
        return sm.execute()

if __name__ == "__main__":
    Tour("tour")
    vendor.spin()
""",
    "classes from the wrong module of SMACH": """
import smach_ros
from smach_ros import StateMachine as Tour
sm = Tour(outcomes=["done"])
with sm:
    Tour.add("A", Do(), {"ok": "B"})
    smach_ros.StateMachine.add("B", Do(), {"ok": "done"})
smach.IntrospectionServer("tour", sm, "/TOUR").start()
""",
    "recursion with known ends": """
def chain(names):
    if not names:
        return
    smach.StateMachine.add(names[0], Do(), {"ok": (names + ["done"])[1]})
    chain(names[1:])

sm = smach.StateMachine(outcomes=["done"])
with sm:
    chain(["A", "B"])
""",
}  # fmt: skip


@pytest.mark.parametrize("name", EXACT)
def test_the_machine_is_exact(name: str) -> None:
    assert read(EXACT[name]).exact == CHAIN


def test_a_class_that_a_function_of_another_module_makes_belongs_to_its_own_file() -> None:
    code = """
from starting import start
class Tour(smach.StateMachine):
    def __init__(self, robot):
        smach.StateMachine.__init__(self, outcomes=["done"])
        with self:
            self.add("A", Do(), {"ok": "B"})
            self.add("B", Do(), {"ok": "done"})
start(Tour)
"""
    assert read(code, starting="def start(kind):\n    kind(None).execute()\n").exact == CHAIN


def test_a_main_script_that_imports_itself() -> None:
    code = """
class Tour(smach.StateMachine):
    def __init__(self):
        smach.StateMachine.__init__(self, outcomes=["done"])
        with self:
            self.add("A", Do(), {"ok": "B"})
            self.add("B", Do(), {"ok": "done"})
if __name__ == "__main__":
    from machine import Tour
    Tour().execute()
"""
    assert read(code).exact == CHAIN


def test_a_method_of_a_made_object_gives_no_machine_of_its_constructor_again() -> None:
    code = """
class Tours:
    def __init__(self, last):
        self.sm = self.made("A", last)
    def made(self, name, after):
        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add(name, Do(), {"ok": after})
        return sm
    def again(self, request):
        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("B", Do(), {"ok": "done"})
        return sm.execute()
Tours("done")
"""
    names = [[state.label for state in machine.states] for machine in read_machines(HEAD + code)]
    assert names == [["A"], ["B"]]


NOT_SURE = {
    "an outcome that a condition adds": """
outcomes = ["ok"]
if vendor.flag():
    outcomes.append("failed")
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(outcomes), {"ok": "done"})
""",
    "a list that one turn of a loop makes, and another one changes": """
while vendor.flag():
    if vendor.first():
        outcomes = ["ok"]
    else:
        outcomes.append("failed")
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(outcomes), {"ok": "done"})
""",
    "an attribute that one turn of a loop makes, and another one changes": """
class Lists:
    pass
lists = Lists()
while vendor.flag():
    if vendor.first():
        lists.outcomes = ["ok"]
    else:
        lists.outcomes.append("failed")
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(lists.outcomes), {"ok": "done"})
""",
    "a list that an inner function of a loop keeps": """
kept = []
def more():
    outcomes = ["ok"]
    kept.append(outcomes)
    return outcomes
while vendor.flag():
    for outcomes in kept:
        outcomes.append("failed")
    more()
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(kept[0]), {"ok": "done"})
""",
    "a list before and after an unknown return": """
def outcomes():
    found = ["ok"]
    if vendor.flag():
        return found
    found.append("failed")
    return found
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(outcomes()), {"ok": "done"})
""",
    "outcomes that unknown code gets": """
outcomes = ["ok"]
vendor.fill(outcomes)
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(outcomes), {"ok": "done"})
""",
    "outcomes that a comprehension with an unknown list adds": """
outcomes = ["ok"]
[outcomes.append(name) for name in vendor.names()]
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(outcomes), {"ok": "done"})
""",
}


@pytest.mark.parametrize("name", NOT_SURE)
def test_outcomes_are_not_known(name: str) -> None:
    (state,) = read(NOT_SURE[name]).states
    assert state.outcomes is None


TARGETS = {
    "import with a fallback": """
try:
    from names import AFTER
except ImportError:
    AFTER = "C"
""",
    "any line of a try can be the last": """
AFTER = "C"
try:
    vendor.risky()
    AFTER = "B"
except vendor.Error:
    pass
""",
    "a return in a try": """
def after():
    try:
        vendor.risky()
        return "B"
    except vendor.Error:
        return "C"
AFTER = after()
""",
    "break under an unknown condition": """
AFTER = "C"
for at in (1, 2, 3):
    if vendor.flag():
        break
    AFTER = "B"
""",
    "continue under an unknown condition": """
AFTER = "C"
for at in (1,):
    if vendor.flag():
        continue
    AFTER = "B"
""",
    "return under an unknown condition": """
def after():
    for at in (1, 2):
        if vendor.flag():
            return "B"
    return "C"
AFTER = after()
""",
    "match of an unknown value": """
match vendor.name():
    case "b":
        AFTER = "B"
    case _:
        AFTER = "C"
""",
    "an attribute of the class, or of the object": """
class Names:
    after = "C"
names = Names()
if vendor.flag():
    names.after = "B"
AFTER = names.after
""",
    "a walrus under an unknown condition": """
AFTER = "C"
vendor.flag() and (AFTER := "B")
""",
    "an alternative": """
AFTER = (vendor.flag() and "B") or "C"
AFTER = "B" if vendor.flag() else "C"
""",
    "a value that is missing by default": """
part = None
if vendor.flag():
    part = Do()
    part.after = "B"
AFTER = "B" if vendor.flag() else "C"
""",
}  # fmt: skip


@pytest.mark.parametrize("name", TARGETS)
def test_a_target_is_one_of_two(name: str) -> None:
    code = f"""{TARGETS[name]}
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {{"ok": AFTER}})
"""
    (state,) = read(code, names='AFTER = "B"').states
    assert state.transitions == {"ok": frozenset({"B", "C"})}


def test_a_loop_with_unknown_turns_changes_what_the_next_turn_reads() -> None:
    machine = read("""
after, is_second = "B", False
sm = smach.StateMachine(outcomes=["done"])
with sm:
    for name in vendor.names():
        smach.StateMachine.add("A", Do(), {"ok": after})
        if is_second:
            after = "C"
        is_second = True
""")
    (state,) = machine.states
    assert state.possible
    assert state.transitions == {"ok": None}


def test_a_state_that_a_condition_adds_is_possible() -> None:
    machine = read("""
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {"ok": "done"})
    if vendor.flag():
        smach.StateMachine.add("B", Do(), {"ok": "done"})
    vendor.flag() and smach.StateMachine.add("C", Do(), {"ok": "done"})
    [smach.StateMachine.add("D", Do(), {"ok": "done"}) for at in vendor.names()]
""")
    assert [(state.label, state.possible) for state in machine.states] == [
        ("A", False), ("B", True), ("C", True), ("D", True)
    ]  # fmt: skip


@pytest.mark.parametrize("call", ["vendor.add_more(sm)", "vendor.add_more(target=sm)"])
def test_a_container_that_unknown_code_gets_is_incomplete(call: str) -> None:
    machine = read(f"""
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {{"ok": "done"}})
{call}
""")
    assert not machine.complete


def test_recursion_without_a_known_end_leaves_the_container_incomplete() -> None:
    machine = read("""
def chain(at):
    smach.StateMachine.add("A%d" % at, Do(), {"ok": "A%d" % (at + 1)})
    if vendor.flag():
        chain(at + 1)

sm = smach.StateMachine(outcomes=["done"])
with sm:
    chain(0)
""")
    assert not machine.complete


def test_recursion_that_adds_no_state_leaves_the_container_complete() -> None:
    machine = read("""
def size(part):
    return vendor.flag() and size(part) + size(part)

sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {"ok": "B"})
    size(sm)
    smach.StateMachine.add("B", Do(), {"ok": "done"})
""")
    assert machine.exact == CHAIN


def test_positional_arguments_behind_unknown_ones_have_no_known_place() -> None:
    machine = read("""
def make(name, after):
    smach.StateMachine.add(name, Do(), {"ok": after})

sm = smach.StateMachine(outcomes=["done"])
with sm:
    make(*vendor.names(), "B")
""")
    (state,) = machine.states
    assert (state.label, state.transitions) == (None, {"ok": None})


# --- modules


def test_a_module_of_a_function_stays_loaded_for_the_next_function() -> None:
    code = """
def {name}():
    import names
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Do(), {{"ok": names.AFTER}})
        smach.StateMachine.add(names.AFTER, Do(), {{"ok": "done"}})
    return sm
"""
    text = HEAD + code.format(name="one") + code.format(name="two")
    machines, faults = evaluated(text, {"names.py": 'AFTER = "B"'})
    assert [machine.exact for machine in machines] == [CHAIN, CHAIN]
    assert faults == []


MODULES = {
    "star import": {"main": "from names import *", "names.py": 'AFTER = "B"\n_X = 1'},
    "package": {"main": "from robot import AFTER", "robot/__init__.py": "from .names import AFTER",
                "robot/names.py": 'AFTER = "B"'},
    "relative import of a parent": {
        "main": "from robot.arm.names import AFTER",
        "robot/__init__.py": "", "robot/arm/__init__.py": "",
        "robot/arm/names.py": "from ..names import AFTER", "robot/names.py": 'AFTER = "B"'},
    "circular import": {"main": "from one import AFTER", "one.py": "import two\nAFTER = two.AFTER",
                        "two.py": 'import one\nAFTER = "B"\ndef late():\n    return one.AFTER'},
    "dotted import": {"main": "import robot.names\nAFTER = robot.names.AFTER",
                      "robot/__init__.py": "", "robot/names.py": 'AFTER = "B"'},
    "alias": {"main": "import robot.names as n\nAFTER = n.AFTER", "robot/__init__.py": "",
              "robot/names.py": 'AFTER = "B"'},
    "line ends of Windows": {"main": "from names import AFTER",
                             "names.py": 'X = 1\r\nAFTER = "B"\r\n'},
}  # fmt: skip


@pytest.mark.parametrize("name", MODULES)
def test_names_of_other_modules_are_known(name: str) -> None:
    files = dict(MODULES[name])
    code = f"""{files.pop("main")}
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {{"ok": AFTER}})
    smach.StateMachine.add("B", Do(), {{"ok": "done"}})
"""
    machines, faults = evaluated(HEAD + code, files)
    assert [machine.exact for machine in machines] == [CHAIN]
    assert faults == []


NO_FAULT = {
    "__getattr__": "def __getattr__(name):\n    return 1",
    "globals": 'globals()["AFTER"] = "B"',
    "star import of an unknown module": "from vendor import *",
    "an error on import": "X = 1\nraise ImportError",
    "set by a function": "import names\ndef init():\n    names.AFTER = 1",
    "exec": 'exec("AFTER = 1")',
    "not read": "def (",
}


@pytest.mark.parametrize("name", NO_FAULT)
def test_a_name_that_a_module_may_have_is_no_fault(name: str) -> None:
    _, faults = evaluated("import names\nx = names.AFTER\n", {"names.py": NO_FAULT[name]})
    assert faults == []


LACKING = {
    "of a module": ("from names import AFTR", ("AFTR", "names.py", "")),
    "with another name": ("from names import AFTER, AFTR as after", ("AFTR", "names.py", "")),
    "of a package": ("from inner import names, other", ("other", "inner/__init__.py", "")),
    "of a module of SMACH": (
        "from smach_ros import StateMachine", ("StateMachine", "smach_ros", "smach"),
    ),
    "of the other module of SMACH": (
        "import smach\nsmach.ServiceState('a', None)", ("ServiceState", "smach", "smach_ros"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LACKING)
def test_a_name_that_an_imported_module_lacks_is_a_fault(name: str) -> None:
    code, names = LACKING[name]
    files = {"names.py": "AFTER = 1", "inner/__init__.py": "", "inner/names.py": ""}
    _, faults = evaluated(code, files)
    assert [(fault.kind, fault.names) for fault in faults] == [("missing member", names)]


@pytest.mark.parametrize(
    "code",
    [
        "import vendor\nif vendor.flag():\n    from names import AFTR\n",
        "try:\n    from names import AFTR\nexcept ImportError:\n    AFTR = 2\n",
        "from robot.msg import Pose\nfrom robot.cfg import TourConfig",  # the build makes them
        "from tools import AFTR",  # two files have this name
        "from whole import AFTR",
        "from twice import AFTER",  # a package with a module of its name
        "from inner import broken",
        "from smach import InvalidUserCodeError",
    ],
)
def test_a_name_that_a_module_can_have_is_no_fault(code: str) -> None:
    files = {
        "names.py": "AFTER = 1", "robot/msg/__init__.py": "", "robot/cfg/__init__.py": "",
        "a/tools.py": "", "b/tools.py": "", "whole.py": "from vendor import *",
        "inner/__init__.py": "", "inner/broken.py": "def",
        "twice/__init__.py": "from twice import *", "twice/twice.py": "AFTER = 1",
    }  # fmt: skip
    assert evaluated(code, files)[1] == []


def test_a_name_that_a_module_cannot_have_is_a_fault() -> None:
    _, faults = evaluated("import names\nx = names.AFTR\n", {"names.py": "AFTER = 1"})
    assert [(fault.kind, fault.names) for fault in faults] == [
        ("missing member", ("AFTR", "names.py", ""))
    ]


# --- bounds


def test_a_machine_after_too_many_steps_is_incomplete(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", 20_000)
    machine = read("""
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", Do(), {"ok": "B"})
    for one in range(10000):
        for other in range(10000):
            pass
    smach.StateMachine.add("B", Do(), {"ok": "done"})
""")
    assert [state.label for state in machine.states] == ["A"]
    assert not machine.complete


def test_a_module_that_takes_too_many_steps_is_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", 20_000)
    endless = "for one in range(10000):\n    for other in range(10000):\n        pass\n"
    machines, faults = evaluated(
        HEAD + "sm = smach.StateMachine(outcomes=['done'])\nimport names\nx = names.AFTER\n",
        {"names.py": endless + "AFTER = 1"},
    )
    assert (machines, faults) == ([], [])

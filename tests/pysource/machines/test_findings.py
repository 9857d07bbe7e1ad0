"""The findings about machines in Python: SMACH's own traps, and no false alarm where a part is not
known."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk

HEAD = """\
import smach
import smach_ros
import vendor

class Do(smach.State):
    def __init__(self, *outcomes):
        smach.State.__init__(self, outcomes=list(outcomes) or ["ok"])

    def execute(self, userdata):
        return "ok"

class Use(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"], input_keys=["part"])

    def execute(self, userdata):
        print(userdata.part)
        return "ok"

"""


def found(code: str, folder: Path, **files: str) -> list[str]:
    """The codes of the findings, each with the code of its line."""
    path = folder / "machine.py"
    path.write_text(HEAD + code, "utf-8")
    for name, text in files.items():
        (folder / f"{name}.py").write_text(text, "utf-8")
    report = PythonProject(Disk()).read(path).report
    return [f"{item.code} {item.span.source.line(item.span.line).strip()}" for item in report]


WRONG = {
    "a first value of the result that a branch keeps": (
        'class Choose(smach.State):\n    def __init__(self):\n'
        '        smach.State.__init__(self, outcomes=["ok", "no"])\n'
        '    def execute(self, userdata):\n        result = ""\n'
        '        if vendor.ready():\n            result = "ok"\n'
        '        elif vendor.late():\n            result = "no"\n        return result\n'
        'sm = smach.StateMachine(outcomes=["ok", "no"])\nwith sm:\n    sm.add("A", Choose())\n',
        'SM309 result = ""',
    ),
    "a first value of the result that is returned before it is replaced": (
        'class Choose(smach.State):\n    def __init__(self):\n'
        '        smach.State.__init__(self, outcomes=["ok", "no"])\n'
        '    def execute(self, userdata):\n        result = "non"\n'
        '        if vendor.ready():\n            return result\n        result = "ok"\n'
        '        return result\n'
        'sm = smach.StateMachine(outcomes=["ok", "no"])\nwith sm:\n    sm.add("A", Choose())\n',
        'SM309 result = "non"',
    ),
    "a text as the outcomes": (
        'sm = smach.StateMachine("d")\nwith sm:\n    sm.add("A", smach.State(outcomes=["d"]))\n',
        'SM801 sm = smach.StateMachine("d")',
    ),
    "a text as the keys of a callback": (
        '@smach.cb_interface(outcomes=["ok"])\ndef call(userdata):\n    return "ok"\n'
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", smach.CBState(call, input_keys="k"))\n',
        'SM801 sm.add("A", smach.CBState(call, input_keys="k"))',
    ),
    "one dictionary for two states": (
        'table = {"ok": "done"}\nsm = smach.StateMachine(outcomes=["done", "no"])\nwith sm:\n'
        '    sm.add("C", Do("ok", "no"), {"ok": "A", "no": "B"})\n'
        '    sm.add("A", Do("ok", "no"), table)\n    sm.add("B", Do(), table)\n',
        'SM802 sm.add("B", Do(), table)',
    ),
    "a name that a module lacks": (
        'import names\nsm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", names.Dooo())\n',
        'SM803 sm.add("A", names.Dooo())',
    ),
    "a name that the file lacks": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Dooo())\n',
        'SM803 sm.add("A", Dooo())',
    ),
    "a name that the file and the module of a star import lack": (
        'from names import *\nsm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", Dooo())\n',
        'SM803 sm.add("A", Dooo())',
    ),
    "a state behind the `with` of its container": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Do())\n'
        'smach.StateMachine.add("B", Do())\n',
        'SM808 smach.StateMachine.add("B", Do())',
    ),
    "a key twice": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", Do(), {"ok": "gone", "ok": "ok"})\n',
        'SM804 sm.add("A", Do(), {"ok": "gone", "ok": "ok"})',
    ),
    "a target that does not exist": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Do(), {"ok": "B"})\n',
        'SM101 sm.add("A", Do(), {"ok": "B"})',
    ),
    "a state added twice": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Do())\n'
        '    sm.add("A", Do(), {"ok": "ok"})\n',
        'SM106 sm.add("A", Do(), {"ok": "ok"})',
    ),
    "a state in no path": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Do())\n'
        '    sm.add("B", Do())\n',
        'SM201 sm.add("B", Do())',
    ),
    "a container that runs as a state": (
        'class Run(smach.StateMachine):\n    def __init__(self):\n'
        '        smach.StateMachine.__init__(self, outcomes=["ok"])\n'
        '    def execute(self, userdata):\n        return "okk"\n'
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Run())\n',
        'SM309 return "okk"',
    ),
    "a key that is read in a loop after another condition": (
        'class Loop(smach.State):\n    def __init__(self):\n'
        '        smach.State.__init__(self, outcomes=["ok"], input_keys=["part"])\n'
        '    def execute(self, userdata):\n        if self.preempt_requested():\n'
        '            return "ok"\n        while not vendor.is_shutdown():\n'
        '            print(userdata.part)\n        return "ok"\n'
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Loop())\n',
        'SM301 sm.add("A", Loop())',
    ),
    "a key that a state sets under another name": (
        'class Set(smach.State):\n    def __init__(self):\n'
        '        smach.State.__init__(self, outcomes=["ok"], output_keys=["part"])\n'
        '    def execute(self, userdata):\n        userdata.part = 1\n        return "ok"\n'
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", Set(), {"ok": "B"}, {"part": "other"})\n    sm.add("B", Use())\n',
        'SM301 sm.add("B", Use())',
    ),
    "an outcome that a comment names": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    # smachac: outcomes ok, no\n'
        '    # the arm\n    sm.add("A", vendor.Do(), {"ok": "ok"})\n',
        'SM104 sm.add("A", vendor.Do(), {"ok": "ok"})',
    ),
    "a key that a comment names": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", vendor.Do(),  # smachac: outcomes ok\n'
        '           {"ok": "ok"})  # smachac: input_keys part\n',
        'SM301 sm.add("A", vendor.Do(),  # smachac: outcomes ok',
    ),
    "a key that a state does not set, as a comment says": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    # smachac: outcomes ok\n    # smachac: output_keys other\n'
        '    sm.add("A", vendor.Do(), {"ok": "B"})\n    sm.add("B", Use())\n',
        'SM301 sm.add("B", Use())',
    ),
    "a comment at a state that is known": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", Do())  # smachac: outcomes ok\n',
        'SM022 sm.add("A", Do())  # smachac: outcomes ok',
    ),
    "a comment without names": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
        '    sm.add("A", vendor.Do())  # smachac: outcomes\n',
        'SM022 sm.add("A", vendor.Do())  # smachac: outcomes',
    ),
    "a key that nothing sets": (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Use())\n',
        'SM301 sm.add("A", Use())',
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_work_is_found(name: str, tmp_path: Path) -> None:
    code, expected = WRONG[name]
    assert found(code, tmp_path, names="class Done:\n    pass\n") == [expected]


RIGHT = {
    "containers that other code opens": """
from contextlib import ExitStack, contextmanager

@contextmanager
def opened(sm):
    with sm:
        yield sm

def add(name):
    smach.StateMachine.add(name, Do())

first, second, third = (smach.StateMachine(outcomes=["ok"]) for _ in range(3))
with opened(first):
    add("A")
with vendor.opened(second):
    add("A")
third.open()
add("A")
third.close()
with ExitStack() as stack:
    stack.enter_context(second)
    add("B")
vendor.open(first)
add("B")
""",
    "a first value of the result in a function that handles exceptions": """
class Choose(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok", "no"])
    def execute(self, userdata):
        result = ""
        try:
            vendor.move()
        except vendor.Error:
            pass
        with vendor.lock():
            result = "ok"
        return result
sm = smach.StateMachine(outcomes=["ok", "no"])
with sm:
    sm.add("A", Choose())
sm.execute()
""",
    "a first value of the result that each branch replaces": """
class Choose(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok", "no"])
    def execute(self, userdata):
        result: str = ""
        vendor.prepare()
        if vendor.ready():
            result = "ok"
        else:
            match vendor.mode():
                case 1:
                    print("one")
                    result = "no"
                case _:
                    result = "ok"
        return result
sm = smach.StateMachine(outcomes=["ok", "no"])
with sm:
    sm.add("A", Choose())
sm.execute()
""",
    "a rule of a concurrence about a state that is not known": """
sm = smach.StateMachine(outcomes=["yes", "no"])
with sm:
    both = smach.Concurrence(["yes", "no"], "no", outcome_map={"yes": {"L": "ok"}})
    with both:
        for name in vendor.names():
            smach.Concurrence.add(name, Do())
    sm.add("BOTH", both)
sm.execute()
""",
    "a copy of a dictionary for each state": """
table = {"ok": "done"}
sm = smach.StateMachine(outcomes=["done", "no"])
with sm:
    sm.add("A", Do("ok", "no"), dict(table, no="B"))
    sm.add("B", Do(), table.copy())
""",
    "a name that a module can have that was not found": """
from vendor import *
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Dooo())
""",
    "a name of Python 2, and one that a handler expects to be missing": """
try:
    text = nothing
except NameError:
    text = unicode("A")
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Do() if raw_input() else text)
""",
    "a name that the file binds in another function": """
def prepare():
    global table
    table = {"ok": "ok"}
def build():
    sm = smach.StateMachine(outcomes=["ok"])
    with sm:
        sm.add("A", Do(), table)
""",
    "one value twice": """
sm = smach.StateMachine(outcomes=["ok"])
sm.userdata.b = 1
with sm:
    sm.add("A", Use(), remapping={"part": "b", "part": "b"})
""",
    "a method execute that other code sets": """
class Plan(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])
def run(userdata):
    return "ok"
plan = Plan()
plan.execute = run
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", plan)
sm.execute()
""",
    "a callback whose second parameter gets another value": """
class Node:
    @smach.cb_interface(outcomes=["ok"])
    def call(self, robot):
        robot.count = robot.total
        return "ok"
    def build(self, robot):
        sm = smach.StateMachine(outcomes=["ok"])
        with sm:
            sm.add("A", smach.CBState(self.call, cb_kwargs={"robot": robot}))
        sm.execute()
Node().build(vendor.robot())
""",
    "a key that the values of other keys select": """
class Mode(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok", "no"], input_keys=["mode", "part"])
    def execute(self, userdata):
        mode = userdata.mode
        if mode == 1:
            return "no"
        print(userdata.part)
        return "ok"
sm = smach.StateMachine(outcomes=["ok", "no"])
sm.userdata.mode = 1
with sm:
    sm.add("A", Mode())
sm.execute()
""",
    "a key whose absence is caught": """
class Careful(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok", "no"], input_keys=["part"])
    def execute(self, userdata):
        try:
            part = userdata.part
        except KeyError:
            return "no"
        print(userdata.part, part)
        return "ok"
sm = smach.StateMachine(outcomes=["ok", "no"])
with sm:
    sm.add("A", Careful())
sm.execute()
""",
    "a key that a try sets": """
class Try(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"], input_keys=["part"], output_keys=["part"])
    def execute(self, userdata):
        try:
            userdata.part = vendor.part()
        except vendor.Error:
            print("error")
        print(userdata.part)
        return "ok"
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Try())
sm.execute()
""",
    "a key that a counter selects": """
class Count(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok", "no"], input_keys=["part"], output_keys=["part"])
        self.tries = 0
    def execute(self, userdata):
        self.tries += 1
        if self.tries == 2:
            print(userdata.part)
            return "ok"
        userdata.part = 1
        return "no"
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Count(), {"no": "A"})
sm.execute()
""",
    "outcomes of a concurrence that are not known": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    both = smach.Concurrence(vendor.outcomes(), "no")
    with both:
        smach.Concurrence.add("A", Do())
    sm.add("BOTH", both, {"ok": "ok", "no": "ok"})
sm.execute()
""",
    "a concurrence with the outcomes of an unknown state": """
class Limited(smach.Concurrence):
    def __init__(self, state):
        outcomes = set(state.get_registered_outcomes())
        outcomes.add("late")
        smach.Concurrence.__init__(self, list(outcomes), default_outcome="late",
                                   outcome_map={"ok": {"B": "ok"}})
        with self:
            smach.Concurrence.add("A", state)
            smach.Concurrence.add("B", Do())
""",
    "outcomes that an assignment to a slice changes": """
outcomes = ["ok", "no", "wrong"]
outcomes[:] = [name for name in outcomes if name != "wrong"]
outcomes[1:2] = ["bad"]
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    inner = smach.StateMachine(outcomes)
    with inner:
        inner.add("A", Do("ok", "bad"))
    sm.add("B", inner, {"bad": "ok"})
sm.execute()
""",
    "a key that an unknown attribute selects": """
class Wait(smach.State):
    def __init__(self, time=None):
        smach.State.__init__(self, outcomes=["ok"], input_keys=["time"])
        self.time = time
    def execute(self, userdata):
        print(self.time if self.time else userdata.time)
        return "ok"
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Wait(vendor.Duration(1)))
sm.execute()
""",
    "a key of the name of an attribute that selects": """
class Wait(smach.State):
    def __init__(self, time=None):
        smach.State.__init__(self, outcomes=["ok"], input_keys=["time"], output_keys=["time"])
        self.time = time
    def execute(self, userdata):
        userdata.time = self.time if self.time else userdata.time
        return "ok"
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Wait(2))
sm.execute()
""",
    "a container added twice": """
def inner():
    sm = smach.StateMachine(outcomes=["ok"])
    with sm:
        sm.add("A", Do())
    return sm
again = inner()
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", again, {"ok": "B"})
    sm.add("B", again)
""",
    "userdata under an unknown condition": """
sm = smach.StateMachine(outcomes=["ok"])
if vendor.flag():
    sm.userdata.part = 1
with sm:
    sm.add("A", Use())
""",
    "userdata that other code fills": """
sm = smach.StateMachine(outcomes=["ok"])
vendor.fill(sm.userdata)
with sm:
    sm.add("A", Use())
""",
    "a state of an unknown type that may write": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", vendor.Find(), {"ok": "B"})
    sm.add("B", Use())
""",
    "an unknown name of a state": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add(vendor.name(), Do(), {"ok": "C"})
    sm.add("B", Do())
    sm.add("D", Do(), {"ok": "E"})
""",
    "unknown transitions": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", smach.State(outcomes=["x", "y"]), vendor.table())
    sm.add("B", Do())
""",
    "unknown outcomes of a container": """
sm = smach.StateMachine(outcomes=vendor.outcomes())
with sm:
    sm.add("A", Do(), {"ok": "gone"})
""",
    "a state that unknown code may add": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Do(), {"ok": "B"})
vendor.add_more(sm)
""",
    "a state in one of two instances": """
def build(long):
    sm = smach.StateMachine(outcomes=["ok"])
    with sm:
        sm.add("A", Do(), {"ok": "B" if long else "ok"})
        sm.add("B", Do())
    return sm
build(True)
build(False)
""",
    "an overridden add": """
class Mine(smach.StateMachine):
    @staticmethod
    def add(label, state, **more):
        smach.StateMachine.add(label + "_X", state, **more)
sm = Mine(outcomes=["ok"])
with sm:
    sm.add("A", Do(), transitions={"ok": "B_X"})
    sm.add("B", Do(), transitions={"ok": "ok"})
""",
    "a sequence": """
sm = smach.Sequence(outcomes=["ok", "no"], connector_outcome="ok")
with sm:
    smach.Sequence.add("A", Do("ok", "no"))
    smach.Sequence.add("B", Do("ok", "no"), transitions={"no": "A"})
""",
    "an iterator": """
sm = smach.Iterator(outcomes=["ok", "no"], it=lambda: vendor.items(), it_label="part",
                    exhausted_outcome="ok", input_keys=[], output_keys=[])
with sm:
    inner = smach.StateMachine(outcomes=["next", "no"], input_keys=["part"])
    with inner:
        inner.add("A", Use(), {"ok": "next"})
        inner.set_initial_state(["A"])
    smach.Iterator.set_contained_state("BODY", inner, loop_outcomes=["next"])
""",
    "callbacks of a concurrence": """
def ended(outcomes):
    return outcomes["A"] == "ok"
def result(outcomes):
    return vendor.choose(outcomes)
sm = smach.Concurrence(outcomes=["ok", "no", "other"], default_outcome="no",
                       child_termination_cb=ended, outcome_cb=result)
with sm:
    smach.Concurrence.add("A", Do())
    smach.Concurrence.add("B", Do("ok", "no"))
""",
    "add_auto": """
sm = smach.StateMachine(outcomes=["ok", "no"])
with sm:
    smach.StateMachine.add_auto("A", Do("ok", "no"), connector_outcomes=["ok"])
    smach.StateMachine.add("B", Do())
""",
    "empty targets": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Do(), {"ok": None})
""",
    "a comment in a text": """
TEXT = "# smachac: outcomes done"
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    # smachac: outcomes ok, no
    sm.add("A", vendor.Do("# smachac: outcomes done"), {"ok": "ok", "no": "B"})
    sm.add("B", Use())
""",
    "a suppression": """
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Do())
    # smachac: allow SM201 a test
    sm.add("B", Do())
""",
}  # fmt: skip


@pytest.mark.parametrize("name", RIGHT)
def test_what_can_work_is_no_finding(name: str, tmp_path: Path) -> None:
    assert found(RIGHT[name], tmp_path) == []


def test_files_of_a_repository_do_not_change_each_other(tmp_path: Path) -> None:
    (tmp_path / "names.py").write_text('TARGETS = ["ok"]\n', "utf-8")
    text = (
        'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Do(), {"ok": names.T})'
    )
    text = f"{HEAD}\nimport names\n{text.replace('names.T', 'names.TARGETS[-1]')}\n"
    (tmp_path / "one.py").write_text(f"import names\nnames.TARGETS.append('gone')\n{text}", "utf-8")
    (tmp_path / "two.py").write_text(text, "utf-8")
    project = PythonProject(Disk())
    codes = [
        [item.code for item in project.read(tmp_path / name).report]
        for name in ("one.py", "two.py", "one.py")
    ]
    assert codes == [["SM101"], [], ["SM101"]]


CONTAINER = """
class Part(smach.StateMachine):
    def __init__(self, where):
        {made}
        self.userdata.count = 1
        with self:
            smach.StateMachine.add("USE", {state}, {{"ok": "ok"}})

class Set(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"], output_keys=["part"])

    def execute(self, userdata):
        userdata.part = 1
        return "ok"

def main():
    sm = smach.StateMachine(outcomes=["ok"])
    {before}
    with sm:
        sm.add("PART", Part(vendor.where()), {{"ok": "LAST"}})
        sm.add("LAST", Use())
    sm.execute()

main()
"""

SELECTED = """if where:
            smach.StateMachine.__init__(self, ["ok"])
        else:
            smach.StateMachine.__init__(self, ["ok"], {keys})"""

PRESET = "sm.userdata.part = 1"


@pytest.mark.parametrize(
    ("made", "state", "before", "codes"),
    [
        (SELECTED.format(keys="['part']"), "Use()", PRESET, []),
        (SELECTED.format(keys="vendor.keys()"), "Use()", PRESET, []),
        ('smach.StateMachine.__init__(self, ["ok"], vendor.keys())', "Use()", PRESET, []),
        ('smach.StateMachine.__init__(self, ["ok"], vendor.keys())', "Use()", "", ["SM301"]),
        ('smach.StateMachine.__init__(self, ["ok"], [], vendor.keys())', "Set()", "", []),
        (SELECTED.format(keys="[], ['part']"), "Set()", "", []),
    ],
)
def test_the_keys_of_a_container_are_not_known(
    made: str, state: str, before: str, codes: list[str], tmp_path: Path
) -> None:
    code = CONTAINER.format(made=made, state=state, before=before or "pass")
    assert sorted({item[:5] for item in found(code, tmp_path)}) == codes
    coverage = PythonProject(Disk()).read(tmp_path / "machine.py").coverage
    assert coverage is not None
    assert coverage.unknown == ()


def test_a_fault_of_a_module_belongs_to_each_file_that_imports_it(tmp_path: Path) -> None:
    (tmp_path / "names.py").write_text("import other\nFIRST = other.MISSING\n", "utf-8")
    (tmp_path / "other.py").write_text("import smach\n", "utf-8")
    text = 'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", Do())\n'
    for name in ("one.py", "two.py"):
        (tmp_path / name).write_text(f"{HEAD}\nimport names\n{text}", "utf-8")
    project = PythonProject(Disk())
    places = [
        [(item.code, Path(item.span.source.name).name) for item in project.read(file).report]
        for file in (tmp_path / "two.py", tmp_path / "one.py", tmp_path / "two.py")
    ]
    assert places == [[("SM803", "names.py")]] * 3


def test_a_state_that_a_comment_describes_is_known(tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    text = 'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n    sm.add("A", vendor.Do())'
    path.write_text(f"{HEAD}{text}  # smachac: outcomes ok\n", "utf-8")
    coverage = PythonProject(Disk()).read(path).coverage
    assert coverage is not None
    assert (coverage.states, coverage.exact) == (1, 1)


def test_a_comment_about_a_finding_that_only_all_rules_report_is_used(tmp_path: Path) -> None:
    code = 'sm = smach.StateMachine(outcomes=["ok"])\nwith sm:\n'
    code += '    sm.add("A", Do("ok", "no"), {"no": "A"})  # smachac: allow SM105 it is meant\n'
    assert found(code, tmp_path) == []
    path = tmp_path / "machine.py"
    report = PythonProject(Disk()).read(path, everything=True).report
    assert "SM105" not in {item.code for item in report}


PYTHON_2 = """import smach

class Do(smach.State):
\tdef __init__(self):
\t\tsmach.State.__init__(self, outcomes=["ok"], input_keys=["part"])

\tdef execute(self, userdata):
\t\tprint "Do", userdata.prat, "größer", `userdata.other`
\t\ttry:
\t\t\tuserdata.prt = 1; x = 1 <> 2
\t\texcept ValueError, error: return "k"
\t\treturn "ok"

sm = smach.StateMachine(outcomes=["done"])
with sm:
\tsm.add("A", Do(), transitions={"ok": "doen",
\t\t"okay": "done"})
"""


def test_places_in_python_2_are_those_of_the_code(tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(PYTHON_2, "utf-8")
    report = PythonProject(Disk()).read(path).report
    assert [(item.code, item.span.line, item.span.text) for item in report] == [
        ("SM310", 8, "prat"),
        ("SM310", 8, "other"),
        ("SM309", 11, '"k"'),
        ("SM101", 16, '"doen"'),
        ("SM102", 17, '"okay"'),
    ]


@pytest.mark.parametrize(
    ("code", "line", "message", "help"),
    [
        ('print "a"\nx = = 3\n', 2, "this is valid neither in Python 2 nor in Python 3", "mark"),
        ('print "a"\nx = (1,\n', 3, "this is valid neither in Python 2 nor in Python 3", "bracket"),
        ('print "a"\nif x:\n    y\n  z\n', 4, "this is valid neither in Python 2 nor", "mark"),
        ("x = = 3\n", 1, "this is not valid Python 3: invalid syntax", "mark"),
        ("<<<<<<< HEAD\nx = 1\n", 1, "this is not valid Python 3: invalid syntax", "one version"),
    ],
)
def test_the_first_syntax_error_of_both_versions(
    code: str, line: int, message: str, help: str, tmp_path: Path
) -> None:
    path = tmp_path / "machine.py"
    path.write_text(f"{code}", "utf-8")
    (item,) = PythonProject(Disk()).read(path).report
    assert (item.code, item.span.line) == ("SM805", line)
    assert item.finding.message.startswith(message)
    assert help in (item.finding.help or "")

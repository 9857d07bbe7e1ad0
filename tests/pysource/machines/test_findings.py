"""The findings about machines in Python: SMACH's own traps, and no false alarm where a part is not
known."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.frontend.files import Disk
from smachac.python_machines import PythonProject

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
    "a copy of a dictionary for each state": """
table = {"ok": "done"}
sm = smach.StateMachine(outcomes=["done", "no"])
with sm:
    sm.add("A", Do("ok", "no"), dict(table, no="B"))
    sm.add("B", Do(), table.copy())
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

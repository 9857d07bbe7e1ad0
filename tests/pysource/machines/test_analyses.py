"""The machines of a file by name, each with its own findings and state types."""

from __future__ import annotations

from pathlib import Path

from smachac.driver.python_machines import PythonProject, analyses_by_name
from smachac.frontend.files import Disk

HEAD = """\
import smach

class Do(smach.State):
    def __init__(self, *outcomes, keys=()):
        smach.State.__init__(self, outcomes=list(outcomes) or ["ok"], input_keys=list(keys))

    def execute(self, userdata):
        return "ok"

"""


def test_a_finding_about_no_state_is_on_the_page_of_its_machine(tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(f"""{HEAD}
one = smach.StateMachine(outcomes=["ok"])
with one:
    one.add("A", Do(), {{"ok": "done", "ok": "ok"}})
two = smach.StateMachine(outcomes="ok")
with two:
    two.add("A", Do(), {{"ok": "o"}})
""")
    found = analyses_by_name(PythonProject(Disk()).read(path))
    codes = {name: [item.code for item in analysis.report] for name, analysis in found.items()}
    assert codes == {"one": ["SM804"], "two": ["SM801"]}


def test_variants_of_a_class_are_named_after_what_differs(tmp_path: Path) -> None:
    (tmp_path / "parts.py").write_text(HEAD)
    path = tmp_path / "machine.py"
    path.write_text(f"""{HEAD}
import parts
sm = smach.StateMachine(outcomes=["ok"])
with sm:
    sm.add("A", Do(), {{"ok": "B"}})
    sm.add("B", Do("ok", "no", "a", "b"), dict.fromkeys(["ok", "no", "a", "b"], "C"))
    sm.add("C", Do(keys=["part"]), {{"ok": "D"}})
    sm.add("D", parts.Do(), {{"ok": "E"}})
    sm.add("E", Do())
""")
    (analysis,) = analyses_by_name(PythonProject(Disk()).read(path)).values()
    assert analysis.machine is not None
    types = [child.type for child in analysis.machine.root.children]
    assert types == ["Do", "Do (ok, no, a, ...)", "Do (part)", "Do (parts)", "Do"]

"""What becomes of SMACHA's kind of scripts and templates: the machine that the program builds.

`expected/` has the outlines of the machines, written down from what SMACHA makes of such scripts:
states in the order of the script, transitions, remappings, keys, userdata and outcome maps.
"""

from __future__ import annotations

import ast
import os
import random
import subprocess
import sys
from collections import deque
from pathlib import Path
from types import ModuleType
from unittest.mock import patch

import pytest

import smachac
from smachac import driver
from smachac.commands.cli import main
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.driver import build
from smachac.frontend.files import disk_library
from smachac.frontend.types.state_types import find_state_type
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.runtime import smach
from smachac.targets import load_target
from tests.smacha.smacha_programs import FOLDER, TEMPLATES, machine_of, outline, stand_ins, text_of
from tests.support.golden import compare_file

SCRIPTS = [
    *(
        "callbacks",
        "core",
        "counting",
        "loading",
        "params",
        "recording",
        "ros_states",
        "served",
        "services",
        "two_arms",
    ),
    "whole",
]


@pytest.mark.parametrize("script", SCRIPTS)
def test_golden_outline(script: str) -> None:
    found = outline(machine_of(text_of(script))) + "\n"
    compare_file(found, FOLDER / "expected" / f"{script}.txt")


@pytest.mark.slow
def test_the_same_texts_each_time() -> None:
    code = (
        "import sys; from tests.smacha.smacha_programs import text_of; "
        f"sys.stdout.write('====='.join(map(text_of, {SCRIPTS})))"
    )
    path = str(FOLDER.parents[1])
    texts = {
        subprocess.run(
            [sys.executable, "-c", code], check=True, capture_output=True, text=True,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": path},
        ).stdout
        for seed in ("1", "2")
    }  # fmt: skip
    assert len(texts) == 1
    assert all("Made by smachac" in text[:200] for text in texts.pop().split("====="))


def test_callbacks_run_by_name_and_lambdas_write_their_keys() -> None:
    machine = machine_of(text_of("callbacks"))
    with stand_ins():
        assert machine.execute() == "final"
    assert machine.userdata.animals == ["cats", "dogs", "goat", "ducks", "goat"]
    assert machine.userdata.numbers == [1, 2, 3, 4, 123, 42]


def test_params_come_from_the_call_and_from_the_sub_script() -> None:
    sub = machine_of(text_of("params"))["SUB"]
    states = [(sub[name]._name, sub[name]._outcome) for name in ("FOO_0", "FOO_1")]
    assert states == [("FIRST", "left"), ("SECOND", "right")]


def test_a_class_defined_twice_and_not_alike_is_told() -> None:
    path = FOLDER / "scripts" / "counting.yml"
    report = built_report(path)
    assert [item.code for item in report] == ["SM607"]
    assert [one.span.text for one in report[0].finding.related] == ["FOO", "BAR"]


def test_python_2_is_translated_and_told() -> None:
    report = built_report(FOLDER / "scripts" / "two_arms.yml")
    assert [item.code for item in report] == ["SM606", "SM606"]
    assert [item.span.text for item in report] == [
        "except (KeyError, AttributeError), e:",
        "print 'no such limb: %s' % e",
    ]


def test_calls_in_plain_text_are_code_as_for_smacha() -> None:
    text = text_of("loading")
    assert "Load('cafe_table', rospkg.RosPack().get_path('my_robot')+'/models/x.sdf')" in text
    assert "rospy.on_shutdown(lambda: delete('cafe_table'))" in text
    assert "import rospkg" in text
    assert "from geometry_msgs.msg import Point, Pose" in text


def test_a_program_that_needs_a_node_is_one() -> None:
    assert text_of("loading").count("rospy.init_node") == 1
    assert "rospy.init_node" not in text_of("counting")  # it only logs


def test_a_base_of_the_user_gets_what_its_own_code_needs() -> None:
    text = text_of("served")
    assert text.count("import rospy\n") == 1
    assert "from actionlib import SimpleActionServer\n" in text
    assert "import GoalStatus" not in text  # `import *` brings it
    places = [
        text.index(part) for part in ("  start_node(", "rospy.Service(", "  preempt_at", "execute")
    ]
    assert places == sorted(places)
    for line in ("from my_msgs.srv import Door", "def main():"):
        assert text.count(line) == 1
    machine_of(text)


def test_imports_of_smach_do_without_it() -> None:
    text = text_of("whole")  # its base imports SMACH itself
    tree = ast.parse(text)
    tried = [ast.unparse(statement) for statement in tree.body if isinstance(statement, ast.Try)]
    for name in ("smach", "smach_ros"):
        (found,) = (item for item in tried if f"import {name}\n" in item)
        assert f"from smachac.runtime import {name}" in found
    module = ModuleType("program")
    with patch.dict("sys.modules", dict.fromkeys(("smach", "smach_ros"), None)):  # there is none
        exec("\n".join(tried), module.__dict__)
    assert module.__dict__["smach"] is smach


@pytest.mark.parametrize("given", ["", "outcomes: [a, b]"])
def test_outcomes_that_are_a_default_are_not_all(tmp_path: Path, given: str) -> None:
    (tmp_path / "T.tpl.py").write_text(CHOOSING)
    rest = "transitions: {a: done, b: A}}" if given else "transitions: {c: done}}"
    states = f"states:\n  - A: {{template: T, {given}{', ' if given else ''}{rest}\n"
    (tmp_path / "main.yml").write_text("name: sm\ntemplate: Base\noutcomes: [done]\n" + states)
    analysis = driver.analyse_script(tmp_path / "main.yml", (), (tmp_path,))
    assert analysis.checked is not None, [item.finding.message for item in analysis.report]


CHOOSING = """
{% block class_defs %}
class T(smach.State):
    def __init__(self, input_keys = [], outcomes=['succeeded']):
        smach.State.__init__(self, input_keys=input_keys, outcomes=outcomes)
{% endblock class_defs %}

{% block body %}
smach.{{ parent_type }}.add('{{ name }}', T(), transitions={{ transitions }})
{% endblock body %}
"""


def test_a_state_whose_meta_block_calls_it_a_container(tmp_path: Path) -> None:
    meta = "{% block meta %}\nname: T\ntype: Container\n{% endblock meta %}\n"
    library = disk_library(tmp_path / "main.yml", [], templates=[tmp_path])
    kinds = {}
    for name, body in (("T", "{{ transitions }}"), ("U", "with x:\n    {{ body | indent(4) }}")):
        (tmp_path / f"{name}.tpl.py").write_text(
            f"{meta}{{% block body %}}\n{body}\n{{% endblock %}}"
        )
        kinds[name] = find_state_type(name, library, [])
    assert [kind.kind for kind in kinds.values() if kind is not None] == ["state", "container"]
    assert kinds["T"] is not None
    assert kinds["T"].open  # nothing is told of its outcomes


@pytest.mark.parametrize(
    ("brought", "told"),
    [
        ("", ["speed", "transition"]),
        ("{% include 'Part.tpl.py' %}", ["transition"]),
        ("{% from 'Part.tpl.py' import x %}", ["transition"]),
        ("{% include file_of_the_state %}", []),  # nobody knows what that one uses
    ],
)
def test_variables_that_a_template_does_not_use(
    tmp_path: Path, brought: str, told: list[str]
) -> None:
    body = "{% block body %}\nadd({{ name }}, {{ arm }}){% if fast %}{% endif %}\n{% endblock %}"
    (tmp_path / "T.tpl.py").write_text(f"{brought}\n{body}\n# {{# speed #}} speed\n")
    (tmp_path / "Part.tpl.py").write_text("{% macro x() %}{{ speed }}{% endmacro %}")
    (tmp_path / "main.yml").write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: T, arm: 1, fast: 2, speed: 3, transition: {a: done}}\n"
    )
    analysis = driver.analyse_script(tmp_path / "main.yml", (), (tmp_path,))
    found = [item for item in analysis.report if item.code == "SM003"]
    assert [item.span.text for item in found] == told
    assert all(item.severity is Severity.WARNING for item in found)
    assert not told or found[-1].finding.help == "did you mean `transitions`?"


def test_shared_objects_are_made_once_in_the_function_that_builds() -> None:
    text = text_of("two_arms")
    assert text.count("limbs = dict()") == 1
    assert text.count("class OldMove") == 1
    assert (
        text.index("rospy.init_node") < text.index("limbs = dict()") < text.index("OldMove(limbs)")
    )
    machine = machine_of(text)
    with stand_ins():
        assert machine.execute() == "succeeded"
    states = [machine["MOVE"]["MOVE_1"], machine["MOVE"]["MOVE_2"]["MOVE"], machine["BACK"]]
    assert len({id(state._limbs) for state in states}) == 1
    assert states[0]._limbs == {
        "left": deque([([-0.08, -0.99998, 1.0], 15.0), ([0.5, 0.25], 15.0)]),
        "right": deque([([-0.08, -0.99998, 1.0], 5.0)]),
    }


def test_blocks_go_where_smacha_put_them() -> None:
    text = text_of("recording")
    order = ["import heapq", "class Shared", "class Recorder", "def main",
             "shared_recorder = Shared()", "    sm = ", "footer_of_stop",
             "footer_of_pause", "footer_of_start",
             "before_stop", "before_start", "sm.execute()", "after_stop", "after_start",
             "\nif __name__"]  # fmt: skip
    places = [text.index(part) for part in order]
    assert places == sorted(places)
    assert text.count("class Shared") == text.count("class Recorder") == 1


def test_what_smacha_gave_to_templates() -> None:
    text = text_of("recording")
    (line,) = (line for line in text.splitlines() if "# Recorder" in line and "in IN" in line)
    words = line.split()
    assert len(words[2]) == 32
    assert int(words[2], 16)
    assert "(StateMachine), params {'side': 'left'}" in line


def test_comments_and_introspection_are_printed_when_asked_for() -> None:
    plain, full = text_of("whole"), text_of("whole", comments="yes", introspection="yes")
    for part in ("IntrospectionServer('whole', sm, '/SM')", "rospy.spin()"):
        assert part not in plain
        assert part in full
    ast.parse(full)
    with_server = text_of("recording", introspection="yes")
    assert 'smach_ros.IntrospectionServer("SM", sm, "/SM")' in with_server
    ast.parse(with_server)


def test_options_are_yes_or_no() -> None:
    with pytest.raises(ValueError, match="`comments` must be `yes` or `no`, not `maybe`"):
        text_of("whole", comments="maybe")


def test_a_program_that_is_one_function_runs_and_tells_its_outcome(tmp_path: Path) -> None:
    events: list[dict[str, object]] = []
    result = smachac.run(
        FOLDER / "scripts" / "recording.yml", templates=[TEMPLATES], observe=events.append
    )
    assert result.outcome == "succeeded"
    assert list(result.events) == events
    entered = [event["path"] for event in events if event["event"] == "enter"]
    assert entered == ["SM/START", "SM/IN", "SM/IN/PAUSE", "SM/STOP"]


@pytest.mark.parametrize("script", ["recording", "served", "two_arms", "whole"])
def test_a_program_that_is_one_function_is_verified(
    script: str, capsys: pytest.CaptureFixture[str]
) -> None:
    folders = ["--templates", str(TEMPLATES), "--scripts", str(FOLDER / "scripts")]
    path = str(FOLDER / "scripts" / f"{script}.yml")
    assert main(["verify", path, *folders, "--paths", "20"]) == 0
    assert capsys.readouterr().out.endswith("python: agrees\n")


MAIN = """\
name: sm
template: OwnBase
function_name: Run_It
outcomes: [done]
states:
- A: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
"""


def test_the_main_function_of_a_base_may_be_in_lower_case(tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text(MAIN)
    (tmp_path / "OwnBase.tpl.py").write_text('{% extends "Base.tpl.py" %}\n')
    assert smachac.run(tmp_path / "main.yml", templates=[tmp_path]).outcome == "done"
    assert main(["verify", str(tmp_path / "main.yml"), "--templates", str(tmp_path)]) == 0


@pytest.mark.parametrize(
    ("function", "fault"),
    [
        ("", "the base of the program defines no function `Run_It`"),
        ("def run_it(): pass", "the program runs no state machine"),
    ],
)
def test_a_base_without_a_main_function_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], function: str, fault: str
) -> None:
    (tmp_path / "main.yml").write_text(MAIN)
    (tmp_path / "OwnBase.tpl.py").write_text(f"import smach\n{{{{ class_defs }}}}\n{function}\n")
    words = ["verify", str(tmp_path / "main.yml"), "--templates", str(tmp_path)]
    assert main(words) == 1
    assert fault in capsys.readouterr().err


def test_core_states_do_what_their_names_say(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    machine = machine_of(text_of("core"))
    written: list[str] = []
    delete = machine["DELETE"].execute

    def look_and_delete(userdata: object) -> str:
        written.append((tmp_path / "numbers.csv").read_text("utf-8"))
        outcome: str = delete(userdata)
        return outcome

    machine["DELETE"].execute = look_and_delete
    assert machine.execute() == "succeeded"
    assert written == ["level;word\n1;a\n"]
    assert not (tmp_path / "numbers.csv").exists()
    lines = capsys.readouterr().out.splitlines()
    assert len({"outcome: low", "outcome: high"} & set(lines)) == 1
    assert machine.execute() == "succeeded"
    machine["WRITE"].delimiter = ","
    machine.userdata.file = str(tmp_path / "nowhere" / "numbers.csv")
    assert machine.execute() == "aborted"


def test_functions_are_called_before_a_state_does_its_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = FOLDER.parent / "cases" / "smacha" / "callbacks_first" / "main.yml"
    machine = machine_of(smachac.compile(path, "python")["sm.py"])
    monkeypatch.chdir(tmp_path)
    written: list[str] = []
    delete = machine["DELETE"].execute

    def look_and_delete(userdata: object) -> str:
        written.append((tmp_path / "logs.csv").read_text("utf-8"))
        outcome: str = delete(userdata)
        return outcome

    machine["DELETE"].execute = look_and_delete
    assert machine.execute() == "succeeded"
    assert written == [f"word,tries\naa,{machine.userdata.tries}\n"]
    assert machine.userdata.tries > 0
    assert [path.name for path in tmp_path.iterdir()] == ["smachac.toml"]
    result = run(smachac.load(path), builtin_behaviour())
    assert result.outcome == "succeeded"
    keys = machine.userdata.keys()
    assert result.userdata == {key: machine.userdata[key] for key in keys}


def test_keys_are_conditions_of_outcomes_without_one() -> None:
    path = FOLDER.parent / "cases" / "smacha" / "keys_as_conditions" / "main.yml"
    machine = machine_of(smachac.compile(path, "python")["sm.py"])
    assert machine.execute() == run(smachac.load(path), builtin_behaviour()).outcome == "stopped"


def test_functions_are_called_first_in_cpp_as_well(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(
        "name: sm\noutcomes: [a]\nuserdata: {n: 0}\nstates:\n  - A:\n"
        "      template: RandomOutcomeState\n      outcomes: [a]\n"
        "      input_keys: [n]\n      output_keys: [n]\n"
        "      callbacks: {n: 'lambda ud: ud.n + 1'}\n"
    )
    text = smachac.compile(path, "cpp")["sm.hpp"]
    assert 0 < text.index('run.write("n", ud.n, ') < text.index("draws_.below(1)")


@pytest.mark.parametrize(
    ("type", "action", "keys"),
    [
        ("PublishMsgState", "start", ["msg", "rate", "topic", "x"]),
        ("PublishObserverMsgState", "add", ["msg", "topic", "x"]),
        ("RecordROSBagState", "record", ["file", "topics", "x"]),
    ],
)
def test_states_of_ros_keep_their_keys_beside_those_of_the_script(
    tmp_path: Path, type: str, action: str, keys: list[str]
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(
        "name: sm\noutcomes: [succeeded, aborted]\nuserdata: {x: 1.0, file: a.bag}\nstates:\n"
        f"  - A:\n      template: {type}\n      action: {action}\n      input_keys: [x]\n"
        "      output_keys: [msg, file]\n"
        "      callbacks: {msg: 'lambda ud: [ud.x, 2.0, 3.0]', file: 'lambda ud: str(ud.x)'}\n"
    )
    text = smachac.compile(path, "python")["sm.py"]
    assert sorted(machine_of(text)["A"].get_registered_input_keys()) == keys
    assert "_lambda_cb" not in text
    assert text.count("with_callbacks(") == 2


def test_topics_are_named_after_their_states() -> None:
    machine = machine_of(text_of("ros_states"))
    assert machine["PUBLISH_MSG"].topic == "smacha/publish_msg"
    assert machine["OBS"].topic == "smacha/obs"


def test_rows_of_messages_field_by_field(tmp_path: Path) -> None:
    class Message:
        __slots__ = ("header", "x", "y")

        def __init__(self, x: object, y: object) -> None:
            self.header, self.x, self.y = "seq", x, y

    machine = machine_of(text_of("core"))
    machine.userdata.level = [Message(1, 2), Message(3, Message(4, 5))]
    machine.userdata.data_keys = ["level"]
    machine.userdata.file = str(tmp_path / "rows.csv")
    assert machine["WRITE"].execute(machine.userdata) == "succeeded"
    assert (tmp_path / "rows.csv").read_text() == "level_x;level_y\n1;2\n3;4;5\n"


def test_ros_states_bring_their_imports_once() -> None:
    text = text_of("ros_states")
    imports = [line for line in text.splitlines() if line.startswith(("import", "from"))]
    assert len(imports) == len(set(imports))
    for line in ("import rospy", "from std_msgs.msg import String"):
        assert line in imports
    tree = ast.parse(text)
    names = [node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)]
    assert len(names) == len(set(names))
    services = text_of("services")
    assert "from actionlib.msg import TestAction, TestGoal" in services
    assert "from arm_msgs.srv import MoveGripper" in services


def test_services_and_actions_get_what_the_script_says() -> None:
    machine = machine_of(text_of("services"))
    (name, _, given) = machine["SLOTS"].given
    assert (name, given) == ("gripper_srv", {"request_slots": ["max_effort", "position"]})
    (_, _, given) = machine["CB"].given
    assert given["request_cb"].get_registered_input_keys() == ("gripper_input",)
    assert given["input_keys"] == ["gripper_input"]
    assert set(machine["ACT"].given[2]) == {"goal", "exec_timeout"}


def built_report(path: Path) -> Report:
    """What building says beyond what checking says."""
    analysis = driver.analyse_script(path, (), (TEMPLATES,))
    target = load_target("python")
    assert analysis.checked is not None
    assert analysis.library is not None
    assert target is not None
    report: Report = []
    build(analysis.checked, target, analysis.library, report)
    assert all(item.severity is Severity.WARNING for item in report)
    return report


def draws(path: Path, **seeds: int) -> list[list[str]]:
    """Forty outcomes of each of two random states of a program made anew."""
    lines = [
        f"  - {name}: {{template: RandomOutcomeState, outcomes: [a, b], transitions: {{b: {to}}}"
        + (f", seed: {seeds[name]}}}\n" if name in seeds else "}\n")
        for name, to in (("A", "B"), ("B", "A"))
    ]
    path.write_text("name: sm\noutcomes: [a, b]\nstates:\n" + "".join(lines))
    machine = machine_of(smachac.compile(path, "python")["sm.py"])
    userdata = machine.userdata
    return [[machine[name].execute(userdata) for _ in range(40)] for name in ("A", "B")]


def test_random_states_are_random_unless_they_have_a_seed(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    first, second = draws(path), draws(path)
    assert len({tuple(row) for row in (*first, *second)}) == 4
    seeded = draws(path, A=7, B=7)
    assert seeded[0] == seeded[1] == draws(path, A=7)[0]
    random.seed(3)
    third = draws(path)
    random.seed(3)
    assert draws(path) == third


def test_random_states_of_cpp_are_random_unless_they_have_a_seed(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    for given, printed in (("", "draws_{};"), (", seed: 0", "draws_{0U};")):
        path.write_text(
            "name: sm\noutcomes: [a, b]\nstates:\n"
            f"  - A: {{template: RandomOutcomeState, outcomes: [a, b]{given}}}\n"
        )
        assert f"smachac::Draws {printed}" in smachac.compile(path, "cpp")["sm.hpp"]

"""The import of machines in Python: the files that it writes, its proof, and programs made of its
scripts, which do what the machines in Python do."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.driver.python_machines import Built, PythonProject
from smachac.frontend import schema
from smachac.frontend.files import Disk
from smachac.ir.nodes import Key, Leaf, Node, Outcome
from smachac.pysource.machines import evaluator
from smachac.refactor.equivalence import map_nodes
from smachac.refactor.imports.proof import differences
from tests.conformance.standalone_smach import FOLDER
from tests.pysource.machines.test_no_execution import CODE, MACHINE
from tests.support.examples import every
from tests.support.golden import compare_folder
from tests.support.hostile_python import HOSTILE
from tests.support.import_runs import python3

CASES = Path(__file__).parents[1] / "import_cases"
MACHINES = {
    "actions": "sm", "callbacks": "Waiter().machine", "concurrence": "sm",
    "container_classes": "build()", "functions": "build()",
    "literal": "main()", "loop": "ring()", "modules": "main()", "python2": "@sm", "rare": "sm",
    "subclass": "Tour(None)", "userdata": "sm", "variables": "sm",
}  # fmt: skip
"""The code that makes the machine of each case, as `import_runs.py` takes it."""

RUNS = 200


@pytest.fixture
def case(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Path]:
    """Copies the Python files of a case to a git repository, and makes it the current folder."""

    def copied(name: str) -> Path:
        folder = tmp_path / name
        folder.mkdir()
        for path in (CASES / name).glob("*.py"):
            shutil.copy(path, folder)
        (folder / ".git").mkdir()
        monkeypatch.chdir(folder)
        return folder

    return copied


def written(folder: Path) -> dict[str, str]:
    """The files below a folder, as text."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes().decode()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.mark.parametrize("name", sorted(path.name for path in CASES.iterdir()))
def test_golden_project(
    name: str, case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case(name)
    code = main(["import", "machine.py", "-o", "project"])
    out, err = capsys.readouterr()
    output = {"output.txt": f"{out}{err}exit code {code}\n"}
    compare_folder(written(folder / "project") | output, CASES / name / "expected")


@pytest.mark.parametrize("runtime", ["bundled", pytest.param("SMACH", marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", every(3, list(MACHINES)))
def test_the_program_of_the_script_runs_as_the_machine(
    name: str, runtime: str, case: Callable[[str], Path]
) -> None:
    if runtime == "SMACH" and not FOLDER.exists():
        pytest.skip("standalone-smach is not installed: scripts/setup.sh dev")
    folder = case(name)
    main(["import", "machine.py", "-o", "project", "-q"])
    machine = folder / "machine.py"
    machine.write_text(python3(machine), "utf-8")  # the code of a program has to be Python 3
    assert main(["build", "project/main.yml", "--target", "python", "-o", "out", "-q"]) == 0
    (program,) = (folder / "out").glob("*.py")
    root = Path(__file__).parents[2]
    paths = [folder, folder / "project", root, *([FOLDER] if runtime == "SMACH" else [])]
    done = subprocess.run(
        [sys.executable, root / "tests" / "support" / "import_runs.py", str(RUNS),
         f"machine.py:{MACHINES[name]}", f"{program}:build()"],
        capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert ("standalone-smach" in found["smach"]) is (runtime == "SMACH")
    python, script = found["machines"]
    assert script["structure"] == python["structure"]
    assert script["runs"] == python["runs"]
    assert not any("raised" in outcome for outcome, _ in python["runs"])


# --- the proof


def built(name: str) -> Built:
    """The first machine of a case."""
    machines: list[Built] = []
    PythonProject(Disk()).read(CASES / name / "machine.py", built=machines)
    return machines[0]


def changed(state: str, change: Callable[[Any], Any]) -> Callable[[Node], Node]:
    return lambda node: change(node) if node.name == state else node


def first_edge(node: Node, **fields: object) -> Node:
    step, *others = node.transitions
    return replace(node, transitions=(replace(step, **fields), *others))  # type: ignore[arg-type]


def span(node: Node) -> Any:
    return node.span


CHANGES: dict[str, tuple[str, str, Callable[[Any], Any]]] = {
    "target": ("literal", "DOCK", lambda node: first_edge(node, target="lost")),
    "outcome of a transition": ("literal", "DOCK", lambda node: first_edge(node, outcome="gone")),
    "no transition": ("literal", "CHARGE", lambda node: replace(node, transitions=())),
    "outcome": ("literal", "CHARGE", lambda node: replace(node, outcomes=(
        *node.outcomes, Outcome(name="more", span=span(node))))),
    "input key": ("userdata", "SORT", lambda node: replace(node, inputs=())),
    "optional key": ("userdata", "WEIGH", lambda node: replace(node, inputs=tuple(
        Key(name=key.name, span=key.span) for key in node.inputs))),
    "output key": ("userdata", "WEIGH", lambda node: replace(node, outputs=())),
    "remapping": ("userdata", "WEIGH", lambda node: replace(node, remaps=())),
    "userdata": ("userdata", "sm", lambda node: replace(node, userdata=())),
    "name of a state": ("literal", "DOCK", lambda node: replace(node, name="DOKC")),
    "first state": ("literal", "sm", lambda node: replace(node, initial="CHARGE")),
    "no state": ("functions", "FETCH", lambda node: replace(node, children=node.children[:1])),
    "join": ("concurrence", "EITHER", lambda node: replace(node, join="all")),
    "rule": ("concurrence", "BOTH", lambda node: replace(node, rules=())),
    "default outcome": ("concurrence", "BOTH",
                        lambda node: replace(node, default_outcome="prepared")),
    "loop outcomes": ("rare", "PACK", lambda node: replace(node, loop_outcomes=("halted",))),
    "item": ("rare", "PACK", lambda node: replace(node, item_key="thing")),
    "connector": ("rare", "BOX", lambda node: replace(node, connector_outcome="halted")),
    "kind": ("functions", "FETCH", lambda node: Leaf(
        name=node.name, type="x", outcomes=node.outcomes, transitions=node.transitions,
        span=node.span)),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_the_proof_finds_each_difference(name: str) -> None:
    where, state, change = CHANGES[name]
    graph, constructions = built(where)
    root: Any = graph.machine.root
    if where == "concurrence":  # its callback is decided by rules in a script
        constructions = replace(constructions, callbacks={})
    assert differences(root, root, constructions) == []
    other: Any = map_nodes(root, changed(state, change))
    assert other != root
    assert differences(root, other, constructions) != []


# --- twice, and over other files


def test_importing_twice_gives_the_same_bytes(
    case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case("subclass")
    assert main(["import", "machine.py", "-o", "one"]) == 0
    assert main(["import", "machine.py", "-o", "two"]) == 0
    assert written(folder / "one") == written(folder / "two")
    capsys.readouterr()
    assert main(["import", "machine.py", "-o", "one"]) == 0
    assert "one is up to date\n" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["main.yml", "Visit.yml", "templates/Wait.yml", "smachac.toml"])
def test_an_edited_project_is_not_overwritten(
    name: str, case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case("subclass")
    main(["import", "machine.py", "-o", "project"])
    path = folder / "project" / name
    path.write_text(path.read_text("utf-8") + "# mine\n", "utf-8")
    machine = folder / "machine.py"
    machine.write_text(machine.read_text("utf-8").replace("Wait(2)", "Wait(7)"), "utf-8")
    before = written(folder / "project")
    capsys.readouterr()
    assert main(["import", "machine.py", "-o", "project"]) == 1
    assert written(folder / "project") == before
    assert f"error: project/{name} was edited" in capsys.readouterr().err


def test_a_project_that_was_not_edited_follows_the_machine(case: Callable[[str], Path]) -> None:
    folder = case("subclass")
    main(["import", "machine.py", "-o", "project"])
    machine = folder / "machine.py"
    machine.write_text(machine.read_text("utf-8").replace("Wait(2)", "Wait(7)"), "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 0
    assert "seconds: 7" in (folder / "project/Visit.yml").read_text("utf-8")


def test_files_that_an_import_no_longer_has_are_named(
    case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case("subclass")
    main(["import", "machine.py", "-o", "project"])
    machine = folder / "machine.py"
    machine.write_text(machine.read_text("utf-8").replace("rest=True", "rest=False"), "utf-8")
    capsys.readouterr()
    assert main(["import", "machine.py", "-o", "project"]) == 0
    assert "no longer used: project/Visit_2.yml\n" in capsys.readouterr().out


def test_the_project_of_another_file_is_not_overwritten(
    case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case("subclass")
    main(["import", "machine.py", "-o", "project"])
    other = folder / "other" / "machine.py"
    other.parent.mkdir()
    shutil.copy(CASES / "literal" / "machine.py", other)
    before = written(folder / "project")
    capsys.readouterr()
    assert main(["import", "other/machine.py", "-o", "project"]) == 1
    assert written(folder / "project") == before
    assert "error: project/main.yml was edited, or is no file of" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["file", "link", "folder"])
def test_files_of_others_are_not_touched(
    kind: str, case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case("literal")
    (folder / "project").mkdir()
    other = folder / "project" / "main.yml"
    match kind:
        case "file":
            other.write_text("name: mine\n", "utf-8")
        case "link":
            (folder / "mine.yml").write_text("name: mine\n", "utf-8")
            other.symlink_to(folder / "mine.yml")
        case "folder":
            other.mkdir()
    before = written(folder)
    assert main(["import", "machine.py", "-o", "project"]) == 1
    assert written(folder) == before
    assert "project/main.yml" in capsys.readouterr().err


# --- what cannot be imported


REFUSED = {
    "syntax error": ("import smach\nsm = smach.StateMachine(outcomes=['a'\n", "SM805"),
    "no machine": ("print('hello')\n", "no state machine found in machine.py"),
    "no state": (
        "import smach\nsm = smach.StateMachine(outcomes=['a'])\nsm.execute()\n",
        "machine.py:2:6: `sm` has no states",
    ),
    "unknown name": (
        "import smach, rospy\nsm = smach.StateMachine(outcomes=['a'])\nwith sm:\n"
        "    sm.add(rospy.get_name(), smach.State(outcomes=['a']))\n",
        "machine.py:4:5: its name is not known",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_files(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text, words = REFUSED[name]
    Path("machine.py").write_text(text, "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 1
    err = capsys.readouterr().err
    assert words in err
    assert "help:" in err
    assert not Path("project").exists()


CONDITION = """\
import smach, sys

class Do(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['ok'])

    def execute(self, userdata):
        return 'ok'

sm = smach.StateMachine(outcomes=['ok'])
with sm:
    sm.add('A', Do(), {'ok': 'B' if ('--b' in sys.argv) else 'C'})
    if '--b' in sys.argv:
        sm.add('B', Do(), {'ok': 'C'})
    sm.add('C', Do())
"""


@pytest.mark.parametrize(
    ("value", "proof"), [("true", "3 states, 3 transitions"), ("false", "2 states, 2 transitions")]
)
def test_assumed_conditions(
    value: str, proof: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(CONDITION, "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 1
    assert "--assume" in capsys.readouterr().err
    condition = f'"--b" in sys.argv={value}'
    assert main(["import", "machine.py", "-o", "project", "--assume", condition]) == 0
    assert proof in capsys.readouterr().out


@pytest.mark.parametrize("text", ["x", "x=1", "x y=true", "=true", "'--c' in sys.argv=true"])
def test_wrong_assumptions(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(CONDITION, "utf-8")
    try:
        code = main(["import", "machine.py", "-o", "project", "--assume", text])
    except SystemExit as ended:
        code = int(ended.code or 0)
    assert code == 2
    assert "--assume" in capsys.readouterr().err
    assert not Path("project").exists()


@pytest.mark.parametrize(("arguments", "words"), [
    (["main.yml"], "main.yml is no Python, SCXML or XML file"),
    (["machine.py", "--machine", "Toru"], "machine.py has no machine `Toru`\ndid you mean `Tour`?"),
])  # fmt: skip
def test_wrong_usage(
    arguments: list[str], words: str, case: Callable[[str], Path],
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    case("subclass")
    assert main(["import", *arguments]) == 2
    assert words in capsys.readouterr().err


def test_an_output_that_is_no_folder(
    case: Callable[[str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = case("literal")
    (folder / "project").write_text("mine", "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 1
    assert "project is no folder" in capsys.readouterr().err
    assert (folder / "project").read_text("utf-8") == "mine"


def test_without_a_git_repository_the_folder_of_the_module_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(CASES / "literal" / "machine.py", tmp_path)
    assert main(["import", "machine.py", "-o", "project"]) == 0
    assert "help: set PYTHONPATH=. for the programs" in capsys.readouterr().out
    assert "code" not in (tmp_path / "project/smachac.toml").read_text("utf-8")


def test_a_folder_with_the_modules_of_several_machines_is_named_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    state = "import smach\nclass Work(smach.State):\n    def __init__(self):\n"
    state += "        smach.State.__init__(self, outcomes=['ok'])\n"
    machine = "{0} = smach.StateMachine(outcomes=['done'])\nwith {0}:\n"
    machine += "    smach.StateMachine.add('A', {0}_states.Work(), {{'ok': 'done'}})\n"
    text = "import smach, left_states, right_states\n"
    (tmp_path / "machine.py").write_text(text + machine.format("left") + machine.format("right"))
    for name in ("left_states.py", "right_states.py"):
        (tmp_path / name).write_text(
            state + "    def execute(self, userdata):\n        return 'ok'\n"
        )
    monkeypatch.chdir(tmp_path)
    assert main(["import", "machine.py", "-o", "project"]) == 0
    told = capsys.readouterr().out
    assert told.count("which has the module `left_states` and 1 more, is outside the project") == 1
    assert told.count("PYTHONPATH") == 1


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_files(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", 20_000)
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(HOSTILE[name], "utf-8")
    assert main(["import", "machine.py", "-o", "project", "-q"]) in (0, 1)


@pytest.mark.parametrize("name", CODE)
def test_no_code_is_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    trace = tmp_path / "trace"
    mark = f'open("{trace}", "w")'
    code = CODE[name].format(mark=mark, file=f'"{trace}"')
    Path("machine.py").write_text(f"import smach\n{code}\n{MACHINE}", "utf-8")
    Path("other.py").write_text(f"import smach\n{mark}\n", "utf-8")
    Path("smach.py").write_text(f"{mark}\n", "utf-8")
    main(["import", "machine.py", "-o", "project", "-q"])
    assert Path("project/main.yml").exists()
    assert not trace.exists()


def test_one_object_at_two_places_is_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(
        "import smach\nsm = smach.StateMachine(outcomes=['a'])\none = smach.State(outcomes=['a'])\n"
        "with sm:\n    sm.add('A', one, {'a': 'B'})\n    sm.add('B', one)\n",
        "utf-8",
    )
    main(["import", "machine.py", "-o", "project"])
    found = capsys.readouterr().out
    assert "machine.py:6:5: `B` and `A` are one object, and two in a program\n" in found


ODD_NAMES = ["on", "a: b", "1", "#x", "null", "Grüße", "\U0001f600", "- x", "it's", '"', "`x`"]


def test_odd_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    lines = [
        "import smach", "class Odd(smach.State):", "    def __init__(self):",
        "        smach.State.__init__(self, outcomes=['~', 'yes'])",
        "    def execute(self, userdata):", "        return 'yes'",
        "sm = smach.StateMachine(outcomes=['no'])", "with sm:",
    ]  # fmt: skip
    for name, target in zip(ODD_NAMES, [*ODD_NAMES[1:], "no"], strict=True):
        lines += [f"    sm.add({name!r}, Odd(), {{'~': {target!r}, 'yes': 'no'}})"]
    Path("machine.py").write_text("\n".join(lines) + "\n", "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 0
    assert main(["build", "project/main.yml", "--target", "python", "-o", "out", "-q"]) == 0


@pytest.mark.parametrize("name", ["ma\nchine.py", "mä ch#}.py", "1.py", "main.py", "sm.py"])
def test_odd_file_names(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".git").mkdir()
    shutil.copy(CASES / "callbacks" / "machine.py", tmp_path / name)
    assert main(["import", name, "-o", "project", "-q"]) == 0
    assert main(["build", "project/main.yml", "--target", "python", "-o", "out", "-q"]) == 0
    assert main(["import", name, "-o", "project", "-q"]) == 0


def test_a_name_that_no_script_can_have_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("machine.py").write_text(
        "import smach\nsm = smach.StateMachine(outcomes=['a'])\nwith sm:\n"
        "    sm.add('A/B', smach.State(outcomes=['a']))\n",
        "utf-8",
    )
    main(["import", "machine.py", "-o", "project"])
    assert "error[SM107]: 'A/B' is not a valid name of a state" in capsys.readouterr().err


ARGUMENTS = [
    "1", "-2.5", "1e300", "True", "None", "'a.b'", "'`x`'", "'params'", "['params', 'x']",
    "[['x']]", "{'a': [1, None]}", "{1: 2}", "(1, 'a')", "()", "{1, 2}", "b'x'", "1j",
    "float('inf')", "'line\\nbreak'", "lambda x: x", "LIMITS", "LIMITS[0] + 1", "print",
]  # fmt: skip


CALLS = [
    "arm", "arm, 'x', [arm]", "'x', speed=2", "color='red', arm=arm", "*[1, 2, 3]", "arm, t=arm",
    "LIMITS, 'a b', **{'x': LIMITS}",
]  # fmt: skip

STATES = """\
import smach
LIMITS = object, 2
LIMITS = [2, 3]

class Given(smach.State):
    def __init__(self, value, t=None):
        smach.State.__init__(self, outcomes=['a'])
        self.value = value, t

    def execute(self, userdata):
        return 'a'

class Many(smach.State):
    def __init__(self, *values, **more):
        smach.State.__init__(self, outcomes=['a'])
        self.value = values, more

    def execute(self, userdata):
        return 'a'

def build(arm=None):
    sm = smach.StateMachine(outcomes=['a'])
    with sm:
"""

COMPARED = """\
import importlib, pathlib, sys
from smachac.runtime import smach
sys.modules['smach'] = smach
import given_states
(program,) = pathlib.Path('out').glob('*.py')
found = importlib.import_module(program.stem).build().get_children()
wanted = given_states.build().get_children()

def plain(value):
    if callable(value):
        return 'a function'
    if isinstance(value, list | tuple):
        return type(value), [plain(item) for item in value]
    return type(value), value

assert list(found) == list(wanted) and wanted
for name in wanted:
    assert plain(found[name].value) == plain(wanted[name].value), (name, found[name].value)
"""


NAMED = [
    *schema.VARIABLES, *schema.LONG, "robot", "timeout", "type", "uuid", "class_name", "arguments",
    "body", "parent_name",
]  # fmt: skip
"""Names of parameters that scripts or templates use too."""


@pytest.mark.parametrize(
    "added",
    [
        "".join(
            f"Many({name}='x'), {{'a': 'S{at}'}})\n        sm.add('S{at}', "
            for at, name in enumerate(dict.fromkeys(NAMED))
        )
        + "Many()",
        *(
            f"Given({text}), {{'a': 'B'}})\n        sm.add('B', Given({text}, t=1)"
            for text in ARGUMENTS
        ),
        *(f"Many({text})" for text in CALLS),
    ],
)
def test_arguments_arrive_as_they_were(
    added: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".git").mkdir()
    code = f"{STATES}        sm.add('A', {added})\n    return sm\n"
    Path("given_states.py").write_text(code, "utf-8")
    assert main(["import", "given_states.py", "-o", "project", "-q"]) == 0
    assert main(["build", "project/main.yml", "--target", "python", "-o", "out", "-q"]) == 0
    root = Path(__file__).parents[2]
    paths = os.pathsep.join(map(str, (tmp_path, tmp_path / "project", tmp_path / "out", root)))
    done = subprocess.run(
        [sys.executable, "-c", COMPARED], capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": paths},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr

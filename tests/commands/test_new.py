"""What `smachac new` begins is without a finding, runs, and is never written over; `states`."""

from __future__ import annotations

import json
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.commands.scaffold import BadNameError, file_stem, key_and_type
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import NOWHERE
from smachac.frontend.files import disk_library
from smachac.frontend.schema import CONTAINERS
from smachac.ir.nodes import Checked, Leaf, Machine, Outcome, StateMachine
from smachac.targets import BuildContext, load_target
from tests.support.typed_machines import with_state_types


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my-robot"]) == 0
    monkeypatch.chdir(tmp_path / "my-robot")
    for name in [name for name in sys.modules if name.partition(".")[0] == "robot_states"]:
        monkeypatch.delitem(sys.modules, name)  # that of another test's project
    return tmp_path / "my-robot"


def files(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): path.read_text("utf-8")
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_a_project_is_clean_and_runs(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["check", "--strict"]) == 0
    assert capsys.readouterr().out == "no findings\n"
    assert main(["fmt", "--check", ".", "templates/Greet.yml"]) == 0
    assert main(["build", "main.yml", "--target", "python", "-o", "out"]) == 0
    assert main(["run", "main.yml", "--quiet", "--expect", "succeeded"]) == 0
    assert "off to the door" in capsys.readouterr().out
    assert (project / "out" / "my_robot.py").is_file()


def test_nothing_is_written_over(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "main.yml").write_text("mine")
    (project / "README.md").unlink()
    before = files(project)
    assert main(["new", "."]) == 1
    assert "main.yml exists already: nothing was written" in capsys.readouterr().err
    assert files(project) == before
    assert main(["new", "state", "Grasp"]) == 0
    before = files(project)
    assert main(["new", "state", "Grasp", "--outcome", "other"]) == 1
    assert files(project) == before


@pytest.mark.parametrize("name", ["1st", "---", "Ünë", "with space", "name: x"])
def test_folders_of_any_name(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", f"./{name}"]) == 0
    monkeypatch.chdir(tmp_path / name)
    assert main(["check", "--strict"]) == 0


def test_a_state_type_with_its_code(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--input", "goal=str", "--output", "width=float<m>", "--outcome", "held"]
    assert main(["new", "state", "GraspPart", *words, "--outcome", "lost"]) == 0
    text = (project / "main.yml").read_text()
    text = text.replace("template: ScriptedState           ", "template: GraspPart   ")
    text = text.replace("      outcomes: [there, lost]\n", "").replace("there: ", "held: ")
    (project / "main.yml").write_text(text)
    assert main(["check", "--strict"]) == 0
    assert main(["fmt", "--check", "templates/GraspPart.yml"]) == 0
    assert main(["run", "main.yml", "--quiet", "--expect", "succeeded"]) == 0
    capsys.readouterr()
    assert main(["states", "GraspPart"]) == 0
    told = capsys.readouterr().out
    assert told.startswith("GraspPart: a state (of this project)\n")
    assert "  goal: str\n" in told
    assert "  width: float<m>\n" in told


def test_code_in_another_language(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "state", "Grasp", "--input", "at=Pose"]) == 0
    capsys.readouterr()
    assert main(["new", "state", "Grasp", "--target", "cpp"]) == 0
    assert capsys.readouterr().out == (
        "created include/robot_states/grasp.hpp\n"
        "add to the `code` of templates/Grasp.yml:"
        ' cpp: {header: robot_states/grasp.hpp, class: "robot_states::Grasp"}\n'
    )
    assert (
        "struct In { const smachac::Pose &at; };"
        in files(project)["include/robot_states/grasp.hpp"]
    )


@pytest.mark.parametrize("language", ["python", "cpp"])
@pytest.mark.parametrize(
    ("interface", "code"),
    [
        ("variables: {class: int}\noutcomes: {done: {}}", "SM004"),
        ("outcoms: {done: {}}", "SM003"),
        ("outcomes: [done", "SM001"),
        ("outcomes: 7", "SM004"),
        ("outcomes: {done: {}}\n== smachac.toml ==\nscripts = 7", "SM007"),
    ],
)
def test_no_stub_is_made_for_an_interface_with_errors(
    project: Path, capsys: pytest.CaptureFixture[str], interface: str, code: str, language: str
) -> None:
    text, _, settings = interface.partition("== smachac.toml ==\n")
    Path("templates/Bad.yml").write_text(f"name: Bad\n{text}")
    if settings:
        Path("smachac.toml").write_text(settings)
    before = files(project)
    capsys.readouterr()
    assert main(["new", "state", "Bad", "--target", language]) == 1
    assert f"error[{code}]" in capsys.readouterr().err
    assert files(project) == before


OPEN = 'outcomes: {"*": {}}\n'
DOCS = ['say """ and \\ end', "two\nlines", "*/ ends\\", '"', "\u2028\u202e", "   "]


@pytest.mark.parametrize("doc", DOCS)
def test_a_stub_holds_any_doc(project: Path, doc: str) -> None:
    Path("templates/Odd.yml").write_text(f"name: Odd\ndoc: {json.dumps(doc)}\n{OPEN}")
    for language in ("python", "cpp"):
        assert main(["new", "state", "Odd", "--target", language]) == 0
    compile(Path("robot_states/odd.py").read_text(), "odd.py", "exec")
    header = Path("include/robot_states/odd.hpp").read_text()
    assert header.splitlines()[1] == "#pragma once"
    assert not header.splitlines()[0].endswith("\\")
    assert "enum class Outcome { succeeded };" in header


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["state", "grasp"], "`grasp` is not a name for a state type"),
        (["state", "Gräsp"], "`Gräsp` is not a name"),
        (["state"], "name a folder, as in `new my_robot`"),
        (["a", "b"], "name a folder"),
        (["state", "Grasp", "--input", "a b"], "`a b` is not a name for a key"),
        (["state", "Grasp", "--input", "a=float<"], "`float<` is not a type"),
        (
            ["state", "Grasp", "--input", "a=flaot"],
            "there is no type `flaot`\ndid you mean `float`?",
        ),
        (["state", "Grasp", "--outcome", "no good"], "`no good` is not a name for an outcome"),
        (
            ["state", "Grasp", "--target", "cpp", "--input", "a=pkg/Msg"],
            "C++ cannot express the interface",
        ),
    ],
)
def test_wrong_usage(
    words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["new", *words]) == 2
    assert message in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("taken").write_text("a file")
    assert main(["new", "taken"]) == 1
    assert "cannot write to taken" in capsys.readouterr().err


def test_names_of_files_and_keys() -> None:
    assert [file_stem(name) for name in ("Grasp", "GraspPart", "TF2Listener", "GoToXY")] == [
        "grasp", "grasp_part", "tf2_listener", "go_to_xy",
    ]  # fmt: skip
    assert key_and_type("a=list[int]", {}) == ("a", "list[int]")
    with pytest.raises(BadNameError):
        key_and_type("=int", {})


# --- states


@pytest.mark.slow
def test_every_state_type_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["states", "--format", "json"]) == 0
    every = json.loads(capsys.readouterr().out)
    names = [item["name"] for item in every]
    assert set(CONTAINERS) < set(names)
    assert {"MoveToJointPositionsState", "ScriptedState", "Base"} < set(names)
    assert "Utils" not in names
    assert main(["states"]) == 0
    listed = capsys.readouterr().out
    assert main(["states", "--format", "md"]) == 0
    document = capsys.readouterr().out
    for item in every:
        assert item["doc"], item["name"]
        assert f"\n  {item['name']} " in listed
        assert f"## {item['name']}\n" in document
    for item in every[::5]:
        assert main(["states", item["name"], "--format", "json"]) == 0
        assert json.loads(capsys.readouterr().out) == item
        assert main(["states", item["name"]]) == 0
        told = capsys.readouterr().out
        for part in ("variables", "input_keys", "output_keys", "outcomes"):
            for row in item[part]:
                assert f"\n  {row['name']}" in told


def test_one_state_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["states", "GripperState"]) == 0
    assert capsys.readouterr().out == (
        "GripperState: a state (built-in)\n\nOpens or closes a gripper.\n\nvariables:\n"
        "  limb: str? = null                        Name of the arm; null means the only arm.\n"
        "  command: one_of[open, close] (required)\n\noutput keys:\n"
        "  width: float<m>  Distance between the fingers, in metres.\n\noutcomes:\n  succeeded\n"
        "  aborted    The gripper did not open, or it closed but holds no body.\n  preempted\n\n"
        "It claims gripper.{limb} while it runs.\nIt waits for the outside world.\n"
        "It has code for: cpp, python.\n"
    )


@pytest.mark.parametrize("target_name", ["python", "cpp"])
def test_the_languages_of_a_type_are_those_that_print_it(
    target_name: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Its states may want more than their name, but they are not refused for want of code."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "templates").mkdir()
    for name, code in CODE.items():
        text = f"name: {name}\ndoc: One.\noutcomes: {{done: {{}}}}\ncode: {code}\n"
        (tmp_path / "templates" / f"{name}.yml").write_text(text)
    (tmp_path / "templates" / "InTemplate.tpl.py").write_text("{# a state #}")
    assert main(["states", "--format", "json"]) == 0
    every = json.loads(capsys.readouterr().out)
    library, target = disk_library(Path("main.yml"), []), load_target(target_name)
    assert target is not None
    refused: list[str] = []
    states = [each for each in every if each["kind"] == "state"]
    for each in states:
        state = Leaf(name="A", type=each["name"], outcomes=DONE, span=NOWHERE)
        root = StateMachine(
            name="sm", type="Base", outcomes=DONE, children=(state,), initial="A", span=NOWHERE
        )
        report: Report = []
        machine = with_state_types(Machine(root=root), library)
        target.emit(Checked(machine), BuildContext(library=library), report)
        if any("has no code" in item.finding.message for item in report):
            refused.append(each["name"])
    assert [one["name"] for one in states if target_name not in one["languages"]] == refused
    assert {"InNothing", "InRust"} < set(refused)
    languages = {one["name"]: one["languages"] for one in every}
    assert languages["InRust"] == ["rust"]
    assert languages["Iterator"] == ["cpp", "python"]
    assert languages["Base"] == ["python"]


DONE = (Outcome(name="done", span=NOWHERE),)
CODE = {
    "InBoth": '{python: "a.b:C", cpp: {header: a/b.hpp, class: "a::C"}}',
    "InCpp": '{cpp: {header: a/b.hpp, class: "a::C"}}',
    "InTemplate": "{python: InTemplate.tpl.py}",
    "InNothing": "{}",
    "InRust": "{rust: a::C}",
}


def test_an_unknown_state_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["states", "GriperState"]) == 2
    assert "did you mean `GripperState`?" in capsys.readouterr().err


def test_what_the_user_has_comes_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "Mine.tpl.py").write_text("{% block body %}{% endblock %}")
    (tmp_path / "more" / "SleepState.yml").write_text("name: SleepState\ndoc: Ours.\n")
    assert main(["states", "--templates", "more"]) == 0
    listed = capsys.readouterr().out
    assert re.match(r"state types \(of this project\)\n  Mine\n  SleepState +Ours\.\n", listed)
    assert listed.count("  SleepState ") == 1
    assert main(["states", "Mine", "--templates", "more"]) == 0
    assert "It has no interface" in capsys.readouterr().out


def test_files_name_their_schemas(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "state", "Grasp"]) == 0
    capsys.readouterr()
    for path in ("main.yml", "templates/Greet.yml", "templates/Grasp.yml"):
        first = (project / path).read_text("utf-8").splitlines()[0]
        assert first.startswith("# yaml-language-server: $schema=")
        found = (project / path).parent / first.partition("=")[2]
        assert main(["schema", found.stem]) == 0
        assert found.read_text("utf-8") == capsys.readouterr().out
    for schema in (project / "schemas").iterdir():
        schema.unlink()
    assert main(["new", "state", "Drop"]) == 0
    assert (project / "templates/Drop.yml").read_text("utf-8").startswith("# The interface")


SCRIPT = """\
name: errand
outcomes: [succeeded, aborted, never]
states:
  - ASK: {template: Asks, transitions: {"yes": CARRY, "no": aborted, failed: ASK}}
  - CARRY: {template: Asks, transitions: {"yes": succeeded, "no": aborted, failed: ASK}}
"""


@pytest.fixture
def errand(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "ä folder"
    (folder / "templates").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    (folder / "main.yml").write_text(SCRIPT)
    (folder / "templates" / "Asks.yml").write_text(
        'outcomes: ["yes", "no", failed]\noutput_keys: [answer]\n'
    )
    return folder


def test_scenarios_end_with_the_outcomes_of_the_script(
    errand: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = str(errand / "main.yml")
    assert main(["new", "scenario", script]) == 0
    captured = capsys.readouterr()
    assert "no path was found that ends with `never`" in captured.err
    files = sorted((errand / "scenarios").iterdir())
    assert [path.stem for path in files] == ["aborted", "succeeded"]
    for path in files:
        assert main(["run", script, "--mock", str(path), "--expect", path.stem, "-q"]) == 0
    assert "errand/ASK" in files[1].read_text()
    assert "errand/CARRY" in files[1].read_text()


def test_scenarios_that_exist_are_kept(errand: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = str(errand / "main.yml")
    mine = errand / "scenarios" / "aborted.yml"
    mine.parent.mkdir()
    mine.write_text("mine")
    assert main(["new", "scenario", script]) == 0
    assert "exists already" in capsys.readouterr().err
    assert mine.read_text() == "mine"
    assert main(["new", "scenario", script, "--outcome", "aborted"]) == 1
    assert mine.read_text() == "mine"


def test_scenarios_are_of_outcomes_of_the_script(
    errand: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = str(errand / "main.yml")
    assert main(["new", "scenario", script, "--outcome", "abortd"]) == 2
    assert "did you mean `aborted`" in capsys.readouterr().err
    (errand / "main.yml").write_text("states: [")
    assert main(["new", "scenario", script]) == 1
    assert not (errand / "scenarios").exists()


def test_a_scenario_asks_for_no_stop_without_need(tmp_path: Path) -> None:
    """Of two paths with as many visits, one with a request to stop is not taken."""
    script = tmp_path / "main.yml"
    script.write_text(
        "name: sm\noutcomes: [done, lost]\nstates:\n"
        "  - BOX:\n      template: StateMachine\n      outcomes: [nothing]\n"
        "      transitions: {nothing: CARRY}\n      states:\n"
        "        - A: {template: ScriptedState, outcomes: [found, nothing],"
        " transitions: {found: B, nothing: nothing}}\n"
        "        - B: {template: ScriptedState, outcomes: [there, blocked],"
        " transitions: {there: nothing, blocked: A}}\n"
        "  - CARRY: {template: ScriptedState, outcomes: [there, dropped],"
        " transitions: {there: done, dropped: lost}}\n",
        "utf-8",
    )
    assert main(["new", "scenario", str(script)]) == 0
    texts = [path.read_text("utf-8") for path in sorted(tmp_path.glob("scenarios/*.yml"))]
    assert len(texts) == 2
    assert "stop" not in "".join(texts)


def test_a_pause_ends_as_preempted_after_a_request_to_stop_only(tmp_path: Path) -> None:
    """A run on a robot has no other cause for it; nor has a simulation by clicks."""
    name = "14_delivery_round"
    shutil.copytree(Path(__file__).parents[2] / "examples" / name, tmp_path / name)
    script = tmp_path / name / "main.yml"
    assert main(["new", "scenario", str(script), "--outcome", "preempted"]) == 0
    text = (script.parent / "scenarios" / "preempted.yml").read_text("utf-8")
    assert "PAUSE" not in text
    assert "preempted\n" in text.partition("\n")[2]


def test_a_stub_looks_for_a_request_to_stop(project: Path) -> None:
    assert main(["new", "state", "Grasp", "--outcome", "held", "--outcome", "preempted"]) == 0
    names: dict[str, Any] = {}
    exec(Path("robot_states/grasp.py").read_text("utf-8"), names)
    state = names["Grasp"]()
    assert state.execute(None) == "held"
    state.request_preempt()
    assert (state.execute(None), state.preempt_requested()) == ("preempted", False)
    assert main(["new", "state", "Look"]) == 0
    assert "preempt" not in Path("robot_states/look.py").read_text("utf-8")


def test_a_stub_has_the_types_of_the_project(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    settings = "[types]\nPart = {name = 'str', at = 'Pose?'}\n"
    (tmp_path / "smachac.toml").write_text(settings)
    call = ["new", "state", "Take", "--input", "part=Part", "--output", "all=list[Part]"]
    assert main(call) == 0
    assert "  part: Part\n" in (tmp_path / "templates" / "Take.yml").read_text()
    python = (tmp_path / "robot_states" / "take.py").read_text()
    assert "# userdata.part: Part, which is {name: str, at: Pose?}\n" in python
    assert main([*call, "--target", "cpp"]) == 0
    text = (tmp_path / "include" / "robot_states" / "take.hpp").read_text()
    assert '#include "smachac/types.hpp"\n' in text
    assert "struct In { const smachac::types::Part &part; };" in text
    capsys.readouterr()
    assert main(["new", "state", "Drop", "--input", "part=Prt"]) == 2
    assert "did you mean `Part`?" in capsys.readouterr().err
    assert main(["new", "state", "Drop", "--target", "cpp", "--input", "part={a: int}"]) == 2
    assert "under `[types]` of smachac.toml" in capsys.readouterr().err


def test_a_stub_for_a_stepped_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "smachac.toml").write_text("bounds = {text = 8}\n")
    call = ["new", "state", "Take", "--target", "cpp", "--option", "mode=step"]
    assert main([*call, "--input", "names=list[str]", "--output", "seen=str"]) == 0
    text = (tmp_path / "include" / "robot_states" / "take.hpp").read_text()
    assert "const smachac::step::List<smachac::step::TextOf<8>> &names; }" in text
    assert "smachac::step::Key<smachac::step::Text> &seen; }" in text
    assert "step(smachac::step::Context &context, In in, Out out) {" in text
    capsys.readouterr()
    assert main(["new", "state", "Drop", "--option", "mode=step"]) == 2
    assert "--option is for `--target cpp`" in capsys.readouterr().err
    assert main([*call[:-1], "mode=other"]) == 2
    assert "`mode` must be `blocking` or `step`" in capsys.readouterr().err

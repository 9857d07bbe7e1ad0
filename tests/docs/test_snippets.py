"""The snippets of the pages: all YAML is checked by the compiler, all commands by their parsers."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import jsonschema
import pytest

import smachac
from smachac.commands.cli import COMMANDS, command_line, main
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.files import disk_library
from smachac.frontend.robots.robots import DataKind, check_data_file
from smachac.report.json_schema import scenario_schema
from smachac.robots.files import plain

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/*.md"))]
PAGES += sorted(ROOT.glob("examples/**/README.md"))
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

FRAGMENTS = {
    "checks": 10,
    "cpp": 1,
    "language": 9,
    "properties": 1,
    "robots": 11,
    "ros": 2,
    "scenarios": 5,
    "semantics": 13,
    "state_types": 2,
    "sweep": 2,
    "tutorial": 7,
}
"""Pages whose YAML is completed and checked here, with the number of its blocks."""

OWN_TESTS = {"README", "ci", "existing", "frameworks", "rules"}
"""Pages with YAML for which there are other tests, here or in the files of ELSEWHERE."""

ELSEWHERE = {
    "README": "below",
    "CONTRIBUTING": "tests/checks",
    "api": "tests/pipeline/test_api.py",
    "checks": "tests/docs/test_checks.py",
    "ci": "tests/repository/test_ci_files.py",
    "cpp": "tests/cpp/test_headers.py",
    "cpp_step": "tests/cpp/test_step_example.py",
    "editors": "settings of editors",
    "existing": "tests/docs/test_existing.py",
    "frameworks": "tests/scxml/test_host.py, tests/yasmin, tests/flexbe/test_page.py",
    "properties": "tests/docs/test_properties.py",
    "robots": "tests/docs/test_tutorial.py",
    "ros": "tests/ros, tests/targets/test_ros_2.py",
    "rules": "tests/checks/test_examples.py",
    "scenarios": "tests/docs/test_tutorial.py",
    "semantics": "tests/docs/test_semantics.py",
    "sweep": "tests/docs/test_tutorial.py",
    "targets": "tests/docs/test_targets.py",
    "tutorial": "tests/docs/test_tutorial.py",
    "verify": "tests/docs/test_verify.py, tests/cpp, tests/verify",
}
"""Pages with marked code that other tests run."""

UNSEEN = {"SM007", "SM011", "SM013", "SM018"}
"""Findings on files that the page does not show: sub-scripts, state types, robots."""

SCRIPT = {
    "name": "name: sm\n",
    "params": "params: {battery_topic: battery}\n",
    "outcomes": "outcomes: [succeeded, aborted, stopped, o]\n",
    "states": "states: [{A: {template: ScriptedState, outcomes: [o], transitions: {o: o}}}]\n",
}


OUTCOMES = "outcomes: {o: {}, found: {}, nothing: {failure: true}, succeeded: {}, aborted: {}}\n"


def blocks(page: Path) -> list[tuple[str, str]]:
    """The language and the text of each block of code."""
    return BLOCK.findall(page.read_text("utf-8"))


def completed(text: str) -> str:
    """A whole script: the fragment, and what it leaves out."""
    if text.startswith("- "):
        text = "states:\n" + text
    text = text.replace("states: ...", "states: [{S: {template: ScriptedState, outcomes: [o]}}]")
    return text + "".join(
        line for name, line in SCRIPT.items() if not re.search(rf"^{name}:", text, re.MULTILINE)
    )


def fragments(page: str) -> list[str]:
    return [text for kind, text in blocks(ROOT / "docs" / f"{page}.md") if kind == "yaml"]


def kind_of(page: str, text: str) -> str:
    """What a fragment is a part of, by its page and its top-level fields."""
    fields = re.findall(r"^(\w+):", text, re.MULTILINE)
    for field, kind in (("arms", "robot"), ("parts", "robot"), ("bodies", "scene")):
        if field in fields:
            return kind
    if "faults" in fields:
        return "faults"
    if page == "state_types" or "code" in fields:
        return "interface"
    return "scenario" if re.search(r"^states:(?: \{|\n +\w)", text, re.MULTILINE) else "script"


def wrong_shape(path: Path) -> list[str]:
    """The findings on text, fields, values, types and expressions."""
    found = smachac.check(path)
    return [
        f"{item.code} {item.message}"
        for item in found
        if item.code.startswith("SM0") and item.code not in UNSEEN
    ]


def faults_of_script(text: str, folder: Path) -> list[str]:
    """The findings on a fragment of a script; the state types in it have one outcome."""
    (folder / "templates").mkdir()
    path = folder / "fragment.yml"
    path.write_text(completed(text), "utf-8")
    for missing in [item for item in smachac.check(path) if item.code == "SM013"]:
        name = missing.finding.arguments[0]
        (folder / "templates" / f"{name}.yml").write_text(f"name: {name}\n{OUTCOMES}")
    return wrong_shape(path)


def faults_of_interface(text: str, folder: Path) -> list[str]:
    """The findings on a fragment of an interface, found by a script that uses it; its state
    sets no variable."""
    found = re.search(r"^name: (\w+)$", text, re.MULTILINE)
    whole = text if found else f"name: Other\noutcomes: {{o: {{}}}}\n{text}"
    name = found[1] if found else "Other"
    (folder / "templates").mkdir()
    (folder / "templates" / f"{name}.yml").write_text(whole, "utf-8")
    (folder / "templates" / f"{name}.tpl.py").write_text("")
    use = f"- A: {{template: {name}, transitions: {{o: aborted}}}}\n"
    (folder / "main.yml").write_text(completed(use), "utf-8")
    return [item for item in wrong_shape(folder / "main.yml") if not item.startswith("SM005")]


def faults_of_data(text: str, kind: DataKind, folder: Path) -> list[str]:
    """The findings in a file of a robot, a scene or faults, beside the robots of the page."""
    report: Report = []
    for other, robot in blocks(ROOT / "docs" / "robots.md"):
        if other == "xml":
            (folder / robot.split()[1]).write_text(robot, "utf-8")
    source = Source(str(folder / "fragment.yml"), text)
    check_data_file(source, kind, disk_library(folder, []), report)
    return [f"{item.code} {item.message}" for item in report]


def faults_of_scenario(text: str) -> list[str]:
    """What the schema of scenarios says against a scenario."""
    data = plain(text)
    validator = jsonschema.Draft7Validator(scenario_schema())
    return [error.message for error in validator.iter_errors(data)]


def faults_of(page: str, text: str, folder: Path) -> list[str]:
    """What the compiler says against a fragment of a page."""
    kind = kind_of(page, text)
    if kind in get_args(DataKind):
        return faults_of_data(text, kind, folder)  # type: ignore[arg-type]
    if kind == "interface":
        return faults_of_interface(text, folder)
    return faults_of_scenario(text) if kind == "scenario" else faults_of_script(text, folder)


@pytest.mark.parametrize(
    ("page", "text"), [(page, text) for page in FRAGMENTS for text in fragments(page)]
)
def test_a_fragment_is_valid(page: str, text: str, tmp_path: Path) -> None:
    assert faults_of(page, text, tmp_path) == []


@pytest.mark.parametrize(
    ("page", "text", "words"),
    [
        ("language", "- LOOK: {template: Detect, timeuot: 20s}\n", "SM003 "),
        ("language", "robot: [panda]\n", "SM004 "),
        ("state_types", "variables: {speed: {type: flaot}}\n", "SM017 "),
        ("tutorial", "name: A\noutcomes: {o: {}}\ncode: {pyhton: x}\n", "SM003 "),
        ("robots", "name: r\nurdf: panda.urdf\narms: {arm: {jionts: []}}\n", "SM018 "),
        ("robots", "bodies: {b: {modle: table}}\n", "SM018 "),
        ("robots", "faults: [{kind: gripper_slip, state: A}]\n", "SM018 "),
        ("sweep", "states:\n  FIND: {outcmoe: found}\n", "outcmoe"),
    ],
)
def test_a_wrong_fragment_is_found(page: str, text: str, words: str, tmp_path: Path) -> None:
    assert words in faults_of(page, text, tmp_path)[0]


def test_the_readme_shows_an_example_and_its_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One word of the example is misspelt; the message is the one that `check` prints of it."""
    ((_, fragment),) = [block for block in blocks(ROOT / "README.md") if block[0] == "yaml"]
    _, message, *_ = [text for kind, text in blocks(ROOT / "README.md") if kind != "sh"]
    folder = ROOT / "examples" / "08_pick_and_place"
    script = (folder / "main.yml").read_text("utf-8")
    wrong = script.replace("{succeeded: PLACE_BLOCK,", "{succeeded: PALCE_BLOCK,")
    shown = [re.sub(r" +#.*", "", line) for line in fragment.splitlines()[1:]]
    assert [line for line in shown if line not in wrong.splitlines()] == []
    for path in folder.glob("*.yml"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "main.yml").write_text(wrong, "utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["check", "main.yml"]) == 1
    assert message in capsys.readouterr().out


def test_the_comments_of_the_ci_page_allow_findings(tmp_path: Path) -> None:
    """Nothing is reported with the comments; every code in them is reported without."""
    text = (ROOT / "docs" / "ci.md").read_text("utf-8")
    (states,) = re.findall(r"^  ```yaml\n(.*?)^  ```$", text, re.MULTILINE | re.DOTALL)
    whole = f"{SCRIPT['name']}outcomes: [done]\nstates:\n  - S: {{template: MoveState}}\n{states}"
    (tmp_path / "templates").mkdir()
    types = {"MoveState": "{done: {}}", "WaitForPart": "{seen: {}}\nblocking: true"}
    for name, outcomes in types.items():
        interface = f"name: {name}\noutcomes: {outcomes}\n"
        (tmp_path / "templates" / f"{name}.yml").write_text(interface, "utf-8")
    path = tmp_path / "main.yml"
    path.write_text(whole, "utf-8")
    assert [item.code for item in smachac.check(path) if item.code != "SM105"] == []
    path.write_text(whole.replace("# smachac:", "# "), "utf-8")
    assert {item.code for item in smachac.check(path)} >= set(re.findall(r"SM\d+", states))


def lines() -> Iterator[tuple[str, str]]:
    """Every command `smachac ...` in the code of the pages, with the page."""
    for page in PAGES:
        for kind, text in blocks(page):
            if kind in ("", "sh", "console"):
                prompt = r"\$ " if kind == "console" else ""
                for line in re.findall(rf"^{prompt}(smachac .*)$", text, re.MULTILINE):
                    yield page.name, line


@pytest.mark.parametrize(("page", "line"), sorted(set(lines())))
def test_a_command_is_valid(page: str, line: str) -> None:
    """Its options exist. The shell would take the comment and the redirection."""
    words = shlex.split(line, comments=True)[1:]
    words = words[: next((at for at, word in enumerate(words) if word in (">", "&", "|")), None)]
    if "--" not in words:
        command_line(*COMMANDS).parse_args(words)
    assert words[0] in COMMANDS


def test_a_wrong_command_is_found(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        command_line(*COMMANDS).parse_args(["check", "--no-such-option"])
    assert "unrecognized arguments" in capsys.readouterr().err


def test_every_page_with_code_has_a_test() -> None:
    marked = {page.stem for page in PAGES if any(kind for kind, _ in blocks(page))}
    assert marked == {*ELSEWHERE, *FRAGMENTS}
    assert {page: len(fragments(page)) for page in FRAGMENTS} == FRAGMENTS
    with_yaml = {page.stem for page in PAGES if "yaml" in dict(blocks(page))}
    assert with_yaml == {*FRAGMENTS, *OWN_TESTS}
    named = re.findall(r"tests/[\w/.]+", " ".join(ELSEWHERE.values()))
    assert [name for name in named if not (ROOT / name).exists()] == []

"""The snippets that no test of a page runs: fragments of scripts and interfaces, and commands."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import COMMANDS, command_line

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/*.md"))]
PAGES += sorted(ROOT.glob("examples/**/README.md"))
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

FRAGMENTS = {"language": 9, "state_types": 2}
"""Pages whose YAML is completed and checked here, with the number of its blocks."""

ELSEWHERE = {
    "README": "below",
    "CONTRIBUTING": "tests/checks",
    "api": "tests/pipeline/test_api.py",
    "checks": "tests/docs/test_checks.py",
    "ci": "tests/repository/test_ci_files.py",
    "cpp": "tests/cpp/test_headers.py",
    "editors": "settings of editors",
    "properties": "tests/docs/test_properties.py",
    "robots": "tests/docs/test_tutorial.py",
    "ros": "tests/ros, tests/targets/test_ros_2.py",
    "rules": "tests/checks/test_examples.py",
    "semantics": "tests/docs/test_semantics.py",
    "sweep": "tests/docs/test_tutorial.py",
    "targets": "tests/docs/test_targets.py",
    "tutorial": "tests/docs/test_tutorial.py",
    "verify": "tests/cpp, tests/verify",
}
"""Pages with marked code that other tests run."""

UNSEEN = {"SM007", "SM011", "SM013", "SM018"}
"""Findings on files that the page does not show: sub-scripts, state types, robots."""

SCRIPT = {
    "name": "name: sm\n",
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


def wrong_shape(path: Path) -> list[str]:
    """The findings on text, fields, values, types and expressions."""
    found = smachac.check(path)
    return [
        f"{each.code} {each.message}"
        for each in found
        if each.code.startswith("SM0") and each.code not in UNSEEN
    ]


def faults_of_script(text: str, folder: Path) -> list[str]:
    """The findings on a fragment of a script; the state types in it have one outcome."""
    (folder / "templates").mkdir()
    path = folder / "fragment.yml"
    path.write_text(completed(text), "utf-8")
    for missing in [each for each in smachac.check(path) if each.code == "SM013"]:
        name = missing.finding.arguments[0]
        (folder / "templates" / f"{name}.yml").write_text(f"name: {name}\n{OUTCOMES}")
    return wrong_shape(path)


def faults_of_interface(text: str, folder: Path) -> list[str]:
    """The findings on a fragment of an interface, found by a script that uses it; its state
    sets no variable."""
    whole = text if text.startswith("name:") else f"name: Other\noutcomes: {{o: {{}}}}\n{text}"
    name = whole.split()[1]
    (folder / "templates").mkdir()
    (folder / "templates" / f"{name}.yml").write_text(whole, "utf-8")
    (folder / "templates" / f"{name}.tpl.py").write_text("")
    use = f"- A: {{template: {name}, transitions: {{o: aborted}}}}\n"
    (folder / "main.yml").write_text(completed(use), "utf-8")
    return [each for each in wrong_shape(folder / "main.yml") if not each.startswith("SM005")]


@pytest.mark.parametrize("text", fragments("language"))
def test_a_fragment_of_a_script_is_valid(text: str, tmp_path: Path) -> None:
    assert faults_of_script(text, tmp_path) == []


@pytest.mark.parametrize(
    ("text", "code"),
    [("- LOOK: {template: Detect, timeuot: 20s}\n", "SM003"), ("robot: [panda]\n", "SM004")],
)
def test_a_wrong_fragment_of_a_script_is_found(text: str, code: str, tmp_path: Path) -> None:
    assert faults_of_script(text, tmp_path)[0].startswith(code)


@pytest.mark.parametrize("text", fragments("state_types"))
def test_a_fragment_of_an_interface_is_valid(text: str, tmp_path: Path) -> None:
    assert faults_of_interface(text, tmp_path) == []


def test_a_wrong_fragment_of_an_interface_is_found(tmp_path: Path) -> None:
    text = "variables: {speed: {type: flaot}}\n"
    assert faults_of_interface(text, tmp_path)[0].startswith("SM017")


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
    named = re.findall(r"tests/[\w/.]+", " ".join(ELSEWHERE.values()))
    assert [name for name in named if not (ROOT / name).exists()] == []

"""The concise format, `-o FILE`, `--quiet`, the first step, and the pages of docs/."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from smachac.commands.cli import COMMANDS, command_line, main
from smachac.commands.docs import documentation_pages

WRONG = """\
outcomes: [done]
states:
  - A:
      template: StateMachine
      outcomes: [done]
      transitions: {don: done}
      states: []
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.yml").write_text(WRONG)
    return tmp_path


def test_concise_is_one_line_for_each_finding(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "main.yml", "--format", "concise", "-q"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert all(line.startswith("main.yml:") and line.endswith("]") for line in lines)
    assert any(": error: " in line and line.endswith("[SM102]") for line in lines)
    assert main(["check", "main.yml", "--format", "concise"]) == 1
    *same, summary = capsys.readouterr().out.splitlines()
    assert same == lines
    assert "error" in summary


@pytest.mark.parametrize("form", ["text", "concise", "json", "sarif", "github", "junit"])
def test_a_report_goes_to_a_file(form: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "main.yml", "--format", form]) == 1
    printed = capsys.readouterr().out
    assert main(["check", "main.yml", "--format", form, "-o", "ä b/report.txt"]) == 1
    assert capsys.readouterr().out == ""
    assert Path("ä b/report.txt").read_text("utf-8") == printed


@pytest.mark.parametrize("name", ["main.yml", "x.py", "new.hpp"])
def test_a_report_replaces_no_file_that_a_person_wrote(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path(name).write_text("mine")
    assert main(["check", ".", "-o", name]) == 2
    assert "was not overwritten" in capsys.readouterr().err
    assert Path(name).read_text() == "mine"


def test_a_report_that_cannot_be_written_fails(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["states", "-o", "."]) == 2
    assert "is a folder" in capsys.readouterr().err
    assert main(["states", "-o", "main.yml/report.txt"]) == 1
    assert "main.yml" in capsys.readouterr().err


def test_no_report_is_written_after_wrong_usage() -> None:
    Path("old.txt").write_text("old")
    assert main(["states", "NoSuchType", "-o", "old.txt"]) == 2
    assert Path("old.txt").read_text() == "old"


def test_watching_writes_no_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "main.yml", "--watch", "-o", "x.txt"]) == 2
    assert "--watch" in capsys.readouterr().err


def test_md_and_markdown_are_one_format(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["states", "--format", "md"]) == 0
    short = capsys.readouterr().out
    assert main(["states", "--format", "markdown"]) == 0
    assert capsys.readouterr().out == short


def test_each_command_with_a_format_has_an_output() -> None:
    for name in COMMANDS:
        parser = next(
            action.choices[name]  # type: ignore[index]
            for action in command_line(name)._actions
            if action.dest == "command"
        )
        options = parser._option_string_actions
        assert ("--format" not in options) or ("-o" in options), name


@pytest.mark.parametrize(
    "words",
    [
        ["build", "main.yml", "--target", "dot", "-o", "out"],
        ["fmt", "main.yml"],
        ["rename", "main.yml", "GREET", "HELLO"],
        ["check", "main.yml"],
    ],
)
def test_quiet_prints_nothing_without_findings(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", "demo", "-q"]) == 0
    monkeypatch.chdir("demo")
    code = main([*words, "-q"])
    captured = capsys.readouterr()
    assert (code, captured.out, captured.err) == (0, "", "")


def test_the_first_step_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([]) == 2
    assert "smachac check " in capsys.readouterr().err
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    assert main([]) == 2
    assert "smachac new " in capsys.readouterr().err
    assert main(["check"]) == 2
    assert "smachac new " in capsys.readouterr().err


def test_pages_are_listed_and_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["docs"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert listed == list(documentation_pages())
    assert "language" in listed
    for word in ("language", "language.md", os.path.join("docs", "language.md")):  # noqa: PTH118
        assert main(["docs", word]) == 0
        assert capsys.readouterr().out == documentation_pages()["language"].read_text("utf-8")
    assert main(["docs", "langauge"]) == 2
    assert "did you mean `language`" in capsys.readouterr().err

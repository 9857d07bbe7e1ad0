"""The command `check` over folders, changes, baselines, and again and again."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

import smachac
from smachac.commands.cli import main
from smachac.diagnostics import baseline
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend import files
from smachac.frontend.text.yaml_tree import Tree, parse

HEAD = "template: Base\noutcomes: [done]\nuserdata: {block: red}\noutput_keys: [block]\nstates:\n"
PICK = "  - PICK: {script: pick, transitions: {ok: done}}\n"
SUB = """\
- PICK:
    template: StateMachine
    outcomes: [ok]
    input_keys: [block]
    states:
      - GRASP: {template: ScriptedState, outcomes: [ok], input_keys: [block], transitions: {ok: ok}}
      - LOST: {template: ScriptedState, outcomes: [ok], transitions: {ok: ok}}
"""
UNSEEN = {
    ".hidden/main.yml": "name: x\nstates: 1\n",
    ".pre-commit-config.yaml": "repos: []\n",
    "templates/Grasp.yml": "name: Grasp\noutcomes: {ok: {}}\n",
    "scenario.yml": "states:\n  PICK: aborted\n",
    "playbook.yml": "- hosts: all\n  tasks: []\n",
    "notes.txt": "states:\nname: x\n",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two scripts that share a sub-script with a fault, one that nobody calls, and other files."""
    texts = {
        **UNSEEN,
        "main.yml": f"name: a\n{HEAD}{PICK}",
        "pick.yml": SUB,
        "deep/er/main.yaml": f"name: b\n{HEAD}{PICK}",
        "deep/er/pick.yml": "- PICK: {template: ScriptedState, outcomes: [ok]}\n",
        "other.yml": f"name: c\n{HEAD}{PICK}",
        "lone.yml": SUB.replace("PICK:", "ALONE:").replace("ok]}", "[params, x]]}"),
    }
    write(tmp_path, texts)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder: Path, texts: dict[str, str]) -> None:
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def lines(shown: str) -> list[str]:
    """Code and place of each finding of a report as text."""
    rows = shown.splitlines()
    return [
        f"{row.partition('[')[2][:5]} {rows[at + 1].partition('> ')[2]}"
        for at, row in enumerate(rows)
        if row.startswith(("error[", "warning["))
    ]


def test_a_folder_is_every_script_in_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check"]) == 1
    by_folder = capsys.readouterr().out
    assert lines(by_folder) == ["SM201 lone.yml:7:9", "SM201 pick.yml:7:9"]
    assert by_folder.endswith("2 errors in 2 files; 4 scripts checked\n")
    assert main(["check", "deep"]) == 0
    assert capsys.readouterr().out == "no findings\n"
    assert main(["check", "*.yml", "deep/**/*.yaml"]) == 1  # patterns take what they are given
    assert "playbook.yml" in capsys.readouterr().out


def test_the_project_says_what_is_no_script(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "smachac.toml").write_text('exclude = ["deep/*", "lone.yml", "other.yml"]\n')
    assert main(["check", "--format", "junit", "."]) == 1
    suite = ET.fromstring(capsys.readouterr().out)[0]
    assert [test.get("name") for test in suite] == ["main.yml"]
    assert main(["check", "deep"]) == 2
    assert "there is no script in `deep`" in capsys.readouterr().err
    assert main(["check", "deep/er/main.yaml"]) == 0


def test_what_is_broken_is_still_a_script(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "deep" / "er" / "main.yaml").write_text("name: b\nstates:\n  - [\n")
    (folder / "deep" / "binary.yml").write_bytes(b"name: \xff\n")
    assert main(["check", "deep"]) == 1
    assert [line[:5] for line in lines(capsys.readouterr().out)] == ["SM007", "SM001"]


def test_sub_scripts_are_read_once(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    parsed: list[str] = []

    def counted(source: Source, report: Report) -> Tree | None:
        parsed.append(source.name)
        return parse(source, report)

    monkeypatch.setattr(files, "parse_with_recovery", counted)
    assert main(["check", "main.yml", "other.yml", "deep"]) == 1
    assert len(parsed) == len(set(parsed))
    assert {"pick.yml", "main.yml", "other.yml"} <= set(parsed)
    assert lines(capsys.readouterr().out) == ["SM201 pick.yml:7:9"]


def test_a_sub_script_alone_has_no_caller_to_blame(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "lone.yml", "--format", "json"]) == 1
    report = json.loads(capsys.readouterr().out)
    (item,) = report["diagnostics"]
    places = {one["place"]["file"] for one in item["related"]}
    assert item["code"] == "SM201"
    assert places <= {"lone.yml"}
    write(folder, {"a.yml": "- A: {script: b}\n", "b.yml": "- B: {script: a}\n"})
    assert main(["check", "a.yml", "b.yml"]) == 1
    assert "calls itself" in capsys.readouterr().out
    write(folder, {"a.yml": "- A: {script: deep/er/pick}\n"})
    assert main(["check", "a.yml", "deep/er/pick.yml", "--format", "junit"]) == 0
    suite = ET.fromstring(capsys.readouterr().out)[0]
    assert [test.get("name") for test in suite] == ["a.yml"]


def test_an_allowance_in_a_shared_sub_script_serves_one_caller(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    allowed = SUB.replace("LOST:", "LOST:  # smachac: allow SM201 by hand, SM204 x\n         ")
    write(folder, {"pick.yml": allowed.replace("hand, SM204 x", "hand")})
    assert main(["check", "main.yml", "other.yml", "--strict"]) == 0
    write(folder, {"pick.yml": allowed.replace("SM201 by hand, ", "SM201, ")})
    capsys.readouterr()
    assert main(["check", "main.yml", "--strict"]) == 0
    assert main(["check", "main.yml", "other.yml", "--strict"]) == 1
    assert capsys.readouterr().out.count("SM204 is allowed here") == 1


def test_a_baseline_knows_what_was_there(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "main.yml", "--baseline", "b.json", "--write-baseline"]) == 0
    assert json.loads((folder / "b.json").read_text())["findings"][0]["code"] == "SM201"
    text = SUB.replace("states:", "states:\n      # moved\n")
    write(folder, {"pick.yml": text})
    capsys.readouterr()
    assert main(["check", "main.yml", "other.yml", "--baseline", "b.json"]) == 0
    assert capsys.readouterr().out == "no findings; 2 scripts checked (1 in the baseline)\n"
    lost = "      - LOST2: {template: ScriptedState, outcomes: [ok], transitions: {ok: ok}}\n"
    write(folder, {"pick.yml": text + lost})
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 1
    assert lines(capsys.readouterr().out) == ["SM201 pick.yml:10:9"]
    write(folder, {"pick.yml": "- PICK: {template: ScriptedState, outcomes: [ok]}\n"})
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 0
    assert capsys.readouterr().out == "no findings (1 of the baseline no longer found)\n"


def test_a_baseline_holds_no_firm_error(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder, {"main.yml": f"name: a\n{HEAD}{PICK}".replace("ok: done", "ok: don")})
    assert main(["check", "main.yml", "--baseline", "b.json", "--write-baseline"]) == 0
    told = capsys.readouterr().out
    assert told.endswith("; 1 error is not in it, because no program can be generated\n")
    known = json.loads((folder / "b.json").read_text())
    assert "SM101" not in {item["code"] for item in known["findings"]}
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 1
    assert "SM101" in {line.split()[0] for line in lines(capsys.readouterr().out)}


def test_a_firm_error_in_a_baseline_is_reported(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(folder, {"main.yml": f"name: a\n{HEAD}{PICK}".replace("ok: done", "ok: don")})
    report = [item for item in smachac.check("main.yml") if item.code == "SM101"]
    assert report
    (folder / "b.json").write_text(baseline.render(report))
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 1
    shown = capsys.readouterr().out
    assert "SM101" in {line.split()[0] for line in lines(shown)}
    assert "no longer found" not in shown


@pytest.mark.parametrize("text", [None, "{", "[]", '{"version": 1}', '{"version": 2}', "[" * 9999])
def test_what_is_no_baseline_is_wrong_usage(
    text: str | None, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if text is not None:
        (folder / "b.json").write_text(text)
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 2
    assert "--baseline b.json: " in capsys.readouterr().err
    assert main(["check", "main.yml", "--write-baseline"]) == 2


def test_an_old_baseline_is_refused_with_the_remedy(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "b.json").write_text('{"version": 1, "findings": []}')
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 2
    error = capsys.readouterr().err
    assert "has version 1, but versions 2 to 3 are read" in error
    assert "run `smachac check` with `--write-baseline`" in error
    assert main(["check", "main.yml", "--baseline", "b.json", "--write-baseline"]) == 0
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 0


def test_a_baseline_of_the_last_version_is_read(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Version 2 knew other arguments for some findings: there, the code and the file count."""
    assert main(["check", "main.yml", "--baseline", "b.json", "--write-baseline"]) == 0
    data = json.loads((folder / "b.json").read_text())
    data |= {"version": 2}
    data["findings"][0] |= {"fingerprint": "0123456789abcdef"}
    (folder / "b.json").write_text(json.dumps(data))
    capsys.readouterr()
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 0
    words = "the baseline is of an older version: write it again with --write-baseline"
    assert capsys.readouterr().out == f"no findings (1 in the baseline, {words})\n"
    lost = "      - LOST2: {template: ScriptedState, outcomes: [ok], transitions: {ok: ok}}\n"
    write(folder, {"pick.yml": SUB + lost})
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 1
    assert len(lines(capsys.readouterr().out)) == 1
    (folder / "b.json").write_text(json.dumps(data | {"version": 3}))
    assert main(["check", "main.yml", "--baseline", "b.json"]) == 1
    assert len(lines(capsys.readouterr().out)) == 2


def git(*words: str) -> None:
    names = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
    subprocess.run(["git", *names, *words], check=True, capture_output=True)


def changed(capsys: pytest.CaptureFixture[str], revision: str = "HEAD") -> list[str]:
    main(["check", ".", "--changed-since", revision, "--format", "junit"])
    suite = ET.fromstring(capsys.readouterr().out)[0]
    return [test.get("name", "") for test in suite]


def test_scripts_of_changed_files(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    git("init", "-q", "-b", "main")
    git("add", ".")
    git("commit", "-qm", "x")
    assert changed(capsys) == []
    assert main(["check", "--changed-since", "HEAD"]) == 0
    assert capsys.readouterr().out == "no findings; 0 scripts checked\n"
    write(folder, {"pick.yml": SUB + "# a word\n"})
    assert changed(capsys) == ["main.yml", "other.yml"]
    git("checkout", "-q", "-b", "work")
    git("commit", "-qam", "y")
    assert changed(capsys, "main") == ["main.yml", "other.yml"]
    git("checkout", "-q", "main")
    write(folder, {"lone.yml": "- A: {template: ScriptedState, outcomes: [ok]}\n"})
    git("commit", "-qam", "z")  # what others did since is not ours
    git("checkout", "-q", "work")
    assert changed(capsys, "main") == ["main.yml", "other.yml"]
    (folder / "deep" / "er" / "pick.yml").unlink()
    (folder / "deep" / "er" / "templates").mkdir()
    assert changed(capsys) == ["deep/er/main.yaml"]
    # A new template that a script looks for in vain, or overrides a built-in one.
    write(folder, {"templates/ScriptedState.yml": "name: ScriptedState\n"})
    assert "main.yml" in changed(capsys)


def test_git_has_its_own_mind(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(folder.parent))
    assert main(["check", "main.yml", "--changed-since", "HEAD"]) == 2
    assert "not a git repository" in capsys.readouterr().err
    git("init", "-q")
    assert main(["check", "main.yml", "--changed-since=--output=x"]) == 2
    assert "the git repository has no commits" in capsys.readouterr().err
    git("commit", "-q", "--allow-empty", "-m", "x")
    assert main(["check", "main.yml", "--changed-since=--output=x"]) == 2
    assert "git has no revision `--output=x`" in capsys.readouterr().err
    monkeypatch.setenv("PATH", str(folder))
    assert main(["check", "main.yml", "--changed-since", "HEAD"]) == 2
    assert "git does not run" in capsys.readouterr().err


def test_watching_checks_at_every_change(folder: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "smachac", "check", "deep", "main.yml", "--watch"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None

    def summary() -> str:
        """What the round says at its end; read until it waits."""
        last = ""
        for line in process.stdout or ():
            if line.startswith("watching"):
                return last
            last = line.strip("\n") and line
        raise AssertionError(process.communicate()[1])

    try:
        assert summary() == "1 error in pick.yml; 2 scripts checked\n"
        write(folder, {"pick.yml": "- PICK: {template: ScriptedState, outcomes: [ok]}\n"})
        assert summary() == "no findings; 2 scripts checked\n"
        write(folder, {"deep/new.yml": f"name: d\n{HEAD}{PICK}"})
        assert summary() == "1 error in deep/new.yml; 3 scripts checked\n"
        write(folder, {"deep/pick.yml": "- PICK: {template: ScriptedState, outcomes: [ok]}\n"})
        assert summary() == "no findings; 3 scripts checked\n"
        (folder / "deep" / "pick.yml").replace(folder / "deep" / "x.yml")
        assert "error" in summary()
        (folder / "smachac.toml").write_text('exclude = ["deep/*"]')
        assert summary() == ""
        (folder / "smachac.toml").unlink()
        assert "error" in summary()
    finally:
        process.send_signal(signal.SIGINT)
        told = process.communicate(timeout=60)[1]
    assert told.endswith("there is no script in `deep`\ninterrupted\n")
    assert process.returncode == 130


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_watching_prints_one_document_a_line(folder: Path, form: str) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "smachac", "check", "main.yml", "--watch", "--format", form],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    out, notices = process.stdout, process.stderr
    assert out is not None
    assert notices is not None

    def document() -> dict[str, object]:
        """What is printed in a round, after whose end the files are watched."""
        while not notices.readline().startswith("watching"):
            assert process.poll() is None
        found = json.loads(out.readline())
        assert isinstance(found, dict)
        return found

    try:
        first = document()
        write(folder, {"pick.yml": "- PICK: {template: ScriptedState, outcomes: [ok]}\n"})
        second = document()
    finally:
        process.send_signal(signal.SIGINT)
        rest = process.communicate(timeout=60)[0]
    assert first != second
    assert first.keys() == second.keys()
    assert rest == ""


def test_notes_are_shown_if_wanted(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "noted.yml").write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\n"
        "states:\n  - A: {template: ScriptedState, outcomes: [done]}\n"
    )
    assert main(["check", "noted.yml"]) == 0
    assert capsys.readouterr().out == "1 note in noted.yml (--notes shows notes)\n"
    assert main(["check", "noted.yml", "--notes"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("info[SM105]: ")
    assert shown.endswith("\n1 note in noted.yml\n")
    assert main(["check", "noted.yml", "--format", "github", "--notes"]) == 0
    assert capsys.readouterr().out.startswith("::notice ")

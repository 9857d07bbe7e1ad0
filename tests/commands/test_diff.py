"""The command `diff`: two files, git revisions, formats, exit codes."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done, lost]
states:
  - PICK: {template: Grasp, speed: 1.0, transitions: {done: PARK, lost: lost}}
  - PARK: {script: park, transitions: {done: done}}
"""
GRASP = "name: Grasp\nvariables: {speed: {type: float}}\noutcomes: {done: {}, lost: {}}\n"
PARK = """\
- PARK:
    template: StateMachine
    outcomes: [done]
    states:
      - HOME: {template: ScriptedState, outcomes: [done]}
"""
CHANGED = SCRIPT.replace("lost: lost", "lost: PARK").replace("1.0", "0.5")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a project, the current one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "templates").mkdir()
    write("main.yml", SCRIPT)
    write("park.yml", PARK)
    write("templates/Grasp.yml", GRASP)
    return tmp_path


def write(name: str, text: str) -> None:
    Path(name).write_text(text, "utf-8")


def git(*words: str) -> str:
    names = ("-c", "user.name=x", "-c", "user.email=x@example.org")
    done = subprocess.run(["git", *names, *words], check=True, capture_output=True, text=True)
    return done.stdout


def commit() -> None:
    git("init", "-q", "-b", "main")
    git("add", ".")
    git("commit", "-qm", "x")


def diff(*words: str) -> int:
    return main(["diff", *words])


def test_two_files(capsys: pytest.CaptureFixture[str]) -> None:
    write("new.yml", CHANGED)
    assert diff("main.yml", "main.yml") == 0
    assert capsys.readouterr().out == ""
    assert diff("main.yml", "new.yml") == 1
    assert capsys.readouterr().out == (
        "main.yml -> new.yml: 1 transition changed, 1 value changed, 1 new finding\n"
        "  ~ state sm/PICK\n"
        "      ~ variable speed: 1.0 -> 0.5\n"
        "      ~ transition lost: outcome lost -> PARK\n"
        "  + warning[SM203] `sm` can never end with its outcome `lost` (new.yml:3:18)\n"
    )


def test_what_changed_since_a_commit(capsys: pytest.CaptureFixture[str]) -> None:
    """Sub-scripts and interfaces of the revision are read, too."""
    commit()
    assert diff("main.yml") == 0
    write("park.yml", PARK.replace("HOME", "DOCK"))
    write("templates/Grasp.yml", GRASP.replace("lost: {}", "lost: {failure: true}"))
    status = git("status", "--porcelain")
    index = Path(".git/index").read_bytes()
    assert diff("main.yml") == 1
    assert capsys.readouterr().out == (
        "main.yml: 1 state renamed, 1 outcome changed\n"
        "  same behaviour: every run goes through the same states, whatever their names and"
        " nesting\n"
        "  ~ state sm/PICK\n"
        "      ~ outcome lost: nothing -> failure\n"
        "  ~ state sm/PARK/DOCK: renamed from sm/PARK/HOME\n"
    )
    assert Path(".git/index").read_bytes() == index
    assert git("status", "--porcelain") == status
    assert git("worktree", "list").count("\n") == 1


def test_two_revisions_and_a_folder_inside(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    write("new.yml", SCRIPT)
    commit()
    write("main.yml", CHANGED)
    Path("new.yml").unlink()
    write("other.yml", SCRIPT)
    git("add", "-A")
    git("commit", "-qm", "y")
    write("main.yml", "broken: [")
    monkeypatch.chdir("templates")
    assert diff("..", "--from", "HEAD~1", "--to", "HEAD") == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if line and not line.startswith(" ")] == [
        "../main.yml: 1 transition changed, 1 value changed, 1 new finding",
        "../other.yml: new script",
        "../new.yml: removed script",
    ]


@pytest.mark.parametrize("words", [["main.yml"], ["--from", "HEAD"], ["main.yml", "--to", "x"]])
def test_without_git_or_a_revision(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    if "x" in words:
        commit()
    assert diff(*words) == 2
    assert capsys.readouterr().err.startswith("smachac: error: ")


def test_a_script_that_does_not_exist(capsys: pytest.CaptureFixture[str]) -> None:
    commit()
    assert diff("no.yml") == 2
    assert "there is no script in `no.yml`" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["name: [\n", "just a text\n", ""])
def test_a_script_that_cannot_be_read(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    write("new.yml", text)
    assert diff("main.yml", "new.yml") == 1
    done = capsys.readouterr()
    assert "error[SM0" in done.err
    head = "main.yml -> new.yml: not compared, because it cannot be read"
    assert done.out.splitlines()[0] == head
    for form in ("markdown", "json", "dot"):
        assert diff("new.yml", "main.yml", "--format", form) == 1


def test_findings(capsys: pytest.CaptureFixture[str]) -> None:
    write("new.yml", SCRIPT.replace("done: PARK", "done: PRAK"))
    assert diff("main.yml", "new.yml", "--format", "json") == 1
    (found,) = json.loads(capsys.readouterr().out)["scripts"]
    assert (found["before"], found["after"], found["equal"]) == ("main.yml", "new.yml", False)
    assert [item["code"] for item in found["findings"]["added"]][:1] == ["SM101"]
    (change,) = found["changes"]
    assert change == {
        "change": "changed",
        "what": "transition",
        "path": "sm/PICK",
        "was": "sm/PICK",
        "name": "done",
        "before": "PARK",
        "after": "outcome PRAK",
        "place": "new.yml:5:5",
    }


def test_markdown(capsys: pytest.CaptureFixture[str]) -> None:
    write("new.yml", SCRIPT.replace("PICK", '"P|<b>*x*"').replace("lost: lost", "lost: PARK"))
    assert diff("main.yml", "new.yml", "--format", "markdown") == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[:7] == [
        "### main.yml -> new.yml",
        "",
        "1 state renamed, 1 transition changed, 1 new finding.",
        "",
        "|  | state | what | before | after |",
        "| --- | --- | --- | --- | --- |",
        r"| renamed | sm/P\|\<b>\*x\* | state | sm/PICK | sm/P\|\<b>\*x\* |",
    ]
    assert diff("main.yml", "main.yml", "--format", "markdown") == 0
    assert capsys.readouterr().out == "No difference in the state machines.\n"


def test_a_picture(capsys: pytest.CaptureFixture[str]) -> None:
    text = CHANGED.replace("  - PARK:", "  - WAIT: {template: SleepState, time: 1.0}\n  - PARK:")
    write("new.yml", text.replace("script: park", "template: ScriptedState, outcomes: [done]"))
    assert diff("main.yml", "new.yml", "--format", "dot") == 1
    drawn = capsys.readouterr().out
    box = {line.split()[0]: line for line in drawn.splitlines() if 'tooltip="' in line}
    assert 'tooltip="added"' in box['"sm/WAIT"']
    assert 'tooltip="changed"' in box['"sm/PICK"']
    assert '"sm/PICK" -> "sm=lost" [label=< lost >, color="#cf222e"' in drawn
    assert '"sm/PICK" -> "sm/PARK" [label=< lost >, color="#1a7f37"' in drawn
    dot = shutil.which("dot")
    if dot is None:
        pytest.skip("Graphviz is not installed")
    done = subprocess.run([dot, "-Tsvg"], input=drawn, capture_output=True, text=True, check=True)
    assert done.stderr == ""


def model_of(page: str) -> Any:
    """The model in a page."""
    start = page.index('<script type="application/json" id="smachac-model">')
    return json.loads(page[page.index(">", start) + 1 : page.index("</script>", start)])


def test_a_page(capsys: pytest.CaptureFixture[str]) -> None:
    """A state with another container moves; the page has it once."""
    text = CHANGED.replace("  - PARK:", "  - WAIT: {template: SleepState, time: 1.0}\n  - PARK:")
    write("new.yml", text.replace("script: park", "template: ScriptedState, outcomes: [done]"))
    assert diff("main.yml", "new.yml", "--format", "html") == 1
    page = capsys.readouterr().out
    model = model_of(page)
    nodes = {item["path"]: item for item in model["nodes"]}
    assert {path: each["change"] for path, each in nodes.items()} == {
        "sm": "same",
        "sm/PICK": "changed",
        "sm/PARK": "changed",
        "sm/WAIT": "added",
        "sm/PARK/HOME (removed)": "removed",
    }
    for path, each in nodes.items():
        assert all(nodes[child]["parent"] == path for child in each["children"])
    edges = {(item["source"], item["outcome"], str(item["target"])): item["change"]
             for item in model["edges"]}  # fmt: skip
    assert edges["sm/PICK", "lost", "sm/PARK"] == "added"
    assert edges["sm/PICK", "lost", "{'outcome': 'lost'}"] == "removed"
    assert edges["sm/PICK", "done", "sm/PARK"] == "same"
    changes = model["differences"]["changes"]
    assert all(change["path"] in nodes for change in changes)
    assert model["source"] == "new.yml"
    write("new.yml", SCRIPT.replace("1.0", "x"))
    assert diff("main.yml", "new.yml", "--format", "html") == 1
    assert '"path":"sm/PICK","kind":"added","text":"+ error[SM' in capsys.readouterr().out
    assert diff("main.yml", "main.yml", "--format", "html") == 0
    write("bad.yml", "name: [")
    capsys.readouterr()
    assert diff("main.yml", "bad.yml", "--format", "html") == 1
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "bad.yml" in shown.err


CONCURRENCE = """\
name: sm
template: Base
outcomes: [done, lost]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done, lost]
      default_outcome: lost
      outcome_map: {done: {A: ok, B: ok}}
      transitions: {done: done, lost: lost}
      states:
        - A: {template: ScriptedState, outcomes: [ok, bad]}
        - B: {template: ScriptedState, outcomes: [ok, bad]}
"""


def test_a_page_has_the_rules_of_both_machines(capsys: pytest.CaptureFixture[str]) -> None:
    write("main.yml", CONCURRENCE)
    write("new.yml", CONCURRENCE.replace("B: ok}}", "C: ok}}").replace("- B:", "- C:"))
    assert diff("main.yml", "main.yml", "--format", "html") == 0
    model = model_of(capsys.readouterr().out)
    (both,) = (item for item in model["nodes"] if item["path"] == "sm/BOTH")
    when = [["sm/BOTH/A", "ok"], ["sm/BOTH/B", "ok"]]
    assert both["rules"] == [{"outcome": "done", "when": when, "change": "same"}]
    assert (both["join"], both["default"]) == ("all", "lost")
    assert diff("main.yml", "new.yml", "--format", "html") == 1  # a renamed state
    (both,) = (e for e in model_of(capsys.readouterr().out)["nodes"] if e["path"] == "sm/BOTH")
    when = [["sm/BOTH/A", "ok"], ["sm/BOTH/C", "ok"]]
    assert both["rules"] == [{"outcome": "done", "when": when, "change": "same"}]
    write("new.yml", CONCURRENCE.replace("{A: ok, B: ok}", "{A: ok}"))
    assert diff("main.yml", "new.yml", "--format", "html") == 1
    model = model_of(capsys.readouterr().out)
    (both,) = (item for item in model["nodes"] if item["path"] == "sm/BOTH")
    found = [(item["change"], [path for path, _ in item["when"]]) for item in both["rules"]]
    assert found == [("added", ["sm/BOTH/A"]), ("removed", ["sm/BOTH/A", "sm/BOTH/B"])]
    edges = {(item["source"], item["outcome"], item["kind"]): item["change"]
             for item in model["edges"]}  # fmt: skip
    assert edges["sm/BOTH/A", "ok", "rule"] == "same"
    assert edges["sm/BOTH/B", "ok", "rule"] == "removed"
    assert edges["sm/BOTH/B", "bad", "default"] == "same"


@pytest.mark.parametrize("format", ["dot", "html"])
def test_a_picture_shows_one_script(format: str, capsys: pytest.CaptureFixture[str]) -> None:
    write("other.yml", SCRIPT)
    commit()
    write("other.yml", CHANGED)
    assert diff("--format", format) == 1
    write("main.yml", CHANGED)
    capsys.readouterr()
    assert diff("--format", format) == 2
    assert "name it" in capsys.readouterr().err


def test_an_empty_revision_is_not_the_last_commit(capsys: pytest.CaptureFixture[str]) -> None:
    """As of an unset variable in CI: `--from "$BASE"`."""
    commit()
    assert diff("main.yml", "--from", "") == 2
    assert "git has no revision ``" in capsys.readouterr().err


def test_a_path_outside_of_the_repository_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    commit()
    assert diff("..") == 2
    assert "`..` is not in the git repository" in capsys.readouterr().err


def test_no_repository_and_no_commits(
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path_factory.mktemp("none"))
    write("main.yml", SCRIPT)
    assert diff("main.yml") == 2
    assert "git finds no repository in this folder: not a git" in capsys.readouterr().err
    subprocess.run(["git", "init", "-q"], check=True)
    assert diff("main.yml") == 2
    assert "has no commits" in capsys.readouterr().err

"""`diff` and `check --changed-since` in a checkout that is not trusted: links, git's settings."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
- A: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""
SECRET = "name: private words\nstates: [[\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository with one commit, the current folder; a file with a secret is beside it."""
    inside = tmp_path / "repository"
    inside.mkdir()
    monkeypatch.chdir(inside)
    (tmp_path / "secret.yml").write_text(SECRET)
    (inside / "main.yml").write_text(SCRIPT)
    git("init", "-q", "-b", "main")
    commit()
    return inside


def git(*words: str) -> str:
    names = ("-c", "user.name=x", "-c", "user.email=x@example.org")
    done = subprocess.run(["git", *names, *words], check=True, capture_output=True, text=True)
    return done.stdout


def commit() -> None:
    git("add", ".")
    git("commit", "-qm", "x")


def link(name: str, target: Path) -> None:
    Path(name).unlink(missing_ok=True)
    Path(name).symlink_to(target)


@pytest.mark.parametrize("words", [["."], ["main.yml"], ["*.yml"], ["main.yml", "more.yml"]])
@pytest.mark.parametrize("target", ["absolute", "relative", "folder"])
def test_a_link_out_of_the_repository_is_not_followed(
    folder: Path, words: list[str], target: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """In a revision and on disk, also if the link is named."""
    to = {"absolute": folder.parent / "secret.yml", "folder": folder.parent}
    link("main.yml", to.get(target, Path("../secret.yml")))
    link("more.yml", Path("main.yml"))
    for format in ("text", "markdown", "json", "dot", "html"):
        assert main(["diff", *words, "--from", "HEAD", "--format", format]) in (1, 2)
        shown = capsys.readouterr()
        assert "private" not in shown.out + shown.err
        if target != "folder" or words[0] == "main.yml":  # a search does not find it
            assert "error[SM007]: this link leads out of the folder `.`" in shown.err


@pytest.mark.parametrize(
    "name", ["sub.yml", "templates/Grasp.yml", "smachac.toml", "inner/main.yml"]
)
def test_no_file_of_a_script_is_read_through_a_link_out_of_the_repository(
    folder: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Sub-scripts, interfaces, settings, and files in a folder that is a link."""
    calls = "- B: {script: sub, transitions: {x: done}}\n- C: {template: Grasp}\n"
    Path("main.yml").write_text(SCRIPT + calls)
    Path(name).parent.mkdir(exist_ok=True)
    if name == "inner/main.yml":
        Path("inner").rmdir()
        link("inner", folder.parent)
    else:
        link(name, folder.parent / "secret.yml")
    commit()
    for words in (["main.yml"], ["."], ["inner/secret.yml"]):
        main(["diff", *words, "--from", "HEAD~", "--to", "HEAD", "--format", "markdown"])
        main(["diff", *words, "--from", "HEAD~", "--format", "markdown"])
        shown = capsys.readouterr()
        assert "private" not in shown.out + shown.err
        assert "Traceback" not in shown.err


def test_a_link_was_in_a_revision_only(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    link("main.yml", folder.parent / "secret.yml")
    commit()
    link("main.yml", Path("inside.txt"))
    Path("inside.txt").write_text(SCRIPT)
    for words in (["--from", "HEAD"], ["--from", "HEAD~", "--to", "HEAD"]):
        assert main(["diff", "main.yml", *words]) == 1
        shown = capsys.readouterr()
        assert "private" not in shown.out + shown.err
        assert "error[SM007] this link leads out of the folder `.`" in shown.out
    assert main(["diff", "main.yml", "--from", "HEAD~"]) == 0  # a link inside is followed


def test_two_files_that_are_named_may_be_links(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder.parent / "other.yml").write_text(SCRIPT)
    link("new.yml", folder.parent / "other.yml")
    assert main(["diff", "main.yml", "new.yml"]) == 0
    assert main(["check", "new.yml"]) == 0
    assert main(["check", "new*.yml"]) == 1  # a pattern is a search, as a folder is
    assert "this link leads out" in capsys.readouterr().out


PROGRAMS = {
    "core.fsmonitor": "{}",
    "core.hooksPath": "{folder}",
    "core.pager": "{}",
    "core.sshCommand": "{}",
    "core.askPass": "{}",
    "credential.helper": "!{}",
    "diff.external": "{}",
    "diff.mark.command": "{}",
    "diff.mark.textconv": "{}",
    "filter.mark.clean": "{}",
    "filter.mark.smudge": "{}",
    "filter.mark.process": "{}",
    "filter.mark.required": "true",
    "alias.rev-parse": "!{}",
    "alias.ls-tree": "!{}",
    "extensions.partialClone": "origin",
    "remote.origin.promisor": "true",
    "remote.origin.url": "ext::{}",
    "remote.origin.uploadpack": "{}",
    "protocol.allow": "always",
    "protocol.ext.allow": "always",
    "gpg.program": "{}",
}
"""Settings of a checkout that name programs, each a script that writes a marker file."""


@pytest.mark.parametrize(
    "names", [["core.fsmonitor"], ["core.hooksPath"], ["filter.mark.process"], [*PROGRAMS]]
)
def test_git_starts_no_program_that_a_checkout_names(
    folder: Path, names: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    marker, program = folder.parent / "marker", folder.parent / "hooks" / "post-index-change"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\n: > {marker}\ncat\n")
    program.chmod(0o755)
    for hook in ("post-checkout", "pre-auto-gc", "reference-transaction"):
        shutil.copy(program, program.parent / hook)
        shutil.copy(program, Path(".git/hooks", hook))
    Path(".gitattributes").write_text("*.yml diff=mark filter=mark\n")
    commit()
    for name in ["filter.mark.clean", *names]:
        git("config", name, PROGRAMS[name].format(program, folder=program.parent))
    marker.unlink(missing_ok=True)
    Path("main.yml").write_text(SCRIPT.replace("A:", "B:"))
    Path("new.yml").write_text(SCRIPT)
    for words in (["diff", "."], ["diff", "--from", "HEAD~", "--to", "HEAD"]):
        assert main(words) in (0, 1)
    main(["check", ".", "--changed-since", "HEAD"])
    assert "2 scripts checked" in capsys.readouterr().out
    assert not marker.exists()


def test_missing_objects_are_not_fetched(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A partial clone whose remote would start a program."""
    marker = folder.parent / "marker"
    blob = git("rev-parse", "HEAD:main.yml").strip()
    git("config", "core.repositoryFormatVersion", "1")
    for name in ("extensions.partialClone", "remote.origin.promisor", "protocol.ext.allow"):
        value = {"extensions.partialClone": "origin", "protocol.ext.allow": "always"}
        git("config", name, value.get(name, "true"))
    git("config", "remote.origin.url", f"ext::touch {marker}")
    Path(".git/objects", blob[:2], blob[2:]).unlink()
    assert main(["diff", "main.yml"]) == 2
    assert "smachac: error: " in capsys.readouterr().err
    assert not marker.exists()


def test_a_repository_that_is_a_part_of_the_files_is_not_used(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    git("clone", "-q", "--bare", ".", "data")
    shutil.rmtree(".git")
    (folder / "data" / "main.yml").write_text(SCRIPT)
    for words in (["diff", "data/main.yml"], ["check", "data", "--changed-since", "HEAD"]):
        assert main(words) == 2
    assert "repository" in capsys.readouterr().err


@pytest.mark.parametrize(
    "kind", ["line ends", "mode", "sha256", "new", "staged", "link", "ignored"]
)
def test_the_files_that_changed(
    folder: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """What `git diff` and `git ls-files --others` list, apart from line ends."""
    scripts = ""
    main_file = Path("main.yml")
    match kind:
        case "line ends":
            main_file.write_bytes(SCRIPT.replace("\n", "\r\n").encode())
            scripts = "; 0 scripts checked"
        case "mode":
            main_file.chmod(0o755)
            scripts = "; 0 scripts checked"
        case "sha256":
            shutil.rmtree(".git")
            git("init", "-q", "--object-format=sha256")
            Path("same.yml").write_text(SCRIPT)
            commit()
            main_file.write_text(f"{SCRIPT}# x\n")
        case "new":
            Path("new.yml").write_text(SCRIPT)
        case "staged":
            Path("new.yml").write_text(SCRIPT)
            git("add", ".")
        case "link":
            Path("a.txt").write_text(SCRIPT)
            Path("b.txt").write_text(SCRIPT)
            link("new.yml", Path("a.txt"))
            commit()
            link("new.yml", Path("b.txt"))
        case "ignored":
            Path(".gitignore").write_text("new.yml\n")
            Path("new.yml").write_text(SCRIPT)
            scripts = "; 0 scripts checked"
    assert main(["check", ".", "--changed-since", "HEAD"]) == 0
    assert capsys.readouterr().out == f"no findings{scripts}\n"

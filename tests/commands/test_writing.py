"""Several files are written as a whole, or not at all."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.commands.writing import PartlyWrittenError, put_all

UNFORMATTED = """\
name:   {name}
template: Base
outcomes: [succeeded]
states:
- A: {{template: ScriptedState, outcomes: [done], transitions: {{done: succeeded}}}}
"""


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def fail_at(monkeypatch: pytest.MonkeyPatch, number: int, error: BaseException) -> None:
    """Make `os.replace` raise an error at its n-th call."""
    replace = os.replace
    calls = iter(range(1, 1000))

    def failing(source: str, target: str) -> None:
        if next(calls) == number:
            raise error
        replace(source, target)

    monkeypatch.setattr(os, "replace", failing)


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize("number", [1, 2, 3])
def test_an_error_between_files_restores_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, error: BaseException
) -> None:
    for name in ("a", "b"):
        (tmp_path / name).write_text(f"old {name}")
    os.link(tmp_path / "a", tmp_path / "a_too")
    before = contents(tmp_path)
    fail_at(monkeypatch, number, error)
    new = {tmp_path / name: b"new" for name in ("new", "a", "b", "other")}
    with pytest.raises(type(error)):
        put_all(new)
    assert contents(tmp_path) == before


def test_hard_links_permissions_and_links(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    os.link(tmp_path / "a", tmp_path / "same")
    (tmp_path / "b").write_text("old")
    (tmp_path / "b").chmod(0o640)
    (tmp_path / "link").symlink_to("b")
    put_all({tmp_path / name: name.encode() for name in ("a", "b", "link", "new")})
    assert (tmp_path / "same").read_bytes() == b"a"
    assert (tmp_path / "b").read_bytes() == b"b"
    assert (tmp_path / "b").stat().st_mode & 0o777 == 0o640
    assert not (tmp_path / "link").is_symlink()
    assert sorted(contents(tmp_path)) == ["a", "b", "link", "new", "same"]


@pytest.mark.skipif(os.name != "posix", reason="no permissions of this kind")
@pytest.mark.parametrize(("mask", "permissions"), [(0o077, 0o600), (0o002, 0o664), (0o022, 0o644)])
def test_the_umask_holds_for_new_files(tmp_path: Path, mask: int, permissions: int) -> None:
    before = os.umask(mask)
    try:
        put_all({tmp_path / "new": b"new"})
        assert os.umask(mask) == mask
    finally:
        os.umask(before)
    assert (tmp_path / "new").stat().st_mode & 0o777 == permissions


def test_a_signal_waits_for_the_last_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    replace = os.replace

    def interrupted(source: str, target: str) -> None:
        signal.raise_signal(signal.SIGINT)  # to this thread
        replace(source, target)

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        put_all({tmp_path / "a": b"a", tmp_path / "b": b"b"})
    assert contents(tmp_path) == {"a": b"a", "b": b"b"}


def test_files_that_cannot_be_restored_are_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a").write_text("old")
    fail_at(monkeypatch, 2, OSError(5, "Input/output error"))
    monkeypatch.setattr(Path, "replace", lambda *_: (_ for _ in ()).throw(OSError(5, "again")))
    with pytest.raises(PartlyWrittenError, match="Input/output error") as e:
        put_all({tmp_path / "a": b"new", tmp_path / "b": b"new"})
    (kept,) = tmp_path.glob(".smachac-*")
    assert str(kept) in str(e.value)
    assert kept.read_text() == "old"


@pytest.mark.parametrize("command", ["fmt", "build"])
def test_commands_write_all_or_none(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: str,
) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.yml").write_text(UNFORMATTED.format(name=name))
    before = contents(tmp_path)
    fail_at(monkeypatch, 2, OSError(28, "No space left on device"))
    words = ["fmt", str(tmp_path)]
    if command == "build":
        words = ["build", str(tmp_path / "a.yml"), "-t", "cpp", "-o", str(tmp_path / "out")]
    assert main(words) == 1
    assert contents(tmp_path) == before
    assert "No space left on device" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        "build main.yml -t cpp -o {}",
        "new {}",
        "run main.yml --mock s.yml -q --trace {}/t.jsonl",
        "check main.yml --baseline {}/k.json --write-baseline",
    ],
)
@pytest.mark.parametrize(
    ("place", "reason"),
    [
        ("out", "out is a link to nowhere, which is no folder"),
        ("out/sub", "out is a link to nowhere, which is no folder"),
        ("loop", "loop is a link to loop, which is no folder"),
        ("linked/new", "linked is a link to s.yml, which is no folder"),
        ("s.yml", "s.yml is no folder"),
    ],
)
def test_a_folder_that_is_none(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: str,
    place: str,
    reason: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(UNFORMATTED.format(name="main"))
    Path("s.yml").write_text("states: {A: [done]}\n")
    for name, target in (("out", "nowhere"), ("loop", "loop"), ("linked", "s.yml")):
        Path(name).symlink_to(target)
    before = sorted(tmp_path.iterdir())
    assert main(words.format(place).split()) in (1, 2)
    assert reason in capsys.readouterr().err
    assert sorted(tmp_path.iterdir()) == before

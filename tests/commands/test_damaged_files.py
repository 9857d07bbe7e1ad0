"""Damaged files of other kinds than scripts: a message and an exit code, never an exception."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main

BENCH = Path(__file__).parents[2] / "bench"
SURROGATE = b"\xed\xa0\x80"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The project that bench/fuzz_files.py damages, with the files that commands write."""
    bench = fuzz_files(monkeypatch)
    monkeypatch.chdir(tmp_path)
    for name, text in bench.FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    for _, command in bench.MADE:
        main(command.split())
    return tmp_path


def fuzz_files(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module bench/fuzz_files.py."""
    monkeypatch.syspath_prepend(BENCH)
    spec = importlib.util.spec_from_file_location("fuzz_files", BENCH / "fuzz_files.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "fuzz_files", module)
    spec.loader.exec_module(module)
    return module


def ended(command: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """The exit code of a command and what it prints."""
    capsys.readouterr()
    try:
        code = main(command.split())
    except SystemExit as end:
        code = int(end.code or 0)
    return code, "".join(capsys.readouterr())


def replaced(path: Path, old: bytes, new: bytes) -> None:
    data = path.read_bytes()
    assert old in data
    path.write_bytes(data.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "old", "new", "key"),
    [
        ("main.yml", b"{WAVE: 3}", b"{WAVE: 3, WAVE: 4}", "WAVE"),
        ("main.yml", b"{WAVE: 3}", b"{WAVE: 3}\n    at_most: {CARRY: 1}", "at_most"),
        ("main.yml", b"- at_most", b"- name: a\n    name: b\n    at_most", "name"),
        ("templates/Wave.yml", b"outcomes:", b"outcomes: [a]\noutcomes:", "outcomes"),
        ("templates/Wave.yml", b"{type: int,", b"{type: int, type: str,", "type"),
        ("templates/Carry.yml", b"done: {},", b"done: {}, done: {doc: a},", "done"),
        ("templates/Carry.yml", b"from: Pose,", b"from: Pose, from: float,", "from"),
    ],
)
def test_a_key_given_twice_is_found_in_properties_and_interfaces(
    project: Path,
    capsys: pytest.CaptureFixture[str],
    file: str,
    old: bytes,
    new: bytes,
    key: str,
) -> None:
    replaced(project / file, old, new)
    code, printed = ended("check main.yml", capsys)
    assert code == 1
    assert f"error[SM002]: `{key}` is given twice" in printed


@pytest.mark.parametrize("opening", ["[", '{"a":', '[{"a":'])
@pytest.mark.parametrize("closed", [True, False])
def test_deep_json_is_refused(
    project: Path, capsys: pytest.CaptureFixture[str], opening: str, closed: bool
) -> None:
    ends = "".join({"[": "]", "{": "}"}[sign] for sign in reversed(opening) if sign in "[{")
    deep = opening * 100_000 + ("1" + ends * 100_000 if closed else "")
    trace = (project / "run.jsonl").read_text()
    (project / "run.jsonl").write_text(trace + deep + "\n")
    for command in ("trace check", "trace stats", "stats"):
        code, printed = ended(f"{command} main.yml run.jsonl", capsys)
        assert code == 1
        reason = "this line has too many brackets in brackets"
        assert f"run.jsonl:{len(trace.splitlines()) + 1}: {reason}" in printed
        assert len(printed) < 10_000
    for text in (deep, f'{{"version": 2, "findings": {deep}}}'):
        (project / "known.json").write_text(text)
        for option in ("", " --write-baseline"):
            code, printed = ended(f"check main.yml --baseline known.json{option}", capsys)
            assert code == 2
            assert "known.json" in printed
            assert (project / "known.json").read_text() == text


@pytest.mark.parametrize("damage", [SURROGATE, b"\0", b"\xff"])
@pytest.mark.parametrize(
    ("file", "after", "command", "code"),
    [
        ("arm.urdf", b'name="shoulder', "check arm_script.yml", "SM018"),
        ("arm.urdf", b"\n  <link", "build arm_script.yml -t python -o out", "SM018"),
        ("arm_skills/carry.py", b"return 'done", "check main.yml", "SM608"),
        ("arm_skills/carry.py", b"# userdata.into", "build main.yml -t python -o out", "SM608"),
        ("smachac.toml", b'scripts = [".', "check main.yml", "SM007"),
        ("smachac.toml", b'SM204 = "er', "check main.yml", "SM007"),
        ("smachac.toml", b"SM204", "check .", "SM007"),
    ],
)
def test_bytes_that_no_text_has_are_named(
    project: Path,
    capsys: pytest.CaptureFixture[str],
    damage: bytes,
    file: str,
    after: bytes,
    command: str,
    code: str,
) -> None:
    replaced(project / file, after, after + damage)
    _, printed = ended(command, capsys)
    expected = code if damage == b"\0" else "SM007"
    assert f"[{expected}]" in printed
    assert file.rpartition("/")[2] in printed


@pytest.mark.parametrize("damage", [SURROGATE, b"\0", b"\xff", b"\\ud800"])
@pytest.mark.parametrize(
    ("file", "after"),
    [
        ("cell_msgs/msg/Part.msg", b"name 'a"),
        ("cell_msgs/msg/Part.msg", b"# a part"),
        ("cell_msgs/srv/Grasp.srv", b"float64 width"),
        ("cell_msgs/action/Tidy.action", b"string room"),
    ],
)
def test_damaged_definitions_of_messages_raise_nothing(
    project: Path, capsys: pytest.CaptureFixture[str], damage: bytes, file: str, after: bytes
) -> None:
    replaced(project / file, after, after + damage)
    code, printed = ended("check ros.yml", capsys)
    assert code in (0, 1)
    assert printed


def test_a_message_without_fields_has_a_help(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "cell_msgs/msg/Part.msg").write_text("")
    code, printed = ended("check ros.yml", capsys)
    assert code == 1
    assert "help: it has no fields" in printed


@pytest.mark.parametrize(
    ("file", "text", "place", "message"),
    [
        ("msg/Part.msg", "int32 pin\nin32[ pin\n", "2:1", "this line declares no field"),
        ("msg/Part.msg", "int32\n", "1:1", "this line declares no field and no constant"),
        ("msg/Part.msg", "# a part\n\n  int32 1pin\n", "3:3", "this line declares no field"),
        ("msg/Part.msg", "int32 pin\nfloat64 pin\n", "2:9", "`pin` is declared twice"),
        ("msg/Part.msg", "int32 pin\n---\n", "1:1", "the file has 2 parts; a `.msg` file has 1"),
        ("srv/Grasp.srv", "float64 width\n", "1:1", "the file has 1 part; a `.srv` file has 2"),
        ("srv/Grasp.srv", "float64 width\n---\nbool=1\n", "3:1", "this line declares no field"),
        (
            "action/Tidy.action",
            "string room\n---\n---\nfloat32 done;\n",
            "4:1",
            "this line declares",
        ),
        ("action/Tidy.action", "string room\n---\n\n---\n", "", ""),
        ("msg/Part.msg", "int32[] pin\nint32 PIN=1\n", "", ""),
    ],
)
def test_a_definition_of_a_message_that_is_not_valid_is_a_warning(
    project: Path,
    capsys: pytest.CaptureFixture[str],
    file: str,
    text: str,
    place: str,
    message: str,
) -> None:
    (project / "cell_msgs" / file).write_text(text)
    for command in ("check ros.yml", "check ."):
        _, printed = ended(command, capsys)
        assert printed.count("SM007") == bool(place)
        assert not place or f"warning[SM007]: {message}" in printed
        assert not place or f"cell_msgs/{file}:{place}" in printed

"""Bad input of any kind gives a message and the exit code of a failure, never an exception."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.commands.run import _write_lines

SCRIPT = """\
name: sm
template: Base
outcomes: [succeeded]
states:
- A: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
"""


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(SCRIPT)
    monkeypatch.chdir(tmp_path)
    return path


@pytest.mark.parametrize("value", ['"\\U00110000"', '"\\ud800"', '"a\\0b"', "n" * 253])
@pytest.mark.parametrize("word", ["name: sm", "template: ScriptedState", "done: succeeded"])
def test_names_that_are_no_names(script: Path, word: str, value: str) -> None:
    script.write_text(SCRIPT.replace(word, f"{word.split(':')[0]}: {value}"))
    for command in (["check"], ["fmt", "--check"], ["build", "-t", "json", "-o", "out"]):
        assert main([*command, str(script)]) in (0, 1)
    assert main(["check", str(script)]) == 1 or value.startswith("n")


def test_the_place_of_an_escape_beyond_unicode(
    script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script.write_text(SCRIPT.replace("name: sm", 'name: "\\U00110000"'))
    assert main(["check", str(script)]) == 1
    assert "main.yml:1:8" in capsys.readouterr().out


@pytest.mark.parametrize(
    "text",
    [
        f"x = {'1' * 4301}",
        f"x = {'[' * 5000}",
        f"x = {'[' * 5000}{']' * 5000}",
        'scripts = ["a\\u0000b"]',
        "[severity]\nSM1 = 1e400",
    ],
)
def test_project_files(script: Path, text: str) -> None:
    script.with_name("smachac.toml").write_text(text)
    assert main(["check", str(script)]) == 1


@pytest.mark.parametrize("text", ["tool = 3", "tool.smachac = 3"])
def test_project_tables_of_other_kinds(script: Path, text: str) -> None:
    script.with_name("pyproject.toml").write_text(text)
    assert main(["check", str(script)]) == 0


def test_everything_is_excluded(script: Path) -> None:
    script.with_name("smachac.toml").write_text('exclude = ["*"]')
    assert main(["check", str(script.parent)]) == 2
    assert main(["fmt", str(script.parent)]) == 2
    assert main(["check", str(script)]) == 0


@pytest.mark.parametrize(
    "text", ['{"": [done]}', "{? [1] : [done]}", '{A: ["\\U00110000"]}', '{A: [{outcome: ""}]}']
)
def test_scenarios(script: Path, text: str) -> None:
    script.with_name("scenario.yml").write_text(f"states: {text}\n")
    assert main(["run", str(script), "--mock", "scenario.yml"]) == 1


def test_names_of_files(script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = os.fsdecode(b"n\xff.yml")
    Path(name).write_text(SCRIPT)
    for path in (name, f"{'n' * 253}.yml"):
        for command in (["check"], ["fmt"], ["build", "-t", "cpp"]):
            assert main([*command, path]) in (1, 2)
    assert "is not UTF-8" in capsys.readouterr().out
    assert main(["new", os.fsdecode(b"p\xff")]) == 2
    assert main(["new", "n" * 300]) == 1
    long = f"{'m' * 249}.yml"
    Path(long).write_text(SCRIPT)
    assert main(["fmt", long]) == 0


@pytest.mark.parametrize(
    "words",
    [
        ["build", "main.yml", "-t", "python", "-o", "loop"],
        ["build", "main.yml", "-t", "python", "-o", "loop/inner"],
        ["build", "loop", "-t", "python"],
        ["new", "loop"],
        ["run", "loop"],
        ["sweep", "loop", "--runs", "1"],
        ["sweep", "main.yml", "--runs", "1", "--mock", "loop"],
    ],
    ids=" ".join,
)
def test_links_that_name_each_other(script: Path, words: list[str]) -> None:
    script.with_name("loop").symlink_to("other")
    script.with_name("other").symlink_to("loop")
    assert main(words) in (1, 2)
    assert script.with_name("loop").is_symlink()


def test_huge_numbers(script: Path) -> None:
    number = "9" * 5000
    assert main(["build", str(script), "-t", "dot", "--option", f"depth={number}"]) == 2
    for option in ("--seed", "--orders"):
        with pytest.raises(SystemExit) as ended:
            main(["run", str(script), option, number])
        assert ended.value.code == 2


COMMANDS = [(["check", "main.yml"], 0)]
MORE_COMMANDS = [
    (["--help"], 0),
    (["build", "main.yml", "-t", "json", "-o", "-"], 0),
    (["run", "main.yml", "--mock", "scenario.yml"], 0),
    (["--version"], 0),
    (["check", "--help"], 0),
    (["check", "broken.yml", "--format", "json"], 1),
    (["build", "main.yml", "-t", "json", "-o", "out"], 0),
    (["fmt", "main.yml", "--diff"], 1),
    (["states"], 0),
    (["explain", "SM999"], 2),
    (["build", "main.yml", "-t", "nothing"], 2),
]


@pytest.mark.parametrize(
    ("command", "code"),
    [
        *(pytest.param(*item, id=" ".join(item[0])) for item in COMMANDS),
        *(
            pytest.param(*item, id=" ".join(item[0]), marks=pytest.mark.slow)
            for item in MORE_COMMANDS
        ),
    ],
)
def test_standard_output_is_full_closed_or_unread(
    script: Path, command: list[str], code: int
) -> None:
    script.with_name("broken.yml").write_text(SCRIPT.replace("done: succeeded", "done: nowhere"))
    script.with_name("scenario.yml").write_text("states: {A: [done]}\n")
    words = [sys.executable, "-m", "smachac", *command]
    prints = code != 2
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        assert ended.returncode == (code or 1)
        assert ("cannot print: No space left on device" in ended.stderr) == prints
        assert ended.stderr.count("\n") == 1 or not prints
        assert subprocess.run(words, stderr=full, check=False).returncode == code
    for closed in ("1>&-", "2>&-", "1>&- 2>&-"):
        shell = ["sh", "-c", f'exec "$@" {closed}', "sh", *words]
        assert subprocess.run(shell, check=False, capture_output=True).returncode == code
    read_end, write_end = os.pipe()
    os.close(read_end)
    with os.fdopen(write_end, "w") as unread:
        ended = subprocess.run(words, stdout=unread, stderr=subprocess.PIPE, text=True, check=False)
    assert ended.returncode == (code or 141)
    assert (ended.stderr == "") == prints


@pytest.mark.slow
@pytest.mark.parametrize("closed", ["1>&-", "2>&-", "0<&- 1>&- 2>&-"])
def test_the_workers_of_a_sweep_start_without_standard_streams(script: Path, closed: str) -> None:
    words = [sys.executable, "-m", "smachac", "sweep", str(script), "--runs", "1", "-o", "report"]
    shell = ["sh", "-c", f'exec "$@" {closed}', "sh", *words]
    assert subprocess.run(shell, check=False, capture_output=True).returncode == 0
    assert "succeeded" in script.with_name("report").read_text("utf-8")


def test_a_pipe_that_does_not_block(script: Path) -> None:
    read_end, write_end = os.pipe()
    os.set_blocking(write_end, False)
    words = [sys.executable, "-m", "smachac", "explain", "SM201"]
    text = subprocess.run(words, capture_output=True, check=True).stdout
    room = 0
    try:
        while True:
            room += os.write(write_end, bytes(4096))
    except BlockingIOError:
        pass
    with subprocess.Popen(words, stdout=write_end) as process:
        os.close(write_end)
        with os.fdopen(read_end, "rb") as stream:
            assert stream.read()[room:] == text
        assert process.wait() == 0


def test_an_output_folder_without_rights(script: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.mkstemp", refused)
    assert main(["build", str(script), "-t", "json"]) == 1


def test_a_trace_on_a_full_disk(script: Path) -> None:
    script.with_name("scenario.yml").write_text("states: {A: [done]}\n")
    for more in ([], ["-q"]):
        words = ["run", str(script), "--mock", "scenario.yml", "--trace", "/dev/full", *more]
        assert main(words) == 1
        assert main([*words[:2], *words[4:]]) == 1


def test_a_trace_ends_with_a_whole_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "t"
    write = os.write
    left = [20]

    def short(handle: int, data: bytes) -> int:
        if not left[0]:
            raise OSError(28, "No space left on device")
        done = write(handle, data[: left[0]])
        left[0] -= done
        return done

    failures: list[OSError] = []
    with path.open("wb", buffering=0) as stream:
        monkeypatch.setattr(os, "write", short)
        _write_lines(stream.fileno(), failures, b'{"seq": 1}\n')
        with pytest.raises(OSError, match="No space"):
            _write_lines(stream.fileno(), failures, b'{"seq": 2}\n')
    assert path.read_bytes() == b'{"seq": 1}\n'
    assert len(failures) == 1


ENDLESS = """\
name: sm
template: Base
outcomes: [succeeded, preempted]
userdata: {tries: 0}
states:
- BOTH:
    template: Concurrence
    outcomes: [succeeded, preempted]
    default_outcome: succeeded
    outcome_map: {succeeded: {A: succeeded}}
    states:
    - A: {template: SleepState, time: 0}
    - B:
        template: CallbacksState
        input_keys: [tries]
        output_keys: [tries]
        callbacks: {tries: 'lambda ud: any(0 for _ in iter(int, 1))'}
    transitions: {succeeded: succeeded, preempted: preempted}
"""


def test_the_second_interrupt_ends_a_branch_that_never_returns(script: Path) -> None:
    script.write_text(ENDLESS)
    os.mkfifo("trace")
    words = [sys.executable, "-m", "smachac", "run", str(script), "-q", "--trace", "trace"]
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        with Path("trace").open() as trace:
            for event in ('"sm/BOTH/B"', '"preempt", "path": "sm/BOTH/B"'):
                for line in trace:
                    if event in line:
                        break
                process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 130
        assert "Traceback" not in process.stderr.read()

"""The command line as users meet it: words, files, exit codes."""

from __future__ import annotations

import gc
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.version import __version__

EXAMPLES = Path(__file__).parents[2] / "examples"
GOOD = str(EXAMPLES / "01_sequence" / "main.yml")


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(Path(GOOD).read_text().replace("GO_HOME,", "GO_HMOE,"))
    return path


def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own."""
    ended: subprocess.CompletedProcess[str] = subprocess.run(
        [sys.executable, "-m", "smachac", *arguments],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        **options,  # type: ignore[call-overload]
    )
    return ended


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["--version"], ["--help"], ["check", "--help"], ["run", "--help"]):
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        assert ended.value.code == 0
    shown = capsys.readouterr().out
    assert f"smachac {__version__}" in shown
    assert "smachac check main.yml" in shown


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["chek"],
        ["build", GOOD],
        ["build", GOOD, "--target", "pyton"],
        ["build", GOOD, "--target", "dot", "--option", "dept=2"],
        ["build", GOOD, "--target", "dot", "--option", "depth"],
        ["explain", "SM999"],
        ["run", GOOD, "--seed", "x"],
        ["run", GOOD, "--record", "x.gif"],
        ["run", str(EXAMPLES / "08_pick_and_place" / "main.yml"), "--record", "x.avi"],
    ],
)
def test_wrong_usage_is_2(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = main(arguments)
    except SystemExit as ended:
        code = ended.code  # type: ignore[assignment]
    assert code == 2
    assert capsys.readouterr().err


def test_a_clean_script(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", GOOD]) == 0
    assert capsys.readouterr().out == "no findings\n"


def test_a_typo_is_found(broken: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(broken)]) == 1
    shown = capsys.readouterr().out
    assert "SM101" in shown
    assert "did you mean `GO_HOME`?" in shown
    assert f"{broken}:" in shown


def test_json(broken: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--format", "json", GOOD, str(broken)]) == 1
    data = json.loads(capsys.readouterr().out)
    assert {item["code"] for item in data["diagnostics"]} >= {"SM101"}


def test_strict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "main.yml"
    text = (
        Path(GOOD)
        .read_text()
        .replace("outcomes: [succeeded, aborted]\n\n", "outcomes: [succeeded, aborted, never]\n\n")
    )
    path.write_text(text)
    assert main(["check", str(path)]) == 0
    assert main(["check", "--strict", str(path)]) == 1
    assert "SM203" in capsys.readouterr().out


@pytest.mark.parametrize("target", ["python", "dot", "ir", "json"])
def test_build(target: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["build", GOOD, "--target", target, "-o", str(tmp_path / "\u00f6 x")]
    assert main(arguments) == 0
    (written,) = list((tmp_path / "\u00f6 x").iterdir())
    assert main([*arguments, "--check"]) == 0
    assert main(arguments) == 0
    written.write_text("mine")
    assert main([*arguments, "--check"]) == 1
    assert main(arguments) == 1
    assert written.read_text() == "mine"
    assert "--force" in capsys.readouterr().err
    assert main([*arguments, "--force"]) == 0
    assert written.read_text() != "mine"


def test_build_writes_nothing_for_a_broken_script(broken: Path, tmp_path: Path) -> None:
    assert main(["build", str(broken), "--target", "python", "-o", str(tmp_path / "out")]) == 1
    assert not (tmp_path / "out").exists()


def test_build_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", GOOD, "--target", "python", "-o", "-"]) == 0
    compile(capsys.readouterr().out, "x.py", "exec")


def test_explain(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "sm201"]) == 0
    shown = capsys.readouterr().out
    assert "SM201" in shown
    assert "Wrong" in shown


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("SM70", "the codes that begin so: SM701, SM702, SM703, SM704"),
        ("sm70", "the codes that begin so: SM701, SM702, SM703, SM704"),
        ("SM2011", "did you mean `SM211`?"),
        ("FIND", "a state or a key needs its script: smachac explain main.yml FIND"),
    ],
)
def test_a_word_that_is_no_code(word: str, told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", word]) == 2
    printed = capsys.readouterr().err
    assert f"there is no code `{word}`" in printed
    assert told in printed
    assert "SM001" not in printed


def test_the_states_of_a_script_are_listed_for_an_unknown_name(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["explain", GOOD, "FIND"]) == 2
    assert "states: `CHECK_BATTERY`, `GO_HOME`" in capsys.readouterr().err


def test_a_folder_in_place_of_a_script(broken: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (broken.parent / "a.yml").write_text("")
    assert main(["run", str(broken.parent)]) == 1
    assert f"help: name a script, such as `{broken}`" in capsys.readouterr().err.replace("\n", "")


def test_targets(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["targets"]) == 0
    assert {line.split()[0] for line in capsys.readouterr().out.splitlines()} >= {
        "python",
        "dot",
        "ir",
        "json",
    }


def test_run_with_trace(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    trace = tmp_path / "deep" / "t.jsonl"
    assert main(["run", GOOD, "--trace", str(trace)]) == 0
    shown = capsys.readouterr().out
    assert "CHECK_BATTERY" in shown
    assert shown.rstrip().endswith("outcome: succeeded")
    events = [json.loads(line) for line in trace.read_text().splitlines()]
    assert [event["event"] for event in events][:2] == ["start", "enter"]
    assert events[-1] == events[-1] | {"event": "finish", "outcome": "succeeded"}
    assert main(["run", "-q", GOOD, "--expect", "aborted"]) == 1


def test_run_a_scenario(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scenario = tmp_path / "scenario.yml"
    scenario.write_text("states:\n  CHECK_BATTERY: low\n")
    script = str(EXAMPLES / "08_pick_and_place" / "main.yml")
    assert main(["run", GOOD, "--mock", str(scenario), "--expect", "aborted"]) == 0
    scenario.write_text("states:\n  LIFT: {outcome: aborted}\n")
    assert main(["run", script, "--mock", str(scenario), "--expect", "aborted"]) == 0
    assert "LET_GO" in capsys.readouterr().out
    scenario.write_text("states:\n  LFIT: aborted\n  LIFT: [aborted, nothing]\n")
    assert main(["run", script, "--mock", str(scenario)]) == 1
    shown = capsys.readouterr().err
    assert f"{scenario}:2:3" in shown
    assert f"{scenario}:3:19" in shown


def test_a_state_that_raises(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "main.yml"
    path.write_text(
        "name: sm\ntemplate: Base\noutcomes: [succeeded]\nstates:\n"
        "  - IN:\n      template: StateMachine\n      outcomes: [succeeded]\n      states:\n"
        "        - DIVIDE:\n            template: CallbacksState\n"
        "            callbacks: {x: 'lambda ud: 1 / len([])'}\n            output_keys: [x]\n"
    )
    assert main(["run", str(path)]) == 1
    shown = capsys.readouterr().err
    assert "sm/IN/DIVIDE (main.yml:9)" in shown
    assert "ZeroDivisionError" in shown
    assert "1 / len([])" in shown


def test_a_missing_file_a_folder_and_a_full_stop(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "folder.yml").mkdir()
    (tmp_path / "folder.yml" / "x.yml").write_text("states: [")
    assert main(["check", str(tmp_path / "no.yml")]) == 1
    assert capsys.readouterr().out.count("SM007") == 1
    assert main(["build", str(tmp_path), "-t", "dot"]) == 1
    assert capsys.readouterr().err.count("SM007") == 1
    assert main(["check", str(tmp_path)]) == 2
    assert "there is no script in" in capsys.readouterr().err


def test_output_that_cannot_be_written(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", GOOD, "--target", "python", "-o", "/dev/null/x"]) == 1
    assert "cannot write" in capsys.readouterr().err
    assert main(["run", GOOD, "--trace", "/dev/full"]) in (0, 1)


def test_check_loads_only_what_it_needs() -> None:
    parsers = "smachac.grammars.standalone"
    heavy = (parsers, "jinja2", "numpy", "pybullet", "PIL", "importlib.metadata")
    code = (
        "import sys; from smachac.commands.cli import main; main(sys.argv[1:]);"
        f"print([name for name in {heavy} if name in sys.modules])"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code, "check", GOOD],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert ended.stdout == "no findings\n[]\n"


def test_ascii_terminals_get_escapes(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text("name: \u00fc\noutcomes: [a]\nstates:\n  - \u2713: {template: X}\n")
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    ended = run("check", str(path), env=environment)
    assert ended.returncode == 1
    assert "\\u2713" in ended.stdout
    assert "Traceback" not in ended.stderr


def test_ctrl_c_preempts_the_machine(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(
        "name: sm\ntemplate: Base\noutcomes: [succeeded, preempted]\nstates:\n"
        "  - WAIT: {template: SleepState, time: 60, transitions: {succeeded: succeeded,"
        " preempted: TIDY_UP}}\n"
        "  - TIDY_UP: {template: ScriptedState, outcomes: [done], transitions: {done: preempted}}\n"
    )
    trace = tmp_path / "t.fifo"
    os.mkfifo(trace)
    process = subprocess.Popen(
        [sys.executable, "-m", "smachac", "run", str(path), "--trace", str(trace)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    with trace.open() as events:
        while json.loads(events.readline())["event"] != "enter":
            pass
        process.send_signal(signal.SIGINT)
        rest = events.read()
    shown, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "TIDY_UP" in rest
    assert shown.rstrip().endswith("outcome: preempted")
    assert "preemption requested" in told


@pytest.mark.parametrize(
    ("options", "codes", "ended"),
    [
        ([], ["SM201", "SM203"], 1),
        (["--select", "SM203,SM204"], ["SM203"], 0),
        (["--select", "SM203", "--select", "sm201"], ["SM201", "SM203"], 1),
        (["--ignore", "SM2"], [], 0),
        (["--ignore", "SM201", "--strict"], ["SM203"], 1),
    ],
)
def test_select_and_ignore(
    options: list[str],
    codes: list[str],
    ended: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(
        "name: sm\ntemplate: Base\noutcomes: [done, never]\nstates:\n"
        "  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n"
        "  - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n"
    )
    assert main(["check", str(path), "--format", "json", *options]) == ended
    data = json.loads(capsys.readouterr().out)
    assert sorted(item["code"] for item in data["diagnostics"]) == codes
    assert main(["check", str(path), "--select", "SM29"]) == 2
    assert "there is no code `SM29`\ndid you mean" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["targets"], ["check", "none.yml"]])
def test_a_command_that_python_calls_leaves_the_garbage_collector_on(words: list[str]) -> None:
    assert gc.isenabled()
    main(words)
    assert gc.isenabled()

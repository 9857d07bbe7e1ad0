"""Stop signals to `smachac run` and `smachac sweep`: SIGINT, SIGTERM, SIGHUP, once and twice."""

from __future__ import annotations

import json
import random
import signal
import sqlite3
from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.support.examples import examples
from tests.support.stops import SIGNALS, Running, folder_of
from tests.support.sweeps import CHANCES, ONCE, SCRIPT, smachac, work_folder

RUN = ("-m", "smachac", "run", "main.yml", "-q")


@pytest.mark.parametrize("number", SIGNALS)
def test_run_ends_as_its_states_do_with_the_code_of_the_signal(tmp_path: Path, number: int) -> None:
    folder_of(tmp_path)
    run = Running(tmp_path, *RUN, "--expect", "succeeded", "--trace", "t.jsonl")
    run.until("working")
    run.send(number)
    code, err = run.end()
    assert (code, run.lines[-2:]) == (128 + number, ["tidied", "outcome: succeeded"])
    assert "preemption requested" in err
    assert "Traceback" not in err
    assert main(["trace", "check", str(tmp_path / "main.yml"), str(tmp_path / "t.jsonl")]) == 0


@pytest.mark.parametrize("seed", range(examples(10)))
def test_run_at_a_random_moment(tmp_path: Path, seed: int) -> None:
    folder_of(tmp_path)
    moment = random.Random(seed)
    number = moment.choice(SIGNALS)
    run = Running(tmp_path, *RUN, "--trace", "t.jsonl")
    run.until("step", moment.randint(1, 30))
    run.send(number)
    code, err = run.end()
    assert (code, run.lines[-1]) == (128 + number, "outcome: succeeded"), err
    events = [json.loads(line) for line in (tmp_path / "t.jsonl").read_text().splitlines()]
    assert [events[-1]["event"], events[-1]["outcome"]] == ["finish", "succeeded"]
    assert main(["trace", "check", str(tmp_path / "main.yml"), str(tmp_path / "t.jsonl")]) == 0


@pytest.mark.parametrize(("first", "second"), [*zip(SIGNALS, SIGNALS[::-1], strict=True)])
def test_the_second_signal_ends_run_at_once(tmp_path: Path, first: int, second: int) -> None:
    folder_of(tmp_path, last="Deaf")
    run = Running(tmp_path, *RUN)
    run.until("working")
    run.send(first)
    run.until("requested")
    run.send(second)
    run.process.wait(120)  # before the end of stdin, which Deaf waits for
    code, err = run.end()
    assert (code, err.splitlines()[-1]) == (128 + second, "interrupted")
    assert "tidied" not in run.lines


@pytest.mark.parametrize("number", SIGNALS)
def test_before_the_machine_run_ends_at_once(tmp_path: Path, number: int) -> None:
    folder_of(tmp_path)
    steps = tmp_path / "steps.py"
    wait = "print('imports', flush=True)\nimport sys; sys.stdin.readline()\n"
    steps.write_text(f"{wait}{steps.read_text()}")
    run = Running(tmp_path, *RUN)
    run.until("imports")
    run.send(number)
    run.process.wait(120)
    code, err = run.end()
    assert (code, err.splitlines()[-1]) == (128 + number, "interrupted")
    assert "Traceback" not in err
    assert "working" not in run.lines


def test_run_below_nohup_goes_on_after_sighup(tmp_path: Path) -> None:
    folder_of(tmp_path)
    ignore = "import signal, sys; signal.signal(signal.SIGHUP, signal.SIG_IGN); "
    start = "from smachac.__main__ import program; sys.exit(program())"
    run = Running(tmp_path, "-c", ignore + start, *RUN[2:])
    run.until("working")
    run.send(signal.SIGHUP)
    run.send(signal.SIGTERM)
    assert run.end()[0] == 143


LOOP = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {template: SleepState, time: 1.0, transitions: {succeeded: B, preempted: done}}
  - B: {template: ScriptedState, outcomes: [again, end], transitions: {again: A, end: done}}
"""


@pytest.mark.parametrize("number", SIGNALS)
def test_run_of_a_scenario_is_stopped_too(tmp_path: Path, number: int) -> None:
    (tmp_path / "main.yml").write_text(LOOP)
    (tmp_path / "mock.yml").write_text("states: {B: again}\n")
    words = ("run", "main.yml", "--mock", "mock.yml", "--max-steps", "1000000000")
    run = Running(tmp_path, "-m", "smachac", *words, "--trace", "t.jsonl")
    line = "  A                                       succeeded  1.00 s"
    run.until(line)
    run.send(number)
    code, err = run.end()
    assert (code, run.lines[-1]) == (128 + number, "outcome: done"), err
    assert (tmp_path / "t.jsonl").read_text().splitlines()[-1].startswith('{"seq": ')


@pytest.mark.parametrize(
    ("steps", "named"),
    [("{B: again}", ["3"]), ("{A: [succeeded, succeeded], B: [again]}", ["1", "2"]), ("{}", [])],
)
def test_a_scenario_without_end_names_its_cycle_and_its_steps(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], steps: str, named: list[str]
) -> None:
    (tmp_path / "main.yml").write_text(LOOP)
    mock = tmp_path / "mock.yml"
    mock.write_text(f"states: {steps}\n")
    script = str(tmp_path / "main.yml")
    trace = tmp_path / "t.jsonl"
    assert main(["run", script, "--mock", str(mock), "-q", "--trace", str(trace)]) == 1
    err = capsys.readouterr().err
    assert "sm/A: did not end after 10000 states: it repeats sm/A, sm/B\n" in err
    assert err.count(f"{mock}:1:") == err.count("this step repeats") == len(named)
    assert len(trace.read_text().splitlines()) < 50_000


def test_max_steps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.yml").write_text(LOOP)
    (tmp_path / "mock.yml").write_text("states: {B: [again, again, end]}\n")
    words = [str(tmp_path / "main.yml"), "--mock", str(tmp_path / "mock.yml"), "--max-steps"]
    assert main(["run", *words, "6", "-q"]) == 0
    assert main(["run", *words, "5", "-q"]) == 1
    assert main(["run", *words, "5", "--orders", "2"]) == 0
    assert "did not end after 5 states" in capsys.readouterr().out
    assert main(["sweep", *words, "5", "--runs", "1", "--jobs", "1"]) == 0
    assert "did not end after 5 states" in capsys.readouterr().out
    for command in ("run", "sweep"):
        assert main([command, words[0], "--max-steps", "5"]) == 2
        assert "--max-steps needs --mock" in capsys.readouterr().err


def test_a_stopped_sweep_without_a_database_has_lost_its_runs(tmp_path: Path) -> None:
    work_folder(tmp_path, "os.kill(os.getppid(), signal.SIGTERM), threading.Event().wait()", 0)
    found = smachac("sweep", "main.yml", "--runs", "1", "--jobs", "1", folder=tmp_path)
    assert (found.returncode, found.stdout[:17]) == (143, "0 of 1 run of sm\n")
    assert found.stderr.endswith(
        "interrupted: 0 of 1 run is done, and none is kept; with `--database FILE` the same command"
        " continues\n"
    )


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_stopped_sweep_keeps_what_is_done(tmp_path: Path, name: str) -> None:
    stop = ONCE.format(f"os.kill(os.getppid(), signal.{name}), threading.Event().wait()")
    work_folder(tmp_path, stop, seed=5)
    words = ("sweep", "main.yml", "--runs", "12", "--jobs", "2", "--database", "sweep.db")
    first = smachac(*words, folder=tmp_path)
    assert first.returncode == 128 + getattr(signal, name), first.stderr
    assert "of 12 runs of sm" in first.stdout
    assert "Traceback" not in first.stderr


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_the_workers_leave_signals_to_the_sweep(tmp_path: Path, name: str) -> None:
    work_folder(tmp_path, f"os.kill(os.getpid(), signal.{name})", seed=1)
    found = smachac("sweep", "main.yml", "--runs", "3", "--jobs", "1", folder=tmp_path)
    assert found.returncode == 0, found.stderr
    assert "failed run" not in found.stdout


GONE = {
    "deleted": "os.remove(HERE / 'sweep.db')",
    "moved": "os.rename(HERE / 'sweep.db', HERE / 'other.db')",
    "replaced": "(os.remove(HERE / 'sweep.db'), (HERE / 'sweep.db').touch())",
}


@pytest.mark.parametrize("action", GONE.values(), ids=GONE)
def test_a_database_that_is_gone_fails_the_sweep(tmp_path: Path, action: str) -> None:
    work_folder(tmp_path, action, seed=2)
    words = ("sweep", "main.yml", "--runs", "4", "--jobs", "1", "--database", "sweep.db")
    found = smachac(*words, folder=tmp_path)
    assert found.returncode == 1
    assert found.stderr == (
        "the database sweep.db was deleted or replaced during the sweep: its runs are lost\n"
    )


def test_a_sweep_whose_database_stays_has_its_runs(tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text(SCRIPT)
    (tmp_path / "chances.yml").write_text(CHANCES)
    words = ("--mock", "chances.yml", "--runs", "4", "--jobs", "1", "--database", "sweep.db")
    assert smachac("sweep", "main.yml", *words, folder=tmp_path).returncode == 0
    connection = sqlite3.connect(tmp_path / "sweep.db")
    assert connection.execute("SELECT count(*) FROM runs").fetchone() == (4,)
    connection.close()

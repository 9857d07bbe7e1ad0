"""Generated Python programs at stop signals: real processes, every base."""

from __future__ import annotations

import random
import signal
from pathlib import Path

import pytest

from tests.support.examples import examples
from tests.support.stops import BRANCHES, SCRIPT, SIGNALS, OnTerminal, Running, built, folder_of

FOOTER = """\
{{% extends "{0}" %}}
{{% block base_footer %}}
    print("footer", flush=True)
{{% endblock %}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = folder_of(tmp_path_factory.mktemp("stops"))
    built(folder)
    return folder


@pytest.mark.parametrize("number", SIGNALS)
def test_a_signal_preempts_the_machine_and_gives_the_exit_code(folder: Path, number: int) -> None:
    program = Running(folder, "sm.py")
    program.until("working")
    program.send(number)
    code, err = program.end()
    assert code == 128 + number
    assert program.lines[-2:] == ["tidied", "outcome: succeeded"]
    assert "Traceback" not in err


@pytest.mark.parametrize("seed", range(examples(20)))
def test_a_signal_at_a_random_moment(folder: Path, seed: int) -> None:
    moment = random.Random(seed)
    number = moment.choice(SIGNALS)
    program = Running(folder, "sm.py")
    program.until("step", moment.randint(1, 30))
    program.send(number)
    code, err = program.end()
    assert code == 128 + number
    assert program.lines[-2:] == ["tidied", "outcome: succeeded"]
    assert "Traceback" not in err


@pytest.mark.parametrize(("first", "second"), [*zip(SIGNALS, SIGNALS[::-1], strict=True)])
def test_the_second_signal_ends_at_once(tmp_path: Path, first: int, second: int) -> None:
    built(folder_of(tmp_path, last="Deaf"))
    program = Running(tmp_path, "sm.py")
    program.until("working")
    program.send(first)
    program.until("requested")
    program.send(second)
    program.process.wait(120)  # before the end of stdin, which Deaf waits for
    assert program.end()[0] == 128 + second
    assert "tidied" not in program.lines


def test_a_state_that_does_not_answer_ends_as_it_does(tmp_path: Path) -> None:
    built(folder_of(tmp_path, last="Deaf"))
    program = Running(tmp_path, "sm.py")
    program.until("working")
    program.send(signal.SIGTERM)
    program.until("requested")
    code, _ = program.end("go on\n")
    assert (code, program.lines[-1]) == (143, "outcome: succeeded")


def test_a_signal_before_the_machine_ends_the_program(tmp_path: Path) -> None:
    folder_of(tmp_path)
    steps = tmp_path / "steps.py"
    steps.write_text(f"print('imports', flush=True)\nimport sys; sys.stdin.readline()\n"
                     f"{steps.read_text()}")  # fmt: skip
    built(tmp_path)
    program = Running(tmp_path, "sm.py")
    program.until("imports")
    program.send(signal.SIGTERM)
    assert program.end()[0] in (-signal.SIGTERM, 143)
    assert "working" not in program.lines


def test_a_signal_after_the_last_state(tmp_path: Path) -> None:
    built(folder_of(tmp_path, last="Deaf"))
    steps = tmp_path / "steps.py"
    slow = '        print("tidied", flush=True)\n'
    steps.write_text(steps.read_text().replace(
        slow, f"{slow}        import atexit; atexit.register(self.last)\n")
        + "\n    def last(self):\n        print('last', flush=True)\n"
        "        sys.stdin.readline()\n")  # fmt: skip
    program = Running(tmp_path, "sm.py")
    program.until("working")
    program.process.stdin.write("go on\n")  # type: ignore[union-attr]
    program.process.stdin.flush()  # type: ignore[union-attr]
    program.until("last")
    program.send(signal.SIGINT)
    code, err = program.end("end\n")
    assert (code, "Traceback" in err) == (0, False)


def test_sighup_that_nohup_ignores_stays_ignored(folder: Path) -> None:
    ignore = "import signal, runpy, sys; signal.signal(signal.SIGHUP, signal.SIG_IGN); "
    program = Running(folder, "-c", f"{ignore}sys.path.insert(0, '.');"
                      " runpy.run_path('sm.py', run_name='__main__')")  # fmt: skip
    program.until("working")
    program.send(signal.SIGHUP)
    program.send(signal.SIGINT)
    assert program.end()[0] == 130


def test_a_stop_reaches_every_branch(tmp_path: Path) -> None:
    built(folder_of(tmp_path, BRANCHES))
    program = Running(tmp_path, "sm.py")
    program.until("working", 2)
    program.send(signal.SIGHUP)
    code, err = program.end()
    assert (code, program.lines[-1]) == (129, "outcome: succeeded")
    assert "Traceback" not in err


@pytest.mark.parametrize("base", ["Base.tpl.py", "Program.tpl.py"])
def test_bases_of_the_user_stop_too(tmp_path: Path, base: str) -> None:
    folder_of(tmp_path, base="Own")
    own = tmp_path / "templates" / "Own.yml"
    own.write_text("name: Own\nkind: base\ncode: {python: Own.tpl.py}\n")
    (tmp_path / "templates" / "Own.tpl.py").write_text(FOOTER.format(base))
    built(tmp_path)
    program = Running(tmp_path, "sm.py")
    program.until("working")
    program.send(signal.SIGTERM)
    code, _ = program.end()
    assert (code, "tidied" in program.lines) == (143, True)
    assert ("footer" in program.lines) is (base == "Base.tpl.py")


@pytest.mark.parametrize("name", ["sm", "signals", "world"])
def test_a_program_in_the_simulation_stops_too(tmp_path: Path, name: str) -> None:
    pytest.importorskip("pybullet")
    folder_of(tmp_path, SCRIPT.format(base="PyBulletBase", last="Work").replace("sm", name, 1))
    built(tmp_path)
    program = Running(tmp_path, f"{name}.py")
    program.until("working")
    program.send(signal.SIGHUP)
    code, err = program.end()
    assert (code, program.lines[-1]) == (129, "outcome: succeeded")
    assert "Traceback" not in err


def test_main_of_an_imported_program_leaves_the_signals_alone(folder: Path) -> None:
    text = "import sys, signal; sys.path.insert(0, '.'); import sm, threading\n" \
           "print(signal.getsignal(signal.SIGTERM) is signal.SIG_DFL, flush=True)\n" \
           "threading.Thread(target=sm.main).start()\n"  # fmt: skip
    program = Running(folder, "-c", text)
    program.until("working")
    program.send(signal.SIGTERM)
    assert program.end()[0] == -signal.SIGTERM
    assert "True" in program.lines


@pytest.mark.parametrize("words", [["sm.py"], ["-m", "smachac", "run", "main.yml"]])
@pytest.mark.parametrize("base", ["Base", "PyBulletBase"])
def test_a_closed_terminal_stops_the_machine_as_ctrl_c_does(
    tmp_path: Path, base: str, words: list[str]
) -> None:
    if base == "PyBulletBase":
        pytest.importorskip("pybullet")
    folder_of(tmp_path, base=base)
    steps = tmp_path / "steps.py"
    said = '        print("tidied", flush=True)\n'
    note = '        open("tidied", "w").close()\n'
    steps.write_text(steps.read_text().replace(said, said + note))
    built(tmp_path)
    program = OnTerminal(tmp_path, *words)
    program.until(b"working")
    assert program.close() == 129
    assert (tmp_path / "tidied").exists()

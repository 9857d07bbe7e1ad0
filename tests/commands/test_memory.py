"""The memory that a check or build takes, and `--memory-limit`, in processes of their own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.memory import limited_memory

resource = pytest.importorskip("resource")
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="no limit of address space")

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
userdata:
  # smachac: allow SM305 (the size is what counts here)
  k: [{}]
states:
  - A: {{template: ScriptedState, outcomes: [done], transitions: {{done: done}}}}
"""


def run(*words: str, folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "smachac", *words]
    return subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)


@pytest.fixture
def long_list(tmp_path: Path) -> Path:
    """A folder with a script of half a megabyte, most of it one list."""
    text = SCRIPT.format(",".join(str(number % 10) for number in range(250_000)))
    (tmp_path / "main.yml").write_text(text, encoding="utf-8")
    return tmp_path


WORDS = [
    pytest.param(["check"], id="check"),
    pytest.param(["build", "--target", "python"], id="build", marks=pytest.mark.slow),
]


@pytest.mark.parametrize("words", WORDS)
@pytest.mark.slow
def test_a_long_list_takes_little_memory(words: list[str], long_list: Path) -> None:
    """An interpreter with the compiler alone takes 100 MB of address space."""
    ended = run(*words, "main.yml", "--memory-limit", "200", folder=long_list)
    assert ended.returncode == 0, ended.stdout + ended.stderr


@pytest.mark.parametrize("words", WORDS)
def test_beyond_the_limit_the_script_is_refused(words: list[str], long_list: Path) -> None:
    ended = run(*words, "main.yml", "--memory-limit", "110", folder=long_list)
    assert ended.returncode == 1
    assert "there is not enough memory" in ended.stdout + ended.stderr
    assert "Traceback" not in ended.stderr
    assert [path.name for path in long_list.iterdir()] == ["main.yml"]


@pytest.mark.slow
def test_without_a_limit_the_same_script_is_checked(long_list: Path) -> None:
    assert run("check", "main.yml", "--memory-limit", "0", folder=long_list).returncode == 0


def test_an_exhausted_memory_is_a_finding_in_every_format(tmp_path: Path) -> None:
    text = SCRIPT.format("")
    (tmp_path / "main.yml").write_text(text, encoding="utf-8")
    code = (
        "import sys\n"
        "import smachac.driver as driver\n"
        "def exhausted(*words, **more): raise MemoryError\n"
        "driver.check_machine = exhausted\n"
        "from smachac.commands.cli import main\n"
        "sys.exit(main(['check', 'main.yml', '--format', 'json']))\n"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, check=False, capture_output=True, text=True
    )
    assert ended.returncode == 1
    found = json.loads(ended.stdout)
    assert "SM006" in json.dumps(found)
    assert "--memory-limit" in json.dumps(found)


@pytest.mark.parametrize("text", ["-1", "1.5", "many", "9" * 10])
def test_the_limit_is_a_number_of_megabytes(text: str, tmp_path: Path) -> None:
    ended = run("check", "--memory-limit", text, folder=tmp_path)
    assert ended.returncode == 2
    assert "must be a number of megabytes" in ended.stderr


def test_the_limit_of_the_process_is_restored_and_never_raised() -> None:
    before = resource.getrlimit(resource.RLIMIT_AS)
    with limited_memory(50_000):
        assert resource.getrlimit(resource.RLIMIT_AS)[0] == 50_000_000_000
        with limited_memory(60_000):
            assert resource.getrlimit(resource.RLIMIT_AS)[0] == 50_000_000_000
        with limited_memory(0):
            assert resource.getrlimit(resource.RLIMIT_AS)[0] == 50_000_000_000
    assert resource.getrlimit(resource.RLIMIT_AS) == before


@pytest.mark.parametrize("words", WORDS)
@pytest.mark.slow
def test_beyond_the_limit_of_cpu_time_the_command_ends(words: list[str], tmp_path: Path) -> None:
    states = "".join(
        f"  - S{n}: {{template: SleepState, time: 1, transitions: {{succeeded: S{n + 1}}}}}\n"
        for n in range(60_000)
    )
    last = "  - S60000: {template: SleepState, time: 1, transitions: {succeeded: done}}\n"
    head = "name: sm\noutcomes: [done, preempted]\nstates:\n"
    (tmp_path / "main.yml").write_text(head + states + last, encoding="utf-8")
    ended = run(*words, "main.yml", "--time-limit", "1", folder=tmp_path)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr == "the limit of CPU time is exceeded; raise it with `--time-limit`\n"
    assert [path.name for path in tmp_path.iterdir()] == ["main.yml"]


@pytest.mark.parametrize("text", ["x", "-1", "1.5"])
def test_other_limits_of_cpu_time_are_wrong_usage(text: str, tmp_path: Path) -> None:
    ended = run("check", "--time-limit", text, folder=tmp_path)
    assert ended.returncode == 2

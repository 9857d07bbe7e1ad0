"""What `--option main|cmake|package` adds to a header builds, installs, is found and runs."""

from __future__ import annotations

import shutil
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import pytest

from smachac.commands import cli

PATROL = Path(__file__).parents[2] / "examples" / "07_iterator" / "main.yml"
ARM = Path(__file__).parents[2] / "examples" / "08_pick_and_place" / "main.yml"
SPOKEN = "waypoint: door\nwaypoint: window\nwaypoint: shelf\noutcome: succeeded\n"
AMENT = Path("/usr/share/ament_cmake/cmake")
SYSTEM_PYTHON = "-DPython3_EXECUTABLE=/usr/bin/python3"
"""The one that Debian's ament is for."""

USER = """
cmake_minimum_required(VERSION 3.14)
project(user LANGUAGES CXX)
find_package({package} REQUIRED)
add_executable(user "{main}")
target_link_libraries(user PRIVATE {package}::{package})
"""
WAIT = """
name: wait
outcomes: [done, stopped]
states:
  - SIT: {template: SleepState, time: 1000.0, transitions: {succeeded: done, preempted: stopped}}
"""

TIDY = """
name: wait
outcomes: [done, stopped]
states:
  - SIT: {template: SleepState, time: 1000.0, transitions: {succeeded: stopped, preempted: TIDY}}
  - TIDY: {template: SleepState, time: 1000.0, transitions: {succeeded: stopped, preempted: DONE}}
  - DONE: {template: SleepState, time: 0.0, transitions: {succeeded: done, preempted: stopped}}
"""
"""After one stop request it goes on for a long time, in TIDY."""

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

GREETING = """
name: greeting
outcomes: [done]
states:
  - GREET: {template: Greet, transitions: {said: done}}
"""

needs_cmake = pytest.mark.skipif(shutil.which("cmake") is None, reason="cmake is not installed")
needs_ament = pytest.mark.skipif(not AMENT.is_dir(), reason="ament-cmake is not installed")


def built(folder: Path, script: Path, *options: str) -> Path:
    flags = [word for option in options for word in ("--option", option)]
    call = ["build", str(script), "--target", "cpp", "-o", str(folder), *flags]
    assert cli.main(call) == 0
    return folder


def ran(*call: str | Path, status: int = 0) -> str:
    run = subprocess.run(list(map(str, call)), capture_output=True, text=True, check=False)
    assert run.returncode == status, run.stdout + run.stderr
    return run.stdout


def made(folder: Path, *flags: str) -> Path:
    """The build folder of a CMake project, built."""
    ran("cmake", "-S", folder, "-B", folder / "build", *flags)
    ran("cmake", "--build", folder / "build")
    return folder / "build"


def uses(folder: Path, package: str, main: Path, installed: Path) -> Path:
    """The program of a project that finds an installed package."""
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(USER.format(package=package, main=main))
    return made(folder, f"-DCMAKE_PREFIX_PATH={installed}", SYSTEM_PYTHON) / "user"


@needs_cmake
@pytest.mark.slow
def test_a_cmake_project_builds_installs_and_is_found(tmp_path: Path) -> None:
    folder = built(tmp_path / "a project", PATROL, "main=true", "cmake=true")
    installed = tmp_path / "installed"
    build = made(folder, f"-DCMAKE_INSTALL_PREFIX={installed}")
    assert ran(build / "patrol") == SPOKEN
    ran("cmake", "--install", build)
    assert ran(installed / "bin" / "patrol") == SPOKEN
    assert ran(uses(tmp_path / "user", "patrol", folder / "main.cpp", installed)) == SPOKEN


@pytest.mark.slow
@needs_cmake
@needs_ament
def test_a_package_for_colcon(tmp_path: Path) -> None:
    folder = built(tmp_path / "package", PATROL, "main=true", "package=night_watch")
    manifest = ElementTree.parse(folder / "package.xml").getroot()
    assert manifest.findtext("name") == "night_watch"
    assert manifest.findtext("export/build_type") == "ament_cmake"
    installed = tmp_path / "installed"
    build = made(folder, f"-DCMAKE_INSTALL_PREFIX={installed}", SYSTEM_PYTHON)
    ran("cmake", "--install", build)
    assert ran(installed / "lib" / "night_watch" / "patrol") == SPOKEN
    main = folder / "src" / "main.cpp"
    assert ran(uses(tmp_path / "user", "night_watch", main, installed)) == SPOKEN


@pytest.mark.slow
@needs_cmake
def test_classes_of_the_user_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "mein Roboter für alles"
    folder.mkdir()
    monkeypatch.chdir(folder)
    (folder / "main.yml").write_text(GREETING, "utf-8")
    assert cli.main(["new", "state", "Greet", "--target", "cpp", "--outcome", "said"]) == 0
    built(folder / "out", folder / "main.yml", "main=true", "cmake=true")
    assert ran(made(folder / "out") / "greeting") == "outcome: done\n"
    (folder / "include").rename(folder / "else where")
    call = ("cmake", "-S", "out", "-B", "new")
    told = subprocess.run(call, capture_output=True, text=True, check=False)
    assert told.returncode != 0
    assert "-D greeting_INCLUDE=FOLDER says where" in " ".join(told.stderr.split())
    ran(*call, "-Dgreeting_INCLUDE=else where")
    ran("cmake", "--build", "new")
    assert ran("new/greeting") == "outcome: done\n"


@pytest.mark.parametrize(
    ("script", "options"), [(ARM, ()), (PATROL, ("main=true", "cmake=true", "package=night"))]
)
def test_what_was_written_can_be_written_again(
    script: Path, options: Sequence[str], tmp_path: Path
) -> None:
    built(tmp_path, script, *options)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    built(tmp_path, script, *options)
    assert {path: path.read_bytes() for path in before} == before


def test_a_library_without_a_program(tmp_path: Path) -> None:
    folder = built(tmp_path, ARM, "cmake=true")
    assert "add_executable" not in (folder / "CMakeLists.txt").read_text()
    assert (folder / "smachac" / "arm.hpp").exists()
    assert not (folder / "smachac" / "program.hpp").exists()


@pytest.mark.parametrize(
    ("script", "options", "told"),
    [
        (ARM, ["main=true"], "`smachac::World &world` and `smachac::Arm &arm`"),
        (PATROL, ["main=yes"], "`main` must be `true` or `false`, not `yes`"),
        (PATROL, ["package=My-Robot"], "not `My-Robot`"),
    ],
)
def test_options_that_make_no_sense(
    script: Path,
    options: Sequence[str],
    told: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    flags = [word for option in options for word in ("--option", option)]
    call = ["build", str(script), "--target", "cpp", "-o", str(tmp_path / "out"), *flags]
    assert cli.main(call) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.fixture(scope="module")
def waiting(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that waits for a stop request."""
    folder = tmp_path_factory.mktemp("wait")
    (folder / "main.yml").write_text(WAIT)
    return compiled(folder)


@pytest.fixture(scope="module")
def tidying(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that goes on after a stop request."""
    folder = tmp_path_factory.mktemp("tidy")
    (folder / "main.yml").write_text(TIDY)
    return compiled(folder)


def compiled(folder: Path) -> Path:
    """The program of the script in a folder."""
    built(folder, folder / "main.yml", "main=true")
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
    program = folder / "program"
    ran("g++", *flags, "-pthread", f"-I{folder}", folder / "main.cpp", "-o", program)
    return program


@pytest.mark.slow
@pytest.mark.parametrize("number", SIGNALS)
def test_a_stop_signal_preempts_the_machine(waiting: Path, tmp_path: Path, number: int) -> None:
    trace = tmp_path / "trace.jsonl"
    started = subprocess.Popen(
        [waiting, "--trace", trace], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    until_entered(trace, started)
    started.send_signal(number)
    out, err = started.communicate(timeout=60)
    assert (started.returncode, out, err) == (128 + number, "outcome: stopped\n", "")
    assert '"event": "preempt"' in trace.read_text()
    assert trace.read_text().splitlines()[-1].startswith('{"seq": ')


@pytest.mark.slow
@pytest.mark.parametrize(("first", "second"), [*zip(SIGNALS, SIGNALS[::-1], strict=True)])
def test_the_second_signal_ends_a_program_at_once(
    tidying: Path, tmp_path: Path, first: int, second: int
) -> None:
    trace = tmp_path / "trace.jsonl"
    started = subprocess.Popen([tidying, "--trace", trace], stdout=subprocess.PIPE, text=True)
    until_entered(trace, started)
    started.send_signal(first)
    until_entered(trace, started, '"wait/TIDY"')
    started.send_signal(second)
    assert (started.communicate()[0], started.returncode) == ("", 128 + second)
    assert trace.read_text().endswith("\n")


@pytest.mark.slow
def test_sighup_that_nohup_ignores_stays_ignored(waiting: Path, tmp_path: Path) -> None:
    trace = tmp_path / "trace.jsonl"
    started = subprocess.Popen(
        ["sh", "-c", f"trap '' HUP; exec {waiting} --trace {trace}"],
        stdout=subprocess.PIPE,
        text=True,
    )
    until_entered(trace, started)
    started.send_signal(signal.SIGHUP)
    started.send_signal(signal.SIGTERM)
    assert (started.communicate()[0], started.returncode) == ("outcome: stopped\n", 143)


def until_entered(trace: Path, started: subprocess.Popen[str], event: str = '"enter"') -> None:
    """Wait until a state runs, or until another event: it is in the trace at once."""
    while not (trace.exists() and event in trace.read_text()):
        assert started.poll() is None


@pytest.mark.slow
def test_arguments_and_a_trace_that_cannot_be_written(waiting: Path, tmp_path: Path) -> None:
    ran(waiting, "--speed", status=2)
    ran(waiting, "--trace", tmp_path / "no" / "folder.jsonl", status=1)

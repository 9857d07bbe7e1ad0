"""Every example is checked, compiled, linted and run; the arm's results are looked at."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.support.examples import every

ROOT = Path(__file__).parents[2] / "examples"
EXAMPLES = sorted(path.parent.name for path in ROOT.glob("*/main.yml"))
ON_THE_ARM = {name for name in EXAMPLES if name >= "08"}


def script(name: str) -> str:
    return str(ROOT / name / "main.yml")


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the Python of all examples."""
    folder = tmp_path_factory.mktemp("built")
    for name in EXAMPLES:
        assert main(["build", script(name), "--target", "python", "-o", str(folder / name)]) == 0
    return folder


def test_there_are_fourteen() -> None:
    assert len(EXAMPLES) == 14


@pytest.mark.parametrize("name", EXAMPLES)
def test_checks_without_a_warning(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    # Example 10 is a script as it was printed, with outcomes that lead nowhere.
    strict = ["--strict"] if name != "10_baxter_pick_and_place" else []
    assert main(["check", *strict, script(name)]) == 0, capsys.readouterr().out


OUTCOMES = {"14_delivery_round": "done"}
"""The outcomes of success that have another name than `succeeded`."""


@pytest.mark.parametrize("name", every(2, EXAMPLES))
def test_runs(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    expected = OUTCOMES.get(name, "succeeded")
    assert main(["run", script(name), "--expect", expected]) == 0, capsys.readouterr().err


@pytest.mark.parametrize("name", every(2, sorted(set(EXAMPLES) - ON_THE_ARM)))
def test_the_file_runs_alone_with_warnings_as_errors(name: str, built: Path) -> None:
    (path,) = (built / name).glob("*.py")
    ended = subprocess.run(
        [sys.executable, "-W", "error", str(path)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.rstrip().endswith(f"outcome: {OUTCOMES.get(name, 'succeeded')}")


@pytest.mark.parametrize("tool", [["check"], ["format", "--check"]], ids=lambda tool: tool[0])
def test_ruff_finds_nothing(tool: list[str], built: Path) -> None:
    ended = subprocess.run(
        [
            sys.executable,
            "-m",
            "ruff",
            *tool,
            "--isolated",
            "--no-cache",
            "--line-length=99",
            built,
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert ended.returncode == 0, ended.stdout


@pytest.mark.slow
def test_mypy_finds_nothing(built: Path) -> None:
    for path in sorted(built.glob("*/*.py")):
        ended = subprocess.run(
            [sys.executable, "-m", "mypy", "--config-file=", "--ignore-missing-imports", str(path)],
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert ended.returncode == 0, ended.stdout


BUILDS = r"""
import sys
from smachac.commands.cli import main
for script in sys.argv[1:]:
    for target in ("python", "dot", "ir", "json"):
        print(f"\0{script} {target}", flush=True)
        assert main(["build", script, "-t", target, "-o", "-"]) == 0
"""


@pytest.mark.slow
def test_output_does_not_depend_on_the_hash_seed() -> None:
    """The output of each example for each target, by `script target`, with two hash seeds."""
    found = []
    for seed in ("1", "2"):
        ended = subprocess.run(
            [sys.executable, "-c", BUILDS, *map(script, EXAMPLES)],
            capture_output=True,
            text=True,
            timeout=120,
            check=True,
            env={"PYTHONHASHSEED": seed, "PATH": ""},
        )
        parts = ended.stdout.split("\0")[1:]
        found.append(dict(part.split("\n", 1) for part in parts))
    first, second = found
    assert len(first) == len(second) == 4 * len(EXAMPLES)
    assert all(first.values())
    assert [name for name in first if first[name] != second[name]] == []

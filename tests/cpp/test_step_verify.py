"""`smachac verify --option mode=step`: the paths of scripts on compiled stepped machines.

All scripts of tests/cases that can be stepped are in one program.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.driver import analyse_script
from smachac.ir.types import Bounds
from smachac.verify.players.cpp_step_program import HOSTED
from tests.cpp.compilers import BARE, SANITIZED, compilers, last_with
from tests.cpp.step_programs import Played, disagreements, played, text

ROOT = Path(__file__).parents[2]
BOUNDS = Bounds(text=32, list=8)


def scripts() -> list[Path]:
    folders = [*(ROOT / "tests" / "cases").iterdir(), *(ROOT / "examples").iterdir()]
    found = [folder / "main.yml" for folder in folders if not folder.name.startswith("bad_")]
    return sorted(path for path in found if path.exists())


def machines() -> list[Played]:
    found = []
    for number, path in enumerate(scripts()):
        machine = analyse_script(path, [], []).checked
        if machine is not None:
            found.append(played(machine, f"script_{number}", BOUNDS))
    return [each for each in found if each is not None]


@pytest.mark.slow
@pytest.mark.parametrize("flags", [BARE, (*BARE, *SANITIZED)], ids=["bare", "sanitized"])
def test_paths_of_scripts_agree(flags: tuple[str, ...], tmp_path: Path) -> None:
    compiler = last_with(*flags)
    every = machines()
    assert len(every) >= 15
    printed = compiler.run(text(every, HOSTED), tmp_path, *flags)
    assert [*disagreements(every, printed)] == []


def test_command(capsys: pytest.CaptureFixture[str]) -> None:
    if not compilers():
        pytest.skip("no C++ compiler")
    script = str(ROOT / "examples" / "03_concurrence" / "main.yml")
    options = ["--option", "mode=step", "--option", "text=32", "--paths", "20"]
    assert main(["verify", script, "--targets", "cpp", *options]) == 0
    assert "cpp: agrees" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("option", "words"),
    [
        ("mode=fast", "`mode` must be `blocking` or `step`"),
        ("text=-1", "`text` must be a number"),
        ("depth=1", "has no option `depth`"),
    ],
)
def test_wrong_options(option: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    script = str(ROOT / "examples" / "03_concurrence" / "main.yml")
    assert main(["verify", script, "--targets", "cpp", "--option", option]) == 2
    assert words in capsys.readouterr().err

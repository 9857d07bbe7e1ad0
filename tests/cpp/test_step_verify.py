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


EXPRESSIONS = """
name: sm
outcomes: [done, failed]
input_keys: {n: int, x: float, side: str, names: "list[str]", sizes: "list[int]", at: "float[3]"}
states:
  - COMPUTE:
      template: CallbacksState
      input_keys: [n, x, side, names, sizes, at]
      output_keys: [i, f, b, t, sizes, names, at, o]
      callbacks:
        i: 'lambda ud: ud.n // 2 + ud.n % 4 - abs(-ud.n) * len(ud.names) + int(ud.x)'
        f: 'lambda ud: ud.n / 2 + ud.x ** 2 + ud.at[-1] + max(ud.sizes) + sum(ud.sizes)'
        b: 'lambda ud: 0 < ud.n <= 7 and ud.side in ["left", "right"] and "e" in ud.side'
        t: 'lambda ud: ud.names[1] if ud.n > 3 else ud.side or "nothing"'
        sizes: 'lambda ud: [ud.n] + ud.sizes + [4]'
        names: 'lambda ud: [ud.side] + ud.names'
        at: 'lambda ud: [ud.x, 1, ud.at[0]]'
        o: 'lambda ud: ud.n if ud.n > 100 else None'
      transitions: {succeeded: JUDGE}
  - JUDGE:
      template: ConditionalOutcomeState
      input_keys: [i, f, b, t, sizes, names, n]
      outcomes: [one, two, three, other]
      default_outcome: other
      callbacks:
        one: 'lambda ud: ud.sizes + [4] != [7] and ud.names + ["z"] != ["left", "z"]'
        two: 'lambda ud: ud.n // (ud.n - 7) > 0'
        three: 'lambda ud: ud.t == "bc" or not ud.b'
      transitions: {one: TRY, two: done, three: failed, other: failed}
  - TRY:
      template: CallbacksState
      input_keys: [sizes, n]
      output_keys: [n]
      callbacks: {n: 'lambda ud: ud.sizes[ud.n + 90]'}
      transitions: {succeeded: done, error: LONG}
  - LONG:
      template: CallbacksState
      input_keys: [sizes]
      output_keys: [sizes]
      callbacks: {sizes: 'lambda ud: ud.sizes + ud.sizes'}
      transitions: {succeeded: done, error: failed}
"""


def test_expressions_have_the_values_of_python(tmp_path: Path) -> None:
    if not compilers():
        pytest.skip("no C++ compiler")
    (tmp_path / "main.yml").write_text(EXPRESSIONS)
    analysis = analyse_script(tmp_path / "main.yml", [], [])
    assert analysis.checked is not None, analysis.report
    one = played(analysis.checked, "expressions", BOUNDS)
    assert one is not None
    printed = compilers()[0].run(text([one], HOSTED), tmp_path, *BARE)
    different = [*disagreements([one], printed)]
    assert different == []


def machines() -> list[Played]:
    found = []
    for number, path in enumerate(scripts()):
        machine = analyse_script(path, [], []).checked
        if machine is not None:
            found.append(played(machine, f"script_{number}", BOUNDS))
    return [item for item in found if item is not None]


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

"""Files of the user are not overwritten unless the command line demands it."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [succeeded]
states:
- A: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
"""


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(SCRIPT)
    return path


@pytest.mark.parametrize(
    "text", ["my notes", "{}", '{"version": 2}', "Made by smachac 0.1", '[{"version": 2}]']
)
def test_a_baseline_overwrites_only_a_baseline(script: Path, text: str) -> None:
    path = script.with_name("known.json")
    words = ["check", str(script), "--write-baseline", "--baseline"]
    path.write_text(text)
    assert main([*words, str(path)]) == 2
    assert main([*words, str(script)]) == 2
    assert (path.read_text(), script.read_text()) == (text, SCRIPT)
    path.unlink()
    assert main([*words, str(path)]) == 0
    assert main([*words, str(path)]) == 0
    path.write_text('{"version": 1, "findings": []}')
    assert main([*words, str(path)]) == 0


def test_a_trace_overwrites_only_a_trace(script: Path) -> None:
    trace = script.with_name("t.jsonl")
    scenario = script.with_name("scenario.yml")
    scenario.write_text("states: {A: [done]}\n")
    words = ["run", str(script), "--mock", str(scenario), "-q", "--trace"]
    assert main([*words, str(script)]) == 2
    assert script.read_text() == SCRIPT
    assert main([*words, str(trace)]) == 0
    assert main([*words, str(trace)]) == 0
    trace.write_text('{"seq": 5}\nmine\n')
    assert main([*words, str(trace)]) == 2
    assert main([*words, "/dev/null"]) == 0


def test_a_film_overwrites_only_a_film(script: Path) -> None:
    film = script.with_name("x.gif")
    film.write_text("my notes")
    assert main(["run", str(script), "--record", str(film)]) == 2
    assert film.read_text() == "my notes"


@pytest.mark.parametrize(
    "text",
    [
        'print("Made by smachac 0.1.0")\n',
        "#\n#\n#\n#\n# Made by smachac 0.1.0 from main.yml\n",
        "# my notes about files Made by smachac 0.1.0\n",
    ],
)
def test_a_file_that_mentions_the_mark_is_not_ours(script: Path, text: str) -> None:
    made = script.with_name("sm.py")
    words = ["build", str(script), "-t", "python", "-o", str(script.parent)]
    made.write_text(text)
    assert main(words) == 1
    assert made.read_text() == text
    assert main([*words, "--force"]) == 0
    assert main(words) == 0


def test_links_at_the_output_are_not_replaced(script: Path) -> None:
    made, target = script.with_name("sm.py"), script.with_name("target.py")
    words = ["build", str(script), "-t", "python", "-o", str(script.parent)]
    for text in (None, "# Made by smachac 0.1.0\n"):
        made.unlink(missing_ok=True)
        made.symlink_to(target)
        if text is not None:
            target.write_text(text)
        assert main(words) == 1
        assert made.is_symlink()
    assert main([*words, "--force"]) == 0
    assert not made.is_symlink()
    assert target.read_text() == "# Made by smachac 0.1.0\n"


def test_a_linked_folder_below_the_output_is_not_entered(script: Path) -> None:
    out, elsewhere = script.with_name("out"), script.with_name("elsewhere")
    words = ["build", str(script), "-t", "cpp", "-o", str(out)]
    assert main(words) == 0
    assert main(words) == 0
    (out / "smachac").rename(elsewhere)
    (out / "smachac").symlink_to(elsewhere)
    assert main(words) == 1


def test_only_the_whole_mark_makes_a_file_ours(script: Path) -> None:
    path = script.with_name("sm.json")
    words = ["build", str(script), "-t", "json", "-o", str(script.parent)]
    for text in ("# Made by smachac is what my notes are about\n", "# Made by smachac\n"):
        path.write_text(text)
        assert main(words) == 1
        assert path.read_text() == text
    path.unlink()
    assert main(words) == 0
    assert main(words) == 0

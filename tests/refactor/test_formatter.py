"""The layout of scripts: the goldens in tests/formatting, and laws for any script."""

from __future__ import annotations

import os
import random
import re
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.frontend.text.yaml_tree import parse
from smachac.ir.printer import print_machine
from smachac.refactor.formatter import WIDTH, format_script
from tests.support.examples import seeds
from tests.support.golden import compare_file
from tests.trust.project_text import MAIN, written
from tests.trust.random_projects import correct_project

ROOT = Path(__file__).parents[1]
LAYOUTS = sorted((ROOT / "formatting").glob("*/before.yml"))
SCRIPTS = [
    path.read_text("utf-8")
    for folder in (ROOT.parent / "examples", ROOT / "cases", ROOT / "formatting")
    for path in sorted(folder.glob("*/*.yml"))
    if 20 < path.stat().st_size < 6000
]


def lay_out(text: str, spelling: str = "kept") -> str | None:
    return format_script(Source("x.yml", text), spelling)  # type: ignore[arg-type]


@pytest.mark.parametrize("before", LAYOUTS, ids=lambda path: path.parent.name)
@pytest.mark.parametrize("spelling", ["kept", "short", "long"])
def test_golden_layout(before: Path, spelling: str) -> None:
    found = lay_out(before.read_bytes().decode(), spelling)
    assert found is not None
    compare_file(found, before.with_name(f"{spelling}.yml"))
    assert lay_out(found, spelling) == found


EXAMPLES = [
    path
    for path in sorted((ROOT.parent / "examples").glob("*/*.yml"))
    if "template:" in path.read_text("utf-8")  # scenes and faults are not scripts
    and path.parent.name != "10_baxter_pick_and_place"  # in the layout of the paper
]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_the_examples_are_laid_out(path: Path) -> None:
    assert lay_out(path.read_text("utf-8")) == path.read_text("utf-8")


def machine_text(files: dict[str, str]) -> str:
    library = memory_library(files, disk_library(ROOT / "main.yml", []))
    analysis = analyse(Source(MAIN, files[MAIN]), library, [])
    assert analysis.machine is not None
    return re.sub(r"(?m)^digest .*\n", "", print_machine(analysis.machine))


def with_comments(text: str, seed: int) -> tuple[str, Counter[str]]:
    """Comments behind lines, between them and deeper than them, each another one."""
    draw = random.Random(seed)
    lines, comments = [], []
    for number, line in enumerate(text.split("\n")):
        comment = f"# comment {number}"
        kind = draw.randrange(8)
        margin = " " * draw.randrange(8)
        if kind == 0 and line.strip() and line.count('"') % 2 == 0:
            lines.append(f"{line}  {comment}")
        elif kind in (1, 2):
            lines += [margin + comment, *[""] * draw.randrange(3), line]
        else:
            lines.append(line)
            continue
        comments.append(comment)
    return "\n".join(lines), Counter(comments)


FIRST_QUICK = seeds(4, 8, 24)


@pytest.mark.parametrize("seed", FIRST_QUICK)
def test_a_project_means_the_same_and_keeps_its_comments(seed: int) -> None:
    files = {name: written(data).text for name, data in correct_project(seed).items()}
    before = machine_text(files)
    for spelling in ("kept", "short", "long"):
        new = {}
        for name, text in files.items():
            if not name.endswith(".yml"):
                new[name] = text
                continue
            remarked, comments = with_comments(text, seed)
            found = lay_out(remarked, spelling)
            assert found is not None
            assert Counter(re.findall(r"# comment \d+", found)) == comments
            assert lay_out(found, spelling) == found
            new[name] = found
        assert machine_text(new) == before


SIGNS = tuple("{}[]:,-?|>#&*!'\"`~")
PHRASES = ("[params, x]", "[[x]]", "&a ", "*a", "<<: *a", "|\n", ">+2", "# c\n", "\n\n", "é", "\t")
PIECES = st.sampled_from([*SIGNS, *PHRASES, "  ", "\n", "- ", "states", "\u2028", "\U0001f600"])
DAMAGE = st.tuples(st.floats(0, 1), st.integers(0, 20), PIECES)


@settings(max_examples=400)
@given(st.sampled_from(SCRIPTS), st.lists(DAMAGE, min_size=1, max_size=4), st.booleans())
@pytest.mark.slow
def test_whatever_is_yaml_can_be_laid_out_once_for_all(
    text: str, damage: list[tuple[float, int, str]], crlf: bool
) -> None:
    for where, removed, piece in damage:
        at = int(where * len(text))
        text = text[:at] + piece + text[at + removed :]
    if crlf:
        text = text.replace("\n", "\r\n")
    if parse(Source("x.yml", text), []) is None:
        return
    for spelling in ("kept", "short", "long"):
        found = lay_out(text, spelling)
        if found is not None:
            assert lay_out(found, spelling) == found
            assert ("\r\n" in found) == ("\r\n" in text[: text.find("\n") + 1])


@pytest.mark.parametrize("text", ["states:\n  - # x\n", "states:\n  -\n  # x\n"])
def test_a_comment_at_an_empty_item_is_left_alone(text: str) -> None:
    """A comment there went above the dash and below it again, in turn (found by fuzzing)."""
    assert lay_out(text) is None


def test_long_and_short_are_two_forms_of_one_script() -> None:
    for seed in range(10):
        for data in correct_project(seed).values():
            text = written(data).text
            long = lay_out(text, "long")
            short = lay_out(text, "short")
            assert lay_out(short or "", "long") == long
            assert lay_out(long or "", "short") == short


def test_lines_in_brackets_are_broken() -> None:
    names = ", ".join(f"outcome_number_{number}" for number in range(9))
    found = lay_out(f"name: sm\noutcomes: [{names}]\nstates: []\n")
    assert found is not None
    assert max(map(len, found.splitlines())) <= WIDTH
    assert found.count("\n") == 4


SCRIPT = """\
name: sm
states:
- A: {T: ScriptedState, t: {ok: done}, o: [ok]}   # one
outcomes: [done]
"""
LAID = """\
name: sm
outcomes: [done]
states:
  - A: {T: ScriptedState, o: [ok], t: {ok: done}}   # one
"""


def test_fmt_writes_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    script = tmp_path / "main.yml"
    script.write_bytes(b"\xef\xbb\xbf" + SCRIPT.replace("\n", "\r\n").encode())
    script.chmod(0o640)
    os.chdir(tmp_path)
    assert main(["fmt", "--check"]) == 1
    assert capsys.readouterr().out == "main.yml would be formatted\n"
    assert main(["fmt", "main.yml", "--diff"]) == 1
    assert "+outcomes: [done]" in capsys.readouterr().out
    assert main(["fmt"]) == 0
    assert capsys.readouterr().out == "formatted main.yml\n"
    assert script.read_bytes() == b"\xef\xbb\xbf" + LAID.replace("\n", "\r\n").encode()
    assert script.stat().st_mode & 0o777 == 0o640
    assert main(["fmt", "--check"]) == 0
    assert main(["fmt", "--longhand"]) == 0
    assert "template: ScriptedState" in script.read_text("utf-8-sig")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["main.yml"]


def test_fmt_leaves_alone_what_it_cannot_read_or_write(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.yml").write_text(SCRIPT)
    (tmp_path / "good.yml").chmod(0o444)
    assert main(["fmt", "good.yml"]) == 1
    assert capsys.readouterr().err == "nothing was written: good.yml: Permission denied\n"
    assert (tmp_path / "good.yml").read_text() == SCRIPT
    (tmp_path / "bad.yml").write_text("name: sm\nstates: [\n")
    assert main(["fmt", "bad.yml"]) == 1
    assert "error[SM001]" in capsys.readouterr().err
    (tmp_path / "odd.yml").write_text("%YAML 1.2\n---\nname: sm\nstates: []\n")
    assert main(["fmt", "odd.yml"]) == 1
    assert "odd.yml was not changed" in capsys.readouterr().err
    assert main(["fmt", "nowhere"]) == 1
    assert main(["fmt", "*.yaml"]) == 2


def test_a_state_that_is_an_anchor_comes_before_its_aliases() -> None:
    text = "name: sm\nstates:\n  - A: {transitions: &t {ok: done}, template: X, userdata: *t}\n"
    found = lay_out(text)
    assert found == text  # in order the alias would stand before its anchor

"""Names that are corrected: when that is certain, what is kept, what is written."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.commands.cli import main
from smachac.commands.files import ChangedError, rewrite_files
from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    Severity,
    fingerprint,
    has_errors,
)
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import Guesser, respelt
from smachac.driver.batch import Batch, check_scripts
from smachac.frontend.files import Disk
from smachac.refactor.autofix import FixResult, apply_fixes

NAMES = ["PICK_BLOCK", "PLACE_BLOCK", "PICK_1", "GRASP", "LEFT", "done", "aborted", "Left_Arm"]


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("PALCE_BLOCK", "PLACE_BLOCK"),
        ("PLACE_BLOK", "PLACE_BLOCK"),
        ("PLACE_BLOCKS", "PLACE_BLOCK"),
        ("PLACE_BLACK", "PLACE_BLOCK"),
        ("pick_block", "PICK_BLOCK"),
        ("GRAPS", "GRASP"),
        ("PICK_2", None),  # another number is another thing
        ("PICK_", None),
        ("LIFT", None),  # a word of its own
        ("PARSG", None),
        ("dne", None),
        ("DONE", "done"),
        ("nothing", None),
        ("GRASP", None),
    ],
)
def test_what_was_meant_for_certain(word: str, meant: str | None) -> None:
    assert Guesser(NAMES).unique_match(word) == meant


def test_of_two_names_as_near_none_is_certain() -> None:
    assert Guesser(["GRASP_A", "GRASP_B"]).unique_match("GRASP_C") is None
    assert Guesser(["GRASP_A", "grasp_a"]).unique_match("Grasp_A") is None
    assert Guesser(["GRASP_A", "OTHER"]).unique_match("GRASP_C") == "GRASP_A"


@pytest.mark.parametrize(
    ("written", "name", "text"),
    [
        ("PIKC", "PICK", "PICK"),
        ("'PIKC'", "PICK", "'PICK'"),
        ('"PIKC"', "PICK", '"PICK"'),
        ("[[x]]", "PICK", None),  # a look-up
        ("PIKC", "no", None),
        ("PIKC", "a: b", None),
        ("PIKC", None, None),
    ],
)
def test_respelling(written: str, name: str | None, text: str | None) -> None:
    span = Span(Source("main.yml", f"a: {written} "), 3, 3 + len(written))
    edits = respelt(Word("PIKC", span), name)
    assert [edit.text for edit in edits] == ([text] if text else [])


BAD = """\
name: sm
template: Base
outcomes: [done, aborted]
states:
  - GRASP_IT:
      template: ScriptedState
      outcomes: [there, slipped]
      transitions: {there: LIFT_IT, sliped: abroted}
  - LIFT_IT: {script: lfit, transitions: {up: done}}
"""
SUB = """\
- LIFT:
    template: StateMachine
    outcomes: [up]
    states:
      - RAISE: {template: ScriptedStat, outcomes: [ok], transitions: {ok: WAIT_FOR_IT}}
      - WAIT_FOR_TI: {template: ScriptedState, outcomes: [ok], transitions: {ok: up}}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "sub").mkdir()
    (tmp_path / "main.yml").write_text(BAD)
    (tmp_path / "smachac.toml").write_text('scripts = ["sub"]\n')
    (tmp_path / "sub" / "lift.yml").write_text(SUB)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_names_are_corrected_in_every_file(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "main.yml").chmod(0o640)
    assert main(["check", "main.yml"]) == 1
    assert "(3 fixable with --fix)" in capsys.readouterr().out
    assert main(["check", "--fix"]) == 0
    assert capsys.readouterr().out == "no findings (5 fixed)\n"
    assert main(["check", "--fix"]) == 0
    right = BAD.replace("sliped", "slipped").replace("abroted", "aborted")
    assert (folder / "main.yml").read_text() == right.replace("lfit", "lift")
    assert (folder / "main.yml").stat().st_mode & 0o777 == 0o640
    text = SUB.replace("ScriptedStat,", "ScriptedState,").replace("TI: {", "TI: {")
    assert (folder / "sub" / "lift.yml").read_text() == text.replace("FOR_IT", "FOR_TI")
    assert sorted(path.name for path in folder.iterdir()) == ["main.yml", "smachac.toml", "sub"]


def test_a_diff_is_a_patch_and_writes_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = BAD.replace("lfit", "lift").rstrip("\n")
    (folder / "main.yml").write_bytes(text.replace("\n", "\r\n").encode())
    assert main(["check", "--diff"]) == 1
    shown = capsys.readouterr()
    assert shown.err == "--fix would fix 4 findings in 2 files\n"
    assert "\\ No newline at end of file" in shown.out
    assert (folder / "sub" / "lift.yml").read_text() == SUB
    assert main(["check", "--fix"]) == 0
    fixed = [(folder / name).read_bytes() for name in ("main.yml", "sub/lift.yml")]
    (folder / "main.yml").write_bytes(text.replace("\n", "\r\n").encode())
    (folder / "sub" / "lift.yml").write_text(SUB)
    patch = ["git", "apply", "-p0", "--unsafe-paths", f"--directory={folder}", "-"]
    subprocess.run(patch, input=shown.out.encode(), check=True, cwd=folder.parent)
    assert [(folder / name).read_bytes() for name in ("main.yml", "sub/lift.yml")] == fixed
    capsys.readouterr()
    assert main(["check", "--diff"]) == 0
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("options", [["--select", "SM2"], ["--ignore", "SM"]])
def test_a_fix_that_adds_an_error_is_not_written(
    options: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: ScriptedState, outcomes: [ok], transition: {ok: done},"
        " transitions: {ok: dnoe}}\n"
    )
    (folder / "main.yml").write_text(text)
    assert main(["check", "main.yml", "--fix", *options]) == 1  # such codes count too
    # Both keys would be `transitions`; the target is corrected on its own.
    assert (folder / "main.yml").read_text() == text.replace("dnoe", "done")
    assert "(1 fixed)" in capsys.readouterr().out


def test_what_was_changed_meanwhile_is_left(tmp_path: Path) -> None:
    path, other = str(tmp_path / "a.yml"), str(tmp_path / "b.yml")
    for name in (path, other):
        Path(name).write_text("old")
    sources = {name: Source(name, "old") for name in (path, other)}
    Path(other).write_text("newer")
    with pytest.raises(ChangedError, match=r"b\.yml was changed"):
        rewrite_files({path: "new", other: "new"}, sources)
    assert Path(path).read_text() == "old"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_the_encoding_stays(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "a.yml"
    path.write_bytes("\u00fc: \u2713\r\n".encode(encoding))
    link = tmp_path / "link.yml"
    link.symlink_to(path)
    name = os.path.realpath(link)
    rewrite_files({name: "\u2713\r\n"}, {name: Source(name, "\u00fc: \u2713\r\n")})
    assert path.read_bytes() == "\u2713\r\n".encode(encoding)
    assert link.is_symlink()


def test_a_fix_that_shows_more_errors_is_not_written(folder: Path) -> None:
    state = "template: SleepStat, tiem: 1, lenght: 2, hieght: 3, widht: 4"
    text = BAD.replace("script: lfit", state).replace("up: done", "succeeded: done")
    text = text.replace("sliped: abroted", "slipped: aborted")
    (folder / "main.yml").write_text(text)
    assert main(["check", "main.yml", "--fix"]) == 1
    assert (folder / "main.yml").read_text() == text


def look(texts: Mapping[str, str]) -> Batch:
    return check_scripts(
        [Path("main.yml")], Disk({os.path.realpath("main.yml"): texts["main.yml"]})
    )


def tried(text: str) -> FixResult:
    before = look({"main.yml": text})

    def again(texts: Mapping[str, str]) -> Batch:
        return look({"main.yml": next(iter(texts.values()))})

    return apply_fixes(before, lambda batch: batch.report, again)


KEYS = """\
name: sm
template: Base
outcomes: [held]
userdata: {pose: 0.5, speed: 1.0, name: block}
states:
  - PICK:  # a container
      # that takes nothing in
      template: StateMachine
      outcomes: [done]
      states:
        - REACH: {template: StateMachine, outcomes: [done], transitions: {done: GRASP}, states: [
            LOOK: {template: PrintUserdataState, input_keys: [pose, speed],
                   transitions: {succeeded: done}}]}
        - GRASP:
            template: StateMachine
            outcomes: [done]
            input_keys:
              - name  # of the block
            states:
              - HOLD:
                  template: PrintUserdataState
                  input_keys: [name, pose]
                  transitions: {succeeded: done}
      transitions: {done: held}
"""


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_keys_are_taken_in_by_every_container_between(end: str, tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_bytes(KEYS.replace("\n", end).encode())
    assert main(["check", str(path), "--fix"]) == 0
    text = path.read_bytes().decode()
    assert text.replace("\r\n", "\n").count("\r") == 0
    lines = [line.strip() for line in text.split(end)]
    at = lines.index("- PICK:  # a container")
    assert lines[at + 2 : at + 4] == ["# that takes nothing in", "template: StateMachine"]
    assert lines[at + 1].startswith("input_keys: [")
    assert {"pose", "speed", "name"} == set(lines[at + 1].partition("[")[2][:-1].split(", "))
    assert "- REACH: {input_keys: [" in text
    assert f"              - name  # of the block{end}              - pose{end}" in text
    old = KEYS.splitlines()
    assert [line for line in text.splitlines() if line in old] == [
        line for line in old if "- REACH" not in line
    ]  # the layout stays


def transition(target: str, more: str = "") -> str:
    """A script that is not formatted, with one transition."""
    return (
        "name:   sm\ntemplate: Base\noutcomes: [ placed,aborted ]\nstates:\n\n\n"
        "  - PICK_BLOCK: {transitions: {picked:  " + target + ", left: PLACE_BLOCK},"
        " outcomes: [picked, left], template: ScriptedState}\n"
        "  - PLACE_BLOCK:\n      template: ScriptedState\n"
        "      outcomes: [there]\n      transitions: {there: placed}\n" + more
    )


@pytest.mark.parametrize(
    ("target", "fixed"),
    [
        ("PALCE_BLOCK", "PLACE_BLOCK"),
        ("place_block", None),  # the case alone
        ("abroted", "aborted"),
        ("ABROTED", None),  # a state that is missing
        ("ABORTED", None),
    ],
)
def test_a_target_stays_of_its_kind(
    target: str, fixed: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(transition(target))
    main(["check", str(path)])
    assert ("fixable" in capsys.readouterr().out) == (fixed is not None)
    main(["check", str(path), "--fix"])
    assert path.read_text() == transition(fixed or target)
    assert ("(1 fixed)" in capsys.readouterr().out) == (fixed is not None)


@pytest.mark.parametrize(
    "more",
    [
        "      outcomes: [there]\n",  # twice: SM002
        "  - PICK_BLOCK: {template: ScriptedState, outcomes: [there]}\n",  # SM106
    ],
)
def test_an_unclear_script_gets_no_fixes(
    more: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(transition("PALCE_BLOCK", more))
    assert main(["check", str(path)]) == 1
    assert "fixable" not in capsys.readouterr().out
    assert main(["check", str(path), "--fix"]) == 1
    assert path.read_text() == transition("PALCE_BLOCK", more)


COMMENTS = """\
name: sm
template: Base
outcomes: [done]
states:
  # smachac: allow SM201 it was not reached once
  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: B}}  # smachac: allow SM101 so
  # kept
  - B:  # smachac: allow SM201, SM999 both of no use
      template: ScriptedState
      # smachac: allow SM105, SM201: one of use
      outcomes: [ok, bad]
      transitions: {ok: done}
"""


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_comments_of_no_use_are_removed(end: str, tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    text = COMMENTS.replace(", SM999", ", SM202").replace("      # smachac: allow SM105, SM201", "")
    text = text.replace("ok, bad", "ok").replace(": one of use\n", "")
    path.write_bytes(text.replace("\n", end).encode())
    assert main(["check", str(path), "--fix"]) == 0
    assert path.read_bytes().decode().replace(end, "\n") == (
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: B}}\n  # kept\n"
        "  - B:\n      template: ScriptedState\n      outcomes: [ok]\n"
        "      transitions: {ok: done}\n"
    )


def test_of_a_comment_with_two_codes_the_useless_one_goes(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    text = "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n" + (
        "  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n"
        "  # smachac: allow SM201, SM202: an operator starts it\n"
        "  - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n"
    )
    path.write_text(text)
    assert main(["check", str(path), "--fix"]) == 0
    assert "  # smachac: allow SM201, an operator starts it\n" in path.read_text()


OUTPUTS = """\
name: sm
template: Base
outcomes: [held]
userdata: {tries: 0}
states:
  - FIND:
      template: StateMachine
      outcomes: [found]
      transitions: {found: COUNT}
      states:
        - LOOK:
            template: ScriptedState
            outcomes: [seen]
            output_keys: [pose]
            steps: [{outcome: seen, set: {pose: 0.5}}]
            transitions: {seen: found}
  - COUNT:
      template: CallbacksState
      input_keys: [tries]
      callbacks: {tries: 'lambda ud: ud.tries + 1'}
      transitions: {succeeded: GRASP}
  - GRASP:
      template: PrintUserdataState
      input_keys: [pose, tries]
      transitions: {succeeded: held}
"""


def test_outputs_that_are_kept_or_dropped_are_handed_out(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(OUTPUTS)
    assert main(["check", str(path)]) == 1
    assert main(["check", str(path), "--fix"]) == 0
    found = OUTPUTS.replace("- FIND:\n", "- FIND:\n      output_keys: [pose]\n")
    assert path.read_text() == found.replace("- COUNT:\n", "- COUNT:\n      output_keys: [tries]\n")


def test_an_output_that_was_misspelt_is_not_added(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    text = OUTPUTS.replace(
        "callbacks: {tries:", "output_keys: [counted]\n      callbacks: {counter:"
    )
    path.write_text(text)
    assert main(["check", str(path), "--fix"]) == 1
    assert "output_keys: [counted]\n" in path.read_text()


LETTERS = st.sampled_from("abdefgilnoprstuPLACEKX_:{, ")


@settings(max_examples=60)
@given(st.lists(st.tuples(st.integers(0, 400), LETTERS, st.integers(0, 1)), max_size=4))
@pytest.mark.slow
def test_fixes_never_make_it_worse(damage: list[tuple[int, str, int]]) -> None:
    text = (
        "name: sm\ntemplate: Base\noutcomes: [placed, aborted]\nstates:\n"
        "  - PICK_BLOCK:\n      template: ScriptedState\n      outcomes: [picked, slipped]\n"
        "      transitions: {picked: PLACE_BLOCK, slipped: RELEASE}\n"
        "  - PLACE_BLOCK:\n      template: ScriptedState\n      outcomes: [there, blocked]\n"
        "      transitions: {there: placed, blocked: RELEASE}\n"
        "  - RELEASE: {template: ScriptedState, outcomes: [open], transitions: {open: aborted}}\n"
    )
    for at, letter, cut in damage:
        at %= len(text)
        text = text[:at] + letter + text[at + cut :]
    before = look({"main.yml": text}).report
    result = tried(text)
    after = result.batch.report
    errors = [fingerprint(item) for item in after if item.severity is Severity.ERROR]
    assert len(errors) <= sum(item.severity is Severity.ERROR for item in before)
    assert set(errors) <= {fingerprint(item) for item in before}
    if result.count:
        assert len(after) < len(before) or not has_errors(after)
        (corrected_text,) = result.texts.values()
        assert look({"main.yml": corrected_text}).report == after or corrected_text != text
    else:
        assert result.texts == {}


def edit(number: int, start: int, end: int, text: str, source: Source) -> Diagnostic:
    edits = (Edit(span=Span(source, start, end), text=text),)
    template = look({"main.yml": "name: sm\n"}).report[0]
    finding = Finding(span=edits[0].span, message="", arguments=(f"{number}",), edits=edits)
    return Diagnostic(kind=template.kind, severity=Severity.ERROR, finding=finding)


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        ([(0, 1, "A"), (1, 2, "B")], "ABcdef"),
        ([(0, 1, "A"), (0, 1, "A")], "Abcdef"),
        ([(0, 1, "A"), (0, 1, "B"), (2, 3, "C")], "abCdef"),
        ([(0, 5, "A"), (1, 2, "B"), (3, 4, "C"), (5, 6, "F")], "abcdeF"),
        ([(1, 1, "+"), (1, 1, "-"), (3, 3, "*")], "a+bc*def"),
        ([(1, 1, "+"), (1, 2, "B")], "abcdef"),
    ],
)
def test_edits_that_overlap_are_left_out(edits: list[tuple[int, int, str]], expected: str) -> None:
    source = Source("main.yml", "abcdef")
    report = [edit(number, *each, source) for number, each in enumerate(edits)]
    nothing = Batch(reports={}, uses={})
    before = Batch(reports={"main.yml": report}, uses={})
    result = apply_fixes(before, lambda batch: batch.report, lambda texts: nothing)
    assert list(result.texts.values()) == ([expected] if expected != "abcdef" else [])

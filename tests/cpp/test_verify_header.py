"""`smachac verify --header`: C++ headers on disk, edited by hand, old, or of another script."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.verify.players.header_text import scopes
from tests.cpp.test_verify import HERE, ROUNDS, astray, crashing, deaf, mistaken

ROOT = Path(__file__).parents[2]
CASE = ROOT / "tests" / "cases" / "code_in_both"
ON_ERROR = ROOT / "tests" / "cases" / "on_error"
COUNTING = ROOT / "examples" / "06_callbacks"

Edit = Callable[[str], str]


def built(folder: Path, script: str, edit: Edit = lambda text: text) -> tuple[str, str]:
    """A script and its header on disk, the header edited."""
    main_yml = folder / "main.yml"
    main_yml.write_text(script, "utf-8")
    assert main(["build", str(main_yml), "--target", "cpp", "-o", str(folder)]) == 0
    (header,) = folder.glob("*.hpp")
    text = header.read_text("utf-8")
    header.write_text(edit(text), "utf-8")
    return str(main_yml), str(header)


def without_stop(text: str) -> str:
    """The state USE gets no requests to stop."""
    head, found, rest = text.partition("struct USE {")
    rest = rest.replace("execute(smachac::Stop &stop)", "execute()", 1)
    rest = rest.replace("stop.requested()", "false", 1).replace("stop.service();", "", 1)
    calls = "states.USE.execute(run.stop_for(places, state))"
    return head + found + rest.replace(calls, "states.USE.execute()")


def forgetful(text: str) -> str:
    """The key `width` does not leave the concurrence."""
    return text.replace("ud.width.take(ud.BOTH_.width);", "")


def swapped_outcomes(text: str) -> str:
    one, other = "return Outcome::fine;", "return Outcome::mixed;"
    return text.replace(one, "return").replace(other, one).replace("return\n", f"{other}\n")


@HERE
@pytest.mark.parametrize("folder", [COUNTING, ON_ERROR], ids=lambda folder: folder.name)
@pytest.mark.slow
def test_a_header_that_nobody_edited_agrees(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """States with expressions run their own code on some paths; some states fail."""
    home = tmp_path / "mein Prüfstand"
    shutil.copytree(folder, home, ignore=shutil.ignore_patterns("expected"))
    script = (folder / "main.yml").read_text("utf-8")
    main_yml, header = built(home, script)
    assert main(["verify", main_yml, "--header", header, "--paths", "60"]) == 0
    assert capsys.readouterr().out.endswith(f"cpp ({header}): agrees\n")


@HERE
@pytest.mark.parametrize(
    "edit",
    [
        astray,
        forgetful,
        without_stop,
        *(
            pytest.param(item, marks=pytest.mark.slow)
            for item in (mistaken, swapped_outcomes, deaf, crashing)
        ),
    ],
)
@pytest.mark.slow
def test_a_fault_made_by_hand_is_found(
    edit: Edit, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, header = built(tmp_path, ROUNDS)
    text = Path(header).read_text("utf-8")
    assert edit(text) != text
    Path(header).write_text(edit(text), "utf-8")
    capsys.readouterr()
    assert main(["verify", main_yml, "--header", header, "--paths", "40"]) == 1
    out = capsys.readouterr().out
    assert f"cpp ({header}) differs from the interpreter" in out


@HERE
@pytest.mark.slow
def test_a_difference_names_the_line_in_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, header = built(tmp_path, ROUNDS, astray)
    main(["verify", main_yml, "--header", header, "--paths", "40"])
    marked = next(row for row in capsys.readouterr().out.splitlines() if row.startswith(" ->"))
    lines = Path(header).read_text("utf-8").splitlines()
    number = max(n for n, line in enumerate(lines, 1) if "case State::USE:" in line)
    assert marked.endswith(f"transition sm/USE (timeout) done -> sm:aborted  sm.hpp:{number}")


@HERE
@pytest.mark.slow
def test_classes_are_replaced_by_stand_ins(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The class of the user is not there; keys that are crossed are found."""
    shutil.copytree(CASE, tmp_path / "case")
    main_yml = str(tmp_path / "case" / "main.yml")
    header = tmp_path / "case.hpp"
    text = (CASE / "expected" / "cpp" / "code_in_both.hpp").read_text("utf-8")
    header.write_text(text, "utf-8")
    shutil.rmtree(tmp_path / "case" / "include")
    given = ["verify", main_yml, "--header", str(header), "--paths", "30"]
    capsys.readouterr()
    assert main(given) == 0
    crossed = text.replace(
        "{ud.shelf.unchecked(), ud.table.unchecked(),",
        "{ud.table.unchecked(), ud.shelf.unchecked(),",
    )
    assert crossed != text
    header.write_text(crossed, "utf-8")
    assert main(given) == 1
    assert " -> read code_in_both/CARRY from = " in capsys.readouterr().out
    other = text.replace("0x64489222U", "0x64489223U")
    header.write_text(other, "utf-8")
    assert main(given) == 1
    err = capsys.readouterr().err
    assert "arm::Carry was written for another Carry.yml" in err
    number = next(n for n, row in enumerate(other.splitlines(), 1) if "0x64489223U" in row)
    assert f"--> {header}:{number}\n" in err


def without_use(text: str) -> str:
    return text.replace("  BOTH,\n  USE,\n}", "  BOTH,\n}")


def renamed(text: str) -> str:
    return text.replace("State::LEFT:", "State::LIFT:").replace("  LEFT,\n", "  LIFT,\n")


def with_another_outcome(text: str) -> str:
    return text.replace("  preempted,\n};\n\nconstexpr", "  preempted,\n  lost,\n};\n\nconstexpr")


def of_another_machine(text: str) -> str:
    return text.replace("namespace sm", "namespace other")


def with_an_own_class(text: str) -> str:
    text = text.replace("  types::RIGHT RIGHT", "  my::Right RIGHT")
    return text.replace("struct RIGHT {", "struct OTHER {")


def with_a_derived_class(text: str) -> str:
    text = text.replace("  types::RIGHT RIGHT", "  types::OTHER RIGHT")
    start = text.index("struct RIGHT {")
    end = text.index("} // namespace types", start)
    return f"{text[:end]}struct OTHER : RIGHT {{}};\n{text[end:]}"


def misspelt(text: str) -> str:
    return text.replace("{ud.BOTH_, ud.goal}", "{ud.BOTH_, ud.goals}")


FAULTS = [
    (without_use, "`sm/USE` of the script (main.yml:24) is not in the header", "namespace sm {"),
    (renamed, "the state `sm/BOTH/LIFT` of the header is not in the script", "case State::LIFT:"),
    (with_another_outcome, "in the script `aborted`, `preempted`, `succeeded`", "namespace sm {"),
    (of_another_machine, "the header has no machine `sm`", ""),
    (with_an_own_class, "`sm/BOTH/RIGHT` has no struct `sm::BOTH::types::RIGHT`", "case State::RI"),
    (lambda text: "", "the header has no machine `sm`", ""),
    (lambda text: '{{{ }}}}}} /* "', "the header has no machine `sm`", ""),
]


@pytest.mark.parametrize(("edit", "message", "place"), FAULTS)
def test_a_header_that_cannot_be_compared_is_reported_with_its_place(
    edit: Edit, message: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, header = built(tmp_path, ROUNDS)
    text = Path(header).read_text("utf-8")
    assert edit(text) != text
    Path(header).write_text(edit(text), "utf-8")
    capsys.readouterr()
    assert main(["verify", main_yml, "--header", header]) == 1
    err = capsys.readouterr().err
    assert message in err
    assert "\nhelp: " in err
    lines = edit(text).splitlines()
    where = next((f":{n}" for n, line in enumerate(lines, 1) if place and place in line), "")
    assert f"--> {header}{where}\n" in err


@HERE
@pytest.mark.parametrize(
    ("edit", "message", "place"),
    [
        (misspelt, "goals", "goals"),
        (with_a_derived_class, "the state sm/BOTH/RIGHT is not of the type", "case State::RIGHT:"),
    ],
)
@pytest.mark.slow
def test_an_error_of_the_compiler_has_its_place_in_the_file(
    edit: Edit, message: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, header = built(tmp_path, ROUNDS, edit)
    capsys.readouterr()
    assert main(["verify", main_yml, "--header", header]) == 1
    err = capsys.readouterr().err
    assert err.startswith("error: the header does not compile: ")
    assert message in err
    lines = Path(header).read_text("utf-8").splitlines()
    number = next(n for n, line in enumerate(lines, 1) if place in line)
    assert f"--> {header}:{number}\n" in err


@pytest.mark.slow
def test_the_parts_of_a_header_are_read_in_linear_time() -> None:
    """Repeated beginnings of what is searched for; a quadratic search would take minutes."""
    for piece in ("namespace a", "enum class A ", "struct A ", "execute(", "case ", "State::", "{"):
        assert len(scopes(Source("a.hpp", piece * 40_000))) <= 1


@pytest.mark.skipif(os.name == "nt", reason="a shell script stands for the compiler")
@pytest.mark.slow
def test_ctrl_c_leaves_no_compiler_behind(tmp_path: Path) -> None:
    """The compiler here starts another process, as g++ does; both hold the pipe `alive`."""
    main_yml, header = built(tmp_path, ROUNDS)
    compiler = tmp_path / "bin" / "g++"
    compiler.parent.mkdir()
    alive = tmp_path / "alive"
    os.mkfifo(alive)
    child = "(sleep 60; echo survived >&3) &"
    script = ["#!/bin/sh", f"exec 3>'{alive}'", child, "echo started >&3", "wait"]
    compiler.write_text("\n".join(script), "utf-8")
    compiler.chmod(0o755)
    command = [sys.executable, "-m", "smachac", "verify", main_yml, "--header", header]
    environment = {**os.environ, "PATH": f"{compiler.parent}:{os.environ['PATH']}"}
    with (
        subprocess.Popen(command, stderr=subprocess.PIPE, env=environment) as process,
        alive.open(encoding="utf-8") as pipe,
    ):
        assert pipe.readline() == "started\n"
        process.send_signal(signal.SIGINT)
        assert process.communicate()[1] == b"interrupted\n"
        assert process.returncode == 130
        assert pipe.read() == ""

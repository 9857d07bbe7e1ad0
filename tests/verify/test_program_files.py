"""`smachac verify --program`: Python programs on disk, edited by hand, old, or no programs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.runtime.tracing import trace
from tests.verify.test_verify import (
    ROOT,
    ROUNDS,
    STOPPABLE,
    astray,
    endless,
    silent,
    swapped,
    unasked,
    waiting_for_all,
)

Edit = Callable[[str], str]

STOPS = STOPPABLE.replace("[succeeded, aborted, preempted]", "[succeeded, preempted]", 1)


def built(folder: Path, script: str, edit: Edit = lambda text: text) -> tuple[str, str]:
    """A script and its program on disk, the program edited."""
    main_yml = folder / "main.yml"
    main_yml.write_text(script, "utf-8")
    assert main(["build", str(main_yml), "--target", "python", "-o", str(folder)]) == 0
    program = folder / "sm.py"
    text = program.read_text("utf-8")
    edited = edit(text)
    program.write_text(edited, "utf-8")
    return str(main_yml), str(program)


def line_of(program: str, words: str) -> int:
    lines = Path(program).read_text("utf-8").splitlines()
    return next(number for number, line in enumerate(lines, 1) if words in line)


def misruled(text: str) -> str:
    return text.replace(
        '"mixed": {"LEFT": "done", "RIGHT": "failed"}',
        '"mixed": {"LEFT": "failed", "RIGHT": "done"}',
    )


@pytest.mark.parametrize("script", [ROUNDS, STOPS])
def test_a_program_that_nobody_edited_agrees(
    script: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, program = built(tmp_path, script)
    assert main(["verify", main_yml, "--program", program, "--paths", "40"]) == 0
    assert capsys.readouterr().out.endswith(f"python ({program}): agrees\n")


@pytest.mark.parametrize(
    ("script", "edit"),
    [
        (ROUNDS, swapped),
        (ROUNDS, astray),
        (ROUNDS, endless),
        (ROUNDS, waiting_for_all),
        (ROUNDS, misruled),
        (STOPS, unasked),
        (STOPS, silent),
    ],
)
def test_a_fault_made_by_hand_is_found(
    script: str,
    edit: Edit,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(trace, "LONGEST_WAIT", 0.05)
    main_yml, program = built(tmp_path, script)
    text = Path(program).read_text("utf-8")
    assert edit(text) != text
    Path(program).write_text(edit(text), "utf-8")
    capsys.readouterr()
    assert main(["verify", main_yml, "--program", program, "--paths", "40"]) == 1
    out = capsys.readouterr().out
    assert f"python ({program}) differs from the interpreter" in out
    assert out.endswith(f"python ({program}): differs\n")


def test_a_difference_names_the_line_in_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """USE is the branch of a concurrence: its transition is that of the time limit around it."""
    main_yml, program = built(tmp_path, STOPS, early)
    assert main(["verify", main_yml, "--program", program]) == 1
    marked = next(row for row in capsys.readouterr().out.splitlines() if row.startswith(" ->"))
    ours, theirs = marked.split(" | ")
    assert "transition sm/GO succeeded -> sm/REST  main.yml:5" in ours
    number = line_of(program, '"GO",') - 1
    assert theirs == f"transition sm/GO succeeded -> sm:succeeded  sm.py:{number}"


def early(text: str) -> str:
    return text.replace('"succeeded": "REST"', '"succeeded": "succeeded"')


def without_rest(text: str) -> str:
    start = text.index("        smach.StateMachine.add(  # main.yml:18")
    return (text[:start] + text[text.index("    return sm\n") :]).replace('"REST"', '"succeeded"')


def with_one_more(text: str) -> str:
    more = 'smach.StateMachine.add("MORE", ScriptedState(outcomes=["a"]), {"a": "preempted"})'
    end = "    pass_on_stop_requests(sm)\n"
    return text.replace(end, f"        {more}\n{end}")


def with_another_outcome(text: str) -> str:
    return text.replace(
        'smach.StateMachine(outcomes=["succeeded", "preempted"])',
        'smach.StateMachine(outcomes=["succeeded", "preempted", "stopped"])',
    )


def flat(text: str) -> str:
    state = 'ScriptedState(outcomes=["succeeded", "preempted"])'
    return text.replace('"GO", sm_go,', f'"GO", {state},')


def with_a_bad_exception(text: str) -> str:
    kind = "class BadError(Exception):\n    def __str__(self):\n        return 1\n\n\n"
    text = text.replace("    return sm\n", "    raise BadError\n")
    return text.replace("def build", f"{kind}def build")


def ending(words: str) -> Edit:
    return lambda text: f"{text}\n{words}\n"


def instead_of_the_end(words: str) -> Edit:
    return lambda text: text.replace("    return sm\n", f"    {words}\n")


FAULTS = [
    (without_rest, "`sm/REST` of the script (main.yml:18) is not in the program", "def bu"),
    (with_one_more, "the state `sm/MORE` of the program is not in the script", "        smach.State"
     'Machine.add("MORE"'),
    (with_another_outcome, "the machine has the outcomes `preempted`, `stopped`", "def bu"),
    (lambda text: text.replace("def build", "def make"), "has no function `build`", ""),
    (instead_of_the_end("return 1"), "is no state machine", "def bu"),
    (instead_of_the_end("return ("), "this is not Python 3: ", "    return (\n"),
    (ending("print 1"), "this is not Python 3: ", "print 1"),
    (lambda text: f"import no_such_arm\n{text}", "No module named 'no_such_arm'", "import no_s"),
    (ending("raise SystemExit(0)"), "runs its machine, or ends", "raise SystemExit(0"),
    (ending("main()"), "runs its machine, or ends", "main()\n"),
    (with_a_bad_exception, "the program cannot be loaded: BadError", "    raise BadError"),
]  # fmt: skip


@pytest.mark.parametrize(("edit", "message", "place"), FAULTS)
def test_a_file_that_cannot_be_compared_is_reported_with_its_place(
    edit: Edit, message: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, program = built(tmp_path, STOPS)
    text = Path(program).read_text("utf-8")
    assert edit(text) != text
    Path(program).write_text(edit(text), "utf-8")
    capsys.readouterr()
    assert main(["verify", main_yml, "--program", program]) == 1
    err = capsys.readouterr().err
    assert err.startswith("error: ")
    assert message in err
    assert "\nhelp: " in err
    rows = edit(text).splitlines(keepends=True)
    last = max(number for number, row in enumerate(rows, 1) if row.startswith(place))
    assert f"--> {program}{f':{last}' if place else ''}\n" in err


def test_a_container_without_its_states_is_no_container(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_yml, program = built(tmp_path, STOPS, flat)
    capsys.readouterr()
    assert main(["verify", main_yml, "--program", program]) == 1
    assert "`sm/GO` is no container, but a container in the script (main.yml:5)" in (
        capsys.readouterr().err
    )


def test_a_program_of_a_version_that_gave_iterators_no_keys_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = (ROOT / "examples" / "07_iterator" / "main.yml").read_text("utf-8")
    (tmp_path / "main.yml").write_text(script, "utf-8")
    assert main(["build", str(tmp_path / "main.yml"), "-t", "python", "-o", str(tmp_path)]) == 0
    (program,) = tmp_path.glob("*.py")
    lines = program.read_text("utf-8").splitlines(keepends=True)
    kept = [line for line in lines if not line.strip().startswith("output_keys=[],")]
    assert kept != lines
    program.write_text("".join(kept), "utf-8")
    capsys.readouterr()
    assert main(["verify", str(tmp_path / "main.yml"), "--program", str(program)]) == 1
    err = capsys.readouterr().err
    assert "missing 1 required positional argument: 'output_keys'" in err
    assert "generate the file again with `smachac build --target python`" in err


def test_modules_beside_the_file_and_in_the_project_are_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The file is outside the project, whose path has a space and an umlaut."""
    project, other = tmp_path / "mein Prüfstand", tmp_path / "elsewhere"
    for folder in (project / "code", other):
        folder.mkdir(parents=True)
    (project / "smachac.toml").write_text('code = ["code"]\n', "utf-8")
    (project / "code" / "arm_verify_a.py").write_text("A = 1\n", "utf-8")
    (project / "arm_verify_b.py").write_text("B = 1\n", "utf-8")
    (other / "arm_verify_c.py").write_text("C = 1\n", "utf-8")
    main_yml, program = built(project, STOPS)
    imports = "import arm_verify_a, arm_verify_b, arm_verify_c, dataclasses\n"
    data = "@dataclasses.dataclass\nclass Size:\n    width: 'float'\n\n\n"
    edited = Path(program).read_text("utf-8").replace('"""\n', f'"""\n{imports}{data}', 1)
    moved = other / "sm.py"
    moved.write_text(f"from __future__ import annotations\n{edited}", "utf-8")
    capsys.readouterr()
    assert main(["verify", main_yml, "--program", str(moved), "--paths", "20"]) == 0
    assert capsys.readouterr().out.endswith(f"python ({moved}): agrees\n")
    assert "arm_verify_c" not in sys.modules
    assert str(other) not in sys.path


def test_a_program_is_not_run_when_it_is_loaded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mark = tmp_path / "ran"
    main_yml, program = built(tmp_path, STOPS)
    text = Path(program).read_text("utf-8")
    wrote = f"        open({str(mark)!r}, 'w').close()\n        step = self.steps"
    text = text.replace("        step = self.steps", wrote, 1)
    assert str(mark) in text
    Path(program).write_text(f"{text}\ntry:\n    main()\nexcept Exception:\n    pass\n", "utf-8")
    main(["verify", main_yml, "--program", program, "--paths", "9"])
    assert not mark.exists()


def test_an_option_with_the_file_of_the_other_is_wrong_usage(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "main.yml").write_text(STOPS, "utf-8")
    for option, other, name in (("program", "header", "sm.hpp"), ("header", "program", "sm.py")):
        assert main(["verify", str(tmp_path / "main.yml"), f"--{option}", name]) == 2
        assert f"`--{other} {name}` does" in capsys.readouterr().err


@pytest.mark.parametrize("make", [lambda path: None, Path.mkdir, os.mkfifo])
def test_a_file_that_cannot_be_read_is_reported(
    make: Callable[[Path], object], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "main.yml").write_text(STOPS, "utf-8")
    make(tmp_path / "sm.py")
    assert main(["verify", str(tmp_path / "main.yml"), "--program", str(tmp_path / "sm.py")]) == 1
    assert "SM007" in capsys.readouterr().err


def test_ctrl_c_while_the_program_is_loaded_ends_it(tmp_path: Path) -> None:
    waits = "print('loading', flush=True)\nwhile True:\n    pass\n"
    main_yml, program = built(tmp_path, STOPS)
    Path(program).write_text(waits, "utf-8")
    command = [sys.executable, "-m", "smachac", "verify", main_yml, "--program", program]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert process.stderr.readline() == "loading\n"
        process.send_signal(signal.SIGINT)
        assert process.wait() == 130
        # Python writes a line twice if the signal arrives while it is flushed.
        assert process.stderr.read().removeprefix("loading\n") == "interrupted\n"

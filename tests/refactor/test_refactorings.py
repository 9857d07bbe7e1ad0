"""Refactorings: the cases in tests/refactorings, and laws for whole projects."""

from __future__ import annotations

import contextlib
import os
import random
import re
import shlex
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import smachac
from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.interpreter.interpreter import run
from smachac.interpreter.userdata import Userdata, UserdataError
from smachac.ir.nodes import Leaf, Machine, StateMachine
from smachac.ir.printer import print_machine
from smachac.ir.traversal import outcome_names, walk
from smachac.refactor.equivalence import normalized
from smachac.refactor.formatter import format_script
from smachac.runtime import smach
from tests.support.examples import examples, seeds
from tests.support.golden import compare_folder
from tests.trust.project_text import written
from tests.trust.random_projects import correct_project

CASES = sorted(
    path.parent for path in (Path(__file__).parents[1] / "refactorings").glob("*/command")
)
SEEDS = seeds(1, 3, 10)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_golden_refactoring(
    case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A case is a command, the files before it, and in `expected` what it prints and changes."""
    monkeypatch.chdir(tmp_path)
    files = (*case.glob("*.yml"), *case.glob("*.tpl.py"))
    before = {path.name: path.read_bytes() for path in files}
    for name, data in before.items():
        (tmp_path / name).write_bytes(data)
    code = main(shlex.split((case / "command").read_text("utf-8")))
    shown = capsys.readouterr()
    found = {"says": f"exit code {code}\n{shown.out}{shown.err}"}
    for path in sorted(tmp_path.glob("*.yml")):
        if path.read_bytes() != before.get(path.name):
            found[path.name] = path.read_bytes().decode()
    compare_folder(found, case / "expected")
    assert code == 0 or list(found) == ["says"]


# --- laws


@contextlib.contextmanager
def inside(folder: str) -> Iterator[None]:
    """Be in another folder for a while, as `contextlib.chdir` of Python 3.11 has it."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


@pytest.fixture
def project(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> random.Random:
    """A random project in the current folder, with comments, and chance for what is done to it."""
    seed: int = request.param
    monkeypatch.chdir(tmp_path)
    for name, data in correct_project(seed).items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        text = written(data).text
        if name.endswith(".yml") and "/" not in name:
            text = remarked(format_script(Source(name, text)) or text, name)
        path.write_text(text, "utf-8")
    return random.Random(seed)


def remarked(text: str, name: str) -> str:
    """A comment above every third line, and one behind every third."""
    lines = []
    for number, line in enumerate(text.splitlines()):
        margin = line[: len(line) - len(line.lstrip())]
        lines += [f"{margin}# {name} {number} above"] if number % 3 == 0 else []
        behind = number % 3 == 1 and not line.endswith(("{", "[", ",")) and line.count('"') % 2 == 0
        lines.append(f"{line}  # {name} {number} behind" if behind else line)
    return "\n".join(lines) + "\n"


def machine() -> Machine:
    found = analyse_script("main.yml")
    assert found.checked is not None, [item.finding.message for item in found.report]
    return found.checked


def machine_text() -> str:
    return re.sub(r"(?m)^digest .*\n", "", print_machine(machine()))


def comments() -> Counter[str]:
    texts = "".join(path.read_text("utf-8") for path in sorted(Path().glob("*.yml")))
    return Counter(re.findall(r"# \S+ \d+ (?:above|behind)", texts))


def texts() -> dict[str, str]:
    return {path.name: path.read_text("utf-8") for path in sorted(Path().glob("*.yml"))}


def command(*words: str) -> int:
    code = main([*words])
    assert code in (0, 1)
    return code


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_what_is_extracted_can_be_inlined_again(project: random.Random) -> None:
    before, remarks, files = machine_text(), comments(), texts()
    inner = list(walk(machine().root))[1:]
    mine = [path for path, node in inner
            if not isinstance(node, Leaf) and not node.sugar and not node.via]  # fmt: skip
    done = 0
    for path in project.sample(mine, min(len(mine), 2)):
        assert command("extract", "main.yml", path, "--check") == 1
        if command("extract", "main.yml", path, "--to", "new_one.yml"):
            continue
        assert machine_text() == before
        assert comments() == remarks
        assert command("extract", "main.yml", path) == 1  # it is one already
        assert command("inline", "main.yml", path) == 0
        Path("new_one.yml").unlink()
        assert machine_text() == before
        assert comments() == remarks
        done += 1
        again = texts()
        assert {name: format_script(Source(name, text)) for name, text in again.items()} == again
    assert texts().keys() == files.keys()
    assert done or not mine


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_calls_can_be_inlined(project: random.Random) -> None:
    before = machine_text()
    for path, node in list(walk(machine().root))[1:]:
        if not node.via or (not isinstance(node, Leaf) and node.sugar):
            continue
        if node.span.source.name == "main.yml" and command("inline", "main.yml", path) == 0:
            assert machine_text() == before


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_a_name_that_is_changed_twice_is_the_old_one(project: random.Random) -> None:
    files, before = texts(), normalized(machine().root)
    names: list[tuple[str, str, str]] = []
    for path, node in walk(machine().root):
        names.append(("state", path, node.name))
        names += [("outcome", f"{path}/{outcome.name}", outcome.name) for outcome in node.outcomes]
        if not isinstance(node, Leaf):
            keys = {key.name for key in (*node.inputs, *node.outputs)}
            keys |= {preset.key for preset in node.userdata}
            names += [("key", f"{path}/{key}", key) for key in sorted(keys)]
    done = Counter[str]()
    for kind, path, name in project.sample(names, min(len(names), 8)):
        if main(["rename", "main.yml", path, "brand_new", "--kind", kind]) != 0:
            assert texts() == files
            continue
        done[kind] += 1
        assert "brand_new" in machine_text()
        there = f"{path.rpartition('/')[0]}/brand_new" if "/" in path else "brand_new"
        assert command("rename", "main.yml", there, name, "--kind", kind) == 0
        assert normalized(machine().root) == before
        files = texts()
    assert done["state"] or done["outcome"]


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_states_that_are_contained_run_as_before(project: random.Random) -> None:
    remarks = comments()
    before = machine()
    found = [
        (path, node)
        for path, node in walk(before.root)
        if isinstance(node, StateMachine) and not node.sugar and not node.via
    ]
    done = 0
    for path, node in found * 3:
        first = project.randrange(len(node.children))
        names = [child.name for child in node.children[first : first + project.randint(1, 4)]]
        paths = [f"{path}/{name}" for name in names]
        done += main(["contain", "main.yml", f"NEW_{done}", "StateMachine", *paths]) == 0
        if done == 3:
            break
    assert comments() == remarks
    after = machine()
    for seed in range(20 if done else 0):
        assert transcript(after, seed) == transcript(before, seed)


def test_a_state_without_interface_leaves_a_container_as_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = next(case for case in CASES if case.name == "contain_without_interface")
    monkeypatch.chdir(tmp_path)
    for path in (*case.glob("*.yml"), *case.glob("*.tpl.py")):
        (tmp_path / path.name).write_bytes(path.read_bytes())

    def ends() -> list[str | None]:
        (text,) = smachac.compile("main.yml", "python", templates=["."]).values()
        return [outcome_of(text, end) for end in ("succeeded", "aborted", "preempted", "there")]

    before = ends()
    assert before == ["succeeded", "aborted", "preempted", "succeeded"]
    assert main(shlex.split((case / "command").read_text("utf-8"))) == 0
    assert ends() == before


def outcome_of(text: str, end: str) -> str | None:
    """How a program ends whose class `Mover`, which comes from elsewhere, ends in this way."""

    class Mover(smach.State):
        def __init__(self, output_keys: list[str]) -> None:
            ends = ["there", "succeeded", "aborted", "preempted"]
            super().__init__(ends, input_keys=["limit", "target"], output_keys=output_keys)

        def execute(self, userdata: Any) -> str:
            userdata.place = [userdata.target, userdata.limit]
            return end

    def execute(self: Any, userdata: Any) -> str:
        if "pose" in userdata:
            userdata.joints = userdata.pose
            return "found"
        assert userdata.where == [[0.4, 0.1, 0.2], 0.5]
        return "good"

    movers = ModuleType("movers")
    movers.Mover = Mover  # type: ignore[attr-defined]
    module = ModuleType("program")
    with patch.dict("sys.modules", {"movers": movers, "smach": smach}):
        exec(text, module.__dict__)
    module.Solver.execute = module.Looker.execute = execute
    outcome: str | None = module.build().execute()
    return outcome


@settings(max_examples=80)
@given(st.integers(0, 10**9))
@pytest.mark.slow
def test_keys_are_seen_in_a_container_as_without_it(seed: int) -> None:
    draw = random.Random(seed)
    names = [f"S{at}" for at in range(draw.randint(3, 6))]
    rows = ["name: sm", "template: Base", "outcomes: [done]", "userdata: {a: 1, b: 2, c: 3}"]
    rows += [f"output_keys: [{draw.choice('abc')}]", "states:"]
    for at, name in enumerate(names):
        keys = [draw.sample("abc", draw.randint(0, 2)) for _ in range(2)]
        on = names[at + 1] if at + 1 < len(names) else "done"
        rows += [f"  - {name}:", "      template: ScriptedState", "      outcomes: [ok, back]"]
        for part, some in zip(("input_keys", "output_keys"), keys, strict=True):
            rows += [f"      {part}: [{', '.join(some)}]"] if some else []
        rows += [f"      transitions: {{ok: {on}, back: {draw.choice(names)}}}"]
    with tempfile.TemporaryDirectory() as folder, inside(folder):
        Path("main.yml").write_text("\n".join(rows) + "\n")
        before = machine()
        at = draw.randrange(len(names))
        code = main(["contain", "main.yml", "NEW", "StateMachine", *names[at : at + 3]])
        after = machine()
    assert (normalized(after.root) == normalized(before.root)) == (code != 0)
    for number in range(20 if code == 0 else 0):
        assert transcript(after, number) == transcript(before, number)


def transcript(whole: Machine, seed: int) -> list[object]:
    """What happens in a run: the leaves by name, what each finds in its userdata, and the end.

    What a leaf does depends on its name and on how often it was there, not on where it stands.
    """
    told: list[object] = []
    visits: Counter[str] = Counter()

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        visits[leaf.name] += 1
        draw = random.Random(f"{seed}/{leaf.name}/{visits[leaf.name]}")
        found: dict[str, object] = {}
        for key in leaf.inputs:
            try:
                found[key.name] = userdata[key.name]
            except UserdataError:
                found[key.name] = "nothing"
        told.append((leaf.name, found))
        outcome = draw.choice([name for name in outcome_names(leaf) if name != "preempted"])
        for key in leaf.outputs:
            if draw.random() < 0.7:
                userdata[key.name] = [leaf.name, visits[leaf.name]]
        return outcome

    outcome = run(whole, behave, max_steps=300).outcome
    # Containers count as steps, so that runs that are broken off differ in their ends.
    return [*told, outcome] if len(told) < 40 else told[:40]


@settings(max_examples=examples(60))
@given(st.integers(0, 10**9))
def test_a_concurrence_decides_as_the_states_did_in_a_row(seed: int) -> None:
    draw = random.Random(seed)
    names = ["A", "B", "C", "D", "E"][: draw.randint(2, 5)]
    rows = ["name: sm", "template: Base", "outcomes: [done, aborted]", "states:"]
    ends = ["done", "aborted", "OUT", "LAST"]
    for at, name in enumerate(names):
        outcomes = ["ok", "bad", "odd"][: draw.randint(1, 3)]
        # Each state is reached from the one before it, so that there is one way in.
        targets = [draw.choice([*names[at + 1 :], *ends]) for _ in outcomes]
        targets[0] = names[at + 1] if at + 1 < len(names) else "done"
        pairs = ", ".join(f"{one}: {to}" for one, to in zip(outcomes, targets, strict=True))
        rows += [f"  - {name}: {{template: ScriptedState, outcomes: [{', '.join(outcomes)}],"
                 f" transitions: {{{pairs}}}}}"]  # fmt: skip
    for name, end in (("OUT", "done"), ("LAST", "aborted")):
        rows += [f"  - {name}: {{template: ScriptedState, outcomes: [ok],"
                 f" transitions: {{ok: {end}}}}}"]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder, inside(folder):
        Path("main.yml").write_text("\n".join(rows) + "\n")
        before = analyse_script("main.yml").machine
        chosen = names[draw.randrange(len(names)) :]
        code = main(["contain", "main.yml", "ALL", "Concurrence", *chosen])
        after = analyse_script("main.yml").machine
    assert before is not None
    assert after is not None
    for number in range(30 if code == 0 else 0):
        assert ending(after, chosen, number) == ending(before, chosen, number)


def ending(whole: Machine, mine: list[str], seed: int) -> list[str | None]:
    """The leaves outside that are entered, and the outcome."""
    told: list[str | None] = []

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        told.extend([leaf.name] if leaf.name not in mine else [])
        return random.Random(f"{seed}/{leaf.name}").choice(list(outcome_names(leaf)))

    return [*told, run(whole, behave, max_steps=50).outcome]


WORDS = ("PICK_BLOCK", "sm", "A", "pick_pose", "succeeded", "TELL", "done", "LIFT", "LOAD_BLOCK")
SCRIPTS = [
    path
    for folder in ("examples", "tests/cases", "tests/formatting")
    for path in sorted((Path(__file__).parents[2] / folder).glob("*/*.yml"))
    if 20 < path.stat().st_size < 5000
]
PIECES = ("{", "}", "[[x]]", ": ", "- ", "\n", "&a ", "*a", "#", "  ", "'", "|\n", "\t", "é")


@settings(max_examples=150)
@given(st.integers(0, 10**9))
@pytest.mark.slow
def test_nothing_escapes(seed: int) -> None:
    draw = random.Random(seed)
    source = draw.choice(SCRIPTS)
    text = source.read_text("utf-8")
    for _ in range(draw.randrange(3)):
        at = draw.randrange(len(text))
        text = text[:at] + draw.choice(PIECES) + text[at + draw.randrange(8) :]
    known = re.findall(r"\b[A-Za-z_]\w*\b", text) or ["x"]
    one, two, three = (draw.choice([*known, *WORDS]) for _ in range(3))
    words = draw.choice([
        ["rename", "main.yml", one, two], ["rename", "main.yml", f"{one}/{two}", three],
        ["extract", "main.yml", one], ["inline", "main.yml", one],
        ["contain", "main.yml", one, draw.choice(["StateMachine", "Concurrence"]), two, three],
    ])  # fmt: skip
    with tempfile.TemporaryDirectory() as folder, inside(folder):
        for other in source.parent.glob("*.yml"):
            Path(other.name).write_bytes(other.read_bytes())
        Path("main.yml").write_text(text, "utf-8")
        before = texts()
        code = main(words)
        assert code in (0, 1, 2)
        assert code == 0 or texts() == before

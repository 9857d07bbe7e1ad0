"""States moved and renamed: as the cases in `reworked/` show it, and by law over projects."""

from __future__ import annotations

import os
import random
import re
import shlex
from collections import Counter
from pathlib import Path

import pytest
from correct import correct_project
from plain import written

from smachac import analyse_file
from smachac.cli import main
from smachac.ir.nodes import Leaf, Machine, StateMachine
from smachac.ir.text import print_machine
from smachac.ir.walk import walk
from smachac.refactor.alike import normal
from smachac.refactor.layout import laid_out
from smachac.source import Source

CASES = sorted(path.parent for path in (Path(__file__).parent / "reworked").glob("*/command"))
SEEDS = range(16)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_cases(
    case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A case is a command, the files before it, and in `expected` what it prints and changes."""
    monkeypatch.chdir(tmp_path)
    before = {path.name: path.read_bytes() for path in case.glob("*.yml")}
    for name, data in before.items():
        (tmp_path / name).write_bytes(data)
    code = main(shlex.split((case / "command").read_text("utf-8")))
    shown = capsys.readouterr()
    found = {"says": f"exit code {code}\n{shown.out}{shown.err}".encode()}
    for path in sorted(tmp_path.glob("*.yml")):
        if path.read_bytes() != before.get(path.name):
            found[path.name] = path.read_bytes()
    folder = case / "expected"
    if os.environ.get("SMACHAC_GOLDEN") == "rewrite":
        folder.mkdir(exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        for name, data in found.items():
            (folder / name).write_bytes(data)
    assert found == {path.name: path.read_bytes() for path in folder.iterdir()}
    assert code == 0 or list(found) == ["says"]


# --- laws


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
            text = remarked(laid_out(Source(name, text)) or text, name)
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
    found = analyse_file("main.yml", (), ())[0]
    assert found.checked is not None, [item.finding.message for item in found.report]
    return found.checked


def machine_text() -> str:
    return re.sub(r"(?m)^digest .*\n", "", print_machine(machine()))


def comments() -> Counter[str]:
    texts = "".join(path.read_text("utf-8") for path in sorted(Path().glob("*.yml")))
    return Counter(re.findall(r"# \S+ \d+ (?:above|behind)", texts))


def texts() -> dict[str, str]:
    return {path.name: path.read_text("utf-8") for path in sorted(Path().glob("*.yml"))}


def run(*words: str) -> int:
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
        assert run("extract", "main.yml", path, "--check") == 1
        if run("extract", "main.yml", path, "--to", "new_one.yml"):
            continue
        assert machine_text() == before
        assert comments() == remarks
        assert run("extract", "main.yml", path) == 1  # it is one already
        assert run("inline", "main.yml", path) == 0
        Path("new_one.yml").unlink()
        assert machine_text() == before
        assert comments() == remarks
        done += 1
        again = texts()
        assert {name: laid_out(Source(name, text)) for name, text in again.items()} == again
    assert texts().keys() == files.keys()
    assert done or not mine


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_calls_can_be_inlined(project: random.Random) -> None:
    before = machine_text()
    for path, node in list(walk(machine().root))[1:]:
        if not node.via or (not isinstance(node, Leaf) and node.sugar):
            continue
        if node.span.source.name == "main.yml" and run("inline", "main.yml", path) == 0:
            assert machine_text() == before


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_a_name_that_is_changed_twice_is_the_old_one(project: random.Random) -> None:
    files, before = texts(), normal(machine().root)
    names: list[tuple[str, str, str]] = []
    for path, node in walk(machine().root):
        names.append(("state", path, node.name))
        names += [("outcome", f"{path}/{each.name}", each.name) for each in node.outcomes]
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
        assert run("rename", "main.yml", there, name, "--kind", kind) == 0
        assert normal(machine().root) == before
        files = texts()
    assert done["state"] or done["outcome"]


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_states_that_are_contained_run_as_before(project: random.Random) -> None:
    remarks = comments()
    before = leaves(machine())
    done = 0
    for path, node in list(walk(machine().root)):
        if not isinstance(node, StateMachine) or node.sugar or node.via:
            continue
        first = project.randrange(len(node.children))
        names = [child.name for child in node.children[first : first + project.randint(1, 3)]]
        paths = [f"{path}/{name}" for name in names]
        if main(["contain", "main.yml", "CONTAINED", "StateMachine", *paths]) == 0:
            assert comments() == remarks
            assert leaves(machine()) == before
            done += 1
            break
    if not done:
        assert "CONTAINED" not in texts()["main.yml"]


def leaves(whole: Machine) -> Counter[str]:
    """What the leaves are, whatever they are in."""
    return Counter(
        f"{node.name} {node.type} {[each.name for each in node.outcomes]} {node.variables}"
        for _, node in walk(whole.root)
        if isinstance(node, Leaf)
    )

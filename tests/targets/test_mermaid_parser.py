"""Mermaid's own parser, from viewer/node_modules, reads every diagram and finds what is drawn."""

from __future__ import annotations

import json
import random
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings

from smachac.ir.nodes import Leaf, Machine
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import walk
from smachac.ir.written import written
from smachac.targets.mermaid.diagram import diagram
from tests.strategies.machines import valid_machines
from tests.support.examples import examples
from tests.targets.test_dot import leaf, machine_of

ROOT = Path(__file__).parents[2]
VIEWER = ROOT / "viewer"
GOLDEN = sorted((ROOT / "tests" / "cases").glob("**/expected/mermaid/*.mmd"))

ODD = [
    *("end", "state", "default", "note", "class", "click", "style", "direction LR", "[*]", "--"),
    *("constructor", "__proto__", "hide empty description", "<<fork>>", "as x", "größe", "日本"),
    *('"', "'", ":", ":::", "#", ";", "#quot;", "%%", "{", "}", "<b>", "</script>", "&amp;"),
    *("a-->b", "`x`", "*x*", "__x__", "1. x", "- x", "$$x$$", "a\nb", " ", "\\", "root_end"),
]

pytestmark = pytest.mark.browser


def parsed(texts: list[str]) -> list[dict[str, Any]]:
    """What the parser finds in each text: an error, or states and edges."""
    node = shutil.which("node")
    if node is None or not (VIEWER / "node_modules" / "mermaid").is_dir():
        pytest.skip("node or the package mermaid is not there: make test-browser")
    done = subprocess.run(
        [node, "mermaid_parser.mjs"],
        cwd=VIEWER,
        input=json.dumps(texts),
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    answers: list[dict[str, Any]] = json.loads(done.stdout)
    assert len(answers) == len(texts)
    return answers


def text_of(machine: Machine) -> str:
    return "\n".join([*diagram(machine, written(machine), depth=None, direction="TB"), ""])


def shown(name: str) -> str:
    return " ".join(name.split()) or "\xa0"


def check(machine: Machine, answer: dict[str, Any]) -> None:
    """The parser finds a state of the right name for each state of a machine, and no other."""
    assert "error" not in answer, answer["error"]
    titles = dict(reversed(answer["states"]))
    found = sorted(text.split(" (")[0] for text in titles.values())
    assert found == sorted(shown(name_in_script(node)) for _, node in [*walk(machine.root)][1:])
    for source, target, _ in answer["edges"]:
        assert source in titles or source.endswith("_start")
        assert target in titles or target.endswith("_end")


def test_the_parser_refuses_what_is_no_diagram() -> None:
    (answer,) = parsed(["stateDiagram-v2\n  a b -->\n"])
    assert "Parse error" in answer["error"]


def test_every_case_and_example() -> None:
    assert len(GOLDEN) > 30
    answers = parsed([path.read_text("utf-8") for path in GOLDEN])
    for path, each in zip(GOLDEN, answers, strict=True):
        assert "error" not in each, f"{path}: {each['error']}"
    assert all(answer["states"] and answer["edges"] for answer in answers)


def test_random_machines() -> None:
    machines: list[Machine] = []

    @seed(3)
    @settings(max_examples=examples(200), database=None, suppress_health_check=list(HealthCheck))
    @given(valid_machines())
    def collect(machine: Machine) -> None:
        machines.append(machine)

    collect()
    assert len(machines) >= examples(200)
    for machine, answer in zip(machines, parsed([*map(text_of, machines)]), strict=True):
        check(machine, answer)


def test_states_that_are_not_known_exactly() -> None:
    """They get a class, in containers and regions too; the legend is the only other state."""
    inner = machine_of("IN", ("done",), leaf("A", "done", done="done"), leaf("?", "done"))
    root = machine_of("sm", ("done",), inner, leaf("B", "done", done="done"))
    unknown = {"sm/IN": "x", "sm/IN/?": "x", "sm/B": "x"}
    text = text_of(Machine(root=root, unknown=unknown))
    (answer,) = parsed([text])
    titles = dict(reversed(answer["states"]))
    assert titles.pop("legend") == "dashed: not known exactly"
    assert sorted(titles.values()) == ["?", "A", "B", "IN"]
    assert sorted(answer["dashed"]) == ["legend", "sm__B", "sm__IN", "sm__IN___"]


def test_any_name() -> None:
    """Names of states and outcomes that mean something to Mermaid are shown as they are."""
    rng = random.Random(5)
    machines = []
    for name in ODD:
        others = rng.sample([item for item in ODD if item != name], 3)
        leaves: list[Leaf] = [leaf(item, *others[:1], **{name: name}) for item in [name, *others]]
        inner = machine_of(name, (name,), *leaves)
        machines.append(Machine(root=machine_of(name, (name,), inner, *leaves[1:])))
    for machine, answer in zip(machines, parsed([*map(text_of, machines)]), strict=True):
        check(machine, answer)
        labels = "\n".join(text for _, _, text in answer["edges"])
        assert shown(machine.root.name) in labels

"""The html target: its model is the machine that runs, and its page contains nothing but itself."""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Iterator, Mapping
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

from smachac.diagnostics.source import Source
from smachac.driver import analyse, analyse_script, compile_script, read_machine
from smachac.frontend.files import disk_library, read_source
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import Interpreter
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import outcome_names, walk
from smachac.ir.written import generated, written
from smachac.targets.html import TARGET
from smachac.targets.html.model import SNIPPET_LINES, machine_model
from smachac.targets.html.page import LAYOUT_ID, MODEL_ID, render_page
from tests.strategies.machines import valid_machines
from tests.support.examples import examples

ROOT = Path(__file__).parents[2]
SCRIPTS = [
    *sorted((ROOT / "examples").glob("*/main.yml")),
    *sorted((ROOT / "tests/cases").glob("*/main.yml")),
]

MARKUP = """\
name: sm
doc: "</script><script>alert(1)</script> <!-- --> ]]> é \\u2028 \\" ' &lt;"
outcomes: [done]
states:
  - GRÜßE:
      template: ScriptedState
      doc: "<img src=x onerror=alert(1)>"
      outcomes: [done]
      userdata: {text: "</textarea><svg onload=alert(1)>"}
"""


def script_machine(script: Path) -> Machine | None:
    source = read_source(script, [])
    assert source is not None
    return read_machine(source, disk_library(script, []), [])


def page_of(text: str) -> str:
    """The page of a script, which has no error."""
    analysis = analyse(Source("main.yml", text), disk_library(Path("main.yml"), []), [])
    compiled = compile_script(analysis, TARGET)
    assert compiled.files, [item.message for item in compiled.report]
    return compiled.files["sm.html"]


class Elements(HTMLParser):
    """The elements of a page with their attributes, and the texts of those with an id."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, str] = {}
        self.inside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        self.inside = dict(attrs).get("id") or tag

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""

    def handle_data(self, data: str) -> None:
        self.texts[self.inside] = self.texts.get(self.inside, "") + data


def drawn_transitions(model: Mapping[str, Any]) -> set[tuple[str, str, str]]:
    """The edges of a model as the interpreter reports them: path, outcome and destination."""
    return {
        (
            edge["source"],
            edge["outcome"],
            edge["target"]
            if isinstance(edge["target"], str)
            else f"{edge['container']}:{edge['target']['outcome']}",
        )
        for edge in model["edges"]
        if edge["source"] is not None
    }


def transitions_of_runs(machine: Machine, runs: int) -> Iterator[tuple[str, str, str]]:
    """The transitions of runs in which every leaf ends with its outcomes in turn."""
    for run in range(runs):

        def behave(path: str, leaf: Leaf, visit: int, userdata: Any, run: int = run) -> str:
            known = [name for name in outcome_names(leaf) if name != leaf.catches]
            if not known:
                return builtin_behaviour()(path, leaf, visit, userdata)
            return known[(run + visit * (run % 3 + 1)) % len(known)]

        events: list[Any] = []
        Interpreter(machine, behave, events.append, max_steps=300).execute()
        for event in events:
            if event["event"] == "transition":
                yield event["path"], event["outcome"], event["to"]


def undrawn(machine: Machine, runs: int = 12) -> set[tuple[str, str, str]]:
    """The transitions of runs that one of both pictures lacks, that of the states as they were
    written or that of the generated ones. After an error, `to` may name no outcome."""
    view = written(machine)
    steps = {step for step in transitions_of_runs(machine, runs) if not step[2].endswith(":None")}
    whole = {
        (view.state(path), outcome, view.state(to))
        for path, outcome, to in steps
        if view.is_whole(path)
    }
    return (steps - drawn_transitions(machine_model(machine, view=generated(machine)))) | (
        whole - drawn_transitions(machine_model(machine))
    )


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
def test_what_runs_is_drawn(script: Path) -> None:
    machine = script_machine(script)
    if machine is not None and analyse_script(script).checked is not None:
        assert undrawn(machine) == set()


@settings(max_examples=150)
@given(valid_machines())
@pytest.mark.slow
def test_what_runs_is_drawn_for_random_machines(machine: Machine) -> None:
    assert undrawn(machine, 6) == set()


@settings(max_examples=examples(100))
@given(valid_machines())
def test_every_edge_connects_states_of_one_container(machine: Machine) -> None:
    model = machine_model(machine)
    nodes = {node["path"]: node for node in model["nodes"]}
    assert list(nodes) == [path for path, _ in walk(machine.root)]
    for node in nodes.values():
        assert all(nodes[child]["parent"] == node["path"] for child in node["children"])
        assert node["initial"] is None or node["initial"] in node["children"]
    followed: dict[tuple[str, str], set[str]] = {}
    for edge in model["edges"]:
        container = nodes[edge["container"]]
        assert edge["source"] is None or edge["source"] in container["children"]
        if isinstance(edge["target"], str):
            assert edge["target"] in container["children"]
        else:
            names = [item["name"] for item in container["outcomes"]]
            assert edge["target"]["outcome"] in names
        if edge["kind"] in ("written", "implicit", "connector"):
            key = edge["source"], edge["outcome"]
            followed.setdefault(key, set()).add(json.dumps(edge["target"]))
    assert all(len(targets) == 1 for targets in followed.values())


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
def test_every_script_has_a_model(script: Path) -> None:
    """Also a script with errors: the server shows it while it is edited."""
    analysis = analyse_script(script)
    if analysis.machine is None:
        return
    model = machine_model(analysis.machine, analysis.report)
    assert json.loads(json.dumps(model)) == model
    assert len(model["findings"]) == len(analysis.report)
    by_path = {node["path"]: node for node in model["nodes"]}
    for index, item in enumerate(model["findings"]):
        if item["node"] in by_path:
            assert index in by_path[item["node"]]["findings"]
    for node in model["nodes"]:
        assert node["snippet"].count("\n") <= SNIPPET_LINES
        assert "/" not in (node["file"] or "")


def test_model_of_an_example() -> None:
    analysis = analyse_script(ROOT / "examples/13_recovery/main.yml")
    assert analysis.machine is not None
    model = machine_model(analysis.machine, analysis.report)
    node = next(item for item in model["nodes"] if item["badges"])
    assert [part[:3] for part in node["parts"]] == [
        [f"{node['path']} (retry)", "retry", None],
        [node["path"], "state", "try"],
    ]
    (badge,) = node["badges"]
    assert badge["text"] == "3 tries"
    leaf = next(item for item in model["nodes"] if item["kind"] == "leaf" and item["inputs"])
    assert leaf["snippet"].lstrip("- ").startswith(leaf["name"])
    assert {"name", "key", "type", "doc"} == set(leaf["inputs"][0])


def test_properties_have_verdicts() -> None:
    script = next(
        path for path in SCRIPTS if (read := script_machine(path)) is not None and read.properties
    )
    analysis = analyse_script(script)
    assert analysis.machine is not None
    found = machine_model(analysis.machine)["properties"]
    assert found
    assert {item["verdict"] for item in found} <= {
        *("holds", "fails", "vacuous", "undecided", "unclear"),
    }


def test_markup_of_a_script_is_only_text() -> None:
    page = page_of(MARKUP)
    parsed = Elements(page)
    tags = [tag for tag, _ in parsed.found]
    assert tags.count("script") == 3
    assert not {"img", "svg", "textarea"} & set(tags)
    model = json.loads(parsed.texts[MODEL_ID])
    assert model["nodes"][0]["doc"].startswith("</script><script>alert(1)</script> <!-- -->")
    assert model["nodes"][1]["name"] == "GRÜßE"
    assert page.isascii()


def test_names_of_scripts_in_the_head_are_escaped() -> None:
    machine = script_machine(ROOT / "examples/01_sequence/main.yml")
    assert machine is not None
    from dataclasses import replace

    odd = "--><script>\"'</title>"
    changed = replace(machine, source=odd, root=replace(machine.root, name=odd))
    parsed = Elements(render_page(changed, machine_model(changed)))
    assert [tag for tag, _ in parsed.found].count("script") == 3
    assert parsed.texts["title"].startswith(odd)


def test_policy_allows_the_parts_of_the_page_alone() -> None:
    page = page_of(MARKUP)
    parsed = Elements(page)
    (policy,) = (
        attributes["content"] or ""
        for tag, attributes in parsed.found
        if tag == "meta" and attributes.get("http-equiv") == "Content-Security-Policy"
    )
    rules = dict(rule.split(" ", 1) for rule in policy.split("; "))
    assert rules["default-src"] == rules["connect-src"] == "'none'"
    for rule, text in (
        ("script-src", parsed.texts["script"]),
        ("style-src", parsed.texts["style"]),
    ):
        digest = b64encode(sha256(text.encode()).digest()).decode()
        assert rules[rule] == f"'sha256-{digest}'"
    links = re.findall(r'(?:src|href)="', page.replace(parsed.texts[LAYOUT_ID], ""))
    assert links == []


def test_page_is_the_same_each_time_and_of_bounded_size() -> None:
    first = page_of(MARKUP)
    assert first == page_of(MARKUP)
    assert len(first) < 1_900_000
    assert first.split("\n")[1].startswith("<!-- Made by smachac ")


def test_snippets_are_bounded() -> None:
    states = "".join(f"      # {number}\n" for number in range(500))
    text = (
        "name: sm\noutcomes: [done]\nstates:\n  - A:\n      template: ScriptedState\n"
        f"{states}      outcomes: [done]\n"
    )
    analysis = analyse(Source("main.yml", text), disk_library(Path("main.yml"), []), [])
    assert analysis.machine is not None
    snippet = machine_model(analysis.machine)["nodes"][1]["snippet"]
    assert snippet.splitlines()[0] == "- A:"
    assert len(snippet.splitlines()) == SNIPPET_LINES + 1
    assert snippet.endswith("…")

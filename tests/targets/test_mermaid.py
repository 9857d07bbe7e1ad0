"""The mermaid target: the text of the diagrams. Mermaid's own parser reads them in
test_mermaid_parser.py."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import assume, given

from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Machine, Node, StateMachine
from smachac.ir.traversal import walk
from smachac.ir.written import generated
from smachac.targets import BuildContext, OptionError
from smachac.targets.mermaid import TARGET
from smachac.targets.mermaid.diagram import diagram, label
from smachac.version import __version__
from tests.strategies.machines import machines
from tests.targets.test_dot import (
    FLAT,
    NO_FILES,
    ODD_NAMES,
    iterator,
    leaf,
    machine_of,
    nested,
    outcomes,
    when,
)

ROOT = Path(__file__).parents[2]


def drawn(root: StateMachine, **options: str) -> list[str]:
    machine = nodes.Checked(Machine(root=root, source="main.yml", digest="0123456789abcdef" * 4))
    files = TARGET.emit(machine, BuildContext(library=NO_FILES, options=options), [])
    assert list(files) == ["sm.mmd"]
    assert files["sm.mmd"].endswith("\n")
    return files["sm.mmd"].splitlines()


def test_a_flat_machine() -> None:
    assert drawn(FLAT) == [
        f"%% Made by smachac {__version__} from main.yml (sha256 0123456789abcdef).",
        "stateDiagram-v2",
        "  accTitle: sm",
        "  direction TB",
        '  state "PICK" as sm__PICK',
        "  sm__PICK : Work",
        '  state "PLACE" as sm__PLACE',
        "  sm__PLACE : Work",
        "  [*] --> sm__PICK",
        "  sm__PICK --> sm__PLACE : succeeded",
        "  sm__PICK --> [*] : ✗ (aborted)",
        "  sm__PLACE --> sm__PICK : ✗ aborted<br/>✗ timeout",
        "  sm__PLACE --> [*] : (succeeded)",
    ]


def test_containers_are_composite_states_before_the_others() -> None:
    lines = drawn(nested())
    at = lines.index('  state "PICK" as sm__PICK {')
    assert lines[at + 1 : at + 7] == [
        '    state "GRASP" as sm__PICK__GRASP',
        "    sm__PICK__GRASP : Work",
        "    [*] --> sm__PICK__GRASP",
        "    sm__PICK__GRASP --> [*] : (succeeded)<br/>✗ (aborted)",
        "  }",
        '  state "GO" as sm__GO',
    ]
    assert "  sm__PICK --> [*] : ✗ (aborted)" in lines


def test_deeper_containers_are_closed_boxes() -> None:
    lines = drawn(nested(), depth="1")
    assert '  state "PICK" as sm__PICK' in lines
    assert "  sm__PICK : StateMachine +" in lines
    assert "}" not in "".join(lines)
    assert drawn(nested(), depth="2") == drawn(nested())


def test_a_container_without_states_is_a_box() -> None:
    assert '  state "IN" as sm__IN' in drawn(machine_of("sm", (), machine_of("IN", ())))


def both(**fields: object) -> Concurrence:
    values: dict[str, object] = {
        "name": "BOTH",
        "type": "Concurrence",
        "outcomes": outcomes("done", "aborted"),
        "children": (leaf("LEFT", "done"), leaf("RIGHT", "done", "aborted")),
        "default_outcome": "aborted",
        "rules": (
            nodes.OutcomeRule(outcome="done", when=(when("LEFT"), when("RIGHT")), span=FLAT.span),
        ),
        "transitions": leaf("", "done", aborted="BOTH").transitions,
        "span": FLAT.span,
    }
    return Concurrence(**(values | fields))  # type: ignore[arg-type]


def test_a_concurrence_has_a_region_for_each_child_and_its_rules_at_its_edges() -> None:
    lines = drawn(machine_of("sm", ("done",), both()))
    at = lines.index('  state "BOTH (Concurrence)" as sm__BOTH {')
    assert lines[at + 1 :] == [
        '    state "LEFT" as sm__BOTH__LEFT',
        "    sm__BOTH__LEFT : Work",
        "    [*] --> sm__BOTH__LEFT",
        "    sm__BOTH__LEFT --> [*] : done",
        "    --",
        '    state "RIGHT" as sm__BOTH__RIGHT',
        "    sm__BOTH__RIGHT : Work",
        "    [*] --> sm__BOTH__RIGHT",
        "    sm__BOTH__RIGHT --> [*] : done<br/>✗ aborted",
        "  }",
        "  [*] --> sm__BOTH",
        "  sm__BOTH --> sm__BOTH : ✗ aborted (otherwise)",
        "  sm__BOTH --> [*] : (done (LEFT = done and RIGHT = done))",
    ]
    first = drawn(machine_of("sm", ("done",), both(join="any")))
    assert '  state "BOTH (Concurrence, first to end)" as sm__BOTH {' in first


def test_an_iterator_describes_its_loop() -> None:
    lines = drawn(machine_of("sm", (), iterator(items_key="feet")))
    assert [line.strip() for line in lines if "EACH__STEP " in line or "no items" in line] == [
        "sm__EACH__STEP : Work",
        "[*] --> sm__EACH__STEP : for each foot in feet<br/>next item after succeeded",
        "sm__EACH__STEP --> [*] : succeeded → done (after the last item)<br/>✗ aborted",
        "[*] --> [*] : no items → done",
    ]


def test_the_direction() -> None:
    assert "  direction LR" in drawn(FLAT, direction="LR")


@pytest.mark.parametrize("options", [{"depth": "0"}, {"depth": "x"}, {"direction": "UP"}])
def test_options_that_make_no_sense(options: dict[str, str]) -> None:
    with pytest.raises(OptionError, match="must be"):
        drawn(FLAT, **options)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("PICK_BLOCK.2-a", "PICK_BLOCK.2-a"),
        ("größe 2", "größe 2"),
        ("_x_", "#95;x#95;"),
        ("1. a", "1#46;#32;a"),
        ("direction TB", "direction#32;TB"),
        ("Direction  LR", "Direction#32;LR"),
        ('"<b>:#;{%}', "#34;#60;b#62;#58;#35;#59;#123;#37;#125;"),
        ("a\x00\ud800", "a#65533;#65533;"),
        ("", "#160;"),
    ],
)
def test_labels(text: str, shown: str) -> None:
    assert label(text) == shown


@given(ODD_NAMES)
def test_a_label_is_letters_and_digits_and_character_codes(text: str) -> None:
    assert re.fullmatch(r"(?:[^\W_]|[_. -]|#\d+;)+", label(text))


@given(machines())
def test_every_state_has_an_identifier_of_its_own(machine: Machine) -> None:
    states = [node for _, node in walk(machine.root)]
    assume(all(_distinct(node) for node in states))
    lines = list(diagram(machine, generated(machine), depth=None, direction="TB"))
    found = [match[1] for line in lines if (match := re.search(r'" as (\w+)(?: \{)?$', line))]
    assert len(set(found)) == len(found) == len(states) - 1
    assert all(id.isascii() and not id.endswith(("_start", "_end")) for id in found)


def _distinct(node: Node) -> bool:
    """Whether the children of a node have different names."""
    names = [child.name for child in getattr(node, "children", ())]
    return len(set(names)) == len(names)


def test_names_that_look_alike_or_are_used_by_mermaid() -> None:
    names = ["ä", "ö", "a_start", "a end", "__2"]
    lines = drawn(machine_of("sm", (), *(leaf(name) for name in names)))
    found = [line.split()[-1] for line in lines if " as " in line]
    assert found == ["sm___", "sm____2", "sm__a_start_", "sm__a_end_", "sm____2_2"]


def test_the_page_shows_the_diagram_of_the_example() -> None:
    page = (ROOT / "docs" / "targets.md").read_text("utf-8")
    block = page.partition("```mermaid\n")[2].partition("```")[0]
    example = ROOT / "tests/cases/examples/03_concurrence/expected/mermaid/prepare.mmd"
    assert example.read_text("utf-8").partition("\n")[2] == block


def test_the_file_grows_with_the_states() -> None:
    def lines(count: int) -> int:
        chain = [leaf(f"S{n}", "aborted", succeeded=f"S{(n + 1) % count}") for n in range(count)]
        return len(drawn(machine_of("sm", ("aborted",), *chain)))

    assert lines(200) - lines(100) == lines(300) - lines(200)


def test_nesting_has_no_limit() -> None:
    inner: Node = leaf("L", "aborted")
    for _ in range(500):
        inner = machine_of("M", ("aborted",), inner)
    root = machine_of("sm", ("aborted",), inner)
    assert sum("{" in line for line in drawn(root, depth="600")) == 500
    assert sum("{" in line for line in drawn(root)) == 39

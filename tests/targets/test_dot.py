"""The dot target: what stands in the file, and what Graphviz itself makes of it."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.diagnostics.source import NOWHERE
from smachac.frontend.loader import Library
from smachac.ir import nodes
from smachac.ir.nodes import (
    Checked,
    Concurrence,
    Condition,
    Leaf,
    Machine,
    Node,
    Outcome,
    OutcomeRule,
    Sequence,
    StateMachine,
    Transition,
    Value,
)
from smachac.targets import BuildContext, stem
from smachac.targets.dot import TARGET
from smachac.targets.dot.style import TONES, identifier, tone
from smachac.version import __version__


def outcomes(*names: str) -> tuple[Outcome, ...]:
    return tuple(Outcome(name=name, span=NOWHERE) for name in names)


def leaf(name: str, *ends: str, doc: str = "", **to: str) -> Leaf:
    """A leaf whose outcomes are the keys of `to` and, with implicit edges, `ends`."""
    steps = [Transition(outcome=o, target=target, span=NOWHERE) for o, target in to.items()]
    steps += [Transition(outcome=o, target=o, origin="implicit", span=NOWHERE) for o in ends]
    return Leaf(
        name=name,
        type="Work",
        doc=doc,
        outcomes=outcomes(*to, *ends),
        transitions=tuple(steps),
        span=NOWHERE,
    )


def machine_of(name: str, ends: tuple[str, ...], *children: Node, **to: str) -> StateMachine:
    """A state machine that starts with its first child; `to` are its own transitions."""
    return StateMachine(
        name=name,
        type="StateMachine",
        outcomes=outcomes(*ends),
        children=children,
        initial=children[0].name if children else "",
        transitions=leaf("", **to).transitions,
        span=NOWHERE,
    )


def drawn(root: StateMachine, **options: str) -> str:
    machine = Checked(Machine(root=root, source="main.yml", digest="0123456789abcdef" * 4))
    files = TARGET.emit(machine, BuildContext(library=NO_FILES, options=options), [])
    assert list(files) == [f"{stem(machine)}.dot"]
    return files[f"{stem(machine)}.dot"]


NO_FILES = Library(
    script=lambda name, caller: None,
    template=lambda name: None,
    script_folders=lambda caller: [],
    template_folders=list,
    script_names=lambda caller: [],
    template_names=list,
)


@pytest.fixture(scope="session")
def graphviz() -> Callable[[str, str], str]:
    """What Graphviz makes of a DOT text in a format; it must have nothing to complain of."""
    dot = shutil.which("dot")
    if dot is None:
        pytest.skip("Graphviz is not installed")

    def run(text: str, form: str) -> str:
        result = subprocess.run(
            [dot, f"-T{form}"], input=text, capture_output=True, encoding="utf-8", check=False
        )
        assert result.returncode == 0, result.stderr
        assert result.stderr == ""
        return result.stdout

    return run


FLAT = machine_of(
    "sm",
    ("succeeded", "aborted"),
    leaf("PICK", "aborted", succeeded="PLACE", doc="Close the gripper."),
    leaf("PLACE", "succeeded", aborted="PICK", timeout="PICK"),
)


def test_a_flat_machine() -> None:
    lines = drawn(FLAT).splitlines()
    assert lines[:2] == [
        f"// Made by smachac {__version__} from main.yml (sha256 0123456789abcdef).",
        'digraph "sm" {',
    ]
    assert lines[-1] == "}"
    assert [line for line in lines if " -> " in line] == [
        '  "sm#start" -> "sm/PICK" [color="#57606a", weight="20"]',
        '  "sm/PICK" -> "sm/PLACE" [label=< <FONT COLOR="#1a7f37">succeeded</FONT> >, '
        'color="#1a7f37", tooltip="succeeded", weight="20"]',
        '  "sm/PICK" -> "sm=aborted" [color="#cf222e", tooltip="aborted", style="dashed"]',
        '  "sm/PLACE" -> "sm/PICK" [label=< <FONT COLOR="#cf222e">aborted</FONT> <BR/> '
        '<FONT COLOR="#bc4c00">timeout</FONT> >, color="#cf222e", tooltip="aborted, timeout"]',
        '  "sm/PLACE" -> "sm=succeeded" [color="#1a7f37", tooltip="succeeded", '
        'style="dashed", weight="20"]',
    ]
    box = next(line for line in lines if line.startswith('  "sm/PICK" ['))
    assert "<B>PICK</B>" in box
    assert ">Work</FONT>" in box
    assert 'tooltip="Close the gripper."' in box
    exits = next(line for line in lines if "rank=same" in line)
    assert exits.count('peripheries="2"') == 2


def nested() -> StateMachine:
    pick = machine_of("PICK", ("succeeded", "aborted"), leaf("GRASP", "succeeded", "aborted"))
    again = leaf("PICK_2", aborted="PICK")
    inner = replace(pick, transitions=leaf("", "aborted", succeeded="PICK_2").transitions)
    return machine_of("sm", ("aborted",), leaf("GO", succeeded="PICK"), inner, again)


def test_edges_meet_a_container_at_its_border_and_leave_from_its_exits() -> None:
    text = drawn(nested())
    assert 'subgraph "cluster_sm/PICK" {' in text
    assert 'lhead="cluster_sm/PICK"' in edge(text, "sm/GO", "sm/PICK#start")
    assert 'lhead="cluster_sm/PICK"' in edge(text, "sm/PICK_2", "sm/PICK#start")
    assert "label" not in edge(text, "sm/PICK=succeeded", "sm/PICK_2")
    assert "dashed" in edge(text, "sm/PICK=aborted", "sm=aborted")


def test_no_edge_is_clipped_at_a_border_that_it_does_not_cross() -> None:
    child = machine_of("PICK", ("aborted",), leaf("GRASP", "aborted"))
    retried = replace(child, transitions=leaf("", aborted="PICK").transitions)
    text = drawn(machine_of("sm", (), retried))
    assert "lhead" not in edge(text, "sm/PICK=aborted", "sm/PICK#start")


def test_deeper_containers_are_closed_boxes() -> None:
    text = drawn(nested(), depth="1")
    assert "subgraph" not in text
    assert "StateMachine <B>+</B>" in text
    assert "lhead" not in edge(text, "sm/GO", "sm/PICK")
    assert "succeeded</FONT>" in edge(text, "sm/PICK", "sm/PICK_2")
    assert drawn(nested(), depth="2") == drawn(nested())


def test_a_concurrence_forks_and_joins() -> None:
    both = Concurrence(
        name="BOTH",
        type="Concurrence",
        outcomes=outcomes("done", "aborted"),
        children=(leaf("LEFT", "done"), leaf("RIGHT", "done", "aborted"), leaf("LOG", "done")),
        default_outcome="aborted",
        join="any",
        rules=(
            OutcomeRule(outcome="done", when=(when("LEFT"), when("RIGHT")), span=NOWHERE),
            OutcomeRule(outcome="aborted", when=(when("RIGHT", "aborted"),), span=NOWHERE),
        ),
        span=NOWHERE,
    )
    text = drawn(machine_of("sm", (), both))
    assert "|| Concurrence, first to end" in text
    for name in ("LEFT", "RIGHT", "LOG"):
        assert edge(text, "sm/BOTH#start", f"sm/BOTH/{name}")
    for name in ("LEFT", "RIGHT"):
        assert "done</FONT>" in edge(text, f"sm/BOTH/{name}", "sm/BOTH#start+0")
    assert edge(text, "sm/BOTH#start+0", "sm/BOTH=done")
    assert "label" not in edge(text, "sm/BOTH/RIGHT", "sm/BOTH=aborted")
    assert "dashed" in edge(text, "sm/BOTH/LOG", "sm/BOTH=aborted")
    assert text.count(">otherwise<") == 1
    assert 'width="1.2", height="0.06"' in text
    assert 'width="0.06", height="1.2"' in drawn(machine_of("sm", (), both), rankdir="LR")


def when(child: str, outcome: str = "done") -> Condition:
    return Condition(child=child, outcome=outcome, span=NOWHERE)


def iterator(**fields: object) -> nodes.Iterator:
    values: dict[str, object] = {
        "name": "EACH",
        "type": "Iterator",
        "outcomes": outcomes("done", "aborted"),
        "children": (leaf("STEP", "succeeded", "aborted"),),
        "item_key": "foot",
        "loop_outcomes": ("succeeded",),
        "final_map": (("exhausted", "done"),),
        "span": NOWHERE,
    }
    return nodes.Iterator(**(values | fields))  # type: ignore[arg-type]


def test_an_iterator_loops() -> None:
    text = drawn(machine_of("sm", (), iterator(items_key="feet")))
    assert "for each <B>foot</B>" in text
    assert ">in feet<" in text
    assert edge(text, "sm/EACH#start", "sm/EACH/STEP")
    assert "succeeded</FONT>" in edge(text, "sm/EACH/STEP", "sm/EACH#start")
    assert "exhausted</FONT>" in edge(text, "sm/EACH#start", "sm/EACH=done")
    assert "label" not in edge(text, "sm/EACH/STEP", "sm/EACH=aborted")


@pytest.mark.parametrize(
    ("data", "shown"),
    [
        ((1, "b", None), ">in [1, b, None]<"),
        (tuple(range(9)), ">in 9 items<"),
        (nodes.Expression(text="ud.blocks[1:]", span=NOWHERE), ">in ud.blocks[1:]<"),
        (("x" * 40,), f">in [{'x' * 22}…<"),
    ],
)
def test_what_an_iterator_runs_over(data: nodes.Data, shown: str) -> None:
    values = Value(data=data, span=NOWHERE)
    assert shown in drawn(machine_of("sm", (), iterator(items=values)))


def test_exits_stay_below_what_only_leads_back() -> None:
    text = drawn(machine_of("sm", ("done",), leaf("A", "done", no="B"), leaf("B", done="A")))
    assert edge(text, "sm/B", "sm=done") == '"sm/B" -> "sm=done" [style="invis"]'


def test_an_empty_machine(graphviz: Callable[[str, str], str]) -> None:
    assert " -> " not in drawn(machine_of("sm", ()))
    graphviz(drawn(machine_of("sm", ())), "plain")


@pytest.mark.parametrize("options", [{"depth": "0"}, {"depth": "x"}, {"rankdir": "UP"}])
def test_options_that_make_no_sense(options: dict[str, str]) -> None:
    with pytest.raises(ValueError, match="must be"):
        drawn(FLAT, **options)


@pytest.mark.parametrize(
    ("outcome", "expected"),
    [
        ("succeeded", "success"),
        ("Aborted", "failure"),
        ("grasp_failed", "failure"),
        ("not_done", "failure"),
        ("no_error", "success"),
        ("timeout", "warning"),
        ("preempted", "warning"),
        ("blocked", "neutral"),
        ("", "neutral"),
    ],
)
def test_tones(outcome: str, expected: str) -> None:
    state = leaf("A", outcome)
    assert tone(outcome, state) == expected
    assert expected in TONES


SVG, XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"


def edge(text: str, tail: str, head: str) -> str:
    """The one line with the arrow between two nodes."""
    start = f'"{tail}" -> "{head}" '
    (line,) = [line.strip() for line in text.splitlines() if line.strip().startswith(start)]
    return line


ODD_NAMES = st.text(
    alphabet=st.one_of(st.sampled_from('a"\\/\n<>&%#=+.;{}[]|\x00\ud800日 '), st.characters()),
    min_size=1,
    max_size=8,
)


@given(ODD_NAMES, ODD_NAMES)
def test_no_two_names_share_a_node(one: str, two: str) -> None:
    assert (identifier(one) == identifier(two)) == (one == two)
    assert all(c.isalnum() or c in "_~.-" for c in identifier(one))


@settings(max_examples=5)
@given(ODD_NAMES, st.lists(ODD_NAMES, min_size=1, max_size=20, unique=True))
def test_graphviz_reads_any_name(
    graphviz: Callable[[str, str], str], name: str, states: list[str]
) -> None:
    leaves = [leaf(state, *states[:2], doc=state) for state in states]
    inside = machine_of(name, tuple(states), *leaves)
    root = machine_of(name, tuple(states), replace(inside, doc=name, type=name))
    svg = ElementTree.fromstring(graphviz(drawn(root), "svg"))
    titles = [title.text for title in svg.iter(f"{{{SVG}}}title")]
    place = f"{identifier(name)}/{identifier(name)}"
    assert {f"{place}/{identifier(state)}" for state in states} <= set(titles)


def test_graphviz_shows_texts_as_they_are(graphviz: Callable[[str, str], str]) -> None:
    root = machine_of("sm", ("a<b>&\\n",), leaf('"x\\', "a<b>&\\n", doc='<say "no" & \\N'))
    svg = ElementTree.fromstring(graphviz(drawn(root), "svg"))
    texts = [text for text in svg.itertext() if text.strip()]
    assert '"x\\' in texts
    assert "a<b>&\\n" in texts
    assert '<say "no" & \u2216N' in [item.get(f"{{{XLINK}}}title") for item in svg.iter()]


MACHINES: Mapping[str, StateMachine] = {
    "flat": FLAT,
    "nested": nested(),
    "sequence": machine_of(
        "sm",
        ("succeeded",),
        Sequence(
            name="ALL",
            type="Sequence",
            outcomes=outcomes("succeeded"),
            children=(leaf("ONE", succeeded="TWO"), leaf("TWO", "succeeded")),
            initial="ONE",
            transitions=leaf("", "succeeded").transitions,
            span=NOWHERE,
        ),
    ),
    "iterator": machine_of("sm", (), iterator(items_key="feet")),
}


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("rankdir", ["TB", "LR"])
def test_graphviz_draws_every_node_once(
    graphviz: Callable[[str, str], str], name: str, rankdir: str
) -> None:
    root = MACHINES[name]
    plain = graphviz(drawn(root, rankdir=rankdir), "plain").splitlines()
    found = [line.split()[1].strip('"') for line in plain if line.startswith("node ")]
    assert sorted(found) == sorted(set(found))
    assert sorted(found) == sorted(expected_nodes(root, root.name))


def expected_nodes(node: Node, path: str) -> list[str]:
    if isinstance(node, Leaf):
        return [path]
    names = [f"{path}#start", *(f"{path}={outcome.name}" for outcome in node.outcomes)]
    for child in node.children:
        names += expected_nodes(child, f"{path}/{child.name}")
    return names


def test_the_file_grows_with_the_states() -> None:
    def lines(count: int) -> int:
        chain = [leaf(f"S{n}", "aborted", succeeded=f"S{(n + 1) % count}") for n in range(count)]
        return drawn(machine_of("sm", ("aborted",), *chain)).count("\n")

    assert lines(200) - lines(100) == lines(300) - lines(200)


def test_nesting_has_no_limit() -> None:
    inner: Node = leaf("L", "aborted")
    for _ in range(500):
        inner = machine_of("M", ("aborted",), inner)
    root = machine_of("sm", ("aborted",), inner)
    assert drawn(root, depth="600").count("subgraph") == 500
    assert drawn(root).count("subgraph") == 39

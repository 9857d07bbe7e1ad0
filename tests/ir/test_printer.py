from __future__ import annotations

import contextlib
import dataclasses
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.diagnostics.source import NOWHERE
from smachac.grammars import parser_of
from smachac.ir import parser
from smachac.ir.nodes import (
    Concurrence,
    Data,
    Expression,
    Iterator,
    Leaf,
    Machine,
    Node,
    Preset,
    Sequence,
    StateMachine,
    Value,
)
from smachac.ir.parser import IrSyntaxError, parse_machine
from smachac.ir.printer import print_machine
from smachac.ir.traversal import walk
from tests.strategies.machines import machines
from tests.support.examples import examples


def holding(data: Data) -> Machine:
    preset = Preset(key="k", value=Value(data=data, span=NOWHERE), span=NOWHERE)
    root = StateMachine(name="sm", type="StateMachine", userdata=(preset,), span=NOWHERE)
    return Machine(root=root)


def held(machine: Machine) -> Data:
    return machine.root.userdata[0].value.data


@given(machines())
@settings(max_examples=examples(60))
def test_reading_what_is_printed_gives_the_same_machine(machine: Machine) -> None:
    text = print_machine(machine)
    again = parse_machine(text)
    assert again == machine
    # Equality does not tell 1, 1.0 and True apart, nor does it look at the digest.
    assert repr(again) == repr(machine)
    assert print_machine(again) == text


EXAMPLE = """\
# A state graph of smachac, format 1: one statement a line, as in grammars/ir.lark.
script "main.yml"
digest "ab12"
base PyBulletBase
variable node_name = "demo"

machine sm: StateMachine {
  doc "Pick the block."
  outcomes succeeded, aborted
  userdata pose: Pose = [[0.5, 0.0, 0.02], [1.0, 0.0, 0.0, 0.0]]
  initial MOVE
  forever

  state MOVE: MoveTo {
    outcomes succeeded
    outcomes aborted "Goal not reached."
    input positions: float<rad>[7] "Where to."
    output error: float<m>
    claims arm
    blocking
    writes aborted: error, "a b"
    variable speed = 1.5
    variable callbacks = {done: `lambda ud: ud.n + 1`, "a b": [null, true, -3]}
    remap positions -> joints
    on succeeded -> BOTH
    on aborted -> aborted (implicit)
  }

  concurrence BOTH: Concurrence {
    outcomes succeeded, aborted
    default aborted
    join any
    rule succeeded when "left arm" = done, RIGHT = done
    on succeeded -> EACH

    state "left arm": Unknown {
      open
    }

    state RIGHT: Unknown {}
  }

  iterator EACH: Iterator {
    outcomes finished
    items from waypoints
    item waypoint
    exhausted empty
    loop done, again
    final empty -> finished

    sequence CHAIN: Sequence {
      outcomes done
      connector done
      initial A
    }
  }
}
"""


def node(machine: Machine, name: str) -> Node:
    (found,) = (each for _, each in walk(machine.root) if each.name == name)
    return found


def test_the_notation_says_what_a_machine_is() -> None:
    machine = parse_machine(EXAMPLE)
    assert (machine.source, machine.digest, machine.base) == ("main.yml", "ab12", "PyBulletBase")
    assert machine.root.forever
    assert machine.root.initial == "MOVE"
    move, both, each = machine.root.children
    assert isinstance(move, Leaf)
    assert isinstance(both, Concurrence)
    assert isinstance(each, Iterator)
    assert isinstance(each.children[0], Sequence)
    assert [outcome.doc for outcome in move.outcomes] == ["", "Goal not reached."]
    assert str(move.inputs[0].type) == "float<rad>[7]"
    assert [step.origin for step in move.transitions] == ["written", "implicit"]
    assert both.join == "any"
    assert [(item.child, item.outcome) for item in both.rules[0].when] == [
        ("left arm", "done"),
        ("RIGHT", "done"),
    ]
    assert (each.items, each.items_key, each.item_key) == (None, "waypoints", "waypoint")
    assert each.final_map == (("empty", "finished"),)


def test_printing_what_was_read_gives_the_same_text() -> None:
    assert print_machine(parse_machine(EXAMPLE)) == EXAMPLE


def test_spans_point_into_the_text() -> None:
    machine = parse_machine(EXAMPLE, "demo.smir")
    move = node(machine, "MOVE")
    assert isinstance(move, Leaf)
    assert str(move.span) == "demo.smir:14:9"
    assert move.span.text == "MOVE"
    step = move.transitions[0]
    assert (step.span.text, step.target_span.text) == ("succeeded", "BOTH")
    assert move.variables[0].value.span.text == "1.5"
    assert machine.root.initial_span.text == "MOVE"
    assert machine.root.userdata[0].value.span.text.startswith("[[0.5")
    both = node(machine, "BOTH")
    assert isinstance(both, Concurrence)
    assert both.default_span.text == "aborted"
    assert both.rules[0].when[0].span.text == '"left arm"'


def test_comments_blank_lines_and_the_order_of_statements_do_not_matter() -> None:
    text = 'machine sm: M { # why\n\n initial A doc "x" # {\n outcomes a outcomes b}  # end'
    machine = parse_machine(text)
    assert (machine.root.initial, machine.root.doc) == ("A", "x")
    assert [outcome.name for outcome in machine.root.outcomes] == ["a", "b"]


@pytest.mark.parametrize(
    "data",
    [
        *(
            0,
            -1,
            10**3000,
            -(10**5000),
            1 << 20_000,
            0.1,
            -0.0,
            1e22,
            5e-324,
            1.7976931348623157e308,
        ),
        *(float("inf"), float("-inf"), True, False, None, "", "é\u2028\x85\x00\x7f", "\ud800"),
        *((), ((),), ("[", ("]",))),
        Expression(text="`x`", span=NOWHERE),
        Expression(text="a\nb", span=NOWHERE),
        Expression(text=' f("x") # y ', span=NOWHERE),
    ],
    ids=lambda data: type(data).__name__,
)
def test_values_come_back_exactly(data: Data) -> None:
    found = held(parse_machine(print_machine(holding(data))))
    assert type(found) is type(data)
    assert found == data
    if isinstance(data, float):
        assert found.hex() == data.hex()  # type: ignore[union-attr]


def test_nan_stays_nan() -> None:
    found = held(parse_machine(print_machine(holding(float("nan")))))
    assert found != found


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("machine sm: M {\n  inital A\n}", 2, 3, "unexpected `inital`"),
        ("machine sm: M {\n  doc 'x'\n}", 2, 7, "unexpected `'x'`; a string would fit"),
        ("machine sm: M {\n", 2, 1, "unexpected the end of the text"),
        ("", 1, 1, "unexpected the end of the text"),
        ("machine sm M {}", 1, 12, "unexpected `M`; `:` would fit"),
        ("machine sm: M {}\nmachine x: M {}", 2, 1, "unexpected `machine`"),
        ("state sm: M {}", 1, 1, "the outermost container is a `machine`"),
        ("machine sm: M {\n  open\n}", 2, 3, "a machine has no such statement"),
        ("machine sm: M {\n  state A: T {initial B}\n}", 2, 15, "a state has no such statement"),
        ("machine sm: M {\n  state A: T {state B: T {}}\n}", 2, 3, "a state has no states inside"),
        ("machine sm: M {\n  forever\n  forever\n}", 3, 3, "this is given twice"),
        ("machine sm: M {\n  input x: list[\n}", 2, 12, "`list[` is no type"),
        ("machine sm: M {\n  userdata x = " + "9" * 5000 + "\n}", 2, 16, "too many digits"),
        ("machine sm: M {\n  userdata x = " + "[" * 9999 + "]" * 9999 + "}", 1, 1, "too deeply"),
        ("initial A machine sm: M {}", 1, 1, "a program has no such statement"),
        ('machine sm: M { doc "\\q" }', 1, 21, "unexpected"),
    ],
)
def test_a_text_that_is_no_machine_is_an_error_with_its_place(
    text: str, line: int, column: int, message: str
) -> None:
    with pytest.raises(IrSyntaxError) as caught:
        parse_machine(text, "bad.smir")
    assert (caught.value.line, caught.value.column) == (line, column)
    assert message in caught.value.message
    assert str(caught.value).startswith(f"bad.smir:{line}:{column}: ")


@given(st.data())
@settings(max_examples=examples(60))
def test_no_text_raises_anything_else(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(EXAMPLE)))
    end = data.draw(st.integers(start, min(start + 20, len(EXAMPLE))))
    text = EXAMPLE[:start] + data.draw(st.text('ab {}[]",:=->#`\n', max_size=4)) + EXAMPLE[end:]
    with contextlib.suppress(IrSyntaxError):
        machine = parse_machine(text)
        assert parse_machine(print_machine(machine)) == machine


def test_defaults_are_left_out() -> None:
    text = print_machine(Machine(root=StateMachine(name="sm", type="M", span=NOWHERE)))
    assert text.splitlines()[1:] == ["", "machine sm: M {}"]


def test_what_is_empty_is_not_the_default() -> None:
    each = Iterator(name="", type="", item_key="", exhausted_outcome="", span=NOWHERE)
    root = StateMachine(name="", type="", children=(each,), span=NOWHERE)
    machine = Machine(root=root, base="")
    assert parse_machine(print_machine(machine)) == machine


def test_deep_nesting_prints_and_reads() -> None:
    root = StateMachine(name="sm", type="M", span=NOWHERE)
    for _ in range(1500):
        root = StateMachine(name="sm", type="M", children=(root,), span=NOWHERE)
    text = print_machine(Machine(root=root))
    again = parse_machine(text)
    assert print_machine(again) == text
    assert sum(1 for _ in walk(again.root)) == 1501


def test_the_grammar_has_every_kind_and_every_field_of_it() -> None:
    kinds = get_args(Node)
    grammar = parser_of("ir")
    assert {word for word in parser.KINDS if grammar_accepts(word)} == {k.keyword for k in kinds}
    names = {field.name for kind in (Machine, *kinds) for field in dataclasses.fields(kind)}
    places = {"span", "via", *(name for name in names if name.endswith(("_span", "_spans")))}
    in_the_head = {"name", "type", "children", "root"}
    in_other_files = {
        "aliases",
        "class_facts",
        "fixed_params",
        "functions",
        "params",
        "properties",
        "robot",
        "state_types",
        "unused",
        "written",
    }
    in_other_files |= {"adds_frames", "built_in", "definitions", "missing_definitions", "stand_in"}
    in_other_files |= {
        "autonomy",
        "any_key",
        "misplaced_keys",
        "other_types",
        "synthetic",
        "unknown",
    }
    statements = {rule.alias for rule in grammar.rules if rule.origin.name == "statement"}
    assert names - places - in_the_head - in_other_files == statements


def grammar_accepts(keyword: str) -> bool:
    """Whether a keyword begins a node."""
    try:
        inner = parse_machine(f"machine sm: M {{ {keyword} A: T {{}} }}").root.children[0]
    except IrSyntaxError:
        return False
    return type(inner) is parser.KINDS[keyword]

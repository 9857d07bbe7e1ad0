from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.data_types import type_of_data
from smachac.analysis.expression_types import limited, type_of, type_of_call
from smachac.analysis.type_inference import infer
from smachac.analysis.type_lattice import fits, misfit, widened
from smachac.checks import check_machine
from smachac.diagnostics.source import NOWHERE
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.evaluator import EvaluationError, evaluate
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.ir.expressions import Expr, parse_expression
from smachac.ir.nodes import Data, Expression, Leaf, Machine, Node, StateMachine, Struct
from smachac.ir.parser import parse_machine
from smachac.ir.printer import print_machine
from smachac.ir.traversal import walk
from smachac.ir.types import Type, parse_type
from tests.strategies.expressions import NAMES_OF_VALUES, VALUES, computations
from tests.strategies.machines import machines, valid_machines
from tests.support.examples import examples
from tests.support.typed_machines import with_state_types


def a(text: str) -> Type:
    found = parse_type(text)
    assert found is not None
    return found


NAMES = {
    "i": a("int"),
    "x": a("float<m>"),
    "s": a("str"),
    "b": a("bool"),
    "l": a("list[int]"),
    "p": a("Pose"),
    "d": a("dict[str, float]"),
    "maybe": a("float?"),
    "mode": a("one_of[open, close]"),
    "u": a("any"),
}


@pytest.mark.parametrize(
    ("text", "type_"),
    [
        ("ud.i + 1", "int"),
        ("ud.i / 2", "float"),
        ("ud.i // 2", "int"),
        ("ud.x + 1", "float<m>"),
        ("ud.x * 2", "float"),
        ("2 ** ud.i", "any"),
        ("-ud.x", "float<m>"),
        ("ud.s + 'a'", "str"),
        ("ud.s * 2", "str"),
        ("ud.l + [1.5]", "list[float]"),
        ("ud.l * 2", "list[int]"),
        ("ud.l[0]", "int"),
        ("ud.d['a']", "float"),
        ("ud['i']", "int"),
        ("ud.p[0]", "Point"),
        ("ud.p[0][1]", "float<m>"),
        ("[[1.0, 2], 3][0][1]", "int"),
        ("{'a': 1, 'b': 'x'}['b']", "str"),
        ("not ud.u", "bool"),
        ("ud.i < 3 < ud.x", "bool"),
        ("ud.i in ud.l", "bool"),
        ("ud.b and ud.i > 1", "bool"),
        ("ud.maybe or 0.0", "float"),
        ("ud.maybe if ud.maybe else 1.0", "float"),
        ("'a' if ud.b else 'b'", "str"),
        ("'a' if ud.b else 1", "any"),
        ("len(ud.l)", "int"),
        ("max(ud.l)", "int"),
        ("max(ud.i, ud.x)", "float<m>"),
        ("min(ud.i, 2.5)", "float"),
        ("sum(ud.l)", "int"),
        ("sorted(ud.l)", "list[int]"),
        ("sorted({2: 1, 1: 2})", "list"),
        ("list({'a': 1})", "list[str]"),
        ("round(ud.x)", "int"),
        ("round(ud.x, 1)", "float<m>"),
        ("float(ud.s)", "float"),
        ("str(ud.i)", "str"),
        ("list(range(3))", "list[int]"),
        ("f(ud)", "any"),
        ("ud.u + 1", "any"),
        ("ud.missing", "any"),
        ("ud.b + 1", "int"),
        ("ud.mode", "one_of[open, close]"),
        ("ud.mode + '!'", "str"),
        ("[ud.i, ud.i]", "int[2]"),
        ("[]", "list"),
        ("lambda y: y", "any"),
    ],
)
def test_the_type_of_an_expression(text: str, type_: str) -> None:
    code = Expression(text=f"lambda ud: {text}", span=NOWHERE)
    assert widened(type_of_call(code, NAMES)) == a(type_)


def test_a_parameter_hides_a_function() -> None:
    expr = parse_expression("len(x)")
    assert expr is not None
    assert type_of(expr, {}) == a("int")
    assert type_of(expr, {"len": a("any")}) == a("any")


def test_what_is_outside_the_subset_is_any() -> None:
    code = Expression(text="lambda ud: [x for x in ud.l]", span=NOWHERE)
    assert type_of_call(code, NAMES) == a("any")


def lines(text: str) -> Machine:
    """A machine from its text, with `; ` for the ends of lines."""
    return with_state_types(parse_machine(text.replace("; ", "\n")))


def known(text: str) -> dict[str, str]:
    """The types of container keys, as `path.key`."""
    found = infer(lines(text)).keys
    return {f"{path}.{key}": str(type_) for (path, key), type_ in found.items()}


def test_types_go_through_remaps_into_containers_and_out() -> None:
    assert known(
        """
        machine sm: StateMachine {
          state WRITE: Any { output made: Pose; remap made -> part; }
          machine IN: StateMachine {
            input given
            output result
            remap given -> part
            remap result -> end
            state READ: Any { input here: Pose; remap here -> given; }
            state COUNT: Any { output n: int; remap n -> result; }
          }
        }"""
    ) == {"sm.part": "Pose", "sm/IN.given": "Pose", "sm/IN.result": "int", "sm.end": "int"}


def test_readers_give_a_type_where_writers_have_none() -> None:
    assert known(
        """
        machine sm: StateMachine {
          userdata empty = []
          userdata vector = [1, 2, 3]
          userdata unknown = `some.code()`
          state A: Any { input empty: list[Pose]; input vector: list[float<m>]; }
          state B: Any { input unknown: Point; }
        }"""
    ) == {"sm.empty": "list[Pose]", "sm.vector": "float<m>[3]", "sm.unknown": "Point"}


def test_code_is_typed_until_nothing_more_is_known() -> None:
    assert (
        known(
            """
        machine sm: StateMachine {
          userdata n = 0
          userdata xs = []
          state A: CallbacksState {
            input n input xs output n output xs
            variable callbacks = {n: `lambda ud: ud.n + 0.5`, xs: `lambda ud: [ud.xs]`}
          }
        }"""
        )["sm.n"]
        == "float"
    )


def test_an_iterator_hands_on_the_type_of_its_items() -> None:
    assert known(
        """
        machine sm: StateMachine {
          userdata points = [[0, 0, 0], [0, 1, 2]]
          iterator EACH: Iterator {
            input points
            items from points
            item point
            state GO: Any { input point: Point; }
          }
          iterator WORDS: Iterator { items ["a", "b"] item word }
        }"""
    ) == {
        "sm.points": "Point[2]",
        "sm/EACH.points": "Point[2]",
        "sm/EACH.point": "Point",
        "sm/WORDS.word": "str",
    }


def codes(text: str) -> list[str]:
    """The codes of the rules over types."""
    found = check_machine(lines(text))
    ours = ("SM304", "SM501", "SM502", "SM503", "SM504")
    return [item.code for item in found if item.code in ours]


CHAIN = """
machine sm: StateMachine {{
  outcomes done
  {held}
  initial A
  state A: Any {{ outcomes ok; {a}; on ok -> B }}
  state B: Any {{ outcomes ok; {b}; on ok -> C }}
  state C: Any {{ outcomes ok; {c}; on ok -> {end} }}
}}"""


def chain(held: str = "", a: str = "", b: str = "", c: str = "", end: str = "done") -> list[str]:
    text = CHAIN.format(held=held, a=a, b=b, c=c, end=end)
    return codes(text)


def test_a_placeholder_that_is_replaced_before_it_is_read_is_fine() -> None:
    assert chain("userdata x = null", "output x: float", c="input x: float") == []
    assert chain("userdata x = null", c="output x: float", b="input x: float") == ["SM304"]
    assert chain("userdata x = null", "output x: float; writes ok: x", c="input x: float") == []
    writes = "output x: float; writes never: x"
    assert chain("userdata x = null", writes, c="input x: float") == ["SM304"]


def test_a_key_may_be_used_for_two_things_one_after_the_other() -> None:
    ends = {"a": "output x: str; input y: str", "b": "input x: str; output x: int"}
    assert chain("", **ends, c="input x: int") == []
    assert chain("", **ends, c="input x: int", end="B") == ["SM304"]


def test_a_literal_that_fits_no_reader_is_one_finding() -> None:
    assert chain("userdata x = 5", "input x: str", "input x: str", "input x: Pose") == ["SM304"]


def test_a_reader_that_no_writer_fits_is_one_finding() -> None:
    writers = ("output x: str; writes never: x", "output y: bool; remap y -> x")
    assert chain("userdata x = null", *writers, "input x: int", "A") == ["SM304"]


def test_a_declared_key_is_asked_once() -> None:
    assert chain("userdata x: int = 1", "output x: str", c="input x: int") == ["SM304"]
    assert chain("userdata x: Pose = 1", c="input x: Pose") == ["SM304"]
    assert chain('userdata x: str = "a"', "input x: int; output x: int") == ["SM304"]


def test_lengths_are_told_through_declarations() -> None:
    held = "userdata x: list[float] = [1, 2]"
    assert chain(held, c="input x: float[3]") == ["SM501"]
    assert chain(held, c="input x: float[2]") == []


POOL = [a(text) for text in ("int", "float<m>", "str", "Pose", "list[str]", "bool", "Point")]
CLASHING = Type("dict", (Type("my_msgs/Thing"),))
"""A type that fits none of the pool."""


@st.composite
def well_typed(draw: st.DrawFn) -> tuple[Machine, int]:
    """A machine of which every reader fits every writer, and the number of its readers.

    Its states run in a circle; some stand in containers, with other names for their keys.
    """
    kinds = draw(st.lists(st.sampled_from(POOL), min_size=1, max_size=3))
    text = ["machine sm: StateMachine {", "outcomes end", "initial S0"]
    readers = 0
    count = draw(st.integers(len(kinds), 8))
    for number in range(count):
        key = number if number < len(kinds) else draw(st.integers(0, len(kinds) - 1))
        kind, after = kinds[key], f"S{(number + 1) % count}"
        reads = number >= len(kinds) and draw(st.booleans())
        readers += reads
        if reads:
            kind = draw(st.sampled_from([kind, Type("optional", (kind,))]))
        declared = f": {kind}"
        word = "input" if reads else "output"
        depth = draw(st.integers(0, 2))
        typed = draw(st.booleans())
        for level in range(depth):
            name = f"S{number}" if level == 0 else f"L{level}"
            to = f"k{key}" if level == 0 else f"c{level - 1}"
            inner = f"L{level + 1}" if level + 1 < depth else "LEAF"
            text += [f"machine {name}: StateMachine {{", "outcomes ok", f"initial {inner}"]
            text += [f"{word} c{level}{declared if typed else ''}", f"remap c{level} -> {to}"]
            text += [f"on ok -> {after if level == 0 else 'ok'}"]
        name = "LEAF" if depth else f"S{number}"
        text += [f"state {name}: Any {{", "outcomes ok", f"{word} own{declared}"]
        text += [f"remap own -> {f'c{depth - 1}' if depth else f'k{key}'}"]
        text += [f"on ok -> {'ok' if depth else after}", "}" * (depth + 1)]
    return parse_machine("\n".join([*text, "}"]), "main.smir"), readers


def type_findings(machine: Machine) -> list[object]:
    found = check_machine(machine)
    return [item for item in found if item.code in ("SM304", "SM501", "SM504")]


@given(well_typed())
@settings(max_examples=examples(60), deadline=None)
def test_a_well_typed_machine_has_no_finding(drawn: tuple[Machine, int]) -> None:
    assert type_findings(drawn[0]) == []


def changed(node: Node, path: Sequence[str], type_: Type) -> Node:
    """A machine in which the leaf at a path reads its key as another type."""
    if isinstance(node, Leaf):
        return replace(node, inputs=tuple(replace(key, type=type_) for key in node.inputs))
    children = tuple(
        changed(child, path[1:], type_) if child.name == path[0] else child
        for child in node.children
    )
    return replace(node, children=children)


def reading_leaves(machine: Machine) -> list[str]:
    return [path for path, node in walk(machine.root) if isinstance(node, Leaf) and node.inputs]


@given(well_typed(), st.data())
@settings(max_examples=examples(60), deadline=None)
def test_one_type_changed_is_found_where_it_stands(
    drawn: tuple[Machine, int], data: st.DataObject
) -> None:
    machine, readers = drawn
    leaves = reading_leaves(machine)
    assert len(leaves) == readers
    if not leaves:
        return
    path = data.draw(st.sampled_from(leaves))
    root = changed(machine.root, path.split("/")[1:], CLASHING)
    assert isinstance(root, StateMachine)
    found = check_machine(replace(machine, root=root))
    clashes = [item for item in found if item.code == "SM304"]
    assert len(clashes) == 1
    (leaf,) = [node for where, node in walk(root) if where == path]
    (key,) = leaf.inputs
    finding = clashes[0].finding
    assert key.span.line in {finding.span.line, *(place.span.line for place in finding.related)}


def shuffled(node: Node, order: Mapping[str, int]) -> Node:
    """The same machine with its states, keys and presets in another order."""

    def by(item: object) -> int:
        return order.get(str(item)[-1:], 0) + len(str(item))

    sorted_ = {part: tuple(sorted(getattr(node, part), key=by)) for part in ("inputs", "outputs")}
    node = replace(node, **sorted_)  # type: ignore[arg-type]
    if isinstance(node, Leaf):
        return node
    children = sorted((shuffled(child, order) for child in node.children), key=by)
    return replace(node, children=tuple(children), userdata=node.userdata[::-1])


@given(well_typed(), st.dictionaries(st.sampled_from(")'05"), st.integers(-999, 999)))
@settings(max_examples=examples(40), deadline=None)
def test_the_order_of_the_script_does_not_count(
    drawn: tuple[Machine, int], order: dict[str, int]
) -> None:
    machine, _ = drawn
    root = shuffled(machine.root, order)
    assert isinstance(root, StateMachine)
    one, other = infer(machine), infer(replace(machine, root=root))
    assert dict(one.keys) == dict(other.keys)
    assert dict(one.inputs) == dict(other.inputs)


@given(machines())
@settings(max_examples=examples(60), deadline=None)
def test_every_machine_is_typed_and_its_text_with_types_reads_as_the_same(
    machine: Machine,
) -> None:
    types = infer(machine)
    assert parse_machine(print_machine(machine, types)) == machine
    for type_ in (*types.keys.values(), *types.inputs.values(), *types.outputs.values()):
        assert parse_type(str(type_)) == type_


@given(valid_machines())
@settings(max_examples=examples(60), deadline=None)
def test_a_valid_machine_has_no_clash(machine: Machine) -> None:
    assert infer(machine).clashes == ()


def data_of(value: object) -> Data:
    """What the interpreter computed, as data of a script."""
    if isinstance(value, list | tuple | range):
        return tuple(data_of(item) for item in value)
    if isinstance(value, dict):
        return Struct(entries=tuple((str(key), data_of(item)) for key, item in value.items()))
    assert value is None or isinstance(value, bool | int | float | str)
    return value


@given(computations(), st.fixed_dictionaries(dict.fromkeys(NAMES_OF_VALUES, VALUES)))
@settings(max_examples=500, deadline=None)
@pytest.mark.slow
def test_what_an_expression_gives_is_of_its_type(expr: Expr, values: dict[str, object]) -> None:
    try:
        value = evaluate(expr, values)
    except EvaluationError:
        return
    if callable(value) or isinstance(value, complex):
        return
    names = {name: widened(type_of_data(data_of(each))) for name, each in values.items()}
    exact = {name: type_of_data(data_of(each)) for name, each in values.items()}
    found = type_of_data(data_of(value))
    for known in (names, exact):
        assert misfit(found, limited(type_of(expr, known))) is None


@given(valid_machines())
@settings(max_examples=examples(60), deadline=None)
def test_what_a_run_writes_is_of_the_type_of_its_key(machine: Machine) -> None:
    types = infer(machine)
    seen: list[Event] = []
    run(machine, builtin_behaviour(), seen.append)
    for event in seen:
        if event["event"] == "write":
            key = event["path"], event["key"]
            assert fits(type_of_data(data_of(event["value"])), types.outputs[key])

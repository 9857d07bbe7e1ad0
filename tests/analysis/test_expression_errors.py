"""What is said of code by its types, against what becomes of it for values of these types."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from smachac.analysis.expression_errors import Fault, expression_faults, kinds
from smachac.analysis.expression_types import type_of
from smachac.analysis.type_lattice import mapping
from smachac.interpreter.evaluator import EvaluationError, evaluate
from smachac.ir.expressions import (
    Attribute,
    Binary,
    Call,
    Compare,
    Constant,
    DictDisplay,
    Expr,
    Index,
    Lambda,
    Name,
    Unary,
    parse_expression,
    parts,
)
from smachac.ir.types import Type, parse_type
from tests.strategies.expressions import COMPUTING_FORMS, trees
from tests.support.examples import examples

INT = st.integers(-3, 9)
FLOAT = st.sampled_from([0.0, 0.5, -2.5, 3.0]) | INT
STR = st.text(alphabet="ab1", max_size=3)
LIST = st.lists(INT, max_size=3)
VALUES: dict[str, st.SearchStrategy[object]] = {
    "bool": st.booleans(),
    "int": INT,
    "float": FLOAT,
    "float<rad>": FLOAT,
    "float<deg>": FLOAT,
    "str": STR,
    "one_of[a, b]": st.sampled_from(["a", "b"]),
    "one_of[1, 2]": st.sampled_from([1, 2]),
    "list[int]": LIST,
    "list": st.lists(INT | STR, max_size=2),
    "float[3]": st.lists(FLOAT, min_size=3, max_size=3),
    "dict[str, int]": st.dictionaries(STR, INT, max_size=2),
    "none": st.none(),
    "int?": INT | st.none(),
    "any": INT | STR | LIST | st.none(),
}
KEYS = ("x", "y", "z")
Typed = tuple[dict[str, Type], dict[str, object]]


@st.composite
def typed_keys(draw: st.DrawFn) -> Typed:
    words = {key: draw(st.sampled_from(list(VALUES))) for key in KEYS}
    values = {key: draw(VALUES[word]) for key, word in words.items()}
    return {key: parse_type(word) or Type("any") for key, word in words.items()}, values


READS = st.builds(Attribute, st.just(Name("ud")), st.sampled_from(KEYS))
CONSTANTS = st.builds(Constant, st.integers(0, 4) | st.sampled_from(["a", "1", 0.5, None, True]))
FORMS = (
    *COMPUTING_FORMS,
    lambda draw, part: Attribute(part(), draw(st.sampled_from(["real", "x", "position"]))),
    lambda draw, part: Call(part(), (part(),)),
)


def faults(expr: Expr, types: dict[str, Type]) -> tuple[Fault, ...]:
    return expression_faults(expr, mapping(types.items()), ("ud",))


def outcome(expr: Expr, values: dict[str, object]) -> object:
    """The value of an expression, or the error that it ends with."""
    try:
        return evaluate(expr, {"ud": SimpleNamespace(**values)})
    except EvaluationError as error:
        return error


@given(trees(READS | CONSTANTS, FORMS, 3), typed_keys())
@settings(max_examples=examples(200))
def test_what_is_reported_comes_about_whatever_the_values_are(expr: Expr, typed: Typed) -> None:
    types, values = typed
    for fault in faults(expr, types):
        event(fault.kind)
        result = outcome(fault.expr, values)
        match fault.kind:
            case "operation":
                assert isinstance(result, EvaluationError), fault
                assert not fault.always or isinstance(outcome(expr, values), EvaluationError)
            case "comparison":
                told = "always true" in fault.what
                assert result is told or isinstance(result, EvaluationError), fault
            case "unit":
                assert {types[key].args for key in fault.keys} >= {("rad",), ("deg",)}


def inner(expr: Expr) -> Iterator[Expr]:
    """An expression and all in it but what stands in lambdas."""
    yield expr
    for part in parts(expr) if not isinstance(expr, Lambda) else ():
        yield from inner(part)


def is_undecided(expr: Expr, types: dict[str, Type], values: dict[str, object]) -> bool:
    """Whether the types do not tell that an operation fails, as its result hangs on more."""
    operands: list[Expr] = [part for part in parts(expr) if not isinstance(part, Lambda)]
    if isinstance(expr, Call):
        operands = [*expr.arguments]
    found = [kinds(type_of(part, {"ud": mapping(types.items())})) for part in operands]
    results = [outcome(part, values) for part in operands]
    if any(len(kind) != 1 for kind in found):
        return True  # unknown, or one of several
    match expr:
        case Binary("*", _, _) if any(isinstance(result, float) for result in results):
            return True  # a text times 2.0 fails, times 2 it does not
        case Binary() | Compare() if found[0] == found[1] == {"list"}:
            return True  # tuples and lists are one; the items may not go together
        case Compare(_, (("in" | "not in", _),)):
            return found == [{"list"}, {"mapping"}]
        case Index():
            return isinstance(results[1], float) or found[0] == {"mapping"}
        case Call(Name(name), arguments):
            # Some functions look into lists, and some do not take fractions.
            return name in ("dict", "sorted", "sum", "max", "min", "range") or len(arguments) > 1
        case DictDisplay():
            return True  # keys that are lists
        case Unary() | Attribute() | Call() | Binary():
            return False
        case Compare(_, rest):
            return len(rest) > 1
    return True


@given(trees(READS | CONSTANTS, FORMS, 2), typed_keys())
@settings(max_examples=examples(200))
def test_what_fails_by_its_types_is_reported(expr: Expr, typed: Typed) -> None:
    types, values = typed
    for item in inner(expr):
        result = outcome(item, values)
        if not isinstance(result, EvaluationError):
            continue
        if not isinstance(result.__cause__, TypeError | AttributeError):
            continue
        if any(isinstance(outcome(part, values), EvaluationError) for part in parts(item)
               if part != getattr(item, "function", None)):  # fmt: skip
            continue
        if not is_undecided(item, types, values):
            event("fails by its types")
            assert [fault for fault in faults(item, types) if fault.expr == item]


TYPES = {
    "n": "int",
    "s": "str",
    "f": "float[3]",
    "d": "dict[str, int]",
    "p": "Pose",
    "m": "one_of[open, closed]",
    "o": "int?",
    "a": "any",
    "rad": "float<rad>",
    "deg": "float<deg>",
    "none": "none",
}


def told(text: str) -> list[str]:
    tree = parse_expression(text)
    assert tree is not None
    types = {key: parse_type(word) or Type("any") for key, word in TYPES.items()}
    return [f"{fault.what}{'' if fault.always else ' (perhaps)'}" for fault in faults(tree, types)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ud.s + 1", ["`ud.s + 1` adds `str` and `int`"]),
        ("ud['s'] - ud.n", ["`ud['s'] - ud.n` subtracts `int` from `str`"]),
        ("-ud.s", ["`-ud.s` uses `str` as a number"]),
        ("ud.s < ud.n", ["`ud.s < ud.n` compares `str` with `int`"]),
        ("ud.n in ud.s", ["`ud.n in ud.s` looks for `int` in `str`"]),
        ("ud.f[3]", ["`ud.f[3]` is out of range: `float[3]` has 3 items"]),
        ("ud.p.position[3]", ["`ud.p.position[3]` is out of range: `Point` has 3 items"]),
        ("ud.f['a']", ["`ud.f['a']` uses `str` as an index of `float[3]`"]),
        ("ud.n[0]", ["`ud.n[0]` reads an item of `int`, which has no items"]),
        ("ud.d[0]", ["`ud.d[0]` uses `int` as an index of `dict[str, int]`"]),
        ("ud.d.x", ["`ud.d.x` reads an attribute that `dict[str, int]` does not have"]),
        ("ud.p.x", ["`ud.p.x` reads an attribute that `Pose` does not have"]),
        ("ud.s(1)", ["`ud.s(1)` calls a value of the type `str`, which is no function"]),
        ("len(ud.n)", ["`len(ud.n)` passes `int` to `len`, which does not accept it"]),
        ("abs(1, 2)", ["`abs(1, 2)` passes 2 arguments to `abs`, which accepts 1"]),
        ("len()", ["`len()` passes 0 arguments to `len`, which accepts 1"]),
        ("round(1.5, places=2)", ["`round(1.5, places=2)` passes the argument `places`"
                                  " to `round`, which does not accept it"]),
        ("ud.s == ud.n", ["`ud.s == ud.n` is always false: `str` never equals `int`"]),
        ("ud.m != 'opne'", ["`ud.m != 'opne'` is always true:"
                            " `one_of[open, closed]` has no value `opne`"]),
        ("ud.n not in ['a', 'b']", ["`ud.n not in ['a', 'b']` is always true:"
                                    " `int` never equals `str`"]),
        ("ud.rad - ud.deg", ["`ud.rad - ud.deg` combines `float<rad>` and `float<deg>`"]),
        ("max(1.0, ud.rad, ud.deg)",
         ["`max(1.0, ud.rad, ud.deg)` combines `float<rad>` and `float<deg>`"]),
        ("min(ud.rad, 2.0, ud.rad)", []),
        ("ud.rad < ud.deg", ["`ud.rad < ud.deg` combines `float<rad>` and `float<deg>`"]),
        # Evaluated in some runs only.
        ("ud.s + 1 if ud.n else 0", ["`ud.s + 1` adds `str` and `int` (perhaps)"]),
        ("ud.n and ud.s + 1", ["`ud.s + 1` adds `str` and `int` (perhaps)"]),
        ("ud.n < 2 < ud.s", ["`2 < ud.s` compares `int` with `str` (perhaps)"]),
        # The condition asks for the key.
        ("ud.none + 1", ["`ud.none + 1` adds `none` and `int`"]),
        ("ud.none + 1 if ud.none else 0", []),
        ("ud.f[3] if len(ud.f) > 3 else 0", []),
        ("ud.none == None or ud.none < 3", []),
        # Nothing is known, or all is well.
        ("ud.a + 1 + ud.o", []),
        ("ud.a.x[0](1)", []),
        ("ud.s.upper() + 'a'", []),
        ("ud.s % ud.n", []),
        ("ud.s * ud.n + 'a'", []),
        ("ud.f[-3] + ud.f[ud.n]", []),
        ("ud.p.position.x + ud.n", []),
        ("ud.p * 2", []),
        ("ud.none == 'a'", []),
        ("ud.m == 'open' or ud.m in ['closed', 'shut']", []),
        ("ud.rad * ud.deg", []),
        ("sorted(ud.f, key=lambda x: x + 'a', reverse=True)", []),
        ("my_function(ud.s, 1)", []),
        ("max(ud.n, 1, key=abs)", []),
        ("round(number=1.5)", []),
        ("(1, 'a')[1] + 'b'", []),
    ],
)  # fmt: skip
def test_what_is_said(text: str, expected: list[str]) -> None:
    assert told(text) == expected

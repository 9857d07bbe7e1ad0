from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from types import SimpleNamespace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from smachac.interpreter.evaluator import FUNCTIONS, EvaluationError, evaluate
from smachac.ir.expressions import Expr, parse_expression, print_expression
from tests.strategies.expressions import FUNCTION_NAMES, NAMES_OF_VALUES, VALUES, computations
from tests.support.examples import examples

PYTHON = {name: getattr(__import__("builtins"), name) for name in FUNCTIONS}


def value_of(text: str, **names: object) -> object:
    tree = parse_expression(text)
    assert tree is not None, text
    return evaluate(tree, names)


def function_of(text: str, **names: object) -> Callable[..., object]:
    function = value_of(text, **names)
    assert callable(function)
    return function


@given(computations(), st.tuples(VALUES, VALUES, VALUES))
@settings(max_examples=examples(200))
def test_the_value_is_the_one_python_gives(tree: Expr, values: tuple[object, ...]) -> None:
    names = dict(zip(NAMES_OF_VALUES, values, strict=True))
    try:
        ours: object = evaluate(tree, names)
    except EvaluationError as error:
        assume(error.__cause__ is not None)
        ours = type(error.__cause__)
    assert repr(ours) == repr(pythons_value(print_expression(tree), names))


def pythons_value(text: str, names: dict[str, object]) -> object:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SyntaxWarning)
        try:
            return eval(text, {"__builtins__": PYTHON, **names})
        except Exception as error:
            return type(error)


def test_userdata_is_read_by_attribute_and_by_item() -> None:
    ud = SimpleNamespace(n=2, pose={"x": [1.5, 2.5]})
    assert value_of("ud.n + ud.pose['x'][1]", ud=ud) == 4.5


def test_a_lambda_is_a_function() -> None:
    double = function_of("lambda ud: ud.n * k", k=2)
    assert [double(SimpleNamespace(n=n)) for n in (1, 4)] == [2, 8]
    assert function_of("lambda: 7")() == 7
    with pytest.raises(EvaluationError, match="1 arguments got 0"):
        double()


def test_lambdas_close_over_parameters() -> None:
    add = function_of("lambda x: lambda y: x - y")(5)
    assert callable(add)
    assert add(3) == 2


@pytest.mark.slow
def test_a_lambda_works_for_ever() -> None:
    count = function_of("lambda x: len(range(100000)) + len(list(range(90000)))")
    assert {count(0) for _ in range(50)} == {190_000}


def test_given_functions_and_dotted_names() -> None:
    tree = parse_expression("math.cos(math.pi) + twice(2)")
    assert tree is not None
    names = {"math.cos": math.cos, "math.pi": math.pi, "twice": lambda x: 2 * x}
    assert evaluate(tree, names) == 3.0


def test_only_what_decides_is_evaluated() -> None:
    assert value_of("1 if True else 1 / 0") == 1
    assert value_of("0 and 1 / 0") == 0
    assert value_of("'' or 'b' or 1 / 0") == "b"
    assert value_of("1 < 0 < 1 / 0") is False


@pytest.mark.parametrize(
    ("text", "message", "cause"),
    [
        ("1 + 1 / (2 - 2)", "`1 / (2 - 2)` has no value: ZeroDivisionError", ZeroDivisionError),
        ("1 + 'a'", "TypeError: unsupported operand", TypeError),
        ("[1][3]", "IndexError", IndexError),
        ("{}['k']", "KeyError: 'k'", KeyError),
        ("ud.missing", "AttributeError", AttributeError),
        ("2.0 ** 5000", "OverflowError", OverflowError),
    ],
)
def test_errors_of_python_are_told_with_their_place(
    text: str, message: str, cause: type[Exception]
) -> None:
    with pytest.raises(EvaluationError) as caught:
        value_of(text, ud=SimpleNamespace())
    assert message in str(caught.value)
    assert isinstance(caught.value.__cause__, cause)


@pytest.mark.parametrize(
    "text",
    [
        "ud.__class__",
        "ud._secret",
        "__import__('os')",
        "_hidden",
        "open('x')",
        "eval('1')",
        "ud.method(1)",
        "'{0.__class__}'.format(ud)",
        "sorted([1], key='{}'.format)",
        "sorted([1], key=ud.method)",
        "(lambda f: f(f))(lambda f: f(f))",
        "(lambda: 1)()",
        "[len][0]('a')",
        "ud.module.path",
        "ud.function.anything",
        "ud.type.mro",
        "ud['__class__']",
        "missing",
    ],
)
def test_what_leads_out_of_the_data_is_refused(text: str) -> None:
    class Userdata(dict[str, object]):
        module, function, type = math, staticmethod(math.cos), int
        _secret = 1

        def method(self, value: object) -> object:
            return value

    with pytest.raises(EvaluationError):
        value_of(text, ud=Userdata(), _hidden=1)


def test_a_parameter_hides_the_function_of_its_name() -> None:
    with pytest.raises(EvaluationError, match="no function known here"):
        function_of("lambda len: len([1])")(len)


@pytest.mark.parametrize(
    "text",
    [
        "9 ** 9 ** 9",
        "2 ** 10001",
        "'a' * 100001",
        "1000000 * [0]",
        "[[0] * 1000] * 1000",
        "('ab' * 50000) + 'c'",
        "range(10 ** 12)",
        "round(5, -10 ** 9)",
        "sorted(range(9999), key=lambda x: sum(range(9999)))",
        "sum([[[0] * 50000], [[0] * 50000], [[0]]], [])",
        "'%99999999d' % 1",
        "sorted(range(99999), key=lambda x: [x] * 1000)",
        "max(range(99999), key=lambda x: [x, x, [x] * 900])",
        "2 ** 9999 * 2 ** 9999",
    ],
)
def test_work_and_size_are_limited(text: str) -> None:
    with pytest.raises(EvaluationError, match=r"more than|numbers"):
        value_of(text)


def test_values_that_grow_from_visit_to_visit_are_limited() -> None:
    for text in ("[ud, ud]", "(ud, ud)", "{1: ud, 2: ud}"):
        tree = parse_expression(text)
        assert tree is not None
        value: object = 1
        for _ in range(15):
            value = evaluate(tree, {"ud": value})
        with pytest.raises(EvaluationError, match="more than"):
            evaluate(tree, {"ud": value})


def test_comparisons_and_look_ups_of_shared_values_are_limited() -> None:
    shared: object = 1
    other: object = 1
    for _ in range(40):
        shared, other = (shared, shared), (other, other)
    for text in ("a == b", "a in [1, b]", "d[a]", "sorted([a, b])", "str(a)"):
        tree = parse_expression(text)
        assert tree is not None
        with pytest.raises(EvaluationError, match="more than"):
            evaluate(tree, {"a": shared, "b": other, "d": {}})


def test_limits_leave_room() -> None:
    assert value_of("2 ** 5000 > 0 and len('a' * 100000) == 100000")
    assert value_of("sum(sorted(range(1000), key=lambda x: -x))") == 499_500
    assert value_of("round(2.567, 1) + round(2.5)") == 4.6


def test_the_functions_are_those_of_the_language() -> None:
    assert sorted(FUNCTIONS) == sorted(FUNCTION_NAMES)


@pytest.mark.parametrize("base", ["0", "1", "-1"])
@pytest.mark.parametrize("exponent", ["10001", "10 ** 9", "10 ** 9 + 1"])
def test_powers_that_stay_small_have_no_limit(base: str, exponent: str) -> None:
    text = f"({base}) ** ({exponent})"
    assert value_of(text) == eval(text)

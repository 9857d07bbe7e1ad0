"""Expressions and types in C++: what is printed, what is refused, and that values are Python's."""

from __future__ import annotations

import contextlib
import json
import math
import random
import shutil
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given

from smachac.diagnostics.source import NOWHERE
from smachac.ir.expressions import Expr, parse_expression
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.types import Type, parse_type
from smachac.targets.cpp.expressions import (
    PORTABLE,
    Spelling,
    cpp_condition,
    cpp_expression,
    cpp_function,
)
from smachac.targets.cpp.types import UnportableError, cpp_float, cpp_string, cpp_type, cpp_value
from smachac.verify.players.cpp import HEADERS
from tests.cpp.compilers import BARE, CLANG_FORMAT, COMPILERS, SANITIZED, Compiler
from tests.cpp.expression_programs import NAMES, Tally, cases, compare, portable, program
from tests.strategies.expressions import NAMES_OF_VALUES, computations, expressions
from tests.strategies.typed_expressions import userdata

KEYS = {name.removeprefix("ud."): spelling for name, spelling in NAMES.items()}
KEYS["thing"] = Spelling(text="in.thing", type=Type("any"))


def type_of(text: str) -> Type:
    found = parse_type(text)
    assert found is not None
    return found


def printed(code: str, wanted: str = "") -> str:
    body, names = cpp_function(code, KEYS)
    text = cpp_expression(body, names, type_of(wanted) if wanted else None).text
    return text.replace("smachac::py::", "py::")


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where programs are built, once for a run of the tests."""
    return tmp_path_factory.mktemp("cpp")


# What is printed


@pytest.mark.parametrize(
    ("code", "text"),
    [
        ("ud.n + 1", "py::add(in.n, 1)"),
        ("lambda u: u.n + u['m']", "py::add(in.n, in.m)"),
        ("lambda: 7", "7"),
        ("ud.x * (1 - ud.y)", "in.x * (1.0 - in.y)"),
        ("ud.x - (1 - ud.y)", "in.x - (1.0 - in.y)"),
        ("-ud.x / ud.n", "py::divide(-in.x, py::real(in.n))"),
        ("-9223372036854775808", "(-9223372036854775807 - 1)"),
        ("0 < ud.x <= 1", "0.0 < in.x && in.x <= 1.0"),
        (
            "0 <= len(ud.s) < 3",
            "py::with(py::length(in.s), "
            "[&](const auto &value_1) { return 0 <= value_1 && value_1 < 3; })",
        ),
        ("ud.x == ud.x", "py::equal(in.x, in.x)"),
        ("ud.maybe != None", "in.maybe != std::nullopt"),
        ("ud.mode == 'open'", 'in.mode == "open"'),
        ("ud.mode in ['open', 'closed']", "py::contains(std::array<std::string, 2>"
         '{{std::string("open"), std::string("closed")}}, in.mode)'),
        ("ud.note or 'none'", 'py::truth(in.note) ? py::present(in.note) : std::string("none")'),
        ("ud.flag and not ud.n or ud.flag", "(in.flag && !(in.n != 0)) || in.flag"),
        ("ud.pose[0][2] + ud.point[0]", "in.pose.position.z + in.point.x"),
        ("ud.n if ud.flag else 0", "in.flag ? in.n : 0"),
        ("max(ud.whole, key=lambda v: -v)",
         "py::max_of(in.whole, [&](const auto &item_1) { return py::negate(item_1); })"),
        ("'at ' + str(ud.x) + 'm'", '"at " + py::text(in.x) + "m"'),
        ("ud.s + ' == ' != ud.mode", 'in.s + " == " != in.mode'),
        ("(ud.note if ud.n == 1 else None) != None",
         "(in.n == 1 ? in.note : std::optional<std::string>{}) != std::nullopt"),
        ("max(ud.whole, key=lambda v: ud.n)",
         "py::max_of(in.whole, [&]([[maybe_unused]] const auto &item_1) { return in.n; })"),
        ("max([ud.pose], key=lambda v: len(v))",
         "py::max_of(std::array<smachac::Pose, 1>{{in.pose}}, "
         "[&]([[maybe_unused]] const auto &item_1) { return 2; })"),
    ],
)  # fmt: skip
def test_expressions_are_printed(code: str, text: str) -> None:
    assert printed(code) == text


@pytest.mark.parametrize(
    ("code", "wanted", "text"),
    [
        ("1", "float", "1.0"),
        ("ud.n", "float<m>", "py::widen(in.n)"),
        ("[ud.x, 0, 1]", "Point", "smachac::Point{in.x, 0.0, 1.0}"),
        ("[ud.x, 0, 1]", "float[3]", "std::array<double, 3>{{in.x, 0.0, 1.0}}"),
        ("[[0, 0, 1], [0, 0, 0, 1]]", "Pose", "smachac::Pose{smachac::Point{0.0, 0.0, 1.0}, "
         "smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}"),
        ("[]", "list[str]", "std::vector<std::string>{}"),
        ("{'frame_id': 'base'}", "PoseStamped",
         'smachac::PoseStamped{std::string("base"), double{}, smachac::Pose{}}'),
        ("ud.n if ud.flag else None", "int?",
         "in.flag ? std::optional<std::int64_t>(in.n) : std::optional<std::int64_t>{}"),
        ("ud.maybe", "int", "py::present(in.maybe)"),
        ("ud.whole", "float[2]", "smachac::convert<std::array<double, 2>>(in.whole)"),
    ],
)  # fmt: skip
def test_expressions_are_printed_as_the_wanted_type(code: str, wanted: str, text: str) -> None:
    assert printed(code, wanted) == text


@pytest.mark.parametrize(
    ("code", "wanted", "reason"),
    [
        ("ud.thing + 1", "", "`ud.thing`: the type is unknown"),
        ("ud.other", "", "`ud.other`: this name is not defined here"),
        ("ud.point.x", "", "the value is a list in Python, which has no field `x`"),
        ("ud.pose[0].z", "", "the value is a list in Python, which has no field `z`"),
        ("math.sin(ud.x)", "", "`math.sin(ud.x)`: unknown function"),
        ("ud.n ** ud.m", "", "`ud.n ** ud.m`: the type depends on the sign of the exponent"),
        ("[1, 'a'][ud.n]", "", "one of two types, `int` or `str`"),
        ("ud.flag and ud.n", "", "one of two types, `bool` or `int`"),
        ("str(max(0, ud.x))", "", "Python prints integers and floats differently"),
        ("str(ud.words)", "", "C++ cannot print `list[str]` as Python does"),
        ("list(ud.table)", "", "a mapping has no order in C++: write `sorted(...)`"),
        ("ud.s + 1", "", "`ud.s + 1`: `+` is not defined for `str` and `int`"),
        ("ud.s < 1", "", "`<` is not defined for `str` and `int`"),
        ("ud.whole == (1, 2)", "", "a list is never equal to a tuple"),
        ("round(ud.x, ud.n)", "", "the number of digits must be a constant from 0 to 1000"),
        ("round(ud.x, -1)", "", "the number of digits must be a constant from 0 to 1000"),
        ("{1: 2}", "", "the keys of a mapping must be `str`, not `int`"),
        ("lambda u: lambda v: v", "", "a function is not a value in C++"),
        ("ud.n + 9223372036854775808", "", "does not fit into an integer of 64 bits"),
        ("ud.s == '\\ud800'", "", "contains a surrogate"),
        ("ud.s.upper()", "", "unknown function"),
        ("[x for x in ud.whole]", "", "is Python code, not a portable expression"),
        ("ud.x", "int", "`ud.x`: the type is `float`, but `int` is required"),
        ("[1, 2]", "float[3]", "the list has 2 items instead of 3"),
        ("max(ud.whole, default=0)", "", "the argument `default` is not supported"),
    ],
)
def test_expressions_are_refused_with_a_reason(code: str, wanted: str, reason: str) -> None:
    with pytest.raises(UnportableError) as found:
        printed(code, wanted)
    assert reason in str(found.value)


@pytest.mark.parametrize(
    ("code", "help"),
    [
        ("ud.s is not None", "compare with `!= None`: `ud.s != None`"),
        ("lambda ud: ud.n if ud.s is None else 0", "compare with `== None`: "),
        ("ud.s is 5", PORTABLE),
        ("[x for x in ud.whole if x is None]", PORTABLE),
    ],
)
def test_a_comparison_with_none_has_a_portable_form(code: str, help: str) -> None:
    with pytest.raises(UnportableError) as found:
        cpp_function(code, KEYS)
    assert (found.value.help or "").startswith(help)


def test_conditions_are_truth() -> None:
    def text(code: str) -> str:
        return cpp_condition(*cpp_function(code, KEYS)).text.replace("smachac::py::", "py::")

    assert text("ud.n and ud.flag") == "in.n != 0 && in.flag"
    assert text("ud.words") == "py::truth(in.words)"
    assert text("ud.x > 1 or not ud.s") == "in.x > 1.0 || !py::truth(in.s)"


@given(computations())
def test_every_computation_is_printed_or_refused(tree: Expr) -> None:
    kinds = zip(NAMES_OF_VALUES, ("int", "float[3]", "str?"), strict=True)
    names = {name: Spelling(text=f"in.{name}", type=type_of(kind)) for name, kind in kinds}
    is_printed_or_refused(tree, names)


@given(expressions())
def test_every_expression_is_printed_or_refused(tree: Expr) -> None:
    is_printed_or_refused(tree, NAMES)


def is_printed_or_refused(tree: Expr, names: dict[str, Spelling]) -> None:
    for print_ in (cpp_expression, cpp_condition):
        try:
            refused = print_(tree, names) is None
        except UnportableError as error:
            refused = not error.names
        assert not refused


# Types and constants


@pytest.mark.parametrize(
    ("type_", "text"),
    [
        ("float<rad>[7]", "std::array<double, 7>"),
        ("list[Pose]?", "std::optional<std::vector<smachac::Pose>>"),
        ("dict[str, int]", "std::map<std::string, std::int64_t>"),
        ("one_of[open, close]", "std::string"),
        ("one_of[1, 2]", "std::int64_t"),
        ("any", "std::any"),
        ("any?", "std::any"),
        ("list", "std::vector<std::any>"),
        ("none", "smachac::None"),
        ("Gripper", "std::any"),
    ],
)
def test_types_have_a_type_in_cpp(type_: str, text: str) -> None:
    assert cpp_type(type_of(type_)) == text


def test_types_of_others_have_none() -> None:
    with pytest.raises(UnportableError, match="the members of the type `geometry_msgs/Pose`"):
        cpp_type(type_of("list[geometry_msgs/Pose]"))


def test_records_without_a_name_have_none() -> None:
    with pytest.raises(UnportableError, match=r"C\+\+ needs a name for the record `{a: int}`"):
        cpp_type(type_of("list[{a: int}]"))


@pytest.mark.parametrize(
    ("data", "type_", "text"),
    [
        ((1, 2.5), "list[float]", "std::vector<double>{1.0, 2.5}"),
        ((0, 0, 1), "Pose", "smachac::Pose{smachac::Point{0.0, 0.0, 1.0}, smachac::Quaternion{}}"),
        (None, "str?", "std::optional<std::string>{}"),
        (float("inf"), "float", "std::numeric_limits<double>::infinity()"),
        (("a", None), "any", 'std::any{std::vector<std::any>{std::any{std::string("a")}, '
         "std::any{}}}"),
        (Expression(text="[1] * 2", span=NOWHERE), "int[2]", "std::array<std::int64_t, 2>{{1, 1}}"),
        (Struct(entries=(("a", 1),)), "dict[str, int]",
         'std::map<std::string, std::int64_t>{{std::string("a"), 1}}'),
    ],
)  # fmt: skip
def test_constants_are_printed(data: Data, type_: str, text: str) -> None:
    assert cpp_value(data, type_of(type_)) == text


@pytest.mark.parametrize(
    ("data", "type_", "reason"),
    [
        (2**63, "int", "does not fit into an integer of 64 bits"),
        (2**53 + 1, "float", "9007199254740993 has no exact value as a float"),
        (True, "int", "`True` is not of the type `int`"),
        ((1, 2), "float[3]", "has 2 items, but `float[3]` has 3"),
        ((1, 2), "Point", "has 3 parts"),
        (Struct(entries=(("joint", 1),)), "JointState", "has no field `joint`"),
        (Expression(text="rospy.Time()", span=NOWHERE), "float", "is not a constant"),
    ],
)
def test_constants_are_refused(data: Data, type_: str, reason: str) -> None:
    with pytest.raises(UnportableError) as found:
        cpp_value(data, type_of(type_))
    assert reason in str(found.value)


# What compiles, and gives the values of Python


SEEDS_AND_CASES = [
    (1, 50),
    *(pytest.param(n, 130, marks=pytest.mark.nightly) for n in (1, 2, 3, 4)),
]


@COMPILERS
@pytest.mark.parametrize(("seed", "count"), SEEDS_AND_CASES)
@pytest.mark.slow
def test_random_expressions_have_the_value_of_python(
    compiler: Compiler, seed: int, count: int, folder: Path
) -> None:
    tally = Tally()
    seed += 10 * len(compiler.name)
    flags = SANITIZED if compiler.runs_with(*SANITIZED) else ()
    assert compare(compiler, folder, list(cases(count, seed)), seed, tally, "-O0", *flags) == []
    # Most have a value, some have none, few are beyond 64 bits.
    assert tally.equal > 2.7 * count
    assert tally.errors > 0.19 * count
    assert tally.limits + tally.nan < 0.58 * count


EDGES = [
    *("[] < ud.rows", "ud.rows < [[]]", "[] in ud.rows", "[[]] + ud.rows", "sorted([[], [1]])"),
    *("max([], [1])", "ud.gaps == []", "ud.rows == [[]] or ud.words == []", "[] == []", "[] < []"),
    *("({} or ud.table) == {}", "(ud.words or []) == []", "'a' in ()", "len([] * 3)", "[] or [[]]"),
    *(
        "1 or 2",
        "ud.n and (1 or 2)",
        "(None or ud.maybe) == 3",
        "ud.maybe or ud.n",
        "None in ud.gaps",
    ),
    *("[None, 1][ud.n] == None", "ud.maybe < ud.n", "(1 if ud.flag else 2) ** 3", "0 / -1", "-0.0"),
    *("ud.point == ud.three", "ud.pose[0] == [1, 2, 3]", "ud.x < 9223372036854775807", "0.1 + 0.2"),
    *("ud.flags[0] + True", "'\\0' + ud.s + '\\0'", "ud.s == '\\0'", "'??=' + 'ü'[0]", "ud.s[-1]"),
    *("5 // -2", "-5 % 3", "2 ** -1", "0.0 ** -1", "(-8) ** 2", "round(0.5)", "round(2.675, 2)"),
    *("str([1, 2.5])", "str([None, True])", "sum([])", "sum([0.1] * 3)", "range(5, 0, -2)[1]"),
    "None in ud.gaps",
    *("max([1], key=lambda v: ud.words[9])", "min([1], key=lambda v: ud.words[9])"),
]


@COMPILERS
@pytest.mark.slow
def test_edges_have_the_value_of_python(compiler: Compiler, folder: Path) -> None:
    batch = []
    for text in EDGES:
        tree = parse_expression(text)
        assert tree is not None, text
        with contextlib.suppress(UnportableError):
            batch.append(portable(tree))
    assert len(EDGES) - len(batch) == 1  # str([1, 2.5])
    assert compare(compiler, folder, batch, 1, Tally()) == []


@COMPILERS
@pytest.mark.slow
def test_programs_without_exceptions_end_with_the_message(compiler: Compiler, folder: Path) -> None:
    text = """\
#include <smachac/values.hpp>
int main(int argc, char **) {
  std::printf("%s\\n", smachac::json(smachac::py::divide(std::int64_t{1}, 2)).c_str());
  std::fflush(stdout);
  return static_cast<int>(smachac::py::floor_divide(4, std::int64_t{argc - 1}));
}
"""
    program = compiler.compile(text, folder, *BARE, standard="c++20")
    run = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert run.stdout == "0.5\n"
    assert run.stderr == "smachac: division by zero\n"
    assert run.returncode < 0


@COMPILERS
@pytest.mark.slow
def test_expressions_compile_optimised_and_bare_without_a_warning(
    compiler: Compiler, folder: Path
) -> None:
    text = program(list(cases(40, 5)), [userdata(random.Random(1))])
    bare = text.replace("try {", "{").replace("error.what()", '""')
    bare = bare.replace("catch (const smachac::Error &error) {", "if (false) {")
    assert compiler.compile(bare, folder, "-O1", *BARE, standard="c++20").exists()


Numbers = tuple[float, float]


def numbers() -> list[Numbers]:
    """Pairs of floats of all sizes, and of such as people write."""
    rng = random.Random(3)
    odd = [0.0, -0.0, 1.0, -1.0, 0.5, 1e15, 1e16, 9007199254740993.0, 2.0**-44, 5e-324, 1e-4, 1e-5]
    found = [(a, b) for a in odd for b in odd]
    for _ in range(600):
        a, b = (struct.unpack("<d", rng.randbytes(8))[0] for _ in range(2))
        if math.isfinite(a) and math.isfinite(b):
            found += [(a, b), (rng.randint(-99, 99) / 8, rng.randint(-9, 9) / 2)]
        found.append((round(rng.uniform(-1e4, 1e4), 3), 10.0 ** rng.randint(-9, 9)))
        found.append((math.floor(a) / 2.0 if abs(a) < 1e9 else 0.125, b))
    return found


def python_lines(a: float, b: float) -> list[str]:
    made: list[Callable[[], float]] = [
        lambda: a,
        lambda: a // b,
        lambda: a % b,
        lambda: round(a, 2),
        lambda: round(a, 0),
        lambda: round(b),
        lambda: float(f" {a!r} ") if a else 0.0,
        lambda: int(a * 2**40) / int(b * 2**40),
    ]
    return [_line(item) for item in made]


def _line(function: Callable[[], float]) -> str:
    try:
        value = function()
    except (ZeroDivisionError, OverflowError):
        return "!"
    return "!" if isinstance(value, int) and abs(value) >= 2**63 else repr(value)


FLOATS = """\
#include <smachac/values.hpp>
template <class F> void show(F function) {
  try {
    std::printf("%s\\n", smachac::py::repr(function()).c_str());
  } catch (const smachac::Error &) {
    std::printf("!\\n");
  }
}
int main() {
  namespace py = smachac::py;
  const double wide = 1099511627776.0;
  const std::vector<std::array<double, 2>> pairs = {PAIRS};
  for (const auto &pair : pairs) {
    const double a = pair[0], b = pair[1];
    show([&] { return a; });
    show([&] { return py::floor_divide(a, b); });
    show([&] { return py::modulo(a, b); });
    show([&] { return py::round(a, 2); });
    show([&] { return py::round(a, 0); });
    show([&] { return py::round(b); });
    show([&] { return a != 0.0 ? py::real(" " + py::text(a) + " ") : 0.0; });
    show([&] { return py::divide(py::whole(a * wide), py::whole(b * wide)); });
  }
}
"""


@COMPILERS
@pytest.mark.slow
def test_floats_are_those_of_python_to_the_last_bit(compiler: Compiler, folder: Path) -> None:
    pairs = numbers()
    table = ", ".join(f"{{{{{cpp_float(a)}, {cpp_float(b)}}}}}" for a, b in pairs)
    lines = compiler.run(FLOATS.replace("PAIRS", table), folder, "-O0").splitlines()
    expected = [line for pair in pairs for line in python_lines(*pair)]
    places = [f"{pairs[i // 8]} {i % 8}" for i in range(len(expected))]
    faults = [
        row
        for row in zip(places, lines, expected, strict=True)
        if row[1] != row[2] and not _beyond(row, pairs)
    ]
    assert faults == []


def _beyond(line: tuple[str, str, str], pairs: list[Numbers]) -> bool:
    """Whether C++ has no whole number for the floats of the last line of a pair."""
    a, b = json.loads(line[0].replace("(", "[").replace(")", "]").rpartition(" ")[0])
    return line[0].endswith("7") and max(abs(a), abs(b)) >= 2**23 and line[1] == "!"


TEXTS = [
    *("12", " -7\n", "+5", "1_000", "_1", "1__0", "", "-", "1e3", "0x10", "\uff19", "1.5", "e5"),
    *(".5", "5.", ".", "1e", "1e+5", "1e999", "-1e999", "1e-999", "0e999", "0.0001e-320", "nan"),
    *("-Infinity", "iNf", "1_0.2_5", "1._5", "1_.5", " 1 2 ", "\x1f7", "1e5_0", "1 _0", "9" * 19),
]


@COMPILERS
@pytest.mark.slow
def test_texts_are_read_as_numbers_and_written_as_json(compiler: Compiler, folder: Path) -> None:
    odd = ["", "\0a", "ä€\N{GRINNING FACE}", "\"'\\\b\f\n\r\t\x01\x7f", "??=", "\\u0041", "\x85"]
    shows = [f"show([] {{ return py::whole({cpp_string(text)}); }});" for text in TEXTS]
    shows += [f"show([] {{ return py::real({cpp_string(text)}); }});" for text in TEXTS]
    shows += [f'std::printf("%s\\n", smachac::json({cpp_string(t)}).c_str());' for t in odd]
    shows += [f"show([] {{ return py::length({cpp_string(text)}); }});" for text in odd]
    text = FLOATS.partition("int main")[0]
    text += f"int main() {{\n  namespace py = smachac::py;\n  {chr(10).join(shows)}\n}}\n"
    expected = [_read(int, text) for text in TEXTS] + [_read(float, text) for text in TEXTS]
    expected += [json.dumps(text) for text in odd] + [str(len(text)) for text in odd]
    assert compiler.run(text, folder, "-O0").splitlines() == expected


def _read(kind: Callable[[str], float], text: str) -> str:
    # Digits beyond ASCII are read by Python alone.
    try:
        value = kind(text) if text.isascii() else None
    except ValueError:
        return "!"
    return "!" if value is None or (isinstance(value, int) and value >= 2**63) else repr(value)


# How it looks


def formatted(text: str, style: str) -> str:
    tool = next(filter(None, map(shutil.which, ("clang-format", "clang-format-14"))), None)
    if tool is None:
        pytest.skip("no clang-format")
    call = [tool, f"--style={{{', '.join(style.strip().splitlines())}}}"]
    return subprocess.run(call, input=text, capture_output=True, text=True, check=True).stdout


def test_generated_expressions_keep_their_layout() -> None:
    functions = [
        f"auto f{i}(const In &in) {{\n  return {case.text};\n}}\n"
        for i, case in enumerate(cases(150, 9))
    ]
    text = "\n".join(functions)
    assert formatted(text, CLANG_FORMAT) == text


def test_the_header_is_laid_out_as_clang_format_does() -> None:
    text = (HEADERS / "smachac" / "values.hpp").read_text("utf-8")
    assert formatted(text, "BasedOnStyle: LLVM\nColumnLimit: 100") == text

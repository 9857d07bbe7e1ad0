from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.type_lattice import (
    Misfit,
    constants,
    fits,
    join,
    joined,
    meet,
    misfit,
    settled,
    widened,
)
from smachac.ir.types import ANY, Type, parse_type
from tests.strategies.machines import types
from tests.support.examples import examples


def a(text: str) -> Type:
    """A type as scripts write it; `=x` is the literal x, `(a, b)` a list of two, `{x: a}` a
    mapping."""
    text = text.strip()
    if text.startswith("="):
        return constants([int(text[1:]) if text[1:].isdigit() else text[1:]])
    if text.startswith("("):
        return Type("tuple", tuple(a(part) for part in _split(text[1:-1])))
    if text.startswith("{") and "," not in text:
        name, _, rest = text[1:-1].partition(":")
        return Type("mapping", (name, a(rest)) if name else ())
    found = parse_type(text)
    assert found is not None, text
    return found


def _split(text: str) -> list[str]:
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and not depth:
            parts.append("")
        else:
            parts[-1] += letter
    return [part for part in parts if part.strip()]


def pairs(text: str) -> list[str]:
    return [pair.strip() for pair in text.replace("\n", "|").split("|") if pair.strip()]


FITS = """
int -> float | int -> float<m> | int<m> -> float<m> | float -> float<rad> | float<rad> -> float
Pose -> Pose? | none -> Pose? | float -> float? | int -> float? | none -> none | int? -> float?
one_of[a] -> one_of[a, b] | one_of[a, b] -> str | one_of[1, 2] -> int | one_of[1, 2] -> float
=a -> one_of[a, b] | =a -> str | =1 -> int | =1 -> float<s> | =1 -> one_of[1, 2]
list[int] -> list[float] | int[3] -> list[float] | list[int] -> int[3] | list -> list[Pose]
list[Pose] -> list | dict[str, int] -> dict[str, float] | dict -> dict[str, Pose]
(=1, float, =3) -> Point | (float, float, float, float) -> Quaternion | (=1, =2, =3) -> Pose
((float, float, float), (float, float, float, float)) -> Pose | (=1, float) -> float[2]
(=1, =2) -> list[float<rad>] | () -> list[Pose] | () -> str[0] | (=a, =b) -> list[one_of[a, b]]
{x: float} -> dict[str, float] | {} -> dict | {frame: str} -> PoseStamped
any -> Pose | Pose -> any | list[any] -> list[Pose] | Grasp -> Pose | any? -> int | list -> Pose
{a: int, b: str} -> {b: str, a: float} | {a: int, b: str} -> {b: str, c: int?}
{a: int, b: int} -> dict[str, float] | dict[str, int] -> {a: int, b: float}
dict -> {a: int, b: str} | {x: =1} -> {x: float} | {x: =1} -> {x: float, y: int?}
list[{a: int, b: str}] -> list[{a: float, b: any}] | {a: int, b: str} -> my_msgs/Pair
geometry_msgs/Pose -> geometry_msgs/msg/Pose | geometry_msgs.msg.Pose -> geometry_msgs/Pose
(float, float) -> my_msgs/Pair | {x: float} -> my_msgs/Point
float<m/s^2> -> float<s^-2*m> | float<rad/s> -> float<s^-1*rad> | float<1/s> -> float<s^-1>
"""


@pytest.mark.parametrize(
    "pair", [p.strip() for p in FITS.replace("\n", "|").split("|") if p.strip()]
)
def test_what_fits(pair: str) -> None:
    given, wanted = map(a, pair.split("->"))
    assert misfit(given, wanted) is None


CLASHES = """
float -> int | bool -> int | int -> bool | str -> float | float -> str | int -> str | Pose -> Point
Pose? -> Pose | none -> Pose | str -> one_of[a, b] | one_of[a, b] -> one_of[a] | one_of[1] -> str
=c -> one_of[a, b] | =a -> float | =1 -> str | list[float] -> list[int] | list[str] -> str
dict[str, str] -> dict[str, int] | dict -> list | list -> dict | (float, =a, float) -> Point
{x: =a} -> dict[str, float] | {x: float} -> Point | {x: float} -> list | (float, float) -> str
geometry_msgs/Pose -> geometry_msgs/Point | geometry_msgs/Pose -> Pose | =a -> std_msgs/String
{a: int, b: str} -> {a: int, c: str} | {a: int, b: str} -> {a: str, b: str}
{a: int, b: str} -> dict[str, int] | dict[str, str] -> {a: int, b: str} | {a: int, b: str} -> str
{x: =1} -> {x: float, y: float} | {x: =a} -> {x: float, y: int?} | {a: int, b: str} -> list
Transform -> Pose | float[3] -> Point | (float, float) -> Pose | str -> Pose | float -> list
"""


@pytest.mark.parametrize("pair", pairs(CLASHES))
def test_what_does_not_fit(pair: str) -> None:
    given, wanted = map(a, pair.split("->"))
    found = misfit(given, wanted)
    assert found is not None
    assert found.kind == "type"


def test_the_innermost_parts_and_the_kind_are_told() -> None:
    assert misfit(a("list[float<deg>[2]]"), a("list[float<rad>[2]]")) == Misfit(
        "unit", a("float<deg>"), a("float<rad>")
    )
    assert misfit(a("(=1, =2)"), a("float[3]")) == Misfit("length", a("(=1, =2)"), a("float[3]"))
    assert misfit(a("float[2]?"), a("float[3]?")) == Misfit("length", a("float[2]"), a("float[3]"))
    assert misfit(a("(float, =a, =3)"), a("Point")) == Misfit("type", a("=a"), a("float"))


@pytest.mark.parametrize(
    ("one", "other", "both"),
    [
        ("int", "float<m>", "float<m>"),
        ("float<deg>", "float<rad>", "float"),
        ("=a", "=b", "str"),
        ("=a", "one_of[a, b]", "one_of[a, b]"),
        ("=1", "float", "float"),
        ("none", "Pose", "Pose?"),
        ("(=1, =2)", "(float, =3)", "float[2]"),
        ("(=1, =2)", "(=3, =4, =5)", "list[int]"),
        ("()", "list[str]", "list[str]"),
        ("(float, float, float)", "Point", "Point"),
        ("{x: =1}", "{x: float}", "dict[str, float]"),
        ("str", "float", "any"),
        ("bool", "int", "any"),
    ],
)
def test_the_least_type_of_two(one: str, other: str, both: str) -> None:
    assert widened(join(a(one), a(other))) == widened(join(a(other), a(one))) == a(both)


@pytest.mark.parametrize(
    ("written", "read", "type_"),
    [
        ("=0", "float<m>", "float<m>"),
        ("int", "float", "int"),
        ("(=0, =0, =0)", "list[float<rad>]", "float<rad>[3]"),
        ("((float, float, float), (float, float, float, float))", "Pose?", "Pose"),
        ("=open", "one_of[open, close]", "one_of[open, close]"),
        ("any", "Pose", "Pose"),
        ("str", "Pose", "str"),
        ("list", "list[Pose]", "list[Pose]"),
        ("((=1, =2, =3),)", "list[Pose]", "Pose[1]"),
        ("=open", "any", "str"),
    ],
)
def test_the_type_of_a_key(written: str, read: str, type_: str) -> None:
    assert settled(a(written), a(read)) == a(type_)


LITERALS = "=a =b =7 (=1,float) () ({x:=1},=a) {x:none} ((float,float,float),()) none"
WRITTEN = st.sampled_from(LITERALS.split(" ")).map(a)
ANY_TYPES = types() | WRITTEN
SCALAR_UNITS = st.sampled_from(["float<m>", "float<rad>", "int", "float", "int<m>"]).map(a)
MORE_TYPES = ANY_TYPES | SCALAR_UNITS


@given(MORE_TYPES)
def test_every_type_fits_itself_any_and_its_optional(type_: Type) -> None:
    assert fits(type_, type_)
    assert fits(type_, ANY)
    assert fits(ANY, type_)
    assert fits(type_, Type("optional", (type_,)))


@given(MORE_TYPES, MORE_TYPES)
@settings(max_examples=examples(300))
def test_both_fit_what_joins_them(one: Type, other: Type) -> None:
    both = join(one, other)
    assert fits(one, both)
    assert fits(other, both)
    assert join(other, one) == both


@given(MORE_TYPES, MORE_TYPES)
@settings(max_examples=examples(300))
def test_what_meets_two_types_fits_both(one: Type, other: Type) -> None:
    both = meet(one, other)
    assert both == ANY or (fits(both, one) and fits(both, other))


@given(MORE_TYPES)
def test_a_widened_type_can_be_written_in_a_script(type_: Type) -> None:
    plain = widened(type_)
    assert parse_type(str(plain)) == plain
    assert widened(plain) == plain


@given(st.lists(MORE_TYPES, max_size=4), st.randoms())
def test_the_order_of_several_types_does_not_count(found: list[Type], random: object) -> None:
    shuffled = list(found)
    random.shuffle(shuffled)  # type: ignore[attr-defined]
    assert joined(found) == joined(shuffled)

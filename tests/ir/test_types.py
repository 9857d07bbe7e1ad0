from __future__ import annotations

import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.grammars import parser_of
from smachac.grammars.standalone.lalr import LarkError
from smachac.ir.types import ANY, Type, _TypeBuilder, parse_type, unknown_words
from tests.strategies.machines import types
from tests.support.examples import examples

JOINTS = Type("array", (Type("float", ("rad",)), 7))


@pytest.mark.parametrize(
    ("text", "type_"),
    [
        ("bool", Type("bool")),
        (" geometry_msgs/Pose ", Type("geometry_msgs/Pose")),
        ("float<rad>[7]", JOINTS),
        ("list[ float<rad>[7] ]", Type("list", (JOINTS,))),
        ("dict[str, Pose?]", Type("dict", (Type("optional", (Type("Pose"),)),))),
        ("one_of[open, close]", Type("one_of", ("open", "close"))),
        ('one_of["left arm", 2, -1]', Type("one_of", ("left arm", 2, -1))),
        ("list of str", Type("list", (Type("str"),))),
        ("dict of list of str", Type("dict", (Type("list", (Type("str"),)),))),
        ("list", Type("list")),
        ("list[7]", Type("array", (Type("list"), 7))),
        ("[function, str]", ANY),
        ("any", ANY),
        (
            "{name: str, at: Pose?}",
            Type("record", ("name", Type("str"), "at", Type("optional", (Type("Pose"),)))),
        ),
        (
            'list[{"a b": {x: int}}]',
            Type("list", (Type("record", ("a b", Type("record", ("x", Type("int"))))),)),
        ),
    ],
)
def test_a_type_is_read(text: str, type_: Type) -> None:
    assert parse_type(text) == type_


@pytest.mark.parametrize(
    "text",
    [
        *("", "7", "a b", "list of", "set of str", "list[", "list[]", "list[str, str]", "Pose[a]"),
        *("dict[int, str]", "dict[str]", "float[-1]", "str<rad>", "float<>", "float<rad", "?"),
        *("{}", "{a}", "{a: }", "{a: int, a: int}", "{a: int", "{1: int}", "{a: one_of}"),
        *("{a: " * 51 + "int" + "}" * 51,),
        *("one_of", "one_of[]", "one_of?", "list[one_of]", "one_of[list[a]]", "a\nb", "int & str"),
        *("list[" * 51 + "a" + "]" * 51, "a" + "?" * 51, "list of " * 51 + "a", "a[" + "1" * 999),
    ],
)
def test_what_is_no_type_is_none(text: str) -> None:
    assert parse_type(text) is None


@given(types())
def test_reading_what_is_printed_gives_the_same_type(type_: Type) -> None:
    assert parse_type(str(type_)) == type_


@given(st.text(alphabet='ab1 []<>?,"-/.of{}:', max_size=20))
@settings(max_examples=examples(200))
def test_any_text_is_a_type_that_prints_or_none(text: str) -> None:
    type_ = parse_type(text)
    assert type_ is None or parse_type(str(type_)) == type_


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("list[Pose?]", ()),
        ("one_of[open, close]", ()),
        ("dict[str, geometry_msgs/Pose]", ()),
        ("numpy.ndarray", ()),
        ("dict", ()),
        ("flaot", ("flaot",)),
        ("dict of list of string", ("string",)),
        ("{name: str, at: Pose}", ()),
        ("list[{name: string}]", ("string",)),
        ("record", ("record",)),
    ],
)
def test_words_that_name_no_type_are_found(text: str, words: tuple[str, ...]) -> None:
    type_ = parse_type(text)
    assert type_ is not None
    assert unknown_words(type_) == words


def test_plain_words_need_no_parser() -> None:
    code = "import sys; from smachac.ir.types import parse_type; print(parse_type('pkg/Pose'))"
    code += "; print('smachac.grammars.standalone.lalr' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["pkg/Pose", "False"]


@pytest.mark.parametrize(
    "text",
    ["float<m/s>", "int<%>", "float<7>", "float<°C>", "int<rad^2>", "float<'>", "float<int<m>>",
     "float<>", "float<a b>", "float< m >", "str<m>", "float<m>[7]", "float<m>?", "float<m,s>"],
)  # fmt: skip
def test_a_quantity_is_that_of_the_grammar(text: str) -> None:
    parser = parser_of("type", _TypeBuilder)
    try:
        wanted = parser.parse(text)
    except (LarkError, ValueError):
        wanted = None
    assert parse_type(text) == wanted

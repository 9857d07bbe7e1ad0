"""Plain values are read from pickles as pickle reads them; nothing else is."""

from __future__ import annotations

import os
import pickle
from collections import OrderedDict
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.runtime import plain_pickle
from smachac.runtime.plain_pickle import MOST_BYTES, plain_value
from tests.support.examples import examples

SCALARS = (
    st.none()
    | st.booleans()
    | st.integers(-(2**200), 2**200)
    | st.floats(allow_nan=False)
    | st.text(max_size=20)
    | st.binary(max_size=20)
)
KEYS = st.none() | st.booleans() | st.integers() | st.text(max_size=5) | st.binary(max_size=5)
VALUES = st.recursive(
    SCALARS | st.sets(KEYS, max_size=4) | st.frozensets(KEYS, max_size=4),
    lambda inner: (
        st.lists(inner, max_size=5)
        | st.lists(inner, max_size=5).map(tuple)
        | st.dictionaries(KEYS, inner, max_size=5)
    ),
    max_leaves=30,
)


@given(value=VALUES, protocol=st.sampled_from([4, 5]))
@settings(max_examples=examples(300))
def test_plain_values_are_read_as_pickle_reads_them(value: object, protocol: int) -> None:
    assert plain_value(pickle.dumps(value, protocol)) == value


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
def test_shared_parts_stay_shared(protocol: int) -> None:
    pose = [1.0, (2, "b"), None]
    read = plain_value(pickle.dumps({"a": pose, "b": pose, "n": list(range(3000))}, protocol))
    assert read == {"a": pose, "b": pose, "n": list(range(3000))}
    assert read["a"] is read["b"]


def cycle() -> list[Any]:
    value: list[Any] = []
    value.append(value)
    return value


def nested(levels: int) -> list[Any]:
    value: list[Any] = []
    for _ in range(levels):
        value = [value]
    return value


def doubled(levels: int) -> list[Any]:
    value: list[Any] = [1]
    for _ in range(levels):
        value = [value, value]
    return value


def wide() -> list[Any]:
    row = [0] * 2000
    return [row] * 2000


@pytest.mark.parametrize(
    "value",
    [OrderedDict(a=1), Fraction(1, 2), os.getcwd, Exception, {"a": {"b": [object]}}, 1j,
     {(1, 2): 3}, {frozenset([1])}, cycle(), nested(60), doubled(40), wide(), "x" * MOST_BYTES,
     1 << 3000, bytearray(b"a")],
)  # fmt: skip
def test_other_values_are_refused(value: object) -> None:
    with pytest.raises(ValueError, match="it "):
        plain_value(pickle.dumps(value, 4))


def test_no_class_is_looked_up() -> None:
    with pytest.raises(ValueError, match="opcode GLOBAL"):
        plain_value(pickle.dumps({1, 2}, 2))


@given(data=st.binary(max_size=60))
@settings(max_examples=examples(300))
def test_broken_pickles_are_refused_with_one_exception(data: bytes) -> None:
    for text in (data, b"\x80\x04" + data + b".", pickle.dumps({"a": [1]}, 4)[: len(data)]):
        try:
            value = plain_value(text)
        except ValueError:
            continue
        assert isinstance(value, PLAIN)


PLAIN = (type(None), bool, int, float, str, bytes, list, tuple, dict, set, frozenset)


@pytest.mark.parametrize(
    "text",
    [b"", b".", b"]0.", b"(.", b"]K\x01e.", b"K\x01K\x02a.", b"}K\x01]s]s.", b"h\x07.", b"\x85.",
     b"K\x01}s.", b"](K\x01u.", b"}(K\x01u.", b"}]K\x01s.", b"q\x01.", b"r\xff\xff\xff\xff."],
)  # fmt: skip
def test_opcodes_out_of_order(text: bytes) -> None:
    with pytest.raises(ValueError, match=r"."):
        plain_value(text)


def test_a_large_memo_index_takes_no_memory() -> None:
    assert plain_value(b"\x80\x02Nr\xff\xff\xff\xff.") is None


def test_the_limits_are_those_of_the_module() -> None:
    most = plain_pickle.MOST_VALUES - 1
    assert plain_value(pickle.dumps([None] * most, 4)) == [None] * most
    assert plain_value(pickle.dumps(nested(plain_pickle.MOST_LEVELS), 4))

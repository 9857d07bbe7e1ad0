"""Every operator and built-in function over every pair of kinds of operands, for both languages."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping

from smachac.ir.expressions import parse_expression
from smachac.targets.cpp.types import UnportableError
from tests.cpp.expression_programs import Case, portable
from tests.strategies.typed_expressions import TYPES

LITERALS = ("None", "True", "0", "-1", "9223372036854775807", "1e308", "''", "'a'", "[]", "[None]",
            "(1, None)", "{}", "{'a': None}", "float('inf')", "float('nan')")  # fmt: skip
OPERANDS = (*(f"ud.{name}" for name in TYPES), *LITERALS)
OPERATORS = ("+", "-", "*", "/", "//", "%", "<", "<=", ">", ">=", "==", "!=", "in", "not in",
             "and", "or")  # fmt: skip
FUNCTIONS = ("abs", "bool", "dict", "float", "int", "len", "list", "max", "min", "range", "round",
             "sorted", "str", "sum", "tuple")  # fmt: skip
EXPONENTS = (0, 1, 2, 3, 62, 63, 64, 10_001, -1, -2, 0.5, -0.5, 1e308)

INPUTS: tuple[Mapping[str, object], ...] = tuple(
    {
        "flag": bool(n % 2), "n": n, "m": m, "x": x, "y": y, "s": s, "t": t,
        "mode": ("open", "closed")[m % 2], "whole": whole, "reals": [x, y][: len(whole)],
        "words": [s, t][: len(whole)], "flags": [True, False][: len(whole)], "three": [x, y, 0.0],
        "rows": [whole, []], "table": dict.fromkeys([s], n), "scores": {"a": x},
        "maybe": maybe, "note": note, "speed": speed, "gaps": [*whole, maybe],
        "point": [x, y, 1.0], "pose": [[x, 0.0, y], [0.0, 0.0, 0.0, 1.0]],
    }
    for n, m, x, y, s, t, whole, maybe, note, speed in (
        (0, 0, 0.0, -0.0, "", "", [], None, None, None),
        (1, -1, 1.0, -1.0, "a", "b", [1], 0, "", 0.0),
        (2**63 - 1, -(2**63), math.inf, -math.inf, "ab", "a", [2**63 - 1, -(2**63)],
         -(2**63), "a", math.inf),
        (-(2**63), 2**63 - 1, 1e308, -1e308, "12", "-7", [-(2**63), 0], 1, "ab", -1e308),
        (3, -7, math.nan, 5e-324, "1e3", "nan", [3, 3], 2**63 - 1, "open", math.nan),
        (-1, 2, 2.5, 0.5, "b", "", [0, 1], -1, "b", 2.5),
    )
)  # fmt: skip
"""Extremes of each kind, each once beside empty values."""


def sources() -> Iterator[str]:
    """The expressions as text."""
    for one in OPERANDS:
        yield from (f"{word}({one})" for word in ("not ", "-", "+", *FUNCTIONS))
        yield from (f"{one} ** {exponent}" for exponent in EXPONENTS)
        yield from (f"{name}({one}, key=lambda v: v)" for name in ("max", "min", "sorted"))
        yield f"sorted({one}, reverse=True)"
        yield f"round({one}, 2)"
    for one, other in itertools.product(OPERANDS, repeat=2):
        yield from (f"{one} {word} {other}" for word in OPERATORS)
        yield f"{one}[{other}]"
        yield f"[{one}, {other}]"
        yield f"{one} if {other} else {one}"
        yield from (f"{name}({one}, {other})" for name in ("max", "min", "sum", "round"))
        yield f"{one} in [{other}]"
        yield f"{one} < {other} < {one}"
        yield f"[{one}] == [{other}]"
        yield f"[{one}] < [{other}]"
        yield f"{{'a': {one}}} == {{'a': {other}}}"


def cases() -> Iterator[Case]:
    """Those of the expressions that C++ can express."""
    for text in sources():
        tree = parse_expression(text)
        assert tree is not None, text
        try:
            yield portable(tree)
        except UnportableError:
            continue

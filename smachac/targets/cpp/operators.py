"""Operators of Python in C++: arithmetic, comparison and membership.

Integer arithmetic is checked for overflow; arithmetic of floats uses the operators of C++.
"""

from __future__ import annotations

from smachac.ir.types import Type
from smachac.targets.cpp.dialect import UNBOUNDED
from smachac.targets.cpp.terms import (
    BOOL,
    EQUALITY,
    NUMBER,
    PRODUCT,
    RELATION,
    SEQUENCES,
    SIGNED,
    SUM,
    CppText,
    Term,
    call,
    cpp,
    fixed,
    has,
    inside,
    join,
    number,
    present,
    shown,
    size_of,
)
from smachac.targets.cpp.types import (
    EXACT,
    FIELDS,
    FLOAT,
    INT,
    LISTED,
    NONE,
    STR,
    UnportableError,
    cpp_literal,
)

CHECKED = {
    "+": "add",
    "-": "subtract",
    "*": "multiply",
    "//": "floor_divide",
    "%": "modulo",
    "/": "divide",
}
BINDING = {"+": SUM, "-": SUM, "*": PRODUCT}


def signed(sign: str, operand: Term) -> Term:
    """`-x` and `+x`."""
    kind = number(operand.type)
    if kind is None:
        raise UnportableError(f"`{shown(operand.type)}` is not a number")
    value = whole(operand) if kind == INT else real(operand)
    if kind == INT:
        return fixed(
            INT, call("negate", value.text) if sign == "-" else call("add", "0", value.text)
        )
    return fixed(kind, CppText(f"-{value.at(SIGNED + 1)}", SIGNED) if sign == "-" else value)


def whole(term: Term) -> CppText:
    """An integer or a truth value as an integer argument."""
    return term.spell(present(term.type))


def real(term: Term) -> CppText:
    """A number as a float, rounded if necessary."""
    kind = present(term.type)
    if term.constant is not None and kind == INT:
        return term.spell(FLOAT)
    value = term.spell(kind)
    return call("real", value.text) if kind in (INT, BOOL) else value


def binary(word: str, left: Term, right: Term) -> Term:
    """A binary operation. Raises UnportableError where Python would raise TypeError."""
    one, other = number(left.type), number(right.type)
    if one is not None and other is not None:
        return _numbers(word, one, other, left, right)
    kinds = present(left.type), present(right.type)
    match word, kinds[0].name, kinds[1].name:
        case "+", "str", "str":
            return _joined_texts(left, right)
        case "+", ("list" | "array"), ("list" | "array"):
            return _joined_lists("list", left, right)
        case "+", "tuple", "tuple":
            return _joined_lists("tuple", left, right)
        case "*", ("str" | "list" | "array" | "tuple"), _ if other == INT:
            return _repeated(left, right)
        case "*", _, ("str" | "list" | "array" | "tuple") if one == INT:
            return _repeated(right, left)
    raise UnportableError(_undefined(word, left, right))


def _undefined(word: str, left: Term, right: Term) -> str:
    return f"`{word}` is not defined for `{shown(left.type)}` and `{shown(right.type)}`"


def _numbers(word: str, one: Type, other: Type, left: Term, right: Term) -> Term:
    if word == "**":
        return _power(one, other, left, right)
    if one == other == INT:
        return fixed(FLOAT if word == "/" else INT, call(CHECKED[word], *_wholes(left, right)))
    type_ = FLOAT if FLOAT in (one, other) or word == "/" else NUMBER
    first, second = real(left), real(right)
    if word in BINDING:
        own = BINDING[word]
        return fixed(type_, CppText(f"{first.at(own)} {word} {second.at(own + 1)}", own))
    return fixed(type_, call(CHECKED[word], first.text, second.text))


def _wholes(left: Term, right: Term) -> tuple[str, str]:
    """Two integers as arguments of a function with an overload for floats: one of them is typed."""
    first, second = whole(left).text, whole(right).text
    if any(present(term.type) == INT and term.constant is None for term in (left, right)):
        return first, second
    return f"std::int64_t{{{first}}}", second


def _power(one: Type, other: Type, left: Term, right: Term) -> Term:
    if one == other == INT:
        exponent = right.constant
        if not isinstance(exponent, int):
            message = "the type depends on the sign of the exponent: write `float(...)`"
            raise UnportableError(message)
        if exponent >= 0:
            return fixed(INT, call("power", *_wholes(left, right)))
    type_ = FLOAT if FLOAT in (one, other) or one == other == INT else NUMBER
    return fixed(type_, call("power", real(left).text, real(right).text))


def _joined_texts(left: Term, right: Term) -> Term:
    first, second = left.spell(STR).at(SUM), right.spell(STR).at(SUM + 1)
    if isinstance(right.constant, str) and "\0" not in right.constant:
        second = cpp_literal(right.constant)
    elif isinstance(left.constant, str) and "\0" not in left.constant:
        first = cpp_literal(left.constant)
    return fixed(STR, CppText(f"{UNBOUNDED}{first} + {second}", SUM))


def _joined_lists(kind: str, left: Term, right: Term) -> Term:
    item = join(inside(present(left.type)), inside(present(right.type)))
    type_ = Type(kind, (item,))
    texts = (
        term.spell(type_).text if has(term.type, "never") else term.present()
        for term in (left, right)
    )
    return fixed(type_, call(f"concat<{cpp(item)}>", *texts))


def _repeated(items: Term, times: Term) -> Term:
    kind = present(items.type)
    type_ = (
        kind if kind == STR else Type("tuple" if kind.name == "tuple" else "list", kind.args[:1])
    )
    return fixed(type_, call("repeat", items.present(), whole(times).text))


DIRECT = (INT, FLOAT, NUMBER, STR)
"""The types whose comparisons are the same in C++ and Python."""

EQUAL = ("==", "!=")
"""The comparisons that values of every type have."""


def compare(word: str, left: Term, right: Term) -> CppText:
    """One comparison. Raises UnportableError where Python would raise TypeError."""
    match word:
        case "==" | "!=":
            return _equal(word, left, right)
        case "in":
            return _contains(left, right)
        case "not in":
            return CppText(f"!{_contains(left, right).at(SIGNED)}", SIGNED)
    return _ordered(word, left, right)


def _direct(word: str, left: Term, right: Term) -> CppText | None:
    """The comparison by an operator of C++, where it has the same meaning and causes no warning."""
    kinds = {left.type, right.type}
    if left.constant is not None and right.constant is not None:
        return None
    floats = {FLOAT if kind == NUMBER else kind for kind in kinds}
    if floats == {INT, FLOAT}:
        whole = left if left.type == INT else right
        if not isinstance(whole.constant, int) or abs(whole.constant) > EXACT:
            return None
        one, other = (_side(term, FLOAT if term is whole else term.type) for term in (left, right))
    elif len(floats) == 1 and (kinds <= set(DIRECT) or (kinds == {BOOL} and word in EQUAL)):
        one, other = _side(left, left.type), _side(right, right.type)
    else:
        return None
    if one == other:
        return None
    return CppText(f"{one} {word} {other}", EQUALITY if word in EQUAL else RELATION)


def _side(term: Term, as_: Type) -> str:
    if isinstance(term.constant, str) and "\0" not in term.constant:
        return cpp_literal(term.constant)
    return term.spell(as_).at(SUM)


def _ordered(word: str, left: Term, right: Term) -> CppText:
    direct = _direct(word, left, right)
    if direct is not None:
        return direct
    nothing = NONE in (left.type, right.type)
    if nothing or not _have_order(present(left.type), present(right.type)):
        raise UnportableError(_undefined(word, left, right))
    left, right = there(left), there(right)
    one, other = _side_of(left, right), _side_of(right, left)
    if word in (">", ">="):
        one, other = other, one
    return call("less" if word in ("<", ">") else "at_most", one, other)


def there(term: Term) -> Term:
    """The value of an optional term; in C++ an error if there is none."""
    if term.type.name != "optional":
        return term
    return fixed(present(term.type), CppText(term.present()))


def _have_order(one: Type, other: Type) -> bool:
    """Whether Python can order any two values of two types."""
    if "never" in (one.name, other.name):
        return True
    if number(one) is not None and number(other) is not None:
        return "optional" not in (one.name, other.name)
    kinds = {one.name, other.name}
    if kinds <= {"list", "array"} or kinds == {"tuple"}:
        return _have_order(inside(one), inside(other))
    return one == other == STR


def orderable(type_: Type) -> bool:
    """Whether the values of a type have an order among themselves."""
    return _have_order(type_, type_)


def _equal(word: str, left: Term, right: Term) -> CppText:
    """`==` or `!=`: an operator of C++, or the function `equal` and its negation."""
    direct = _direct(word, left, right)
    if direct is not None:
        return direct
    for one, other in ((left, right), (right, left)):
        if other.type == NONE and one.type.name == "optional" and other.simple:
            return CppText(f"{one.text(SUM)} {word} std::nullopt", EQUALITY)
        if one.type.name in LISTED and present(other.type).name in SEQUENCES:
            if size_of(other.type) != len(FIELDS[one.type.name]):
                size = len(FIELDS[one.type.name])
                raise UnportableError(f"`{one.type}` only compares with a list of {size} items")
            return _equality(word, one.text(), other.spell(one.type).text)
    _refuse_kinds(left.type, right.type)
    return _equality(word, _side_of(left, right), _side_of(right, left))


def _equality(word: str, one: str, other: str) -> CppText:
    found = call("equal", one, other)
    return CppText(f"!{found.at(SIGNED)}", SIGNED) if word == "!=" else found


def _side_of(term: Term, other: Term) -> str:
    """A side of a comparison; an empty list gets the item type of the other side."""
    common = join(term.type, other.type)
    known = has(term.type, "never") and common.name != "mixed"
    return term.spell(common if known else term.type).text


def _refuse_kinds(one: Type, other: Type) -> None:
    """Refuses comparisons of lists, tuples and ranges with each other: in Python they are never
    equal, in C++ they may be."""
    one, other = present(one), present(other)
    if one.name in SEQUENCES and other.name in SEQUENCES:
        kinds = {"list" if type_.name == "array" else type_.name for type_ in (one, other)}
        if len(kinds) > 1:
            raise UnportableError(f"a {' is never equal to a '.join(sorted(kinds))}")
        _refuse_kinds(inside(one), inside(other))
    elif one.name == other.name == "dict":
        _refuse_kinds(inside(one), inside(other))


def _contains(left: Term, right: Term) -> CppText:
    kind = present(right.type)
    if kind == STR or kind.name == "dict":
        if present(left.type) != STR:
            raise UnportableError(f"`{shown(kind)}` never contains `{shown(left.type)}`")
        # None is in no mapping, but `None in "text"` is an error.
        return call(
            "contains", right.present(), left.text() if kind.name == "dict" else left.present()
        )
    if kind.name not in SEQUENCES:
        raise UnportableError(f"`{shown(kind)}` has no items")
    _refuse_kinds(left.type, inside(kind))
    return call("contains", right.present(), left.text())

"""The built-in functions of expressions in C++, and the subscript operator."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from smachac.ir.types import Type
from smachac.targets.cpp.identifiers import member_identifier
from smachac.targets.cpp.literals import mapped
from smachac.targets.cpp.operators import orderable, real, whole
from smachac.targets.cpp.terms import (
    BOOL,
    NUMBER,
    RANGE,
    SEQUENCES,
    CppText,
    Term,
    call,
    cpp,
    fixed,
    has,
    hosted_call,
    inside,
    joined,
    literal,
    number,
    present,
    shown,
    size_of,
)
from smachac.targets.cpp.types import (
    FIELDS,
    FLOAT,
    INT,
    LISTED,
    STR,
    UnportableError,
    fields_of,
)

Named = Mapping[str, Term]


def item(owner: Term, place: Term) -> Term:
    """`owner[place]`."""
    kind, index = present(owner.type), present(place.type)
    if kind.name == "dict" and index == STR:
        return fixed(inside(kind), call("item", owner.present(), place.present()))
    if number(index) == INT and index.name in ("int", "bool"):
        found = STR if kind == STR else inside(kind) if kind.name in SEQUENCES else None
        found = FLOAT if kind.name in LISTED[:2] else found
        if found is not None:
            return fixed(found, call("item", owner.present(), whole(place).text))
    if kind.name == "struct" and isinstance(place.constant, str):
        return _field(owner, kind, place.constant)
    raise UnportableError(f"`{shown(kind)}` has no items with the index type `{shown(index)}`")


def _field(owner: Term, struct: Type, name: str) -> Term:
    """A field of a record. Python fails where an optional field is absent, and has None where it is
    null: C++ does not tell these apart."""
    fields = fields_of(struct)
    if name not in fields:
        raise UnportableError(f"`{struct}` has no field `{name}`, only {', '.join(fields)}")
    if fields[name].name == "optional":
        raise UnportableError(f"`{name}` of `{struct}` may be absent", help=_OPTIONAL_FIELD)
    return fixed(fields[name], call("field", f"{owner.present()}.{member_identifier(name)}"))


_OPTIONAL_FIELD = "declare the field without `?`, or write a class in C++ for the state"


def item_of(given: list[Term]) -> Type:
    """The type of the items that a function iterates over."""
    if len(given) == 1:
        return inside(items(given[0]).type)
    return joined([term.type for term in given])


def items(term: Term) -> Term:
    """The items that a function iterates over, as a list: the characters of a string, the keys of a
    mapping."""
    kind = present(term.type)
    if kind == STR:
        return fixed(Type("list", (STR,)), call("characters", term.present()))
    if kind.name == "dict":
        return fixed(Type("list", (STR,)), call("keys", term.present()))
    if kind.name in LISTED[:2]:
        raise UnportableError(f"`{kind}` is not a list: use its fields, such as `.x`")
    if kind.name not in SEQUENCES:
        raise UnportableError(f"`{shown(term.type)}` has no items")
    return fixed(kind, CppText(term.present()))


def _no_names(named: Named, *but: str) -> None:
    for name in named:
        if name not in but:
            raise UnportableError(f"the argument `{name}` is not supported")


def _only(given: list[Term], named: Named) -> Term:
    _no_names(named)
    if len(given) != 1:
        raise UnportableError(f"the function has {len(given)} arguments instead of one")
    return given[0]


def _abs(given: list[Term], named: Named) -> Term:
    only = _only(given, named)
    kind = number(only.type)
    if kind is None:
        raise UnportableError(f"`{shown(only.type)}` is not a number")
    value = f"std::int64_t{{{whole(only).text}}}" if kind == INT else real(only).text
    return fixed(kind, call("absolute", value))


def _bool(given: list[Term], named: Named) -> Term:
    if not given:
        return literal(False)
    only = _only(given, named)
    if only.type == BOOL:
        return only
    return fixed(BOOL, call("truth", only.text()))


def _dict(given: list[Term], named: Named) -> Term:
    if not given:
        return mapped([(literal(name), value) for name, value in named.items()])
    only = _only(given, named)
    if present(only.type).name != "dict":
        raise UnportableError(f"`{shown(only.type)}` is not a mapping")
    return fixed(present(only.type), CppText(only.present()))


def _float(given: list[Term], named: Named) -> Term:
    if not given:
        return literal(0.0)
    only = _only(given, named)
    if present(only.type) == STR:
        return fixed(FLOAT, hosted_call("real", only.present()))
    if number(only.type) is None:
        raise UnportableError(f"`{shown(only.type)}` is not a number")
    return fixed(FLOAT, real(only))


def _int(given: list[Term], named: Named) -> Term:
    if not given:
        return literal(0)
    only = _only(given, named)
    kind = number(only.type)
    if present(only.type) == STR:
        return fixed(INT, hosted_call("whole", only.present()))
    if kind in (FLOAT, NUMBER):
        return fixed(INT, call("whole", only.present()))
    if kind is None:
        raise UnportableError(f"`{shown(only.type)}` is not a number")
    return fixed(INT, CppText(f"std::int64_t{{{whole(only).text}}}"))


def _len(given: list[Term], named: Named) -> Term:
    only = _only(given, named)
    kind = present(only.type)
    if kind.name in LISTED:
        return literal(len(FIELDS[kind.name]))
    if kind.name not in (*SEQUENCES, "str", "dict"):
        raise UnportableError(f"`{shown(only.type)}` has no length")
    return fixed(INT, call("length", only.present()))


def _list(given: list[Term], named: Named, kind: str = "list") -> Term:
    if not given:
        return fixed(Type(kind, (INT,)), CppText(f"{cpp(Type(kind, (INT,)))}{{}}"))
    only = _only(given, named)
    if present(only.type).name == "dict":
        raise UnportableError("a mapping has no order in C++: write `sorted(...)`")
    found = items(only)
    wanted = Type(kind, (inside(found.type),))
    return fixed(wanted, found.spell(wanted))


def _extreme(name: str) -> Callable[[list[Term], Named], Term]:
    def made(given: list[Term], named: Named) -> Term:
        _no_names(named, "key")
        if not given:
            raise UnportableError("the function has no arguments")
        if len(given) == 1:
            if named and present(given[0].type).name == "dict":
                raise UnportableError("a mapping has no order in C++")
            source = items(given[0])
            item_type, text = inside(source.type), source.text()
        else:
            item_type = joined([term.type for term in given])
            array = Type("array", (item_type, len(given)))
            inner = ", ".join(term.spell(item_type).text for term in given)
            text = f"{cpp(array)}{{{{{inner}}}}}"
        _check_order(item_type, named)
        return fixed(item_type, call(name, text, *(key.text() for key in named.values())))

    return made


def _check_order(item_type: Type, named: Named) -> None:
    key = inside(named["key"].type) if "key" in named else item_type
    if "key" in named and named["key"].type.name != "function":
        raise UnportableError("`key` must be a lambda")
    if not orderable(key):
        raise UnportableError(f"values of the type `{shown(key)}` have no order")


def _range(given: list[Term], named: Named) -> Term:
    _no_names(named)
    if not 1 <= len(given) <= 3 or any(number(term.type) != INT for term in given):
        raise UnportableError("`range` takes one to three integers")
    return fixed(RANGE, call("range", *(whole(term).text for term in given)))


def _round(given: list[Term], named: Named) -> Term:
    _no_names(named, "ndigits")
    number_, *rest = [*given, *named.values()]
    kind = number(number_.type)
    if kind is None or len(rest) > 1:
        raise UnportableError("`round` takes a number and optionally a number of digits")
    if not rest or (rest[0].constant is None and rest[0].type.name == "none"):
        return fixed(INT, call("round", real(number_).text)) if kind != INT else _int(given[:1], {})
    digits = rest[0].constant
    if not isinstance(digits, int) or isinstance(digits, bool) or not 0 <= digits <= 1000:
        raise UnportableError("the number of digits must be a constant from 0 to 1000")
    if kind == INT:
        return _int(given[:1], {})
    return fixed(kind, hosted_call("round", real(number_).text, str(digits)))


def _sorted(given: list[Term], named: Named) -> Term:
    _no_names(named, "key", "reverse")
    only = _only(given, {})
    if named and present(only.type).name == "dict" and "key" in named:
        raise UnportableError("a mapping has no order in C++")
    source = items(only)
    _check_order(inside(source.type), {k: v for k, v in named.items() if k == "key"})
    last: list[str] = []
    if named:
        reverse = named.get("reverse", literal(False))
        if reverse.type != BOOL:
            raise UnportableError("`reverse` must be a `bool`")
        last = [reverse.text()]
    last += [named["key"].text()] if "key" in named else []
    return fixed(Type("list", (inside(source.type),)), call("sorted", source.text(), *last))


def _str(given: list[Term], named: Named) -> Term:
    if not given:
        return literal("")
    only = _only(given, named)
    kind = present(only.type)
    if kind == STR and only.type == STR:
        return only
    if has(only.type, "number"):
        raise UnportableError("Python prints integers and floats differently: write `float(...)`")
    if kind.name not in ("bool", "int", "float", "str", "never") and not _prints_alike(kind):
        raise UnportableError(f"C++ cannot print `{shown(only.type)}` as Python does")
    return fixed(STR, call("text", only.text()))


def _prints_alike(type_: Type) -> bool:
    """Whether C++ prints the same `repr`: strings would need Unicode tables, mappings an order."""
    if type_.name in ("list", "array", "optional"):
        return _prints_alike(inside(type_))
    return type_.name in ("bool", "int", "float", "none", "never")


def _sum(given: list[Term], named: Named) -> Term:
    _no_names(named, "start")
    if len(given) + len(named) not in (1, 2) or not given:
        raise UnportableError("`sum` takes a list and optionally a start value")
    source = items(given[0])
    kind = number(inside(source.type))
    if inside(source.type).name == "never":
        kind = INT
    start = [*given[1:], *named.values()]
    if kind is None or inside(source.type).name == "optional":
        raise UnportableError(
            f"values of the type `{shown(inside(source.type))}` have no sum in C++"
        )
    if not start:
        # The sum of no floats is the whole number 0.
        empty = kind == FLOAT and size_of(source.type) is None
        return fixed(NUMBER if empty else kind, call("sum", source.text()))
    first = number(start[0].type)
    if first is None:
        raise UnportableError(f"the start value is `{shown(start[0].type)}`, not a number")
    if start[0].type.name == "optional":
        raise UnportableError("the start value may be None, which is then the sum of no items")
    if present(start[0].type) == BOOL:
        raise UnportableError("the start value is a truth value, which is then the sum of no items")
    type_ = first if kind == first else NUMBER
    if FLOAT in (first,) or (kind == FLOAT and size_of(source.type) is not None):
        type_ = FLOAT
    return fixed(type_, call("sum", source.text(), start[0].present()))


FUNCTIONS: Mapping[str, Callable[[list[Term], Named], Term]] = {
    "abs": _abs,
    "bool": _bool,
    "dict": _dict,
    "float": _float,
    "int": _int,
    "len": _len,
    "list": _list,
    "max": _extreme("max_of"),
    "min": _extreme("min_of"),
    "range": _range,
    "round": _round,
    "sorted": _sorted,
    "str": _str,
    "sum": _sum,
    "tuple": lambda given, named: _list(given, named, "tuple"),
}
"""The same functions as in interpreter/evaluator.py."""

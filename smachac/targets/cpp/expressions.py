"""Portable expressions as C++17, with the value that Python gives them, or the reason why not.

What Python raises an exception for is a `smachac::Error` in C++, and so are whole numbers beyond 64
bits. The functions of Python are those of smachac/values.hpp.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from smachac.diagnostics.source import assert_never
from smachac.ir.expressions import (
    Attribute,
    Binary,
    Boolean,
    Call,
    Compare,
    Conditional,
    Constant,
    DictDisplay,
    Expr,
    Index,
    Lambda,
    ListDisplay,
    Name,
    TupleDisplay,
    Unary,
    dotted,
    parse_expression,
    print_expression,
)
from smachac.ir.types import Type
from smachac.targets.cpp import builtin_functions, literals, operators
from smachac.targets.cpp.terms import (
    AND,
    BOOL,
    EQUALITY,
    OR,
    POSTFIX,
    SIGNED,
    TERNARY,
    Term,
    Text,
    call,
    fixed,
    ground,
    has,
    join,
    joined,
    literal,
    present,
    shown,
)
from smachac.targets.cpp.types import FIELDS, FLOAT, INT, NONE, UnportableError, plain


@dataclass(frozen=True, slots=True, kw_only=True)
class Spelling:
    """How C++ spells a name of an expression, and the type of what it stands for."""

    text: str
    type: Type


@dataclass(frozen=True, slots=True, kw_only=True)
class Printed:
    """An expression in C++: a full expression that fits an initializer, and its type."""

    text: str
    type: Type


def cpp_expression(
    expr: Expr, names: Mapping[str, Spelling], wanted: Type | None = None
) -> Printed:
    """An expression over names, as a value of the wanted type or else of its own.

    A name may be dotted: `{"ud.n": Spelling(text="in.n", type=INT)}`. The text belongs into a
    function: lambdas in it capture by reference. Raises UnportableError.
    """
    term = lowered(expr, names)
    try:
        type_ = ground(term.type) if wanted is None else plain(wanted)
        return Printed(text=term.spell(type_).text, type=type_)
    except UnportableError as error:
        raise _told(expr, error) from error


def cpp_condition(expr: Expr, names: Mapping[str, Spelling]) -> str:
    """The truth of an expression over names. Raises UnportableError."""
    try:
        return condition(lowered(expr, names)).text
    except UnportableError as error:
        raise _told(expr, error) from error


def lowered(expr: Expr, names: Mapping[str, Spelling]) -> Term:
    """An expression over names as a term (see terms.py). Raises UnportableError."""
    return _term(expr, _Scope(names=names))


PORTABLE = "docs/cpp.md lists the expressions it knows; for other code write a class"


def cpp_function(code: str, keys: Mapping[str, Spelling]) -> tuple[Expr, dict[str, Spelling]]:
    """The body of a function of the script over userdata, and the names in it, for the functions
    above: a lambda, or an expression over `ud` or `userdata`. Raises UnportableError."""
    tree = parse_expression(code)
    if tree is None:
        error = UnportableError(f"`{code}` is Python code, not a portable expression")
        error.help = PORTABLE
        raise error
    parameters: tuple[str, ...] = ("ud", "userdata")
    if isinstance(tree, Lambda):
        parameters = (tree.parameter,) if tree.parameter else ()
        tree = tree.body
    name = dotted(tree)
    if name is not None and name.split(".")[0] not in parameters:
        error = UnportableError(f"`{name}` is a name of Python code, which C++ does not know")
        error.help = PORTABLE
        raise error
    return tree, {f"{p}.{key}": spelling for p in parameters for key, spelling in keys.items()}


def _told(expr: Expr, error: UnportableError) -> UnportableError:
    """A reason with the part of the expression that it is about."""
    if error.told:
        return error
    told = UnportableError(f"`{print_expression(expr)}`: {error}")
    told.told, told.help = True, error.help
    return told


@dataclass(frozen=True, slots=True, kw_only=True)
class _Scope:
    """The names known, and numbers for the names that C++ needs of its own."""

    names: Mapping[str, Spelling]
    numbers: Iterator[int] = field(default_factory=lambda: itertools.count(1))

    def with_parameter(self, name: str, spelling: Spelling) -> _Scope:
        """The names inside a lambda; what its parameter hides is gone."""
        others = {key: each for key, each in self.names.items() if key.partition(".")[0] != name}
        return replace(self, names={**others, name: spelling})


def _term(expr: Expr, scope: _Scope) -> Term:
    """An expression as a term; a reason that C++ cannot say it names the innermost part."""
    try:
        found = _form(expr, scope)
    except UnportableError as error:
        raise _told(expr, error) from error
    if has(found.type, "any"):
        raise _told(expr, UnportableError("of this no type is known: declare that of its key"))
    return found


def _form(expr: Expr, scope: _Scope) -> Term:
    match expr:
        case Constant(value):
            return literal(value)
        case Name() | Attribute():
            return _name(expr, scope)
        case Index(value, index):
            return _index(value, index, scope)
        case Call(function, arguments, keywords):
            return _call(function, arguments, keywords, scope)
        case Lambda():
            raise UnportableError("a function is no value in C++")
        case Conditional(test, then, otherwise):
            return _conditional(*(_term(part, scope) for part in (test, then, otherwise)))
        case ListDisplay(items):
            return literals.listed([_term(item, scope) for item in items], "array")
        case TupleDisplay(items):
            return literals.listed([_term(item, scope) for item in items], "tuple")
        case DictDisplay(entries):
            return literals.mapped([(_term(k, scope), _term(v, scope)) for k, v in entries])
        case Unary("-", Constant(int() | float() as value)):
            return literal(-value)
        case Unary("not", operand):
            text = Text(f"!{condition(_term(operand, scope)).at(SIGNED)}", SIGNED)
            return fixed(BOOL, text)
        case Unary(sign, operand):
            return operators.signed(sign, _term(operand, scope))
        case Binary(word, left, right):
            return operators.binary(word, _term(left, scope), _term(right, scope))
        case Compare(first, rest):
            operands = [(word, _term(operand, scope)) for word, operand in rest]
            return fixed(BOOL, _chain(_term(first, scope), operands, scope))
        case Boolean(word, operands):
            return _boolean(word, [_term(operand, scope) for operand in operands], scope)
    return assert_never(expr)


def _name(expr: Name | Attribute, scope: _Scope) -> Term:
    text = dotted(expr)
    if text is not None and text in scope.names:
        spelling = scope.names[text]
        return fixed(plain(spelling.type), Text(spelling.text), simple=True)
    match expr:
        case Attribute(value, name) if not isinstance(value, Name) or value.name in scope.names:
            owner = _term(value, scope)
            return _member(owner, name)
    raise UnportableError("this is not known here")


def _member(owner: Term, name: str) -> Term:
    fields = FIELDS.get(present(owner.type).name, {})
    if name not in fields:
        raise UnportableError(f"a `{shown(owner.type)}` has no `{name}`")
    value = owner.spell(present(owner.type)).at(POSTFIX)
    return fixed(fields[name], Text(f"{value}.{name}"), simple=owner.simple)


def _index(value: Expr, index: Expr, scope: _Scope) -> Term:
    if isinstance(value, Name) and value.name not in scope.names and isinstance(index, Constant):
        key = f"{value.name}.{index.value}"
        if isinstance(index.value, str) and key in scope.names:
            return _name(Attribute(value, index.value), scope)
    owner, place = _term(value, scope), _term(index, scope)
    kind = present(owner.type)
    fields = list(FIELDS.get(kind.name, {}))
    match kind.name, place.constant:
        case (("PoseStamped" | "JointState"), str(name)):
            return _member(owner, name)
        case (("Point" | "Quaternion" | "Pose" | "Transform"), int(at)) if (
            -len(fields) <= at < len(fields)
        ):
            return _member(owner, fields[at])
    return builtin_functions.item(owner, place)


def _call(
    function: Expr,
    arguments: tuple[Expr, ...],
    keywords: tuple[tuple[str, Expr], ...],
    scope: _Scope,
) -> Term:
    name = dotted(function)
    if name is None or name not in builtin_functions.FUNCTIONS or name in scope.names:
        known = ", ".join(builtin_functions.FUNCTIONS)
        error = UnportableError("C++ knows no such function")
        error.help = f"it knows {known}"
        raise error
    given = [_term(argument, scope) for argument in arguments]
    named: dict[str, Term] = {}
    for key, value in keywords:
        if isinstance(value, Lambda):
            item = builtin_functions.item_of(given)
            named[key] = _function(value, item, scope)
        else:
            named[key] = _term(value, scope)
    return builtin_functions.FUNCTIONS[name](given, named)


def _function(function: Lambda, item: Type, scope: _Scope) -> Term:
    """A function of one item of a list."""
    if function.parameter is None:
        raise UnportableError("a key is a function of an item")
    name = f"item_{next(scope.numbers)}"
    inner = scope.with_parameter(function.parameter, Spelling(text=name, type=item))
    body = _term(function.body, inner)
    value = body.text()
    unused = "" if re.search(rf"\b{name}\b", value) else "[[maybe_unused]] "
    text = f"[&]({unused}const auto &{name}) {{ return {value}; }}"
    return Term(type=Type("function", (body.type,)), spell=lambda wanted: Text(text))


# Truth and choice


def condition(term: Term) -> Text:
    """The text of a term's truth."""
    if term.test is not None:
        return term.test
    if term.type == BOOL:
        return term.spell(BOOL)
    if isinstance(term.constant, int | float | str) or term.type == NONE:
        return Text("true" if term.constant else "false")
    if term.simple and term.type in (INT, FLOAT):
        return Text(f"{term.text(EQUALITY + 1)} != {'0' if term.type == INT else '0.0'}", EQUALITY)
    return call("truth", term.text())


def _conditional(test: Term, then: Term, otherwise: Term) -> Term:
    chosen = condition(test)

    def spell(wanted: Type) -> Text:
        return _choice(chosen, then.spell(wanted), otherwise.spell(wanted))

    return Term(type=join(then.type, otherwise.type), spell=spell)


def _choice(test: Text, one: Text, other: Text) -> Text:
    first, second = one.at(OR), other.at(OR)
    if first.lstrip("-").isdigit() and second.lstrip("-").isdigit():
        # Two literals would make it an int, and not a whole number of 64 bits.
        first = f"std::int64_t{{{first}}}"
    return Text(f"{test.at(OR)} ? {first} : {second}", TERNARY)


def _both(one: Text, other: Text) -> Text:
    return Text(f"{one.at(AND)} && {other.at(AND)}", AND)


def _boolean(word: str, operands: list[Term], scope: _Scope) -> Term:
    """`and`, `or`: of truth values their junction, else the operand that settles it."""
    sign, own = ("||", OR) if word == "or" else ("&&", AND)
    # g++ warns of `&&` in `||` without brackets.
    test = Text(f" {sign} ".join(condition(each).at(AND + (own == OR)) for each in operands), own)
    *first, last = operands
    type_ = joined([*(present(e.type) if word == "or" else e.type for e in first), last.type])
    names = [f"value_{next(scope.numbers)}" for _ in first]

    def spell(wanted: Type) -> Text:
        if type_ == BOOL:
            return converted_bool(test, wanted)
        text = last.spell(wanted)
        for term, name in zip(reversed(first), reversed(names), strict=True):
            text = _settled(word, term, name, text, wanted)
        return text

    return Term(type=type_, spell=spell, test=test)


def converted_bool(test: Text, wanted: Type) -> Text:
    return fixed(BOOL, test).spell(wanted)


def _settled(word: str, term: Term, name: str, rest: Text, wanted: Type) -> Text:
    """The term where it settles an `and` or `or`, else the rest."""
    if word == "or" and term.type == NONE:
        return rest
    bound = term if term.simple else fixed(term.type, Text(name), simple=True)
    taken = bound.spell(wanted)
    one, other = (taken, rest) if word == "or" else (rest, taken)
    text = _choice(condition(bound), one, other)
    return text if term.simple else bind(term, name, text)


def bind(term: Term, name: str, text: Text) -> Text:
    """A text in which a name stands for a term that is computed once."""
    return call("with", term.text(), f"[&](const auto &{name}) {{ return {text.text}; }}")


def _chain(left: Term, rest: list[tuple[str, Term]], scope: _Scope) -> Text:
    """`a < b < c`: `b` is computed once, `c` where `a < b`."""
    (word, right), *others = rest
    if not others:
        return operators.compare(word, left, right)
    if right.simple:
        return _both(operators.compare(word, left, right), _chain(right, others, scope))
    name = f"value_{next(scope.numbers)}"
    bound = fixed(right.type, Text(name), simple=True)
    text = _both(operators.compare(word, left, bound), _chain(bound, others, scope))
    return bind(right, name, text)

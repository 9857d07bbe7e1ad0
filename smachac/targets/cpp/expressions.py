"""Portable expressions in C++17, with the values that they have in Python.

Where Python raises an exception, C++ throws a `smachac::Error`; so does an integer beyond 64 bits.
The operations and functions of Python are in smachac/values.hpp. An expression that C++ cannot
express raises UnportableError.
"""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator, Mapping

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
from smachac.ir.python_code import parse_code
from smachac.ir.types import Type
from smachac.records import dataclass, field, replace
from smachac.targets.cpp import builtin_functions, literals, operators
from smachac.targets.cpp.dialect import BLOCKING, STEPPED, Dialect
from smachac.targets.cpp.literals import stored
from smachac.targets.cpp.terms import (
    AND,
    BOOL,
    EQUALITY,
    OR,
    POSTFIX,
    SIGNED,
    TERNARY,
    CppText,
    Term,
    call,
    converted,
    fixed,
    ground,
    has,
    join,
    joined,
    literal,
    present,
    shown,
)
from smachac.targets.cpp.types import (
    FIELDS,
    FLOAT,
    INT,
    LISTED,
    NONE,
    UnportableError,
    plain,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Spelling:
    """The C++ text for a name of an expression, and the type of its value."""

    text: str
    type: Type


@dataclass(frozen=True, slots=True, kw_only=True)
class Printed:
    """An expression in C++: a full expression that fits an initializer, and its type.

    `uses_names`: it reads one of the names that it was given. `may_fail`: it can leave a fault in
    the context of a stepped machine.
    """

    text: str
    type: Type
    uses_names: bool
    may_fail: bool = False


def cpp_expression(
    expr: Expr,
    names: Mapping[str, Spelling],
    wanted: Type | None = None,
    dialect: Dialect = BLOCKING,
) -> Printed:
    """An expression over names, as a value of the wanted type or else of its own.

    A name may be dotted: `{"ud.n": Spelling(text="in.n", type=INT)}`. The text belongs into a
    function: lambdas in it capture by reference. Raises UnportableError.
    """
    inner = _KnownNames(spellings=names)
    term = _term(expr, inner)
    try:
        type_ = ground(term.type) if wanted is None else plain(wanted)
        text = term.spell(type_).text
        return _printed(text, type_, inner, dialect)
    except UnportableError as error:
        raise _located(expr, error) from error


def cpp_bounded(expr: Expr, names: Mapping[str, Spelling], wanted: Type) -> Printed:
    """An expression in a stepped machine, as a value that `put` stores in a key; `wanted` is the
    type of the key without bounds. Raises UnportableError."""
    inner = _KnownNames(spellings=names)
    term = _term(expr, inner)
    try:
        return _printed(stored(term, wanted), wanted, inner, STEPPED)
    except UnportableError as error:
        raise _located(expr, error) from error


def cpp_condition(
    expr: Expr, names: Mapping[str, Spelling], dialect: Dialect = BLOCKING
) -> Printed:
    """The truth of an expression over names. Raises UnportableError."""
    inner = _KnownNames(spellings=names)
    term = _term(expr, inner)
    try:
        return _printed(condition(term).text, BOOL, inner, dialect)
    except UnportableError as error:
        raise _located(expr, error) from error


def _printed(text: str, type_: Type, names: _KnownNames, dialect: Dialect) -> Printed:
    """The text of an expression without marks. Raises UnportableError."""
    return Printed(
        text=dialect.resolved(text),
        type=type_,
        uses_names=names.reads_any(),
        may_fail=dialect.may_fail(text),
    )


def lowered(expr: Expr, names: Mapping[str, Spelling]) -> Term:
    """An expression over names as a term (see terms.py). Raises UnportableError."""
    return _term(expr, _KnownNames(spellings=names))


PORTABLE = "use an expression that `smachac docs cpp` lists, or write a class for the state"


def cpp_function(code: str, keys: Mapping[str, Spelling]) -> tuple[Expr, dict[str, Spelling]]:
    """The body of a function of the script over userdata, and the names in it, for the functions
    above: a lambda, or an expression over `ud` or `userdata`. Raises UnportableError."""
    tree = parse_expression(code)
    if tree is None:
        message = f"`{code}` is Python code, not a portable expression"
        raise UnportableError(message, code, help=_portable_none(code) or PORTABLE)
    parameters: tuple[str, ...] = ("ud", "userdata")
    if isinstance(tree, Lambda):
        parameters = (tree.parameter,) if tree.parameter else ()
        tree = tree.body
    name = dotted(tree)
    if name is not None and name.split(".")[0] not in parameters:
        message = f"`{name}` is defined in Python only"
        raise UnportableError(message, name, help=PORTABLE)
    return tree, {f"{p}.{key}": spelling for p in parameters for key, spelling in keys.items()}


def _portable_none(code: str) -> str | None:
    """The help for code that is portable with `== None` for `is None`."""
    try:
        tree = parse_code(code.strip())
    except SyntaxError:
        return None
    words = None
    for node in ast.walk(tree):
        if not isinstance(node, ast.Compare):
            continue
        for at, (sign, right) in enumerate(zip(node.ops, node.comparators, strict=True)):
            new = _WITHOUT_IS.get(type(sign))
            if new is not None and isinstance(right, ast.Constant) and right.value is None:
                node.ops[at] = new()
                words = "`== None`" if new is ast.Eq else "`!= None`"
    text = ast.unparse(tree)
    if words is None or parse_expression(text) is None:
        return None
    return f"compare with {words}: `{text}`"


_WITHOUT_IS: dict[type[ast.cmpop], type[ast.cmpop]] = {ast.Is: ast.Eq, ast.IsNot: ast.NotEq}


def _located(expr: Expr, error: UnportableError) -> UnportableError:
    """An error whose message names the part of the expression; the innermost part is kept."""
    if error.names:
        return error
    part = print_expression(expr)
    return UnportableError(f"`{part}`: {error}", part, help=error.help)


@dataclass(frozen=True, slots=True, kw_only=True)
class _KnownNames:
    """The names known in a part of an expression, and the state of one translation.

    `numbers` are for the variables that only C++ needs. `read` holds the spellings of the names
    that stand in the text made so far.
    """

    spellings: Mapping[str, Spelling]
    numbers: Iterator[int] = field(default_factory=lambda: itertools.count(1))
    read: set[str] = field(default_factory=set)

    def with_parameter(self, name: str, spelling: Spelling) -> _KnownNames:
        """The names inside a lambda: its parameter hides names of the same root."""
        others = {
            key: spelling
            for key, spelling in self.spellings.items()
            if key.partition(".")[0] != name
        }
        return replace(self, spellings={**others, name: spelling})

    def reads_any(self) -> bool:
        return any(spelling.text in self.read for spelling in self.spellings.values())

    def term(self, name: str) -> Term:
        """A name as a term; it counts as read where its text is made."""
        spelling = self.spellings[name]
        type_ = plain(spelling.type)

        def spell(wanted: Type) -> CppText:
            self.read.add(spelling.text)
            return converted(CppText(spelling.text), type_, wanted)

        return Term(type=type_, spell=spell, simple=True)


def _term(expr: Expr, names: _KnownNames) -> Term:
    """An expression as a term; a reason that C++ cannot express it names the innermost part."""
    before = set(names.read)
    try:
        found = _form(expr, names)
    except UnportableError as error:
        raise _located(expr, error) from error
    if has(found.type, "any"):
        unknown = UnportableError("the type is unknown", help="declare the types of the keys")
        raise _located(expr, unknown)
    if found.constant is not None:
        # A constant does not contain the text that it was computed from.
        names.read.intersection_update(before)
    return found


def _form(expr: Expr, names: _KnownNames) -> Term:
    match expr:
        case Constant(value):
            return literal(value)
        case Name() | Attribute():
            return _name(expr, names)
        case Index(value, index):
            return _index(value, index, names)
        case Call(function, arguments, keywords):
            return _call(function, arguments, keywords, names)
        case Lambda():
            raise UnportableError("a function is not a value in C++")
        case Conditional(test, then, otherwise):
            return _conditional(*(_term(part, names) for part in (test, then, otherwise)))
        case ListDisplay(items):
            return literals.listed([_term(item, names) for item in items], "array")
        case TupleDisplay(items):
            return literals.listed([_term(item, names) for item in items], "tuple")
        case DictDisplay(entries):
            return literals.mapped([(_term(k, names), _term(v, names)) for k, v in entries])
        case Unary("-", Constant(int() | float() as value)):
            return literal(-value)
        case Unary("not", operand):
            text = CppText(f"!{condition(_term(operand, names)).at(SIGNED)}", SIGNED)
            return fixed(BOOL, text)
        case Unary(sign, operand):
            return operators.signed(sign, _term(operand, names))
        case Binary(word, left, right):
            return operators.binary(word, _term(left, names), _term(right, names))
        case Compare(first, rest):
            operands = [(word, _term(operand, names)) for word, operand in rest]
            return fixed(BOOL, _chain(_term(first, names), operands, names))
        case Boolean(word, operands):
            return _boolean(word, [_term(operand, names) for operand in operands], names)
    return assert_never(expr)


def _name(expr: Name | Attribute, names: _KnownNames) -> Term:
    text = dotted(expr)
    if text is not None and text in names.spellings:
        return names.term(text)
    match expr:
        case Attribute(value, name) if not isinstance(value, Name) or value.name in names.spellings:
            owner = _term(value, names)
            fields = list(FIELDS.get(present(owner.type).name, {}))
            if name in fields:
                listed = present(owner.type).name in LISTED
                raise UnportableError(
                    f"the value is a {'list' if listed else 'mapping'} in Python,"
                    f" which has no field `{name}`",
                    help=f"write `[{fields.index(name) if listed else repr(name)}]` for `.{name}`",
                )
            return _member(owner, name)
    raise UnportableError("this name is not defined here")


def _member(owner: Term, name: str) -> Term:
    fields = FIELDS.get(present(owner.type).name, {})
    if name not in fields:
        raise UnportableError(f"`{shown(owner.type)}` has no field `{name}`")
    value = owner.spell(present(owner.type)).at(POSTFIX)
    return fixed(fields[name], CppText(f"{value}.{name}"), simple=owner.simple)


def _index(value: Expr, index: Expr, names: _KnownNames) -> Term:
    if (
        isinstance(value, Name)
        and value.name not in names.spellings
        and isinstance(index, Constant)
    ):
        key = f"{value.name}.{index.value}"
        if isinstance(index.value, str) and key in names.spellings:
            return _name(Attribute(value, index.value), names)
    owner, place = _term(value, names), _term(index, names)
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
    names: _KnownNames,
) -> Term:
    name = dotted(function)
    if name is None or name not in builtin_functions.FUNCTIONS or name in names.spellings:
        known = ", ".join(builtin_functions.FUNCTIONS)
        raise UnportableError("unknown function", help=f"use one of the functions {known}")
    given = [_term(argument, names) for argument in arguments]
    named: dict[str, Term] = {}
    for key, value in keywords:
        if isinstance(value, Lambda):
            item = builtin_functions.item_of(given)
            named[key] = _function(value, item, names)
        else:
            named[key] = _term(value, names)
    return builtin_functions.FUNCTIONS[name](given, named)


def _function(function: Lambda, item: Type, names: _KnownNames) -> Term:
    """A function of one item of a list."""
    if function.parameter is None:
        raise UnportableError("`key` must be a function of one item")
    name = f"item_{next(names.numbers)}"
    inner = names.with_parameter(function.parameter, Spelling(text=name, type=item))
    body = _term(function.body, inner)
    value = body.text()
    unused = "" if name in names.read else "[[maybe_unused]] "
    text = f"[&]({unused}const auto &{name}) {{ return {value}; }}"
    return Term(type=Type("function", (body.type,)), spell=lambda wanted: CppText(text))


# Truth values and choices


def condition(term: Term) -> CppText:
    """The text of a term's truth."""
    if term.test is not None:
        return term.test
    if term.type == BOOL:
        return term.spell(BOOL)
    if isinstance(term.constant, int | float | str) or term.type == NONE:
        return CppText("true" if term.constant else "false")
    if term.simple and term.type in (INT, FLOAT):
        return CppText(
            f"{term.text(EQUALITY + 1)} != {'0' if term.type == INT else '0.0'}", EQUALITY
        )
    return call("truth", term.text())


def _conditional(test: Term, then: Term, otherwise: Term) -> Term:
    chosen = condition(test)

    def spell(wanted: Type) -> CppText:
        return _choice(chosen, then.spell(wanted), otherwise.spell(wanted))

    return Term(type=join(then.type, otherwise.type), spell=spell)


def _choice(test: CppText, one: CppText, other: CppText) -> CppText:
    first, second = one.at(OR), other.at(OR)
    if one.digits and other.digits:
        # Two literals would make it an int, and not a whole number of 64 bits.
        first = f"std::int64_t{{{first}}}"
    return CppText(f"{test.at(OR)} ? {first} : {second}", TERNARY)


def _both(one: CppText, other: CppText) -> CppText:
    return CppText(f"{one.at(AND)} && {other.at(AND)}", AND)


def _boolean(word: str, operands: list[Term], names: _KnownNames) -> Term:
    """`and`, `or`: of truth values a truth value, else the operand that decides the result."""
    sign, own = ("||", OR) if word == "or" else ("&&", AND)
    # g++ warns of `&&` in `||` without brackets.
    test = CppText(
        f" {sign} ".join(condition(operand).at(AND + (own == OR)) for operand in operands), own
    )
    *first, last = operands
    type_ = joined([*(present(e.type) if word == "or" else e.type for e in first), last.type])
    variables = [f"value_{next(names.numbers)}" for _ in first]

    def spell(wanted: Type) -> CppText:
        if type_ == BOOL:
            return converted_bool(test, wanted)
        text = last.spell(wanted)
        for term, name in zip(reversed(first), reversed(variables), strict=True):
            text = _settled(word, term, name, text, wanted)
        return text

    return Term(type=type_, spell=spell, test=test)


def converted_bool(test: CppText, wanted: Type) -> CppText:
    return fixed(BOOL, test).spell(wanted)


def _settled(word: str, term: Term, name: str, rest: CppText, wanted: Type) -> CppText:
    """The term where it decides an `and` or `or`, else the rest."""
    if word == "or" and term.type == NONE:
        return rest
    bound = term if term.simple else fixed(term.type, CppText(name), simple=True)
    taken = bound.spell(wanted)
    one, other = (taken, rest) if word == "or" else (rest, taken)
    text = _choice(condition(bound), one, other)
    return text if term.simple else bind(term, name, text)


def bind(term: Term, name: str, text: CppText) -> CppText:
    """A text that uses a name for a term, which is evaluated once."""
    return call("with", term.text(), f"[&](const auto &{name}) {{ return {text.text}; }}")


def _chain(left: Term, rest: list[tuple[str, Term]], names: _KnownNames) -> CppText:
    """`a < b < c`: `b` is evaluated once, `c` only if `a < b`."""
    (word, right), *others = rest
    if not others:
        return operators.compare(word, left, right)
    if right.simple:
        return _both(operators.compare(word, left, right), _chain(right, others, names))
    name = f"value_{next(names.numbers)}"
    bound = fixed(right.type, CppText(name), simple=True)
    text = _both(operators.compare(word, left, bound), _chain(bound, others, names))
    return bind(right, name, text)

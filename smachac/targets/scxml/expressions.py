"""Portable expressions in JavaScript, with the values that they have in Python.

JavaScript has one type of numbers and other rules for truth, equality and order. Where the types of
the operands are known and both languages agree, the operator of JavaScript is printed; elsewhere a
function of functions.js. Integers beyond 53 bits are an error when they occur, never another value.
What has no equal meaning raises UnsupportedError.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence

from smachac.analysis.expression_types import body_of, type_of
from smachac.analysis.type_lattice import BOOL, NONE, STR, item_of, mapping, plain, present
from smachac.diagnostics.source import assert_never
from smachac.interpreter.evaluator import EvaluationError, evaluate
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
    parts,
    print_expression,
)
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field, replace

LARGEST = 2**53 - 1
"""The largest integer that JavaScript represents exactly, with all below it."""

SMALL = 10**6
"""The largest constant whose addition needs no test of the sum: a counter does not reach 2**53."""

RESERVED = frozenset([
    "arguments", "await", "break", "case", "catch", "class", "const", "continue", "debugger",
    "default", "delete", "do", "else", "enum", "eval", "export", "extends", "false", "finally",
    "for", "function", "if", "implements", "import", "in", "instanceof", "interface", "let",
    "new", "null", "package", "private", "protected", "public", "return", "static", "super",
    "switch", "this", "throw", "true", "try", "typeof", "undefined", "var", "void", "while",
    "with", "yield",
])  # fmt: skip
"""Words that are no names in JavaScript."""

_NAME = re.compile(r"[A-Za-z_$][A-Za-z0-9_$]*")
_UNPRINTABLE = re.compile("[\x7f-\x9f\u2028\u2029\ud800-\udfff\ufffe\uffff]")

PORTABLE = "compute the value in a state of your own"


class UnsupportedError(Exception):
    """A part of an expression or value that JavaScript cannot express with the same meaning."""

    def __init__(self, message: str, help: str = PORTABLE) -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True, slots=True, kw_only=True)
class Reads:
    """What a function of the script reads: the text and the type of each key by its name. A key
    that is not in `keys` is read by `other`."""

    keys: Mapping[str, tuple[str, Type]]
    other: Callable[[str], str]


def js_string(text: str) -> str:
    """A literal in single quotes, fit for an attribute of XML in double quotes."""
    inner = json.dumps(text, ensure_ascii=False)[1:-1].replace('\\"', '"').replace("'", "\\'")
    inner = _UNPRINTABLE.sub(lambda found: f"\\u{ord(found[0]):04x}", inner)
    return f"'{inner}'"


def js_member(owner: str, key: str) -> str:
    """`owner.key`, or `owner['a key']`."""
    return f"{owner}.{key}" if _NAME.fullmatch(key) else f"{owner}[{js_string(key)}]"


def js_value(data: Data) -> str:
    """A value of the script; code in it must be a constant. Raises UnsupportedError."""
    match data:
        case None:
            return "null"
        case bool():
            return "true" if data else "false"
        case int():
            if abs(data) > LARGEST:
                raise UnsupportedError(f"the integer {data} has more than 53 bits")
            return str(data)
        case float():
            return _real(data)
        case str():
            return js_string(data)
        case tuple():
            return f"[{', '.join(map(js_value, data))}]"
        case Struct(entries=entries):
            return js_object((key, js_value(value)) for key, value in entries)
        case Expression():
            return js_value(_constant(data))
    return assert_never(data)


CONSTANTS: Mapping[str, float] = {
    f"math.{name}": getattr(math, name) for name in ("e", "inf", "nan", "pi", "tau")
}
"""The constants of Python's module `math`."""


def _constant(expression: Expression) -> Data:
    """The value of code that reads nothing. A message, `Point(x=1.0)`, is a mapping of the fields
    that are given, as in the client libraries of ROS for JavaScript."""
    tree = parse_expression(expression.text)
    if tree is None:
        raise UnsupportedError(f"`{expression.text}` is Python code, not a portable expression")
    names: dict[str, object] = {**CONSTANTS}
    todo = [tree]
    while todo:
        part = todo.pop()
        todo += parts(part)
        if isinstance(part, Call) and not part.arguments:
            name = dotted(part.function) or ""
            if name.rpartition(".")[2][:1].isupper():
                names[name] = lambda **fields: fields
    try:
        return _data(evaluate(tree, names))
    except EvaluationError as error:
        raise UnsupportedError(f"`{expression.text}` has no value in JavaScript") from error


def _data(value: object) -> Data:
    """A value of Python as data of a script."""
    match value:
        case None | bool() | int() | float() | str():
            return value
        case list():
            return tuple(map(_data, value))
        case dict() if all(isinstance(key, str) for key in value):
            return Struct(entries=tuple((key, _data(item)) for key, item in value.items()))
    raise UnsupportedError(f"a {type(value).__name__} is not a value that a host receives")


def js_object(entries: object) -> str:
    """An object literal of names and texts of values."""
    found = []
    for key, value in entries:  # type: ignore[attr-defined]
        if key == "__proto__":
            raise UnsupportedError("the key `__proto__` has another meaning in JavaScript")
        plain_name = _NAME.fullmatch(key) and key not in RESERVED
        found.append(f"{key if plain_name else js_string(key)}: {value}")
    return f"{{{', '.join(found)}}}"


def _real(value: float) -> str:
    if value != value:
        return "NaN"
    if abs(value) == float("inf"):
        return "Infinity" if value > 0 else "-Infinity"
    return f"{value:.0f}" if value.is_integer() and abs(value) < SMALL else repr(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Js:
    """A printed expression: its text, its precedence, and its type."""

    text: str
    binding: int = 20
    type: Type = ANY

    def at(self, binding: int) -> str:
        return self.text if self.binding >= binding else f"({self.text})"


# Precedences of JavaScript.
_ARROW, _TEST, _OR, _AND, _EQUAL, _LESS, _SUM, _PRODUCT, _SIGNED, _CALL = (
    *(2, 3, 4, 5, 9, 10, 12, 13, 15, 18),
)


def js_function(expression: Expression, reads: Reads) -> Js:
    """The result of a function of the script. Raises UnsupportedError."""
    tree = parse_expression(expression.text)
    if tree is None:
        raise UnsupportedError(f"`{expression.text}` is Python code, not a portable expression")
    body, parameters = body_of(tree)
    return _Printer(parameters=parameters, reads=reads).print(body)


def js_truth(expression: Expression, reads: Reads) -> str:
    """The truth of the result of a function of the script. Raises UnsupportedError."""
    return _truth(js_function(expression, reads))


def _truth(value: Js) -> str:
    return value.at(_OR) if value.type == BOOL else f"truth({value.text})"


def _name(type_: Type) -> str:
    """The name of the type of a value that is not None."""
    return plain(present(type_)).name


def _is_number(type_: Type) -> bool:
    return plain(type_).name in ("int", "float", "bool")


def _is_whole(type_: Type) -> bool:
    return plain(type_).name in ("int", "bool")


def _call(name: str, *arguments: Js | str, type: Type = ANY) -> Js:
    given = ", ".join(
        argument if isinstance(argument, str) else argument.at(_ARROW) for argument in arguments
    )
    return Js(text=f"{name}({given})", type=type)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Printer:
    """Prints the parts of one function. `parameters` are names of the userdata; `bound` are the
    parameters of the lambdas around a part, with the types of their values."""

    parameters: tuple[str, ...]
    reads: Reads
    bound: Mapping[str, Type] = field(default_factory=dict)

    def print(self, expr: Expr) -> Js:
        type_ = self.type(expr)
        return replace(self._form(expr), type=type_)

    def type(self, expr: Expr) -> Type:
        """The type of a part. `type_of` supposes that the test of a conditional excludes null,
        which JavaScript would take for a number: one with a branch that can be null is `any`."""
        if isinstance(expr, Conditional):
            branches = (expr.then, expr.otherwise)
            if any(self.type(branch).name in ("optional", "any") for branch in branches):
                return ANY
        keys = mapping((key, type_) for key, (_, type_) in self.reads.keys.items())
        return type_of(expr, {**dict.fromkeys(self.parameters, keys), **self.bound})

    def _form(self, expr: Expr) -> Js:
        match expr:
            case Constant(value):
                return Js(text=js_value(value))
            case Name(name) if name in self.bound:
                return Js(text=_parameter(name))
            case Attribute(Name(name), key) | Index(Name(name), Constant(str(key))) if (
                name in self.parameters and name not in self.bound
            ):
                known = self.reads.keys.get(key)
                return Js(text=known[0] if known else self.reads.other(key))
            case Name() | Attribute():
                raise _unsupported(expr, "the name is not defined in JavaScript")
            case Index(value, index):
                place = self.print(index)
                if _name(place.type) == "float" or (
                    place.type == ANY and isinstance(index, Binary | Unary | Conditional | Call)
                ):
                    raise _unsupported(expr, "the place of an item must be an integer or a text")
                return _call("item", self.print(value), place)
            case Call():
                return self._called(expr)
            case Lambda():
                raise _unsupported(expr, "a function is not a value in the data of SCXML")
            case Conditional(test, then, otherwise):
                branches = (self.print(then).at(_TEST), self.print(otherwise).at(_TEST))
                return Js(text=f"{self.truth(test)} ? {' : '.join(branches)}", binding=_TEST)
            case ListDisplay(items):
                return Js(text=f"[{', '.join(self.print(item).at(_ARROW) for item in items)}]")
            case TupleDisplay():
                raise _unsupported(expr, "a tuple is not a list, and JavaScript has only lists")
            case DictDisplay(entries):
                return self._mapping(expr, entries)
            case Unary("not", operand):
                return Js(text=f"!{_bracketed(self.truth(operand))}", binding=_SIGNED)
            case Unary(sign, operand):
                return self._signed(sign, operand)
            case Binary(operator, left, right):
                return self._binary(expr, operator, self.print(left), self.print(right))
            case Compare(first, rest):
                return self._comparison(first, rest)
            case Boolean(operator, operands):
                return self._boolean(operator, operands)
        return assert_never(expr)

    def truth(self, expr: Expr) -> str:
        """The truth of a part; that of `and` and `or` needs no values of their operands."""
        if isinstance(expr, Boolean):
            sign = " && " if expr.operator == "and" else " || "
            return f"({sign.join(self.truth(operand) for operand in expr.operands)})"
        return _truth(self.print(expr))

    def _mapping(self, expr: Expr, entries: Sequence[tuple[Expr, Expr]]) -> Js:
        found = {}
        for key, value in entries:
            if not isinstance(key, Constant) or not isinstance(key.value, str):
                raise _unsupported(expr, "the keys of a mapping must be texts")
            found[key.value] = self.print(value).at(_ARROW)
        return Js(text=f"({js_object(found.items())})")

    def _signed(self, sign: str, operand: Expr) -> Js:
        value = self.print(operand)
        text = value.at(_SIGNED) if _is_number(value.type) else f"number({value.text})"
        return Js(text=f"{sign}{_bracketed(text)}", binding=_SIGNED)

    def _binary(self, expr: Expr, operator: str, left: Js, right: Js) -> Js:
        numbers = _is_number(left.type) and _is_number(right.type)
        integers = _is_whole(left.type) and _is_whole(right.type)
        match operator:
            case "+" | "-" if numbers or (operator == "+" and left.type == right.type == STR):
                text = f"{left.at(_SUM)} {operator} {right.at(_SUM + 1)}"
                if not integers or _is_small(expr):
                    return Js(text=text, binding=_SUM)
                return Js(text=f"whole({text})")
            case "*" if numbers:
                text = f"{left.at(_PRODUCT)} * {right.at(_PRODUCT + 1)}"
                return Js(text=f"whole({text})") if integers else Js(text=text, binding=_PRODUCT)
            case "*" if not _repeats(left, right) and not _repeats(right, left):
                raise _unsupported(expr, "the types of its operands are not known")
            case "%" if plain(left.type) == STR:
                raise _unsupported(expr, "`%` is for numbers here")
            case "**":
                return self._power(expr, left, right)
        return _call(_BINARY[operator], left, right)

    def _power(self, expr: Expr, left: Js, right: Js) -> Js:
        match expr:
            case Binary(_, _, Constant(int(exponent))) if exponent >= 0 and _is_whole(left.type):
                return _call("power", left, right)
            case Binary(_, Name() | Attribute(), Constant(2)) if _name(left.type) == "float":
                text = f"{left.at(_PRODUCT)} * {left.at(_PRODUCT + 1)}"
                return Js(text=text, binding=_PRODUCT)
        raise _unsupported(expr, "the last digit of a power differs between engines")

    def _comparison(self, first: Expr, rest: Sequence[tuple[str, Expr]]) -> Js:
        left, tests = self.print(first), []
        for at, (sign, operand) in enumerate(rest):
            right = self._items(operand) if sign in ("in", "not in") else self.print(operand)
            tests.append(_compared(sign, left, right))
            if at + 1 < len(rest) and not isinstance(operand, Constant | Name | Attribute):
                raise _unsupported(operand, "the middle of a chain of comparisons is computed")
            left = right
        if len(tests) == 1:
            return tests[0]
        return Js(text=" && ".join(test.at(_AND + 1) for test in tests), binding=_AND)

    def _items(self, expr: Expr) -> Js:
        """A value of which only the items are used: it can be a tuple or a range."""
        if isinstance(expr, TupleDisplay):
            return self.print(ListDisplay(expr.items))
        if isinstance(expr, Call) and dotted(expr.function) == "range":
            given = [self.print(argument) for argument in expr.arguments]
            if not expr.keywords and not any(_name(js.type) == "float" for js in given):
                return _call("range", *given, type=self.type(expr))
        return self.print(expr)

    def _boolean(self, operator: str, operands: Sequence[Expr]) -> Js:
        values = [self.print(operand) for operand in operands]
        own = _AND if operator == "and" else _OR
        if all(value.type == BOOL for value in values):
            sign = " && " if operator == "and" else " || "
            return Js(text=sign.join(value.at(own + 1) for value in values), binding=own)
        result = values[-1]
        for value in reversed(values[:-1]):
            chosen = (result.at(_TEST), "it") if operator == "and" else ("it", result.at(_TEST))
            text = f"(it => truth(it) ? {' : '.join(chosen)})({value.at(_ARROW)})"
            result = Js(text=text)
        return result

    def _called(self, expr: Call) -> Js:
        name = dotted(expr.function)
        if name is None or name not in FUNCTIONS or name in self.bound:
            raise _unsupported(expr, "the function is not one of the portable ones")
        given = [self._items(argument) for argument in expr.arguments]
        item = item_of(given[0].type) if len(given) == 1 else ANY
        named = {key: self._argument(value, item) for key, value in expr.keywords}
        floats = len(given) == 1 and _name(given[0].type) == "float"
        if name == "str" and floats and not _is_real(expr.arguments[0]):
            raise _unsupported(expr, "the number can be an integer, which Python prints as one")
        try:
            return FUNCTIONS[name](given, named)
        except (KeyError, ValueError, IndexError):
            raise _unsupported(expr, "these arguments are not supported") from None

    def _argument(self, value: Expr, item: Type) -> Js:
        if not isinstance(value, Lambda):
            return self.print(value)
        name = value.parameter or ""
        bound = {**self.bound, name: item} if name else self.bound
        body = replace(self, bound=bound).print(value.body).at(_TEST)
        body = f"({body})" if body.startswith("{") else body
        return Js(text=f"{_parameter(name) if name else '()'} => {body}", binding=_ARROW)


def _is_real(expr: Expr) -> bool:
    """Whether the value of an expression is a float whatever it reads; a key of the type `float`
    can hold an integer."""
    match expr:
        case Constant(value):
            return isinstance(value, float)
        case Unary(_, operand):
            return _is_real(operand)
        case Binary("/", _, _):
            return True
        case Binary(_, left, right):
            return _is_real(left) or _is_real(right)
        case Conditional(_, then, otherwise):
            return _is_real(then) and _is_real(otherwise)
    return isinstance(expr, Call) and dotted(expr.function) == "float"


def _parameter(name: str) -> str:
    """The parameter of a lambda: no name of a function or of data is one."""
    return re.sub("[^A-Za-z0-9_]", lambda found: f"${ord(found[0]):x}", name) + "$"


def _bracketed(text: str) -> str:
    return text if re.fullmatch(r"[\w.$]+(\([^()]*\))?", text) else f"({text})"


def _unsupported(expr: Expr, reason: str) -> UnsupportedError:
    return UnsupportedError(f"`{print_expression(expr)}`: {reason}")


def _is_small(expr: Expr) -> bool:
    """Whether a sum has a small constant: its result is exact without a test."""
    if not isinstance(expr, Binary):
        return False
    sides = (expr.left, expr.right)
    return any(
        isinstance(s, Constant) and isinstance(s.value, int) and s.value <= SMALL for s in sides
    )


_BINARY = {
    "+": "plus", "-": "minus", "*": "times", "/": "divided", "//": "floored", "%": "remainder",
}  # fmt: skip


def _compared(sign: str, left: Js, right: Js) -> Js:
    numbers = _plain_numbers(left, right)
    same = numbers or left.type == right.type == STR or _literal(left) == _literal(right) == STR
    none = NONE in (left.type, right.type)
    match sign:
        case "==" | "!=" if same or none:
            return Js(text=f"{left.at(_LESS)} {sign}= {right.at(_LESS)}", binding=_EQUAL)
        case "==":
            return _call("equal", left, right)
        case "!=":
            return Js(text=f"!{_call('equal', left, right).text}", binding=_SIGNED)
        case "in":
            return _call("contains", left, right)
        case "not in":
            return Js(text=f"!{_call('contains', left, right).text}", binding=_SIGNED)
        case _ if numbers:
            return Js(text=f"{left.at(_SUM)} {sign} {right.at(_SUM)}", binding=_LESS)
    one, other = (right, left) if sign in (">", ">=") else (left, right)
    return _call("less" if sign in ("<", ">") else "atMost", one, other)


def _repeats(values: Js, times: Js) -> bool:
    """Whether a product is certainly no text or list that is repeated by a float."""
    unknown = values.type == times.type == ANY
    return unknown or (_name(values.type) not in ("int", "float", "bool") and _is_whole(times.type))


def _literal(value: Js) -> Type:
    return plain(value.type)


def _plain_numbers(left: Js, right: Js) -> bool:
    return all(plain(js.type).name in ("int", "float") for js in (left, right))


# Functions. A function raises ValueError for arguments that it does not support.

Named = Mapping[str, Js]


def _one(given: Sequence[Js], named: Named) -> Js:
    if named or len(given) != 1:
        raise ValueError
    return given[0]


def _abs(given: Sequence[Js], named: Named) -> Js:
    value = _one(given, named)
    return _call("Math.abs" if _is_number(value.type) else "absolute", value)


def _float(given: Sequence[Js], named: Named) -> Js:
    value = _one(given, named)
    if _is_whole(value.type):
        return Js(text=f"{value.at(_SUM)} + 0", binding=_SUM)  # no integer is -0
    return value if plain(value.type).name == "float" else _call("real", value)


def _str(given: Sequence[Js], named: Named) -> Js:
    value = _one(given, named)
    match plain(value.type).name:
        case "str":
            return value
        case "int" | "bool" | "none":
            return _call("text", value)
        case "float":
            return _call("realText", value)
    raise UnsupportedError("`str` of a value whose type is not known, or of a list or mapping")


def _round(given: Sequence[Js], named: Named) -> Js:
    return _call("rounded", _one(given, named))


def _sum(given: Sequence[Js], named: Named) -> Js:
    values, *start = [*given, *(named[key] for key in named if key == "start")]
    if len(start) > 1 or set(named) - {"start"}:
        raise ValueError
    return _call("total", values, start[0] if start else "0")


def _extreme(*more: str) -> Callable[[Sequence[Js], Named], Js]:
    def printed(given: Sequence[Js], named: Named) -> Js:
        if set(named) - {"key"} or not given:
            raise ValueError
        values = given[0] if len(given) == 1 else _listed(given)
        key = [named["key"]] if named else ["undefined"] if more else []
        return _call("largest", values, *key, *more)

    return printed


def _listed(given: Sequence[Js]) -> Js:
    return Js(text=f"[{', '.join(js.at(_ARROW) for js in given)}]")


def _sorted(given: Sequence[Js], named: Named) -> Js:
    values = _one(given, {})
    if set(named) - {"key", "reverse"}:
        raise ValueError
    reverse = named.get("reverse", Js(text="false", type=BOOL))
    if reverse.type != BOOL:
        raise ValueError
    more = [reverse] if named else []
    return _call("sorted", values, *more, *([named["key"]] if "key" in named else []))


FUNCTIONS: Mapping[str, Callable[[Sequence[Js], Named], Js]] = {
    "abs": _abs,
    "bool": lambda given, named: Js(text=_truth(_one(given, named))),
    "float": _float,
    "int": lambda given, named: _call("integer", _one(given, named)),
    "len": lambda given, named: _call("size", _one(given, named)),
    "list": lambda given, named: Js(text=f"items({_one(given, named).text}).slice()"),
    "max": _extreme(),
    "min": _extreme("true"),
    "round": _round,
    "sorted": _sorted,
    "str": _str,
    "sum": _sum,
}
"""The portable functions whose results JavaScript can represent. `tuple` and `dict` are missing; a
`range` is accepted only where its items are used."""

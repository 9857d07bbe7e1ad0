"""Evaluation of portable expressions, without Python's `eval`.

Only the given names and a fixed table of functions can be called. Attributes with a leading
underscore, and all attributes of functions, classes, modules and frames, cannot be read. Steps and
sizes are limited, so that no expression can block the program or exhaust its memory.
"""

from __future__ import annotations

import operator
import types
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

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
    parts,
    print_expression,
)

MOST_STEPS = 1_000_000
"""Limit on the nodes that one evaluation visits; a value that is made, compared or given to
a function also counts its size."""

LARGEST = 100_000
"""Limit on the size of a result: items and characters, nested ones included, each as often as it is
reached."""

MOST_BITS = 10_000
"""Limit on the binary digits of an integer."""

CLOSED = (
    types.FunctionType,
    types.BuiltinFunctionType,
    types.MethodType,
    types.ModuleType,
    types.GeneratorType,
    types.CoroutineType,
    types.FrameType,
    types.TracebackType,
    types.CodeType,
    type,
)
"""Types whose attributes cannot be read, because they lead to objects outside the data."""

METHODS = (types.MethodType, types.BuiltinMethodType)
"""Types that an attribute must not have: a function such as `sorted` would call it."""


class EvaluationError(Exception):
    """An expression has no value. The message has the reason; the cause is the exception of
    Python."""


def evaluate(expr: Expr, names: Mapping[str, object]) -> object:
    """The value of an expression. A lambda gives a function that raises the same errors.

    A name may be dotted: `{"math.pi": 3.14}` gives `math.pi` a value without `math`. Raises
    EvaluationError and no other exception.
    """
    return _run(_Evaluation(names, {}, _Budget()), expr)


def can_evaluate(expr: Expr, names: Collection[str]) -> bool:
    """Whether an expression has only names and functions of this module and the given `names`, so
    that `evaluate` fails where Python fails, apart from its limits."""
    known = {*names, *FUNCTIONS}
    todo: list[tuple[Expr, frozenset[str]]] = [(expr, frozenset())]
    while todo:
        current, bound = todo.pop()
        match current:
            case Name(name) if name not in known and name not in bound:
                return False
            case Attribute(_, name) if name.startswith("_"):
                return False
            case Call(function) if dotted(function) not in FUNCTIONS or dotted(function) in bound:
                return False
            case Binary("%", Constant(str()), _):
                return False
            case Lambda(str() as parameter, _):
                bound |= {parameter}
        todo.extend((part, bound) for part in parts(current))
    return True


class _Budget:
    """The remaining steps of an evaluation and of the lambdas it calls; closed when it ends."""

    def __init__(self) -> None:
        self.left = MOST_STEPS
        self.ended = False


def _run(evaluation: _Evaluation, expr: Expr) -> object:
    """Run a whole evaluation and close its budget."""
    try:
        return evaluation.value(expr)
    except RecursionError as error:
        raise EvaluationError("the expression is too deep") from error
    finally:
        evaluation.budget.ended = True


class _Evaluation:
    """The given names, the parameters of the enclosing lambdas, and the step budget."""

    def __init__(self, names: Mapping[str, object], bound: Mapping[str, object], budget: _Budget):
        self.names = names
        self.bound = bound
        self.budget = budget

    def value(self, expr: Expr) -> Any:
        self.spend(1)
        try:
            return self.compute(expr)
        except (EvaluationError, RecursionError):
            raise
        except Exception as error:
            reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
            raise EvaluationError(f"`{print_expression(expr)}` has no value: {reason}") from error

    def spend(self, steps: int) -> None:
        self.budget.left -= steps
        if self.budget.left < 0:
            raise EvaluationError(f"the expression takes more than {MOST_STEPS} steps")

    def sized(self, value: Any) -> Any:
        """A value that was made or is going to be compared; its size is limited, and counts as
        steps."""
        if isinstance(value, SIZED):
            size = _size(value)
            _limit(size, LARGEST, "items")
            self.spend(size)
        elif isinstance(value, int):
            _limit(value.bit_length(), MOST_BITS, "digits")
        return value

    def compute(self, expr: Expr) -> Any:
        match expr:
            case Constant(value):
                return value
            case Name(name):
                return self.look_up(name)
            case Attribute(value, name):
                return self.attribute(expr, value, name)
            case Index(value, index):
                return self.value(value)[self.sized(self.value(index))]
            case Call():
                return self.call(expr)
            case Lambda(parameter, body):
                return self.function(parameter, body)
            case Conditional(test, then, otherwise):
                return self.value(then if self.value(test) else otherwise)
            case ListDisplay(items):
                return self.sized([self.value(item) for item in items])
            case TupleDisplay(items):
                return self.sized(tuple([self.value(item) for item in items]))
            case DictDisplay(entries):
                return self.sized({self.value(key): self.value(value) for key, value in entries})
            case Unary(word, operand):
                return UNARY[word](self.value(operand))
            case Binary(word, left, right):
                return self.sized(self.binary(word, self.value(left), self.value(right)))
            case Compare(first, rest):
                return self.compare(first, rest)
            case Boolean(word, operands):
                return self.boolean(word, operands)
        return assert_never(expr)

    def look_up(self, name: str) -> object:
        if name.startswith("_"):
            raise EvaluationError(f"`{name}`: names with a leading underscore are not for scripts")
        for table in (self.bound, self.names, FUNCTIONS):
            if name in table:
                return table[name]
        raise EvaluationError(f"`{name}` is not defined")

    def attribute(self, expr: Expr, value: Expr, name: str) -> object:
        text = dotted(expr) or ""
        if text in self.names and text.partition(".")[0] not in self.bound:
            return self.names[text]
        owner = self.value(value)
        if name.startswith("_"):
            raise EvaluationError(f"`{name}`: names with a leading underscore are not for scripts")
        if isinstance(owner, CLOSED):
            kind = type(owner).__name__
            raise EvaluationError(f"`{name}`: attributes of a {kind} are not for scripts")
        found = getattr(owner, name)
        if isinstance(found, METHODS):
            raise EvaluationError(f"`{name}`: methods are not for scripts")
        return found

    def call(self, expr: Call) -> object:
        text = dotted(expr.function) or ""
        function = self.names.get(text, FUNCTIONS.get(text))
        if not callable(function) or text.partition(".")[0] in self.bound:
            raise EvaluationError(f"`{print_expression(expr.function)}` is no function known here")
        arguments = [self.value(argument) for argument in expr.arguments]
        keywords = {name: self.value(argument) for name, argument in expr.keywords}
        self.spend(sum(map(_length, arguments)))
        for value in (*arguments, *keywords.values()):
            self.sized(value)
        return self.sized(function(*arguments, **keywords))

    def function(self, parameter: str | None, body: Expr) -> Callable[..., object]:
        wanted = 0 if parameter is None else 1

        def call(*arguments: object) -> object:
            if len(arguments) != wanted:
                raise EvaluationError(f"a lambda of {wanted} arguments got {len(arguments)}")
            bound = self.bound if parameter is None else {**self.bound, parameter: arguments[0]}
            if self.budget.ended:
                return _run(_Evaluation(self.names, bound, _Budget()), body)
            return _Evaluation(self.names, bound, self.budget).value(body)

        return call

    def binary(self, word: str, left: Any, right: Any) -> object:
        if word == "**" and isinstance(left, int) and isinstance(right, int) and abs(left) > 1:
            _limit(left.bit_length() * right, MOST_BITS, "digits")
        elif word == "*" and isinstance(right, SIZED) and isinstance(left, int):
            _limit(left * _size(right), LARGEST, "items")
        elif word == "*" and isinstance(left, SIZED) and isinstance(right, int):
            _limit(right * _size(left), LARGEST, "items")
        elif word == "+" and isinstance(left, SIZED) and isinstance(right, SIZED):
            _limit(_size(left) + _size(right), LARGEST, "items")
        elif word == "%" and isinstance(left, str):
            raise EvaluationError("`%` is for numbers here, not for formatting strings")
        return BINARY[word](left, right)

    def compare(self, first: Expr, rest: tuple[tuple[str, Expr], ...]) -> object:
        left = self.value(first)
        result: object = True
        for place, (word, operand) in enumerate(rest):
            if place and not result:
                break
            right = self.value(operand)
            self.spend(_length(right))
            self.sized(left)
            self.sized(right)
            result = COMPARE[word](left, right)
            left = right
        return result

    def boolean(self, word: str, operands: tuple[Expr, ...]) -> object:
        result: object = None
        for operand in operands:
            result = self.value(operand)
            if bool(result) == (word == "or"):
                break
        return result


SIZED = (str, bytes, list, tuple, dict)
"""Types whose length is limited."""


def _length(value: object) -> int:
    """The number of items or characters of a value, as a number of steps."""
    return len(value) if isinstance(value, (*SIZED, range)) else 1


def _limit(size: int, most: int, what: str) -> None:
    if size > most:
        raise EvaluationError(f"the value would have more than {most} {what}")


def _size(value: Any) -> int:
    """Items and characters in a value and in its parts, counted up to the limit."""
    total = 0
    todo = [value]
    while todo and total <= LARGEST:
        current = todo.pop()
        if isinstance(current, SIZED):
            total += len(current)
        if isinstance(current, (list, tuple)):
            todo.extend(current)
        elif isinstance(current, dict):
            todo.extend(current.keys())
            todo.extend(current.values())
    return total


def _range(*bounds: int) -> range:
    found = range(*bounds)
    _limit(len(found), LARGEST, "items")
    return found


def _round(number: Any, ndigits: int | None = None) -> object:
    _limit(abs(ndigits or 0), 1000, "digits")
    return round(number, ndigits)


def _sum(items: Iterable[Any], start: Any = 0) -> object:
    items = list(items)
    _limit(_size(items) + _size(start), LARGEST, "items")
    return sum(items, start)


UNARY: Mapping[str, Callable[[Any], object]] = {
    "+": operator.pos,
    "-": operator.neg,
    "not": operator.not_,
}

BINARY: Mapping[str, Callable[[Any, Any], object]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "//": operator.floordiv,
    "%": operator.mod,
    "**": operator.pow,
}

COMPARE: Mapping[str, Callable[[Any, Any], object]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "in": lambda left, right: left in right,
    "not in": lambda left, right: left not in right,
}

FUNCTIONS: Mapping[str, Callable[..., object]] = {
    "abs": abs,
    "bool": bool,
    "dict": dict,
    "float": float,
    "int": int,
    "len": len,
    "list": list,
    "max": max,
    "min": min,
    "range": _range,
    "round": _round,
    "sorted": sorted,
    "str": str,
    "sum": _sum,
    "tuple": tuple,
}
"""The functions that every expression may call, as in Python."""

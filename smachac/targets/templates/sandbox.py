"""The sandbox of templates: Jinja's sandbox with a budget for each rendering.

Jinja's sandbox denies access to Python internals. The budget bounds loops and the size of texts.
It is counted in characters: each turn of a loop, each call, the arguments and results of filters
and operators and the output are charged. When the budget is used up, the rendering fails. It does
not depend on time: the same template always fails at the same place.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sized
from functools import partial, wraps
from string import Formatter
from typing import TYPE_CHECKING, Any, TypeVar

from jinja2 import TemplateRuntimeError, Undefined, UndefinedError, nodes
from jinja2.filters import FILTERS
from jinja2.sandbox import SandboxedEnvironment
from jinja2.tests import TESTS
from jinja2.utils import missing
from jinja2.visitor import NodeTransformer

if TYPE_CHECKING:
    from jinja2.runtime import Context

Made = TypeVar("Made", bound=nodes.Node)

BUDGET = 1_000_000
"""The budget of one rendering in characters, beside ten times the size of its variables. A state
needs some thousands."""

CALL = 20
"""The charge for a call, in characters."""

MOST_CALLS_DEEP = 200
"""The maximal nesting of macros, blocks and includes."""

MOST_BITS = 10_000
"""Limit on the binary digits of an integer."""

DEEPEST = 1_000
"""The deepest nesting of a value that is counted; Python prints none that is deeper."""

DROPPED_FILTERS = ("random", "urlize")
"""Filters that would make the output random, or whose cost is not bounded."""

KEPT_GLOBALS = ("range", "dict", "cycler", "joiner", "namespace")

_NUMBER = re.compile(r"\d+")
_TEXTS = (str, bytes, bytearray)
_VIEWS: tuple[type, ...] = (type({}.keys()), type({}.values()), type({}.items()))
_WITHOUT_METHODS = (int, float, complex, bytes, bytearray, memoryview)
"""Types whose methods make values of any size; templates have no use for them."""

_DEEP = frozenset(["literal", "pprint", "tojson"])
"""Filters that copy a text once for each level of a value."""

_SORTING = frozenset(["sort", "dictsort", "groupby", "unique", "min", "max"])
_CHEAP = frozenset(["append", "get", "items", "keys", "values", "pop", "setdefault", "add"])
"""Methods whose cost does not grow with the size of their object."""

PYTHON_2_METHODS = {"iteritems": "items", "itervalues": "values", "iterkeys": "keys"}


class TooMuchError(TemplateRuntimeError):
    """A template exceeds its budget; the message has the reason."""


class UndefinedNameError(UndefinedError):
    """A template uses a variable that is not defined, `undefined_name`."""

    def __init__(self, undefined_name: str, message: str):
        super().__init__(message)
        self.undefined_name = undefined_name


class Missing(Undefined):
    """An undefined name: it may be tested, as in `{% if x %}`, but not printed."""

    __slots__ = ()
    __str__ = Undefined._fail_with_undefined_error

    def __init__(
        self,
        hint: str | None = None,
        obj: Any = missing,
        name: Any = None,
        exc: Any = UndefinedError,
    ):
        if obj is missing and name is not None:
            exc = partial(UndefinedNameError, name)
        super().__init__(hint, obj, name, exc)


class Meter:
    """The remaining budget of one rendering."""

    def __init__(self) -> None:
        self.left = BUDGET
        self.depth = 0

    def begin(self, given: object) -> None:
        """Starts a rendering with these variables."""
        self.left = BUDGET
        self.left += 10 * self.size(given)
        self.depth = 0

    def charge(self, amount: int) -> None:
        self.left -= amount
        if self.left < 0:
            raise TooMuchError("the template does not end, or prints too much text")

    def size(self, value: object) -> int:
        """The size of a value in characters; counting stops when the budget is exceeded."""
        if isinstance(value, (*_TEXTS, range)):
            return len(value)
        if isinstance(value, int):
            return _digits(value)
        if not isinstance(value, (list, tuple, dict, *_VIEWS)):  # objects of the engine
            return 1
        total = 0
        todo: list[Any] = [value]
        while todo and total <= self.left:
            each = todo.pop()
            total += 1
            if isinstance(each, (*_TEXTS, range)):
                total += len(each)
            elif isinstance(each, int):
                total += _digits(each) - 1
            elif isinstance(each, dict):
                todo.extend(each.keys())
                todo.extend(each.values())
            elif isinstance(each, (list, tuple, *_VIEWS)):
                todo.extend(iter(each))  # type: ignore[call-overload]
        return total

    def weight(self, value: object) -> int:
        """The size of a value, as often as it has levels."""
        size = self.size(value)
        if size > self.left:
            return size
        levels = 0
        level: list[Any] = [value]
        while level and levels < DEEPEST:
            inner: list[Any] = []
            for other in level:
                if isinstance(other, dict):
                    inner.extend(other.values())
                elif isinstance(other, list | tuple):
                    inner.extend(other)
            levels, level = levels + 1, inner
        return size * levels


def _digits(number: int) -> int:
    """The size of an integer. Raises TooMuchError for one beyond the limit."""
    bits = number.bit_length()
    if bits > MOST_BITS:
        raise TooMuchError(f"an integer has more than {MOST_BITS:,} binary digits")
    return bits // 3 + 1


class _Counted:
    """The items of a loop; each turn is charged."""

    def __init__(self, meter: Meter, items: Any, text: int) -> None:
        self.meter = meter
        self.items = items
        self.text = text

    def __iter__(self) -> Iterator[Any]:
        for item in self.items:
            self.meter.charge(1 + self.text)
            yield item

    def __len__(self) -> int:
        return len(self.items)


class BoundedEnvironment(SandboxedEnvironment):
    """Jinja's sandbox with a meter for everything that a template does.

    `include` renders an `{% include %}`: file names, context, whether the file may be missing.
    """

    intercepted_binops = frozenset(["+", "-", "*", "/", "//", "**", "%"])

    def __init__(self, include: Callable[[Any, Any, bool], str], **options: Any) -> None:
        self.meter = Meter()
        super().__init__(undefined=Missing, finalize=self._finalized, **options)
        self.include = include
        self.globals = {name: self.globals[name] for name in KEPT_GLOBALS}
        self.filters = {
            name: self._metered(name, function)
            for name, function in FILTERS.items()
            if name not in DROPPED_FILTERS
        }
        self.tests = {name: self._metered_test(test) for name, test in TESTS.items()}

    def add_filters(self, filters: Mapping[str, Callable[..., Any]]) -> None:
        """Adds filters, metered like those of Jinja."""
        self.filters |= {name: self._metered(name, filter_) for name, filter_ in filters.items()}

    def add_tests(self, tests: Mapping[str, Callable[..., Any]]) -> None:
        """Adds tests, metered like those of Jinja."""
        self.tests |= {name: self._metered_test(test) for name, test in tests.items()}

    def _parse(self, source: str, name: str | None, filename: str | None) -> nodes.Template:
        tree = super()._parse(source, name, filename)
        counted: nodes.Template = _Counting().visit(tree)
        return counted

    def _finalized(self, value: object) -> object:
        self.meter.charge(self.meter.size(value))
        return value

    # Methods that _Counting inserts calls of into templates.

    def counted(self, items: Any, text: int) -> _Counted:
        """The items of a loop that prints `text` characters in each turn."""
        return _Counted(self.meter, items, text)

    def joined(self, *parts: object) -> str:
        """`a ~ b`."""
        self.meter.charge(1 + sum(self.meter.size(part) for part in parts))
        return "".join(str(part) for part in parts)

    def weighed(self, value: Any) -> Any:
        """A value that is going to be searched, compared or copied; its size is charged."""
        self.meter.charge(self.meter.size(value))
        return value

    def included(self, names: Any, context: Context, may_be_missing: bool) -> str:
        return self.include(names, context, may_be_missing)

    # Methods of the sandbox.

    def is_safe_attribute(self, obj: Any, attr: str, value: Any) -> bool:
        if isinstance(obj, _WITHOUT_METHODS) and callable(value):
            return False
        return super().is_safe_attribute(obj, attr, value)

    def getattr(self, obj: Any, attribute: str) -> Any:
        if attribute in PYTHON_2_METHODS and isinstance(obj, dict):
            attribute = PYTHON_2_METHODS[attribute]
        return super().getattr(obj, attribute)

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        meter = self.meter
        meter.charge(1 + meter.size(left) + meter.size(right))
        if operator == "%" and isinstance(left, _TEXTS):
            text = left if isinstance(left, str) else left.decode("latin-1")
            meter.charge(_widths(text, right))
            if isinstance(right, dict):
                meter.charge(text.count("%") * meter.size(right))
        elif operator == "*":
            meter.charge(_product(left, right))
        elif operator == "**" and isinstance(left, int) and isinstance(right, int):
            meter.charge(left.bit_length() * max(0, right))
        result = super().call_binop(context, operator, left, right)
        meter.size(result)  # raises for an integer beyond the limit
        return result

    def call(__self, __context: Context, __obj: Any, *args: Any, **kwargs: Any) -> Any:  # noqa: N805
        meter = __self.meter
        if meter.depth >= MOST_CALLS_DEEP:
            raise TooMuchError("macros, blocks or includes call one another endlessly")
        function = getattr(__obj, "__func__", None)
        own = getattr(__obj, "__self__", None) is __self and function is not None
        if not own:
            is_add = getattr(__obj, "__name__", "") == "add" and not hasattr(__obj, "__self__")
            measure = meter.weight if is_add else meter.size
            meter.charge(CALL + sum(map(measure, (*args, *kwargs.values()))))
            meter.charge(_cost_of_method(__obj, (*args, *kwargs.values()), meter))
        meter.depth += 1
        result = super().call(__context, __obj, *args, **kwargs)
        meter.depth -= 1
        if not own:
            meter.charge(meter.size(result))
        return result

    def _metered(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        meter = self.meter

        @wraps(function)
        def filtered(*args: Any, **kwargs: Any) -> Any:
            values = [*args, *kwargs.values()]
            if getattr(function, "jinja_pass_arg", None) is not None:
                values = values[1:]
            meter.charge(1 + sum(map(meter.size, values)))
            for value in values[1:]:
                if type(value) is int:
                    meter.charge(abs(value) * _lines(values[0]))
            if name == "replace" and len(values) > 2:
                meter.charge((meter.size(values[0]) + 1) * meter.size(values[2]))
            elif name == "join" and len(values) > 1:
                meter.charge(meter.size(values[0]) * meter.size(values[1]))
            elif name == "format" and isinstance(values[0], str):
                meter.charge(_widths(values[0], tuple(values[1:])))
                meter.charge(values[0].count("%(") * sum(map(meter.size, values[1:])))
            meter.charge(_cost_of_filter(name, values, meter))
            result = function(*args, **kwargs)
            if isinstance(result, Iterator):
                return iter(_Counted(meter, result, 0))
            meter.charge(meter.size(result))
            return result

        return filtered

    def _metered_test(self, function: Any) -> Any:
        meter = self.meter

        @wraps(function)
        def tested(*args: Any) -> Any:
            given = args[getattr(function, "jinja_pass_arg", None) is not None :]
            meter.charge(1 + sum(map(meter.size, given)))
            return function(*args)

        return tested


def _cost_of_filter(name: str, values: list[Any], meter: Meter) -> int:
    """The charge for a filter, beyond the sizes of its values and its result."""
    first, others = values[0], values[1:]
    size = meter.size(first)
    widths = [abs(value) for value in others if type(value) is int]
    if name in _DEEP:
        return meter.weight(first) * (1 + sum(widths))
    if name in _SORTING:
        return size * size.bit_length()
    if name == "sum" and any(isinstance(value, list | tuple) for value in others):
        return size * (len(first) if isinstance(first, Sized) else 1)
    if name in ("indent", "wordwrap"):
        text = sum(len(value) for value in others if isinstance(value, str))
        lines = _lines(first) if name == "indent" else size
        # `textwrap` copies the rest of a long word for each line.
        copied = size * size // (1000 * max(1, *widths, 1)) if name == "wordwrap" else 0
        return lines * text + copied
    return 0


def _lines(value: object) -> int:
    """How often a filter may apply a width to a value: once a line or item."""
    if isinstance(value, str):
        return 1 + value.count("\n")
    return 1 + len(value) if isinstance(value, Sized) else 1


def _product(left: object, right: object) -> int:
    """The size of a product."""
    for row, number in ((left, right), (right, left)):
        if isinstance(row, (*_TEXTS, list, tuple)) and isinstance(number, int):
            return len(row) * max(0, number)
    return 0


def _widths(text: str, values: object) -> int:
    """The characters that the widths in a format string may add."""
    many = values if isinstance(values, tuple) else (values,)
    stars = sum(abs(value) for value in many if type(value) is int) if "*" in text else 0
    return stars + sum(int(found[:12]) for found in _NUMBER.findall(text))


def _cost_of_method(function: object, values: tuple[Any, ...], meter: Meter) -> int:
    """The charge for a method of a string, list or dictionary, beyond its arguments."""
    name = getattr(function, "__name__", "")
    # The sandbox puts a function of its own before `str.format`.
    owner = getattr(getattr(function, "__wrapped__", function), "__self__", None)
    if isinstance(owner, list) and name == "pop" and values:
        return len(owner) // 20  # the items behind it move
    if not isinstance(owner, str | list | tuple | dict) or name in _CHEAP:
        return 0
    cost = meter.size(owner)
    if name.startswith("format") and isinstance(owner, str):
        return cost + _cost_of_format(owner, values, meter)
    cost += sum(abs(value) * _lines(owner) for value in values if type(value) is int)
    if name == "replace" and len(values) > 1:
        cost *= 1 + meter.size(values[1])
    elif name in ("join", "translate") and values:
        cost *= 1 + meter.size(values[0])
    elif name == "expandtabs":
        cost += 8 * len(owner) + sum(abs(v) * len(owner) for v in values if type(v) is int)
    return cost


def _cost_of_format(text: str, values: tuple[Any, ...], meter: Meter) -> int:
    """The charge for `str.format`: each field may print every value, and be as wide as a number in
    its format or, where that contains fields, in the values."""
    try:
        specs = [spec or "" for _, field, spec, _ in Formatter().parse(text) if field is not None]
    except ValueError:
        return 0  # it raises the same error
    cost = len(specs) * sum(map(meter.size, values))
    cost += sum(int(found[:12]) for spec in specs for found in _NUMBER.findall(spec))
    inner = sum(spec.count("{") for spec in specs)
    return cost + (inner * sum(map(_numbers, values)) if inner else 0)


def _numbers(value: Any) -> int:
    """The sum of the integers in a value, and of those that its texts contain."""
    total, todo = 0, [value]
    while todo:
        each = todo.pop()
        if isinstance(each, int):
            total += abs(each)
        elif isinstance(each, str):
            total += sum(int(found[:12]) for found in _NUMBER.findall(each))
        elif isinstance(each, dict):
            todo.extend(each.values())
        elif isinstance(each, list | tuple):
            todo.extend(each)
    return total


class _Counting(NodeTransformer):
    """Inserts the counting into a template: into loops, joins, comparisons, slices and includes.

    At the top level of a template that extends another, an include prints nothing, but runs: its
    blocks are collected.
    """

    def __init__(self) -> None:
        self.is_top_of_child = False

    def visit_Template(self, node: nodes.Template) -> nodes.Template:  # noqa: N802
        self.is_top_of_child = node.find(nodes.Extends) is not None
        self.generic_visit(node)
        return node

    def visit_Block(self, node: nodes.Block) -> nodes.Block:  # noqa: N802
        before, self.is_top_of_child = self.is_top_of_child, False
        self.generic_visit(node)
        self.is_top_of_child = before
        return node

    def visit_For(self, node: nodes.For) -> nodes.For:  # noqa: N802
        self.generic_visit(node)
        text = sum(len(data.data) for data in node.find_all(nodes.TemplateData))
        node.iter = _call("counted", [node.iter, nodes.Const(text)], node)
        return node

    def visit_Concat(self, node: nodes.Concat) -> nodes.Call:  # noqa: N802
        self.generic_visit(node)
        return _call("joined", node.nodes, node)

    def visit_Compare(self, node: nodes.Compare) -> nodes.Compare:  # noqa: N802
        self.generic_visit(node)
        node.expr = _weighed(node.expr)
        for operand in node.ops:
            operand.expr = _weighed(operand.expr)
        return node

    def visit_Getitem(self, node: nodes.Getitem) -> nodes.Expr:  # noqa: N802
        self.generic_visit(node)
        if isinstance(node.arg, nodes.Slice):
            return _weighed(node)
        node.arg = _weighed(node.arg)
        return node

    def visit_List(self, node: nodes.List) -> nodes.Expr:  # noqa: N802
        self.generic_visit(node)
        return _weighed(node)

    def visit_Dict(self, node: nodes.Dict) -> nodes.Expr:  # noqa: N802
        self.generic_visit(node)
        return _weighed(node)

    def visit_Tuple(self, node: nodes.Tuple) -> nodes.Expr:  # noqa: N802
        self.generic_visit(node)
        return _weighed(node) if node.ctx == "load" else node

    def visit_Include(self, node: nodes.Include) -> nodes.Stmt:  # noqa: N802
        self.generic_visit(node)
        values: list[Any] = [node.template]
        values.append(nodes.DerivedContextReference())
        values.append(nodes.Const(node.ignore_missing))
        call = _call("included", values, node)
        if self.is_top_of_child:
            return _in_environment(nodes.ExprStmt(call, lineno=node.lineno), node)
        return _in_environment(nodes.Output([call], lineno=node.lineno), node)


def _weighed(expression: Any) -> nodes.Expr:
    if isinstance(expression, nodes.Const):
        return expression
    return _call("weighed", [expression], expression)


def _call(method: str, values: list[Any], node: nodes.Node) -> nodes.Call:
    """A call of a method of the environment, at the place of a node."""
    function = nodes.EnvironmentAttribute(method)
    return _in_environment(nodes.Call(function, values, [], None, None, lineno=node.lineno), node)


def _in_environment(made: Made, node: nodes.Node) -> Made:
    """A node that was made, in the environment of another."""
    assert node.environment is not None
    made.set_environment(node.environment)
    return made

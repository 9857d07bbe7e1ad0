"""Userdata of a run: values as Python data, copies at container borders, and the view of a leaf."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from typing import Literal, Protocol

from smachac.interpreter.evaluator import EvaluationError, evaluate
from smachac.ir.expressions import Expr, Lambda, parse_expression
from smachac.ir.nodes import Data, Expression, Leaf, Node, Struct
from smachac.ir.traversal import remapping

UserdataErrorKind = Literal["missing-key", "undeclared-read"]
"""The kind of a failed read of userdata."""


class BehaviourError(Exception):
    """A leaf cannot perform its behaviour; the message has the reason."""


class UserdataError(BehaviourError):
    """A leaf read a key that is absent or that it does not declare."""

    def __init__(self, kind: UserdataErrorKind, message: str) -> None:
        super().__init__(message)
        self.kind: UserdataErrorKind = kind


LONGEST_WAIT = 1e9
"""Seconds of virtual time, longer than everything else in a run."""


class Readable(Protocol):
    """Readable userdata: the view of a leaf, or the userdata of a container."""

    def __getitem__(self, key: str, /) -> object: ...

    def __contains__(self, key: object, /) -> bool: ...


def python_data(data: Data) -> object:
    """A new Python object for a value of the script, with its expressions evaluated.

    A lambda, and code that cannot be evaluated here (it needs the robot), stays an Expression.
    """
    match data:
        case tuple():
            return [python_data(item) for item in data]
        case Struct(entries=entries):
            return {key: python_data(item) for key, item in entries}
        case Expression():
            return _evaluate(data)
    return data


def _evaluate(expression: Expression) -> object:
    try:
        value = _value(_parse(expression), {}, expression.text)
    except BehaviourError:
        return expression
    return expression if callable(value) else value


def call_function(expression: Expression, userdata: Readable) -> object:
    """The result of a function of the script, called with userdata.

    The expression is a lambda with one parameter or none, or the body of a lambda over `ud`. Raises
    BehaviourError.
    """
    body: Expr = _parse(expression)
    names = {"ud": KeyAttributes(userdata), "userdata": KeyAttributes(userdata)}
    if isinstance(body, Lambda):
        names = {body.parameter: KeyAttributes(userdata)} if body.parameter else {}
        body = body.body
    return _value(body, names, expression.text)


def _parse(expression: Expression) -> Expr:
    parsed = parse_expression(expression.text)
    if parsed is None:
        raise BehaviourError(f"`{expression.text}` is Python code, which is not run here")
    return parsed


def _value(expr: Expr, names: Mapping[str, object], text: str) -> object:
    try:
        return evaluate(expr, names)
    except EvaluationError as error:
        if isinstance(error.__cause__, UserdataError):
            raise error.__cause__ from None
        raise BehaviourError(f"`{text}`: {error}") from error


def trace_value(value: object) -> object:
    """A value for a trace: a JSON copy if there is one, else its `repr`."""
    if isinstance(value, Expression):
        return value.text
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError, RecursionError):
        return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(value))


def copy_in(node: Node, around: Mapping[str, object], own: dict[str, object]) -> None:
    """Copy the declared inputs of a container from the userdata around it; absent keys stay absent.

    The values are shared, not copied (docs/semantics.md, Userdata).
    """
    names = remapping(node)
    for key in node.inputs:
        outer = names[key.name]
        if outer in around:
            own[key.name] = around[outer]


def copy_out(node: Node, own: Mapping[str, object], around: dict[str, object]) -> None:
    """Copy the declared outputs of a container to the userdata around it."""
    names = remapping(node)
    for key in node.outputs:
        if key.name in own:
            around[names[key.name]] = own[key.name]


class Userdata:
    """The view of a leaf on its container's userdata: its declared keys, under its own names.

    Reading an undeclared or absent key raises UserdataError; writing an undeclared key has no
    effect. `unrestricted` leaves see every key: leaves of an open type, and the child of an
    iterator. `requested` holds the paths of states with an unserved request to stop. `on_write` is
    called after each write, `stop_machine` sends a request to stop to the whole machine.
    """

    __slots__ = (
        *("_around", "_requested", "_names", "_path", "_reads", "_writes", "_on_write"),
        *("slept", "stop_machine", "waits"),
    )

    def __init__(
        self,
        leaf: Leaf,
        path: str,
        around: dict[str, object],
        requested: set[str],
        on_write: Callable[[str, object], None],
        *,
        unrestricted: bool = False,
        stop_machine: Callable[[], None] = lambda: None,
    ) -> None:
        self._path = path
        self._around = around
        self._requested = requested
        self._names = remapping(leaf)
        self._reads = None if unrestricted else {key.name for key in leaf.inputs}
        self._writes = None if unrestricted else {key.name for key in leaf.outputs}
        self._on_write = on_write
        self.stop_machine = stop_machine
        self.slept = 0.0
        self.waits = False

    def __getitem__(self, key: str) -> object:
        if self._reads is not None and key not in self._reads:
            raise UserdataError("undeclared-read", f"reads `{key}`, which is not one of its inputs")
        outer = self._names[key]
        if outer not in self._around:
            where = f"`{key}`" if outer == key else f"`{key}` (`{outer}` of its container)"
            raise UserdataError("missing-key", f"reads {where}, which holds nothing")
        return self._around[outer]

    def __setitem__(self, key: str, value: object) -> None:
        if self._writes is not None and key not in self._writes:
            return
        self._around[self._names[key]] = value
        self._on_write(key, value)

    def __contains__(self, key: object) -> bool:
        declared = self._reads is None or key in self._reads
        return declared and isinstance(key, str) and self._names[key] in self._around

    def keys(self) -> list[str]:
        """The keys that can be read now, under the leaf's names, sorted."""
        if self._reads is not None:
            return sorted(key for key in self._reads if key in self)
        inner = {to: key for key, to in self._names.items()}
        return sorted(inner.get(key, key) for key in self._around)

    @property
    def preempted(self) -> bool:
        """Whether the leaf has an unserved request to stop."""
        return self._path in self._requested

    def service_preempt(self) -> None:
        """Mark the request to stop as served."""
        self._requested.discard(self._path)

    def sleep(self, seconds: float) -> None:
        """Let virtual time pass between the behaviour of the leaf and its exit."""
        self.slept += max(0.0, seconds)

    def wait_for_stop(self) -> None:
        """Let virtual time pass until a request to stop arrives, at most LONGEST_WAIT."""
        self.waits = True
        self.slept += LONGEST_WAIT


class KeyAttributes:
    """Userdata in expressions: keys as attributes, `ud.key`."""

    __slots__ = ("_userdata",)

    def __init__(self, userdata: Readable) -> None:
        self._userdata = userdata

    def __getattr__(self, name: str) -> object:
        return self._userdata[name]

    def __getitem__(self, name: str) -> object:
        return self._userdata[name]

    def __contains__(self, name: object) -> bool:
        return name in self._userdata

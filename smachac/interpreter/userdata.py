"""Userdata while a machine is interpreted: values as Python data, and what a leaf sees of them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Literal, Protocol

from smachac.ir.nodes import Data, Expression, Leaf, Node, Struct
from smachac.ir.traversal import remapping

if TYPE_CHECKING:
    from smachac.ir.expressions import Expr


UserdataFault = Literal["missing-key", "undeclared-read"]


class BehaviourError(Exception):
    """What a leaf was to do cannot be done; the message says why."""


class UserdataError(BehaviourError):
    """A leaf read a key that is absent, or that it does not declare."""

    def __init__(self, kind: UserdataFault, message: str) -> None:
        super().__init__(message)
        self.kind: UserdataFault = kind


class Readable(Protocol):
    """Something with keys: what a leaf sees, or the userdata of a container."""

    def __getitem__(self, key: str, /) -> object: ...

    def __contains__(self, key: object, /) -> bool: ...


def python_data(data: Data) -> object:
    """A fresh Python object for data of the script: lists, dicts, and expressions evaluated.

    A lambda, and what cannot be evaluated here (code that needs the robot), stands for itself.
    """
    match data:
        case tuple():
            return [python_data(item) for item in data]
        case Struct(entries=entries):
            return {key: python_data(item) for key, item in entries}
        case Expression():
            return _evaluated(data)
    return data


def _evaluated(expression: Expression) -> object:
    try:
        value = _value(_parsed(expression), {}, expression.text)
    except BehaviourError:
        return expression
    return expression if callable(value) else value


def called(expression: Expression, userdata: Readable) -> object:
    """The result of a function of the script: a lambda over userdata, or of nothing.

    An expression that is no lambda is taken for the body of one over `ud`. Raises BehaviourError.
    """
    from smachac.ir.expressions import Lambda

    body: Expr = _parsed(expression)
    names = {"ud": Fields(userdata), "userdata": Fields(userdata)}
    if isinstance(body, Lambda):
        names = {body.parameter: Fields(userdata)} if body.parameter else {}
        body = body.body
    return _value(body, names, expression.text)


def _parsed(expression: Expression) -> Expr:
    from smachac.ir.expressions import parse_expression

    parsed = parse_expression(expression.text)
    if parsed is None:
        raise BehaviourError(f"`{expression.text}` is Python code, which is not run here")
    return parsed


def _value(expr: Expr, names: Mapping[str, object], text: str) -> object:
    from smachac.interpreter.evaluator import EvaluationError, evaluate

    try:
        return evaluate(expr, names)
    except EvaluationError as error:
        if isinstance(error.__cause__, UserdataError):
            raise error.__cause__ from None
        raise BehaviourError(f"`{text}`: {error}") from error


def trace_value(value: object) -> object:
    """A value as a trace shows it: a copy of what JSON can say, else its `repr`."""
    if isinstance(value, Expression):
        return value.text
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError, RecursionError):
        return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(value))


def copy_in(node: Node, around: Mapping[str, object], own: dict[str, object]) -> None:
    """The declared inputs of a container, from the userdata around it (V1); absent ones stay (V2).

    Values are shared, not copied (V6).
    """
    names = remapping(node)
    for key in node.inputs:
        outer = names.get(key.name, key.name)
        if outer in around:
            own[key.name] = around[outer]


def copy_out(node: Node, own: Mapping[str, object], around: dict[str, object]) -> None:
    """The declared outputs of a container, to the userdata around it (V4)."""
    names = remapping(node)
    for key in node.outputs:
        if key.name in own:
            around[names.get(key.name, key.name)] = own[key.name]


class Userdata:
    """What a leaf sees of its container's userdata: its declared keys, under its own names (R*).

    An undeclared or absent key cannot be read (UserdataError); writing an undeclared one does
    nothing (R4). `loose` leaves see every key: those of an open type, and the child of an
    iterator (I7). `asked` holds the paths of states that are asked to stop; `stop_machine` asks
    the whole machine to.
    """

    __slots__ = (
        *("_around", "_asked", "_names", "_path", "_reads", "_writes", "_written"),
        *("slept", "stop_machine"),
    )

    def __init__(
        self,
        leaf: Leaf,
        path: str,
        around: dict[str, object],
        asked: set[str],
        written: Callable[[str, object], None],
        *,
        loose: bool = False,
        stop_machine: Callable[[], None] = lambda: None,
    ) -> None:
        self._path = path
        self._around = around
        self._asked = asked
        self._names = remapping(leaf)
        self._reads = None if loose else {key.name for key in leaf.inputs}
        self._writes = None if loose else {key.name for key in leaf.outputs}
        self._written = written
        self.stop_machine = stop_machine
        self.slept = 0.0

    def __getitem__(self, key: str) -> object:
        if self._reads is not None and key not in self._reads:
            raise UserdataError("undeclared-read", f"reads `{key}`, which is not one of its inputs")
        outer = self._names.get(key, key)
        if outer not in self._around:
            where = f"`{key}`" if outer == key else f"`{key}` (`{outer}` of its container)"
            raise UserdataError("missing-key", f"reads {where}, which holds nothing")
        return self._around[outer]

    def __setitem__(self, key: str, value: object) -> None:
        if self._writes is not None and key not in self._writes:
            return
        self._around[self._names.get(key, key)] = value
        self._written(key, value)

    def __contains__(self, key: object) -> bool:
        declared = self._reads is None or key in self._reads
        return declared and isinstance(key, str) and self._names.get(key, key) in self._around

    def keys(self) -> list[str]:
        """The keys that can be read now, under the leaf's names, sorted."""
        if self._reads is not None:
            return sorted(key for key in self._reads if key in self)
        inner = {to: key for key, to in self._names.items()}
        return sorted(inner.get(key, key) for key in self._around)

    @property
    def preempted(self) -> bool:
        """Whether a request to stop has reached the leaf and waits for an answer."""
        return self._path in self._asked

    def service_preempt(self) -> None:
        """Answer the request to stop: it counts as served."""
        self._asked.discard(self._path)

    def sleep(self, seconds: float) -> None:
        """Let virtual time pass between what the leaf does and its end."""
        self.slept += max(0.0, seconds)


class Fields:
    """Userdata as expressions see it: `ud.key`."""

    __slots__ = ("_userdata",)

    def __init__(self, userdata: Readable) -> None:
        self._userdata = userdata

    def __getattr__(self, name: str) -> object:
        return self._userdata[name]

    def __getitem__(self, name: str) -> object:
        return self._userdata[name]

    def __contains__(self, name: object) -> bool:
        return name in self._userdata

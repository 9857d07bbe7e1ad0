"""Where a value comes from: the code that has passed on the argument of a call.

`Say(self.robot)` in a method of an object whose constructor has `self.robot = robot` has the value
of the argument `robot` of the call that made the object, and so on.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Hashable, Iterator
from typing import NamedTuple

from smachac.pysource.machines.values import Creation, Frame, Function, Instance, Value
from smachac.pysource.modules.syntax_tree import walk_code

MOST_STEPS = 30
"""The most calls through which a value is followed."""

_LOOPS = ast.For | ast.AsyncFor | ast.While


class Origin(NamedTuple):
    """Code that has a value, and the frame in which it is evaluated."""

    node: ast.expr
    frame: Frame


class Parameter(NamedTuple):
    """A parameter of a function: the object whose method it is, and the call."""

    function: Function
    name: str
    me: Value | None
    call: Creation | None


class _Assigned(NamedTuple):
    """The names that code assigns, with their numbers of assignments, and those in its loops."""

    names: Counter[str]
    in_loops: frozenset[str]


class Origins:
    """Follows values to the code in which they begin, and names them."""

    def __init__(self) -> None:
        self.frames: dict[Frame, int] = {}
        self.objects: dict[Instance, int] = {}
        self.assigned: dict[ast.AST, _Assigned] = {}

    def of(self, node: ast.expr, frame: Frame) -> Iterator[Origin]:
        """The code that has the value of an expression, from the expression itself to the first
        code that had it."""
        here: Origin | None = Origin(node, frame)
        for _ in range(MOST_STEPS):
            if here is None:
                return
            yield here
            here = self._before(here)

    def source(self, node: ast.expr, frame: Frame, state: Hashable) -> tuple[Hashable, ast.expr]:
        """A name for a value that is not known, and the first code that has it. Two arguments have
        one name only if they certainly have one value: a value that changes, as in a loop, has a
        name for each `state` that gets it."""
        *_, last = self.of(node, frame)
        text = ast.unparse(last.node)
        me = _object_of(last)
        if me is not None:
            return ("object", self.objects.setdefault(me, len(self.objects)), text), last.node
        number = self.frames.setdefault(last.frame, len(self.frames))
        changes = state if self._changes(last) else None
        return ("frame", number, text, changes), last.node

    def parameter(self, here: Origin) -> Parameter | None:
        """The parameter whose value code has: a name in a function, or an attribute that the
        constructor of its object has set."""
        function, me = here.frame.function, _object_of(here)
        match here.node:
            case ast.Name(id=name) if function is not None:
                if name not in self._assigned(function.node).names:
                    return Parameter(function, name, here.frame.me, here.frame.made_by)
            case ast.Attribute(attr=name) if me is not None:
                maker = _maker(me)
                given = self._assigned_from(maker, name) if maker is not None else None
                if maker is not None and given is not None:
                    return Parameter(maker, given, me, me.made_by)
        return None

    def _before(self, here: Origin) -> Origin | None:
        """The code that had a value before it was passed on."""
        found = self.parameter(here)
        return _argument(found.function, found.name, found.call) if found is not None else None

    def _assigned_from(self, maker: Function, attribute: str) -> str | None:
        """The parameter whose value a constructor gives to an attribute, in its only assignment."""
        found = [
            node.value
            for node in walk_code(maker.node)
            if isinstance(node, ast.Assign)
            for target in node.targets
            if isinstance(target, ast.Attribute) and target.attr == attribute
        ]
        match found:
            case [ast.Name(id=name)] if name not in self._assigned(maker.node).names:
                return name
        return None

    def _changes(self, here: Origin) -> bool:
        """Whether a name in code can have several values in its function or module."""
        function, text = here.frame.function, here.frame.module.text
        root: ast.AST | None = text.tree if text is not None else None
        root = function.node if function is not None else root
        if root is None:
            return True
        known = self._assigned(root)
        names = {part.id for part in ast.walk(here.node) if isinstance(part, ast.Name)}
        return any(known.names[name] > 1 or name in known.in_loops for name in names)

    def _assigned(self, root: ast.AST) -> _Assigned:
        if root not in self.assigned:
            nodes = [*walk_code(root)]
            loops = (node for node in nodes if isinstance(node, _LOOPS))
            inside = {name for loop in loops for name in _stored(ast.walk(loop))}
            self.assigned[root] = _Assigned(Counter(_stored(nodes)), frozenset(inside))
        return self.assigned[root]


def _stored(nodes: Iterator[ast.AST] | list[ast.AST]) -> Iterator[str]:
    return (node.id for node in nodes
            if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load))  # fmt: skip


def _object_of(here: Origin) -> Instance | None:
    """The object of which code is an attribute: that of the method in which it is."""
    function, me = here.frame.function, here.frame.me
    match here.node:
        case ast.Attribute(value=ast.Name(id=owner)) if isinstance(me, Instance):
            parameters = function.node.args.args[:1] if function is not None else []
            return me if [part.arg for part in parameters] == [owner] else None
    return None


def _maker(me: Instance) -> Function | None:
    """The constructor of an object, if its own class has it."""
    maker = getattr(me.cls, "slots", {}).get("__init__")
    return maker if isinstance(maker, Function) else None


def _argument(function: Function, name: str, call: Creation | None) -> Origin | None:
    """The code of the argument for a parameter."""
    if call is None or not isinstance(call.node, ast.Call):
        return None
    for keyword in call.node.keywords:
        if keyword.arg == name:
            return Origin(keyword.value, call.frame)
    names = [part.arg for part in (*function.node.args.posonlyargs, *function.node.args.args)]
    if name not in names or any(isinstance(part, ast.Starred) for part in call.node.args):
        return None
    is_bound = function.owner is not None and function.kind != "staticmethod"
    at = names.index(name) - is_bound
    return Origin(call.node.args[at], call.frame) if 0 <= at < len(call.node.args) else None

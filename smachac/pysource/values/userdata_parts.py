"""The parts of userdata keys that the Python class of a state reads."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from smachac.ir.class_facts import Part, Step
from smachac.pysource.modules.functions import is_plain, tried_code
from smachac.pysource.modules.modules import OwnClass
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code

TESTS = frozenset(["hasattr", "isinstance", "type"])
"""Functions that test what a value is; code with one of them may handle values of every type."""


def parts_read(text: PythonText, function: ast.FunctionDef) -> tuple[Part, ...]:
    """The attributes, constant indexes and fields of userdata keys that `execute` reads, without
    those of keys that it writes, of fields that it sets or tests, and without code in `try`."""
    return _parts(text, function, function.args.args[1].arg, {})


def parts_of_arguments(own: OwnClass, execute: ast.FunctionDef) -> Iterator[Part]:
    """The parts of userdata keys that helpers of the class read, where `execute` passes the value
    of the key as an argument: `self._log(userdata.parcel)`."""
    userdata = execute.args.args[1].arg
    every = [*walk_code(execute)]
    calls = [call for call in every if isinstance(call, ast.Call)]
    if not calls or any(isinstance(node, ast.Name) and node.id in TESTS for node in every):
        return
    tried, written, known = tried_code(every), written_keys(every, userdata), _fields_known(every)
    done = set[tuple[str, int, str]]()
    for call in calls:
        match call.func:
            case ast.Attribute(value=ast.Name(id="self"), attr=name) if call not in tried:
                found = own.method(name)
            case _:
                continue
        if found is None or not is_plain(found[1]) or name in own.assigned():
            continue
        for at, value in enumerate(call.args):
            match value, [*found[1].args.posonlyargs, *found[1].args.args][at + 1 : at + 2]:
                case ast.Attribute(value=ast.Name(id=owner), attr=key), [ast.arg(arg=given)]:
                    pass
                case ast.Starred(), _:
                    break
                case _:
                    continue
            if owner != userdata or key in written or (name, at, key) in done:
                continue
            done.add((name, at, key))
            if not _is_rebound(found[1], given):
                read = _parts(found[0].text, found[1], "", {given: (key, ())})
                yield from (part for part in read if part.steps[-1] not in known)


def _is_rebound(function: ast.FunctionDef, name: str) -> bool:
    """Whether a function binds the name of a parameter again."""
    binds = [node for node in walk_code(function)
             if (isinstance(node, ast.Name) and node.id == name and not _is_read(node))
             or (isinstance(node, ast.arg) and node.arg == name)]  # fmt: skip
    return len(binds) > 1


def _parts(
    text: PythonText, function: ast.FunctionDef, userdata: str, given: Mapping[str, Way]
) -> tuple[Part, ...]:
    """The parts that a function reads of the userdata of a name, and of its parameters in `given`,
    which are values of keys."""
    every = [*walk_code(function)]
    tried = tried_code(every)
    if any(isinstance(node, ast.Name) and node.id in TESTS for node in every):
        return ()
    written = written_keys(every, userdata)
    known = _fields_known(every)
    names = _names(every, userdata, given)
    found: list[Part] = []
    for node in every:
        found += [one for one in _unpacked(text, node, names, userdata)
                  if node not in tried and one.key not in written]  # fmt: skip
        way = _way(node, names, userdata)
        if way is None or node in tried or not isinstance(node, ast.Attribute | ast.Subscript):
            continue  # a local name has its value from a part that was read before
        key, steps = way
        if not steps or steps[-1] in known or key in written:
            continue
        span = text.span(node)
        if not text.is_filled(span):
            place = span
            if isinstance(node, ast.Subscript) and isinstance(steps[-1][1], str):
                place = text.span(node.slice)
            found.append(Part(key, steps, span.text, place))
    return tuple(found)


def _unpacked(
    text: PythonText, node: ast.AST, names: Mapping[str, Way], userdata: str
) -> Iterator[Part]:
    """The parts of userdata that a statement unpacks to several names: `x, y = userdata.offset`."""
    for target, value, more in _bindings(node):
        way = _way(value, names, userdata)
        if way is None or not isinstance(target, ast.Tuple | ast.List):
            continue
        span = text.span(target)
        if any(isinstance(elt, ast.Starred) for elt in target.elts) or text.is_filled(span):
            continue
        steps: tuple[Step, ...] = (*way[1], *more, ("names", len(target.elts)))
        yield Part(way[0], steps, text.span(value).text, span)


def written_keys(every: Sequence[ast.AST], userdata: str) -> frozenset[str]:
    """The keys of userdata that the code writes or deletes."""
    found: set[str] = set()
    for node in every:
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=key, ctx=ast.Store() | ast.Del()):
                found.update([key] if name == userdata else ())
            case ast.Subscript(
                value=ast.Name(id=name),
                slice=ast.Constant(value=str(key)),
                ctx=ast.Store() | ast.Del(),
            ):
                found.update([key] if name == userdata else ())
    return frozenset(found)


ADDING = frozenset(["update", "setdefault", "__setitem__", "setattr"])
"""Names of functions and methods that add entries of any name to a mapping."""

LOOKING = frozenset(
    ["abs", "bool", "dict", "float", "int", "len", "list", "max", "min", "print", "round", "sorted",
     "str", "sum", "tuple"]
)  # fmt: skip
"""Functions of Python that change none of their arguments."""


def added_entries(own: OwnClass, execute: ast.FunctionDef) -> frozenset[str] | None:
    """The entries that the code of a class can add to the values of keys; None if their names are
    not known, or if it passes a whole value to other code."""
    userdata = execute.args.args[1].arg
    every = [inner for _, node in own.classes for inner in walk_code(node)]
    names = _names([*walk_code(execute)], userdata, {})
    found: set[str] = set()
    for node in every:
        match node:
            case ast.Subscript(slice=index, ctx=ast.Store()):
                if not isinstance(index, ast.Constant):
                    return None
                found.add(str(index.value))
            case ast.AugAssign(op=ast.BitOr()):
                return None
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)) if name in ADDING:
                return None
            case ast.Call(func=called, args=args, keywords=keywords):
                plain = isinstance(called, ast.Name) and called.id in LOOKING
                passed = [*args, *(one.value for one in keywords)]
                ways = [] if plain else [_way(one, names, userdata) for one in passed]
                whole = any(isinstance(one, ast.Name) and one.id == userdata for one in passed)
                if whole or any(way is not None and not way[1] for way in ways):
                    return None
    return frozenset(found)


Way = tuple[str, tuple[Step, ...]]
"""A key of userdata, and the steps to a part of its value."""


def _fields_known(every: Sequence[ast.AST]) -> frozenset[Step]:
    """The fields that the code sets, or for which it tests a mapping."""
    found: set[Step] = set()
    for node in every:
        match node:
            case ast.Subscript(slice=ast.Constant(value=str(name)), ctx=ast.Store() | ast.Del()):
                found.add(("item", name))
            case ast.Compare(left=ast.Constant(value=str(name)), ops=[ast.In() | ast.NotIn()]):
                found.add(("item", name))
    return frozenset(found)


def _names(every: Sequence[ast.AST], userdata: str, given: Mapping[str, Way]) -> Mapping[str, Way]:
    """The local names that are bound once, to a part of userdata or to each item of one."""
    bound = Counter(name.id for name in every if isinstance(name, ast.Name) and not _is_read(name))
    bound.update(argument.arg for argument in every if isinstance(argument, ast.arg))
    names: dict[str, Way] = {**given}
    # An outer loop comes before an inner one, and `ast.walk` gives it first.
    for node in every:
        for target, value, more in _bindings(node):
            way = _way(value, names, userdata)
            if isinstance(target, ast.Name) and bound[target.id] == 1 and way is not None:
                names[target.id] = (way[0], (*way[1], *more))
    return names


def _bindings(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr, tuple[Step, ...]]]:
    """The targets of an assignment or a loop, each with the value and the steps to its part."""
    match node:
        case ast.Assign(targets=[target], value=value):
            yield target, value, ()
        case ast.For(target=target, iter=items) | ast.comprehension(target=target, iter=items):
            match target, items:
                case ast.Tuple(elts=[_, item]), ast.Call(
                    func=ast.Name(id="enumerate"), args=[value, *_]
                ):
                    yield item, value, (("each", ""),)
                case _, ast.Call(func=ast.Name(id="reversed" | "sorted" | "list"), args=[value]):
                    yield target, value, (("each", ""),)
                case _:
                    yield target, items, (("each", ""),)


def _way(node: ast.AST, names: Mapping[str, Way], userdata: str) -> Way | None:
    """The part of userdata that code reads; None for other code."""
    steps: list[Step] = []
    while True:
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=key, ctx=ast.Load()) if (
                name == userdata
            ):
                return key, tuple(reversed(steps))
            case ast.Attribute(value=value, attr=name, ctx=ast.Load()):
                steps.append(("attribute", name))
            case ast.Subscript(value=value, slice=ast.Constant(value=step), ctx=ast.Load()) if (
                isinstance(step, str | int) and not isinstance(step, bool)
            ):
                if isinstance(value, ast.Name) and value.id == userdata:
                    return (step, tuple(reversed(steps))) if isinstance(step, str) else None
                steps.append(("item", step))
            case ast.Name(id=name) if name in names and _is_read(node):
                key, first = names[name]
                return key, (*first, *reversed(steps))
            case _:
                return None
        node = value


def _is_read(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Load)

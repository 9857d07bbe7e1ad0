"""Messages of ROS in the classes of the user: the types that their modules import, and the fields
of messages that their methods use.

The type of a message is known for a parameter with an annotation, the argument of a callback that
a method gives to a subscriber, and a variable whose only value is a new message or one that
`wait_for_message` returns.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.ir.argument_parts import argument_uses, own_names
from smachac.ir.class_facts import ClassMessages, MessageRef
from smachac.ir.message_types import PARTS, DefinitionKind
from smachac.pysource.modules.modules import Module, OwnClass
from smachac.pysource.modules.syntax_tree import walk_code

SUBSCRIBES = frozenset(["Subscriber", "create_subscription"])
"""Functions of rospy and rclpy that receive a type and a callback for its messages."""

WAITS = frozenset(["wait_for_message"])
"""Functions that receive a type and return a message of it."""

_Function = ast.FunctionDef | ast.AsyncFunctionDef


class _Names(NamedTuple):
    """The names of a module that mean types of ROS or modules with them, by the code that names
    them: `Twist`, and `msg` or `geometry_msgs.msg`."""

    types: Mapping[str, MessageRef]
    modules: Mapping[str, tuple[str, DefinitionKind]]

    def type_of(self, node: ast.expr | None) -> MessageRef | None:
        """The type that code names: `Twist`, `msg.Twist`, `SetBool.Request`."""
        match node:
            case ast.Name(id=name):
                return self.types.get(name)
            case ast.Constant(value=str(text)) if text.isidentifier():
                return self.types.get(text)
            case ast.Attribute(value=owner, attr=name):
                module = self.modules.get(ast.unparse(owner))
                if module is not None:
                    return MessageRef(module[1], module[0], name)
                whole = self.type_of(owner)
                if whole is not None and not whole.part and name.lower() in PARTS[whole.kind]:
                    return whole._replace(part=name.lower())
        return None


def class_messages(own: OwnClass) -> ClassMessages | None:
    """What a class and its modules do with types of ROS; None without such types."""
    named: list[tuple[MessageRef, Word]] = []
    found = ClassMessages()
    seen: set[str] = set()
    for module, node in own.classes:
        names, words = _imported(module)
        if not names.types and not names.modules:
            continue
        if module.text.source.name not in seen:
            seen.add(module.text.source.name)
            named += words
            named += _attributes(module, names)
        if _is_bound_again(module, names):
            continue
        callbacks = _callbacks(node, names)
        for function in node.body:
            if isinstance(function, ast.FunctionDef):
                found = _with_function(found, module, function, names, callbacks)
    return found._replace(named=tuple(named)) if named or found.uses else None


def _imported(module: Module) -> tuple[_Names, list[tuple[MessageRef, Word]]]:
    """The names of types that the statements at the top of a module import, and these words."""
    types: dict[str, MessageRef] = {}
    modules: dict[str, tuple[str, DefinitionKind]] = {}
    words: list[tuple[MessageRef, Word]] = []
    for node in module.text.tree.body:
        match node:
            case ast.ImportFrom(module=str(path), names=names, level=0):
                package, _, folder = path.partition(".")
                for alias in names:
                    kind = _kind(folder or alias.name)
                    own = alias.asname or alias.name
                    if kind is None or "." in package or alias.name == "*":
                        continue
                    if folder:
                        types[own] = MessageRef(kind, package, alias.name)
                        words.append((types[own], Word(alias.name, _span(module, alias))))
                    else:
                        modules[own] = (package, kind)
            case ast.Import(names=names):
                for alias in names:
                    package, _, folder = alias.name.partition(".")
                    kind = _kind(folder)
                    if kind is not None:
                        modules[alias.asname or alias.name] = (package, kind)
    return _Names(types, modules), [(ref, word) for ref, word in words if _is_class(ref.name)]


def _span(module: Module, alias: ast.alias) -> Span:
    """The place of the name in an import, without its `as`."""
    start = module.text.offset(alias.lineno, alias.col_offset)
    return Span(module.text.source, start, start + len(alias.name))


def _keyword(module: Module, node: ast.keyword, name: str) -> Word:
    """The name of an argument at its place."""
    start = module.text.offset(node.lineno, node.col_offset)
    return Word(name, Span(module.text.source, start, start + len(name)))


def _kind(folder: str) -> DefinitionKind | None:
    return next((part for part in PARTS if part == folder), None)


def _is_class(name: str) -> bool:
    """Whether a name can be that of a type: modules of classes have names such as `_Twist`."""
    return "_" not in name


def _attributes(module: Module, names: _Names) -> Iterator[tuple[MessageRef, Word]]:
    """The types that code takes from modules: `geometry_msgs.msg.Twist`."""
    for node in module.nodes if names.modules else ():
        if isinstance(node, ast.Attribute) and _is_class(node.attr):
            found = names.modules.get(ast.unparse(node.value))
            if found is not None:
                span = module.text.span(node)
                span = Span(span.source, max(span.end - len(node.attr), 0), span.end)
                yield MessageRef(found[1], found[0], node.attr), Word(node.attr, span)


def _is_bound_again(module: Module, names: _Names) -> bool:
    """Whether a module gives one of the names of types another meaning."""
    known = {type_.partition(".")[0] for type_ in (*names.types, *names.modules)}
    return not (known.isdisjoint(module.variables) and known.isdisjoint(module.definitions))


def _callbacks(node: ast.ClassDef, names: _Names) -> Mapping[str, MessageRef]:
    """The types of the messages that methods of a class get from subscribers, by method: those that
    nothing else in the class uses."""
    found: dict[str, MessageRef] = {}
    used: Counter[str] = Counter()
    for inner in walk_code(node):
        match inner:
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                used[name] += 1
            case ast.Call(func=ast.Name(id=called) | ast.Attribute(attr=called)):
                given = [*inner.args, *(one.value for one in inner.keywords)]
                types = [one for one in map(names.type_of, given) if one is not None]
                raw = any(one.arg in ("raw", None) for one in inner.keywords)
                if called not in SUBSCRIBES or len(types) != 1 or raw:
                    continue
                for one in given:
                    match one:
                        case ast.Attribute(value=ast.Name(id="self"), attr=name):
                            found[name] = types[0]
    return {name: ref for name, ref in found.items() if used[name] == 1}


def _with_function(
    found: ClassMessages,
    module: Module,
    function: ast.FunctionDef,
    names: _Names,
    callbacks: Mapping[str, MessageRef],
) -> ClassMessages:
    """The facts with those about one method."""
    if module.text.is_filled(module.text.span(function)):
        return found
    nodes = [node for line in function.body for node in walk_code(line)]
    keywords = [
        (ref, tuple(_keyword(module, one, one.arg) for one in node.keywords if one.arg))
        for node in nodes
        if isinstance(node, ast.Call) and not node.args
        and (ref := names.type_of(node.func)) is not None
    ]  # fmt: skip
    arguments = [*function.args.posonlyargs, *function.args.args]
    known = {
        argument.arg: ref
        for argument in (*arguments, *function.args.kwonlyargs)
        if (ref := names.type_of(argument.annotation)) is not None
    }
    if function.name in callbacks and len(arguments) >= 2:
        known.setdefault(arguments[1].arg, callbacks[function.name])
    made = dict(_variables(nodes, names))
    known = {**made, **known}
    own = set(own_names(function.body, known, made)) if known else set()
    uses = argument_uses(nodes, own, module.text.span)
    contents = found.uses if not known else (*found.uses, (tuple(known.items()), uses))
    return found._replace(
        uses=contents, calls=(*found.calls, *(keyword for keyword in keywords if keyword[1]))
    )


def _variables(nodes: Sequence[ast.AST], names: _Names) -> Iterator[tuple[str, MessageRef]]:
    """The local variables whose only value is a message of a known type."""
    stored = Counter(
        node.id
        for node in nodes
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
    )
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as call):
                pass
            case _:
                continue
        ref = names.type_of(call.func)
        match call.func:
            case ast.Name(id=called) | ast.Attribute(attr=called) if called in WAITS:
                types = [one for one in map(names.type_of, call.args) if one is not None]
                is_message = (
                    isinstance(call.func, ast.Attribute) and ast.unparse(call.func.value) == "rospy"
                )
                ref = types[0] if len(types) == 1 and is_message else None
        if ref is not None and stored[name] == 1:
            yield name, ref

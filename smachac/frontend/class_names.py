"""Names in the methods of a class that nothing defines: names of the module, attributes of `self`.

Only names that nothing in the text can bind are found; where a name can come from elsewhere, such
as a star import or a base class that is not read, none is.
"""

from __future__ import annotations

import ast
import builtins
from collections import Counter
from collections.abc import Iterable, Iterator

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.frontend.python_modules import Module, OwnClass
from smachac.ir.class_facts import ClassFault

BUILT_IN = frozenset([*dir(builtins), "__file__", "__builtins__", "__path__", "__class__", "_"])
"""Names that a module has without a definition; `_` is that of gettext."""

DYNAMIC = frozenset(["exec", "eval", "globals", "locals", "vars", "setattr", "__import__"])
"""Functions that can define a name at run time."""

USUAL_MODULES = frozenset([
    "collections", "copy", "datetime", "functools", "itertools", "json", "logging", "math", "os",
    "random", "re", "rospy", "smach", "subprocess", "sys", "threading", "time",
])  # fmt: skip
"""Modules whose names nobody uses for something else that a sketch leaves out."""

STATE_METHODS = frozenset([
    "execute", "request_preempt", "service_preempt", "recall_preempt", "preempt_requested",
    "register_outcomes", "get_registered_outcomes", "register_io_keys", "register_input_keys",
    "get_registered_input_keys", "register_output_keys", "get_registered_output_keys",
])  # fmt: skip
"""The methods of `smach.State` that containers call (smachac/runtime/smach/state.py)."""

INHERITED = STATE_METHODS.union(
    dir(object), ["_outcomes", "_input_keys", "_output_keys", "_preempt_requested", "__name__"]
)
"""The attributes of a state of SMACH."""

LATE = frozenset(["__getattr__", "__getattribute__", "__dict__", "__slots__"])
"""Names in a class that can have attributes without a definition."""


def undefined_names(
    module: Module, node: ast.ClassDef, outcomes: Iterable[str]
) -> list[ClassFault]:
    """The misspelt names in the methods of a class of a module: nothing in its text defines them,
    and a name one slip away is defined, or it is a usual module. `outcomes` are those of the class:
    an outcome without quotes is such a name. Other names may be those of a sketch."""
    text = module.text
    if module.dynamic or not module.name or "NameError" in text.source.text:
        return []
    every = [*ast.walk(text.tree)]
    used = {each.id for each in every if isinstance(each, ast.Name)}
    if not DYNAMIC.isdisjoint(used):
        return []
    bound = {name for each in every for name in _bound(each)} | BUILT_IN
    ends, guess, found = set(outcomes), guesser(sorted(bound - BUILT_IN)), []
    methods = _only_methods(every)
    owners = {each.value for each in every if isinstance(each, ast.Attribute)}
    for each in _evaluated(node):
        if (
            isinstance(each, ast.Call)
            and isinstance(each.func, ast.Name)
            and each.func.id in methods
        ):
            methods.remove(each.func.id)
            name = Word(each.func.id, text.span(each.func))
            found.append(ClassFault(kind="undefined name", name=name, near=f"self.{name.text}"))
        if isinstance(each, ast.Name) and each.id not in bound:
            bound.add(each.id)
            near = f'"{each.id}"' if each.id in ends else guess.sure(each.id)
            name = Word(each.id, text.span(each))
            if each in owners and each.id in USUAL_MODULES:
                found.append(ClassFault(kind="no import", name=name))
            elif near is not None:
                found.append(ClassFault(kind="undefined name", name=name, near=near))
    return found


def _only_methods(every: list[ast.AST]) -> set[str]:
    """The names that only methods of classes have: a call needs `self.` or the class."""
    classes = [each for each in every if isinstance(each, ast.ClassDef)]
    methods = Counter(
        each.name for owner in classes for each in owner.body if isinstance(each, ast.FunctionDef)
    )
    uses = Counter(name for each in every for name in _bound(each))
    return {name for name, times in methods.items() if uses[name] == times} - BUILT_IN


def _bound(node: ast.AST) -> Iterator[str]:
    """The names that a node binds, in any scope."""
    match node:
        case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name):
            yield name
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.Import() | ast.ImportFrom():
            for alias in node.names:
                yield alias.asname or alias.name.partition(".")[0]
        case ast.Global() | ast.Nonlocal():
            yield from node.names
        case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
            yield name
        case ast.MatchStar(name=str(name)) | ast.MatchMapping(rest=str(name)):
            yield name
    for each in getattr(node, "type_params", ()):
        yield each.name


def _evaluated(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes in a class without annotations, in their order."""
    todo: list[ast.AST] = [node]
    while todo:
        each = todo.pop()
        yield each
        skipped = {"annotation", "returns", "type_comment", "type_params"}
        parts: list[ast.AST] = []
        for name, value in ast.iter_fields(each):
            if name not in skipped:
                parts += [part for part in (value if isinstance(value, list) else [value])
                          if isinstance(part, ast.AST)]  # fmt: skip
        todo += reversed(parts)


def undefined_methods(own: OwnClass) -> list[ClassFault]:
    """The methods that a class calls on `self` and that neither it nor its bases define, each
    once; also other attributes, if a near name is defined, or if `__init__` has an argument of that
    name and does not keep it."""
    every = [each for module, _ in own.classes for each in ast.walk(module.text.tree)]
    names = {each.id for each in every if isinstance(each, ast.Name)}
    defined = {name for names_ in own.names for name in names_}
    if own.root == "unknown" or not DYNAMIC.isdisjoint(names) or not LATE.isdisjoint(defined):
        return []
    attributes = [each for each in every if isinstance(each, ast.Attribute)]
    if not LATE.isdisjoint(each.attr for each in attributes):
        return []
    defined |= {each.attr for each in attributes if isinstance(each.ctx, ast.Store)} | INHERITED
    quoted = {each.value for each in every if isinstance(each, ast.Constant)}
    called = [each.func for each in every if isinstance(each, ast.Call)]
    guess, found = guesser(sorted(name for name in defined if not name.startswith("__"))), []
    constructor = own.method("__init__")
    arguments = ast.walk(constructor[1].args) if constructor is not None else ()
    given = {each.arg for each in arguments if isinstance(each, ast.arg)}
    for module, node in own.classes:
        for each in _evaluated(node):
            if not isinstance(each, ast.Attribute) or not _of_self(each):
                continue
            span = module.text.span(each)
            if each.attr in defined or each.attr in quoted or module.text.is_filled(span):
                continue
            word = Word(each.attr, _end_of(span, each.attr))
            if each.attr in given:
                defined.add(each.attr)
                found.append(ClassFault(kind="unset attribute", name=word))
                continue
            near = guess(each.attr)
            if near is not None or any(each is function for function in called):
                defined.add(each.attr)
                found.append(ClassFault(kind="undefined method", name=word, near=near))
    return found


def _of_self(node: ast.Attribute) -> bool:
    return isinstance(node.value, ast.Name) and node.value.id == "self"


def _end_of(span: Span, name: str) -> Span:
    """The place of the last name in an expression such as `self.name`."""
    return Span(span.source, span.end - len(name), span.end)

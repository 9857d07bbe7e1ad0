"""Slips in what a class passes to calls: a call in place of a function, a wrong number of arguments
or of values in a text, a function in place of its module."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from inspect import isbuiltin, isclass, isfunction
from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.faults.instance_members import Objects
from smachac.pysource.faults.void_calls import called_function, is_silent
from smachac.pysource.modules.functions import tried_code
from smachac.pysource.modules.library_names import MODULES, is_shadowed, module_of_library
from smachac.pysource.modules.modules import (
    Module,
    OwnClass,
    find_class,
    names_of,
    of_other_objects,
)
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

EXTRA_ARGUMENT = FaultKind(
    name="extra argument",
    message="`{owner}` has no parameter for `{word}`",
    help="its parameters are those of `{near}`",
    effect="the call raises TypeError when it runs: the machine stops",
)
LACKING_ARGUMENT = FaultKind(
    name="lacking argument",
    message="this call of `{word}` does not pass `{more}`",
    help="its parameters are those of `{near}`",
    effect="the call raises TypeError when it runs: the machine stops",
)
UNKNOWN_KEYWORD = FaultKind(
    name="unknown keyword",
    message="`{owner}` has no parameter `{word}`",
    help="remove it, or add it to the parameters",
    near_help=SUGGESTION,
    effect="the call raises TypeError when it runs: the machine stops",
)
CALLED_EARLY = FaultKind(
    name="called early",
    message="`{word}` is called here: `{more}` gets its result, None, in place of the function",
    help="write `{near}`",
    effect="the function runs at once, and not later",
    accepted=True,
)
NUMBER_OF_VALUES = FaultKind(
    name="number of values",
    message="the text has {more}, but gets {file}",
    help="write one value for each place",
    effect="the code raises {word} when it runs: the machine stops",
)
NO_MODULE_HERE = FaultKind(
    name="no module here",
    message="`{word}` is a {owner} here, not the module `{word}`: it has no `{more}`",
    help="write `{near}`",
    effect="the code raises AttributeError when it runs: the machine stops",
)

TAKERS: Mapping[str, tuple[int, str]] = {
    "Timer": (1, "function"),
    "Thread": (1, "target"),
    "signal": (1, "handler"),
    "add_done_callback": (0, "fn"),
    "on_shutdown": (0, "h"),
    "Subscriber": (2, "callback"),
    "create_timer": (1, "callback"),
    "create_subscription": (2, "callback"),
}
"""Functions that call another one later: the position and the name of their parameter for it."""

WITHOUT_ARGUMENTS = frozenset(["Timer", "Thread", "on_shutdown", "create_timer"])
"""Those of them that pass no arguments. `rospy.Timer` passes one."""

_PLACE = re.compile(r"%(?:\((\w+)\))?[#0\- +]*(\*|\d+)?(?:\.(\*|\d+))?[hlL]?([diouxXeEfFgGcrsa%])")
_FIELD = re.compile(r"\{\{|\}\}|\{([^{}]*)\}")


class _MethodCode(NamedTuple):
    """A method of a class of a state type or of a base class of it: the class with its base
    classes, the module and the class of the method, its nodes that are checked, and the objects
    that the classes make."""

    own: OwnClass
    module: Module
    class_node: ast.ClassDef
    method: ast.FunctionDef
    nodes: Sequence[ast.AST]
    objects: Objects


def call_slips(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The slips in the calls of a class and of its base classes."""
    objects = Objects(own, library)
    for module, node in own.classes:
        others = of_other_objects(node)
        for method in node.body:
            if not isinstance(method, ast.FunctionDef):
                continue
            every = [node for node in walk_code(method) if node not in others]
            tried = tried_code(every)
            every = [node for node in every if node not in tried]
            code = _MethodCode(own, module, node, method, every, objects)
            found = [
                *_called_early(code),
                *_wrong_numbers(module, every),
                *_no_modules(module, method, every, library),
                *_wrong_counts(code),
            ]
            yield from (fault for fault in found if not module.text.is_filled(fault.name.span))


# --- a call in place of a function


def _called_early(code: _MethodCode) -> Iterator[ClassFault]:
    """The calls of functions without a result that are passed where the function is needed."""
    own, module, node, method, every, objects = code
    for inner in every:
        match inner:
            case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if name in TAKERS:
                pass
            case _:
                continue
        at, keyword = TAKERS[name]
        given = [value.value for value in inner.keywords if value.arg in (keyword, "callback")]
        given += inner.args[at : at + 1]
        for call in given:
            if not isinstance(call, ast.Call) or isinstance(call.func, ast.Call):
                continue
            found = called_function(own, module, method, call.func, objects.library)
            called = found[1] if found is not None else objects.method(module, node, call.func)
            if called is None or not is_silent(called):
                continue
            span = module.text.span(call)
            text = " ".join(span.text.split())
            near = module.text.span(call.func).text
            if call.args or call.keywords:
                near = f"lambda{'' if name in WITHOUT_ARGUMENTS else ' *_'}: {text}"
            more = module.text.span(inner.func).text
            yield ClassFault(kind=CALLED_EARLY, name=Word(text, span), near=near, more=more)


# --- too few or too many arguments


def _called_code(code: _MethodCode, call: ast.Call) -> ast.FunctionDef | None:
    """The function or method of the project that a call in a method of a class runs, also that of
    an object, or the constructor; None for one with a decorator."""
    own, module, node, method, _, objects = code
    function = called_function(own, module, method, call.func, objects.library)
    called = function[1] if function is not None else objects.method(module, node, call.func)
    called = called or _constructor(module, call.func, objects.library)
    if called is None or called.decorator_list:
        return None
    head = call.func.value if isinstance(call.func, ast.Attribute) else None
    of_object = function is None or (isinstance(head, ast.Name) and head.id == "self")
    first = [argument.arg for argument in (*called.args.posonlyargs, *called.args.args)][:1]
    return called if of_object == (first == ["self"]) else None


def _takes_self(call: ast.Call, function: ast.FunctionDef) -> bool:
    """Whether the first parameter of a function is the object of the call."""
    taken = [*function.args.posonlyargs, *function.args.args]
    bound = isinstance(call.func, ast.Attribute) or function.name == "__init__"
    return bound and [argument.arg for argument in taken[:1]] == ["self"]


def _constructor(module: Module, called: ast.expr, library: UserCode) -> ast.FunctionDef | None:
    """The constructor of the class of the project that an expression names."""
    if not isinstance(called, ast.Name) or called.id not in module.names:
        return None
    found = find_class(module, called.id, library)
    bound = names_of(found[1].body)[0].get("__init__", ()) if isinstance(found, tuple) else ()
    match bound:
        case (ast.FunctionDef() as maker,):
            return maker
    return None


def _wrong_counts(code: _MethodCode) -> Iterator[ClassFault]:
    """The calls of functions and methods of the project that lack an argument, or pass one that the
    function does not have."""
    module = code.module
    for call in code.nodes:
        if not isinstance(call, ast.Call) or any(keyword.arg is None for keyword in call.keywords):
            continue
        if any(isinstance(argument, ast.Starred) for argument in call.args):
            continue
        called = _called_code(code, call)
        if called is None:
            continue
        taken = called.args
        names = [argument.arg for argument in (*taken.posonlyargs, *taken.args)]
        due = names[: len(names) - len(taken.defaults)]
        if _takes_self(call, called):
            names, due = names[1:], due[1:]
        pairs = zip(taken.kwonlyargs, taken.kw_defaults, strict=True)
        due += [argument.arg for argument, default in pairs if default is None]
        passed = {*names[: len(call.args)], *(keyword.arg for keyword in call.keywords)}
        missing = [name for name in due if name not in passed]
        span = module.text.span(call)
        head = " ".join(module.text.span(call.func).text.split())
        by_name = [argument.arg for argument in (*taken.args, *taken.kwonlyargs)]
        unknown = [
            keyword.arg for keyword in call.keywords if keyword.arg and keyword.arg not in by_name
        ]
        signature = (
            f"{head}({', '.join([*names, *(argument.arg for argument in taken.kwonlyargs)])})"
        )
        is_base = called.name == "__init__" and isinstance(call.func, ast.Attribute)
        if unknown and taken.kwarg is None and not is_base:
            free = [name for name in by_name if name not in passed and name != "self"]
            near = guesser(free)(unknown[0]) or (free[0] if len(free) == 1 else None)
            keyword = next(keyword for keyword in call.keywords if keyword.arg == unknown[0])
            start = module.text.offset(keyword.lineno, keyword.col_offset)
            place = Span(module.text.source, start, start + len(unknown[0]))
            word = Word(unknown[0], place)
            yield ClassFault(kind=UNKNOWN_KEYWORD, name=word, near=near, owner=head)
            continue
        if len(call.args) > len(names) and taken.vararg is None:
            more = module.text.span(call.args[len(names)])
            word = Word(" ".join(more.text.split()), more)
            yield ClassFault(kind=EXTRA_ARGUMENT, name=word, near=signature, owner=head)
        elif missing and not is_base:
            word = Word(head, span)
            yield ClassFault(kind=LACKING_ARGUMENT, name=word, more=missing[0], near=signature)


# --- values in a text


def _wrong_numbers(module: Module, every: Sequence[ast.AST]) -> Iterator[ClassFault]:
    """The texts with another number of places than values: `"%s of %s" % (a,)`."""
    for node in every:
        match node:
            case ast.BinOp(
                op=ast.Mod(), left=ast.Constant(value=str() as text), right=ast.Tuple(elts=values)
            ):
                places, exact = _places(text), True
            case ast.Call(
                func=ast.Attribute(value=ast.Constant(value=str() as text), attr="format"),
                args=values,
                keywords=[],
            ):
                places, exact = _fields(text), False
            case _:
                continue
        if places is None or any(isinstance(value, ast.Starred) for value in values):
            continue
        given = len(values)
        if given == places or (given > places and not exact):
            continue
        error = "TypeError" if exact else "IndexError"
        span = module.text.span(node)
        yield ClassFault(
            kind=NUMBER_OF_VALUES,
            name=Word(error, span),
            more=f"{places} place{'s' * (places != 1)} for values",
            file=f"{given} value{'s' * (given != 1)}",
        )


def _places(text: str) -> int | None:
    """The number of values that `%` needs for a text; None if it has names, or is not valid."""
    count, at = 0, text.find("%")
    while at >= 0:
        found = _PLACE.match(text, at)
        if found is None or found[1]:
            return None
        count += (found[4] != "%") + (found[2] == "*") + (found[3] == "*")
        at = text.find("%", found.end())
    return count


def _fields(text: str) -> int | None:
    """The number of values that `format` needs for a text, all of whose fields have no name and no
    number; None for another text."""
    inner = [found[1] for found in _FIELD.finditer(text) if found[1] is not None]
    plain = all(re.match(r"(?:$|[.\[!:])", value) for value in inner)
    rest = _FIELD.sub("", text)
    return len(inner) if plain and "{" not in rest and "}" not in rest else None


# --- a function in place of its module


def _no_modules(
    module: Module, method: ast.FunctionDef, every: Sequence[ast.AST], library: UserCode
) -> Iterator[ClassFault]:
    """The names of modules of Python's library under which the file imports a function or class of
    the module: `from time import time`, and then `time.sleep(1)`."""
    done = set[str]()
    for node in every:
        match node:
            case ast.Attribute(value=ast.Name(id=name) as head, attr=attribute) if name in MODULES:
                pass
            case _:
                continue
        match module.names.get(name, ()):
            case (ast.ImportFrom(module=source, level=0, names=names),) if source == name:
                pass
            case _:
                continue
        if name in done or module.dynamic or all((one.asname or one.name) != name or one.name
                                                 != name for one in names):  # fmt: skip
            continue
        if _is_local(method, name) or is_shadowed(name, library):
            continue
        found = module_of_library(name)
        kept = getattr(found, name, None)
        if found is None or not (isclass(kept) or isfunction(kept) or isbuiltin(kept)):
            continue
        if hasattr(kept, attribute) or not hasattr(found, attribute):
            continue
        done.add(name)
        calls = any(isinstance(one, ast.Call) and isinstance(one.func, ast.Name)
                    and one.func.id == name for one in walk_code(module.text.tree))  # fmt: skip
        near = f"import {name}` in place of `from {name} import {name}"
        if attribute == name:
            near = f"{name}` in place of `{name}.{name}"
        elif calls or isclass(kept):
            near = f"from {name} import {', '.join(sorted([attribute, name]))}`, and here `"
            near += attribute
        what = "class" if isclass(kept) else "function"
        yield ClassFault(kind=NO_MODULE_HERE, name=Word(name, module.text.span(head)), near=near,
                         owner=what, more=attribute)  # fmt: skip


def _is_local(method: ast.FunctionDef, name: str) -> bool:
    """Whether a method binds a name itself."""
    return any(
        (isinstance(node, ast.arg) and node.arg == name)
        or (isinstance(node, ast.Name) and node.id == name and not isinstance(node.ctx, ast.Load))
        for node in walk_code(method)
    )

"""The declared interface of a SMACH class: the lists that `__init__` passes to `smach.State`.

The class is read as a syntax tree and never run.
"""

from __future__ import annotations

import ast
import re

from smachac.diagnostics.source import Word
from smachac.frontend.loader import Library
from smachac.frontend.python_source import PythonText, python_text
from smachac.ir.nodes import StateType
from smachac.targets.interface_check import Declared, Words

PARAMETERS = ("outcomes", "input_keys", "output_keys", "io_keys")
"""The parameters of `smach.State.__init__` with lists of names, in their order."""

REGISTERS = re.compile(r"\.(register)?_(outcomes|(io|input|output)_keys)\b")
"""Methods and attributes that change the declared interface; a class that has one is not read."""


def declared(type_: StateType, library: Library) -> Declared | None:
    """The interface that the class of a state type declares; None where it cannot be read."""
    code = type_.code.get("python", "")
    module, colon, name = code.partition(":")
    if colon:
        path = module.replace(".", "/")
        source = library.code(f"{path}.py") or library.code(f"{path}/__init__.py")
    else:
        source, name = library.own_template(code) if code else None, ""
    try:
        text = python_text(source, template=not colon) if source is not None else None
        found = _class(text, type_.name, name) if text is not None else None
        if text is None or found is None:
            return None
        return _of_class(text, found, code if colon else found.name)
    except (RecursionError, MemoryError):
        return None


def _class(text: PythonText, type_: str, name: str) -> ast.ClassDef | None:
    """The class of a name; in a template the class with the name of the type, or the only class."""
    found = [node for node in text.tree.body if isinstance(node, ast.ClassDef)]
    named = [node for node in found if node.name == (name or re.sub(r"\W+", "_", type_))]
    some = named if named or name else found
    return some[0] if len(some) == 1 else None


def _of_class(text: PythonText, node: ast.ClassDef, name: str) -> Declared | None:
    """The interface of a class; None if it is more than one `__init__` of a plain `smach.State`."""
    bases = [ast.unparse(base) for base in node.bases]
    makers = [each for each in node.body if getattr(each, "name", "") == "__init__"]
    plain = bases in (["smach.State"], ["State"]) and not node.keywords and not node.decorator_list
    if not plain or len(makers) != 1 or REGISTERS.search(ast.unparse(node)):
        return None
    (maker,) = makers
    if not isinstance(maker, ast.FunctionDef) or maker.decorator_list:
        return None
    if any(piece.startswith("{%") for piece in text.fillings(text.span(maker))):
        return None
    calls = [each for each in ast.walk(maker) if isinstance(each, ast.Call) and _is_super(each)]
    alone = [each.value for each in maker.body if isinstance(each, ast.Expr)]
    if len(calls) != 1 or calls[0] not in alone:
        return None
    given = _given(calls[0])
    if given is None:
        return None
    lists = {key: _words(text, value) for key, value in given.items()}
    both = lists.get("io_keys", ())
    span = text.span(node)
    at = max(span.source.text.find(node.name, span.start), span.start)
    return Declared(
        name=name,
        span=span._replace(start=at, end=at + len(node.name)),
        outcomes=lists.get("outcomes", ()),
        inputs=_together(lists.get("input_keys", ()), both),
        outputs=_together(lists.get("output_keys", ()), both),
    )


def _is_super(call: ast.Call) -> bool:
    """Whether a call is that of the `__init__` of the base class."""
    match call.func:
        case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr="__init__"):
            return True
        case ast.Attribute(value=owner, attr="__init__"):
            return ast.unparse(owner) in ("smach.State", "State")
    return False


def _given(call: ast.Call) -> dict[str, ast.expr] | None:
    """The arguments by name; None where some are in `*args` or `**kwargs`."""
    arguments = list(call.args)
    if isinstance(call.func, ast.Attribute) and not isinstance(call.func.value, ast.Call):
        arguments = arguments[1:]  # the first one is `self`
    if any(isinstance(each, ast.Starred) for each in arguments):
        return None
    found: dict[str, ast.expr] = dict(zip(PARAMETERS, arguments, strict=False))
    for keyword in call.keywords:
        if keyword.arg is None:
            return None
        found[keyword.arg] = keyword.value
    return found


def _words(text: PythonText, value: ast.expr) -> Words | None:
    """The names in a list of string literals; None for other expressions."""
    if not isinstance(value, ast.List | ast.Tuple | ast.Set):
        return None
    found = []
    for each in value.elts:
        span = text.span(each)
        if not (isinstance(each, ast.Constant) and isinstance(each.value, str)):
            return None
        if text.is_filled(span):
            return None
        found.append(Word(each.value, span))
    return None if text.is_filled(text.span(value)) else tuple(found)


def _together(some: Words | None, more: Words | None) -> Words | None:
    return None if some is None or more is None else (*some, *more)

"""What a class of SMACH says of itself: the lists that its `__init__` hands to `smach.State`."""

from __future__ import annotations

import ast
import re

from smachac.diagnostics.source import Word
from smachac.frontend.loader import Library
from smachac.frontend.python_source import PythonText, python_text
from smachac.frontend.state_types import StateType
from smachac.targets.interface_check import Declared, Words

PARAMETERS = ("outcomes", "input_keys", "output_keys", "io_keys")
"""Of `smach.State.__init__`, in their order (smach.state)."""

REGISTERS = re.compile(r"\.(register)?_(outcomes|(io|input|output)_keys)\b")
"""What else changes what a state declares."""


def declared(type_: StateType, library: Library) -> Declared | None:
    """What the class of a state type declares; None where that cannot be read."""
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
    """The class of a name; in a template the one that the program will call so, or the only one."""
    found = [node for node in text.tree.body if isinstance(node, ast.ClassDef)]
    named = [node for node in found if node.name == (name or re.sub(r"\W+", "_", type_))]
    some = named if named or name else found
    return some[0] if len(some) == 1 else None


def _of_class(text: PythonText, node: ast.ClassDef, name: str) -> Declared | None:
    """None where more than one `__init__` of a plain state has a say."""
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
    """Whether it calls the `__init__` of the class above."""
    match call.func:
        case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr="__init__"):
            return True
        case ast.Attribute(value=owner, attr="__init__"):
            return ast.unparse(owner) in ("smach.State", "State")
    return False


def _given(call: ast.Call) -> dict[str, ast.expr] | None:
    """The arguments by name; None where not all are told."""
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
    """The names of a list that is written out."""
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

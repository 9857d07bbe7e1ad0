"""Constants of a module that are not a plain text: members of classes and enumerations, tables.

Where a name can have another value, because the module changes it, the answer is None: not known.
"""

from __future__ import annotations

import ast

from smachac.pysource.modules.modules import Module, constant, find_class, names_of
from smachac.pysource.modules.user_code import UserCode
from smachac.records import dataclass

MUTATORS = frozenset(["clear", "pop", "popitem", "setdefault", "update"])
"""The methods that change a dictionary."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """A constant of a class. `text` is its value; None: a member of an enumeration, which is no
    text. `value` is the text of that member, if it is one."""

    text: str | None
    value: str | None = None


def member(module: Module, owner: str, name: str, library: UserCode) -> Member | None:
    """The constant `owner.name` of a class in a module; None: not known."""
    found = find_class(module, owner, library)
    if not isinstance(found, tuple) or _is_assigned(module, name):
        return None
    where, node = found
    names, dynamic = names_of(node.body)
    if dynamic or node.decorator_list or node.keywords or _is_assigned(where, name):
        return None
    text = constant(names, name)
    bases = [ast.unparse(base).rpartition(".")[2] for base in node.bases]
    own = any("__" in name for name in names) and bases != []
    if bases == ["Enum"] and not own and name in names:
        one = len(names[name]) == 1 and isinstance(names[name][0], ast.Assign)
        return Member(text=None, value=text) if one else None
    plain = bases in ([], ["object"], ["State"], ["StrEnum"], ["str", "Enum"])
    return Member(text=text) if plain and text is not None else None


def _is_assigned(module: Module, name: str) -> bool:
    """Whether code of a module assigns an attribute of a name, of any object."""
    return name in module.attributes["changed"]


def table(module: Module, name: str) -> ast.Dict | None:
    """The dictionary that a name of a module has for ever; None: not known."""
    match module.names.get(name, ()):
        case (ast.Assign(targets=[ast.Name()], value=ast.Dict() as value),):
            pass
        case (ast.AnnAssign(value=ast.Dict() as value),):
            pass
        case _:
            return None
    for node in module.nodes:
        match node:
            case ast.Subscript(value=ast.Name(id=owner), ctx=ast.Store() | ast.Del()):
                changed = owner == name
            case ast.Attribute(value=ast.Name(id=owner), attr=method):
                changed = owner == name and method in MUTATORS
            case ast.AugAssign(target=ast.Name(id=owner)):
                changed = owner == name
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                changed = name in names
            case _:
                changed = False
        if changed:
            return None
    return value


def entries(node: ast.Dict, key: ast.expr) -> list[ast.expr] | None:
    """The values one of which a dictionary has for a key; None: not known."""
    if any(key is None for key in node.keys):  # `**other`
        return None
    if not isinstance(key, ast.Constant):
        return node.values
    if not all(isinstance(key, ast.Constant) for key in node.keys):
        return None
    found = [
        value
        for member, value in zip(node.keys, node.values, strict=True)
        if isinstance(member, ast.Constant) and member.value == key.value
    ]
    return found[-1:] or None

"""Members of enumerations and constants of plain classes of the project that do not exist."""

from __future__ import annotations

import ast
import builtins
import enum
from collections.abc import Iterator

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.class_facts import ClassFault
from smachac.pysource.faults.instance_members import NO_MEMBER, has_no_base, members_of, shows_all
from smachac.pysource.modules.functions import caught
from smachac.pysource.modules.modules import Module, OwnClass, file_of, find_class, names_of
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

KINDS = frozenset(["Enum", "IntEnum", "StrEnum", "Flag", "IntFlag"])
"""The classes of the module `enum` whose members are the names in the body of a class."""

VALUES = frozenset(["str", "int", "float"])
"""The classes that the members of an enumeration can be besides."""


def missing_constants(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The members that the code of a class uses and its enumerations and plain classes do not
    have, each once: `Mode.FASTT`."""
    done = set[tuple[str, str]]()
    for module, node in own.classes:
        every = [*walk_code(node)]
        tried, bound = caught(node), _bound(every)
        quoted = {constant.value for constant in every if isinstance(constant, ast.Constant)}
        known: dict[str, tuple[Module, ast.ClassDef] | None] = {}
        for inner in every:
            match inner:
                case ast.Attribute(value=ast.Name(id=name), attr=member, ctx=ast.Load()) if (
                    name[0].isupper()  # others are modules and variables, which cost time
                ):
                    pass
                case _:
                    continue
            span = module.text.span(inner)
            if name in bound or inner in tried or member in quoted or (name, member) in done:
                continue
            if name not in known:
                known[name] = _class(module, name, library)
            found = known[name]
            if found is None or module.text.is_filled(span) or _has(*found, member):
                continue
            done.add((name, member))
            place = Word(member, Span(span.source, span.end - len(member), span.end))
            names = _constants(found[1])
            where = f" in `{file_of(found[0])}`" if found[0].name else ""
            more = f"its members are {listed(names)}" if names else "define it in the class"
            yield ClassFault(kind=NO_MEMBER, name=place, near=guesser(names)(member), file=where,
                             more=more, owner=found[1].name)  # fmt: skip


def _bound(every: list[ast.AST]) -> set[str]:
    """The names that the code of a class binds itself."""
    return {name.id for name in every
            if isinstance(name, ast.Name) and not isinstance(name.ctx, ast.Load)} | {
        argument.arg for argument in every if isinstance(argument, ast.arg)
    }  # fmt: skip


def _class(module: Module, name: str, library: UserCode) -> tuple[Module, ast.ClassDef] | None:
    """The enumeration or plain class of the project that a name is, if its text shows all its
    members."""
    if name not in module.names:
        return None
    found = find_class(module, name, library)
    if not isinstance(found, tuple) or names_of(found[1].body)[1]:
        return None
    plain = has_no_base(found[1]) or _kind(*found) is not None
    return found if plain and shows_all(module, name, *found) else None


def _kind(module: Module, node: ast.ClassDef) -> str | None:
    """The class of the module `enum` that a class is derived from directly; None for others."""
    decorators = {ast.unparse(inner).rpartition(".")[2] for inner in node.decorator_list}
    if node.keywords or not node.bases or not decorators <= {"unique"}:
        return None
    *first, last = node.bases
    if not all(isinstance(node, ast.Name) and node.id in VALUES for node in first):
        return None
    match last:
        case ast.Name(id=name):
            bound = module.names.get(name, ())
            known = [isinstance(node, ast.ImportFrom) and node.module == "enum" for node in bound]
        case ast.Attribute(value=ast.Name(id="enum"), attr=name):
            known = [isinstance(name, ast.Import) for name in module.names.get("enum", ())]
        case _:
            return None
    return name if name in KINDS and known == [True] else None


def _has(module: Module, node: ast.ClassDef, member: str) -> bool:
    """Whether a class has an attribute, itself or from Python."""
    kind = _kind(module, node)
    if member.startswith("_") or (kind is not None and member in ("name", "value")):
        return True
    bases: list[type] = [getattr(enum, kind, str), enum.EnumMeta] if kind is not None else [type]
    bases += [getattr(builtins, base.id) for base in node.bases
              if isinstance(base, ast.Name) and base.id in VALUES]  # fmt: skip
    if kind == "StrEnum":
        bases.append(str)
    return member in members_of(node)[0] or any(hasattr(base, member) for base in bases)


def _constants(node: ast.ClassDef) -> list[str]:
    """The public names that the body of a class gives a value, in their order."""
    found = [target.id for inner in node.body if isinstance(inner, ast.Assign)
             for target in inner.targets if isinstance(target, ast.Name)]  # fmt: skip
    return [name for name in dict.fromkeys(found) if not name.startswith("_")]

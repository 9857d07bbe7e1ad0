"""Objects of plain classes of the project that a state keeps, or its module: attributes that they
do not have, methods that are not called, and calls with too few or too many arguments."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.faults.class_slips import NO_EFFECT, NOT_CALLED, operands
from smachac.pysource.modules.functions import caught
from smachac.pysource.modules.modules import (
    Module,
    OwnClass,
    file_of,
    find_class,
    load_module,
    of_other_objects,
    source_module,
)
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

NO_MEMBER = FaultKind(
    name="no member",
    message="`{owner}`{file} has no `{word}`",
    help="{more}",
    near_help=SUGGESTION,
    effect="the code raises AttributeError when it runs: the machine stops",
)

LATE = frozenset(["__getattr__", "__getattribute__", "__slots__", "__new__", "__class__"])
"""Names by which a class can have attributes that its text does not show."""


def missing_members(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The attributes of objects of plain classes that these do not define, each once."""
    objects = Objects(own, library)
    done = set[tuple[str, str]]()
    for module, node in own.classes:
        set_here = module.attributes["changed"]
        for use in objects.uses(module, node, walk_code(node)):
            if (use.name, use.member) in done:
                continue
            names, methods = members_of(use.definition)
            member = use.member
            if member in names or member in set_here or member in module.constants:
                continue
            if hasattr(object, member):
                continue
            done.add((use.name, member))
            place = Word(member, Span(use.span.source, use.span.end - len(member), use.span.end))
            where = f" in `{file_of(use.module)}`" if use.module.name else ""
            near = guesser(sorted(names))(member)
            if near is None:
                near = next((one for one in methods if _is_part(one, member)), None)
            yield ClassFault(kind=NO_MEMBER, name=place, near=near, file=where,
                             more=_help(methods), owner=use.definition.name)  # fmt: skip


def uncalled_members(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The methods of objects of plain classes without `()`, in a condition or alone in a line."""
    objects = Objects(own, library)
    for module, node in own.classes:
        set_here = {
            attribute.attr
            for attribute in walk_code(node)
            if isinstance(attribute, ast.Attribute) and not isinstance(attribute.ctx, ast.Load)
        }
        kinds: dict[ast.expr, FaultKind] = {}
        kinds.update((part, kind) for kind, part in _conditions_and_lines(node))
        for use in objects.uses(module, node, kinds):
            if use.member not in set_here and _is_method(use.definition, use.member):
                word = Word(use.span.text, use.span)
                yield ClassFault(kind=kinds[use.node], name=word, near=f"{use.span.text}()")


_Entry = tuple[Module, ast.expr | None, Span]
"""The value of an attribute, with its module and the place of the attribute."""


class _Use(NamedTuple):
    """A read of a member of an object in an attribute of `self` or in a name of the module: the
    name, the member, the place of both, and the class of the object with its module."""

    node: ast.expr
    name: str
    member: str
    span: Span
    module: Module
    definition: ast.ClassDef


class Objects:
    """The objects of plain classes of the project that a class keeps in its attributes, or a module
    under a name."""

    def __init__(self, own: OwnClass, library: UserCode) -> None:
        self.library = library
        self.kept = {
            name: entries[0] for name, entries in own.assigned().items() if len(entries) == 1
        }
        self.classes: dict[str, tuple[Module, ast.ClassDef] | None] = {}
        self.left_out: dict[ast.ClassDef, tuple[set[ast.AST], set[str]]] = {}

    def uses(
        self, module: Module, node: ast.ClassDef, expressions: Iterable[ast.AST]
    ) -> Iterator[_Use]:
        """The reads of members among some expressions of a class."""
        if node not in self.left_out:
            self.left_out[node] = of_other_objects(node) | caught(node), {*_bound(node)}
        others, bound = self.left_out[node]
        for expression in expressions:
            match expression:
                case ast.Attribute(
                    value=ast.Attribute(value=ast.Name(id="self"), attr=name), attr=member,
                    ctx=ast.Load(),
                ) as each if name in self.kept and each not in others:  # fmt: skip
                    entry: _Entry | None = self.kept[name]
                    where = f"self.{name}"
                case (
                    ast.Attribute(value=ast.Name(id=name), attr=member, ctx=ast.Load()) as each
                ) if name in module.names and name not in bound and each not in others:
                    entry = None
                    where = f"{module.name}:{name}"
                case _:
                    continue
            if where not in self.classes:
                entry = entry or _of_module(module, name, self.library)
                self.classes[where] = _plain_class(entry, self.library) if entry else None
            found, span = self.classes[where], module.text.span(each)
            if found is not None and not module.text.is_filled(span):
                yield _Use(each, name, member, span, *found)

    def method(
        self, module: Module, node: ast.ClassDef, called: ast.expr
    ) -> ast.FunctionDef | None:
        """The method of an object in an attribute of `self` that an expression names."""
        for use in self.uses(module, node, [called]):
            body = use.definition.body
            bound = [node for node in body if getattr(node, "name", "") == use.member]
            if len(bound) == 1 and isinstance(bound[0], ast.FunctionDef):
                return bound[0]
        return None


def _conditions_and_lines(node: ast.ClassDef) -> Iterator[tuple[FaultKind, ast.expr]]:
    """The expressions of which code uses the truth alone, and those alone in a line."""
    for inner in walk_code(node):
        match inner:
            case (
                ast.If(test=test)
                | ast.While(test=test)
                | ast.IfExp(test=test)
                | ast.Assert(test=test)
            ):
                for part in operands(test):
                    yield NOT_CALLED, part
            case ast.Expr(value=value):
                yield NO_EFFECT, value


def _is_method(node: ast.ClassDef, name: str) -> bool:
    """Whether a name of a class is a method without decorators, and nothing else."""
    methods = [
        function
        for function in node.body
        if isinstance(function, ast.FunctionDef) and function.name == name
    ]
    set_ = any(isinstance(inner, ast.Attribute | ast.Name) and isinstance(inner.ctx, ast.Store)
               and name in (getattr(inner, "attr", ""), getattr(inner, "id", ""))
               for inner in walk_code(node))  # fmt: skip
    return len(methods) == 1 and not methods[0].decorator_list and not set_


def _is_part(name: str, member: str) -> bool:
    """Whether a name is a word of another one: `read` of `read_weight`."""
    one, other = name.split("_"), member.split("_")
    return one == other[: len(one)] or other == one[: len(other)]


def _help(methods: list[str]) -> str:
    return f"its methods are {listed(methods)}" if methods else "define it in the class"


def _bound(node: ast.ClassDef) -> Iterator[str]:
    """The names that the code of a class binds itself."""
    for inner in walk_code(node):
        match inner:
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                yield name
            case ast.ExceptHandler(name=str(name)) | ast.alias(name=name):
                yield name


def _of_module(module: Module, name: str, library: UserCode) -> _Entry | None:
    """The only value of a name of a module, also where the module imports it."""
    match module.names.get(name, ()):
        case (ast.ImportFrom() as imported,) if imported in module.text.tree.body:
            own = next(alias.name for alias in imported.names
                       if (alias.asname or alias.name) == name)  # fmt: skip
            other = load_module(source_module(module, imported), library)
            if not isinstance(other, Module) or other.dynamic:
                return None
            module, name = other, own
    match module.names.get(name, ()):
        case (ast.Assign(targets=[ast.Name() as target], value=ast.Call() as value) as line,):
            shared = any(isinstance(node, ast.Global) and name in node.names
                         for node in module.nodes)  # fmt: skip
            if line in module.text.tree.body and not shared:
                return module, value, module.text.span(target)
    return None


def _plain_class(entry: _Entry, library: UserCode) -> tuple[Module, ast.ClassDef] | None:
    """The class of the object that an attribute keeps, if it has no base class and its text shows
    all its attributes."""
    match entry:
        case (module, ast.Call(func=ast.Name(id=name)), _):
            found = find_class(module, name, library)
        case _:
            return None
    if not isinstance(found, tuple):
        return None
    return found if shows_all(module, name, *found) and has_no_base(found[1]) else None


def has_no_base(node: ast.ClassDef) -> bool:
    """Whether a class has no base class, decorator or metaclass."""
    plain = all(isinstance(base, ast.Name) and base.id == "object" for base in node.bases)
    return plain and not node.keywords and not node.decorator_list


def shows_all(module: Module, name: str, other: Module, node: ast.ClassDef) -> bool:
    """Whether the text of a class of the module `other`, which `module` uses under a name, shows
    all names that it has itself."""
    if other.text.fillings(other.text.span(node)):
        return False
    used = {name.id for name in walk_code(node) if isinstance(name, ast.Name)}
    used |= {
        attribute.attr for attribute in walk_code(node) if isinstance(attribute, ast.Attribute)
    }
    bound = {function.name for function in node.body if isinstance(function, ast.FunctionDef)}
    late = {"setattr", "vars", "__dict__", "locals", "exec", "globals"} & used
    outside = any(_sets(node, name) for one in (module, other) for node in one.nodes)
    return not (late or outside or LATE & bound)


def _sets(node: ast.AST, name: str) -> bool:
    """Whether code sets an attribute of a class: `Scale.read = ...`, `setattr(Scale, ...)`."""
    match node:
        case ast.Attribute(value=ast.Name(id=owner), ctx=ast.Store()):
            return owner == name
        case ast.Call(func=ast.Name(id="setattr"), args=[ast.Name(id=owner), *_]):
            return owner == name
    return False


def members_of(node: ast.ClassDef) -> tuple[set[str], list[str]]:
    """The names of a class and of the attributes of its objects, and its public methods."""
    names = set[str]()
    for inner in walk_code(node):
        match inner:
            case ast.Attribute(attr=name, ctx=ast.Store()) | ast.Name(id=name, ctx=ast.Store()):
                names.add(name)
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                names.add(name)
            case ast.ClassDef(name=name) | ast.alias(asname=str(name)) | ast.alias(name=name):
                names.add(name)
    methods = [
        function.name
        for function in node.body
        if isinstance(function, ast.FunctionDef) and not function.name.startswith("_")
    ]
    return names, methods

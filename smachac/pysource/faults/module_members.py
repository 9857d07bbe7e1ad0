"""Names of modules of the project in the class of a state type: functions that are not called, and
names that these modules do not have."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Set

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.pysource.faults.class_slips import operands
from smachac.pysource.faults.instance_members import NO_MEMBER
from smachac.pysource.modules.imports import makes_names
from smachac.pysource.modules.modules import (
    Module,
    OwnClass,
    file_of,
    find_function,
    first_name,
    load_module,
    module_name,
    source_module,
)
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

FUNCTION_NOT_CALLED = FaultKind(
    name="function not called",
    message="`{word}` without `()` does not call the function",
    help="write `{near}`",
    effect="the value is the function itself: it is no number, and true in every condition",
    accepted=True,
)

_WORD = re.compile(r"\w+")
_Reference = ast.Name | ast.Attribute
_Function = ast.FunctionDef | ast.AsyncFunctionDef
_ORDER = ast.Lt | ast.LtE | ast.Gt | ast.GtE


def module_slips(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The functions of modules that the code of a class uses as values, and its names that modules
    do not have, each once."""
    done = set[str]()
    for module, node in own.classes:
        found = [*_uncalled(module, node, module.rebound, module.tried, library)]
        found += _missing(module, node, done, library)
        for fault in found:
            if fault.name.text not in done and not module.text.is_filled(fault.name.span):
                done.add(fault.name.text)
                yield fault


# --- functions that are not called


def _uncalled(
    module: Module, node: ast.ClassDef, bound: Set[str], tried: Set[ast.AST], library: UserCode
) -> Iterator[ClassFault]:
    """The functions of the project whose name without `()` is used as a number or a truth value, is
    kept in the userdata, or is a line."""
    for function in walk_code(node):
        if not isinstance(function, _Function):
            continue
        values = {id(value): value for value in _values(function, tried)}
        kept = _kept(function, values)
        for value in (*values.values(), *kept):
            head = first_name(value)
            if head is None or head in bound or not _may_be_function(module, value, library):
                continue
            found = find_function(module, value, library)
            if found is None or found[1].decorator_list:
                continue
            span = module.text.span(value)
            given = found[1].args
            needed = len(given.posonlyargs) + len(given.args) > len(given.defaults)
            near = f"{span.text}({'...' if needed or None in given.kw_defaults else ''})"
            yield ClassFault(kind=FUNCTION_NOT_CALLED, name=Word(span.text, span), near=near)


def _may_be_function(module: Module, node: _Reference, library: UserCode) -> bool:
    """Whether the text of the module of a name can define a function of that name, so that it must
    be parsed."""
    if isinstance(node, ast.Attribute):
        dotted, name = module_name(module, ast.unparse(node.value)), node.attr
    else:
        match module.names.get(node.id, ()):
            case (ast.ImportFrom() as imported,):
                dotted = source_module(module, imported)
                name = next(name.name for name in imported.names
                            if (name.asname or name.name) == node.id)  # fmt: skip
            case (ast.FunctionDef(),):
                return True
            case _:
                return False
    return any(f"def {name}(" in text for text in _texts(dotted, library))


def _texts(dotted: str | None, library: UserCode) -> list[str]:
    """The texts of the files of the project that can be a module."""
    path = (dotted or "").replace(".", "/")
    sources = [library.code(file) for file in (f"{path}.py", f"{path}/__init__.py") if path]
    return [source.text for source in sources if source is not None]


def _values(function: ast.AST, tried: Set[ast.AST]) -> Iterator[_Reference]:
    """The names in a function whose value is a number, a truth value or a value of the userdata,
    or that are alone in a line."""
    for node in walk_code(function):
        found: list[ast.expr] = []
        match node:
            case ast.BinOp(left=left, right=right):
                found = [left, right]
            case ast.AugAssign(value=value) | ast.UnaryOp(op=ast.USub(), operand=value):
                found = [value]
            case ast.Compare(left=left, ops=ops, comparators=others):
                ordered = all(isinstance(op, _ORDER) for op in ops)
                found = [left, *others] if ordered else []
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
                found = [*operands(test)]
            case ast.Assign(
                targets=[ast.Attribute(value=ast.Name(id="userdata" | "ud"))], value=value
            ):
                found = [value]
            case ast.Expr(value=value) if node not in tried:
                found = [value]
        yield from (one for one in found if isinstance(one, _Reference))


def _kept(function: ast.AST, values: dict[int, _Reference]) -> Iterator[_Reference]:
    """The values of the variables among these names that have one value and are never called."""
    used = {value.id for value in values.values() if isinstance(value, ast.Name)}
    if not used:
        return
    stored: dict[str, int] = {}
    for node in walk_code(function):
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
                stored[name] = stored.get(name, 0) + 1
            case ast.arg(arg=name) | ast.Call(func=ast.Name(id=name)):
                stored[name] = 2
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                stored.update(dict.fromkeys(names, 2))
    for node in walk_code(function):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                if name in used and stored[name] == 1 and isinstance(value, _Reference):
                    yield value


# --- names that a module does not have


def _missing(
    module: Module, node: ast.ClassDef, done: Set[str], library: UserCode
) -> Iterator[ClassFault]:
    """The attributes of imported modules of the project that these do not define; `done` are names
    that have a fault. A module is parsed only if its text does not contain the name."""
    words: dict[str, tuple[str, set[str]]] = {}
    for inner in walk_code(node):
        match inner:
            case ast.Attribute(value=ast.Name() | ast.Attribute() as owner, attr=name):
                head = first_name(owner)
            case _:
                continue
        if head is None or head not in module.names or head in done or inner in module.tried:
            continue
        if head in module.rebound:
            continue
        written = ast.unparse(owner)
        if written not in words:
            words[written] = _words(module, written, library)
        dotted, known = words[written]
        set_here = name in module.constants or name in module.attributes["changed"]
        if not dotted or name in known or set_here or name.startswith("__"):
            continue
        fault = _absent(dotted, name, module, library)
        if fault is not None:
            span = module.text.span(inner)
            place = Span(span.source, span.end - len(name), span.end)
            near, file, more = fault
            yield ClassFault(kind=NO_MEMBER, name=Word(name, place), near=near, owner=file,
                             more=more)  # fmt: skip


def _words(module: Module, written: str, library: UserCode) -> tuple[str, set[str]]:
    """The dotted name of the module of the project that a name is in a module, and the words of its
    text; empty if it is none."""
    dotted = module_name(module, written)
    texts = _texts(dotted, library)
    if dotted is None or len(texts) != 1:
        return "", set()
    return dotted, {*_WORD.findall(texts[0])}


def _absent(
    dotted: str, name: str, user: Module, library: UserCode
) -> tuple[str | None, str, str] | None:
    """The nearest name, the file and the help for a name that a module does not define; None where
    it can have it."""
    other = load_module(dotted, library)
    if not isinstance(other, Module) or other.dynamic or makes_names(other.text.tree):
        return None
    package, _, last = dotted.rpartition(".")
    above = load_module(package, library) if package else None
    if isinstance(above, Module) and (above.dynamic or last in above.names):
        return None  # perhaps an object of the package with the name of the module
    path = dotted.replace(".", "/")
    inside = {name.partition(".")[0] for name in library.code_names(path)} if other.package else ()
    if name in inside or "__getattr__" in other.names:
        return None
    public = [name for name in other.names if not name.startswith("_")]
    functions = [text for text in public if isinstance(other.names[text][-1], ast.FunctionDef)]
    more = f"its functions are {listed(functions)}" if functions else "define it in the module"
    near = guesser(sorted(public))(name)
    return near, file_of(other), more

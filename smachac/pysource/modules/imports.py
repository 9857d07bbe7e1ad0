"""Imports of modules of the project that fail: of a module that does not exist, or of a name that
the module does not define.

Only imports at the top of a file are judged, not those in `try`, `if` or a function. Modules that
are in no folder of the project can be installed ones.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from typing import NamedTuple

from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import DID_YOU_MEAN, ClassFault, FaultKind
from smachac.ir.python_code import parse_module
from smachac.pysource.modules.modules import (
    Module,
    absent_module,
    is_module,
    load_module,
    source_module,
)
from smachac.pysource.modules.other_modules import module_with
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode
from smachac.records import replace

NO_IMPORTED_MODULE = FaultKind(
    name="no imported module",
    message="no module `{word}` exists, which is imported here",
    help="correct the name, or create the module",
    near_help=DID_YOU_MEAN,
    effect="Python raises ModuleNotFoundError: the program stops when it starts",
    missing=True,
)
NO_IMPORTED_NAME = FaultKind(
    name="no imported name",
    message="`{file}` has no `{word}`, which is imported from it",
    help="correct the name, or define it in `{file}`",
    near_help=DID_YOU_MEAN,
    missing=True,
)

MAKES_NAMES = frozenset(["exec", "globals", "locals", "vars", "setattr", "__import__"])
"""Functions that can define a name of a module at run time."""

GENERATED = re.compile(r"\.(msg|srv|action|cfg|_?version)\b|_pb2\b|_pb2_grpc\b")
"""Names of modules that other tools write, such as those of the messages of a ROS package."""

_WORD = re.compile(r"[^\W\d]\w*")
_BLOCK = re.compile(
    r"\{%[-+]?\s*block\s+(?:base_)?imports\b[^%]*%\}(.*?)\{%[-+]?\s*endblock\b", re.S
)
_IMPORT = re.compile(r"^(?:from[ \t]+[\w.]+[ \t]+import[ \t]+(?:\([^()]*\)|.+)|import .+)$", re.M)


class Import(NamedTuple):
    """A statement that imports from a module, with the dotted name as it is written, its place, and
    the dotted name from the top. `names` are those that it imports from it, each at its place."""

    written: Word
    module: str
    names: tuple[Word, ...] = ()


def missing_imports(module: Module, library: UserCode) -> list[ClassFault]:
    """The imports of a module of the user that fail."""
    return [
        fault
        for statement in _statements(module)
        for fault in _faults(statement, library, module.text)
    ]


def missing_in_template(source: Source, library: UserCode) -> list[tuple[ClassFault, bool]]:
    """The imports in the block `imports` of a template that fail, each with whether it is certainly
    printed: the block has no tags of Jinja. A line with a tag is not judged."""
    return [
        (fault, is_printed)
        for statement, is_printed in _lines(source)
        for fault in _faults(statement, library)
    ]


def _statements(module: Module) -> Iterator[Import]:
    text = module.text
    for node in module.text.tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom) and not text.is_filled(text.span(node)):
            yield from _imports(node, text.span(node), module)


def _lines(source: Source) -> Iterator[tuple[Import, bool]]:
    for block in _BLOCK.finditer(source.text):
        is_printed = "{%" not in block[1]
        for found in _IMPORT.finditer(source.text, block.start(1), block.end(1)):
            if "{{" in found[0] or "{%" in found[0]:
                continue
            try:
                (node,) = parse_module(found[0]).body
            except (SyntaxError, ValueError):
                continue
            if isinstance(node, ast.Import | ast.ImportFrom):
                for statement in _imports(node, Span(source, found.start(), found.end()), None):
                    yield statement, is_printed


def _imports(
    node: ast.Import | ast.ImportFrom, span: Span, module: Module | None
) -> Iterator[Import]:
    """The imports of one statement at a place."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            yield Import(_placed(alias.name, span, 0), alias.name)
        return
    if node.level and (module is None or not module.name):
        return
    top = source_module(module, node) if module is not None else node.module or ""
    dots = "." * node.level
    written = _placed(f"{dots}{node.module or ''}", span, 0)
    if node.module:
        place = Span(span.source, written.span.start + node.level, written.span.end)
        written = Word(node.module, place)
    words = [alias.name for alias in node.names if alias.name != "*"]
    after = span.source.text.find("import", written.span.end) - span.start
    yield Import(written, top, tuple(_placed(word, span, max(after, 0) + 6) for word in words))


def _placed(name: str, span: Span, after: int) -> Word:
    """The place of a name in a statement, behind a number of its characters."""
    found = re.compile(rf"(?<![\w.]){re.escape(name)}(?![\w.])").search(
        span.source.text, span.start + after, span.end
    )
    start = found.start() if found is not None else span.start
    return Word(name, Span(span.source, start, start + len(name)))


def _faults(one: Import, library: UserCode, user: PythonText | None = None) -> Iterator[ClassFault]:
    """The faults of an import: of the module or a name, or of the text of the module. `user` is the
    code that has the import."""
    head, path = one.module.partition(".")[0], one.module.replace(".", "/")
    if not one.module or head in sys.stdlib_module_names:
        return
    files = (f"{path}/__init__.py", f"{path}.py")
    file = next((file for file in files if library.code(file) is not None), None)
    if file is not None:
        other = load_module(one.module, library)
        if isinstance(other, ClassFault):
            yield other
        elif other is not None:
            yield from _no_names(one, file, other, library, user)
        return
    folder = library.code_names(path)
    if not folder:
        yield from _no_module(one.module, one.written, library)
    elif any(is_module(text) for text in folder):
        for word in one.names:
            inner = f"{one.module}.{word.text}"
            other = load_module(inner, library)
            if isinstance(other, ClassFault):
                yield other
            elif other is None and not library.code_names(f"{path}/{word.text}"):
                for fault in _no_module(inner, word, library):
                    yield replace(fault, file=path)


def _no_names(
    one: Import, file: str, other: Module, library: UserCode, user: PythonText | None
) -> Iterator[ClassFault]:
    """The names that a module does not define."""
    words = set(_WORD.findall(other.text.source.text))
    if all(word.text in words for word in one.names):
        return
    if other.dynamic or makes_names(other.text.tree):
        return
    inside = library.code_names(file.rpartition("/")[0]) if other.package else ()
    known = {*other.names, *(text.partition(".")[0] for text in inside)}
    guess = guesser(sorted(name for name in known if not name.startswith("__")))
    for word in one.names:
        if word.text not in known | words and not word.text.startswith("__"):
            other_module = module_with(word.text, file, library) or ""
            near = guess(word.text)
            lines = _lines_with(word.text, user) if user is not None and near else ()
            help = _name_elsewhere(word.text, other_module, near, lines)
            yield ClassFault(kind=NO_IMPORTED_NAME, name=word, near=near, file=file, help=help)


def _name_elsewhere(name: str, module: str, near: str | None, lines: tuple[int, ...]) -> str:
    """The help for a name that another module defines, or that is also used in other lines."""
    if module:
        return f"import `{name}` from `{module}`, which defines it"
    if near is None or not lines:
        return ""
    numbers = ", ".join(map(str, lines))
    return f"did you mean `{near}`? Write it here and in line{'s' if lines[1:] else ''} {numbers}"


def _lines_with(name: str, user: PythonText) -> tuple[int, ...]:
    """The lines of code that use a name, each once."""
    found = (name for name in walk_code(user.tree) if isinstance(name, ast.Name))
    spans = [user.span(word) for word in found if word.id == name]
    return tuple(sorted({span.line for span in spans}))


def _no_module(name: str, place: Word, library: UserCode) -> Iterator[ClassFault]:
    """The fault that a module does not exist, at its name in an import, if another module has
    nearly the same name. Beside a folder that is no package, it can be an installed one: then the
    names are one slip apart."""
    if "." not in name or GENERATED.search(name):
        return
    found = absent_module(Word(name, place.span), library)
    if found is None or found.near is None:
        return
    exists = library.code(f"{found.near.replace('.', '/')}.py") is not None
    is_package = library.code(f"{name.partition('.')[0]}/__init__.py") is not None
    if not exists or not (is_package or guesser([found.near]).unique_match(name)):
        return
    near = found.near if "." in place.text else found.near.rpartition(".")[2]
    yield ClassFault(kind=NO_IMPORTED_MODULE, name=Word(name, place.span), near=near)


def makes_names(tree: ast.Module) -> bool:
    """Whether code of a module can define names in another way than by a statement at its top."""
    return any(isinstance(node, ast.Name) and node.id in MAKES_NAMES for node in walk_code(tree))

"""Circular imports of modules of the user: a name is imported from a module that has begun to load
and has not defined it yet.

The modules are loaded as Python does: in the order of the imports, each once. Only imports at the
top of a module are followed, not those in `if`, `try` or a function.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.pysource.modules.modules import Module, file_of, load_module, names_of, source_module
from smachac.pysource.modules.user_code import UserCode

CIRCULAR_IMPORT = FaultKind(
    name="circular import",
    message="`{word}` is not defined yet: `{file}` is still loading, and imports `{more}`"
    " before it defines `{word}`",
    help="import it in the function that uses it, or move `{word}` to a module that"
    " imports neither of the two",
    missing=True,
)

DEEPEST = 100
"""The most modules that load inside each other; Python's own limit is some hundreds."""


def circular_imports(modules: Iterable[str], library: UserCode) -> list[ClassFault]:
    """The first import that fails, where a program imports modules in this order. Python stops
    there."""
    loading = _Loading(library)
    for name in modules:
        for fault in loading.load(name, 0):
            return [fault]
    return []


class _Loading:
    """The modules that a program has begun to load: the statements that each has run, or None for a
    module that is complete or that is not one of the project."""

    def __init__(self, library: UserCode) -> None:
        self.library = library
        self.run: dict[str, list[ast.stmt] | None] = {}

    def load(self, name: str, depth: int) -> Iterator[ClassFault]:
        """Load a module with its packages; the faults of imports inside."""
        package = name.rpartition(".")[0]
        if package:
            yield from self.load(package, depth)
        if name in self.run or depth > DEEPEST:
            return
        self.run[name] = None
        module = load_module(name, self.library)
        if not isinstance(module, Module):
            return
        done: list[ast.stmt] = []
        self.run[name] = done
        for node in module.text.tree.body:
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield from self.load(alias.name, depth + 1)
            elif isinstance(node, ast.ImportFrom):
                yield from self._names(module, node, depth)
            done.append(node)
        self.run[name] = None

    def _names(self, module: Module, node: ast.ImportFrom, depth: int) -> Iterator[ClassFault]:
        source = source_module(module, node)
        yield from self.load(source, depth + 1)
        done = self.run.get(source)
        other = load_module(source, self.library) if done is not None else None
        if done is None or not isinstance(other, Module):
            return
        bound, dynamic = names_of(done)
        for alias in node.names:
            inner = f"{source}.{alias.name}"
            if other.package and alias.name not in bound:
                yield from self.load(inner, depth + 1)
                if inner in self.run and load_module(inner, self.library) is not None:
                    continue
            missing = alias.name in other.names and alias.name not in bound
            if missing and not dynamic and not other.dynamic and alias.name != "*":
                start = module.text.offset(alias.lineno, alias.col_offset)
                place = Span(module.text.source, start, start + len(alias.name))
                word = Word(alias.name, place)
                yield ClassFault(kind=CIRCULAR_IMPORT, name=word, file=file_of(other),
                                 more=file_of(module))  # fmt: skip

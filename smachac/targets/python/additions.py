"""What programs use of `runtime/additions.py`: imported from there, or, in a program that is one
file (`--option standalone=true`), as text."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from functools import cached_property

from smachac.ir.python_code import parse_module
from smachac.targets.runtime_files import runtime_files

MODULE = "smachac.runtime.additions"


class Additions:
    """The text of the module, read at its first use."""

    @cached_property
    def _text(self) -> str:
        return runtime_files({"additions.py": "additions.py"})["additions.py"]

    @cached_property
    def _tree(self) -> ast.Module:
        return parse_module(self._text)

    @cached_property
    def _definitions(self) -> dict[str, ast.stmt]:
        """The functions and classes, by name, in their order."""
        kinds = (ast.FunctionDef, ast.ClassDef)
        return {node.name: node for node in self._tree.body if isinstance(node, kinds)}

    @cached_property
    def classes(self) -> frozenset[str]:
        """The names of the classes, which are those of built-in state types."""
        return frozenset(
            name for name, node in self._definitions.items() if isinstance(node, ast.ClassDef)
        )

    def text(self, name: str) -> str:
        """The text of a function or class."""
        return ast.get_source_segment(self._text, self._definitions[name]) or ""

    def needed(self, names: Iterable[str]) -> list[str]:
        """These functions and classes, and those that they use, in the order of the module."""
        found: set[str] = set()
        waiting = [*names]
        while waiting:
            name = waiting.pop()
            if name in self._definitions and name not in found:
                found.add(name)
                waiting += _read(self._definitions[name])
        return [name for name in self._definitions if name in found]

    def imports(self, names: Iterable[str]) -> list[str]:
        """The imports of the standard library that these functions and classes need."""
        read = {word for name in names for word in _read(self._definitions[name])}
        return [
            ast.unparse(node)
            for node in self._tree.body
            if isinstance(node, ast.Import | ast.ImportFrom)
            and read.intersection(alias.name for alias in node.names).difference(["smach"])
        ]


def _read(tree: ast.AST) -> Iterator[str]:
    """The names that code reads."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            yield node.id

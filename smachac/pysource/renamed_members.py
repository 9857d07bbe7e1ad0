"""A name that a module of the project no longer has: the definition in it that has probably got
another name, since nothing uses it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from smachac.diagnostics.negation import are_unlike
from smachac.diagnostics.spelling import SHORTEST_PART, words_of
from smachac.pysource.modules import Module, file_of
from smachac.pysource.source import PythonText
from smachac.pysource.user_code import UserCode

_WORD = re.compile(r"\w+")


def renamed_member(
    name: str, other: Module, user: PythonText | None, library: UserCode
) -> str | None:
    """The definition of a module that nothing uses and that has a word of a missing name, or the
    only unused function with as many parameters as `user` passes arguments; None without exactly
    one."""
    numbers = _argument_numbers(name, user) if user is not None else None
    found = [each for each in _definitions(other)
             if not are_unlike(name, each) and _fits(other.names[each][-1], numbers)]  # fmt: skip
    unused = _unused(found, other, library) if found else []
    words = _words(name)
    alike = [each for each in unused if not words.isdisjoint(_words(each))]
    if not alike and numbers:
        alike = [each for each in unused if isinstance(other.names[each][-1], ast.FunctionDef)]
    return alike[0] if len(alike) == 1 else None


def _words(name: str) -> set[str]:
    return {each for each in words_of(name) if len(each) >= SHORTEST_PART}


def _definitions(module: Module) -> Iterator[str]:
    """The functions, plain classes and constants of a module."""
    for name, bound in module.names.items():
        match bound:
            case (ast.FunctionDef() | ast.Assign() | ast.AnnAssign(),):
                plain = True
            case (ast.ClassDef(bases=bases),):
                plain = not any(ast.unparse(each).endswith("State") for each in bases)
            case _:
                plain = False
        if plain and not name.startswith("_"):
            yield name


def _fits(definition: ast.AST, numbers: set[int] | None) -> bool:
    """Whether a definition can be called with each of some numbers of arguments."""
    if not numbers:
        return True
    if not isinstance(definition, ast.FunctionDef):
        return isinstance(definition, ast.ClassDef)
    args = definition.args
    most = len(args.posonlyargs) + len(args.args)
    return all(most - len(args.defaults) <= number <= most for number in numbers)


def _unused(names: Sequence[str], module: Module, library: UserCode) -> list[str]:
    """Those names of a module that neither it nor another file beside it or above it uses."""
    own = _WORD.findall(module.text.source.text)
    here = {name for name in names if own.count(name) == 1}
    file = file_of(module)
    folder = file.rpartition("/")[0]
    while here:
        for each in library.code_names(folder):
            path = f"{folder}/{each}".removeprefix("/")
            source = library.code(path) if each.endswith(".py") and path != file else None
            if source is not None:
                here -= {*_WORD.findall(source.text)}
        if not folder:
            break
        folder = folder.rpartition("/")[0]
    return [name for name in names if name in here]


def _argument_numbers(name: str, text: PythonText) -> set[int]:
    """How many arguments the calls of a name pass; empty if one of them is not known."""
    found = set[int]()
    for each in ast.walk(text.tree):
        match each:
            case ast.Call(func=ast.Name(id=called) | ast.Attribute(attr=called)) if called == name:
                if any(isinstance(one, ast.Starred) for one in each.args) or each.keywords:
                    return set()
                found.add(len(each.args))
    return found

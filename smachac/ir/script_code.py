"""Code of the script: its text with the trees of Python and of the portable subset, parsed once."""

from __future__ import annotations

import ast
from collections.abc import Collection
from functools import cached_property, lru_cache
from typing import NamedTuple

TYPE_CHECKING = False  # annotations only: few scripts contain code
if TYPE_CHECKING:
    from smachac.ir.expressions import Expr


class Fields(NamedTuple):
    """The keys of userdata that code reads, in order, and those that it tests with `in`."""

    read: tuple[str, ...]
    tested: frozenset[str]


USERDATA = ("ud", "userdata")
"""The usual names of userdata."""

_METHODS = frozenset(["keys", "update", "extract", "merge"])


class ScriptCode:
    """A text of code and the facts about it, each computed at its first use. Nobody may change the
    trees."""

    def __init__(self, text: str) -> None:
        self.text = text

    @cached_property
    def tree(self) -> ast.expr | None:
        """The syntax tree as Python reads the text; None if it is not valid."""
        from smachac.ir.python_code import parse_code

        try:
            return parse_code(self.text)
        except SyntaxError:
            return None

    @cached_property
    def portable(self) -> Expr | None:
        """The tree of a portable expression; None if the text is other code."""
        from smachac.ir.expressions import parse_expression

        return parse_expression(self.text)

    @cached_property
    def free_names(self) -> tuple[ast.Name, ...]:
        """The names that the code reads and does not bind; none if it is not valid."""
        return tuple(free_names(self.tree)) if self.tree is not None else ()

    @cached_property
    def function(self) -> tuple[ast.expr, frozenset[str]] | None:
        """The value of a lambda over userdata, or of an expression over `ud`, and the names that
        the userdata has in it; None if the code is neither, or cannot be called with userdata
        alone."""
        text = self.text.strip()
        body = self.tree if text == self.text else script_code(text).tree
        if isinstance(body, ast.Lambda):
            arguments = [*body.args.posonlyargs, *body.args.args]
            names = frozenset(argument.arg for argument in arguments[:1])
            if len(arguments) - len(body.args.defaults) != 1 or _reads_another(body, names):
                return None  # SM317, SM019
            return body.body, names
        names = frozenset(USERDATA)
        if body is None:
            return None
        used = any(isinstance(node, ast.Name) and node.id in names for node in ast.walk(body))
        return (body, names) if used else None

    @cached_property
    def fields(self) -> Fields | None:
        """The keys that a lambda over userdata, or an expression over `ud`, reads; None if not
        known.

        They are not known where the code passes userdata on, has another name for it than its
        argument, does not accept it alone, or is the name of a function.
        """
        return None if self.function is None else fields_of(*self.function)


# Cached, because many analyses read each text, which states often share: without, a check of 1,000
# states with a callback each takes 30 % more instructions, and one of 1,000 mixed states 10 %.
@lru_cache(maxsize=10_000)
def script_code(text: str) -> ScriptCode:
    """The code of a text."""
    return ScriptCode(text)


def _reads_another(tree: ast.Lambda, names: frozenset[str]) -> bool:
    """Whether a lambda reads userdata by a name that is not its argument."""
    bound = names.union(node.arg for node in ast.walk(tree) if isinstance(node, ast.arg))
    others = [name for name in USERDATA if name not in bound]
    return any(isinstance(node, ast.Name) and node.id in others for node in ast.walk(tree.body))


def fields_of(body: ast.expr, names: Collection[str]) -> Fields | None:
    """The keys that code reads of userdata, which has these names; None if not known."""

    def is_userdata(node: ast.expr) -> bool:
        return isinstance(node, ast.Name) and node.id in names

    read: dict[str, None] = {}
    tested: set[str] = set()
    uses = 0
    for node in ast.walk(body):
        match node:
            case ast.Name(id=name) if name in names:
                uses += 1
            case ast.Attribute(value=value, attr=key) if is_userdata(value):
                uses -= key not in _METHODS
                read[key] = None
            case ast.Subscript(value=value, slice=ast.Constant(str() as key)) if is_userdata(value):
                uses -= 1
                read[key] = None
            case ast.Compare(
                left=ast.Constant(str() as key),
                ops=[ast.In() | ast.NotIn()],
                comparators=[value],
            ) if is_userdata(value):
                uses -= 1
                tested.add(key)
    return None if uses else Fields(tuple(read), frozenset(tested))


def free_names(tree: ast.AST) -> list[ast.Name]:
    """The names that code reads and does not bind itself, in the order of the text.

    A name that `:=` binds is one of its function, everywhere in it.
    """
    found: list[tuple[ast.Name, tuple[set[str], ...]]] = []
    todo: list[tuple[ast.AST, tuple[set[str], ...]]] = [(tree, (set(),))]
    while todo:
        node, scopes = todo.pop()
        match node:
            case ast.Name():
                if isinstance(node.ctx, ast.Load):
                    found.append((node, scopes))
            case ast.Lambda(args=args, body=body):
                own = {node.arg for node in ast.walk(args) if isinstance(node, ast.arg)}
                defaults = [default for default in (*args.defaults, *args.kw_defaults) if default]
                todo.extend((default, scopes) for default in defaults)
                todo.append((body, (own, *scopes)))
            case ast.ListComp() | ast.SetComp() | ast.DictComp() | ast.GeneratorExp():
                inner = (scopes[0], _stored(node), *scopes[1:])
                todo.extend((child, inner) for child in ast.iter_child_nodes(node))
            case _:
                if isinstance(node, ast.NamedExpr):
                    scopes[0].add(node.target.id)
                todo.extend((child, scopes) for child in ast.iter_child_nodes(node))
    free = [name for name, scopes in found if not any(name.id in scope for scope in scopes)]
    return sorted(free, key=lambda name: (name.lineno, name.col_offset))


def _stored(node: ast.AST) -> set[str]:
    return {
        name.id
        for name in ast.walk(node)
        if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)
    }

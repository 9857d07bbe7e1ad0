"""Operations on userdata keys in `execute`, numbers that it writes to keys, and comparisons of
variables and keys with texts."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Literal, TypedDict

from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import Compared, TableLookUp
from smachac.pysource.modules.functions import access_of, tried_code
from smachac.pysource.modules.modules import Module, OwnClass, of_other_objects
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.values.userdata_parts import TESTS, added_entries, written_keys

PURE = frozenset(["len", "abs", "min", "max", "round", "sum", "int", "float", "bool"])
"""Functions of Python that the types of expressions know (analysis/expression_types.py)."""

NUMBERS = frozenset(
    ["acos", "asin", "atan", "atan2", "ceil", "copysign", "cos", "degrees", "dist", "exp", "fabs",
     "floor", "fmod", "hypot", "log", "log10", "pow", "radians", "sin", "sqrt", "tan"]
)  # fmt: skip
"""Functions of the module `math` that return one number."""


class OperationFacts(TypedDict, total=False):
    operations: tuple[Word, ...]
    userdata: str
    numbers: tuple[Span, ...]
    collections: tuple[tuple[Span, Literal["list", "dict"]], ...]
    entries: frozenset[str] | None


def operation_facts(own: OwnClass, execute: ast.FunctionDef | None) -> OperationFacts:
    """The facts about the operations of `execute`."""
    if execute is None:
        return {}
    module = next(module for module, node in own.classes if execute in node.body)
    return {
        "operations": operations(module, execute),
        "userdata": execute.args.args[1].arg,
        "numbers": number_writes(module, execute),
        "collections": tuple(collection_writes(module, execute)),
        "entries": added_entries(own, execute),
    }


def operations(module: Module, function: ast.FunctionDef) -> tuple[Word, ...]:
    """The comparisons and calculations of `execute` over nothing but userdata keys and constants.
    Not those of keys that it writes, and those in `try`; nothing if it tests the types of values.
    """
    userdata = function.args.args[1].arg
    every = [*walk_code(function)]
    if any(isinstance(node, ast.Name) and node.id in TESTS for node in every):
        return ()
    tried, written = tried_code(every), written_keys(every, userdata)
    bound = {argument.arg for argument in every if isinstance(argument, ast.arg)} - {userdata}
    names = (PURE - module.names.keys() - bound) | {userdata}
    found = []
    todo: list[ast.AST] = [*reversed(function.body)]
    while todo:
        node = todo.pop()
        if node in tried:
            continue
        if isinstance(node, ast.Compare | ast.BinOp) and _is_known(node, userdata, names, written):
            span = module.text.span(node)
            if not module.text.is_filled(span):
                found.append(Word(span.text, span))
            continue
        parts = [*ast.iter_child_nodes(node)]
        if isinstance(node, ast.Call):  # `all(...)` of an array of numpy
            parts = [part for part in parts if not isinstance(part, ast.Compare)]
        todo.extend(reversed(parts))
    return tuple(found)


def _is_known(
    node: ast.expr, userdata: str, names: frozenset[str] | set[str], written: frozenset[str]
) -> bool:
    """Whether an expression has no names but those of the userdata and of pure functions, and reads
    a key that the code does not write."""
    every = [*walk_code(node)]
    used = {name.id for name in every if isinstance(name, ast.Name)}
    keys = {found.key for node in every if (found := access_of(node, userdata)) is not None}
    return used <= names and bool(keys) and not keys & written


def _written_values(every: list[ast.AST], userdata: str) -> list[ast.expr]:
    """The values of the assignments to one userdata key each."""
    return [
        assignment.value
        for assignment in every
        if isinstance(assignment, ast.Assign)
        and len(assignment.targets) == 1
        and access_of(assignment.targets[0], userdata) is not None
    ]


def number_writes(module: Module, function: ast.FunctionDef) -> tuple[Span, ...]:
    """The places of the values that `execute` writes to userdata keys and that are one number."""
    every = [*walk_code(function)]
    values = _written_values(every, function.args.args[1].arg)
    if not values:
        return ()
    local = dict(bound_once(every))
    found = (value for value in values if _is_number(value, module, local, 10))
    return tuple(module.text.span(node) for node in found)


def collection_writes(
    module: Module, function: ast.FunctionDef
) -> Iterator[tuple[Span, Literal["list", "dict"]]]:
    """The places of the values that `execute` writes to userdata keys and that are a list or a
    dictionary, also in a local variable."""
    every = [*walk_code(function)]
    values = _written_values(every, function.args.args[1].arg)
    if not values:
        return
    local = dict(bound_once(every))
    bound = {argument.arg for argument in every if isinstance(argument, ast.arg)} | local.keys()
    for value in values:
        match local.get(value.id) if isinstance(value, ast.Name) else value:
            case ast.List() | ast.ListComp():
                yield module.text.span(value), "list"
            case ast.Dict() | ast.DictComp():
                yield module.text.span(value), "dict"
            case ast.Call(func=ast.Name(id="list" | "sorted" | "dict" as name)):
                if name not in module.names and name not in bound:
                    yield module.text.span(value), "dict" if name == "dict" else "list"


def bound_once(every: list[ast.AST]) -> Iterator[tuple[str, ast.expr]]:
    """The local names that are bound once, by an assignment, each with its value."""
    stored = [name for name in every if isinstance(name, ast.Name)]
    bound = Counter(name.id for name in stored if not isinstance(name.ctx, ast.Load))
    bound.update(argument.arg for argument in every if isinstance(argument, ast.arg))
    for node in every:
        match node:
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                bound.update(names)
                bound.update(names)
    for node in every:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if bound[name] == 1:
                yield name, value


def _is_number(node: ast.expr, module: Module, local: Mapping[str, ast.expr], depth: int) -> bool:
    """Whether the value of an expression is one number, whatever its names are."""

    def known(*nodes: ast.expr) -> bool:
        return depth > 0 and all(_is_number(node, module, local, depth - 1) for node in nodes)

    match node:
        case ast.Constant(value=int() | float() as value):
            return not isinstance(value, bool)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=inner):
            return known(inner)
        case ast.BinOp(left=left, right=right):
            return known(left, right)
        case ast.IfExp(body=body, orelse=other):
            return known(body, other)
        case ast.Name(id=name):
            return name in local and known(local[name])
        case ast.Attribute(value=ast.Name(id="math"), attr="pi" | "tau" | "e"):
            return _is_math(module)
        case ast.Call(func=ast.Attribute(value=ast.Name(id="math"), attr=name)):
            return name in NUMBERS and _is_math(module)
        case ast.Call(func=ast.Name(id="float" | "int" | "len" as name)):
            return name not in module.names and name not in local
        case ast.Call(func=ast.Name(id="abs" | "round" as name), args=[first, *_]):
            return name not in module.names and known(first)
    return False


def _is_math(module: Module) -> bool:
    """Whether the name `math` is the module of Python."""
    match module.names.get("math", ()):
        case (ast.Import(names=names),):
            return any(name.name == "math" and name.asname is None for name in names)
    return False


# --- comparisons with texts


def compared_texts(
    own: OwnClass, kept: Mapping[str, str], execute: ast.FunctionDef | None
) -> Iterator[Compared]:
    """The texts with which a class compares its attributes that are a parameter of the constructor
    for ever (`kept`), and the keys that `execute` does not write; not the default values of
    parameters."""
    userdata = execute.args.args[1].arg if execute is not None else ""
    written = written_keys([*walk_code(execute)], userdata) if execute is not None else frozenset()
    defaults = _defaults(own)
    for module, node in own.classes:
        others = of_other_objects(node)
        inside = {*walk_code(execute)} if execute in node.body and execute is not None else set()
        for inner in walk_code(node):
            for side, texts in _equalities(inner) if inner not in others else ():
                key = access_of(side, userdata) if inner in inside else None
                match side:
                    case ast.Attribute(value=ast.Name(id="self"), attr=name) if name in kept:
                        found = kept[name]
                    case _ if key is not None and key.key not in written:
                        found = key.key
                    case _:
                        continue
                owner = module.text.span(side).text
                for text in texts:
                    span = module.text.span(text)
                    known = key is None and text.value in defaults.get(found, ())
                    if not known and not module.text.is_filled(span):
                        word = Word(str(text.value), span)
                        yield Compared("key" if key else "variable", found, owner, word)


def _equalities(node: ast.AST) -> Iterator[tuple[ast.expr, list[ast.Constant]]]:
    """The values that a comparison or `match` compares with texts, each with the texts."""
    match node:
        case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[right]):
            yield left, _texts([right])
            yield right, _texts([left])
        case ast.Compare(left=left, ops=[ast.In() | ast.NotIn()], comparators=[right]):
            if isinstance(right, ast.List | ast.Tuple | ast.Set):
                yield left, _texts(right.elts)
        case ast.Match(subject=subject, cases=cases):
            patterns = [part for case in cases for part in _alternatives(case.pattern)]
            yield subject, _texts([pattern.value for pattern in patterns
                                   if isinstance(pattern, ast.MatchValue)])  # fmt: skip


def _alternatives(pattern: ast.pattern) -> list[ast.pattern]:
    return pattern.patterns if isinstance(pattern, ast.MatchOr) else [pattern]


def _texts(nodes: list[ast.expr]) -> list[ast.Constant]:
    return [node for node in nodes
            if isinstance(node, ast.Constant) and isinstance(node.value, str)]  # fmt: skip


def _defaults(own: OwnClass) -> dict[str, list[object]]:
    """The default values of the parameters of the constructor that are constants."""
    found = own.method("__init__")
    if found is None:
        return {}
    taken = found[1].args
    positional = [*taken.posonlyargs, *taken.args]
    pairs = [*zip(reversed(positional), reversed(taken.defaults), strict=False)]
    pairs += [(argument, default) for argument, default in
              zip(taken.kwonlyargs, taken.kw_defaults, strict=True) if default]  # fmt: skip
    return {argument.arg: [default.value] for argument, default in pairs
            if isinstance(default, ast.Constant)}  # fmt: skip


# --- tables of the module


def table_look_ups(
    own: OwnClass, kept: Mapping[str, str], execute: ast.FunctionDef | None
) -> Iterator[TableLookUp]:
    """The look-ups of variables and keys in a dictionary with constant keys that nothing changes:
    `BINS[self.side]`; not those in `try`, and not where the class tests the keys."""
    userdata = execute.args.args[1].arg if execute is not None else ""
    for module, node in own.classes:
        every = [*walk_code(node)]
        left_out = of_other_objects(node) | tried_code(every)
        for inner in every:
            match inner:
                case ast.Subscript(value=ast.Name(id=name), slice=index, ctx=ast.Load()):
                    pass
                case _:
                    continue
            key = access_of(index, userdata) if execute in node.body else None
            match index:
                case ast.Attribute(value=ast.Name(id="self"), attr=attribute) if attribute in kept:
                    found = kept[attribute]
                case _ if key is not None:
                    found = key.key
                case _:
                    continue
            table = _table(module, name) if inner not in left_out else None
            if table is not None and not module.text.is_filled(module.text.span(inner)):
                span = module.text.span(inner)
                kind: Literal["key", "variable"] = "key" if key is not None else "variable"
                yield TableLookUp(kind, found, name, table, Word(span.text, span))


def _table(module: Module, name: str) -> tuple[Word, ...] | None:
    """The texts that are the keys of a dictionary of a module, which its code uses only for
    look-ups; None for another value."""
    match module.names.get(name, ()):
        case (ast.Assign(targets=[ast.Name()], value=ast.Dict(keys=keys)),):
            pass
        case _:
            return None
    every = module.nodes
    uses = [word for word in every if isinstance(word, ast.Name) and word.id == name]
    looked_up = {node.value for node in every
                 if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Load)}  # fmt: skip
    texts = _texts([key for key in keys if key is not None])
    stores = [use for use in uses if isinstance(use.ctx, ast.Store)]
    if len(texts) != len(keys) or not texts or len(stores) != 1:
        return None
    if any(use not in looked_up for use in uses if use not in stores):
        return None
    return tuple(Word(str(text.value), module.text.span(text)) for text in texts)

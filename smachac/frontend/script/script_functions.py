"""Functions of the user that a script names as code: `callbacks: {best: choose_best}`.

A program gets them from the templates of the user, which define them or import them from modules
of the project. They are read, never run.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from smachac.diagnostics.source import Span, Word
from smachac.frontend.loader import Library
from smachac.frontend.resolved_script import State
from smachac.frontend.types.smacha_meta import extended
from smachac.ir.argument_parts import argument_uses, own_names, result_of
from smachac.ir.function_facts import FunctionFacts
from smachac.ir.nodes import Data, Expression, StateType, Struct
from smachac.ir.script_code import script_code
from smachac.pysource.flow.flow import Flows
from smachac.pysource.modules.functions import alternatives, is_plain, returns_of
from smachac.pysource.modules.modules import Module, OwnClass, find_function, template_module
from smachac.pysource.modules.source import name_span
from smachac.pysource.templates.template_sources import TEMPLATE_FILES

_NAME = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*)*")


def functions_of(
    base: State, types: Mapping[str, StateType | None], library: Library
) -> dict[str, FunctionFacts]:
    """The functions that the states of a script name, by the text in the script."""
    modules = list(_modules(types, library))
    if not modules:
        return {}
    found: dict[str, FunctionFacts] = {}
    for text in dict.fromkeys(_names(base)):
        facts = next((fact for fact in _facts(text, modules, library) if fact is not None), None)
        if facts is not None:
            found[text] = facts
    return found


def _names(base: State) -> Iterator[str]:
    """The texts in the variables of all states that can be the name of a function."""
    todo = [base]
    while todo:
        state = todo.pop()
        todo += state.states
        for held in state.variables:
            yield from _names_in(held.value.data)


def _names_in(data: Data) -> Iterator[str]:
    match data:
        case Struct(entries=entries):
            for _, value in entries:
                yield from _names_in(value)
        case str() | Expression():
            text = data if isinstance(data, str) else data.text
            text = text.strip("` ")
            text = text.partition("(")[0] if text.endswith(")") else text  # a call
            if _NAME.fullmatch(text):
                yield text


def _modules(types: Mapping[str, StateType | None], library: Library) -> Iterator[Module]:
    """The Python in the user's templates of the base and of the states of a script, and in those
    that they extend."""
    seen: set[str] = set()
    todo = [name for name, type_ in types.items() if type_ is not None and not type_.built_in]
    while todo:
        name = todo.pop()
        if name in seen:
            continue
        seen.add(name)
        for pattern in TEMPLATE_FILES:
            source = library.own_template(pattern.format(name))
            module = template_module(source) if source is not None else None
            if source is not None:
                todo.append(extended(source).partition(".")[0])
            if module is not None:
                yield module


def _facts(
    text: str, modules: Iterable[Module], library: Library
) -> Iterator[FunctionFacts | None]:
    """The facts about the function of a name in each module; None where it has none, or one that is
    not called as it is defined."""
    called = script_code(text).tree
    for module in modules if called is not None else ():
        try:
            found = find_function(module, called, library) if called is not None else None
            yield _function(*found, library) if found is not None else None
        except (RecursionError, MemoryError, ValueError):
            return


def _function(module: Module, function: ast.FunctionDef, library: Library) -> FunctionFacts | None:
    text, given = module.text, function.args
    if not is_plain(function) or text.is_filled(text.span(function)):
        return None
    if None in given.kw_defaults:  # a keyword that no state passes
        return None
    positional = [*given.posonlyargs, *given.args]
    unknown = OwnClass(classes=(), names=(), root="unknown")
    first = positional[0].arg if positional else ""
    flow = Flows(unknown, library).of(module, function, first) if first else None
    values = [
        returned.value for returned in returns_of(function.body) if returned.value is not None
    ]
    ends = not isinstance(function.body[-1], ast.Raise)
    parameters = tuple(argument.arg for argument in positional)
    own = set(own_names(function.body, parameters))
    places = _places(module, function)
    word = Word(function.name, name_span(text, function))
    return FunctionFacts(
        word=word,
        head=_head(module, positional) or word.span,
        parameters=parameters,
        least=len(positional) - len(given.defaults),
        most=None if given.vararg is not None else len(positional),
        silent=not values and ends and not _is_sketch(function),
        results=tuple(
            result_of(one, own, places) for value in values for one in alternatives(value)
        ),
        reads=flow.reads if flow is not None else (),
        writes=flow.writes if flow is not None else (),
        used=_used(function),
        uses=argument_uses(_nodes(function), own, places),
    )


def _used(function: ast.FunctionDef) -> tuple[str, ...]:
    """The parameters of a function that its body reads."""
    read = {node.id for line in function.body for node in ast.walk(line)
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}  # fmt: skip
    given = [*function.args.posonlyargs, *function.args.args]
    return tuple(argument.arg for argument in given if argument.arg in read)


def _places(module: Module, function: ast.FunctionDef) -> Callable[[ast.expr], Span]:
    """The spans of the expressions in a function: of one in a formatted text that of this text,
    where Python gives no exact place."""
    formatted = {
        node: text
        for text in _nodes(function)
        if isinstance(text, ast.JoinedStr)
        for node in ast.walk(text)
    }

    def place(node: ast.expr) -> Span:
        span = module.text.span(node)
        text = formatted.get(node)
        exact = text is None or span.text == ast.unparse(node)
        return span if exact or text is None else module.text.span(text)

    return place


def _nodes(function: ast.FunctionDef) -> list[ast.AST]:
    """The parts of the body of a function, in the order of its lines."""
    return [node for line in function.body for node in ast.walk(line)]


def _head(module: Module, positional: Sequence[ast.arg]) -> Span | None:
    """The place of the positional parameters of a function."""
    if not positional:
        return None
    first, last = positional[0], positional[-1]
    start = module.text.offset(first.lineno, first.col_offset)
    end = module.text.offset(last.end_lineno or last.lineno, last.end_col_offset or 0)
    return Span(module.text.source, start, end)


def _is_sketch(function: ast.FunctionDef) -> bool:
    """Whether a function is not written yet: it has no code but a text or `...`."""
    return all(
        isinstance(node, ast.Pass)
        or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))
        for node in function.body
    )

"""Results that `execute` loses: a helper whose outcome nothing uses, an outcome alone in a line,
and a name that has no value after an `except`."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator

from smachac.diagnostics.source import Word
from smachac.diagnostics.wording import listed
from smachac.ir.class_facts import ANY, ClassFault, FaultKind
from smachac.ir.code_slips import texts_of
from smachac.ir.outcome_names import PREEMPTED
from smachac.pysource.flow.path_ends import PathEnds
from smachac.pysource.modules.functions import is_plain, returns_of
from smachac.pysource.modules.modules import Module, OwnClass, find_function
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

LOST_OUTCOME = FaultKind(
    name="lost outcome",
    message="the result of `{word}` ({more}) is not used",
    help="write `{near}`",
    effect="`execute` goes on, and the outcome is lost",
    accepted=True,
)
LOST_TEXT = FaultKind(
    name="lost text",
    message="the line `{word}` does nothing: `execute` goes on",
    help="write `return {word}`",
    effect="",
    accepted=True,
)
NO_VALUE = FaultKind(
    name="no value",
    message="`{word}` has no value here if `{more}` was taken",
    help="end the `{more}` with `{near}`, or set `{word}` in it",
    effect="the code raises UnboundLocalError when it runs: the machine stops",
    accepted=True,
)

_Nested = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda
_Parts = ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp
_Leaves = ast.Return | ast.Raise | ast.Break | ast.Continue


def lost_outcomes(own: OwnClass, library: UserCode) -> list[ClassFault]:
    """The lines of `execute` that make an outcome and do not return it, and its names that have no
    value after an `except`."""
    found = own.method("execute")
    outcomes = [*_listed_outcomes(own)]
    if found is None or not is_plain(found[1]):
        return []
    module, execute = found
    faults = [*_alone(own, module, execute, outcomes)]
    if outcomes and not any(fault.kind is LOST_TEXT for fault in faults):
        faults += _unbound(own, module, execute, outcomes, library)
    return faults


def _listed_outcomes(own: OwnClass) -> Iterator[str]:
    """The outcomes that the constructors of a class and of its base classes list."""
    for _, node in own.classes:
        for inner in walk_code(node):
            match inner:
                case ast.keyword(
                    arg="outcomes", value=ast.List(elts=items) | ast.Tuple(elts=items)
                ):
                    pass
                case _:
                    continue
            for item in items:
                if isinstance(item, ast.Constant) and isinstance(item.value, str):
                    yield item.value


# --- outcomes that are not returned


def _alone(
    own: OwnClass, module: Module, execute: ast.FunctionDef, outcomes: Collection[str]
) -> Iterator[ClassFault]:
    returned = {returned.value.value for returned in returns_of(execute.body)
                if isinstance(returned.value, ast.Constant)}  # fmt: skip
    ends = {id(line) for line in _last_lines(execute.body)}  # SM309
    local = {name.id for name in walk_code(execute)
             if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)}  # fmt: skip
    for statement in _statements(execute.body):
        span = module.text.span(statement)
        if (
            not isinstance(statement, ast.Expr)
            or id(statement) in ends
            or module.text.is_filled(span)
        ):
            continue
        match statement.value:
            case ast.Constant() | ast.IfExp() as value if statement is not execute.body[0]:
                words = texts_of(value)
                known = {*words} <= {*outcomes} if outcomes else all(map(str.isidentifier, words))
                if words and known:
                    word = Word(" ".join(span.text.split()), span)
                    yield ClassFault(kind=LOST_TEXT, name=word, outcomes=words)
            case ast.Name(id=name) if name in local:
                yield ClassFault(kind=LOST_TEXT, name=Word(name, span), outcomes=(ANY,))
            case ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr=name)):
                names, whole, answers = _results(own, name)
                if not names or not names <= {*outcomes}:
                    continue
                if answers or not names & returned:
                    near = f"return {span.text}"
                    if not whole:
                        near = f"outcome = {span.text}`, and return `outcome` if it is not `None"
                    lost = sorted(names)
                    yield ClassFault(kind=LOST_OUTCOME, name=Word(span.text, span), near=near,
                                     more=listed(lost), outcomes=tuple(lost))  # fmt: skip


def _results(own: OwnClass, name: str) -> tuple[set[str], bool, bool]:
    """The texts that a method of the class returns, whether each path returns one, and whether it
    answers a stop request; no texts if it returns anything else."""
    found = own.method(name)
    if found is None or not is_plain(found[1]) or name in own.assigned():
        return set(), False, False
    module, function = found
    values = [returned.value for returned in returns_of(function.body)]
    texts = {value.value for value in values
             if isinstance(value, ast.Constant) and isinstance(value.value, str)}  # fmt: skip
    nothing = [value for value in values if value is None or _is_none(value)]
    if sum(map(_is_text, values)) + len(nothing) != len(values):
        return set(), False, False
    whole = not nothing and PathEnds(module.names, lambda _: False).block(function.body)
    answers = PREEMPTED in texts and any(
        isinstance(node, ast.Attribute) and node.attr == "service_preempt"
        for node in walk_code(function)
    )
    return texts, whole, answers


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _is_text(node: ast.expr | None) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements of a function, without those of functions in it."""
    todo: list[ast.AST] = [*reversed(body)]
    while todo:
        each = todo.pop()
        if isinstance(each, _Nested):
            continue
        if isinstance(each, ast.stmt):
            yield each
        if isinstance(each, ast.stmt | ast.ExceptHandler | ast.match_case):
            todo += reversed([*ast.iter_child_nodes(each)])


def _last_lines(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The lines after which control comes to the end of statements."""
    last = body[-1]
    yield last
    match last:
        case ast.If(body=inner, orelse=other):
            blocks = [inner, other]
        case ast.With(body=inner):
            blocks = [inner]
        case ast.Try(body=inner, handlers=handlers, orelse=other):
            blocks = [inner, other, *(handler.body for handler in handlers)]
        case ast.Match(cases=cases):
            blocks = [case_.body for case_ in cases]
        case _:
            return
    for block in filter(None, blocks):
        yield from _last_lines(block)


# --- names without a value


def _unbound(
    own: OwnClass,
    module: Module,
    execute: ast.FunctionDef,
    outcomes: Collection[str],
    library: UserCode,
) -> Iterator[ClassFault]:
    """Names that only the body of a `try` sets, and that the lines after it use although an
    `except` goes on. Code in loops is not judged: an earlier round can have set the name."""
    every = [*walk_code(execute)]
    if any(isinstance(node, ast.Global | ast.Nonlocal | ast.Delete) for node in every):
        return
    ends = PathEnds(module.names, lambda called: _can_raise(own, module, called, library))
    rest = tuple(outcome for outcome in outcomes if outcome != PREEMPTED)
    text = {constant.value for constant in every if isinstance(constant, ast.Constant)}
    unused = [word for word in rest if word not in text]
    near = f'return "{unused[0]}"' if len(unused) == 1 else "return ..."
    for block in _blocks(execute.body):
        for at, node in enumerate(block):
            if not isinstance(node, ast.Try) or node.finalbody:
                continue
            open_ = [handler for handler in node.handlers
                     if not ends.block(handler.body) and not _leaves(handler)]  # fmt: skip
            names = _set_only_in(node, execute, every) if open_ else set()
            use = _first_use(block[at + 1 :], names) if names else None
            if use is None or module.text.is_filled(module.text.span(execute)):
                continue
            head = _head(open_[0], module)
            place = Word(use.id, module.text.span(use))
            yield ClassFault(kind=NO_VALUE, name=place, near=near, more=head, outcomes=rest)
            return


def _leaves(node: ast.AST) -> bool:
    """Whether code has a statement that leaves it, perhaps under a condition."""
    return any(isinstance(inner, _Leaves) for inner in walk_code(node))


def _head(handler: ast.ExceptHandler, module: Module) -> str:
    if handler.type is None:
        return "except"
    return f"except {module.text.span(handler.type).text}"


def _blocks(body: list[ast.stmt]) -> Iterator[list[ast.stmt]]:
    """The lists of statements of a function outside loops and `try`."""
    todo = [body]
    while todo:
        block = todo.pop()
        yield block
        for node in block:
            if isinstance(node, ast.If):
                todo += [node.body, node.orelse]
            elif isinstance(node, ast.With):
                todo.append(node.body)


def _set_only_in(node: ast.Try, execute: ast.FunctionDef, every: list[ast.AST]) -> set[str]:
    """The names that only the body of a `try` sets, behind or by a call that can fail."""
    calls = [(inner.lineno, inner.col_offset) for line in node.body for inner in walk_code(line)
             if isinstance(inner, ast.Call)]  # fmt: skip
    inner = [inner for line in (*node.body, *node.orelse) for inner in walk_code(line)]
    stores = [name for name in inner if isinstance(name, ast.Name)
              and isinstance(name.ctx, ast.Store)]  # fmt: skip
    lines = {name: min(store.lineno for store in stores if store.id == name)
             for name in {store.id for store in stores}}  # fmt: skip
    found = {name for name, line in lines.items() if any(at <= line for at, _ in calls)}
    mine = {id(store) for store in stores}
    for item in every:
        match item:
            case ast.Name(id=name, ctx=ast.Store()) if id(item) not in mine:
                found.discard(name)
            case ast.arg(arg=name) | ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                found.discard(name)
            case ast.alias(name=name, asname=other):
                found.discard(other or name.partition(".")[0])
            case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
                found.discard(name)
            case ast.MatchStar(name=str(name)) | ast.MatchMapping(rest=str(name)):
                found.discard(name)
    return found


def _first_use(block: list[ast.stmt], names: set[str]) -> ast.Name | None:
    """The first use of one of the names that every path through statements reaches."""
    for node in block:
        for part in _certain(node):
            if isinstance(part, ast.Name) and part.id in names and isinstance(part.ctx, ast.Load):
                return part
        if isinstance(node, ast.Try) or _leaves(node):
            return None
    return None


def _certain(node: ast.stmt) -> Iterator[ast.AST]:
    """The nodes of a statement that are evaluated whatever its conditions are."""
    match node:
        case ast.If(test=value) | ast.While(test=value) | ast.For(iter=value):
            todo: list[ast.AST] = [value]
        case ast.Assign() | ast.AugAssign() | ast.AnnAssign() | ast.Expr() | ast.Return():
            todo = [node]
        case _:
            todo = []
    while todo:
        each = todo.pop()
        if isinstance(each, _Nested | _Parts):
            continue
        yield each
        match each:
            case ast.BoolOp(values=[first, *_]) | ast.IfExp(test=first):
                todo.append(first)
            case ast.AnnAssign(value=given):
                todo += [given] if given is not None else []
            case _:
                todo += reversed([*ast.iter_child_nodes(each)])


def _can_raise(own: OwnClass, module: Module, called: ast.expr, library: UserCode) -> bool:
    """Whether a called function of the user has a `raise`, or is not known in its class."""
    match called:
        case ast.Attribute(value=ast.Name(id="self"), attr=name):
            found = own.method(name)
        case _:
            found = find_function(module, called, library)
    return found is not None and any(isinstance(node, ast.Raise) for node in walk_code(found[1]))

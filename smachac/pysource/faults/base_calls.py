"""Calls of the constructor of a base class of the project, against its parameters."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.modules.functions import alternatives, returns_of
from smachac.pysource.modules.modules import Module, Names, OwnClass
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code

NO_BASE_ARGUMENT = FaultKind(
    name="no base argument",
    message="`__init__` of `{owner}` has no parameter `{word}`",
    help="its parameters are {more}",
    near_help=SUGGESTION,
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
ARGUMENT_TWICE = FaultKind(
    name="argument twice",
    message="`__init__` of `{owner}` gets `{word}` twice: by its place, and by its name",
    help="remove one of the two arguments",
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
TOO_MANY_ARGUMENTS = FaultKind(
    name="too many arguments",
    message="`__init__` of `{owner}` has no parameter for `{word}`",
    help="its parameters are {more}",
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
MISSING_BASE_ARGUMENT = FaultKind(
    name="missing base argument",
    message="`__init__` of `{owner}` requires {more}, which this call does not pass",
    help="its parameters are {near}",
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
OTHER_LISTS = FaultKind(
    name="other lists",
    message="the outcomes `{word}` are passed as `{more}` of `__init__` of `{owner}`, and"
    " `{file}` as `outcomes`",
    help="pass them in the order of its parameters: {near}",
    effect="the state does not have the outcomes that it returns: the machine stops with an error",
)


class _Call(NamedTuple):
    """A call of the constructor of the class `owner` with the parameters `taken`, in the
    constructor `maker` of a derived class. `arguments` are those without `self`, `base` is the
    constructor that is called."""

    module: Module
    maker: ast.FunctionDef
    node: ast.Call
    arguments: Sequence[ast.expr]
    owner: str
    base: ast.FunctionDef

    @property
    def taken(self) -> ast.arguments:
        return self.base.args

    @property
    def positional(self) -> list[str]:
        """The parameters that accept arguments without a name, without `self`."""
        return [argument.arg for argument in (*self.taken.posonlyargs, *self.taken.args)][1:]


def base_call_faults(own: OwnClass) -> Iterator[ClassFault]:
    """The calls of constructors of base classes of the project that these do not fit."""
    for at, names in enumerate(own.names):
        call = _base_call(own, at, names)
        if call is None:
            continue
        faults = [*_name_faults(call)] or [*_count_faults(call)]
        yield from faults or (_other_lists(own, call) if at == 0 else ())


def arguments_to_base(own: OwnClass) -> Mapping[str, tuple[PythonText, ast.expr]] | None:
    """The arguments that a class passes to the constructor of the last of its base classes, by the
    name of the parameter, and the default values of others, each with the text that it is in; not
    those of a parameter to which that constructor gives another value. None if it is not known."""
    *derived, (last, base) = own.classes
    call = _base_call(own, 0, own.names[0]) if derived else None
    if call is None or call.base not in base.body or [*base_call_faults(own)]:
        return None
    if call.node not in [node.value for node in call.maker.body if isinstance(node, ast.Expr)]:
        return None
    taken, text = call.taken, last.text
    names = [argument.arg for argument in (*taken.posonlyargs, *taken.args)]
    pairs = [*zip(reversed(names), reversed(taken.defaults), strict=False)]
    pairs += [(argument.arg, default) for argument, default in
              zip(taken.kwonlyargs, taken.kw_defaults, strict=True) if default]  # fmt: skip
    found = {name: (text, default) for name, default in pairs}
    given = [*zip(call.positional, call.arguments, strict=False)]
    given += [(keyword.arg or "", keyword.value) for keyword in call.node.keywords]
    found |= {name: (call.module.text, value) for name, value in given}
    for node in walk_code(call.base):
        match node:
            case (
                ast.Name(id=name, ctx=ast.Store() | ast.Del())
                | ast.Attribute(value=ast.Name(id=name))
            ):
                found.pop(name, None)
    return found


def _maker(names: Names) -> ast.FunctionDef | None:
    """The constructor among the names of a class, if it is plain."""
    match names.get("__init__", ()):
        case (ast.FunctionDef(decorator_list=[]) as maker,):
            return maker
    return None


def _base_call(own: OwnClass, at: int, names: Names) -> _Call | None:
    """The only call of the constructor of the base class in that of a class; None where it is not
    known which one it calls, and with which arguments."""
    module, node = own.classes[at]
    maker = _maker(names)
    base = next((level for level in range(at + 1, len(own.names))
                 if "__init__" in own.names[level]), None)  # fmt: skip
    taken = _maker(own.names[base]) if base is not None else None
    if maker is None or base is None or taken is None or maker not in node.body:
        return None
    me = [argument.arg for argument in (*maker.args.posonlyargs, *maker.args.args)][:1]
    calls = [(call, _arguments(call, node, own.classes[base][1], me))
             for call in walk_code(maker) if isinstance(call, ast.Call)]  # fmt: skip
    found = [(call, given) for call, given in calls if given is not None]
    if len(found) != 1 or taken not in own.classes[base][1].body:
        return None
    call, arguments = found[0]
    open_ = any(isinstance(argument, ast.Starred) for argument in arguments)
    open_ = open_ or any(keyword.arg is None for keyword in call.keywords)
    if open_ or module.text.is_filled(module.text.span(call)):
        return None
    return _Call(module, maker, call, arguments, own.classes[base][1].name, taken)


def _arguments(
    call: ast.Call, node: ast.ClassDef, base: ast.ClassDef, me: list[str]
) -> Sequence[ast.expr] | None:
    """The arguments without names of a call of the constructor of the base class; None for other
    calls."""
    match call.func:
        case ast.Attribute(value=ast.Call(func=ast.Name(id="super"), args=given), attr="__init__"):
            names = [name.id for name in given if isinstance(name, ast.Name)]
            known = not given or names == [node.name, *me]
            first = call.args[0] if call.args else None
            again = isinstance(first, ast.Name) and [first.id] == me
            return call.args if known and not again else None
        case ast.Attribute(value=ast.Name(id=name), attr="__init__") if name == base.name:
            match call.args:
                case [ast.Name(id=passed), *others] if [passed] == me:
                    return others
    return None


def _name_faults(call: _Call) -> Iterator[ClassFault]:
    """The arguments of a name that the constructor does not have, or that it gets twice."""
    text = call.module.text
    by_name = [argument.arg for argument in (*call.taken.args, *call.taken.kwonlyargs)]
    by_name = [name for name in by_name if name not in ("self",)]
    passed = {*call.positional[: len(call.arguments)]}
    free = [name for name in by_name if name not in passed]
    given = {keyword.arg for keyword in call.node.keywords}
    for keyword in call.node.keywords:
        name = keyword.arg or ""
        start = text.offset(keyword.lineno, keyword.col_offset)
        word = Word(name, Span(text.source, start, start + len(name)))
        if name in passed and name in by_name:
            yield ClassFault(kind=ARGUMENT_TWICE, name=word, owner=call.owner)
        elif name not in by_name and call.taken.kwarg is None:
            near = guesser([text for text in free if text not in given])(name)
            yield ClassFault(kind=NO_BASE_ARGUMENT, name=word, near=near, owner=call.owner,
                             more=_in_order(by_name))  # fmt: skip


def _in_order(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _count_faults(call: _Call) -> Iterator[ClassFault]:
    """Arguments that are too many, or missing."""
    text, positional = call.module.text, call.positional
    if len(call.arguments) > len(positional) and call.taken.vararg is None:
        span = text.span(call.arguments[len(positional)])
        more = _in_order(positional) if positional else "only `self`"
        word = Word(" ".join(span.text.split()), span)
        yield ClassFault(kind=TOO_MANY_ARGUMENTS, name=word, owner=call.owner, more=more)
        return
    due = positional[: len(positional) - len(call.taken.defaults)]
    due += [argument.arg for argument, default in
            zip(call.taken.kwonlyargs, call.taken.kw_defaults, strict=True)
            if default is None]  # fmt: skip
    given = {*positional[: len(call.arguments)], *(keyword.arg for keyword in call.node.keywords)}
    missing = [name for name in due if name not in given]
    if missing:
        span = text.span(call.node.func)
        by_name = [*positional, *(argument.arg for argument in call.taken.kwonlyargs)]
        yield ClassFault(kind=MISSING_BASE_ARGUMENT, name=Word(span.text, span),
                         near=_in_order(by_name),
                         owner=call.owner, more=listed(missing))  # fmt: skip


def _other_lists(own: OwnClass, call: _Call) -> Iterator[ClassFault]:
    """The outcomes that `execute` returns, passed as another parameter than `outcomes`, which gets
    none of them."""
    found = own.method("execute")
    lists = {name: (value, texts)
             for name, value in zip(call.positional, call.arguments, strict=False)
             if (texts := _texts(value))}  # fmt: skip
    if found is None or "outcomes" not in lists:
        return
    returned = {
        alternative.value
        for line in returns_of(found[1].body)
        if line.value is not None
        for alternative in alternatives(line.value)
        if isinstance(alternative, ast.Constant)
    }
    wrong, given = lists["outcomes"]
    other = next((name for name, (_, texts) in lists.items() if texts & returned), None)
    if other is not None and given.isdisjoint(returned):
        span, text = call.module.text.span(lists[other][0]), call.module.text.span(wrong).text
        yield ClassFault(
            kind=OTHER_LISTS,
            name=Word(" ".join(span.text.split()), span),
            near=_in_order(call.positional),
            owner=call.owner,
            more=other,
            file=" ".join(text.split()),
        )


def _texts(node: ast.expr) -> set[object]:
    """The texts in a list; none for another expression."""
    items = node.elts if isinstance(node, ast.List | ast.Tuple) else ()
    return {item.value for item in items if isinstance(item, ast.Constant)}


def copied(node: ast.expr) -> ast.expr:
    """The list of which an expression makes a copy, or the expression itself: `list(keys)`,
    `[*keys]`, `keys or []`."""
    match node:
        case ast.Call(func=ast.Name(id="list" | "tuple"), args=[value], keywords=[]):
            return copied(value)
        case ast.List(elts=[ast.Starred(value=value)]):
            return copied(value)
        case ast.BoolOp(op=ast.Or(), values=[value, ast.List(elts=[]) | ast.Tuple(elts=[])]):
            return copied(value)
    return node

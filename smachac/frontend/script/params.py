"""Params, look-ups and string constructs: `[params, x]`, `[[x]]`, `['/', [params, arm]]`.

They may be at any depth of a value. A quoted word is data: `['params', x]` is a plain list.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser, guesser_of, respelt
from smachac.frontend.errors.references import (
    look_up_of_call,
    param_before_definition,
    unresolved_look_up,
)
from smachac.frontend.errors.script import too_big, wrong_shape
from smachac.frontend.text.values import as_value
from smachac.frontend.text.yaml_tree import (
    Entry,
    Joined,
    Map,
    Scalar,
    Seq,
    Tree,
    is_known_wrong,
    known_wrong,
)
from smachac.ir.nodes import FixedParam, Param, StateType


class Call(NamedTuple):
    """A call of a sub-script: the state that calls, the name of the sub-script with the place of
    the call, the tree of the sub-script, the params that the call gives, and the call around it."""

    state: str
    script: Word
    tree: Tree
    given: tuple[Word, ...]
    outer: Call | None


class Scope(dict[str, Tree]):
    """The params in scope of a state. `call` is that of the sub-script around it, `later` are the
    places of the params of the same mapping that are defined below the one which is read."""

    call: Call | None = None
    later: Mapping[str, Span] = MappingProxyType({})


MAX_TEXT = 100_000
"""The longest result of a string construct, in characters."""

MAX_PARTS = 1_000
"""The most parts of a string construct that programs put together when they run."""

MAX_NODES = 100_000
"""The most nodes of a param after substitution of its look-ups."""

MAX_FILLED, MAX_FILLED_BY_STATE = 100_000, 100
"""The most nodes that all look-ups of a script may add: a fixed part and a part for each state."""

MAX_LEVELS = 100
"""The most levels of a value: Python and C++ compilers accept about 200 nested brackets."""


def is_flat(tree: Tree) -> bool:
    """Whether a value has no look-ups and no nested collections, as most values."""
    if isinstance(tree, Scalar):
        return True
    names_params = False
    if isinstance(tree, Map):
        for entry in tree.entries:  # `all` takes longer, and every value comes here
            if not isinstance(entry.value, Scalar):
                return False
    else:
        for item in tree.items:
            if not isinstance(item, Scalar):
                return False
            names_params = names_params or item.value == "params"
    return not names_params or look_up_word(tree) is None


def is_too_deep(tree: Tree) -> bool:
    """Whether a value has more than MAX_LEVELS levels."""
    level = [tree]
    for _ in range(MAX_LEVELS + 1):
        below: list[Tree] = []
        for one in level:
            if isinstance(one, Seq):
                below += one.items
            elif isinstance(one, Map):
                below += [entry.value for entry in one.entries]
        if not below:
            return False
        level = below
    return True


def look_up_word(tree: Tree) -> Word | None:
    """The param that a look-up names; None if the tree is no look-up."""
    match tree:
        case Seq(items=(Scalar(value="params", plain=True), Scalar(value=str(name), plain=True))):
            return Word(name, tree.items[1].span)
        case Seq(items=(Seq(items=(Scalar(value=str(name), plain=True) as word,)),)):
            return Word(name, word.span)
    return None


def recovered_look_up(tree: Tree, scope: Scope, report: Report) -> Tree | None:
    """The value of `[param, x]`, where `params` is misspelt and `x` is a param in scope, which is
    reported; None for other trees."""
    match tree:
        case Seq(items=(Scalar(value=str(first), plain=True) as one, Scalar(value=str(name)))):
            if name not in scope or guesser_of(("params",)).unique_match(first) is None:
                return None
            word = Word(first, one.span)
            message = f"`[{first}, {name}]` is a list of two texts, not a look-up"
            help, edits = f"did you mean `[params, {name}]`?", respelt(word, "params")
            arguments = ("look-up", first, name)
            report.append(wrong_shape(word.span, message, help, arguments=arguments, edits=edits))
            return scope[name]
    return None


def look_ups(tree: Tree) -> Iterator[Word]:
    """The names of params in the look-ups of a value, at any depth."""
    todo: list[Tree] = [tree]
    while todo:
        each = todo.pop()
        if isinstance(each, Scalar):
            continue
        word = look_up_word(each)
        if word is not None:
            yield word
            continue
        inner: Iterable[Tree]
        inner = (entry.value for entry in each.entries) if isinstance(each, Map) else each.items
        todo.extend(inner)


def fill_in(tree: Tree, scope: Scope, report: Report, *, names: bool = False) -> Tree:
    """The tree with every look-up and string construct replaced by its value.

    `names`: the tree is a list of names, so that its items are not joined to one string. A look-up
    that fails is reported (SM015) and becomes `known_wrong`.
    """
    if isinstance(tree, Scalar):
        return tree
    if isinstance(tree, Map):
        values = [fill_in(entry.value, scope, report) for entry in tree.entries]
        if all(new is entry.value for new, entry in zip(values, tree.entries, strict=True)):
            return tree
        pairs = zip(tree.entries, values, strict=True)
        return Map(tuple(Entry(entry.key, new) for entry, new in pairs), tree.span)
    word = look_up_word(tree)
    if word is not None:
        return _found(word, scope, report)
    meant = recovered_look_up(tree, scope, report) if scope else None
    if meant is not None:
        return meant
    items = tuple(fill_in(item, scope, report) for item in tree.items)
    if not names and any(look_up_word(item) is not None for item in tree.items):
        joined = _joined(items, tree, report)
        if joined is not None:
            return joined
    if all(new is old for new, old in zip(items, tree.items, strict=True)):
        return tree
    return Seq(items, tree.span)


def _found(word: Word, scope: Scope, report: Report) -> Tree:
    value = scope.get(word.text)
    if value is None:
        report.append(_unresolved(word, scope))
        return known_wrong(word.span)
    return value


def _unresolved(word: Word, scope: Scope) -> Diagnostic:
    """SM015: at the call that does not give the param, if the look-up is in a sub-script and no
    other param in scope has nearly this name."""
    if word.text in scope.later:
        return param_before_definition(word, scope.later[word.text])
    call, turned = scope.call, _turned_param(word.text, scope)
    while call is not None and call.tree.span.source is not word.span.source:
        call = call.outer
    if call is None:
        return unresolved_look_up(word, scope, turned)
    places = [*look_ups(call.tree)]
    read = {place.text for place in places}
    idle = [word for word in call.given if word.text not in read]
    known = scope.keys() - {word.text for word in idle}
    if turned in known or guesser(sorted(known))(word.text) is not None:
        return unresolved_look_up(word, scope, turned)
    places = [place for place in places if place.text == word.text]
    return look_up_of_call(word, call.script, call.state, idle, turned, places)


def _turned_param(name: str, scope: Scope) -> str | None:
    """The only param in scope whose value is the name of a missing one: both have changed
    places."""
    found = [
        key
        for key, value in scope.items()
        if isinstance(value, Scalar) and value.value == name and value.plain
    ]
    return found[0] if len(found) == 1 else None


def _joined(items: tuple[Tree, ...], tree: Seq, report: Report) -> Tree | None:
    """The text of a string construct; None if a part is a collection: then the tree is a list. With
    a part whose fault is reported it is `known_wrong`."""
    parts = []
    for item, own in zip(items, tree.items, strict=True):
        if not isinstance(item, Scalar):
            return None
        if item is not own and is_known_wrong(item):
            return known_wrong(tree.span)
        parts.append(str(item.value))
    text = "".join(parts)
    if len(text) > MAX_TEXT:
        message = f"this string construct has {len(text):,} characters; the limit is {MAX_TEXT:,}"
        report.append(too_big(tree.span, message, "use shorter params", arguments=("text",)))
        return known_wrong(tree.span)
    # A call may need quotes in YAML; quotes around a dotted word mean that it is text.
    quoted = any(isinstance(item, Scalar) and not item.plain for item in tree.items)
    plain = text != "" and (text.endswith(")") or not quoted)
    return Joined(text, plain, *tree.span, parts=_parts(items, tree))


def _parts(items: tuple[Tree, ...], tree: Seq) -> tuple[str | Scalar, ...]:
    """The texts of a string construct, and the values of its params; none if there are too many."""
    parts: list[str | Scalar] = []
    for item, own in zip(items, tree.items, strict=True):
        if isinstance(item, Joined):
            parts += item.parts or (str(item.value),)
        elif isinstance(item, Scalar):
            parts.append(str(item.value) if item is own else item)
    return tuple(parts) if len(parts) <= MAX_PARTS else ()


def child_scope(scope: Scope, own: Tree | None, report: Report) -> Scope:
    """The params of a state: its own ones hide outer ones; later ones may use earlier ones."""
    if not isinstance(own, Map):
        return scope
    inner = Scope(scope)
    inner.call = scope.call
    later = {str(entry.key.value): entry.key.span for entry in own.entries}
    inner.later = later
    for entry in own.entries:
        later.pop(str(entry.key.value), None)  # a key that is written twice is reported before
        value = fill_in(entry.value, inner, report)
        if value is not entry.value and size_up_to(value, MAX_NODES) > MAX_NODES:
            message = f"the look-ups in this param give it more than {MAX_NODES:,} values"
            help = "use smaller params"
            report.append(too_big(entry.value.span, message, help, arguments=("param",)))
            value = known_wrong(entry.value.span)
        inner[str(entry.key.value)] = value
    return inner


def size_up_to(tree: Tree, limit: int) -> int:
    """The number of nodes of a tree; counting stops at one more than the limit."""
    stack, seen = [tree], 0
    while stack and seen <= limit:
        seen += 1
        node = stack.pop()
        if isinstance(node, Seq):
            stack.extend(node.items)
        elif isinstance(node, Map):
            stack.extend(entry.value for entry in node.entries)
    return seen


def params_of(entry: Entry | None) -> tuple[Param, ...]:
    """The params of the main script that have values of their own."""
    if entry is None or not isinstance(entry.value, Map):
        return ()
    return tuple(
        Param(name=str(item.key.value), value=as_value(item.value)) for item in entry.value.entries
    )


def fixed_params(own: Mapping[str, Entry], type_: StateType, scope: Scope) -> Iterator[FixedParam]:
    """The look-ups in the time limit and in the retries of a state."""
    for key in ("timeout", "retry"):
        if key not in own or key in type_.variables:
            continue
        for word in look_ups(own[key].value):
            if word.text in scope:
                yield FixedParam(key, word, scope[word.text].span)

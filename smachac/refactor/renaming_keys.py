"""Keys of userdata under another name: in the container that has them, and in all that is inside
under the same name. Where a state cannot be renamed inside, a remapping joins the names."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.ir import nodes
from smachac.ir.nodes import Container, Leaf, Machine, Node
from smachac.ir.userdata import remapping
from smachac.refactor.renaming import Renaming, containers_of, same_place, step_words
from smachac.refactor.sheet import RefusedError
from smachac.source import Span

OPENLY = ("PrintUserdataState", "ScriptedState", "CallbacksState", "ConditionalOutcomeState")
"""The state types of which all is known that they do with their keys: it stands in the script."""


def rename_key(work: Renaming, machine: Machine, declared: Span) -> None:
    """Rename a key of the container whose first state stands at a place, in it and in all that is
    inside under the same name."""
    starts = work.scopes or [declared]
    scopes = {
        id(each): each
        for each in containers_of(machine)
        if not each.sugar
        and each.children
        and any(same_place(each.children[0].span, start) for start in starts)
    }
    todo = list(scopes.values())
    while todo:
        for child in todo.pop().children:
            if isinstance(child, Leaf) or child.sugar or id(child) in scopes:
                continue
            if work.old in _names(child) and work.old not in remapping(child) and child.children:
                place = child.children[0].span
                same = [
                    each
                    for each in containers_of(machine)
                    if not each.sugar and each.children and same_place(each.children[0].span, place)
                ]
                todo += [each for each in same if id(each) not in scopes]
                scopes |= {id(each): each for each in same}
    for scope in scopes.values():
        work.scopes.append(scope.children[0].span)
        _in_scope(work, scope, scopes)
    for container in containers_of(machine):
        for child in container.children:
            if id(child) in scopes and work.old in _names(child):
                _at_border(work, child, id(container) in scopes)


def _names(node: Node) -> list[str]:
    return [key.name for key in (*node.inputs, *node.outputs)]


def _at_border(work: Renaming, node: Node, around: bool) -> None:
    """What a container calls a key outside, when the key inside has another name; `around`: it
    has that outside as well."""
    for remap in node.remaps:
        if remap.key == work.old:
            work.spell(remap.span)
            return
    if not around:
        work.add(node, "remapping", work.new, work.old)


def _in_scope(work: Renaming, scope: Container, scopes: dict[int, Container]) -> None:
    for preset in scope.userdata:
        if preset.key == work.new:
            message = f"`{scope.name}` has a key `{work.new}` already"
            raise RefusedError(preset.span, message, "choose another name")
        if preset.key == work.old:
            work.spell(preset.span)
    for key in (*scope.inputs, *scope.outputs):
        if key.name == work.old:
            work.spell(key.span)
    bodies = work.bodies(scope)
    if isinstance(scope, nodes.Iterator):
        if scope.item_key == work.old:
            work.words(bodies, "it_label")
        if scope.items_key == work.old:
            work.words(bodies, "it")
    for child in scope.children:
        for remap in child.remaps:
            if remap.to == work.old:
                sheet = work.sheets(remap.span.source)
                work.atom(sheet, sheet.value_of(remap.span))
        if id(child) in scopes or work.old in remapping(child):
            continue
        if work.old not in _names(child):
            continue
        if isinstance(child, Leaf) and child.type in OPENLY and _rewrite(work, child):
            continue
        work.add(child, "remapping", work.old, work.new)


def _rewrite(work: Renaming, leaf: Leaf) -> bool:
    """Rename a key of a state that declares it in the script, in its code as well; whether that
    can be done."""
    own = [key for key in (*leaf.inputs, *leaf.outputs) if key.name == work.old]
    if any(key.span.text.strip("'\"") != work.old for key in own):
        return False
    places = []
    for held in leaf.variables:
        for code in _expressions(held.value.data):
            found = _attributes(code, work.old)
            if found is None:
                return False
            places += found
    for key in own:
        work.spell(key.span)
    for place in places:
        work.spell(place)
    bodies = work.bodies(leaf)
    if leaf.type == "CallbacksState":
        work.keys(bodies, "callbacks")
    for atom, sheet in step_words(bodies, "set"):
        work.atom(sheet, atom)
    return True


def _expressions(data: nodes.Data) -> Iterator[nodes.Expression]:
    match data:
        case nodes.Expression():
            yield data
        case nodes.Struct(entries=entries):
            for _, value in entries:
                yield from _expressions(value)
        case tuple():
            for value in data:
                yield from _expressions(value)


def _attributes(code: nodes.Expression, key: str) -> list[Span] | None:
    """Where a function reads a key of its userdata; None where that cannot be told."""
    written = code.span.text
    at = written.find(code.text)
    if at < 0 or not code.text.isascii() or "\n" in code.text:
        return None if key in code.text else []
    try:
        tree = ast.parse(code.text, mode="eval").body
    except SyntaxError:
        return None
    if not isinstance(tree, ast.Lambda) or len(tree.args.args) != 1:
        return None if key in code.text else []
    owner = tree.args.args[0].arg
    found = []
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=attr) if name == owner == name:
                if attr == key and node.end_col_offset is not None:
                    end = code.span.start + at + node.end_col_offset
                    found.append(Span(code.span.source, end - len(key), end))
            case ast.Subscript(value=ast.Name(id=name)) if name == owner:
                return None
    return found

"""States and outcomes under another name: which words of which texts change.

A name is known by where it is declared, so that a sub-script that is called several times, or by
several scripts, is renamed in all of them. That no other name is meant is proven afterwards, by
skeletons (skeleton.py).
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator

from smachac.diagnostics.source import Source, Span
from smachac.ir import nodes
from smachac.ir.nodes import Container, Leaf, Machine, Node
from smachac.ir.traversal import leads_to_child, remapping
from smachac.refactor.cst import Atom, Group, Item
from smachac.refactor.editor import RefusedError, Sheet, put, variable
from smachac.refactor.field_order import variables_of

Sheets = Callable[[Source], Sheet]


class Renaming:
    """One renaming, worked out over one machine after the other."""

    def __init__(self, old: str, new: str, sheets: Sheets) -> None:
        self.old = old
        self.new = new
        self.sheets = sheets
        self.added: set[tuple[int, str, str]] = set()
        self.scopes: list[Span] = []
        """Where the first states of containers stand in which a key got another name."""

    def spell(self, span: Span) -> None:
        """Let the new name stand there, if the old one does."""
        if span.text.strip("'\"") == self.old:
            self.sheets(span.source).spell(span, self.new)

    def add(self, node: Node, name: str, key: str, value: str) -> None:
        """Add an entry to a variable of a state, once."""
        mark = (node.span.start, node.span.source.name + name, key)
        if mark in self.added:
            return
        self.added.add(mark)
        sheet = self.sheets(node.span.source)
        place = sheet.state(node.span)
        body = variables_of(place.item)
        assert body is not None
        put(body, name, key, value)
        sheet.write_anew(place)

    def words(self, bodies: Iterable[tuple[Sheet, Group]], *names: str) -> None:
        """Spell the values of variables anew: a word, the items of a list, the values of a map."""
        for sheet, body in bodies:
            for name in names:
                item = variable(body, name)
                for atom in _values(item) if item is not None else ():
                    self.atom(sheet, atom)

    def keys(self, bodies: Iterable[tuple[Sheet, Group]], *names: str) -> None:
        """Spell the keys of variables that are mappings anew."""
        for sheet, body in bodies:
            for name in names:
                item = variable(body, name)
                for inner in item.value.items if item and isinstance(item.value, Group) else ():
                    if inner.key is not None:
                        self.atom(sheet, inner.key)

    def atom(self, sheet: Sheet, atom: Atom) -> None:
        if atom.start >= 0 and atom.text.strip("'\"") == self.old:
            self.spell(Span(sheet.source, atom.start, atom.end))

    def bodies(self, node: Node) -> list[tuple[Sheet, Group]]:
        """Where variables of a state stand: at its name, and in the sub-script that it calls."""
        found: list[tuple[Sheet, Group]] = []
        sheet = self.sheets(node.span.source)
        place = sheet.places.get(node.span.start)
        body = variables_of(place.item) if place is not None else None
        if body is not None:
            found.append((sheet, body))
        spans = [outcome.span for outcome in node.outcomes]
        if not isinstance(node, Leaf):
            spans += [child.span for child in node.children[:1]]
        for span in spans[-1:]:
            other = self.sheets(span.source)
            inner = other.body_of(span)
            if inner is not None and inner is not body:
                found.append((other, inner))
        return found


def _values(item: Item) -> Iterator[Atom]:
    todo: list[Atom | Group] = [item.value]
    while todo:
        node = todo.pop()
        if isinstance(node, Atom):
            yield node
        else:
            todo += [inner.value for inner in node.items]


def same_place(one: Span, other: Span) -> bool:
    return one.source is other.source and one.start == other.start


def containers_of(machine: Machine) -> Iterator[Container]:
    todo: list[Node] = [machine.root]
    while todo:
        node = todo.pop()
        if not isinstance(node, Leaf):
            yield node
            todo += node.children


# --- states


def rename_state(work: Renaming, machine: Machine, declared: Span) -> None:
    """Rename the state whose name stands at a place, and what leads to it."""
    if same_place(machine.root.span, declared) and machine.root.name == work.old:
        work.spell(declared)
        return
    for container in containers_of(machine):
        inside = frozenset(child.name for child in container.children)
        mine = [child for child in container.children
                if child.name == work.old and same_place(child.span, declared)]  # fmt: skip
        if not mine:
            continue
        for other in container.children:
            if other.name == work.new and other not in mine:
                message = f"`{container.name}` has a state `{work.new}` already"
                raise RefusedError(other.span, message, "choose another name")
        if any(outcome.name == work.new for outcome in container.outcomes):
            message = f"`{work.new}` is an outcome of `{container.name}`: who leads there?"
            raise RefusedError(container.span, message, "choose another name")
        work.spell(declared)
        for child in container.children:
            for step in child.transitions:
                if step.target == work.old and leads_to_child(step, inside):
                    work.spell(step.target_span)
        match container:
            case nodes.Concurrence():
                for rule in container.rules:
                    for each in rule.when:
                        if each.child == work.old:
                            work.spell(each.span)
            case nodes.StateMachine() | nodes.Sequence():
                if not same_place(container.initial_span, container.span):
                    work.spell(container.initial_span)


# --- outcomes


def rename_outcome(work: Renaming, machine: Machine, declared: Span) -> None:
    """Rename the outcome that is declared at a place, and what becomes of it."""

    def is_mine(node: Node) -> bool:
        return any(each.name == work.old and same_place(each.span, declared)
                   for each in node.outcomes)  # fmt: skip

    if is_mine(machine.root):
        _inside(work, machine.root)
    for container in containers_of(machine):
        for child in container.children:
            if not is_mine(child):
                continue
            if any(each.name == work.new for each in child.outcomes):
                message = f"`{child.name}` has an outcome `{work.new}` already"
                raise RefusedError(child.span, message, "choose another name")
            _inside(work, child)
            if not container.sugar:
                _around(work, container, child)


def _inside(work: Renaming, node: Node) -> None:
    """What a state says of its own outcome."""
    bodies = work.bodies(node)
    work.words(bodies, "outcomes", "default_outcome", "exhausted_outcome", "final_outcome_map")
    for sheet, body in bodies:
        for name in ("retry", "for_each"):
            item = variable(body, name)
            if item is not None and isinstance(item.value, Group):
                inner = [each for each in item.value.items if each.key and each.key.text == "on"]
                for atom in (atom for each in inner for atom in _values(each)):
                    work.atom(sheet, atom)
    if isinstance(node, Leaf):
        if node.type == "ConditionalOutcomeState":
            work.keys(bodies, "callbacks")
        for atom, sheet in step_words(bodies, "outcome"):
            work.atom(sheet, atom)
        return
    if node.sugar:
        return
    inside = frozenset(child.name for child in node.children)
    if work.new in inside:
        message = f"`{node.name}` has a state `{work.new}`: who leads there?"
        raise RefusedError(node.span, message, "choose another name")
    for child in node.children:
        for step in child.transitions:
            if step.target != work.old or leads_to_child(step, inside):
                continue
            if step.origin == "implicit":
                work.add(child, "transitions", step.outcome, work.new)
            else:
                work.spell(step.target_span)
    if isinstance(node, nodes.Concurrence):
        for rule in node.rules:
            if rule.outcome == work.old:
                work.spell(rule.span)
        work.spell(node.default_span)


def _around(work: Renaming, container: Container, child: Node) -> None:
    """What the container makes of the outcome of a state in it."""
    for step in child.transitions:
        if step.outcome != work.old:
            continue
        if step.origin == "implicit":
            work.add(child, "transitions", work.new, work.old)
        elif step.origin == "connector":
            help = f"give `{child.name}` a container, or rename the connector by hand"
            message = f"`{work.old}` is the connector of `{container.name}`"
            raise RefusedError(child.span, message, help)
        else:
            work.spell(step.span)
    match container:
        case nodes.Concurrence():
            for rule in container.rules:
                for each in rule.when:
                    if each.child == child.name and each.outcome == work.old:
                        sheet = work.sheets(each.span.source)
                        work.atom(sheet, sheet.value_of(each.span))
        case nodes.Iterator():
            bodies = work.bodies(container)
            work.words(bodies, "loop_outcomes", "break_outcomes")
            work.keys(bodies, "final_outcome_map")


def step_words(bodies: Iterable[tuple[Sheet, Group]], what: str) -> Iterator[tuple[Atom, Sheet]]:
    """In the steps of a scripted state: its outcomes, or the keys that it sets."""
    for sheet, body in bodies:
        item = variable(body, "steps")
        for step in item.value.items if item and isinstance(item.value, Group) else ():
            for each in step.value.items if isinstance(step.value, Group) else ():
                if each.key is None or each.key.text != what:
                    continue
                if isinstance(each.value, Atom):
                    yield each.value, sheet
                else:
                    yield from ((inner.key, sheet) for inner in each.value.items if inner.key)


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

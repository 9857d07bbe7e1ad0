"""Rename: the words to replace for a new name of a state, an outcome or a userdata key.

A name is identified by the span of its declaration, so that a sub-script with several calls, or
with several calling scripts, is renamed for all of them. The result is checked by
`equal_after_rename` (equivalence.py).
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator

from smachac.analysis.property_events import NamedStates, NameFault
from smachac.diagnostics.source import Source, Span
from smachac.ir import nodes
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Container, Leaf, Machine, Node
from smachac.ir.properties import atoms
from smachac.ir.python_code import parse_code
from smachac.ir.script_paths import sugared_child
from smachac.ir.traversal import expressions_in, leads_to_child, remapping, walk
from smachac.records import replace
from smachac.refactor.cst import Atom, Collection, Item
from smachac.refactor.editor import RefusedError, ScriptEditor, add_entry, variable
from smachac.refactor.field_order import variables_of

Editors = Callable[[Source], ScriptEditor]


class Renaming:
    """One renaming, applied to one machine after the other."""

    def __init__(self, old: str, new: str, editors: Editors) -> None:
        self.old = old
        self.new = new
        self.editors = editors
        self.added: set[tuple[int, str, str]] = set()
        self.scopes: list[Span] = []
        """The spans of the first states of the containers in which the key was renamed: by them the
        next machine finds its containers."""

    def replace_word(self, span: Span) -> None:
        """Replace the old name at a span."""
        if span.text.strip("'\"") == self.old:
            self.editors(span.source).replace_word(span, self.new)

    def add(self, node: Node, name: str, key: str, value: str) -> None:
        """Add an entry to a field of a state, once."""
        mark = (node.span.start, node.span.source.name + name, key)
        if mark in self.added:
            return
        self.added.add(mark)
        editor = self.editors(node.span.source)
        place = editor.state(node.span)
        body = variables_of(place.item)
        assert body is not None
        add_entry(body, name, key, value)
        editor.rewrite_state(place)

    def words(self, bodies: Iterable[tuple[ScriptEditor, Collection]], *names: str) -> None:
        """Replace the old name in the values of fields: a word, list items, mapping values."""
        for editor, body in bodies:
            for name in names:
                item = variable(body, name)
                for atom in _values(item) if item is not None else ():
                    self.atom(editor, atom)

    def keys(self, bodies: Iterable[tuple[ScriptEditor, Collection]], *names: str) -> None:
        """Replace the old name in the keys of fields that are mappings."""
        for editor, body in bodies:
            for name in names:
                item = variable(body, name)
                for inner in (
                    item.value.items if item and isinstance(item.value, Collection) else ()
                ):
                    if inner.key is not None:
                        self.atom(editor, inner.key)

    def atom(self, editor: ScriptEditor, atom: Atom) -> None:
        """Replace a scalar if it is the old name."""
        if atom.start >= 0 and atom.text.strip("'\"") == self.old:
            self.replace_word(Span(editor.source, atom.start, atom.end))

    def bodies(self, node: Node) -> list[tuple[ScriptEditor, Collection]]:
        """The fields of a state: at its name, and in the sub-script that it calls."""
        found: list[tuple[ScriptEditor, Collection]] = []
        editor = self.editors(node.span.source)
        place = editor.places.get(node.span.start)
        body = variables_of(place.item) if place is not None else None
        if body is not None:
            found.append((editor, body))
        spans = [outcome.span for outcome in node.outcomes]
        if not isinstance(node, Leaf):
            spans += [child.span for child in node.children[:1]]
        for span in spans[-1:]:
            other = self.editors(span.source)
            inner = other.body_of(span)
            if inner is not None and inner is not body:
                found.append((other, inner))
        return found


def _values(item: Item) -> Iterator[Atom]:
    """All scalars in the value of an item."""
    todo: list[Atom | Collection] = [item.value]
    while todo:
        node = todo.pop()
        if isinstance(node, Atom):
            yield node
        else:
            todo += [inner.value for inner in node.items]


def same_place(one: Span, other: Span) -> bool:
    """Whether two spans begin at the same offset of the same source."""
    return one.source is other.source and one.start == other.start


def containers_of(machine: Machine) -> Iterator[Container]:
    """All containers of a machine."""
    todo: list[Node] = [machine.root]
    while todo:
        node = todo.pop()
        if not isinstance(node, Leaf):
            yield node
            todo += node.children


# --- states


def rename_state(renaming: Renaming, machine: Machine, declared: Span) -> None:
    """Rename the state whose name is at a span, and the references to it."""

    def is_declared(node: Node) -> bool:
        return node.name == renaming.old and same_place(node.span, declared)

    _rename_in_properties(renaming, machine, is_state=is_declared)
    if same_place(machine.root.span, declared) and machine.root.name == renaming.old:
        renaming.replace_word(declared)
        return
    for container in containers_of(machine):
        inside = frozenset(child.name for child in container.children)
        declaring = [child for child in container.children
                if child.name == renaming.old and same_place(child.span, declared)]  # fmt: skip
        if not declaring:
            continue
        for other in container.children:
            if other.name == renaming.new and other not in declaring:
                message = f"`{container.name}` already has a state `{renaming.new}`"
                raise RefusedError(other.span, message, "choose another name")
        if any(outcome.name == renaming.new for outcome in container.outcomes):
            message = f"`{renaming.new}` is an outcome of `{container.name}`"
            message += ": transitions to it would be ambiguous"
            raise RefusedError(container.span, message, "choose another name")
        renaming.replace_word(declared)
        for child in container.children:
            for step in child.transitions:
                if step.target == renaming.old and leads_to_child(step, inside):
                    renaming.replace_word(step.target_span)
        match container:
            case nodes.Concurrence():
                for rule in container.rules:
                    for condition in rule.when:
                        if condition.child == renaming.old:
                            renaming.replace_word(condition.span)
                    for word in rule.ignored:
                        if word.text == renaming.old:
                            renaming.replace_word(word.span)
            case nodes.StateMachine() | nodes.Sequence():
                if not same_place(container.initial_span, container.span):
                    renaming.replace_word(container.initial_span)


def _rename_in_properties(
    renaming: Renaming,
    machine: Machine,
    *,
    is_state: Callable[[Node], bool] = lambda node: False,
    has_outcome: Callable[[Node], bool] = lambda node: False,
) -> None:
    """Rename a state, or an outcome of the states that have it, in the properties of a script."""
    if not machine.properties:
        return
    known = dict(walk(machine.root))
    names = NamedStates([*known], [*known.values()], {})
    for atom in (atom for given in machine.properties for atom in atoms(given.form)):
        events = names.resolve(atom)
        if isinstance(events, NameFault):
            continue
        name, outcome = atom.name, atom.outcome
        if atom.subject == "path":
            words = names.paths[events[0][0]].split("/")
            path = ["/".join(words[: end + 1]) for end in range(len(words))]
            parts = name.split("/")
            for at, text in enumerate(path[-len(parts) :]):
                parts[at] = renaming.new if is_state(known[text]) else parts[at]
            name = "/".join(parts)
        if outcome == renaming.old and any(
            has_outcome(names.nodes[number]) for number, _ in events
        ):
            outcome = renaming.new
        new = str(replace(atom, name=name, outcome=outcome))
        if new != str(atom) and atom.span.text.strip("'\"") == str(atom):
            renaming.editors(atom.span.source).replace_word(atom.span, new)


# --- outcomes


def rename_outcome(renaming: Renaming, machine: Machine, declared: Span) -> None:
    """Rename the outcome that is declared at a span, and the references to it."""

    def has_declaration(node: Node) -> bool:
        return any(outcome.name == renaming.old and same_place(outcome.span, declared)
                   for outcome in node.outcomes)  # fmt: skip

    _rename_in_properties(renaming, machine, has_outcome=has_declaration)
    if has_declaration(machine.root):
        _rename_in_state(renaming, machine.root)
    for container in containers_of(machine):
        for child in container.children:
            if not has_declaration(child):
                continue
            if any(outcome.name == renaming.new for outcome in child.outcomes):
                message = f"`{child.name}` already has an outcome `{renaming.new}`"
                raise RefusedError(child.span, message, "choose another name")
            _rename_in_state(renaming, child)
            if not container.sugar:
                _rename_in_container(renaming, container, child)


def _rename_in_state(renaming: Renaming, node: Node) -> None:
    """Rename an outcome in the fields and the children of its state."""
    bodies = renaming.bodies(node)
    renaming.words(bodies, "outcomes", "default_outcome", "exhausted_outcome", "final_outcome_map")
    for editor, body in bodies:
        for name in ("retry", "for_each"):
            item = variable(body, name)
            if item is not None and isinstance(item.value, Collection):
                inner = [
                    other for other in item.value.items if other.key and other.key.text == "on"
                ]
                for atom in (atom for item in inner for atom in _values(item)):
                    renaming.atom(editor, atom)
    if isinstance(node, Leaf):
        conditions = variable_of(node, "conditions")
        if conditions is not None:
            renaming.keys(bodies, conditions.name)
        for atom, editor in _step_words(bodies, node, "outcome"):
            renaming.atom(editor, atom)
        return
    if node.sugar:
        return
    inside = frozenset(child.name for child in node.children)
    if renaming.new in inside:
        message = (
            f"`{node.name}` has a state `{renaming.new}`: transitions to it would be ambiguous"
        )
        raise RefusedError(node.span, message, "choose another name")
    for child in node.children:
        for step in child.transitions:
            if step.target != renaming.old or leads_to_child(step, inside):
                continue
            if step.origin == "implicit":
                renaming.add(child, "transitions", step.outcome, renaming.new)
            else:
                renaming.replace_word(step.target_span)
    if isinstance(node, nodes.Concurrence):
        for rule in node.rules:
            if rule.outcome == renaming.old:
                renaming.replace_word(rule.span)
        renaming.replace_word(node.default_span)


def _rename_in_container(renaming: Renaming, container: Container, child: Node) -> None:
    """Rename an outcome of a child in the transitions and rules of its container."""
    for step in child.transitions:
        if step.outcome != renaming.old:
            continue
        if step.origin == "implicit":
            renaming.add(child, "transitions", renaming.new, renaming.old)
        elif step.origin == "connector":
            help = f"put `{child.name}` into a container, or rename the connector by hand"
            message = f"`{renaming.old}` is the connector of `{container.name}`"
            raise RefusedError(child.span, message, help)
        else:
            renaming.replace_word(step.span)
    for level in child.autonomy:
        if level.outcome == renaming.old:
            renaming.replace_word(level.span)
    match container:
        case nodes.Concurrence():
            for rule in container.rules:
                for condition in rule.when:
                    if condition.child == child.name and condition.outcome == renaming.old:
                        editor = renaming.editors(condition.span.source)
                        renaming.atom(editor, editor.value_of(condition.span))
        case nodes.Iterator():
            bodies = renaming.bodies(container)
            renaming.words(bodies, "loop_outcomes", "break_outcomes")
            renaming.keys(bodies, "final_outcome_map")


def _step_words(
    bodies: Iterable[tuple[ScriptEditor, Collection]], leaf: Leaf, what: str
) -> Iterator[tuple[Atom, ScriptEditor]]:
    """The outcomes, or the keys set, in the steps of a state."""
    steps = variable_of(leaf, "steps")
    for editor, body in bodies:
        item = variable(body, steps.name) if steps is not None else None
        for step in item.value.items if item and isinstance(item.value, Collection) else ():
            for other in step.value.items if isinstance(step.value, Collection) else ():
                if other.key is None or other.key.text != what:
                    continue
                if isinstance(other.value, Atom):
                    yield other.value, editor
                else:
                    yield from ((inner.key, editor) for inner in other.value.items if inner.key)


# --- keys

_NAMED_BY_SCRIPT = frozenset(["argument", "result", "listed"])
"""Roles of keys whose names stand in the script only, not in the code of the state type."""


def rename_key(renaming: Renaming, machine: Machine, declared: Span) -> None:
    """Rename a key of the container whose first state is at a span, there and in the containers
    inside that use the same name for it."""
    starts = renaming.scopes or [declared]
    scopes = {
        id(container): container
        for container in containers_of(machine)
        if not container.sugar
        and container.children
        and any(same_place(container.children[0].span, start) for start in starts)
    }
    todo = list(scopes.values())
    while todo:
        for child in todo.pop().children:
            if isinstance(child, Leaf) or child.sugar or id(child) in scopes:
                continue
            if (
                renaming.old in _names(child)
                and renaming.old not in remapping(child)
                and child.children
            ):
                place = child.children[0].span
                same = [
                    container
                    for container in containers_of(machine)
                    if not container.sugar
                    and container.children
                    and same_place(container.children[0].span, place)
                ]
                todo += [container for container in same if id(container) not in scopes]
                scopes |= {id(container): container for container in same}
    for scope in scopes.values():
        renaming.scopes.append(scope.children[0].span)
        _rename_in_scope(renaming, scope, scopes)
    for container in containers_of(machine):
        for child in container.children:
            if id(child) in scopes and renaming.old in _names(child):
                _rename_at_border(renaming, child, id(container) in scopes)


def _names(node: Node) -> list[str]:
    """The names of the inputs and outputs of a node."""
    return [key.name for key in (*node.inputs, *node.outputs)]


def _rename_at_border(renaming: Renaming, node: Node, around: bool) -> None:
    """Rename a key in the remapping of a container. `around`: the key is renamed outside too."""
    for remap in node.remaps:
        if remap.key == renaming.old:
            renaming.replace_word(remap.span)
            return
    if not around:
        renaming.add(node, "remapping", renaming.new, renaming.old)


def _rename_in_scope(renaming: Renaming, scope: Container, scopes: dict[int, Container]) -> None:
    """Rename a key in one container and the interfaces of its children."""
    for preset in scope.userdata:
        if preset.key == renaming.new:
            message = f"`{scope.name}` already has a key `{renaming.new}`"
            raise RefusedError(preset.span, message, "choose another name")
        if preset.key == renaming.old:
            renaming.replace_word(preset.span)
    for key in (*scope.inputs, *scope.outputs):
        if key.name == renaming.old:
            renaming.replace_word(key.span)
    bodies = renaming.bodies(scope)
    if isinstance(scope, nodes.Iterator):
        if scope.item_key == renaming.old:
            renaming.words(bodies, "it_label")
        if scope.items_key == renaming.old:
            renaming.words(bodies, "it")
    for child in scope.children:
        for remap in child.remaps:
            if remap.to == renaming.old:
                editor = renaming.editors(remap.span.source)
                renaming.atom(editor, editor.value_of(remap.span))
        inner = _state_inside(child)
        if _names_items(child, renaming.old):
            _rename_items(renaming, child)
            if renaming.old not in _names(inner):
                continue
        if id(child) in scopes or renaming.old in remapping(child):
            continue
        if renaming.old not in _names(child):
            continue
        if isinstance(inner, Leaf) and _rename_in_leaf(renaming, inner):
            continue
        renaming.add(child, "remapping", renaming.old, renaming.new)


def _state_inside(node: Node) -> Node:
    """The state inside the containers of its sugar."""
    while not isinstance(node, Leaf) and (inside := sugared_child(node)) is not None:
        node = inside
    return node


def _names_items(node: Node, key: str) -> bool:
    """Whether a state has `for_each: {in: key}`."""
    if not isinstance(node, nodes.Iterator) or node.sugar != "for_each" or not node.items_key:
        return False
    return remapping(node)[node.items_key] == key


def _rename_items(renaming: Renaming, node: Node) -> None:
    """Rename the key in `for_each: {in: key}`."""
    for editor, body in renaming.bodies(node):
        item = variable(body, "for_each")
        if item is None or not isinstance(item.value, Collection):
            continue
        for other in item.value.items:
            if other.key is not None and other.key.text == "in" and isinstance(other.value, Atom):
                renaming.atom(editor, other.value)


def _rename_in_leaf(renaming: Renaming, leaf: Leaf) -> bool:
    """Rename a key of a state that declares it in the script, in its code too; False if that is not
    possible."""
    own = [key for key in (*leaf.inputs, *leaf.outputs) if key.name == renaming.old]
    if any(key.role not in _NAMED_BY_SCRIPT for key in own):
        return False
    if any(key.span.text.strip("'\"") != renaming.old for key in own):
        return False
    places = []
    for held in leaf.variables:
        for code in expressions_in(held.value.data):
            found = _attributes(code, renaming.old)
            if found is None:
                return False
            places += found
    for key in own:
        renaming.replace_word(key.span)
    for place in places:
        renaming.replace_word(place)
    bodies = renaming.bodies(leaf)
    callbacks = variable_of(leaf, "callbacks")
    if callbacks is not None:
        renaming.keys(bodies, callbacks.name)
    for atom, editor in _step_words(bodies, leaf, "set"):
        renaming.atom(editor, atom)
    return True


def _attributes(code: nodes.Expression, key: str) -> list[Span] | None:
    """The spans where a function reads a key of its userdata; None if they cannot be determined."""
    written = code.span.text
    at = written.find(code.text)
    if at < 0 or not code.text.isascii() or "\n" in code.text:
        return None if key in code.text else []
    try:
        tree = parse_code(code.text)
    except SyntaxError:
        return None
    if not isinstance(tree, ast.Lambda) or len(tree.args.args) != 1:
        return None if key in code.text else []
    owner = tree.args.args[0].arg
    found = []
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=attr) if name == owner:
                if attr == key and node.end_col_offset is not None:
                    end = code.span.start + at + node.end_col_offset
                    found.append(Span(code.span.source, end - len(key), end))
            case ast.Subscript(value=ast.Name(id=name)) if name == owner:
                return None
    return found

"""Changes of a machine: the target of a transition, a new state, a state less.

Each function changes the texts of a script and proves that the machine is changed in exactly this
way; they raise HasErrorsError, NotFoundError and RefusedError. Unlike the refactorings they change
the behaviour, so the script may have errors before and afterwards.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from functools import partial

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.wording import listed
from smachac.driver import Analysis
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Iterator,
    Leaf,
    Machine,
    Node,
    Outcome,
    Preset,
    StateMachine,
    StateType,
    Transition,
)
from smachac.ir.nodes import Sequence as SequenceNode
from smachac.ir.outcome_names import PREEMPTED, good_first, is_failure
from smachac.ir.script_paths import sugared_child
from smachac.ir.traversal import leads_to_child, outcome_names, walk
from smachac.ir.types import Type
from smachac.records import dataclass, field, replace
from smachac.refactor.cst import Collection, Item
from smachac.refactor.edited_script import EditedScript, HasErrorsError
from smachac.refactor.editor import RefusedError, ScriptEditor, StateItem, flow_mapping, new_atom
from smachac.refactor.equivalence import NodeMap, same_machine
from smachac.refactor.formatter import item_lines
from smachac.refactor.insertion import as_yaml, fields_of, insert_field, remove_entry, set_entry
from smachac.refactor.locate import NotFoundError, find_state


def set_transition(script: EditedScript, state: str, outcome: str, target: str | None) -> Analysis:
    """Let an outcome of a state lead to a state beside it or to an outcome of its container; None
    removes the transition from the script. The analysis afterwards."""
    machine = _machine(script)
    path, node = find_state(machine, state)
    parent = _parent(machine, path, node)
    if not isinstance(parent, StateMachine | SequenceNode):
        message = f"`{parent.name}` is not a state machine: its states have no transitions"
        raise RefusedError(node.span, message)
    optional = _optional(machine, node)
    declared = (*outcome_names(node), *sorted(optional))
    if outcome not in declared and not (isinstance(node, Leaf) and node.open):
        raise _unknown(f"`{node.name}` has no outcome `{outcome}`", outcome, declared)
    ends = outcome_names(parent)
    names = [child.name for child in parent.children]
    if target is not None and target not in (*names, *ends):
        message = f"`{target}` is neither a state nor an outcome of `{parent.name}`"
        raise _unknown(message, target, [*names, *ends])
    editor = script.editor(node.span.source)
    if target is not None:
        set_entry(editor, node.span, "transitions", outcome, target)
    elif not remove_entry(editor, node.span, "transitions", outcome):
        message = f"`{node.name}` has no transition for `{outcome}` in the script"
        raise RefusedError(node.span, message)
    led = target if target is not None else _without(parent, node, outcome)
    places = _same_places(machine, path)

    def as_wanted(after: Machine) -> bool:
        found = dict(walk(after.root)).get(path)
        if found is None:
            return False

        def changed(child: Node) -> Node:
            rest = [step for step in child.transitions if step.outcome != outcome]
            inside = target is not None or led in names
            steps = [_step(outcome, led, inside=inside)] if led else []
            free = outcome in optional
            outcomes = _with_optional(child, found, outcome) if free else child.outcomes
            return replace(child, transitions=(*rest, *steps), outcomes=outcomes)

        return same_machine(_at(machine, places, changed), after)

    return script.changed(node.span, as_wanted)


def _optional(machine: Machine, node: Node) -> frozenset[str]:
    """The outcomes that a state has only if its container or one of its transitions names them."""
    type_ = machine.state_types.get(node.type) if isinstance(node, Leaf) else None
    return type_.optional if type_ is not None else frozenset()


def _with_optional(before: Node, after: Node, name: str) -> tuple[Outcome, ...]:
    """The outcomes after a change, if they are those before with or without an optional one."""
    rest = [
        tuple(outcome for outcome in node.outcomes if outcome.name != name)
        for node in (before, after)
    ]
    return after.outcomes if rest[0] == rest[1] else before.outcomes


def _without(parent: Container, node: Node, outcome: str) -> str:
    """Where an outcome leads without a transition; empty if nowhere."""
    if isinstance(parent, SequenceNode) and outcome == parent.connector_outcome:
        names = [child.name for child in parent.children]
        after = names[names.index(node.name) + 1 :]
        return after[0] if after else outcome
    return outcome if outcome in outcome_names(parent) else ""


def _step(outcome: str, target: str, *, inside: bool) -> Transition:
    origin = "written" if inside else "implicit"
    return Transition(outcome=outcome, target=target, origin=origin, span=NOWHERE)  # type: ignore[arg-type]


def remove_state(script: EditedScript, state: str, to: str | None = None) -> Analysis:
    """Remove a state. What led to it leads to `to`: a state beside it or an outcome of its
    container; by default, where its best outcome led. The analysis afterwards."""
    machine = _machine(script)
    path, node = find_state(machine, state)
    parent = _parent(machine, path, node)
    if not isinstance(parent, StateMachine | Concurrence) or parent.sugar:
        raise RefusedError(node.span, f"`{parent.name}` needs each of its states")
    rest = [child for child in parent.children if child.name != node.name]
    if not rest:
        raise RefusedError(node.span, f"`{parent.name}` has no other state", "remove it instead")
    editor = script.editor(node.span.source)
    place = editor.state(node.span)
    own = Span(node.span.source, place.item.start, editor.end_of(place))
    if isinstance(parent, Concurrence):
        ruled = [
            condition
            for rule in parent.rules
            for condition in rule.when
            if condition.child == node.name
        ]
        if ruled:
            message = f"a rule of `{parent.name}` names `{node.name}`"
            raise RefusedError(ruled[0].span, message, "change the rule first")
        _remove_text(editor, place, own)
        changed = _remover(node.name, "", "", own)
    else:
        goal, names = _goal(parent, node, to), frozenset(child.name for child in parent.children)
        for child in rest:
            for step in child.transitions:
                if leads_to_child(step, names) and step.target == node.name:
                    text = script.editor(step.target_span.source)
                    text.replace(step.target_span.start, step.target_span.end, as_yaml(goal))
        initial = _first(script, parent, node, goal, rest[0].name)
        _remove_text(editor, place, own)
        changed = _remover(node.name, goal, initial, own)
    around = _same_places(machine, path.rpartition("/")[0])
    wanted = _at(machine, around, changed)
    return script.changed(node.span, lambda after: same_machine(wanted, after))


def _remove_text(editor: ScriptEditor, place: StateItem, own: Span) -> None:
    """Remove a state from the text, with the empty line behind the first one of a list."""
    first = place.states.items[0] is place.item
    blank = first and own.source.text.startswith("\n", own.end)
    editor.replace(own.start, own.end + blank, "")


def _goal(parent: StateMachine, node: Node, to: str | None) -> str:
    """Where the transitions to a removed state lead."""
    names = [child.name for child in parent.children if child.name != node.name]
    known = [*names, *outcome_names(parent)]
    if to is not None:
        if to not in known:
            message = f"`{to}` is neither another state nor an outcome of `{parent.name}`"
            raise _unknown(message, to, known)
        return to
    steps = {step.outcome: step.target for step in node.transitions}
    for outcome in good_first(steps):
        if steps[outcome] in known:
            return steps[outcome]
    message = f"it is not clear where the transitions to `{node.name}` shall lead"
    raise RefusedError(node.span, message, "name a state or an outcome with --to")


def _first(
    script: EditedScript, parent: StateMachine, node: Node, goal: str, next_name: str
) -> str:
    """The initial state of a container after a state was removed; it is written where needed."""
    if parent.initial != node.name:
        return parent.initial
    if goal not in [child.name for child in parent.children]:
        message = f"`{parent.name}` begins with `{node.name}`: name the state that is first then"
        raise RefusedError(node.span, message, "name it with --to")
    span = parent.initial_span
    if span.text.strip("'\"") == node.name and span.start != node.span.start:
        script.editor(span.source).replace(span.start, span.end, as_yaml(goal))
    elif goal != next_name:
        editor = script.editor(parent.span.source)
        insert_field(editor, fields_of(editor, parent.span), f"initial: {as_yaml(goal)}")
    return goal


def _remover(name: str, goal: str, initial: str, own: Span) -> NodeMap:
    """The change of a container that loses a state, whose text is `own`, and what that presets."""

    def changed(parent: Node) -> Node:
        assert not isinstance(parent, Leaf)
        names = frozenset(child.name for child in parent.children)
        inside = goal in names

        def led(step: Transition) -> Transition:
            there = leads_to_child(step, names) and step.target == name
            return _step(step.outcome, goal, inside=inside) if there and goal else step

        children = tuple(
            replace(child, transitions=tuple(map(led, child.transitions)))
            for child in parent.children
            if child.name != name
        )
        userdata = tuple(_kept(parent.userdata, own))
        parent = replace(parent, children=children, userdata=userdata)
        return replace(parent, initial=initial) if isinstance(parent, StateMachine) else parent

    return changed


def _kept(presets: Iterable[Preset], own: Span) -> Iterable[Preset]:
    """The presets of a container without those of the state whose text is removed."""

    def lost(span: Span) -> bool:
        return span.source is own.source and own.start <= span.start < own.end

    for preset in presets:
        given = [given for given in preset.given if not lost(given.span)]
        if given:
            yield replace(preset, value=given[-1].value)
        elif not lost(preset.span):
            yield preset


@dataclass(frozen=True, slots=True, kw_only=True)
class NewState:
    """A state to add: its name, its state type, and some of its transitions and variables."""

    name: str
    type: str
    transitions: Mapping[str, str] = field(default_factory=dict)
    variables: Mapping[str, object] = field(default_factory=dict)


def add_state(
    script: EditedScript,
    container: str,
    new: NewState,
    *,
    after: str | None = None,
    on: str | None = None,
) -> Analysis:
    """Add a state to a container, behind the state `after` or as the last one. With
    `on`, this outcome of `after` leads to the new state, whose best outcome leads on from there.

    Required variables without a value get a placeholder, and outcomes without a transition one that
    suits their names. The analysis afterwards.
    """
    name = new.name
    machine = _machine(script)
    path, parent = find_state(machine, container)
    while not isinstance(parent, Leaf) and (inside := sugared_child(parent)) is not None:
        path, parent = f"{path}/{inside.name}", inside
    if isinstance(parent, Leaf):
        raise RefusedError(parent.span, f"`{parent.name}` is not a container of the script")
    if isinstance(parent, Iterator):
        raise RefusedError(parent.span, f"`{parent.name}` runs one state: it cannot have two")
    if not parent.children:
        raise RefusedError(parent.span, f"`{parent.name}` has no state yet")
    taken = {child.name: child for child in parent.children}
    if name in taken or name in outcome_names(parent) or not name.strip() or "/" in name:
        message = f"`{parent.name}` cannot have another state `{name}`"
        raise RefusedError(parent.span, message, "choose another name")
    if after is not None and after not in taken:
        raise _unknown(f"`{parent.name}` has no state `{after}`", after, list(taken))
    type_ = find_state_type(new.type, script.library(), [])
    if type_ is None or type_.kind != "state":
        raise NotFoundError(f"there is no state type `{new.type}` for states")
    before = taken[after] if after is not None else parent.children[-1]
    editor = script.editor(before.span.source)
    place = editor.state(before.span)
    given = dict(new.transitions)
    if on is not None:
        if not isinstance(parent, StateMachine) or on not in outcome_names(before):
            message = f"`{before.name}` has no outcome `{on}` that leads on"
            raise _unknown(message, on, outcome_names(before))
        goal = next((step.target for step in before.transitions if step.outcome == on), None)
        if goal is not None:
            given.setdefault(good_first(_outcomes(type_))[0], goal)
        set_entry(editor, before.span, "transitions", on, name)
    led = _transitions(parent, name, type_, given)
    item = _state_item(name, type_, new.variables, led)
    if any(item.leading[:1] == [""] for item in place.states.items):
        item.leading = [""]
    lines = item_lines(item, place.states.column, first=False)
    editor.insert_lines(editor.end_of(place), lines)
    places = _same_places(machine, path)
    befores = _same_places(machine, f"{path}/{before.name}")

    def same(whole: Machine) -> bool:
        nodes = dict(walk(whole.root))
        made = [nodes.get(f"{place}/{name}") for place in places]
        wanted = machine if on is None else _at(machine, befores, partial(_led, on, name))
        return all(_is_made(state, new.type, led) for state in made) and same_machine(
            wanted, _at(whole, places, lambda node: _without_child(node, name))
        )

    return script.changed(parent.span, same)


def _led(outcome: str, target: str, node: Node) -> Node:
    """A state with another target for an outcome."""
    rest = [step for step in node.transitions if step.outcome != outcome]
    return replace(node, transitions=(*rest, _step(outcome, target, inside=True)))


def _is_made(node: Node | None, type_name: str, led: Mapping[str, str]) -> bool:
    """Whether a new state has its type and its transitions."""
    if node is None or node.type != type_name:
        return False
    return led.items() <= {step.outcome: step.target for step in node.transitions}.items()


def _without_child(parent: Node, name: str) -> Node:
    assert not isinstance(parent, Leaf)
    children = tuple(child for child in parent.children if child.name != name)
    return replace(parent, children=children)


def _transitions(
    parent: Container, name: str, type_: StateType, given: Mapping[str, str]
) -> dict[str, str]:
    """The transitions of a new state: those given; a failure leads to an outcome of failure, any
    other outcome to the best one. None for outcomes that the container has too."""
    if not isinstance(parent, StateMachine):
        return dict(given)
    ends = good_first(outcome_names(parent))
    known = [*(child.name for child in parent.children), name, *ends]
    for target in given.values():
        if target not in known:
            message = f"`{target}` is neither a state nor an outcome of `{parent.name}`"
            raise _unknown(message, target, known)
    found = dict(given)
    for outcome in _outcomes(type_):
        if outcome not in found and outcome not in ends and ends:
            bad = [end for end in ends if is_failure(end)]
            fails = is_failure(outcome) or outcome == PREEMPTED
            found[outcome] = bad[0] if bad and fails else ends[0]
    return found


def _outcomes(type_: StateType) -> Sequence[str]:
    """The outcomes of a new state. A script lists those that the type leaves to it."""
    names = [outcome.name for outcome in type_.outcomes if outcome.name not in type_.optional]
    return names or ["succeeded"]


def _state_item(
    name: str, type_: StateType, variables: Mapping[str, object], led: Mapping[str, str]
) -> Item:
    """The syntax tree of a new state."""
    values = {
        variable.name: _placeholder(variable.type)
        for variable in type_.variables.values()
        if variable.required and variable.default is None
    } | dict(variables)
    rows: list[tuple[str, str | Collection]] = [("template", as_yaml(type_.name))]
    if "outcomes" in type_.given and not type_.outcomes:
        rows.append(("outcomes", f"[{', '.join(map(as_yaml, _outcomes(type_)))}]"))
    rows += [(name, _yaml_value(value)) for name, value in values.items()]
    if led:
        pairs = ((as_yaml(outcome), as_yaml(target)) for outcome, target in led.items())
        rows.append(("transitions", flow_mapping(pairs)))
    items = [
        Item(new_atom(as_yaml(key)), new_atom(row) if isinstance(row, str) else row)
        for key, row in rows
    ]
    body = Collection(True, False, -1, items=items)
    return Item(None, Collection(True, False, -1, items=[Item(new_atom(as_yaml(name)), body)]))


_PLACEHOLDERS: Mapping[str, object] = {
    "bool": False, "int": 0, "float": 0.0, "str": "", "list": [], "array": [], "dict": {},
}  # fmt: skip


def _placeholder(type_: Type) -> object:
    """A value for a variable of a type: zero, an empty text or list, the first choice."""
    if type_.name == "one_of" and type_.args:
        return type_.args[0]
    return _PLACEHOLDERS.get(type_.name)


def _yaml_value(value: object) -> str:
    if isinstance(value, str):
        return as_yaml(value)
    return json.dumps(value, ensure_ascii=False)


def _machine(script: EditedScript) -> Machine:
    """The machine of a script, which may have errors. Raises HasErrorsError if it is not known."""
    if script.analysis.machine is None:
        raise HasErrorsError
    return script.analysis.machine


def _parent(machine: Machine, path: str, node: Node) -> Container:
    """The container of the state at a path. Raises RefusedError for the whole script."""
    above = path.rpartition("/")[0]
    if not above:
        raise RefusedError(node.span, "this is the whole script")
    parent = dict(walk(machine.root))[above]
    assert not isinstance(parent, Leaf)
    return parent


def _unknown(message: str, word: str, known: Sequence[str]) -> NotFoundError:
    near = did_you_mean(word, known) or f"it has {listed(known)}"
    return NotFoundError(f"{message}\n{near}")


def _same_places(machine: Machine, path: str) -> frozenset[str]:
    """The paths of a state in all calls of the sub-script that contains it. Of a state with sugar
    they are those of the outermost containers."""
    nodes = dict(walk(machine.root))
    span = nodes[path].span
    found = [name for name, node in nodes.items() if node.span == span]
    return frozenset(
        text for text in found if "/" not in text or nodes[text.rpartition("/")[0]].span != span
    )


def _at(machine: Machine, paths: frozenset[str], change: NodeMap) -> Machine:
    """A machine in which the nodes at some paths are changed."""

    def mapped(node: Node, here: str) -> Node:
        if not isinstance(node, Leaf):
            children = tuple(mapped(child, f"{here}/{child.name}") for child in node.children)
            node = replace(node, children=children)
        return change(node) if here in paths else node

    root = mapped(machine.root, machine.root.name)
    assert isinstance(root, StateMachine)
    return replace(machine, root=root)

"""Lowering: from a resolved script to the state graph. Every script has a graph; rules judge it."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping
from pathlib import PurePath
from typing import Any, NamedTuple, TypeAlias

from smachac.diagnostics.source import NOWHERE, Span, Word, assert_never
from smachac.frontend import schema
from smachac.frontend.resolved_script import ANY_OUTCOME, ERROR, Script, State
from smachac.frontend.script.desugar import desugared
from smachac.frontend.text.fields import Keys, Pairs
from smachac.ir import nodes
from smachac.ir.graph import is_unread
from smachac.ir.nodes import (
    Autonomy,
    Concurrence,
    Condition,
    Container,
    ContainerKind,
    Expression,
    Given,
    Key,
    KeyRole,
    Leaf,
    Machine,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    Sequence,
    StateMachine,
    Struct,
    Transition,
    Value,
    Variable,
    VariableType,
)
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY
from smachac.records import replace

_VARIABLE = re.compile(r"(\.?)\{(\w+)\}")
"""A part of a claim that the value of a variable replaces."""


NodeCache: TypeAlias = "dict[tuple[Span, tuple[Span, ...]], tuple[State, Node]]"
"""The nodes with the states that they were made from, by the spans of the name and of the calls
around."""


def lower(script: Script, kept: NodeCache | None = None) -> Machine:
    """The machine that a script describes. `kept` are the nodes of the machine before a change,
    which become those of this one: a state that is the same object has the same node."""
    base = script.base
    nodes = _Nodes(kept, {})
    root = _container(base, "StateMachine", nodes)
    assert isinstance(root, StateMachine)
    if kept is not None:
        kept.clear()
        kept.update(nodes.new)
    digest = hashlib.sha256()
    for source in script.sources:
        digest.update(source.text.encode("utf-8", "surrogatepass"))
        digest.update(b"\0")
    return Machine(
        root=replace(root, type="StateMachine"),
        base=base.type.name or "Base",
        variables=base.variables,
        source=PurePath(script.sources[0].name).name,
        digest=digest.hexdigest(),
        robot=script.robot,
        definitions=script.definitions,
        missing_definitions=script.missing_definitions,
        other_types=script.other_types,
        functions=script.functions,
        unused=script.unused,
        properties=script.properties,
        params=script.params,
        fixed_params=script.fixed_params,
        state_types=script.state_types,
        aliases=script.aliases,
    )


def _keys(
    listed: Keys,
    known: tuple[Key, ...],
    roles: Mapping[str, KeyRole],
    default: tuple[Key, ...],
    secret: frozenset[str],
) -> tuple[Key, ...]:
    """The keys of an interface and those that the script lists, which have `roles` by name; where
    it lists none, the default ones. The keys in `secret` are secret."""
    if not listed:
        if not default:
            return known
        names = {key.name for key in known}
        return (*known, *(key for key in default if key.name not in names))
    keys = {key.name: key for key in known}
    for word, type_ in listed:
        declared = keys.get(word.text)
        keys[word.text] = Key(
            name=word.text,
            type=type_ or (declared.type if declared else ANY),
            doc=declared.doc if declared else "",
            role=declared.role if declared else roles.get(word.text, roles.get("*", "")),
            frame=declared.frame if declared else "",
            secret=word.text in secret,
            span=word.span,
        )
    return tuple(keys.values())


def _interface(state: State) -> dict[str, Any]:
    """The fields that every node has, without outcomes."""
    type_ = state.type
    return {
        "name": state.name.text,
        "type": type_.name,
        "doc": state.doc.strip(),
        "inputs": _keys(
            state.input_keys,
            type_.input_keys,
            type_.listed_inputs,
            type_.default_keys.get("input_keys", ()),
            type_.secret_keys,
        ),
        "outputs": _keys(
            state.output_keys,
            type_.output_keys,
            type_.listed_outputs,
            type_.default_keys.get("output_keys", ()),
            type_.secret_keys,
        ),
        "transitions": tuple(
            [
                Transition(
                    outcome=key.text, target=target.text, span=key.span, target_span=target.span
                )
                for key, target in state.transitions
            ]
        ),
        "remaps": _remaps(state.remapping) if state.remapping else (),
        "claims": _claims(state) if type_.claims or state.claims else (),
        "tags": tuple([word.text for word in state.tags]) if state.tags else (),
        "autonomy": _autonomy(state.autonomy) if state.autonomy else (),
        "span": state.name.span,
        "via": state.via,
        "written": state.written,
    }


def _remaps(pairs: Pairs) -> tuple[Remap, ...]:
    return tuple([Remap(key=key.text, to=to.text, span=key.span, to_span=to.span)
                  for key, to in pairs])  # fmt: skip


def _autonomy(pairs: Pairs) -> tuple[Autonomy, ...]:
    return tuple(Autonomy(outcome=key.text, level=level.text, span=key.span)
                 for key, level in pairs)  # fmt: skip


def _claims(state: State) -> tuple[str, ...]:
    """The resources that a state claims, those of its type included, each once."""
    claims = (*state.type.claims, *(word.text for word in state.claims))
    return tuple(
        dict.fromkeys(_VARIABLE.sub(lambda found: _part(state, found), claim) for claim in claims)
    )


def _part(state: State, found: re.Match[str]) -> str:
    """The part of a claim for `{name}`: the value of that variable, or nothing, without the dot
    before it, if the value is null. A variable without a constant value, and a key, stay in braces.
    """
    dot, name = found.groups()
    if name in schema.VARIABLES:
        return found[0]
    value = next((variable.value for variable in state.variables if variable.name == name), None)
    known = state.type.variables.get(name)
    if value is None and known is not None:
        value = known.default
    match value:
        case Value(data=None):
            return ""
        case Value(data=bool()):
            return found[0]
        case Value(data=str() | int() as constant):
            return f"{dot}{constant}"
    return found[0]


def _leaf(state: State) -> Leaf:
    type_ = state.type
    outcomes = {outcome.name: outcome for outcome in type_.outcomes}
    for given in _given_outcomes(state):
        declared = outcomes.setdefault(given.name, given)
        if given.failure is not None:
            outcomes[given.name] = replace(declared, failure=given.failure)
    leaf = Leaf(
        **_interface(state),
        outcomes=tuple(outcomes.values()),
        variables=(*state.variables, *_defaults(state)) if type_.variables else state.variables,
        writes=type_.writes,
        open=type_.open or type_.any_key,
        blocking=type_.blocking,
        class_facts=type_.class_facts,
        built_in=type_.built_in,
        stand_in=type_.stand_in,
        any_key=type_.any_key,
        adds_frames=type_.adds_frames,
        misplaced_keys=state.misplaced_keys,
    )
    for known in type_.variables.values():
        if known.role == "conditions":
            return _with_conditions(leaf, known)
    return leaf


def _given_outcomes(state: State) -> list[Outcome]:
    """The outcomes that a script lists: those that it adds to the state type, or declares again."""
    type_ = state.type
    if not type_.open and "outcomes" not in type_.given:
        # An outcome that the type lacks was reported; its transition is no second fault.
        if not state.outcomes:
            return []
        names = {key.text for key, _ in state.transitions}
        names.update(outcome.name for outcome in type_.outcomes)
        return [outcome for outcome in state.outcomes if outcome.name in names]
    given = [*state.outcomes]
    if state.default_outcome is not None:
        given.append(_outcome(state.default_outcome))
    else:
        default = type_.variables.get("default_outcome")
        if default is not None and default.default is not None:
            match default.default.data:
                case tuple() | Struct() | Expression():
                    pass
                case data:
                    given.append(Outcome(name=str(data), span=state.name.span))
    if type_.open and not given:
        return [_outcome(key) for key, _ in state.transitions]
    return given


def _outcome(word: Word) -> Outcome:
    return Outcome(name=word.text, span=word.span)


def _defaults(state: State) -> Iterable[Variable]:
    """The default outcome of a state, if the script leaves it to the interface."""
    known = state.type.variables.get("default_outcome")
    if known is None or known.default is None:
        return
    if all(variable.name != known.name for variable in state.variables):
        yield Variable(
            name=known.name,
            type=known.type,
            role=known.role,
            value=known.default,
            span=state.name.span,
        )


def _without_optional(child: Node, state: State, outcomes: frozenset[str]) -> Node:
    """A state without the optional outcomes of its type that nothing in the script names."""
    if not isinstance(child, Leaf) or not state.type.optional:
        return child
    led = {edge.outcome for edge in child.transitions} | outcomes
    dropped = state.type.optional - led
    kept = tuple(outcome for outcome in child.outcomes if outcome.name not in dropped)
    return child if len(kept) == len(child.outcomes) else replace(child, outcomes=kept)


class _Nodes(NamedTuple):
    """The nodes of the machine before a change, and those of this one. `old` is None where nobody
    keeps nodes: then those of leaves are not noted."""

    old: NodeCache | None
    new: NodeCache


def _container(state: State, owner: ContainerKind, kept: _Nodes) -> Container:
    children = tuple([_node(child, kept) for child in state.states])
    fields = _interface(state)
    fields["outcomes"] = state.outcomes
    fields["userdata"] = presets(state)
    match owner:
        case "Concurrence":
            return _concurrence(state, fields, children)
        case "Iterator":
            return _iterator(state, fields, children)
        case "StateMachine":
            return StateMachine(**fields, **_linear(state, children), forever=state.forever)
        case "Sequence":
            connector = _text(state.connector_outcome)
            linear = _linear(state, _linked(children, connector))
            word = state.connector_outcome
            return Sequence(
                **fields,
                **linear,
                connector_outcome=connector,
                connector_span=word.span if word is not None else NOWHERE,
            )
    return assert_never(owner)


def _linear(state: State, children: tuple[Node, ...]) -> dict[str, Any]:
    """The children of a state machine or sequence, with their implied edges, and its initial
    state."""
    outcomes = frozenset(outcome.name for outcome in state.outcomes)
    if state.on_error is not None:
        target = state.on_error
        children = tuple([_with_error_transition(child, target) for child in children])
    children = tuple(map(_without_optional, children, state.states, [outcomes] * len(children)))
    first = children[0].name if children else ""
    initial = state.initial or Word(first, state.name.span)
    return {
        "children": tuple(_with_implicit(child, outcomes) for child in children),
        "initial": initial.text,
        "initial_span": initial.span,
    }


def _text(word: Word | None, default: str = "") -> str:
    return word.text if word is not None else default


def _node(state: State, kept: _Nodes) -> Node:
    assert state.owner != "base"
    if state.owner == "state" and kept.old is None:
        return _with_sugar(_leaf(state), state)
    place = state.name.span, state.via
    known = kept.old.get(place) if kept.old is not None else None
    if known is None or known[0] is not state:
        node = _leaf(state) if state.owner == "state" else _container(state, state.owner, kept)
        known = state, _with_sugar(node, state)
    kept.new[place] = known
    return known[1]


def _with_sugar(node: Node, state: State) -> Node:
    """The node with its transition on errors, in the containers of its sugar."""
    words = [key for key, _ in state.transitions]
    for part in (state.sugar.retry, state.sugar.for_each):
        if part is not None:
            words += part.on
    return desugared(_with_error(node, words), state.sugar)


def _linked(children: tuple[Node, ...], connector: str) -> tuple[Node, ...]:
    """The states of a sequence, each linked to the next by the connector outcome.

    docs/semantics.md, Sequence.
    """
    linked = []
    for child, after in zip(children, (*children[1:], None), strict=False):
        has = any(outcome.name == connector for outcome in child.outcomes)
        own = any(transition.outcome == connector for transition in child.transitions)
        if after is not None and has and not own:
            link = Transition(
                outcome=connector, target=after.name, origin="connector", span=child.span
            )
            child = replace(child, transitions=(*child.transitions, link))
        linked.append(child)
    return tuple(linked)


def _with_implicit(child: Node, outcomes: frozenset[str]) -> Node:
    """The child with the edges that its container's outcomes imply.

    docs/semantics.md, Steps and transitions.
    """
    names = [outcome.name for outcome in child.outcomes if outcome.name in outcomes]
    if not names:
        return child
    own = {transition.outcome for transition in child.transitions}
    implied = [
        Transition(outcome=name, target=name, origin="implicit", span=child.span)
        for name in names
        if name not in own
    ]
    return replace(child, transitions=(*child.transitions, *implied)) if implied else child


def _concurrence(state: State, fields: dict[str, Any], children: tuple[Node, ...]) -> Concurrence:
    default = state.default_outcome or Word("", state.name.span)
    join = _text(state.join)
    endings: dict[str, list[Word]] = {}
    for _, conditions in state.outcome_map:
        for name, ending in conditions:
            endings.setdefault(name.text, []).append(ending)
    children = tuple(_with_error(child, endings.get(child.name, [])) for child in children)
    return Concurrence(
        **fields,
        children=children,
        default_outcome=default.text,
        default_span=default.span,
        rules=tuple(
            _outcome_rule(outcome, conditions, children)
            for outcome, conditions in state.outcome_map
        ),
        join="rule" if join == "rule" else "any" if join == "any" else "all",
    )


def _outcome_rule(outcome: Word, conditions: Pairs, children: tuple[Node, ...]) -> OutcomeRule:
    """A rule of an outcome map. A state with `any` is no condition, unless it has an outcome of
    that name."""
    ignored = [child for child, ending in conditions if ending.text == ANY_OUTCOME]
    if ignored:
        own = {child.name for child in children if ANY_OUTCOME in outcome_names(child)}
        ignored = [child for child in ignored if child.text not in own]
    return OutcomeRule(
        outcome=outcome.text,
        span=outcome.span,
        when=tuple(
            Condition(child=child.text, outcome=ending.text, span=child.span)
            for child, ending in conditions
            if child not in ignored
        ),
        ignored=tuple(ignored),
    )


def _iterator(state: State, fields: dict[str, Any], children: tuple[Node, ...]) -> nodes.Iterator:
    """An iterator with all its looping outcomes (docs/semantics.md, Iterator)."""
    words = [*state.loop_outcomes, *state.break_outcomes]
    words += [key for key, _ in state.final_outcome_map]
    children = tuple(_with_error(child, words) for child in children)
    own = [outcome.name for child in children[:1] for outcome in child.outcomes]
    breaks = [word.text for word in state.break_outcomes]
    loops = [word.text for word in state.loop_outcomes]
    if breaks:
        loops = [name for name in own if name not in breaks]
    exhausted = state.exhausted_outcome or Word("exhausted", state.name.span)
    final = {key.text: to.text for key, to in state.final_outcome_map}
    declared: tuple[Outcome, ...] = fields["outcomes"]
    results = [final.get(exhausted.text, exhausted.text)]
    if not declared:
        results += [final.get(name, name) for name in own if name not in loops]
    known = {outcome.name for outcome in declared}
    fields["outcomes"] = declared + tuple(
        Outcome(name=name, span=exhausted.span)
        for name in dict.fromkeys(results)
        if name not in known
    )
    items, items_key = state.it, ""
    match state.it:
        case Value(data=str() as items_key):  # the name of a key of the userdata
            items = None
    return nodes.Iterator(
        **fields,
        children=children,
        items=items,
        items_key=items_key,
        items_span=state.it.span if state.it is not None else NOWHERE,
        item_key=_text(state.it_label, "it_data"),
        item_span=state.it_label.span if state.it_label is not None else NOWHERE,
        exhausted_outcome=exhausted.text,
        exhausted_span=exhausted.span,
        loop_outcomes=tuple(loops),
        loop_spans=() if breaks else tuple(word.span for word in state.loop_outcomes),
        final_map=tuple(final.items()),
        final_spans=tuple({key.text: key.span for key, _ in state.final_outcome_map}.values()),
    )


def presets(state: State) -> tuple[Preset, ...]:
    """The userdata of a container, its own and that of its leaves: the last value of each key."""
    found: dict[str, Preset] = {}
    given: dict[str, list[Given]] = {}
    for child in (state, *(child for child in state.states if child.owner == "state")):
        for preset in child.userdata:
            found[preset.key] = preset
            given.setdefault(preset.key, []).append(
                Given(child.name, preset.value, preset.span, child is state)
            )
    return tuple(
        replace(preset, given=tuple(given[key])) if len(given[key]) > 1 else preset
        for key, preset in found.items()
    )


def _catching(node: Node, span: Span) -> Node:
    """The state with one more outcome, for its exceptions; `span` is the place that names it."""
    if node.catches:
        return node
    own, name = outcome_names(node), ERROR
    while name in own:
        name = f"caught_{name}"
    return replace(node, catches=name, outcomes=(*node.outcomes, Outcome(name=name, span=span)))


def _with_error(node: Node, words: Iterable[Word]) -> Node:
    """The state with an outcome `error` for its exceptions, if `words` name one and the state
    neither has such an outcome nor is open."""
    for word in words:
        if word.text == ERROR:
            has_no_interface = isinstance(node, Leaf) and node.open and not node.any_key
            own = has_no_interface or ERROR in outcome_names(node)
            return node if own else _catching(node, word.span)
    return node


def _with_error_transition(node: Node, target: Word) -> Node:
    """A state of a container that has `on_error: target`: its exceptions lead to the target, unless
    it is the target itself or has a transition for them."""
    if node.name == target.text or is_unread(node):
        return node
    node = _catching(node, target.span)
    if any(step.outcome == node.catches for step in node.transitions):
        return node
    step = Transition(
        outcome=node.catches, target=target.text, span=target.span, target_span=target.span
    )
    return replace(node, transitions=(*node.transitions, step))


def _with_conditions(leaf: Leaf, conditions: VariableType) -> Leaf:
    """A leaf whose outcomes have conditions: the input key named like an outcome is its condition,
    if it has no other (SMACHA's rule)."""
    known = {variable.name: variable for variable in leaf.variables}
    held = known.get(conditions.name)
    given = held.value.data if held is not None else Struct(entries=())
    if leaf.open or not isinstance(given, Struct):
        return leaf
    inputs = {key.name for key in leaf.inputs} - {name for name, _ in given.entries}
    keyed = [
        outcome
        for outcome in leaf.outcomes
        if outcome.name in inputs and outcome.name.isidentifier()
    ]
    if not keyed and held is not None:
        return leaf
    code = [
        (outcome.name, Expression(text=f"lambda ud: ud.{outcome.name}", span=outcome.span))
        for outcome in keyed
    ]
    span = keyed[0].span if keyed else leaf.span
    value = Value(data=Struct(entries=(*given.entries, *code)), span=span)
    made = Variable(name=conditions.name, role=conditions.role, value=value, span=span)
    others = [variable for variable in leaf.variables if variable.name != conditions.name]
    return replace(leaf, variables=(made, *others))

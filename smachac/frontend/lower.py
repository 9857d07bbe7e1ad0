"""A script to the state graph. Total: whatever the script holds has a graph; rules judge it."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import PurePath
from typing import Any, cast

from smachac.diagnostics.source import Span, Word
from smachac.frontend import field_shapes, schema
from smachac.frontend.desugar import desugared
from smachac.frontend.resolve import Script, State
from smachac.frontend.sugar import ERROR, NAMES, has_sugar, is_own, read_sugar
from smachac.frontend.type_annotations import is_long_form
from smachac.frontend.values import as_value, as_written
from smachac.frontend.yaml_tree import Map, Scalar, Tree
from smachac.ir import nodes
from smachac.ir.graph import is_unread
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Container,
    Expression,
    Given,
    Key,
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
)
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY, parse_type

_NOT_VARIABLES = frozenset(schema.names_for("state")) | {"script"}
"""What of a leaf's fields belongs to the language; the rest are variables of its state type."""

_VARIABLE = re.compile(r"(\.?)\{(\w+)\}")
"""A part of a claim that is filled in."""

_BASE_VARIABLES = ("node_name", "function_name", "manifest")


def lower(script: Script) -> Machine:
    """The machine that a script describes."""
    base = script.base
    root = _container(base, "StateMachine")
    assert isinstance(root, StateMachine)
    digest = hashlib.sha256()
    for source in script.sources:
        digest.update(source.text.encode("utf-8", "surrogatepass"))
        digest.update(b"\0")
    names = [*_BASE_VARIABLES, *base.type.variables]
    return Machine(
        root=replace(root, type="StateMachine"),
        base=base.type.name or "Base",
        variables=tuple(_variable(base, name) for name in names if name in base.fields),
        source=PurePath(script.sources[0].name).name,
        digest=digest.hexdigest(),
        robot=script.robot,
        unused=script.unused,
    )


def _tree(state: State, name: str) -> Tree | None:
    entry = state.fields.get(name)
    return entry.value if entry is not None else None


def _words(state: State, name: str) -> tuple[Word, ...]:
    if name in state.read:
        return cast(tuple[Word, ...], state.read[name])
    tree = _tree(state, name)
    return field_shapes.as_names(tree, []) if tree is not None else ()


def _pairs(state: State, name: str) -> tuple[tuple[Word, Word], ...]:
    if name in state.read:
        return cast(tuple[tuple[Word, Word], ...], state.read[name])
    tree = _tree(state, name)
    return field_shapes.as_pairs(tree, []) if tree is not None else ()


def _word(state: State, name: str, default: str = "") -> Word:
    tree = _tree(state, name)
    word = field_shapes.as_name(tree, []) if tree is not None else None
    return word or Word(default, state.name.span)


def _variable(state: State, name: str) -> Variable:
    entry = state.fields[name]
    value = as_value(entry.value, code=name == "callbacks")
    known = state.type.variables.get(name)
    type_ = known.type if known is not None else ANY
    return Variable(name=name, type=type_, value=value, span=entry.key.span)


def _keys(state: State, name: str, known: tuple[Key, ...]) -> tuple[Key, ...]:
    """The keys of an interface and those the script adds."""
    part = name.removesuffix("_keys")
    listed = [key for key, each in state.type.variables.items() if each.keys == part]
    trees = [tree for key in (name, *listed) if (tree := _tree(state, key)) is not None]
    if not trees:
        return known
    keys = {key.name: key for key in known}
    for word, type_ in (pair for tree in trees for pair in field_shapes.as_keys(tree, [])):
        found = parse_type(type_.text) if type_ is not None else None
        below = keys.get(word.text)
        keys[word.text] = Key(
            name=word.text,
            type=found or (below.type if below else ANY),
            doc=below.doc if below else "",
            span=word.span,
        )
    return tuple(keys.values())


def _interface(state: State) -> dict[str, Any]:
    """The fields that every node has, without outcomes."""
    doc = _tree(state, "doc")
    type_ = state.type
    return {
        "name": state.name.text,
        "type": type_.name,
        "doc": field_shapes.as_text(doc, []).strip() if doc is not None else "",
        "inputs": _keys(state, "input_keys", type_.input_keys),
        "outputs": _keys(state, "output_keys", type_.output_keys),
        "transitions": tuple(
            Transition(outcome=key.text, target=target.text, span=key.span, target_span=target.span)
            for key, target in _pairs(state, "transitions")
        ),
        "remaps": tuple(
            Remap(key=key.text, to=to.text, span=key.span) for key, to in _pairs(state, "remapping")
        ),
        "claims": tuple(
            dict.fromkeys(
                _VARIABLE.sub(lambda found: _part(state, found), claim)
                for claim in (*type_.claims, *(word.text for word in _words(state, "claims")))
            )
        ),
        "span": state.name.span,
        "via": state.via,
        "written": tuple(_written(state)) if type_.prints_itself else (),
    }


def _written(state: State) -> Iterable[Variable]:
    """What the script says of a state; params are those in scope."""
    for name, entry in state.fields.items():
        if name not in ("template", "states", "params"):
            yield Variable(name=name, value=as_written(entry.value), span=entry.key.span)
    if state.params:
        entries = ((name, as_written(tree).data) for name, tree in state.params.items())
        value = Value(data=Struct(entries=tuple(entries)), span=state.name.span)
        yield Variable(name="params", value=value, span=state.name.span)


def _part(state: State, found: re.Match[str]) -> str:
    """A part of a claim in braces: what a variable holds, without its dot where that is nothing.
    What is no constant, and a key, stays in braces."""
    dot, name = found.groups()
    entry = state.fields.get(name)
    known = state.type.variables.get(name)
    tree = entry.value if entry is not None else known.default if known is not None else None
    if tree is None or name in schema.VARIABLES:
        return found[0]
    match as_value(tree).data:
        case None:
            return ""
        case bool():
            return found[0]
        case str() | int() as value:
            return f"{dot}{value}"
    return found[0]


def _leaf(state: State) -> Leaf:
    type_ = state.type
    fields = _interface(state)
    outcomes = {outcome.name: outcome for outcome in type_.outcomes}
    if type_.open or "outcomes" in type_.given:
        given = [*_words(state, "outcomes")]
        if "default_outcome" in state.fields:
            given.append(_word(state, "default_outcome"))
        elif "default_outcome" in type_.variables:
            default = type_.variables["default_outcome"].default
            given += (
                [Word(str(default.value), state.name.span)] if isinstance(default, Scalar) else []
            )
        if type_.open and not given:
            given += [key for key, _ in _pairs(state, "transitions")]
    else:
        # What the type does not have was told; its transition is no second fault.
        led = {key.text for key, _ in _pairs(state, "transitions")}
        given = [word for word in _words(state, "outcomes") if word.text in led]
    for word in given:
        outcomes.setdefault(word.text, Outcome(name=word.text, span=word.span))
    leaf = Leaf(
        **fields,
        outcomes=tuple(outcomes.values()),
        variables=(
            *(
                _variable(state, name)
                for name in state.fields
                if name not in _NOT_VARIABLES or (name in NAMES and is_own(name, type_))
            ),
            *_defaults(state),
        ),
        writes=type_.writes,
        open=type_.open,
        blocking=type_.blocking,
        body=type_.body,
    )
    return with_conditions(leaf) if leaf.type == "ConditionalOutcomeState" else leaf


def _defaults(state: State) -> Iterable[Variable]:
    """The default outcome of a state, where the script leaves it to the interface."""
    known = state.type.variables.get("default_outcome")
    if known is not None and known.default is not None and known.name not in state.fields:
        value = as_value(known.default)
        yield Variable(name=known.name, type=known.type, value=value, span=state.name.span)


def _without_optional(child: Node, state: State, outcomes: frozenset[str]) -> Node:
    """A state without those outcomes that its type can do without, and that nobody speaks of."""
    if not isinstance(child, Leaf) or not state.type.optional:
        return child
    led = {edge.outcome for edge in child.transitions} | outcomes
    dropped = state.type.optional - led
    kept = tuple(each for each in child.outcomes if each.name not in dropped)
    return child if len(kept) == len(child.outcomes) else replace(child, outcomes=kept)


def _container(state: State, owner: str) -> Container:
    children = tuple([_node(child) for child in state.states])
    fields = _interface(state)
    fields["outcomes"] = tuple(
        Outcome(name=word.text, span=word.span) for word in _words(state, "outcomes")
    )
    fields["userdata"] = presets(state)
    outcomes = frozenset(outcome.name for outcome in fields["outcomes"])
    match owner:
        case "Concurrence":
            return _concurrence(state, fields, children)
        case "Iterator":
            return _iterator(state, fields, children)
        case "Sequence":
            connector = _word(state, "connector_outcome")
            children = _linked(children, connector.text)
            fields["connector_outcome"] = connector.text
    if "on_error" in state.fields:
        target = _word(state, "on_error")
        children = tuple([with_way_out(child, target) for child in children])
    children = tuple(map(_without_optional, children, state.states, [outcomes] * len(children)))
    fields["children"] = tuple(_with_implicit(child, outcomes) for child in children)
    first = children[0].name if children else ""
    initial = _word(state, "initial", first)
    fields["initial"] = initial.text
    fields["initial_span"] = initial.span
    if owner == "Sequence":
        return Sequence(**fields)
    forever = _tree(state, "forever")
    fields["forever"] = isinstance(forever, Scalar) and forever.value is True
    return StateMachine(**fields)


def _node(state: State) -> Node:
    node = _leaf(state) if state.owner == "state" else _container(state, state.owner)
    words = [key for key, _ in _pairs(state, "transitions")]
    if not has_sugar(state.fields, state.type):
        return if_asked(node, words)
    sugar = read_sugar(state.fields, state.type, [])
    for part in (sugar.retry, sugar.for_each):
        words += part.on if part is not None else ()
    return desugared(if_asked(node, words), sugar)


def _linked(children: tuple[Node, ...], connector: str) -> tuple[Node, ...]:
    """The states of a sequence, each linked to the next by the connector (smach-semantics Q2)."""
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
    """The child with the edges that its container's outcomes imply (smach-semantics M6)."""
    own = {transition.outcome for transition in child.transitions}
    implied = tuple(
        Transition(outcome=o.name, target=o.name, origin="implicit", span=child.span)
        for o in child.outcomes
        if o.name not in own and o.name in outcomes
    )
    if not implied:
        return child
    return replace(child, transitions=(*child.transitions, *implied))


def _concurrence(state: State, fields: dict[str, Any], children: tuple[Node, ...]) -> Concurrence:
    default = _word(state, "default_outcome")
    tree = _tree(state, "outcome_map")
    rules = field_shapes.as_rules(tree, []) if tree is not None else ()
    pairs = [pair for _, conditions in rules for pair in conditions]
    children = tuple(
        if_asked(child, [ending for name, ending in pairs if name.text == child.name])
        for child in children
    )
    return Concurrence(
        **fields,
        children=children,
        default_outcome=default.text,
        default_span=default.span,
        rules=tuple(
            OutcomeRule(
                outcome=outcome.text,
                span=outcome.span,
                when=tuple(
                    Condition(child=child.text, outcome=ending.text, span=child.span)
                    for child, ending in conditions
                ),
            )
            for outcome, conditions in rules
        ),
        join="any" if _word(state, "join").text == "any" else "all",
    )


def _iterator(state: State, fields: dict[str, Any], children: tuple[Node, ...]) -> nodes.Iterator:
    """An iterator with its looping outcomes spelt out (smach-semantics I1, I3)."""
    items, items_key = _items(_tree(state, "it"))
    lists = (_words(state, name) for name in ("loop_outcomes", "break_outcomes"))
    words = [word for words in lists for word in words]
    words += [key for key, _ in _pairs(state, "final_outcome_map")]
    children = tuple(if_asked(child, words) for child in children)
    own = [outcome.name for child in children[:1] for outcome in child.outcomes]
    breaks = [word.text for word in _words(state, "break_outcomes")]
    loops = [word.text for word in _words(state, "loop_outcomes")]
    if breaks:
        loops = [name for name in own if name not in breaks]
    exhausted = _word(state, "exhausted_outcome", "exhausted")
    final = {key.text: to.text for key, to in _pairs(state, "final_outcome_map")}
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
    return nodes.Iterator(
        **fields,
        children=children,
        items=items,
        items_key=items_key,
        item_key=_word(state, "it_label", "it_data").text,
        exhausted_outcome=exhausted.text,
        loop_outcomes=tuple(loops),
        final_map=tuple(final.items()),
    )


def _items(tree: Tree | None) -> tuple[Value | None, str]:
    """What an iterator runs over: a value, or the name of a key of its userdata."""
    if tree is None:
        return None, ""
    value = as_value(tree)
    return (None, value.data) if isinstance(value.data, str) else (value, "")


def presets(state: State) -> tuple[Preset, ...]:
    """The userdata of a container. Of several values for a key the last one counts."""
    found: dict[str, Preset] = {}
    given: dict[str, list[Given]] = {}
    for each in (state, *(child for child in state.states if child.owner == "state")):
        for preset in _own(each):
            found[preset.key] = preset
            given.setdefault(preset.key, []).append(
                Given(each.name, preset.value, preset.span, each is state)
            )
    return tuple(
        replace(preset, given=tuple(given[key])) if len(given[key]) > 1 else preset
        for key, preset in found.items()
    )


def _own(state: State) -> Iterator[Preset]:
    """Userdata in the short form `key: value` or the long one `key: {type: T, value: V}`."""
    entry = state.fields.get("userdata")
    for each in field_shapes.as_map(entry.value, []) if entry is not None else ():
        value, type_ = each.value, ANY
        if isinstance(value, Map) and is_long_form(value):
            inner = {item.key.value: item.value for item in value.entries}
            named = inner.get("type")
            if isinstance(named, Scalar) and isinstance(named.value, str):
                type_ = parse_type(named.value) or ANY
            value = inner["value"]
        yield Preset(key=str(each.key.value), value=as_value(value), type=type_, span=each.key.span)


def catching(node: Node, span: Span) -> Node:
    """The state, with one outcome more for its exceptions. `span` is where the script asks."""
    if node.catches:
        return node
    own, name = outcome_names(node), ERROR
    while name in own:
        name = f"caught_{name}"
    return replace(node, catches=name, outcomes=(*node.outcomes, Outcome(name=name, span=span)))


def if_asked(node: Node, words: Iterable[Word]) -> Node:
    """The state as the script speaks of its outcomes: it catches if `error` is among them and not
    an outcome that it has, or may have, itself."""
    if ERROR in outcome_names(node) or (isinstance(node, Leaf) and node.open):
        return node
    asked = next((word for word in words if word.text == ERROR), None)
    return node if asked is None else catching(node, asked.span)


def with_way_out(node: Node, target: Word) -> Node:
    """A state of a container that has `on_error: target`: its exceptions lead there, unless it is
    the target or says otherwise."""
    if node.name == target.text or is_unread(node):
        return node
    node = catching(node, target.span)
    if any(step.outcome == node.catches for step in node.transitions):
        return node
    step = Transition(
        outcome=node.catches, target=target.text, span=target.span, target_span=target.span
    )
    return replace(node, transitions=(*node.transitions, step))


def with_conditions(leaf: Leaf) -> Leaf:
    """A ConditionalOutcomeState whose outcomes without a condition are told by the key of their
    name, where it is an input: so it was in SMACHA."""
    known = {each.name: each for each in leaf.variables}
    given = known["callbacks"].value.data if "callbacks" in known else Struct(entries=())
    if leaf.open or not isinstance(given, Struct):
        return leaf
    inputs = {key.name for key in leaf.inputs} - {name for name, _ in given.entries}
    told = [each for each in leaf.outcomes if each.name in inputs and each.name.isidentifier()]
    if not told and "callbacks" in known:
        return leaf
    code = [
        (each.name, Expression(text=f"lambda ud: ud.{each.name}", span=each.span)) for each in told
    ]
    span = told[0].span if told else leaf.span
    value = Value(data=Struct(entries=(*given.entries, *code)), span=span)
    made = Variable(name="callbacks", value=value, span=span)
    others = [each for each in leaf.variables if each.name != "callbacks"]
    return replace(leaf, variables=(made, *others))

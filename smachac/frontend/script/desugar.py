"""Desugaring: time limits, retries and loops become containers, as a SMACH user would write them.

A time limit is a concurrence with a timer; retries and `for_each` are iterators. The container has
the state's name, interface and transitions; the state is inside, under the same name. A container
inside another one has the name of its role (`INNER_NAMES`). The container also has the outcome
`preempted`, with which it ends after a request to stop (docs/semantics.md, Preemption).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from smachac.diagnostics.source import Span
from smachac.frontend.resolved_script import (
    EXHAUSTED,
    TIMEOUT,
    TIMER,
    ForEach,
    Retry,
    Sugar,
    Timeout,
)
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Expression,
    Iterator,
    Key,
    Leaf,
    Node,
    Outcome,
    OutcomeRule,
    Remap,
    StateMachine,
    Transition,
    Value,
    Variable,
)
from smachac.ir.outcome_names import GOOD_OUTCOMES, PREEMPTED
from smachac.ir.traversal import OuterNames, outcome_names, remapping
from smachac.ir.types import optional
from smachac.records import replace


def desugared(node: Node, sugar: Sugar) -> Node:
    """A state inside the containers of its sugar: the time limit is for each try, and the number of
    tries is for each item."""
    if sugar.timeout is not None:
        node = _limited(node, sugar.timeout)
    if sugar.retry is not None:
        node = _retried(node, sugar.retry)
    if sugar.for_each is not None:
        node = _repeated(node, sugar.for_each)
    return node


INNER_NAMES = {"timeout": "TIMED", "retry": "TRIES"}
"""The names of containers made of sugar inside another one, by field."""


def _inside(node: Node) -> Node:
    """The state as a child of the container: without the transitions, which the container has. A
    container made of sugar gets the name of its role."""
    name = node.name
    if not isinstance(node, Leaf) and node.sugar:
        name = _fresh(INNER_NAMES[node.sugar], (name,))
    return replace(node, name=name, transitions=(), remaps=(), autonomy=(), doc="")


def _around(node: Node) -> dict[str, Any]:
    """The fields of the container that are those of the state."""
    fields = (
        *("name", "doc", "inputs", "outputs", "transitions", "remaps", "autonomy", "span", "via"),
    )
    return {name: getattr(node, name) for name in fields}


def _fresh(wanted: str, taken: tuple[str, ...]) -> str:
    """A name that is not in `taken`: the wanted one, or that with a number."""
    number, name = 1, wanted
    while name in taken:
        number += 1
        name = f"{wanted}_{number}"
    return name


def _pause(name: str, seconds: Value, node: Node, reads: tuple[Key, ...] = ()) -> Leaf:
    """A timer: a state that waits, beside another state or before it."""
    return Leaf(
        name=name,
        type=TIMER,
        inputs=reads,
        outcomes=tuple(Outcome(name=text, span=node.span) for text in ("succeeded", PREEMPTED)),
        variables=(Variable(name="time", role="duration", value=seconds, span=seconds.span),),
        blocking=True,
        built_in=TIMER,
        adds_frames=(),
        span=node.span,
        via=node.via,
    )


def _with_outcomes(
    outcomes: tuple[Outcome, ...], names: Iterable[str], span: Span
) -> tuple[Outcome, ...]:
    """The outcomes, with those of `names` that are not among them."""
    known = {outcome.name for outcome in outcomes}
    return outcomes + tuple(Outcome(name=name, span=span) for name in names if name not in known)


def _limited(node: Node, limit: Timeout) -> Concurrence:
    """A state with a time limit: a concurrence with a timer, in which the first to end preempts the
    other. A rule for each outcome of the state requires that the timer was preempted; otherwise the
    outcome is `timeout`."""
    timer = _fresh("TIMER", (node.name,))
    own = outcome_names(node)
    rules = tuple(
        OutcomeRule(
            outcome=name,
            when=(
                Condition(child=node.name, outcome=name, span=node.span),
                Condition(child=timer, outcome=PREEMPTED, span=node.span),
            ),
            span=node.span,
        )
        for name in own
    )
    seconds = Value(data=limit.seconds, span=limit.value_span)
    return Concurrence(
        **_around(node),
        type="Concurrence",
        sugar="timeout",
        outcomes=_with_outcomes(node.outcomes, [TIMEOUT, PREEMPTED], limit.span),
        children=(_inside(node), _pause(timer, seconds, node)),
        default_outcome=TIMEOUT,
        default_span=limit.span,
        rules=rules,
        join="any",
    )


def _retried(node: Node, retry: Retry) -> Iterator:
    """A state with retries: an iterator with one item for each try, which continues on the outcomes
    of `on`. With a delay the item is the pause before the try, in seconds."""
    on = tuple(word.text for word in retry.on)
    own = outcome_names(node)
    keys = tuple(key.name for key in (*node.inputs, *node.outputs))
    # The item must not hide a key of the state, which uses the keys of the iterator.
    item = _fresh("pause" if retry.delay else "attempt", keys)
    child = _inside(node)
    items: tuple[float, ...] = tuple(range(1, retry.most + 1))
    if retry.delay and own:
        child = _after_pause(child, node.name, item, on)
        items = (0.0, *(retry.delay,) * (retry.most - 1))
    kept = tuple(outcome for outcome in node.outcomes if outcome.name not in on)
    return Iterator(
        **_around(node),
        type="Iterator",
        sugar="retry",
        outcomes=_with_outcomes(kept, [EXHAUSTED, PREEMPTED], retry.span),
        children=(child,),
        items=Value(data=items, span=retry.span),
        item_key=item,
        exhausted_outcome=EXHAUSTED,
        loop_outcomes=tuple(name for name in own if name in on),
        final_map=tuple((name, PREEMPTED) for name in own if name in on),
    )


def _after_pause(node: Node, state: str, key: str, on: tuple[str, ...]) -> StateMachine:
    """A try of the state `state`: its node after a pause, whose seconds are the userdata `key`."""
    own = outcome_names(node)
    name = _fresh("PAUSE", (node.name,))
    reads = Key(name=key, span=node.span)
    time = Expression(text=f"lambda ud: ud.{key}", span=node.span)
    pause = _pause(name, Value(data=time, span=node.span), node, (reads,))
    # A stopped pause ends the try with an outcome that the state itself has.
    end = next(name for name in (PREEMPTED, *on, *own) if name in own)
    edges = (("succeeded", node.name), (PREEMPTED, end))
    entry = tuple(
        Transition(outcome=outcome, target=target, span=node.span, target_span=node.span)
        for outcome, target in edges
    )
    exits = tuple(
        Transition(outcome=name, target=name, origin="implicit", span=node.span) for name in own
    )
    return StateMachine(
        name=_fresh("TRY", (node.name, state)),
        type="StateMachine",
        sugar="retry",
        outcomes=node.outcomes,
        inputs=(*node.inputs, reads),
        outputs=node.outputs,
        children=(replace(pause, transitions=entry), replace(node, transitions=exits)),
        initial=name,
        initial_span=node.span,
        span=node.span,
        via=node.via,
    )


def _repeated(node: Node, loop: ForEach) -> Iterator:
    """A state with `for_each`: an iterator over its items, which continues on the outcomes of `on`
    (without `on`: on the first success), and ends with the first of them after the last item."""
    own = outcome_names(node)
    good = tuple(name for name in own if name in GOOD_OUTCOMES)[:1]
    on = tuple(word.text for word in loop.on) or good or own[:1]
    items = loop.items
    fields = _around(node)
    remaps = remapping(node)
    item = next((key for key, to in remaps.items() if to == loop.item), loop.item)
    fields["inputs"] = tuple(key for key in node.inputs if key.name != item)
    if not loop.item:  # any of them can be the item
        fields["inputs"] = tuple(replace(key, type=optional(key.type)) for key in node.inputs)
    fields["remaps"] = tuple(remap for remap in node.remaps if remap.key != item)
    kept = tuple(outcome for outcome in node.outcomes if outcome.name not in on[1:])
    exhausted = _fresh(EXHAUSTED, own)
    items_key = ""
    if isinstance(items.data, str):
        items_key = _with_input(fields, items.data, items.span)
    return Iterator(
        **fields,
        type="Iterator",
        sugar="for_each",
        outcomes=_with_outcomes(kept, [PREEMPTED] if loop.preempted else [], loop.span),
        children=(_inside(node),),
        items=None if items_key else items,
        items_key=items_key,
        items_span=items.span,
        item_key=item,
        item_span=loop.item_span,
        exhausted_outcome=exhausted,
        loop_outcomes=on,
        loop_spans=tuple(word.span for word in loop.on),
        final_map=((exhausted, on[0]), *((name, PREEMPTED) for name in on)) if on else (),
    )


def _with_input(fields: dict[str, Any], outer: str, span: Span) -> str:
    """The key by which a container reads the key `outer` of its parent; added to `fields` if the
    container has none."""
    remaps = OuterNames({remap.key: remap.to for remap in fields["remaps"]})
    names: list[str] = [key.name for key in fields["inputs"]]
    for name in names:
        if remaps[name] == outer:
            return name
    name = _fresh(outer, (*names, *remaps))
    fields["inputs"] += (Key(name=name, span=span),)
    if name != outer:
        fields["remaps"] += (Remap(key=name, to=outer, span=span, to_span=span),)
    return name

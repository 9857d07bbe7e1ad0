"""Exceptions as outcomes: the states that end with `error` when something goes wrong in them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from smachac.ir.graph import is_unread
from smachac.ir.nodes import Leaf, Node, Outcome, Transition
from smachac.ir.walk import outcome_names
from smachac.source import Span, Word
from smachac.sugar import ERROR


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

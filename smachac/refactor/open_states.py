"""Inferred interfaces of open states, from their script and template."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from smachac.ir.nodes import Key, Leaf, Outcome, StateMachine, Transition
from smachac.ir.traversal import outcome_names
from smachac.records import dataclass, replace


@dataclass(frozen=True, slots=True, kw_only=True)
class TemplateFacts:
    """Facts about the template of a state type: the keys that its code reads and writes, and
    whether the outcomes of its states are complete."""

    reads: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    outcomes: bool = False


def with_inferred_interfaces(
    parent: StateMachine, facts: Callable[[Leaf], TemplateFacts]
) -> StateMachine:
    """A container whose open states have an inferred interface.

    SMACH lets them end with any outcome of the container as well. Their keys are those of their
    code, their script and their remapping.
    """
    children = tuple(
        _with_inferred_interface(child, parent, facts(child))
        if isinstance(child, Leaf) and child.open
        else child
        for child in parent.children
    )
    return replace(parent, children=children)


def _with_inferred_interface(leaf: Leaf, parent: StateMachine, facts: TemplateFacts) -> Leaf:
    known = set(outcome_names(leaf)) | {step.outcome for step in leaf.transitions}
    more = [] if facts.outcomes else [name for name in outcome_names(parent) if name not in known]
    remapped = [remap.key for remap in leaf.remaps]
    reads = [*facts.reads, *(key for key in remapped if key not in facts.writes)]
    writes = [*facts.writes, *(key for key in remapped if key not in facts.reads)]
    return replace(
        leaf,
        outcomes=(*leaf.outcomes, *(Outcome(name=name, span=leaf.span) for name in more)),
        transitions=(*leaf.transitions, *(_implicit_transition(leaf, name) for name in more)),
        inputs=_keys(leaf, leaf.inputs, reads),
        outputs=_keys(leaf, leaf.outputs, writes),
        open=False,
    )


def _implicit_transition(leaf: Leaf, outcome: str) -> Transition:
    return Transition(
        outcome=outcome, target=outcome, origin="implicit", span=leaf.span, target_span=leaf.span
    )


def _keys(leaf: Leaf, declared: Iterable[Key], names: Iterable[str]) -> tuple[Key, ...]:
    found = {name: Key(name=name, span=leaf.span) for name in names}
    return tuple({**found, **{key.name: key for key in declared}}.values())

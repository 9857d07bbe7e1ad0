"""States without an interface, as far as their scripts and templates tell of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from smachac.ir.nodes import Key, Leaf, Outcome, StateMachine, Transition
from smachac.ir.traversal import outcome_names


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """What the template of a state type tells: the keys that its code reads and writes, and whether
    the outcomes that its states have are all there are."""

    reads: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    outcomes: bool = False


def completed(parent: StateMachine, told: Callable[[Leaf], Told]) -> StateMachine:
    """A container whose states without an interface have all that they may have: SMACH lets them
    leave by any outcome that the container has as well, and their keys are those of their code,
    their script and their remapping."""
    children = tuple(
        _completed(child, parent, told(child)) if isinstance(child, Leaf) and child.open else child
        for child in parent.children
    )
    return replace(parent, children=children)


def _completed(leaf: Leaf, parent: StateMachine, told: Told) -> Leaf:
    known = set(outcome_names(leaf)) | {step.outcome for step in leaf.transitions}
    more = [] if told.outcomes else [name for name in outcome_names(parent) if name not in known]
    remapped = [remap.key for remap in leaf.remaps]
    reads = [*told.reads, *(key for key in remapped if key not in told.writes)]
    writes = [*told.writes, *(key for key in remapped if key not in told.reads)]
    return replace(
        leaf,
        outcomes=(*leaf.outcomes, *(Outcome(name=name, span=leaf.span) for name in more)),
        transitions=(*leaf.transitions, *(_left(leaf, name) for name in more)),
        inputs=_keys(leaf, leaf.inputs, reads),
        outputs=_keys(leaf, leaf.outputs, writes),
        open=False,
    )


def _left(leaf: Leaf, outcome: str) -> Transition:
    return Transition(
        outcome=outcome, target=outcome, origin="implicit", span=leaf.span, target_span=leaf.span
    )


def _keys(leaf: Leaf, declared: Iterable[Key], names: Iterable[str]) -> tuple[Key, ...]:
    found = {name: Key(name=name, span=leaf.span) for name in names}
    return tuple({**found, **{key.name: key for key in declared}}.values())

"""Rules over values that are set: those that are overwritten before a state reads them."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.liveness import DeadStore, dead_stores
from smachac.analysis.uses import place_of
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.wording import listed

MOST_PLACES = 3
"""Limit on the related places of a finding."""


@rule(
    "SM320",
    "dead-store",
    Severity.WARNING,
    effect="another value replaces the first one before a state reads it",
)
def dead_store(context: Context) -> Iterator[Finding]:
    """A state sets a key that every path sets again before a state reads it.

    The result of the state is lost: two states use one key by mistake, or the state that should
    read the first value is missing.

    Exactly: only keys that the script lists in `output_keys` of the state count, not the outputs of
    a state type or sub-script. The end of the container counts as a read, and so does a state with
    an unknown interface. A state that ends with a failure leaves the value as it was. All other
    outputs that the script lists at the state must be lost too, except those of callbacks, which
    are judged one by one.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - FIND_CUP:
              template: ScriptedState
              outcomes: [found]
              output_keys: [pose]
              transitions: {found: FIND_BOX}
          - FIND_BOX:
              template: ScriptedState
              outcomes: [found]
              output_keys: [pose]
              transitions: {found: GRASP}
          - GRASP:
              template: ScriptedState
              outcomes: [held]
              input_keys: [pose]
              transitions: {held: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - FIND_CUP:
              template: ScriptedState
              outcomes: [found]
              output_keys: [cup_pose]
              transitions: {found: FIND_BOX}
          - FIND_BOX:
              template: ScriptedState
              outcomes: [found]
              output_keys: [box_pose]
              transitions: {found: GRASP}
          - GRASP:
              template: ScriptedState
              outcomes: [held]
              input_keys: [cup_pose, box_pose]
              transitions: {held: done}
    """
    found: dict[tuple[str, str], list[DeadStore]] = {}
    for store in dead_stores(context.absorbed_flow, context.of_container):
        found.setdefault((store.path, store.leaf.name), []).append(store)
    for stores in found.values():
        leaf = stores[0].leaf
        own = [key for key in leaf.outputs if key.span.source is leaf.span.source]
        for store in stores:
            if store.key.role == "result" or len(stores) == len(own):
                yield _dead(context, store)


def _dead(context: Context, store: DeadStore) -> Finding:
    leaf, span = store.leaf, place_of(store.leaf, store.key)
    places = [context.spans[f"{store.path}/{name}"] for name in store.again[:MOST_PLACES]]
    other = notation.mapping(leaf, "remapping", [(store.key.name, f"{store.name}_2")])
    related = [place for span in places for place in other_place(span, "it is set again here")]
    return Finding(
        span=span,
        message=f"`{leaf.name}` sets `{store.name}`, but {listed(store.again)} sets it again before"
        " a state reads it",
        arguments=(store.key.name, *sorted(store.again)),
        help=f"write `{other}` at one of the two, for a key of its own, or add a"
        f" state between them that reads `{store.name}`",
        related=(*related, *calls(leaf, span)),
        node=f"{store.path}/{leaf.name}",
    )

"""The rule over the bodies of the simulated world: a name that is given twice."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.robot.simulated_world import is_simulated
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.wording import listed
from smachac.ir.graph import Event
from smachac.ir.leaf import variable
from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import successes

MOST_VISITS = 200_000
"""The most events that the searches of one machine visit; beyond them nothing more is found."""


@rule(
    "SM514",
    "body-loaded-twice",
    Severity.WARNING,
    effect="the state ends with `aborted`: the world keeps the first body and adds no second one",
)
def body_loaded_twice(context: Context) -> Iterator[Finding]:
    """A state loads a body under a name that a body of the simulated world has already.

    The state always ends with `aborted`: the world keeps the first body, and the second is missing.

    Exactly: on every path to the state, a built-in state that loads a model has loaded one with the
    same name before, with success. Without `body`, the name is `model_name`.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {left: [0.5, 0.2, 0.1], right: [0.5, -0.2, 0.1]}
        states:
          - LEFT:
              template: LoadModelState
              model_name: block
              remapping: {pose: left}
              transitions: {succeeded: RIGHT, aborted: failed}
          - RIGHT:
              template: LoadModelState
              model_name: block
              remapping: {pose: right}
              transitions: {succeeded: done, aborted: failed}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {left: [0.5, 0.2, 0.1], right: [0.5, -0.2, 0.1]}
        states:
          - LEFT:
              template: LoadModelState
              model_name: block
              body: left_block
              remapping: {pose: left}
              transitions: {succeeded: RIGHT, aborted: failed}
          - RIGHT:
              template: LoadModelState
              model_name: block
              body: right_block
              remapping: {pose: right}
              transitions: {succeeded: done, aborted: failed}
    """
    loading = dict(_loading(context)) if is_simulated(context) else {}
    if len(set(loading.values())) == len(loading):
        return
    visits = 0
    for path, body in loading.items():
        found = _loaded_before(context, loading, path)
        visits += found.visits
        if visits > MOST_VISITS:
            return
        if found.states:
            nodes = [context.routes.nodes[state] for state in found.states]
            leaf = context.routes.nodes[path]
            names = listed([node.name for node in nodes])
            yield Finding(
                span=leaf.span,
                message=f"`{leaf.name}` always fails: {names} loaded a body `{body}` before it",
                arguments=(leaf.name, body),
                help=f"give this body another name, such as `body: {body}_2`",
                related=(
                    *other_place(nodes[0].span, f"`{body}` is loaded here"),
                    *calls(leaf, leaf.span),
                ),
                node=path,
            )


def _loading(context: Context) -> Iterator[tuple[str, str]]:
    """The built-in states that load a model, each with the name of its body, if that is fixed."""
    for path, node in context.states:
        if isinstance(node, Leaf) and node.built_in and node.adds_frames:
            given = (variable(node, name) for name in node.adds_frames)
            body = next((value for value in given if value), None)
            if isinstance(body, str):
                yield path, body


class _Loaded(NamedTuple):
    """The states that have loaded the body on all paths to a state; none if a path has none."""

    states: tuple[str, ...]
    visits: int


def _loaded_before(context: Context, loading: Mapping[str, str], path: str) -> _Loaded:
    """The search backwards from the entry of a state for states that load the same body."""
    graph, leaves = context.routes.graph, context.routes.nodes
    start: Event = (path, "")
    seen = {start}
    todo = [start]
    found: dict[str, None] = {}
    for event in todo:
        where, outcome = event
        leaf = leaves.get(where)
        same = loading.get(where) == loading[path]
        if same and isinstance(leaf, Leaf) and outcome in successes(leaf):
            found[where] = None
            continue
        before = list(graph.pred[event])
        if not before:
            return _Loaded((), len(seen))
        for item in before:
            if item not in seen:
                seen.add(item)
                todo.append(item)
    return _Loaded(tuple(found), len(seen))

"""Explanation of a name: the states and keys of a script that have it."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import DataFlow
from smachac.diagnostics.diagnostic import Report, did_you_mean
from smachac.diagnostics.wording import listed
from smachac.report.explain_key import (
    KeyExplanation,
    explain_keys,
    key_json,
    key_names,
    key_text,
)
from smachac.report.explain_state import StateExplanation, explain_state, state_json, state_text
from smachac.report.json import json_text
from smachac.report.outline import paragraphs

MOST_NAMED = 20
"""Limit on the listed states or keys of one name."""


class UnclearError(Exception):
    """A name has no meaning, or too many; the message lists candidates."""


def explain_name(context: Context, report: Report, name: str, form: str) -> str:
    """The explanation of the state or key `name`; `form` is `text` or `json`.

    A state is named by its path or the end of it; a key by its name, optionally after the path of
    its container. Raises UnclearError if the name has no meaning, or too many.
    """
    flow = context.flow
    states = _states(context, name)
    exact = [path for path in states if path == name]
    keys = _keys(context, name)
    if not states and not keys:
        raise UnclearError(_unknown(flow, context.written.states, name))
    if len(states) > 1 and not exact:
        raise UnclearError(_several_states(context, name, states, keys))
    if not states and len(keys) > 1 and all(key != name.rpartition("/")[2] for _, key in keys):
        raise UnclearError(_several_keys(context, name, keys))
    found = [explain_state(context, path, report) for path in exact or states]
    explanations = list(explain_keys(context, keys))
    return _json(found, explanations) if form == "json" else _text(found, explanations)


def _states(context: Context, name: str) -> list[str]:
    """The paths in the script of the states of a name: the end of a path in the script, or of one
    in traces, also without its brackets (`LOOK/TIMER`)."""
    view = context.written
    found = [path for path in view.states if _ends(path, name)]
    if not found:
        found = [
            part.state
            for shown, part in view.traced.items()
            if _ends(shown, name) or _ends(f"{part.state}/{shown.rpartition('/')[2]}", name)
        ]
    return list(dict.fromkeys(found))


def _ends(path: str, name: str) -> bool:
    return path == name or path.endswith(f"/{name}")


def _keys(context: Context, name: str) -> list[tuple[str, str]]:
    """The keys of a name: those of containers, else those of states."""
    names, view = key_names(context.flow), context.written
    pairs = names.get(name, [])
    where, _, key = name.rpartition("/")
    if not pairs and where:
        found = names.get(key, [])
        pairs = [pair for pair in found if _ends(view.state(pair[0]), where)]
        pairs = pairs or [pair for pair in found if _ends(pair[0], where)]
        name = key
    return [pair for pair in pairs if pair[1] == name] or pairs


def _unknown(flow: DataFlow, paths: Iterable[str], name: str) -> str:
    states = dict.fromkeys(path.rpartition("/")[2] for path in paths)
    keys = key_names(flow)
    near = did_you_mean(name.rpartition("/")[2], [*states, *keys])
    known = near or f"states: {listed(states)}\nkeys: {listed(keys) or 'none'}"
    return f"there is no state or key `{name}`\n{known}"


def _several_states(
    context: Context, name: str, states: list[str], keys: list[tuple[str, str]]
) -> str:
    lines = [f"there are {len(states)} states `{name}`; give the path of one of them:"]
    named = [f"  {path} ({context.written.states[path].node.span})" for path in states]
    named += [f"  {path} (a key)" for path in _key_paths(context, keys)]
    return "\n".join([*lines, *_few(named)])


def _several_keys(context: Context, name: str, keys: list[tuple[str, str]]) -> str:
    lines = [f"states use the name `{name}` for {len(keys)} keys; give the path of one of them:"]
    return "\n".join([*lines, *_few([f"  {path}" for path in _key_paths(context, keys)])])


def _key_paths(context: Context, keys: list[tuple[str, str]]) -> list[str]:
    return list(dict.fromkeys(f"{context.written.state(path)}/{key}" for path, key in keys))


def _few(lines: list[str]) -> list[str]:
    more = len(lines) - MOST_NAMED
    return lines if more <= 0 else [*lines[:MOST_NAMED], f"  and {more} more"]


def _text(states: list[StateExplanation], keys: list[KeyExplanation]) -> str:
    parts = [state_text(explanation) for explanation in states]
    parts += [key_text(part) for explanation in keys for part in explanation]
    return "\n".join(paragraphs(*part) for part in parts)


def _json(states: list[StateExplanation], keys: list[KeyExplanation]) -> str:
    found = {"states": [*map(state_json, states)], "keys": [*map(key_json, keys)]}
    return json_text(found)

"""Explanation of the properties of a script: each with its verdict, as text or as JSON, and the
scenario of a counterexample."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from smachac.analysis.properties import Judgement, witness
from smachac.diagnostics.diagnostic import did_you_mean
from smachac.interpreter.counterexample import Replay, replay
from smachac.ir.nodes import Machine
from smachac.ir.properties import in_words
from smachac.report.outline import at, way
from smachac.report.terminal import on_one_line


class NoScenarioError(Exception):
    """No failing property has the given name. The message lists the failing properties."""


def render_properties(machine: Machine, found: Sequence[Judgement], form: str) -> str:
    """The properties of a machine; `form` is `text` or `json`."""
    if form == "json":
        data = [_as_data(machine, judgement) for judgement in found]
        return json.dumps({"properties": data}, indent=2, ensure_ascii=False) + "\n"
    lines: list[str] = []
    size = max((len(judgement.verdict) for judgement in found), default=0)
    for judgement in found:
        words = in_words(judgement.property.form)
        name = judgement.property.name
        named = words if name == words else f"{name}: {words}"
        lines.append(f"{judgement.verdict:<{size}}  {named}")
        if judgement.counterexample is not None:
            labels = tuple(step.label for step in witness(judgement.counterexample))
            lines += way(f"{'':<{size}}  ", labels)
    if not found:
        lines.append(f"{machine.root.name} has no properties")
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def _as_data(machine: Machine, each: Judgement) -> dict[str, Any]:
    data: dict[str, Any] = {
        "name": each.property.name,
        "words": in_words(each.property.form),
        "verdict": each.verdict,
        "src": at(each.property.span),
    }
    if each.counterexample is not None:
        shown = _replay(machine, each)
        data["path"] = [step.label for step in witness(each.counterexample)]
        data["scenario"] = shown.text
        data["schedule"] = list(shown.schedule)
    return data


def _replay(machine: Machine, each: Judgement) -> Replay:
    assert each.counterexample is not None
    return replay(machine, each.counterexample.visits, each.counterexample.again)


def render_scenario(machine: Machine, found: Sequence[Judgement], name: str) -> str:
    """The counterexample of the property with a name, or with a number from 1, as a file for
    `smachac run --mock`. Raises NoScenarioError."""
    failing = [judgement for judgement in found if judgement.counterexample is not None]
    chosen = [judgement for judgement in failing if judgement.property.name == name]
    if not chosen and name.isdecimal() and 1 <= int(name) <= len(found):
        chosen = [
            judgement for judgement in found[int(name) - 1 : int(name)] if judgement in failing
        ]
    if not chosen:
        names = [judgement.property.name for judgement in failing]
        near = did_you_mean(name, names)
        known = ", ".join(f"`{name}`" for name in names)
        help = near or (f"these fail: {known}" if known else "all properties hold")
        raise NoScenarioError(f"no property `{name}` fails\n{help}")
    shown = _replay(machine, chosen[0])
    turns = f" --schedule {','.join(shown.schedule)}" if shown.schedule else ""
    lines = [f"# {chosen[0].property.name}: smachac run {machine.source} --mock FILE{turns}"]
    if not shown.followed:
        lines.append("# the run differs from here on where the items of an iterator are others")
    return "".join(f"{on_one_line(line)}\n" for line in lines) + shown.text

"""Keys and outcomes that a state lists although its interface, which is complete, has none of
them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from smachac.diagnostics.diagnostic import Report, did_you_mean
from smachac.diagnostics.source import Word
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import wrong_shape
from smachac.frontend.text.fields import Keys
from smachac.ir.nodes import Key, Outcome, StateType


def _known(type_: StateType, part: str) -> list[str]:
    """The names in a part of an interface, those included that a script may add."""
    declared: dict[str, tuple[Key, ...] | tuple[Outcome, ...]] = {
        "input_keys": type_.input_keys,
        "output_keys": type_.output_keys,
        "outcomes": type_.outcomes,
    }
    optional = {"input_keys": type_.listed_inputs, "output_keys": type_.listed_outputs}
    return [*(item.name for item in declared[part]), *optional.get(part, ())]


def check_interface(read: Mapping[str, Any], type_: StateType, report: Report) -> None:
    """The keys and outcomes that a state lists beyond those of a complete interface."""
    for part in ("input_keys", "output_keys", "outcomes"):
        if part in type_.given or part not in read:
            continue
        known = _known(type_, part)
        if part == "outcomes":
            outcomes: tuple[Outcome, ...] = read[part]
            words = [Word(outcome.name, outcome.span) for outcome in outcomes]
        else:
            keys: Keys = read[part]
            words = [word for word, _ in keys]
        for word in words:
            if word.text not in known:
                what = part.replace("_", " ").removesuffix("s")
                message = f"state type `{type_.name}` has no {what} `{word.text}`"
                help = did_you_mean(word.text, known)
                help = help or (
                    f"use one of its {what}s: {listed(known)}" if known else "remove it"
                )
                arguments = (part, type_.name, word.text)
                effect = f"the interface of `{type_.name}` lists all {what}s: this entry adds none"
                item = wrong_shape(word.span, message, help, arguments=arguments, effect=effect)
                report.append(item)

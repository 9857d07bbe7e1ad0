"""Keys and outcomes that a state lists although its interface, which is complete, has none of
them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from smachac.diagnostics.diagnostic import Report, did_you_mean
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser_of, words_of
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import wrong_shape
from smachac.frontend.text.fields import Keys, Pairs
from smachac.ir.nodes import Key, Outcome, StateType


def _known(type_: StateType, part: str) -> list[str]:
    """The names in a part of an interface, those included that a script may add."""
    declared: dict[str, tuple[Key, ...] | tuple[Outcome, ...]] = {
        "input_keys": type_.input_keys,
        "output_keys": type_.output_keys,
        "outcomes": type_.outcomes,
    }
    optional = {"input_keys": type_.listed_inputs, "output_keys": type_.listed_outputs}
    return [*(each.name for each in declared[part]), *optional.get(part, ())]


def check_interface(read: Mapping[str, Any], type_: StateType, report: Report) -> None:
    """The keys and outcomes that a state lists beyond those of a complete interface."""
    for part in ("input_keys", "output_keys", "outcomes"):
        if part in type_.given or part not in read:
            continue
        known = _known(type_, part)
        if part == "outcomes":
            outcomes: tuple[Outcome, ...] = read[part]
            words = [Word(each.name, each.span) for each in outcomes]
        else:
            keys: Keys = read[part]
            words = [word for word, _ in keys]
        for word in words:
            if word.text not in known:
                what = part.replace("_", " ").removesuffix("s")
                message = f"state type `{type_.name}` has no {what} `{word.text}`"
                help = _meant_remap(word.text, known, read.get("remapping", ())) \
                    if part != "outcomes" else None  # fmt: skip
                help = help or did_you_mean(word.text, known)
                help = help or (
                    f"use one of its {what}s: {listed(known)}" if known else "remove it"
                )
                arguments = (part, type_.name, word.text)
                effect = f"the interface of `{type_.name}` lists all {what}s: this entry adds none"
                item = wrong_shape(word.span, message, help, arguments=arguments, effect=effect)
                report.append(item)


def _meant_remap(name: str, known: Sequence[str], remapping: Pairs) -> str | None:
    """The help for a listed key that the interface does not have, if it is no misspelt one: the
    remapping that gives a key of the state this name."""
    if guesser_of(tuple(known)).sure(name) is not None:
        return None
    for key, to in remapping:
        if to.text == name and key.text in known:
            return f"remove it: the remapping gives `{key.text}` the name `{name}`"
    given = {key.text for key, _ in remapping}
    free = [key for key in known if key not in given]
    near = [key for key in free if words_of(key) & words_of(name)] or free
    if len(near) != 1:
        return None
    entry = f"{near[0]}: {name}"
    where = f"add `{entry}` to the remapping" if given else f"write `remapping: {{{entry}}}`"
    return f"{where} in place of this entry"

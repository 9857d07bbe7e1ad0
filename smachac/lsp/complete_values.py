"""Completion of params and of the values of variables."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from smachac.frontend import schema
from smachac.lsp.complete_flow import success_first
from smachac.lsp.complete_keys import callbacks, item_keys, key_word
from smachac.lsp.place import KEY
from smachac.lsp.word import Completion, Request


def params(here: Request) -> Iterable[Completion]:
    """The params that the sub-script of a call looks up."""
    if here.place.role != KEY or not here.body.text("script"):
        return []
    return [Completion(word=each, kind="param") for each in params_of_call(here)
            if each not in here.place.siblings]  # fmt: skip


def params_of_call(here: Request) -> list[str]:
    """The params that the called sub-script looks up."""
    found = here.facts.sub_script(here.body.text("script"), here.facts.caller)
    text = found[0].text if found is not None else ""
    words = re.findall(r"\[params, *(\w+)\]|\[\[(\w+)\]\]", text)
    return list(dict.fromkeys(one or other for one, other in words))


def choices(here: Request) -> Iterable[Completion]:
    words = schema.FIELD_CHOICES.get(here.place.field, ())
    return [Completion(word=each, kind="value") for each in words]


def robots(here: Request) -> Iterable[Completion]:
    return [Completion(word=each, kind="value") for each in ("panda", "baxter")]


def variable(here: Request) -> Iterable[Completion]:
    """The values of a variable that has few: booleans, names of outcomes and keys, models."""
    type_ = here.facts.type_named(here.facts.called(here.body).template)
    variable = type_.variables.get(here.place.field) if type_ is not None else None
    if here.place.role == KEY and variable is not None and variable.role == "callbacks":
        return callbacks(here)
    if here.place.role == KEY and variable is not None and variable.role == "steps":
        left = [each for each in ("outcome", "set") if each not in here.place.siblings]
        if not here.place.inner:
            return [Completion(word=each, kind="field", text=f"{each}: ") for each in left]
        return [key_word(here, each) for each in here.facts.outputs(here.body)]
    if variable is not None and here.place.inner[-1:] == ("outcome",):
        words = success_first(here.facts.outcomes(here.body))
        return [Completion(word=each, kind="outcome") for each in words]
    if variable is not None and str(variable.type) in ("bool", "bool?"):
        return [Completion(word=each, kind="value") for each in ("true", "false")]
    if variable is not None and variable.role == "limb":
        return [Completion(word=each, kind="value") for each in ("left", "right")]
    if variable is not None and variable.keys:
        return item_keys(here)
    used = Counter(
        each.text(here.place.field)
        for body in here.place.bodies
        for each in body.states
        if each.template == here.body.template
    )
    return [Completion(word=each, kind="value") for each, _ in used.most_common() if each]

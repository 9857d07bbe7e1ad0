"""Completion of keys of the userdata, and of types."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from smachac.frontend.text.fields import PRESET_FIELDS
from smachac.ir.types import ANY, WORDS
from smachac.lsp.place import KEY, VALUE, Body
from smachac.lsp.word import Completion, Request


def key_word(here: Request, name: str) -> Completion:
    """A key of the container around the state, with its type."""
    context = here.view.context
    detail = ""
    if context is not None and here.around is not None:
        root = context.machine.root.name
        path = "/".join([root, *here.place.path[:-1]])
        type_ = context.types.keys.get((path, name), ANY)
        detail = "" if type_ == ANY else str(type_)
    return Completion(word=name, kind="key", detail=detail)


def remapping(here: Request) -> Iterable[Completion]:
    place, facts = here.place, here.facts
    if here.around is None:
        return []
    own = [*facts.inputs(here.body), *facts.outputs(here.body)]
    known = facts.keys_in(here.around)
    if place.role == KEY:
        there = {*known}
        left = [fromkey for fromkey in dict.fromkeys(own) if fromkey not in place.siblings]
        ranked = sorted(left, key=lambda text: text in there and known[text] > 1)
        return [Completion(word=text, kind="key") for text in ranked]
    if not place.inner:
        return []
    wanted, writes = place.inner[0], place.inner[0] in facts.outputs(here.body)
    mine = {*here.body.names("userdata")}
    taken = {*here.body.pairs("remapping").values()}
    cooperating = Counter(
        to
        for state in here.around.states
        if state.start != here.body.start
        for key, to in state.pairs("remapping").items()
        if key == wanted
    )
    before, after = neighbour_keys(here)
    mine_words = {word for name in here.place.path[-1:] for word in name.lower().split("_")}

    def score(name: str) -> float:
        total = 3.0 * (name in mine) + 1.0 * min(cooperating[name], 3)
        total += 2.0 * (wanted in name or name in wanted)
        total += 1.0 * bool({*wanted.split("_")} & {*name.split("_")})
        total += 1.5 * bool(mine_words & {*name.split("_")})
        total -= 2.0 * (name in taken) + 4.0 * (name == wanted and name not in known)
        total += 1.0 * (not known.get(name))
        total += 2.5 * (name in before and not writes)
        total += 2.5 * (name in after and writes)
        return total

    ranked = sorted(dict.fromkeys([*known, wanted]), key=lambda name: -score(name))
    return [key_word(here, text) for text in ranked]


def neighbour_keys(here: Request) -> tuple[set[str], set[str]]:
    """The keys that the state before writes, and those that the state after reads."""
    assert here.around is not None
    states = here.around.states
    at = next((at for at, state in enumerate(states) if state.start == here.body.start), -1)
    before = states[at - 1 : at] if at > 0 else []
    after = states[at + 1 : at + 2] if at >= 0 else []
    wrote = [key for state in before for key in here.facts.outer_keys(state)]
    reads = [key for state in after for key in here.facts.outer_keys(state)]
    return {key for key, writes in wrote if writes}, {key for key, writes in reads if not writes}


def declared_keys(here: Request) -> Iterable[Completion]:
    """The keys that a state may list: those around it, and those that its states use."""
    place = here.place
    if place.role == VALUE and place.inner:
        return types(here)
    known = {*place.siblings}
    found: dict[str, None] = {}
    if here.body.states:
        for child in here.body.states:
            for key, writes in here.facts.outer_keys(child):
                if writes == (place.field == "output_keys"):
                    found.setdefault(key)
        inside = {*here.body.names("userdata")}
        found = {key: None for key in found if key not in inside}
    if place.field == "output_keys" or not here.body.states:
        found |= dict.fromkeys(here.body.names("callbacks"))
    found |= dict.fromkeys(here.body.pairs("remapping"))
    for text in expressions(here.body):
        found = dict.fromkeys(re.findall(r"\bud\.(\w+)", text)) | found
    if here.around is not None:
        scope = here.facts.keys_in(here.around)
        back = {to: key for key, to in here.body.pairs("remapping").items()}
        found |= dict.fromkeys(back.get(key, key) for key in scope)
    return [key_word(here, text) for text in found if text not in known]


def userdata(here: Request) -> Iterable[Completion]:
    """The keys that something reads and nothing presets; or the parts of the long form."""
    place = here.place
    if place.role == VALUE and place.inner[1:] == ("type",):
        return types(here)
    if place.role == KEY and place.inner:
        left = [field for field in PRESET_FIELDS if field not in place.siblings]
        return [Completion(word=text, kind="field", text=f"{text}: ") for text in left]
    if place.role != KEY:
        return []
    if here.body.states:
        uses = [key for child in here.body.states for key in here.facts.outer_keys(child)]
    else:
        uses = [(to, False) for to in here.body.pairs("remapping").values()]
        uses += [(key, False) for key in here.facts.inputs(here.body)]
    written = {key for key, writes in uses if writes}
    read = [key for key, writes in uses if not writes]
    ranked = sorted(dict.fromkeys(read), key=lambda key: key in written)
    return [Completion(word=text, kind="key") for text in ranked if text not in place.siblings]


def item_keys(here: Request) -> Iterable[Completion]:
    scope = here.facts.keys_in(here.around) if here.around is not None else {}
    own = here.body.names("input_keys")
    return [key_word(here, fromkey) for fromkey in dict.fromkeys([*own, *scope])]


def label_keys(here: Request) -> Iterable[Completion]:
    used = [key for child in here.body.states for key, writes in here.facts.outer_keys(child)
            if not writes and key not in here.body.names("input_keys")]  # fmt: skip
    return [key_word(here, fromkey) for fromkey in dict.fromkeys(used)]


def for_each(here: Request) -> Iterable[Completion]:
    place = here.place
    if place.role == KEY:
        left = [name for name in ("item", "in", "on") if name not in place.siblings]
        return [Completion(word=text, kind="field", text=f"{text}: ") for text in left]
    if place.inner[:1] == ("item",):
        return [key_word(here, input_) for input_ in here.facts.inputs(here.body)]
    if place.inner[:1] == ("in",) and here.around is not None:
        return [key_word(here, key) for key in here.facts.keys_in(here.around)]
    if place.inner[:1] == ("on",):
        return [Completion(word=outcome, kind="outcome")
                for outcome in here.facts.outcomes(here.body)]  # fmt: skip
    return []


def callbacks(here: Request) -> Iterable[Completion]:
    if here.place.role != KEY:
        return []
    words = [*here.body.names("output_keys"), *here.body.names("outcomes")]
    return [Completion(word=word, kind="key") for word in words
            if word not in here.place.siblings]  # fmt: skip


def types(here: Request) -> Iterable[Completion]:
    own = [name for body in here.place.bodies[:1] for name in body.names("types")]
    named = dict.fromkeys([*own, *here.facts.library.types])
    return [Completion(word=word, kind="type") for word in [*named, *WORDS]]


def expressions(body: Body) -> Iterable[str]:
    """The texts of code in the fields of a state."""
    for name in ("callbacks",):
        entry = body.fields.get(name)
        if entry is not None:
            yield entry.value.span.text

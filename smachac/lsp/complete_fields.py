"""Completion of fields and variables: required ones first, then those that are likely."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from smachac.frontend import schema
from smachac.ir.nodes import StateType, VariableType
from smachac.ir.types import ANY
from smachac.lsp.complete_values import params_of_call
from smachac.lsp.place import Body
from smachac.lsp.word import Completion, Request


def fields(here: Request) -> Iterable[Completion]:
    """The fields and variables that the state does not have yet, required ones first."""
    present = {*here.place.siblings}
    calls = "script" in present
    body = here.body
    type_ = here.facts.type_named(body.template)
    variables = dict(type_.variables) if type_ is not None else {}
    known = [*schema.names_for(body.owner)]
    known += ["script"] if body.name is not None else []
    needed = [] if calls else [*schema.REQUIRED[body.owner]]
    if body.name is not None and not calls:
        needed.insert(0, "template")
        needed.insert(1, "script") if "transitions" in present else needed.append("script")
    needed += [name for name, each in variables.items() if each.required]
    order = dict.fromkeys([*needed, *likely(here, type_), *variables, *usual_order(known)])
    for name in order:
        other = {"template": "script", "script": "template"}.get(name, "")
        if name not in present and other not in present:
            yield field_word(here, name, variables.get(name))


def likely(here: Request, type_: StateType | None) -> Iterable[str]:
    """The optional fields that the state probably needs."""
    body, around = here.body, here.around
    if type_ is not None and body.name is not None:
        given = [each for each in ("outcomes", "input_keys", "output_keys")
                 if each in type_.given]  # fmt: skip
        code = [name for name, each in type_.variables.items() if each.role == "callbacks"]
        used = used_fields(here)
        if "outcomes" in given and not any(each.name not in type_.optional
                                           for each in type_.outcomes):  # fmt: skip
            yield "outcomes"
        if "callbacks" in body.fields and given:
            yield from (each for each in given if each != "outcomes")
        yield from [each for each in given if used[each]]
        yield from [each for each in code if used[each]]
    if body.owner == "Concurrence":
        yield from ("default_outcome", "outcome_map")
    if body.owner == "Iterator":
        yield from ("outcomes", "input_keys", "it_label", "exhausted_outcome", "loop_outcomes")
    if body.states:
        inside = {*body.names("userdata"), *body.names("input_keys")}
        written: set[str] = set()
        for child in body.states:
            uses = list(here.facts.outer_keys(child))
            if any(not writes and key not in inside | written for key, writes in uses):
                yield "userdata" if around is None else "input_keys"
                break
            written |= {key for key, writes in uses if writes}
    if around is not None:
        yield from likely_of_state(here, around)


def likely_of_state(here: Request, around: Body) -> Iterable[str]:
    body = here.body
    scope = here.facts.keys_in(around)
    own = [*here.facts.inputs(body), *here.facts.outputs(body)]
    renamed = body.pairs("remapping")
    if "script" in body.fields and params_of_call(here):
        yield "params"
    if any(key not in (*around.names("userdata"), *around.names("input_keys"))
           for key in own if key not in renamed) and scope:  # fmt: skip
        yield "remapping"
    if any(to not in scope for to in renamed.values()):
        yield "userdata"
    if around.owner not in ("Concurrence", "Iterator"):
        yield "transitions"
    used = used_fields(here)
    yield from [name for name, _ in used.most_common()]


def used_fields(here: Request) -> Counter[str]:
    """The fields of the other states of the same type in the text, by number of uses."""
    found: Counter[str] = Counter()
    todo = list(here.place.bodies[:1])
    while todo:
        each = todo.pop()
        todo += each.states
        if each.start != here.body.start and each.template == here.body.template:
            found.update([*each.fields])
    return found


def field_word(here: Request, name: str, variable: VariableType | None) -> Completion:
    if variable is not None:
        type_ = "" if variable.type == ANY else str(variable.type)
        return Completion(word=name, kind="field", detail=type_, doc=variable.doc,
                          text=f"{name}: ")  # fmt: skip
    doc = schema.FIELD_DOCS.get(name, "")
    return Completion(word=name, kind="field", doc=doc, text=f"{name}: ")


def usual_order(names: Iterable[str]) -> list[str]:
    """Fields in the order of the formatter, less usual ones last."""
    first = ("doc", "outcomes", "input_keys", "output_keys", "params", "userdata", "remapping",
             "transitions", "states")  # fmt: skip
    known = list(dict.fromkeys(names))
    return [*(name for name in first if name in known), *(n for n in known if n not in first)]

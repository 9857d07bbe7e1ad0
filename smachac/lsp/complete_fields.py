"""Completion of fields and variables: required ones first, then those that are likely."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from smachac.frontend import schema
from smachac.frontend.schema import CONTAINERS
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree
from smachac.ir.nodes import StateType, VariableType
from smachac.ir.types import ANY, Type
from smachac.lsp.complete_values import params_of_call
from smachac.lsp.place import Body
from smachac.lsp.repair import ENDING
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
    needed += [name for name, variable in variables.items() if variable.required]
    if body.name is None:
        needed.insert(1, "template")
    words = [*needed, *likely(here, type_), *variables, *usual_order(known)]
    order = {name: None for name in words if name in variables or name in schema.VARIABLES}
    value = _value_behind(here)
    for name in sorted(order, key=lambda name: not _fits(here, name, variables.get(name), value)):
        other = {"template": "script", "script": "template"}.get(name, "")
        if name not in present and other not in present:
            yield field_word(here, name, variables.get(name))


def _value_behind(here: Request) -> Tree | None:
    """The value that stands behind the word already, where only the name of a field is typed."""
    entry = here.body.fields.get(str(here.place.word.value))
    value = entry.value if entry is not None else None
    if isinstance(value, Scalar) and (value.value is None or value.value == ENDING):
        return None
    return value


def _fits(here: Request, name: str, variable: VariableType | None, value: Tree | None) -> bool:
    """Whether a value has the shape of a field."""
    if value is None:
        return True
    if variable is not None:
        return _is_look_up(value) or _has_type(value, variable.type)
    if name in ("template", "script") and isinstance(value, Scalar):
        library = here.facts.library
        scripts = library.script_names(here.facts.caller)
        known = scripts if name == "script" else [*library.template_names(), *CONTAINERS]
        return str(value.value) in known
    kinds = SHAPES.get(schema.VARIABLES[name].shape, (Scalar, Seq, Map))
    return Scalar in kinds if _is_look_up(value) else isinstance(value, kinds)


def _is_look_up(value: Tree) -> bool:
    """Whether a value looks a param up: `[params, x]` or `[[x]]`."""
    if not isinstance(value, Seq) or not value.items:
        return False
    first = value.items[0]
    return isinstance(first, Seq) or (isinstance(first, Scalar) and first.value == "params")


SHAPES: Mapping[str, tuple[type, ...]] = {
    **dict.fromkeys(("name", "text", "flag"), (Scalar,)),
    **dict.fromkeys(("map", "userdata", "pairs", "rules"), (Map,)),
    **dict.fromkeys(("keys", "outcomes"), (Seq, Map)),
    "names": (Seq,),
}
"""The kinds of YAML values of fields, by shape; other shapes have all kinds."""


def _has_type(value: Tree, type_: Type) -> bool:
    """Whether a value may have a type, as far as its kind of YAML value shows it."""
    if type_.name == "optional" and isinstance(type_.args[0], Type):
        return _has_type(value, type_.args[0])
    data = value.value if isinstance(value, Scalar) else None
    match type_.name:
        case "bool":
            return isinstance(data, bool)
        case "int" | "float":
            return isinstance(data, (int, float)) and not isinstance(data, bool)
        case "str":
            return isinstance(data, str)
        case "one_of":
            return data in type_.args
        case "list" | "array":
            return isinstance(value, Seq)
        case "dict" | "record":
            return isinstance(value, Map)
    return True


def likely(here: Request, type_: StateType | None) -> Iterable[str]:
    """The optional fields that the state probably needs."""
    body, around = here.body, here.around
    if type_ is not None and body.name is not None:
        given = [name for name in ("outcomes", "input_keys", "output_keys")
                 if name in type_.given]  # fmt: skip
        code = [name for name, variable in type_.variables.items() if variable.role == "callbacks"]
        used = used_fields(here)
        if "outcomes" in given and not any(outcome.name not in type_.optional
                                           for outcome in type_.outcomes):  # fmt: skip
            yield "outcomes"
        if "callbacks" in body.fields and given:
            yield from (text for text in given if text != "outcomes")
        yield from [text for text in given if used[text]]
        yield from [text for text in code if used[text]]
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

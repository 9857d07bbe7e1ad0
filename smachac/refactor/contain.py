"""States that are put into a container of their own: how that is written."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from smachac.ir.nodes import Node
from smachac.ir.walk import leads_to_child
from smachac.refactor.concrete import Atom, Group, Item
from smachac.refactor.containing import Plan
from smachac.refactor.order import variables_of
from smachac.refactor.sheet import Place, Sheet, pairs, put, variable, word
from smachac.source import Source


def presets_of(sheet: Sheet, inside: Sequence[Node]) -> set[str]:
    """The keys of the userdata that comes with states that are no containers."""
    found: set[str] = set()
    for child in inside:
        body = variables_of(sheet.state(child.span).item)
        item = variable(body, "userdata") if body is not None else None
        if body is None or item is None or variable(body, "states") is not None:
            continue
        if isinstance(item.value, Group):
            found |= {each.key.text.strip("'\"") for each in item.value.items if each.key}
    return found


def contain(sheets: Callable[[Source], Sheet], made: Plan) -> None:
    """Write a plan into the text that holds the states. Raises RefusedError."""
    sheet = sheets(made.inside[0].span.source)
    places = [sheet.state(child.span) for child in made.inside]
    names = frozenset(child.name for child in made.parent.children)
    for child, place in zip(made.inside, places, strict=True):
        if made.kind == "Concurrence":
            _without_transitions(place.item)
        else:
            _lead_out(sheet, child, place, names, made)
    mine = {child.name for child in made.inside}
    for child in made.parent.children:
        for step in child.transitions if child.name not in mine else ():
            if leads_to_child(step, names) and step.target in mine:
                sheets(step.target_span.source).spell(step.target_span, made.name)
    initial = made.parent.initial_span
    written = made.parent.initial in mine and initial.start != made.parent.span.start
    if written and initial.text.strip("'\"") == made.parent.initial:
        sheets(initial.source).spell(initial, made.name)
    sheet.write_anew(places[0], [_written(made, [place.item for place in places])])
    for place in places[1:]:
        sheet.write_anew(place, [])


def _lead_out(sheet: Sheet, child: Node, place: Place, names: frozenset[str], made: Plan) -> None:
    """Let a state's edges lead to outcomes of the container, where they led out."""
    body = variables_of(place.item)
    assert body is not None
    item = variable(body, "transitions")
    group = item.value if item is not None and isinstance(item.value, Group) else None
    own = {each.key.text.strip("'\""): each for each in group.items if each.key} if group else {}
    for step in child.transitions:
        target = made.ends.get((child.name, step.outcome), step.target)
        here = own.get(step.outcome)
        if here is None:
            by_name = target == step.outcome and not leads_to_child(step, names)
            if not (by_name and step.origin == "implicit"):
                put(body, "transitions", step.outcome, target)
        elif isinstance(here.value, Atom) and here.value.text.strip("'\"") != target:
            here.value = Atom(target, -1, -1)
            if group is not None:
                group.flat = ""


def _without_transitions(item: Item) -> None:
    """Take the transitions of a state away: in a concurrence they mean nothing. Comments stay."""
    body = variables_of(item)
    found = variable(body, "transitions") if body is not None else None
    if body is None or found is None:
        return
    body.items = [each for each in body.items if each is not found]
    item.lead += [*found.lead, found.aside.strip()] if found.aside else found.lead
    if isinstance(found.value, Group):
        for each in found.value.items:
            item.lead += [line for line in (*each.lead, each.aside.strip()) if line]
        item.lead += found.value.tail


def _written(made: Plan, items: list[Item]) -> Item:
    """The container with its states."""

    def listed(names: Sequence[str]) -> Group:
        return Group(False, True, -1, items=[Item(None, word(name)) for name in names])

    rows: list[tuple[str, Group | Atom]] = [
        ("template", word(made.kind)),
        ("outcomes", listed(list(made.exits))),
    ]
    rows += [("input_keys", listed(made.inputs))] if made.inputs else []
    rows += [("output_keys", listed(made.outputs))] if made.outputs else []
    if made.kind == "Concurrence":
        rows.append(("default_outcome", word(made.default)))
        rules = [Item(word(end), pairs(rule.items())) for end, rule in made.rules.items()]
        rows += [("outcome_map", Group(True, False, -1, items=rules))] if rules else []
    rows.append(("transitions", pairs((end, place) for end, (place, _) in made.exits.items())))
    if made.kind != "Concurrence" and made.entry != made.inside[0].name:
        rows.append(("initial", word(made.entry)))
    lead = items[0].lead
    blank = bool(lead) and not lead[0]
    for item in items[:1]:
        item.lead = lead[1:] if blank else lead
    rows.append(("states", Group(False, False, -1, items=items)))
    body = Group(True, False, -1, items=[Item(word(name), value) for name, value in rows])
    named = Group(True, False, -1, items=[Item(word(made.name), body)])
    return Item(None, named, lead=[""] if blank else [])

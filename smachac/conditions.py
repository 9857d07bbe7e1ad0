"""Outcomes that keys of the userdata tell, as SMACHA had them."""

from __future__ import annotations

from dataclasses import replace

from smachac.ir.nodes import Expression, Leaf, Struct, Value, Variable


def with_conditions(leaf: Leaf) -> Leaf:
    """A ConditionalOutcomeState whose outcomes without a condition are told by the key of their
    name, where it is an input: so it was in SMACHA."""
    known = {each.name: each for each in leaf.variables}
    given = known["callbacks"].value.data if "callbacks" in known else Struct(entries=())
    if leaf.open or not isinstance(given, Struct):
        return leaf
    inputs = {key.name for key in leaf.inputs} - {name for name, _ in given.entries}
    told = [each for each in leaf.outcomes if each.name in inputs and each.name.isidentifier()]
    if not told and "callbacks" in known:
        return leaf
    code = [
        (each.name, Expression(text=f"lambda ud: ud.{each.name}", span=each.span)) for each in told
    ]
    span = told[0].span if told else leaf.span
    value = Value(data=Struct(entries=(*given.entries, *code)), span=span)
    made = Variable(name="callbacks", value=value, span=span)
    others = [each for each in leaf.variables if each.name != "callbacks"]
    return replace(leaf, variables=(made, *others))

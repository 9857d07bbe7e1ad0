"""The rule on types: a value must fit the type with which it is read (see type_lattice.py)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.data_types import type_of_data
from smachac.analysis.type_inference import Cell, Clash
from smachac.analysis.type_lattice import misfit, present, widened
from smachac.checks.findings.edits import likely
from smachac.checks.findings.help_text import calls, did_you_mean, other_place
from smachac.checks.findings.type_origins import cell_owner, written
from smachac.checks.findings.type_words import in_words
from smachac.checks.findings.value_places import place_of_part
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Expression, Leaf, StateType, Struct
from smachac.ir.traversal import outcome_names


@rule(
    "SM304",
    "type-mismatch",
    Severity.ERROR,
    effect="the state that reads the value fails, or uses it with a wrong meaning",
)
def type_mismatch(context: Context) -> Iterator[Finding]:
    """A value does not fit the type with which it is read.

    The state that reads it fails in the middle of the task, or uses the value with a wrong meaning.

    Exactly: types come from interfaces, from the script, from literals and from the results of
    functions, and are followed through remappings and containers. Literals, lists and dictionaries
    that the Python class of a state type writes to an output key are checked against its interface,
    and the steps of a ScriptedState against the fields of a step. The default of a variable in an
    interface must fit its type. An `int` fits a `float`, a `T` fits a `T?`, an enumeration fits one
    with more choices, and `any` fits every type.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK:
              template: ScriptedState
              output_keys: {found: str}
              remapping: {found: part}
              outcomes: [done]
              transitions: {done: PICK}
          - PICK:
              template: ScriptedState
              input_keys: {part: Pose}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK:
              template: ScriptedState
              output_keys: {found: Pose}
              remapping: {found: part}
              outcomes: [done]
              transitions: {done: PICK}
          - PICK:
              template: ScriptedState
              input_keys: {part: Pose}
              outcomes: [done]
              transitions: {done: done}
    """
    clashes = [clash for clash in context.clashes["type"] if not _is_function(clash)]
    if clashes:
        from smachac.checks.findings.clash_findings import clash_findings

        yield from clash_findings(clashes, context.machine.aliases)
    yield from _lists_for_items(context)
    yield from _without_items(context)
    yield from _wrong_steps(context)
    if context.leaves_with_class:
        from smachac.checks.findings.class_value_types import wrong_loops, wrong_writes

        yield from wrong_writes(context)
        yield from wrong_loops(context)
    for type_ in context.machine.state_types.values():
        yield from _wrong_defaults(type_)


def _lists_for_items(context: Context) -> Iterator[Finding]:
    """The states in a loop that read its list where they need its item."""
    seen: set[tuple[str, str]] = set()
    containers = dict(context.containers) if context.item_reads else {}
    for read in context.item_reads:
        around = containers.get(read.path.rpartition("/")[0])
        if isinstance(around, nodes.Iterator) and not around.sugar:
            continue  # SM004: the state of an Iterator has no remapping
        if (read.path, read.key) in seen:
            continue
        seen.add((read.path, read.key))
        help = f"write `{read.key}: {read.item}`"
        for name in read.lacking:
            help += f", and add `{read.item}` to the `input_keys` of `{name}`"
        cell = read.clash.cell
        yield Finding(
            span=read.span,
            message=f"`{read.node.name}` reads the list `{read.items}` as `{read.key}`, but the"
            f" loop gives its item under `{read.item}`",
            arguments=(read.key, read.items, "item"),
            help=help,
            effect=f"`{cell_owner(cell)[1:-1]}` gets the whole list in place of {named_item(cell)}",
            related=calls(read.node, read.span),
            node=read.path,
            repairs=likely([Edit(span=read.span, text=read.item)], "read the item")
            if read.span.text == read.items and not read.lacking
            else (),
        )


def named_item(cell: Cell) -> str:
    """The value that a reader needs, in words."""
    return f"one `{widened(cell.declared)}`"


def _without_items(context: Context) -> Iterator[Finding]:
    """The loops over a key whose value is a number, which has no items."""
    for path, container in context.containers:
        if not isinstance(container, nodes.Iterator) or not container.items_key:
            continue
        from smachac.analysis.expression_errors import kinds

        key = container.items_key
        cell = context.types.cells.get((path, key))
        if cell is None or kinds(cell.holds or cell.declared) != {"number"}:
            continue
        origins = {alike[0].origin: None for alike in cell.flows.values()}
        type_ = cell.holds or cell.declared
        lists = [
            name
            for name in (input_.name for input_ in container.inputs)
            if (other := context.types.cells.get((path, name))) is not None
            and kinds(other.holds or other.declared) == {"list"}
        ]
        yield Finding(
            span=container.items_span,
            message=f"`{container.name}` needs a list of items in `{key}`, but `{key}` is"
            f" {in_words(type_)}",
            arguments=(key, str(widened(type_)), "list"),
            help=f"did you mean `{lists[0]}`, the only list here?"
            if len(lists) == 1
            else f"write a list for `{key}`, such as `[1, 2, 3]`",
            related=(
                *(
                    place
                    for origin in origins
                    for place in other_place(origin.span, written(origin))
                ),
                *calls(container, container.items_span),
            ),
            node=path,
        )


STEP = ("outcome", "set")
"""The fields of a step."""


def _wrong_steps(context: Context) -> Iterator[Finding]:
    """The steps of ScriptedStates that are no list of mappings with the fields of a step."""
    for path, leaf in context.leaves_with_variables:
        held = variable_of(leaf, "steps")
        if held is None or isinstance(held.value.data, Expression):
            continue
        whole, data = held.value.span, held.value.data
        shown = f"`{held.name}` of `{leaf.name}`"
        one = "write each step as a mapping: `- {outcome: NAME, set: {KEY: VALUE}}`"
        faults: list[tuple[Span, str, str, str]] = []
        if not isinstance(data, tuple):
            faults = [(whole, f"{shown} must be a list of steps", one, "")]
            if isinstance(data, Struct) and "\n" not in whole.text:
                faults = [
                    (whole, f"{shown} must be a list of steps", f"write `[{whole.text}]`", "")
                ]
        for at, step in enumerate(data if isinstance(data, tuple) else ()):
            if isinstance(step, Struct):
                for name, value in step.entries:
                    if name in STEP:
                        continue
                    place = place_of_part(whole, (at, name), key=True)
                    help = did_you_mean(guesser(STEP)(name)) or f"its fields are {listed(STEP)}"
                    if value in STEP:
                        help = f"write `{value}: {name}`: the name of the field comes first"
                    faults.append(
                        (place, f"a step of `{leaf.name}` has no field `{name}`", help, name)
                    )
            elif not isinstance(step, Expression):
                place = place_of_part(whole, (at,))
                known = isinstance(step, str) and step in outcome_names(leaf)
                help = f"write `{{outcome: {step}}}`" if known else one
                faults.append(
                    (place, f"step {at + 1} of `{leaf.name}` is not a mapping", help, str(at))
                )
        for span, message, help, name in faults:
            yield Finding(
                span=span,
                message=message,
                arguments=(held.name, name, "step"),
                help=help,
                related=calls(leaf, span),
                node=path,
            )


def _is_function(clash: Clash) -> bool:
    """Whether a value is the text of a function where one is allowed, which is SM316."""
    value, node = clash.flow.value, clash.cell.node
    if clash.cell.role != "variable" or not isinstance(node, Leaf) or not isinstance(value, str):
        return False
    roles = {variable.role for variable in node.variables if variable.name == clash.cell.key}
    return value.lstrip().startswith("lambda") and not roles.isdisjoint(("duration", "function"))


def _wrong_defaults(type_: StateType) -> Iterator[Finding]:
    """The defaults of an interface that do not fit their own types."""
    for held in type_.variables.values():
        data = held.default.data if held.default is not None else None
        found = misfit(type_of_data(data), held.type) if data is not None else None
        if held.default is None or found is None:
            continue
        help = f"write a default that fits `{held.type}`, or correct the type"
        if found.given.name == "literal" and present(found.wanted).name in ("int", "float"):
            from smachac.checks.findings.number_help import suggested_number

            help = suggested_number(str(found.given.args[0]), present(found.wanted)) or help
        if isinstance(data, str) and data.lower() in ("none", "nil"):
            help = f"write `null` for no value: `{data}` is a text"
        yield Finding(
            span=held.default.span,
            message=f"the default of `{held.name}` is {in_words(type_of_data(data))}, but its type"
            f" is `{held.type}`",
            arguments=(held.name, str(widened(found.given)), str(found.wanted)),
            help=help,
        )

"""Rules over messages of ROS: the fields that states set and read, and their definitions."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple, TypeAlias

from smachac.analysis.code_slots import code_slots
from smachac.analysis.context import Context
from smachac.analysis.message_code import MOST_CODE, leaf_definitions, message_code, nested_messages
from smachac.analysis.message_keys import (
    TYPE_KEY,
    lacks_type_key,
    remapped_field,
    suggested_type_key,
)
from smachac.analysis.type_inference import TypeFlow
from smachac.analysis.type_lattice import fits, present
from smachac.checks.findings.edits import likely, listing, with_input, with_remapping
from smachac.checks.findings.help_text import calls, did_you_mean
from smachac.checks.findings.literals import literal_finding
from smachac.checks.findings.value_places import Part, place_of_part
from smachac.checks.ros.message_calls import CHECK_FIELDS, call_faults, message_calls
from smachac.checks.ros.message_reads import (
    code_places,
    described,
    field_finding,
    near_field,
    operands_of,
    unknown_field_finding,
    wrong_comparisons,
    wrong_operands,
    wrong_reads,
)
from smachac.checks.ros.message_types import (
    call_of,
    missing_types,
    names_type,
    no_type,
    suggested_type,
    type_in_place_of_part,
    word_in,
)
from smachac.checks.ros.message_values import (
    ValueFault,
    in_field_order,
    is_time,
    value_faults,
    value_help,
    with_levels,
)
from smachac.checks.ros.messages_in_classes import faults_in_classes
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.leaf import given_fields, key_names, type_text, variable, variable_of
from smachac.ir.message_types import (
    FLOATS,
    INTEGERS,
    PARTS,
    DefinitionKind,
    Definitions,
    Message,
    MissingDefinitions,
    userdata_type,
)
from smachac.ir.nodes import DEFINITION_KINDS, Data, Expression, Leaf, Node, Struct, Value, Variable
from smachac.ir.traversal import remapping
from smachac.ir.types import Type
from smachac.records import replace

NO_MESSAGE = frozenset(["stop", "stop_all", "remove", "remove_all"])
"""The values of the variable `action` with which a state reads no message."""

NUMBERS = frozenset([*INTEGERS, *FLOATS, "bool"])
"""The types of fields that are numbers in Python."""

SCALARS = frozenset(["bool", "int", "float", "str", "literal", "one_of"])


_SHORT_VALUE = re.compile(r"""['"]?\s*:\s*('[^'\n]*'|"[^"\n]*"|\[[^\[\]\n]*\]|[^\s,\[\]{}#]+)""")
"""A text in quotes, a list or a word after the name of a field."""


class _Use(NamedTuple):
    """A name that a state uses as a field; `key`: the field has the value of the key of that
    name, or gives it one."""

    word: Word
    key: bool


@rule(
    "SM512",
    "unknown-field",
    Severity.ERROR,
    effect="the state fails when it uses the field",
)
def unknown_field(context: Context) -> Iterator[Finding]:
    """A state uses a field or type of a message that does not exist, or a value of another type.

    The state fails when it runs: the goal or the request is never sent, or its function stops at
    the name.

    Exactly: fields in lists of keys, in mappings and lists of values, in calls of the classes of
    messages (`Bool(data=True)`, `std_msgs.msg.Bool(data=True)`), in functions that receive the
    message, and in mappings that are published or copied to a field of a goal or a request, at any
    depth; also numbers that a function compares with text. A value fits if it is in the range of
    its type, and a text or a list is not longer than its type allows (`string<=8`, `int32[<=4]`).
    The definitions of messages, services and actions (`.msg`, `.srv`, `.action`) are searched in
    packages in the folders of `code` in the project file, in the folder of the script and in those
    above it up to the root of the repository, in AMENT_PREFIX_PATH, in ROS_PACKAGE_PATH and beside
    the Python that runs smachac. The types of common packages, such as std_msgs, std_srvs,
    geometry_msgs, sensor_msgs, nav_msgs and trajectory_msgs, are known without their files. Without
    a definition, nothing is checked; but a type is reported if its package has other types of its
    kind, or its name is that of another kind. Where several are found, such as those of ROS 1 and
    ROS 2, a finding holds for all of them. In the classes of state types, imports of messages are
    checked, and the fields of new messages and of the arguments of callbacks. A function that
    calculates with a whole message, or compares it with a number or a text, is also found.

    Wrong:
        name: sm
        template: ROSBase
        outcomes: [done, failed]
        userdata: {force: 5.0}
        states:
          - GRASP:
              template: ServiceState
              service_namespace: gripper
              service: cell_msgs/Grasp
              request_slots: [force]
              input_keys: [force]
              transitions: {succeeded: done, aborted: failed, preempted: failed}
        == cell_msgs/srv/Grasp.srv ==
        float64 max_force
        ---
        bool held

    Right:
        name: sm
        template: ROSBase
        outcomes: [done, failed]
        userdata: {max_force: 5.0}
        states:
          - GRASP:
              template: ServiceState
              service_namespace: gripper
              service: cell_msgs/Grasp
              request_slots: [max_force]
              input_keys: [max_force]
              transitions: {succeeded: done, aborted: failed, preempted: failed}
        == cell_msgs/srv/Grasp.srv ==
        float64 max_force
        ---
        bool held
    """
    found, missing = context.machine.definitions, context.machine.missing_definitions
    for path, node in context.leaves_with_variables:
        if names_type(node):
            yield from missing_types(path, node, missing)
            yield from type_in_place_of_part(path, node)
        yield from _wrong_messages(context, path, node, found, missing)
        if not found:
            continue
        for kind, definitions in leaf_definitions(node, found):
            for held in node.variables:
                if held.role in PARTS[kind]:
                    messages = [definition.part(held.role) for definition in definitions]
                    other = _other_type(context, node, kind, held.role)
                    yield from _faults(context, path, node, held, messages, other)
                    yield from _wrong_values(path, node, held, messages, found, other)
                    yield from _wrong_arguments(path, node, held.value, messages, found)
                    yield from _wrong_slots(context, path, held, messages, found)
        for slot in code_slots(node, context.machine.state_types):
            yield from _wrong_calls(path, node, slot.code, found)
            code = message_code(slot, node, found, context.machine.functions)
            if code is not None:
                here = code_places(node, slot, code)
                yield from wrong_reads(path, node, code, found, here)
                yield from wrong_comparisons(path, node, code, found, here)
                yield from wrong_operands(path, node, operands_of(slot, code), code, found, here)
    for path, container in context.containers if found else ():
        for preset in container.userdata:
            if isinstance(preset.value.data, Expression):
                yield from _wrong_calls(path, container, preset.value.data, found)
    yield from faults_in_classes(context, found, missing)


@rule(
    "SM515",
    "untyped-message",
    Severity.ERROR,
    effect="no class of the message is known: the state ends with `aborted`, or the program stops",
)
def untyped_message(context: Context) -> Iterator[Finding]:
    """A state makes a message of a mapping, but its type is not given.

    The state ends with `aborted`, or the program with an exception: no class is known to which the
    fields belong.

    Exactly: a mapping that a state reads as its message (`msg` of PublishMsgState) without the
    input key `msg_type`, and `null` as the type of an action, a service or a message.

    Wrong:
        name: sm
        template: ROSBase
        outcomes: [done, failed]
        userdata: {msg: {data: true}}
        states:
          - SAY:
              template: PublishMsgState
              action: start
              input_keys: [msg]
              transitions: {succeeded: done, aborted: failed}

    Right:
        name: sm
        template: ROSBase
        outcomes: [done, failed]
        userdata: {msg: {data: true}, msg_type: std_msgs/Bool}
        states:
          - SAY:
              template: PublishMsgState
              action: start
              input_keys: [msg, msg_type]
              transitions: {succeeded: done, aborted: failed}
    """
    for path, node in context.leaves_with_variables:
        if names_type(node):
            yield from _null_types(path, node)
        yield from _untyped_mappings(context, path, node)


def _null_types(path: str, leaf: Leaf) -> Iterator[Finding]:
    """SM515 for variables that have to name a type."""
    for role in DEFINITION_KINDS:
        held = variable_of(leaf, role)
        if held is not None and held.value.data is None:
            yield Finding(
                span=held.value.span,
                message=f"`{held.name}` of `{leaf.name}` is null: it names no type",
                arguments=(held.name,),
                help="write the type with its package, as in `std_srvs/Trigger`",
                related=calls(leaf, held.value.span),
                node=path,
            )


def _wrong_calls(path: str, node: Node, code: Expression, found: Definitions) -> Iterator[Finding]:
    """Arguments of the classes of messages, in code, that are no fields or do not fit."""
    if len(code.text) <= MOST_CODE:
        for call, messages in message_calls(code, found):
            faults = call_faults(call, messages, found, code.span)
            yield from _argument_findings(path, node, code.span, faults)


def _wrong_arguments(
    path: str, leaf: Leaf, value: Value, messages: Sequence[Message], found: Definitions
) -> Iterator[Finding]:
    """Arguments that do not fit, in the call that makes a goal or a request; unknown fields of its
    own are names that the state uses."""
    code = value.data
    call = _class_call(code.text, messages) if isinstance(code, Expression) else None
    if call is not None:
        faults = call_faults(call, messages, found, value.span)
        known = [fault for fault in faults if fault.wanted is not None or len(fault.names) > 1]
        yield from _argument_findings(path, leaf, value.span, known)


def _argument_findings(
    path: str, node: Node, span: Span, faults: Iterable[ValueFault]
) -> Iterator[Finding]:
    """The findings for the arguments of a class of a message."""
    for names, message, wanted, value in faults:
        word = word_in(names[-1], span, "=")
        effect = f"`{node.name}` ends with `aborted`: the message is never sent"
        if wanted is None:
            effect = "the field is ignored, or the program stops"
            yield replace(unknown_field_finding(path, node, word, (message,)), effect=effect)
            continue
        text = f"the value of `{names[-1]}` does not fit: the field of {described(message)} is"
        help = value_help(value, wanted)
        yield field_finding(path, node, word, f"{text} `{wanted}`", help, (message,), effect)


def _untyped_mappings(context: Context, path: str, leaf: Leaf) -> Iterator[Finding]:
    """SM515 for the mappings that a state reads as messages."""
    names = key_names(leaf.inputs, "message")
    if not lacks_type_key(leaf):
        return
    if variable(leaf, "action") in NO_MESSAGE:
        return
    for name in sorted(names):
        cell = context.types.cells.get((path, name))
        flows = [flow for alike in cell.flows.values() for flow in alike] if cell else []
        for flow in flows:
            if flow.how == "value" and isinstance(flow.value, Struct):
                add = listing([leaf], "input_keys", TYPE_KEY)
                meant = suggested_type_key(context.routes.nodes.get(path.rpartition("/")[0]))
                help = f"{add}, and set the key to the type, as in `{TYPE_KEY}: std_msgs/Bool`"
                if meant is not None:
                    help = add
                    if meant != TYPE_KEY:
                        help += f" and `{TYPE_KEY}: {meant}` to its `remapping`"
                message = "gets a mapping as its message, but no type: it lacks the key"
                found = literal_finding(
                    flow, f"`{leaf.name}` {message} `{TYPE_KEY}`", help, (leaf.name,)
                )
                edits = with_input(leaf, TYPE_KEY) if meant is not None else ()
                if edits and meant is not None and meant != TYPE_KEY:
                    edits += with_remapping(leaf, TYPE_KEY, meant)
                yield replace(found, repairs=likely(edits, "read the type"))


def _wrong_messages(
    context: Context,
    path: str,
    leaf: Leaf,
    found: Definitions,
    missing: MissingDefinitions,
) -> Iterator[Finding]:
    """Types in the key `msg_type` that do not exist, and mappings in the userdata whose fields the
    message of this type does not have, or whose values do not fit."""
    names = key_names(leaf.inputs, "message")
    typed = context.types.cells.get((path, TYPE_KEY))
    if not names or typed is None or variable(leaf, "action") in NO_MESSAGE:
        return
    given = [flow for alike in typed.flows.values() for flow in alike]
    texts = {flow.value for flow in given if flow.how == "value" and isinstance(flow.value, str)}
    if len(texts) != 1 or any(flow.how != "value" for flow in given):
        return
    type_ = texts.pop()
    absent = missing.get(("msg", type_))
    if absent is not None and absent.other is None:
        package, *_, name = re.split(r"[/.]", type_)
        meant = suggested_type(name, "msg", absent)
        yield literal_finding(given[0], no_type(package, name, "msg"), meant, (package, name))
    messages = [definition.part("message") for definition in found.get(("msg", type_), ())]
    effect = f"`{leaf.name}` ends with `aborted`: the message is never used"
    for name in sorted(names) if messages else ():
        yield from _mapping_faults(context, path, name, messages, found, effect)


def _wrong_slots(
    context: Context, path: str, held: Variable, messages: Sequence[Message], found: Definitions
) -> Iterator[Finding]:
    """Mappings in the userdata that a state copies to a field of a goal or a request, and whose
    fields the message of this field does not have, or whose values do not fit."""
    data = held.value.data
    for name in data if isinstance(data, tuple) else ():
        fields = [message.field(name) for message in messages] if isinstance(name, str) else []
        types = [field.type for field in fields if field is not None and not field.type.array]
        inner = nested_messages(types, found) if len(types) == len(messages) else []
        if isinstance(name, str) and inner:
            effect = f"the {held.role} cannot be made of the value: it is never sent"
            yield from _mapping_faults(context, path, name, inner, found, effect)


def _mapping_faults(
    context: Context,
    path: str,
    name: str,
    messages: Sequence[Message],
    found: Definitions,
    effect: str,
) -> Iterator[Finding]:
    """The faults of the mappings in a key of a state for a message."""
    for flow, item, value in (*_flows(context, path, name), *_items(context, path, name)):
        if not isinstance(value, Struct):
            continue
        faults = [list(value_faults(value, message, found)) for message in messages]
        levels = with_levels(value, faults[0] if all(faults) else (), found)
        for (steps, message, wanted, given), level in levels:
            fields = sorted(field.name for field in message.fields)
            text = f"{described(message)} has no field `{steps[-1]}`"
            help = level or did_you_mean(near_field(steps[-1], fields))
            help = help or _only_missing(value, steps, message)
            known = f"use one of its fields: {listed(fields)}" if fields else "it has no fields"
            help = help or known
            if wanted is not None:
                text = f"the value of `{steps[-1]}` does not fit: the field of"
                text += f" {described(message)} is `{wanted}`"
                help = value_help(given, wanted)
            finding = literal_finding(
                flow,
                text,
                help,
                (message.name, *map(str, item), *steps),
                part=Part((*item, *steps), key=wanted is None),
            )
            yield replace(finding, effect=effect)


_Literal: TypeAlias = "tuple[TypeFlow, tuple[int, ...], Data]"
"""A literal that arrives at a key, the steps to its part that does so, and that part."""


def _flows(context: Context, path: str, name: str) -> Iterator[_Literal]:
    """The literals that arrive at a key of a state."""
    cell = context.types.cells.get((path, name))
    for alike in cell.flows.values() if cell is not None else ():
        yield from ((flow, (), flow.value) for flow in alike if flow.how == "value")


def _items(context: Context, path: str, name: str) -> Iterator[_Literal]:
    """The items of the literal lists over which the loop around a state gives it a key."""
    around = path.rpartition("/")[0]
    loop, node = (context.routes.nodes.get(text) for text in (around, path))
    if not isinstance(loop, nodes.Iterator) or not loop.items_key or node is None:
        return
    if remapping(node)[name] != loop.item_key:
        return
    for flow, _, items in _flows(context, around, loop.items_key):
        for number, item in enumerate(items if isinstance(items, tuple) else ()):
            yield flow, (number,), item


def _only_missing(data: Data, steps: Sequence[str], message: Message) -> str | None:
    """The help that names the only field that a mapping lacks, if one of its own is unknown."""
    for step in steps[:-1]:
        data = dict(data.entries).get(step) if isinstance(data, Struct) else None
    given = [name for name, _ in data.entries] if isinstance(data, Struct) else []
    fields = [field.name for field in message.fields]
    missing = [name for name in fields if name not in given]
    more = [name for name in given if name not in fields]
    return f"write `{missing[0]}`" if len(missing) == len(more) == 1 else None


def _wrong_values(
    path: str,
    leaf: Leaf,
    held: Variable,
    messages: Sequence[Message],
    found: Definitions,
    other: str,
) -> Iterator[Finding]:
    """Values that do not fit the fields of a message, or are for fields that it does not have."""
    data, span = held.value.data, held.value.span
    if isinstance(data, tuple) and all(isinstance(value, str) for value in data):
        return  # the names of keys
    if isinstance(data, tuple) and all(len(data) != len(message.fields) for message in messages):
        first = messages[0]
        counts = f"{len(data)} values, but {described(first)} has {len(first.fields)} fields"
        form = ", ".join(f"{field.name}: ..." for field in first.fields)
        help = f"write a mapping of the fields: `{{{form}}}`"
        yield field_finding(path, leaf, Word("", span), f"the list has {counts}", help, messages)
        return
    faults = [list(value_faults(data, message, found)) for message in messages]
    effect = f"the program stops when it makes the state: the {held.role} is never sent"
    order = in_field_order(data, messages[0]) if faults and all(faults) else None
    if order is not None:
        fields = ", ".join(f"`{field.name}`" for field in messages[0].fields)
        text = f"a list gives the fields in their order ({fields}), but these values do not fit it"
        yield field_finding(path, leaf, Word("", span), text, f"write `{order}`", messages, effect)
        return
    levels = with_levels(data, faults[0] if all(faults) else (), found)
    for (names, message, wanted, value), level in levels:
        if wanted is None:
            word = _field_word(names, span)
            also = other if len(names) == 1 else ""
            finding = unknown_field_finding(path, leaf, word, (message,), other=also)
            yield replace(finding, help=level or finding.help, effect=effect)
            continue
        text = f"the value of `{names[-1]}` does not fit: the field of {described(message)} is"
        place = _value_span(_field_word(names, span).span, span)
        if isinstance(data, tuple) and len(names) == 1:
            numbers = [number for number, field in enumerate(message.fields) if field.name in names]
            place = place_of_part(span, numbers)
        word, help = Word(names[-1], place), value_help(value, wanted)
        yield field_finding(path, leaf, word, f"{text} `{wanted}`", help, (message,), effect)


def _other_type(context: Context, leaf: Leaf, kind: DefinitionKind, role: str) -> str:
    """The end of the help that names the type that has all fields which a state gives; empty if it
    is not known."""
    others = context.machine.other_types
    named = next(
        (other for other in leaf.variables if DEFINITION_KINDS.get(other.role) == kind), None
    )
    if not others or named is None:
        return ""
    fields = given_fields(leaf.variables, role)
    other = others.get((type_text(named), fields))
    return f", or correct the type: `{other}` has {both(fields)}" if other is not None else ""


def _field_word(names: Sequence[str], span: Span) -> Word:
    """The last of the names of nested fields, in its place inside the others."""
    place, whole = span, span
    for name in names:
        word = word_in(name, place, ":")
        if word.span == place:  # the values are a list
            return Word(names[-1], whole)
        whole = word.span
        place = Span(span.source, whole.end, span.end)
    return Word(names[-1], whole)


def _value_span(name: Span, value: Span) -> Span:
    """The value after the name of a field, if it is short; else the name."""
    if name == value:
        return name
    after = Span(value.source, name.end, value.end)
    found = _SHORT_VALUE.match(after.text)
    if found is None:
        return name
    return Span(after.source, after.start + found.start(1), after.start + found.end(1))


def _faults(
    context: Context,
    path: str,
    leaf: Leaf,
    held: Variable,
    messages: Sequence[Message],
    other: str,
) -> Iterator[Finding]:
    names = {field.name for message in messages for field in message.fields}
    inputs = {key.name for key in leaf.inputs}
    remapped = remapped_field(leaf, held, names)
    for use in _uses(held, messages):
        name = use.word.text
        if remapped is not None and use.key and name not in names:
            help = f"write `{remapped}`, which the remapping has, in place of `{name}`"
            text = f"{described(messages[0])} has no field `{name}`"
            yield field_finding(path, leaf, use.word, text, help, messages)
        elif name not in names:
            lists = (("input_keys", leaf.inputs), ("output_keys", leaf.outputs))
            named = [part for part, keys in lists if name in [key.name for key in keys]]
            also = f", in the `{named[0]}`" if use.key and named and len(named) == 1 else ""
            yield unknown_field_finding(path, leaf, use.word, messages, also=also, other=other)
        elif use.key and name in inputs:
            given = present(context.types.inputs[path, name])
            fields = [message.field(name) for message in messages]
            wanted = [userdata_type(field.type) for field in fields if field is not None]
            if not any(_can_fit(given, type_) for type_ in wanted):
                type_ = next(field.type for field in fields if field is not None)
                message = f"`{name}` is `{given}`, but the field of {described(messages[0])} is"
                help = f"remap `{name}` to a key whose values are `{wanted[0]}`"
                yield field_finding(path, leaf, use.word, f"{message} `{type_}`", help, messages)


def _can_fit(given: Type, wanted: Type) -> bool:
    """Whether a field can accept a value: a list of numbers can be read as a message, a number of
    seconds as a time or a duration, and a whole number as a truth value."""
    if wanted.name in ("array", "list") and given.name in ("array", "list"):
        item, wanted_item = (type_.args[:1] for type_ in (given, wanted))
        if wanted_item and isinstance(wanted_item[0], Type) and is_time(wanted_item[0].name):
            return not item or not isinstance(item[0], Type) or _can_fit(item[0], wanted_item[0])
    if is_time(wanted.name) and given.name in ("int", "float"):
        return True
    if "/" in wanted.name and given.name not in SCALARS:
        return True
    truths = ("bool", "int")
    return (given.name in truths and wanted.name in truths) or fits(given, wanted)


def _uses(held: Variable, messages: Sequence[Message]) -> Iterator[_Use]:
    """The names of fields in the value of a variable: a list of keys, or a call of the class of
    the message."""
    span = held.value.span
    match held.value.data:
        case tuple() as names if all(isinstance(name, str) for name in names):
            for name in names:
                yield _Use(word_in(str(name), span), key=True)
        case Expression(text=text):
            for name in _keywords(text, messages):
                yield _Use(word_in(name, span, "="), key=False)


def _keywords(text: str, messages: Sequence[Message]) -> Iterator[str]:
    """The names of the arguments in a call of the class of a message."""
    call = _class_call(text, messages)
    if call is not None:
        yield from (
            keyword.arg for keyword in call.keywords if keyword.arg not in (None, CHECK_FIELDS)
        )


def _class_call(text: str, messages: Sequence[Message]) -> ast.Call | None:
    """The call of the class of a message, by keywords: `TestGoal(goal=1)` in ROS 1,
    `Test.Goal(goal=1)` in ROS 2; None for other code."""
    tree = call_of(text)
    if tree is None or tree.args:
        return None
    definition, _, part = messages[0].name.rpartition("/")[2].partition(".")
    called = ast.unparse(tree.func).split(".")
    joined = f"{definition}{part.capitalize()}"
    is_class = called[-1] == joined or called[-2:] == [definition, part.capitalize()]
    return tree if is_class else None

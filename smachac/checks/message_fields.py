"""Rules over messages of ROS: the fields that states set and read, and their definitions."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.type_lattice import fits, present
from smachac.checks.messages import calls, did_you_mean
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.leaf import type_text, variable_of
from smachac.ir.message_types import PARTS, Definition, DefinitionKind, Message, userdata_type
from smachac.ir.nodes import DEFINITION_KINDS, Expression, Leaf, Struct, Variable
from smachac.ir.types import Type

SCALARS = frozenset(["bool", "int", "float", "str", "literal", "one_of"])

MOST_CODE = 10_000
"""The longest message in code that is read, in characters."""


class _Use(NamedTuple):
    """A name that a state uses as a field; `key`: the field has the value of the key of that
    name, or gives it one."""

    word: Word
    key: bool


@rule("SM512", "unknown-field", Severity.ERROR)
def unknown_field(context: Context) -> Iterator[Finding]:
    """A state uses a field that the message does not have, or gives it a value of another type.

    The state fails when it runs: the goal or the request is never sent.

    Exactly: the definitions of services and actions (`.srv`, `.action`) are searched in packages in
    the folders of `code` in the project file, in the folder of the script and in those above it up
    to the root of the repository, in AMENT_PREFIX_PATH, in ROS_PACKAGE_PATH and beside the Python
    that runs smachac. Where there is none, nothing is checked. Where several are found, such as
    those of ROS 1 and ROS 2, a finding holds for all of them.

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
    if not context.machine.definitions:
        return
    for path, node in context.states:
        if isinstance(node, Leaf):
            for kind, definitions in _definitions(context, node):
                for held in node.variables:
                    if held.role in PARTS[kind]:
                        messages = [each.part(held.role) for each in definitions]
                        yield from _faults(context, path, node, held, messages)


def _definitions(
    context: Context, leaf: Leaf
) -> Iterator[tuple[DefinitionKind, tuple[Definition, ...]]]:
    """The definitions of the types that a state names."""
    for role, kind in DEFINITION_KINDS.items():
        named = variable_of(leaf, role)
        found = context.machine.definitions
        if named is not None and (kind, type_text(named)) in found:
            yield kind, found[kind, type_text(named)]


def _faults(
    context: Context, path: str, leaf: Leaf, held: Variable, messages: Sequence[Message]
) -> Iterator[Finding]:
    names = {each.name for message in messages for each in message.fields}
    guess = guesser(sorted(names))
    inputs = {key.name for key in leaf.inputs}
    for use in _uses(held, messages):
        name = use.word.text
        if name not in names:
            known = f"its fields are {listed(names)}" if names else "it has no fields"
            message = f"{_described(messages[0])} has no field `{name}`"
            help = did_you_mean(guess(name)) or known
            yield _finding(path, leaf, use.word, message, help, messages)
        elif use.key and name in inputs:
            given = present(context.types.inputs[path, name])
            fields = [message.field(name) for message in messages]
            wanted = [userdata_type(each.type) for each in fields if each is not None]
            if not any(_can_fit(given, each) for each in wanted):
                type_ = next(each.type for each in fields if each is not None)
                message = f"`{name}` is `{given}`, but the field of {_described(messages[0])} is"
                help = f"remap `{name}` to a key whose values are `{wanted[0]}`"
                yield _finding(path, leaf, use.word, f"{message} `{type_}`", help, messages)


def _can_fit(given: Type, wanted: Type) -> bool:
    """Whether a field can accept a value: a list of numbers can be read as a message, and a whole
    number as a truth value."""
    if "/" in wanted.name and given.name not in SCALARS:
        return True
    truths = ("bool", "int")
    return (given.name in truths and wanted.name in truths) or fits(given, wanted)


def _described(message: Message) -> str:
    """The name of a message in a sentence."""
    definition, _, part = message.name.partition(".")
    return f"the {part} of `{definition}`" if part else f"`{definition}`"


def _finding(
    path: str, leaf: Leaf, word: Word, message: str, help: str, messages: Sequence[Message]
) -> Finding:
    places = [each.fields[0].span for each in messages if each.fields][:1]
    return Finding(
        span=word.span,
        message=message,
        arguments=(messages[0].name, word.text),
        help=help,
        related=(
            *(Related(span=span, message="the fields are defined here") for span in places),
            *calls(leaf, word.span),
        ),
        node=path,
    )


def _uses(held: Variable, messages: Sequence[Message]) -> Iterator[_Use]:
    """The names of fields in the value of a variable: a list of keys, a mapping of the fields, or
    a call of the class of the message."""
    span = held.value.span
    match held.value.data:
        case tuple() as names:
            for name in names:
                if isinstance(name, str):
                    yield _Use(_word(name, span), key=True)
        case Struct(entries=entries):
            for name, _ in entries:
                yield _Use(_word(name, span), key=False)
        case Expression(text=text):
            for name in _keywords(text, messages):
                yield _Use(_word(name, span, "="), key=False)


def _keywords(text: str, messages: Sequence[Message]) -> Iterator[str]:
    """The names of the arguments in a call of the class of a message: `TestGoal(goal=1)` in ROS 1,
    `Test.Goal(goal=1)` in ROS 2."""
    if len(text) > MOST_CODE:
        return
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    if not isinstance(tree, ast.Call) or tree.args:
        return
    definition, _, part = messages[0].name.rpartition("/")[2].partition(".")
    called = ast.unparse(tree.func).split(".")
    joined = f"{definition}{part.capitalize()}"
    if called[-1] == joined or called[-2:] == [definition, part.capitalize()]:
        yield from (each.arg for each in tree.keywords if each.arg is not None)


def _word(name: str, span: Span, after: str = "") -> Word:
    """A name inside a span, before some text; the whole span if it is not written there."""
    found = re.search(rf"(?<!\w){re.escape(name)}(?=\s*{re.escape(after)})(?!\w)", span.text)
    if found is None:
        return Word(name, span)
    return Word(name, Span(span.source, span.start + found.start(), span.start + found.end()))

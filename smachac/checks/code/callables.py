"""Rules on functions in a script: whether they can be called, with which arguments, and results."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.analysis.code_slots import (
    CodeSlot,
    accepts,
    is_value,
    means,
    parameters,
    results,
    swapped,
    userdata_outside,
    userdata_parameter,
)
from smachac.analysis.context import Context
from smachac.analysis.expression_errors import is_method, kinds, type_text
from smachac.analysis.expression_types import type_of_call
from smachac.analysis.function_slots import named_functions
from smachac.analysis.type_inference import TypeFlow
from smachac.checks.code.function_results import (
    NONE_EFFECTS,
    WAIT_FAILS,
    always_true,
    overwritten_keys,
    silent_functions,
)
from smachac.checks.code.outcome_results import wrong_outcomes
from smachac.checks.findings.class_value_types import CHANGES, none_writes
from smachac.checks.findings.code_findings import readable_slots, slot_owner
from smachac.checks.findings.help_text import calls, in_quotes_for, other_place
from smachac.checks.findings.number_help import suggested_number
from smachac.checks.findings.type_origins import written
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import in_quotes
from smachac.diagnostics.wording import listed
from smachac.ir.code_places import node_place, node_range, place_in
from smachac.ir.function_facts import FunctionFacts
from smachac.ir.nodes import Expression, Node, VariableRole
from smachac.ir.script_code import USERDATA, free_names
from smachac.ir.types import ANY, Type


@rule(
    "SM316",
    "not-a-function",
    Severity.ERROR,
    effect="the program stops when it makes the state, or the state fails at its first visit",
)
def not_a_function(context: Context) -> Iterator[Finding]:
    """Code of the script gives a value where the state calls a function.

    A Python program evaluates the code once, when it builds the machine: there is no userdata then,
    so the program does not start. A function is evaluated at each visit of the state.

    Exactly: in a variable that must be a function by the interface of the state type, code that
    certainly gives something else; in a variable that may be a function, code that reads userdata
    outside a function, and a function that is written as text.

    Wrong:
        name: sm
        template: Base
        outcomes: [low, high]
        userdata: {level: 7}
        states:
          - JUDGE:
              template: ConditionalOutcomeState
              input_keys: [level]
              outcomes: [low]
              callbacks: {low: 'ud.level < 10'}
              default_outcome: high
              transitions: {low: low, high: high}

    Right:
        name: sm
        template: Base
        outcomes: [low, high]
        userdata: {level: 7}
        states:
          - JUDGE:
              template: ConditionalOutcomeState
              input_keys: [level]
              outcomes: [low]
              callbacks: {low: 'lambda ud: ud.level < 10'}
              default_outcome: high
              transitions: {low: low, high: high}
    """
    for path, node, slot, tree in readable_slots(context):
        text = slot.code.text
        if slot.quoted:
            yield Finding(
                span=slot.code.span,
                message=f"`{slot.name}` of `{node.name}` is text, not a function",
                arguments=(slot.name, text),
                help=f"write the function in backticks: {in_quotes(f'`{text}`')}",
                related=calls(node, slot.code.span),
                node=path,
                edits=_backticks(slot),
            )
            continue
        read = userdata_outside(tree)
        facts = _called(context, slot, tree) if read is None else None
        if facts is not None and isinstance(tree, ast.Call):
            yield from _called_too_early(path, node, slot, tree, facts)
            continue
        if read is None and not (slot.must_be_called and is_value(tree)):
            continue
        name = read.id if read is not None else USERDATA[0]
        what = "is not a function"
        if read is not None:
            what = f"reads `{read.id}` outside a function; it has no value before the machine runs"
        function = f"lambda {_arguments(slot, name)}: {_with_keys(slot, tree, name, node)}"
        yield Finding(
            span=node_place(slot.code, read) if read is not None else slot.code.span,
            message=f"{slot_owner(slot, node)} {what}",
            arguments=(slot.name, text),
            help=_as_key(slot) or f"write {_as_code(slot, function)}",
            related=calls(node, slot.code.span),
            node=path,
            edits=_as_function(slot, name) if read is not None else (),
        )


def _called(context: Context, slot: CodeSlot, tree: ast.expr) -> FunctionFacts | None:
    """The function of the user that code in place of a function calls; None for other code."""
    if not slot.must_be_called or not isinstance(tree, ast.Call) or not context.machine.functions:
        return None
    return context.machine.functions.get(ast.unparse(tree.func))


def _called_too_early(
    path: str, node: Node, slot: CodeSlot, call: ast.Call, facts: FunctionFacts
) -> Iterator[Finding]:
    """SM316 for a call of a function of the user that fails or gives no function, where the state
    can call that function itself."""
    if call.keywords or any(isinstance(argument, ast.Starred) for argument in call.args):
        return
    values = [result.kind in ("constant", "truth") for result in facts.results]
    fails = not facts.accepts(len(call.args))
    certain = fails or facts.silent or (values and all(values))
    if certain and slot.arguments is not None and facts.accepts(len(slot.arguments)):
        name, span = ast.unparse(call.func), slot.code.span
        yield Finding(
            span=span,
            message=f"{slot_owner(slot, node)} is a call of `{name}`, not the function",
            arguments=(slot.name, slot.code.text),
            help=f"write the function: `{name}`",
            effect="the program calls it once, when it makes the state: the call raises TypeError"
            if fails
            else "the program calls it once, when it makes the state: the result is no function",
            related=(
                *other_place(facts.word.span, "it is defined here"),
                *calls(node, span),
            ),
            node=path,
            edits=(Edit(span=span, text=name),) if span.text == slot.code.text else (),
        )


def _arguments(slot: CodeSlot, userdata: str) -> str:
    """The arguments of the function of a slot, in which the userdata has the name of the code."""
    names = slot.arguments or ("userdata",)
    return ", ".join(userdata if name == "userdata" else name for name in names)


def _with_keys(slot: CodeSlot, tree: ast.expr, name: str, node: Node) -> str:
    """Code in which the names of keys stand for the keys of userdata."""
    text, keys = slot.code.text, {key.name for key in (*node.inputs, *node.outputs)}
    for word in reversed(free_names(tree)):
        if word.id in keys:
            start, _ = node_range(text, word)
            text = f"{text[:start]}{name}.{text[start:]}"
    return text


def _as_code(slot: CodeSlot, text: str) -> str:
    """Code as the script must write it: in backticks and quotes where a plain text is no code, and
    in quotes where it has none, because a plain text of YAML cannot contain a colon."""
    source, start = slot.code.span.source, slot.code.span.start
    before = source.text[max(0, start - 1) : start + 1]
    if not slot.must_be_called and "`" not in slot.code.span.text:
        return in_quotes(f"`{text}`")
    quoted = any(text in before for text in "'\"`|>") or "\n" in slot.code.span.text
    return f"`{text}`" if quoted else f"`{in_quotes(text)}`"


def _as_key(slot: CodeSlot) -> str | None:
    """The help for an iterator over the key that its code reads."""
    match slot.name, slot.tree:
        case "it", ast.Attribute(value=ast.Name(), attr=key):
            return f"write the name of the key: `{key}`"
    return None


def _backticks(slot: CodeSlot) -> tuple[Edit, ...]:
    """The edit that puts quoted text in backticks, if the quotes hold nothing but the text."""
    span, text = slot.code.span, slot.code.text
    written = span.text
    doubled = text.replace("'", "''")
    if "\n" in text or written not in (f"'{doubled}'", f'"{text}"'):
        return ()
    return (Edit(span=span, text=in_quotes(f"`{text}`")),)


def _as_function(slot: CodeSlot, name: str) -> tuple[Edit, ...]:
    """The edit that makes a lambda of code; a plain scalar gets quotes."""
    text, span = slot.code.text, slot.code.span
    head = f"lambda {_arguments(slot, name)}: "
    key = _as_key(slot)
    if key is not None and span.text == text:
        return (Edit(span=span, text=text.partition(".")[2]),)
    if slot.must_be_called and span.text == text and not {"'", "\n"} & set(text):
        return (Edit(span=span, text=f"'{head}{text}'"),)
    if span.text[:1] not in ("'", '"'):
        return ()
    start = place_in(slot.code, 0, 1)
    return (Edit(span=Span(start.source, start.start, start.start), text=head),)


@rule(
    "SM317",
    "wrong-arguments",
    Severity.ERROR,
    effect="the call raises TypeError at the first visit of the state",
)
def wrong_arguments(context: Context) -> Iterator[Finding]:
    """A function of the script has other arguments than the state passes to it.

    The call fails at the first visit of the state, with the robot in the middle of its task.

    Exactly: the interface of the state type lists the arguments. Lambdas are checked, and functions
    that a template of the script defines or imports from a module of the project. Arguments in
    another order are found by their names.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded]
        userdata: {n: 0}
        output_keys: [n]
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              output_keys: [n]
              callbacks: {n: 'lambda ud, n: n + 1'}
              transitions: {succeeded: succeeded}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        userdata: {n: 0}
        output_keys: [n]
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              output_keys: [n]
              callbacks: {n: 'lambda ud: ud.n + 1'}
              transitions: {succeeded: succeeded}
    """
    for path, node, slot, tree in readable_slots(context):
        if not isinstance(tree, ast.Lambda) or slot.arguments is None or slot.quoted:
            continue
        due = slot.arguments
        if accepts(tree, len(due)):
            found = swapped([parameter.arg for parameter in parameters(tree)], due)
            what = f"has the arguments {_names(found)}, but the state passes {_names(due)}"
            effect: str | None = ORDER_EFFECT
            if not found:
                continue
        else:
            own = len(parameters(tree))
            what, effect = _wrong_number(own, due), None
        yield Finding(
            span=_head(slot, tree),
            message=f"the function of {slot_owner(slot, node)} {what}",
            arguments=(slot.name, slot.code.text),
            help=_head_help(node, tree, due),
            effect=effect,
            related=calls(node, slot.code.span),
            node=path,
        )

    for path, node, slot, facts in named_functions(context):
        yield from _wrong_parameters(path, node, slot, facts)


def _wrong_parameters(
    path: str, node: Node, slot: CodeSlot, facts: FunctionFacts
) -> Iterator[Finding]:
    """SM317 for a function in a module: the number of its parameters, or their order."""
    due, own = slot.arguments or (), len(facts.parameters)
    found = swapped(facts.parameters, due)
    if not facts.accepts(len(due)):
        span, effect, what = facts.word.span, None, _wrong_number(own, due)
    elif found:
        span, effect = facts.head, ORDER_EFFECT
        what = f"has the parameters {_names(found)}, but the state passes {_names(due)}"
    else:
        return
    yield Finding(
        span=span,
        message=f"`{facts.word.text}`, the function of {slot_owner(slot, node)}, {what}",
        arguments=(slot.name, slot.code.text),
        help=_definition_help(slot, facts, own_parameters(facts.parameters, due)),
        effect=effect,
        related=(*other_place(slot.code.span, "it is called here"), *calls(node, slot.code.span)),
        node=path,
    )


def _wrong_number(own: int, due: Sequence[str]) -> str:
    """The number of parameters against the arguments, as part of a message."""
    what = f"has {own or 'no'} parameter{'s' * (own != 1)}, but the state passes {len(due)}"
    return f"{what} argument{'s' * (len(due) != 1)}: {_names(due)}"


def own_parameters(own: Sequence[str], due: Iterable[str]) -> list[str]:
    """The names of parameters that a function needs, as the user has written them."""
    return [next((text for text in own if means(text, name)), _short(name)) for name in due]


def _definition_help(slot: CodeSlot, facts: FunctionFacts, due: list[str]) -> str:
    """The help for a function of the user with wrong parameters: its correct head, or a value for
    each parameter that its body needs and the state does not pass."""
    more = facts.parameters[len(due) : facts.least]
    if set(more).isdisjoint(facts.used):
        return f"write `def {facts.word.text}({', '.join(due)}):`"
    call = f"{slot.code.text}({', '.join([*due, *('...' for _ in more)])})"
    default = "a default value" if len(more) == 1 else "default values"
    return f"give {listed(more)} {default}, or write `lambda {', '.join(due)}: {call}`"


def _head_help(node: Node, tree: ast.Lambda, due: tuple[str, ...]) -> str:
    """The help for a lambda with wrong arguments: its correct beginning, and the way to read a key
    that was written as an argument."""
    given = [parameter.arg for parameter in parameters(tree)]
    names = own_parameters(given, due)
    help = f"begin it with `lambda {', '.join(names)}:`"
    read = {node.id for node in ast.walk(tree.body) if isinstance(node, ast.Name)}
    own = [
        parameter.arg
        for parameter in parameters(tree)
        if not any(means(parameter.arg, arg) for arg in due)
    ]
    keys = [name for name in own if name in read]
    if (
        "userdata" not in due
        or not keys
        or own == [parameter.arg for parameter in parameters(tree)]
    ):
        return help
    help += f", and read {', '.join(f'`{key}` as `{USERDATA[0]}.{key}`' for key in keys)}"
    undeclared = [key for key in keys if key not in {input_.name for input_ in node.inputs}]
    if undeclared:
        help += f"; add {listed(undeclared)} to the `input_keys` of `{node.name}`"
    return help


def _names(names: Iterable[str]) -> str:
    """Names in their order."""
    return ", ".join(f"`{name}`" for name in names)


def _short(argument: str) -> str:
    return USERDATA[0] if argument == "userdata" else argument


def _head(slot: CodeSlot, tree: ast.Lambda) -> Span:
    """The span of the arguments of a lambda, or of the word `lambda`."""
    found = [node for node in ast.walk(tree.args) if isinstance(node, ast.arg)]
    if not found:
        return place_in(slot.code, 0, len("lambda"))
    first, last = found[0], found[-1]
    if slot.code.text.count("\n"):
        return slot.code.span
    whole = ast.Name(
        id="",
        lineno=first.lineno,
        col_offset=first.col_offset,
        end_lineno=last.end_lineno,
        end_col_offset=last.end_col_offset,
    )
    return node_place(slot.code, whole)


ORDER_EFFECT = "the arguments are passed in that order: each name has a wrong value"

NO_VALUE = frozenset([
    "logging.info", "random.seed", "random.shuffle", "rospy.loginfo", "rospy.logwarn",
    "rospy.sleep", "time.sleep",
])  # fmt: skip
"""Functions that return None."""

ALWAYS_NOTHING = frozenset(["append", "extend"])
"""Those that return None whatever the value is."""


@rule("SM318", "wrong-result", Severity.ERROR)
def wrong_result(context: Context) -> Iterator[Finding]:
    """A function of the script returns nothing, or something that the state cannot use.

    Methods such as `append` change a list and return None: a condition is then never true, and a
    callback replaces the value of its key by None.

    Exactly: a result that is None in conditions, durations and callbacks (there only that of a
    method that changes a value, and that of a function of the project without `return`); text as a
    duration; a text that is not an outcome of the state in a function that returns its outcome, or
    there a field of the message that is no text by its definition (SM512). A warning if only some
    runs give this result, or if the type of the value is not known, and for a condition whose
    results are all texts, which count as true.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded]
        userdata: {seen: [1]}
        output_keys: [seen]
        states:
          - NOTE:
              template: CallbacksState
              input_keys: [seen]
              output_keys: [seen]
              callbacks: {seen: 'lambda ud: ud.seen.append(2)'}
              transitions: {succeeded: succeeded}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        userdata: {seen: [1]}
        output_keys: [seen]
        states:
          - NOTE:
              template: CallbacksState
              input_keys: [seen]
              output_keys: [seen]
              callbacks: {seen: 'lambda ud: ud.seen + [2]'}
              transitions: {succeeded: succeeded}
    """
    for path, node, slot, tree in readable_slots(context):
        if not isinstance(tree, ast.Lambda) or slot.quoted or slot.returns != "value":
            continue
        found = results(tree)
        for result in found:
            fault = _value_fault(context, path, node, slot, result)
            if fault is None:
                continue
            what, help, sure, effect = fault
            yield Finding(
                span=node_place(slot.code, result),
                message=f"the function of {slot_owner(slot, node)} returns {what}",
                arguments=(slot.name, ast.unparse(result)),
                help=help,
                effect=effect,
                related=(
                    *(
                        place
                        for preset in _presets(context, path, slot, result)
                        for place in other_place(preset.span, written(preset))
                    ),
                    *calls(node, slot.code.span),
                ),
                node=path,
                severity=None if sure and len(found) == 1 else Severity.WARNING,
            )
    yield from wrong_outcomes(context)
    yield from none_writes(context)

    yield from silent_functions(context)
    yield from overwritten_keys(context)
    yield from always_true(context)


SECONDS = Type("float", ("s",))

RESULT_HELP: Mapping[VariableRole, str] = {
    "conditions": "return a comparison, as in `lambda ud: ud.n > 0`",
    "duration": "return a number of seconds, as in `lambda ud: 2.5`",
}
"""The help for code of a role that returns None."""


class Fault(NamedTuple):
    """What a function returns, the help, whether it is certain, and what happens then; an empty
    effect is in `what`."""

    what: str
    help: str
    sure: bool
    effect: str


def _value_fault(
    context: Context, path: str, node: Node, slot: CodeSlot, result: ast.expr
) -> Fault | None:
    """The fault of a result that must be a value."""
    nothing = NONE_EFFECTS.get(slot.role, "").format(name=slot.name)
    a_value = RESULT_HELP.get(slot.role, "return a value")
    match result:
        case ast.Constant(value=None) if slot.role != "callbacks":
            return Fault("None", a_value, True, nothing)
        case ast.Call(func=ast.Name(id="print")) if slot.role != "callbacks":
            return Fault("None: `print` returns nothing", a_value, True, nothing)
        case ast.Call(func=function, args=given) if ast.unparse(function) in NO_VALUE:
            if slot.role == "callbacks":
                return None
            name = ast.unparse(function)
            if name.endswith(".sleep") and slot.role == "duration" and given:
                a_value = f"write the number of seconds: `{ast.unparse(given[0])}`"
            return Fault(f"None: `{name}` returns nothing", a_value, True, nothing)
        case ast.Call(func=ast.Attribute(value=value, attr=method)):
            type_ = _type(context, path, node, slot, value)
            known = next(iter(kinds(type_)), "") if len(kinds(type_)) == 1 else ""
            if known and method not in CHANGES.get(known, ()):
                return None
            if not known and (method not in ALWAYS_NOTHING or type_ != ANY):
                return None
            what = f"None: `{method}` changes the value and returns nothing"
            return Fault(
                what, _instead(result, value, method, slot.code.span), bool(known), nothing
            )
        case ast.Attribute(value=value, attr=method) if slot.role != "callbacks":
            if is_method(_type(context, path, node, slot, value), method):
                always = ", which is always true" if slot.role == "conditions" else ""
                what = f"the method `{method}` without a call{always}"
                effect = WAIT_FAILS if slot.role == "duration" else ""
                return Fault(what, f"call it: `{ast.unparse(result)}()`", True, effect)
    if slot.role == "duration":
        type_ = _type(context, path, node, slot, result)
        if kinds(type_) and "number" not in kinds(type_):
            what = f"`{type_text(type_)}`, but a duration is a number of seconds"
            help = _number_help(_presets(context, path, slot, result))
            return Fault(what, help, True, WAIT_FAILS)
    return None


def _number_help(presets: list[TypeFlow]) -> str:
    """The help for a duration that is no number: the number, where a text of the script was meant
    as one."""
    texts = (preset.value for preset in presets if isinstance(preset.value, str))
    meant = (suggested_number(text, SECONDS) for text in texts)
    found = next((help for help in meant if help is not None), None)
    return found or "return a number, for example with `float(...)`"


def _presets(context: Context, path: str, slot: CodeSlot, result: ast.expr) -> list[TypeFlow]:
    """The values of the script for the keys that a duration reads."""
    if slot.role != "duration":
        return []
    keys = [node.attr for node in ast.walk(result) if isinstance(node, ast.Attribute)]
    cells = [context.types.cells.get((path, key)) for key in dict.fromkeys(keys)]
    origins = [
        alike[0].origin for cell in cells if cell is not None for alike in cell.flows.values()
    ]
    return [fromkey for fromkey in dict.fromkeys(origins) if fromkey.how == "value"]


def _instead(call: ast.Call, value: ast.expr, method: str, span: Span) -> str:
    """The code that returns the changed value, for the scalar at `span`."""
    owner = ast.unparse(value)
    given = [in_quotes_for(ast.unparse(argument), span) for argument in call.args]
    match method, given:
        case "append", [item]:
            return f"write `{owner} + [{item}]`, which is the longer list"
        case "extend", [items]:
            return f"write `{owner} + {items}`, which is the longer list"
        case "sort", []:
            return f"write `sorted({owner})`, which is the sorted list"
    return "return the new value"


def _type(context: Context, path: str, node: Node, slot: CodeSlot, value: ast.expr) -> Type:
    """The type of a part of a function, by the types of the keys that it reads."""
    name = userdata_parameter(slot)
    if name is None:
        return ANY
    code = Expression(text=f"lambda {name}: {ast.unparse(value)}", span=slot.code.span)
    types = context.types.inputs
    keys = {key.name: types.get((path, key.name), ANY) for key in node.inputs}
    return type_of_call(code, keys)

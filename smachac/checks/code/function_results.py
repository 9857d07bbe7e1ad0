"""Functions in a script and their results: those that return nothing, replace a key that they set
themselves, or make a condition that is always true."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from smachac.analysis.code_slots import CodeSlot, is_condition, results
from smachac.analysis.context import Context
from smachac.analysis.function_slots import named_functions
from smachac.checks.findings.code_findings import readable_slots, slot_owner
from smachac.checks.findings.help_text import calls, other_place
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.source import Span
from smachac.ir.nodes import Leaf, Node, VariableRole

WAIT_FAILS = "the state fails when it begins to wait"

NONE_EFFECTS: Mapping[VariableRole, str] = {
    "callbacks": "SMACH sets the key `{name}` to the result of the function, which is None",
    "conditions": "the condition is never true",
    "duration": WAIT_FAILS,
}
"""What happens with None as the result of code of a role."""


def silent_functions(context: Context) -> Iterator[Finding]:
    """The functions of the user that return no value, although the state uses their result. A
    callback that sets other keys itself may return nothing; its own key gets its result."""
    for path, node, slot, facts in named_functions(context):
        used = slot.role != "callbacks" or (
            (not facts.writes or slot.name in {word.text for word in facts.writes})
            and isinstance(node, Leaf)
            and slot.name in {key.name for key in node.outputs}
        )
        if facts.silent and slot.returns == "value" and used:
            yield Finding(
                span=facts.word.span,
                message=f"`{facts.word.text}`, the function of {slot_owner(slot, node)}, never"
                " returns a value",
                arguments=(slot.name, slot.code.text),
                help=f"end `{facts.word.text}` with `return ...`",
                effect=NONE_EFFECTS.get(slot.role, "").format(name=slot.name),
                related=(*other_place(slot.code.span, "its result is used here"),
                         *calls(node, slot.code.span)),
                node=path,
            )  # fmt: skip


def overwritten_keys(context: Context) -> Iterator[Finding]:
    """The callbacks that set their key themselves and return a text, such as an outcome, which then
    replaces the value of the key."""
    for path, node, slot, facts in named_functions(context):
        if slot.role != "callbacks" or not facts.texts or not isinstance(node, Leaf):
            continue
        own = slot.name in {word.text for word in facts.writes}
        if own and slot.name in {key.name for key in node.outputs}:
            first = facts.texts[0]
            yield Finding(
                span=first.span,
                message=f"`{facts.word.text}`, the function of {slot_owner(slot, node)}, sets"
                f" `{slot.name}` and then returns the text `{first.text}`",
                arguments=(slot.name, slot.code.text, first.text),
                help="return the value, or decorate the function with `smach.cb_interface`",
                effect=f"the result of the function replaces the value: `{slot.name}` is then the"
                f" text `{first.text}`",
                related=(*other_place(slot.code.span, "its result is used here"),
                         *calls(node, slot.code.span)),
                node=path,
            )  # fmt: skip


def always_true(context: Context) -> Iterator[Finding]:
    """The conditions whose results are all constants that count as true, such as names of
    outcomes. One number, or `True`, is intended."""
    for path, node, slot, tree in readable_slots(context):
        if not isinstance(tree, ast.Lambda) or slot.quoted or not is_condition(slot):
            continue
        found = results(tree)
        values = [constant.value for constant in found if isinstance(constant, ast.Constant)]
        texts = all(isinstance(value, str) for value in values)
        if len(values) < len(found) or not all(values) or any(value is True for value in values):
            continue
        if texts or len(values) > 1:
            yield _true_condition(path, node, slot, slot.code.span, len(values), texts, tree.body)
    for path, node, slot, facts in named_functions(context):
        if facts.texts and is_condition(slot):
            number = len(facts.texts)
            yield _true_condition(path, node, slot, facts.texts[0].span, number, True, None)


def _true_condition(
    path: str,
    node: Node,
    slot: CodeSlot,
    span: Span,
    number: int,
    texts: bool,
    body: ast.expr | None,
) -> Finding:
    kind = "text" if texts else "constant"
    amount = {1: f"the result is a {kind}, which is", 2: f"both results are {kind}s, which are"}
    words = amount.get(number, f"all results are {kind}s, which are")
    help = "return a comparison, as in `lambda ud: ud.n > 0`"
    if isinstance(body, ast.IfExp):
        test = ast.get_source_segment(slot.code.text, body.test) or ast.unparse(body.test)
        help = f"write `{test}` in place of `{ast.get_source_segment(slot.code.text, body)}`"
    return Finding(
        span=span,
        message=f"the function of {slot_owner(slot, node)} is always true: {words} always true",
        arguments=(slot.name, slot.code.text, "true"),
        help=help,
        effect="the condition is true at each visit: the other outcome never occurs",
        related=calls(node, span),
        node=path,
        severity=Severity.WARNING,
    )

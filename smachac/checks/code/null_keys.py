"""Keys that are null in every run: nothing sets them, and an output that is probably meant for them
is read by nothing (SM311)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import UserdataScope
from smachac.analysis.expression_errors import function_faults
from smachac.analysis.null_guards import excludes_null
from smachac.analysis.type_lattice import NONE, mapping, present
from smachac.analysis.used_keys import sees_everything
from smachac.checks.findings.candidate_keys import may_be, unread_output
from smachac.checks.findings.help_text import other_place
from smachac.checks.findings.value_places import place_of_fault
from smachac.diagnostics.diagnostic import Finding
from smachac.ir.leaf import functions
from smachac.ir.nodes import Container, Leaf, Preset
from smachac.ir.traversal import inputs_from, outcome_names
from smachac.ir.types import ANY, Type


def null_keys(context: Context) -> Iterator[Finding]:
    """The code of states that fails because a key of the type `T?` is always null, where an output
    that nothing reads is probably meant for the key."""
    for path, container in context.containers:
        for preset in container.userdata:
            if preset.value.data is None and preset.type.name == "optional" and not preset.secret:
                yield from _null_key(context, path, container, preset)


def _null_key(
    context: Context, path: str, container: Container, preset: Preset
) -> Iterator[Finding]:
    readers = [*_readers(path, container, preset.key)]
    scope = context.absorbed_flow.scopes.get(path) if readers else None
    if scope is None or not _is_always_null(scope, preset.key):
        return
    unread = unread_output(scope, preset.key)
    if unread is None or not may_be(context.types, scope, unread.key, present(preset.type)):
        return
    for place, leaf, own in readers:
        names: list[tuple[str, Type]] = [(input_.name, ANY) for input_ in leaf.inputs]
        userdata = mapping((name, NONE if name == own else type_) for name, type_ in names)
        codes = [*(functions(leaf, "callbacks") or {}).values()]
        for code in (*codes, *(functions(leaf, "conditions") or {}).values()):
            faults = function_faults(code.text, userdata)
            found = [fault for fault in faults if fault.kind == "operation" and fault.always]
            if not found:
                continue
            called = f"`{own}`" if own == preset.key else f"`{own}` (`{preset.key}` outside)"
            yield Finding(
                span=place_of_fault(code, found[0]),
                message=f"the code of `{leaf.name}` fails: {called} is null in every run, as no"
                " state sets it",
                arguments=(preset.key,),
                help=unread.help,
                related=(
                    *other_place(preset.span, f"`{preset.key}` begins as `null`"),
                    *other_place(unread.place, f"nothing reads `{unread.key}`"),
                ),
                node=place,
            )
            return


def _readers(path: str, container: Container, key: str) -> Iterator[tuple[str, Leaf, str]]:
    """The leaves in a container and in those below it that read a key, with their paths and their
    names for it; none below a container that compares the key with null."""
    for child in container.children:
        below = f"{path}/{child.name}"
        for input_ in inputs_from(child, key):
            if isinstance(child, Leaf):
                yield below, child, input_.name
            elif not _is_compared(child, input_.name):
                yield from _readers(below, child, input_.name)


def _is_compared(container: Container, key: str) -> bool:
    """Whether a state of a container compares a key with null."""
    return any(
        excludes_null(child, key, outcome)
        for child in container.children
        for outcome in outcome_names(child)
    )


def _is_always_null(scope: UserdataScope, key: str) -> bool:
    """Whether nothing sets a key of a container that begins as null, and nothing compares it with
    null."""
    if key in scope.inputs or sees_everything(scope):
        return False
    return key not in scope.uses.written and not _is_compared(scope.container, key)

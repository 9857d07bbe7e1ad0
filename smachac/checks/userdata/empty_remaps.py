"""Remappings of optional keys to a key that nothing sets (SM302): the state works without it.

Some scripts do this on purpose, with a key such as `no_offset`. So a finding needs evidence: a
similar name, a key of a container around, or a value in place of a name.
"""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.empty_remaps import EmptyRemap
from smachac.analysis.unset_reads import container_name, provided_keys
from smachac.checks.edits import listing
from smachac.checks.help_text import calls, did_you_mean, other_place
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.spelling import guesser
from smachac.frontend.text.unquoted import is_name


def empty_remap_findings(context: Context) -> Iterator[Finding]:
    for each in context.empty_remaps:
        key, remap = each.remap.key, each.remap
        help = _help(each)
        if help is None:
            continue
        around = container_name(each.scope, remap.span)
        yield Finding(
            span=remap.to_span,
            message=f"`{key}` of `{each.child.name}` is remapped to `{remap.to}`, which nothing in"
            f" {around} sets",
            arguments=(key, remap.to),
            help=help,
            effect=f"`{each.child.name}` works without `{key}`",
            related=(*_outer_key(context, each), *calls(each.child, remap.span)),
            severity=Severity.WARNING,
            node=f"{each.scope.path}/{each.child.name}",
        )


def _help(each: EmptyRemap) -> str | None:
    remap, container = each.remap, each.scope.container.name
    if not is_name(remap.to):
        return (
            f"a remapping takes the name of a key: set `{remap.key}` in the `userdata` of"
            f" `{container}`, and remove this entry"
        )
    if each.other:
        return listing([each.scope.container], "input_keys", remap.to)
    return did_you_mean(_meant(each))


def meant_by_empty_remaps(context: Context) -> set[tuple[str, str]]:
    """The keys that empty remappings probably mean, each with the path of its container."""
    found = [(each.scope.path, _meant(each)) for each in context.empty_remaps if not each.other]
    return {(path, key) for path, key in found if key is not None}


def _meant(each: EmptyRemap) -> str | None:
    near = guesser(sorted(provided_keys(each.scope).keys))(each.remap.to)
    return near if near is not None else _by_words(each)


ABSENT = frozenset(["no", "none", "nothing", "empty", "zero", "unset", "without", "not"])
"""Words of a name that is unset on purpose."""


def _by_words(each: EmptyRemap) -> str | None:
    """The only key that shares words with the wrong name: one that makes up that name together with
    the remapped key, as `hover` and `offset` do for `hover_offset`, or one that nothing reads."""
    key, words = each.remap.key, set(each.remap.to.split("_"))
    if words & ABSENT:
        return None
    keys = provided_keys(each.scope).keys
    found = [name for name in keys if {*name.split("_"), *key.split("_")} == words]
    if not found:
        read = each.scope.uses.read.union(each.scope.outputs)
        own = words.difference(key.split("_"))
        found = [name for name in keys if name not in read and own & set(name.split("_"))]
    return found[0] if len(found) == 1 else None


def _outer_key(context: Context, each: EmptyRemap) -> Iterator[Related]:
    """The declaration of the key in the container around that has it."""
    if each.other:
        holder = context.corrected_flow.scopes[each.other].container
        for preset in holder.userdata:
            if preset.key == each.remap.to:
                yield from other_place(preset.span, f"`{holder.name}` has it")

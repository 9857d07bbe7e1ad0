"""Loops over a list with one text that is the name of a key: the key itself is meant (SM305,
SM306)."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from smachac.analysis.definite_assignment import UserdataScope
from smachac.checks.edits import listing
from smachac.checks.messages import calls
from smachac.diagnostics.diagnostic import Finding
from smachac.ir import nodes
from smachac.ir.nodes import Container


def is_over_the_word(loop: nodes.Iterator, key: str) -> bool:
    """Whether the items of a loop are a list with one text, the name of a key."""
    return loop.items is not None and loop.items.data == (key,)


def loop_over_the_word(container: Container, key: str) -> nodes.Iterator | None:
    """The loop of a container over a list with one text, the name of a key."""
    for child in container.children:
        if isinstance(child, nodes.Iterator) and is_over_the_word(child, key):
            return child
    return None


def words_as_lists(path: str, loop: nodes.Iterator) -> Iterator[Finding]:
    """The finding on an iterator over the name of one of its input keys, which its state does not
    read."""
    read = {key.name for child in loop.children for key in child.inputs}
    for key in loop.inputs if loop.items is not None and not loop.sugar else ():
        if is_over_the_word(loop, key.name) and key.name not in read:
            yield word_as_list(path, loop, key.name)


def loops_over_names_of_lists(scope: UserdataScope, read: Collection[str]) -> Iterator[Finding]:
    """The findings on loops over one text, which is the name of a list of the userdata that other
    states read."""
    lists = {each.key for each in scope.container.userdata if isinstance(each.value.data, tuple)}
    for key in lists.intersection(read):
        loop = loop_over_the_word(scope.container, key)
        if loop is not None and (loop.sugar or key not in {each.name for each in loop.inputs}):
            yield word_as_list(f"{scope.path}/{loop.name}", loop, key)


def word_as_list(path: str, loop: nodes.Iterator, key: str) -> Finding:
    """The finding on a loop over one text, which is the name of a key."""
    field = "in" if loop.sugar else "it"
    help = f"write `{field}: {key}`"
    if not loop.sugar and key not in {each.name for each in loop.inputs}:
        help += f", and {listing([loop], 'input_keys', key)}"
    return Finding(
        span=loop.items_span,
        message=f"`{loop.name}` runs once, for the text `{key}`, not for the items of the key"
        f" `{key}`",
        arguments=("items", key),
        help=help,
        effect="the state gets the name of the key in place of an item",
        related=calls(loop, loop.items_span),
        node=path,
    )

"""Iterators over a list with one text that is the name of a key: that key is meant (SM306)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.checks.help_text import calls
from smachac.diagnostics.diagnostic import Finding
from smachac.ir import nodes


def words_as_lists(path: str, loop: nodes.Iterator) -> Iterator[Finding]:
    """The finding on an iterator over the name of one of its input keys, which its state does not
    read."""
    read = {key.name for child in loop.children for key in child.inputs}
    for key in loop.inputs if not loop.sugar else ():
        if loop.items is not None and loop.items.data == (key.name,) and key.name not in read:
            yield word_as_list(path, loop, key.name)


def word_as_list(path: str, loop: nodes.Iterator, key: str) -> Finding:
    """The finding on a loop over one text, which is the name of a key."""
    return Finding(
        span=loop.items_span,
        message=f"`{loop.name}` runs once, for the text `{key}`, not for the items of the key"
        f" `{key}`",
        arguments=("items", key),
        help=f"write `it: {key}`",
        effect="the state gets the name of the key in place of an item",
        related=calls(loop, loop.items_span),
        node=path,
    )

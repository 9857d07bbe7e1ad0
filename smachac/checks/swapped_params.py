"""Two params of the call of a sub-script whose values have changed places: the help for a fault in
code that works with one of them (SM311)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from smachac.diagnostics.source import Source, Span
from smachac.frontend.yaml_tree import Map, Scalar, parse
from smachac.ir.nodes import is_number

_PARAMS = re.compile(r"\b(?:params|p):[ ]+(\{[^{}\n]*\})")
"""The params of a state or of a call, on one line."""


def swapped_params_help(places: Iterable[Span], script: Source) -> str | None:
    """The help for the params of a call of the sub-script `script` at which one of these values is
    written: the script itself, or every other call in the file, gives the same params, two of them
    with values of the other kinds."""
    for place in places:
        given = [
            each for each in _params(place.source) if each[0].start <= place.start < each[0].end
        ]
        if len(given) != 1 or place.source is script:
            continue
        span, own = given[0]
        others = [
            each for at, each in _params(place.source) if at != span and each.keys() == own.keys()
        ]
        others = [each for _, each in _params(script) if each.keys() >= own.keys()] or others
        wrong = [name for name in own if others and all(_kind(each[name]) != _kind(own[name])
                 for each in others)]  # fmt: skip
        if len(wrong) != 2:
            continue
        one, two = wrong
        if all(_kind(each[one]) == _kind(own[two]) and _kind(each[two]) == _kind(own[one])
               for each in others):  # fmt: skip
            first, second = own[one].span.text, own[two].span.text
            text = f"{one}: {second}, {two}: {first}"
            return f"write `{text}` in the `params` of the call: the values have changed places"
    return None


def _params(source: Source) -> Iterator[tuple[Span, Mapping[str, Scalar]]]:
    """The params on one line in a text that are single values, with the place of each mapping."""
    for found in _PARAMS.finditer(source.text):
        tree = parse(Source("", found[1]), [])
        if isinstance(tree, Map):
            values = {str(each.key.value): each.value for each in tree.entries}
            scalars = {key: each for key, each in values.items() if isinstance(each, Scalar)}
            if len(scalars) == len(values):
                yield Span(source, *found.span(1)), scalars


def _kind(value: Scalar) -> str:
    """The kind of a single value."""
    if is_number(value.value):
        return "number"
    return type(value.value).__name__

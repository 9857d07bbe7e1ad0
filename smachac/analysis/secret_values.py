"""Values of secret keys that the script contains."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.type_inference import TypeFlow, Types
from smachac.diagnostics.source import Span
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.secret_keys import SecretKeys


def secret_values(types: Types, secret: SecretKeys) -> Iterator[TypeFlow]:
    """The literals that reach secret keys, each once, where it is written.

    Code is no literal, and neither are null, true, false and the empty text.
    """
    found: set[Span] = set()
    for (path, key), cell in types.cells.items():
        if key not in secret.get(path, ()):
            continue
        for flow in (flow for flows in cell.flows.values() for flow in flows):
            origin = flow.origin
            if origin.how == "value" and _is_value(origin.value) and origin.span not in found:
                found.add(origin.span)
                yield origin


def _is_value(data: Data) -> bool:
    """Whether a literal contains a text or a number."""
    match data:
        case None | bool() | Expression():
            return False
        case Struct(entries=entries):
            return any(_is_value(value) for _, value in entries)
        case tuple():
            return any(_is_value(value) for value in data)
    return data != ""

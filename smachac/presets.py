"""What containers hold before they run: their own `userdata`, and that of the leaves in them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from smachac import shapes
from smachac.ir.nodes import Given, Preset
from smachac.ir.types import ANY, parse_type
from smachac.script import State
from smachac.syntax import Map, Scalar
from smachac.typed import is_long_form
from smachac.values import as_value


def presets(state: State) -> tuple[Preset, ...]:
    """The userdata of a container. Of several values for a key the last one counts."""
    found: dict[str, Preset] = {}
    given: dict[str, list[Given]] = {}
    for each in (state, *(child for child in state.states if child.owner == "state")):
        for preset in _own(each):
            found[preset.key] = preset
            given.setdefault(preset.key, []).append(
                Given(each.name, preset.value, preset.span, each is state)
            )
    return tuple(
        replace(preset, given=tuple(given[key])) if len(given[key]) > 1 else preset
        for key, preset in found.items()
    )


def _own(state: State) -> Iterator[Preset]:
    """Userdata in the short form `key: value` or the long one `key: {type: T, value: V}`."""
    entry = state.fields.get("userdata")
    for each in shapes.as_map(entry.value, []) if entry is not None else ():
        value, type_ = each.value, ANY
        if isinstance(value, Map) and is_long_form(value):
            inner = {item.key.value: item.value for item in value.entries}
            named = inner.get("type")
            if isinstance(named, Scalar) and isinstance(named.value, str):
                type_ = parse_type(named.value) or ANY
            value = inner["value"]
        yield Preset(key=str(each.key.value), value=as_value(value), type=type_, span=each.key.span)

"""Facts about the states of a text that hold also while it is half-typed: outcomes, keys, types.

They come from the tree of the text, the interfaces of state types and the sub-scripts it calls.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.diagnostics.source import Source
from smachac.frontend.loader import Library
from smachac.frontend.resolved_script import EXHAUSTED, TIMEOUT
from smachac.frontend.schema import CONTAINERS
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import StateType
from smachac.lsp.place import Body, top_bodies

MOST_CALLS = 20
"""The most calls of sub-scripts, one in the other, that are followed."""


class Facts:
    """The facts of one text. State types and sub-scripts are read once."""

    def __init__(self, library: Library, caller: str, known: Mapping[str, StateType]) -> None:
        self.library = library
        self.caller = caller
        self.types: dict[str, StateType | None] = dict(known)

    def type_named(self, name: str) -> StateType | None:
        """The state type of a name, read at its first use."""
        if name not in self.types:
            named = name and name not in CONTAINERS
            self.types[name] = find_state_type(name, self.library, []) if named else None
        return self.types[name]

    def called(self, body: Body) -> Body:
        """The state of the sub-script that a state calls, with the fields of the call over it; the
        state itself if it calls none."""
        caller = self.caller
        for _ in range(MOST_CALLS):
            name = body.text("script")
            found = self.sub_script(name, caller) if name else None
            if found is None:
                return body
            source, inner = found
            own = {key: entry for key, entry in body.fields.items() if key != "script"}
            body = Body(name=body.name, fields={**inner.fields, **own}, start=body.start,
                        end=body.end)  # fmt: skip
            caller = source.name
        return body

    def sub_script(self, name: str, caller: str) -> tuple[Source, Body] | None:
        """The text of a sub-script and its state."""
        source = self.library.script(name, caller)
        tree = self.library.parse(source, []) if source is not None else None
        bodies = top_bodies(tree)
        return (source, bodies[0]) if source is not None and bodies else None

    def outcomes(self, body: Body) -> list[str]:
        """The outcomes that a state can end with."""
        body = self.called(body)
        found = self._own_outcomes(body)
        if "retry" in body.fields:
            found.append(EXHAUSTED)
        type_ = self.type_named(body.template)
        if "timeout" in body.fields and (type_ is None or TIMEOUT not in type_.variables):
            found.append(TIMEOUT)
        return list(dict.fromkeys(found))

    def _own_outcomes(self, body: Body) -> list[str]:
        declared = body.names("outcomes")
        if body.owner == "Iterator":
            return [*declared, *([body.text("exhausted_outcome")] if not declared else [])]
        type_ = self.type_named(body.template)
        if type_ is None:
            return declared
        default = body.text("default_outcome")
        optional = type_.optional
        fixed = [outcome.name for outcome in type_.outcomes if outcome.name not in optional]
        rest = [outcome.name for outcome in type_.outcomes if outcome.name in optional]
        return [*declared, *([default] if default else []), *fixed, *rest]

    def inputs(self, body: Body) -> list[str]:
        """The names of the keys that a state reads."""
        return self._keys(body, "input_keys")

    def outputs(self, body: Body) -> list[str]:
        """The names of the keys that a state writes."""
        return self._keys(body, "output_keys")

    def _keys(self, body: Body, part: str) -> list[str]:
        body = self.called(body)
        type_ = self.type_named(body.template)
        known = () if type_ is None else (
            type_.input_keys if part == "input_keys" else type_.output_keys
        )  # fmt: skip
        return list(dict.fromkeys([*body.names(part), *(key.name for key in known)]))

    def outer_keys(self, child: Body) -> Iterator[tuple[str, bool]]:
        """The keys of the container around a state that the state uses, and whether it writes
        them."""
        renamed = {**self.called(child).pairs("remapping"), **child.pairs("remapping")}
        for key in self.inputs(child):
            yield renamed.get(key, key), False
        for key in self.outputs(child):
            yield renamed.get(key, key), True
        for key in child.names("userdata") if not child.states else ():
            yield key, True

    def keys_in(self, container: Body) -> dict[str, int]:
        """The keys of a container, with the number of their uses in it."""
        found = dict.fromkeys(
            [
                *container.names("userdata"),
                *container.names("input_keys"),
                *container.names("output_keys"),
            ],
            0,
        )
        if container.owner == "Iterator":
            found.setdefault(container.text("it_label") or "it_data", 0)
            if container.text("it"):
                found.setdefault(container.text("it"), 0)
        for child in container.states:
            for key, _ in self.outer_keys(child):
                found[key] = found.get(key, 0) + 1
        return found

    def params(self, bodies: tuple[Body, ...]) -> list[str]:
        """The params in scope of a state, inner ones first."""
        found: list[str] = []
        for body in reversed(bodies):
            found += body.names("params")
        return list(dict.fromkeys(found))

    def variables_of(self, body: Body) -> list[str]:
        """The names of the variables of a state's type."""
        type_ = self.type_named(body.template)
        return list(type_.variables) if type_ is not None else []

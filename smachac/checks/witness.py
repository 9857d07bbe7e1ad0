"""Paths on which a key is read though nothing has set it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from smachac.checks.missing import Missing
from smachac.ir.dataflow import Flow, Scope
from smachac.ir.graph import Place
from smachac.ir.keypaths import Reached, Search, search, way_to
from smachac.ir.keyuses import place_of
from smachac.ir.nodes import Node
from smachac.ir.userdata import remapping
from smachac.source import Span

MOST_STEPS = 250_000
"""Steps of all searches for one rule: beyond that findings come without a path, so that ten
thousand faults take no longer than they should."""


class Witness(NamedTuple):
    """A place of a container that finds a key unset.

    `always`: whichever way it is entered. `inner` is what reads it in the end, where the place is a
    container. `also` are more such places.
    """

    reader: Reader
    always: bool
    inner: Reader | None
    path: tuple[str, ...]
    also: tuple[Place, ...] = ()


@dataclass(slots=True)
class Searches:
    """Searches for witnesses as long as there are steps left."""

    flow: Flow
    left: int = MOST_STEPS

    def witnesses(self, missing: Missing) -> Iterator[Witness]:
        """Each place that is the first to find the key unset on some path.

        One for all where nothing sets the key, as that is one fault.
        """
        scope, nothing_sets = missing.scope, missing.cause != "unset"
        if self.left <= 0:
            reader = reader_at(scope, missing.places[0], missing.key)
            yield Witness(reader, nothing_sets, None, ())
            return
        found = self._search(scope, missing.key)
        unset = [
            each.place
            for each in found
            if each.state == "unset" and missing.key in scope.reads.get(each.place, ())
        ]
        for place in unset[:1] if nothing_sets else unset:
            inner, inside, always = self._inside(scope, place, missing.key)
            yield Witness(
                reader_at(scope, place, missing.key),
                always and Reached(place, "set") not in found,
                inner,
                tuple(way_to(found, Reached(place, "unset")) + inside),
                tuple(each for each in missing.places if each != place) if nothing_sets else (),
            )

    def _search(self, scope: Scope, key: str) -> Search:
        found = search(self.flow, scope, key, ["unset"], stops=True)
        self.left -= len(scope.reads) + len(found)
        return found

    def _inside(
        self, scope: Scope, place: Place, key: str
    ) -> tuple[Reader | None, list[str], bool]:
        """What reads the key inside a container, the way to it there, and whether it never finds
        the key."""
        way: list[str] = []
        always, outermost = True, scope
        while place in scope.inner and self.left > 0:
            scope = self.flow.scopes[f"{scope.path}/{place}"]
            key = next(own for own, to in scope.inputs.items() if to == key and own in scope.needed)
            found = self._search(scope, key)
            place = next(
                each.place
                for each in found
                if each.state == "unset" and key in scope.reads.get(each.place, ())
            )
            always = always and Reached(place, "set") not in found
            way += way_to(found, Reached(place, "unset"))
        inner = reader_at(scope, place, key) if scope is not outermost else None
        return inner, way, always


class Reader(NamedTuple):
    """A state that needs a key of its container, where the script says so, and in words."""

    path: str
    node: Node
    span: Span
    words: str


def container_name(scope: Scope, span: Span) -> str:
    """What a finding calls a container: a sub-script has another name at each call, and a fault
    in it is one fault."""
    is_called = scope.container.span.source is not span.source
    return "the sub-script" if is_called else f"`{scope.container.name}`"


def reader_at(scope: Scope, place: Place, key: str) -> Reader:
    """The state at a place of a container; the container itself where that is its start."""
    node: Node = scope.container
    if not isinstance(place, str):
        return Reader(scope.path, node, node.span, f"`{node.name}` goes through `{key}`")
    node = scope.children[place]
    names = remapping(node)
    own = next((each for each in node.inputs if names.get(each.name, each.name) == key), None)
    span = node.span if own is None else place_of(node, own)
    called = f"`{key}`"
    if own is not None and own.name != key:
        called = f"`{own.name}` (`{key}` of {container_name(scope, span)})"
    return Reader(f"{scope.path}/{place}", node, span, f"`{node.name}` reads {called}")

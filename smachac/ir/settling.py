"""One type for each place, once all that arrives there is known."""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

from smachac.ir.joining import joined, meet, settled
from smachac.ir.places import Place
from smachac.ir.types import ANY, Type


def key_types(places: list[Place]) -> dict[int, Type]:
    """The type of each place by `id`. Linked places without a declaration have one type."""
    groups = Groups()
    for place in places:
        for link in place.links:
            if place.declared == ANY and link.declared == ANY:
                groups.unite(id(place), id(link))
    read = _read(places, groups)
    written: dict[int, set[Type]] = {}
    for place in places:
        fresh = (alike[0].type for alike in place.flows.values() if not alike[0].judged)
        written.setdefault(groups.of(id(place)), set()).update(fresh)
    types = {
        group: settled(joined(found), _common(read.get(group, ())))
        for group, found in written.items()
    }
    return {
        id(place): types[groups.of(id(place))] if place.declared == ANY else place.declared
        for place in places
    }


def _read(places: list[Place], groups: Groups) -> dict[int, set[Type]]:
    """What the readers of each group ask for; those of an item ask for a list of such."""
    read: dict[int, set[Type]] = {}
    for place in places:
        wanted = (link.declared for link in place.links if link.declared != ANY)
        read.setdefault(groups.of(id(place)), set()).update(wanted)
    for place in places:
        for code in place.readers:
            if code.items and code.expression is None:
                item = code.place.declared
                if item == ANY:
                    item = _common(read.get(groups.of(id(code.place)), ()))
                if item != ANY:
                    read[groups.of(id(place))].add(Type("list", (item,)))
    return read


def _common(types: Iterable[Type]) -> Type:
    """The type that can be read as all of these; `any` where there is none."""
    return reduce(meet, sorted(types, key=repr), ANY)


class Groups:
    """Sets that are united step by step; each has one member that stands for it."""

    def __init__(self) -> None:
        self.parent: dict[int, int] = {}

    def of(self, member: int) -> int:
        root = member
        while (above := self.parent.get(root, root)) != root:
            root = above
        while member != root:
            self.parent[member], member = root, self.parent[member]
        return root

    def unite(self, one: int, other: int) -> None:
        self.parent[self.of(one)] = self.of(other)

"""The bodies that states load into the simulated world, and whether that can be before a state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from smachac.analysis.successors import Routes
from smachac.ir.graph import Event
from smachac.ir.leaf import variable
from smachac.ir.nodes import Concurrence, Leaf, Node
from smachac.ir.outcome_names import fails
from smachac.ir.traversal import outcome_names

MOST_VISITS = 500_000
"""The most events that the searches of one machine visit; beyond them nothing more is found."""


def bodies_loaded(states: Iterable[tuple[str, Node]]) -> Mapping[str, str] | None:
    """The states that load a body, each with its name; None where code of the user may load some,
    or the name of one is computed."""
    found: dict[str, str] = {}
    for path, node in states:
        if isinstance(node, Leaf) and node.adds_frames != ():
            given = (variable(node, name) for name in node.adds_frames or ())
            body = next((value for value in given if value), None)
            if not isinstance(body, str):
                return None
            found.setdefault(path, body)
    return found


class LoadingOrder:
    """Which states can run before the body that they use is loaded, and never after it."""

    def __init__(self, routes: Routes, loading: Mapping[str, str]) -> None:
        self._routes = routes
        self._loaders: dict[str, list[str]] = {}
        for path, body in loading.items():
            if (path, "") in routes.before:
                self._loaders.setdefault(body, []).append(path)
        self._after: dict[str, set[Event]] = {}
        self._visits = 0

    def loaded_later(self, path: str, body: str) -> str | None:
        """The first state that loads a body which is not there at any entry of a state; None where
        a path loads it before, or nothing loads it.

        A state that leads to the loading state when it fails can be meant as a test for the body.
        """
        loaders = self._loaders.get(body, [])
        if not loaders or (path, "") not in self._routes.before:
            return None
        if body not in self._after:
            self._after[body] = self._reached(self._loaded(loaders))
        node = self._routes.nodes[path]
        failed = [(path, name) for name in outcome_names(node) if fails(node, name)]
        if (path, "") in self._after[body] or self._visits > MOST_VISITS:
            return None
        tested = self._reached(failed)
        late = self._visits <= MOST_VISITS and not any((loader, "") in tested for loader in loaders)
        return loaders[0] if late else None

    def _loaded(self, loaders: Iterable[str]) -> Iterator[Event]:
        """The events after which a body may be loaded. In a concurrence it may be loaded while the
        other children run."""
        for path in loaders:
            node = self._routes.nodes[path]
            yield from ((path, name) for name in outcome_names(node) if not fails(node, name))
            while (path := path.rpartition("/")[0]) in self._routes.nodes:
                around = self._routes.nodes[path]
                if isinstance(around, Concurrence):
                    yield from ((f"{path}/{child.name}", "") for child in around.children)
                    yield from ((path, name) for name in outcome_names(around))

    def _reached(self, starts: Iterable[Event]) -> set[Event]:
        """Some events, and those that can follow."""
        found = set(starts)
        todo = list(found)
        while todo and self._visits <= MOST_VISITS:
            self._visits += 1
            for event in self._routes.after(todo.pop()):
                if event not in found:
                    found.add(event)
                    todo.append(event)
        return found

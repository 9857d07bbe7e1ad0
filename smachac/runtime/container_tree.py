"""Containers and those below them: paths, active states, and userdata as a pickle."""

from __future__ import annotations

import base64
import pickle
from collections.abc import Iterator

from smachac.runtime.smach import UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach.user_data import store

PROTOCOL = 2
"""The pickle protocol of userdata; SMACH's viewer reads it, in Python 2 too."""


def containers(path: str, container: Container) -> Iterator[tuple[str, Container]]:
    """A container and those below it, each with its path."""
    pending = [(path, container)]
    while pending:
        path, container = pending.pop(0)
        yield path, container
        for label, child in container.get_children().items():
            if isinstance(child, Container):
                pending.append((f"{path.rstrip('/')}/{label}", child))


def active_paths(path: str, container: Container) -> list[str]:
    """The paths of the states that run now: one, or one for each branch of a concurrence."""
    children = container.get_children()
    found = []
    for label in container.get_active_states():
        child = children.get(label)
        below = f"{path.rstrip('/')}/{label}"
        inner = active_paths(below, child) if isinstance(child, Container) else []
        found += inner or ([below] if child is not None else [])
    return found


def pickled(userdata: UserData) -> str:
    """The userdata in the format of SMACH's viewer; the `repr` of values that cannot be pickled."""
    held = dict(store(userdata))
    try:
        data = pickle.dumps(held, PROTOCOL)
    except Exception:
        data = pickle.dumps({key: _picklable(value) for key, value in held.items()}, PROTOCOL)
    return base64.b64encode(data).decode("ascii")


def _picklable(value: object) -> object:
    try:
        pickle.dumps(value, PROTOCOL)
    except Exception:
        return repr(value)
    return value

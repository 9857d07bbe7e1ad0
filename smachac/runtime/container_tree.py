"""Containers and those below them: paths, active states, outcomes, and userdata as a pickle and as
JSON."""

from __future__ import annotations

import base64
import pickle
from collections.abc import Iterator
from itertools import islice
from typing import Any

from smachac.runtime.smach import UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach.user_data import store
from smachac.runtime.tracing.values import shown_value

PROTOCOL = 2
"""The pickle protocol of userdata; SMACH's viewer reads it, in Python 2 too."""

MOST_KEYS = 100
"""The most keys of one container in a status."""


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


def status_fields(path: str, container: Container, info: str) -> dict[str, Any]:
    """The fields of a status of smach_msgs."""
    return {
        "path": path,
        "initial_states": [str(label) for label in container.get_initial_states()],
        "active_states": [str(label) for label in container.get_active_states()],
        "local_data": pickled(container.userdata),
        "info": info,
    }


def more_status(container: Container) -> dict[str, Any]:
    """What a status as JSON has beside the fields of smach_msgs: the outcomes of the states that
    have ended, and the values of keys, cut to a limited size."""
    held = islice(dict(store(container.userdata)).items(), MOST_KEYS)
    return {
        "ended": container.get_child_outcomes(),
        "userdata": {str(key): shown_value(value) for key, value in held},
    }


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

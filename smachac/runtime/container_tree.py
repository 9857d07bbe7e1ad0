"""Containers and those below them: paths, active states, outcomes, and userdata as a pickle and as
JSON."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from itertools import islice
from typing import Any

from smachac.runtime import smach
from smachac.runtime.plain_pickle import plain_value
from smachac.runtime.smach import UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach.user_data import store
from smachac.runtime.tracing.values import shown_value

PROTOCOL = 2
"""The pickle protocol of userdata on ROS 1: SMACH's viewer reads it, in Python 2 too."""

NEW_PROTOCOL = 4
"""The pickle protocol of userdata on ROS 2; bytes and sets in it are plain values."""

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


def status_fields(path: str, container: Container, info: str, protocol: int) -> dict[str, Any]:
    """The fields of a status of smach_msgs."""
    return {
        "path": path,
        "initial_states": [str(label) for label in container.get_initial_states()],
        "active_states": [str(label) for label in container.get_active_states()],
        "local_data": pickled(container.userdata, protocol),
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


def pickled(userdata: UserData, protocol: int) -> bytes:
    """The pickle of the userdata as a dict; the `repr` of values that cannot be pickled."""
    held = dict(store(userdata))
    try:
        return pickle.dumps(held, protocol)
    except Exception:
        return pickle.dumps(
            {key: _picklable(value, protocol) for key, value in held.items()}, protocol
        )


def received_userdata(path: str, data: bytes, unpickle: bool) -> UserData:
    """The userdata of a command to a container, from its pickle.

    Only plain values are accepted, unless `unpickle` is true. Userdata that cannot be read is
    dropped, and the log contains the reason.
    """
    userdata = UserData()
    try:
        held = (pickle.loads(data) if unpickle else plain_value(data)) if data else {}
        if not isinstance(held, dict):
            raise TypeError("it is no dictionary")
    except Exception as error:  # a pickle raises what it likes
        smach.logwarn(f"the userdata of a command to container '{path}' is dropped: {error}")
        return userdata
    store(userdata).update({str(key): value for key, value in held.items()})
    return userdata


def _picklable(value: object, protocol: int) -> object:
    try:
        pickle.dumps(value, protocol)
    except Exception:
        return repr(value)
    return value

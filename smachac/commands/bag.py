"""Bags of rosbag2, and the statuses of machines in them. The package rosbags reads them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from smachac.runtime.tracing.writer import LONGEST_LINE
from smachac.verify.status_conformance import Status, in_order, status_of

TOPIC, JSON_TOPIC = "/smach/container_status", "/smach/container_status_json"
"""The ends of the topics with statuses: messages of smach_msgs, JSON texts."""

STATUS_TYPE = "smach_msgs/msg/SmachContainerStatus"
STATUS_FIELDS = (
    "std_msgs/Header header\nstring path\nstring[] initial_states\nstring[] active_states\n"
    "uint8[] local_data\nstring info\n"
)

NO_TOPIC = (
    f"it has no topic that ends with `{JSON_TOPIC}` or `{TOPIC}`; record that topic of a program"
    " that is built with `--option introspection=yes`"
)


class BagError(Exception):
    """A bag cannot be read; the message gives the reason."""


def is_bag(path: Path) -> bool:
    """Whether a path is that of a bag: a folder, or one of its files."""
    return path.suffix in (".db3", ".mcap") or path.is_dir()


def read_statuses(path: Path) -> dict[str, list[Status]]:
    """The statuses in a bag, in the order of their time, by topic. Raises BagError."""
    if path.is_dir() and not (path / "metadata.yaml").is_file():
        raise BagError("it is a folder without metadata.yaml, so no bag of rosbag2")
    try:
        from rosbags.rosbag2 import Reader
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    except ImportError:
        raise BagError("bags need the package rosbags: pip install 'smachac[bags]'") from None
    types = get_typestore(Stores.LATEST)
    types.register(get_types_from_msg(STATUS_FIELDS, STATUS_TYPE))
    found: dict[str, list[Status]] = {}
    try:
        with Reader(path) as reader:
            wanted = [
                each for each in reader.connections if each.topic.endswith((TOPIC, JSON_TOPIC))
            ]
            for connection, _, data in reader.messages(wanted) if wanted else ():
                message = types.deserialize_cdr(data, connection.msgtype)
                status = _status(message)
                found.setdefault(connection.topic, []).extend([status] if status else [])
    except BagError:
        raise
    except Exception as error:  # of rosbags, of its storages, and of the messages
        reason = " ".join(str(error).split()) or type(error).__name__
        raise BagError(f"it is broken: {reason}") from None
    if not found:
        raise BagError(NO_TOPIC)
    return {topic: in_order(statuses) for topic, statuses in found.items()}


def _status(message: Any) -> Status | None:
    """The status in a message; None if no change has caused it. Raises BagError."""
    text = message.data if hasattr(message, "data") else message.info
    if len(text) > LONGEST_LINE:
        raise BagError(f"a status in it has more than {LONGEST_LINE:,} characters")
    if hasattr(message, "data"):
        fields = json.loads(message.data)
        return status_of(fields, float(fields["stamp"]))
    stamp = message.header.stamp
    return status_of(vars(message), stamp.sec + stamp.nanosec * 1e-9)

"""Bags of rosbag2, written with the package rosbags."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

TEXT_TYPE = "std_msgs/msg/String"


def text_message(text: str) -> bytes:
    """A std_msgs/String as it is on the wire."""
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.LATEST)
    return bytes(types.serialize_cdr(types.types[TEXT_TYPE](data=text), TEXT_TYPE))


def write_bag(
    folder: Path,
    storage: str,
    messages: Mapping[tuple[str, str], Sequence[bytes]],
    definition: str = "",
) -> None:
    """Write a bag with messages by topic and type; `definition` are the fields of types that ROS
    does not have itself."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    types = get_typestore(Stores.LATEST)
    with Writer(folder, version=9, storage_plugin=StoragePlugin[storage.upper()]) as bag:
        for (topic, kind), content in messages.items():
            if kind not in types.types:
                types.register(get_types_from_msg(definition, kind))
            connection = bag.add_connection(topic, kind, typestore=types)
            for at, data in enumerate(content):
                bag.write(connection, at, data)

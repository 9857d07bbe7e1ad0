"""Bags of rosbag2, and the statuses of machines in them. The package rosbags reads them."""

from __future__ import annotations

import json
import re
from contextlib import suppress
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

LARGEST_RECORD = 2**30
"""Bytes of the largest record of a damaged file .mcap that is read."""

NO_TOPIC = (
    f"it has no topic that ends with `{JSON_TOPIC}` or `{TOPIC}`; record that topic of a program"
    " that is built with `--option introspection=yes`"
)


class BagError(Exception):
    """A bag cannot be read; the message gives the reason."""


def is_bag(path: Path) -> bool:
    """Whether a path is that of a bag: a folder, or one of its files."""
    return path.suffix in (".db3", ".mcap") or path.is_dir()


Messages = dict[str, list[tuple[str, bytes]]]
"""The type and the serialized data of each message, by topic."""


def read_statuses(path: Path) -> tuple[dict[str, list[Status]], list[str]]:
    """The statuses in a bag, in the order of their time, by topic; and notes on what was not read.

    A bag whose recorder was killed is read as far as it goes. Raises BagError.
    """
    try:
        import rosbags.rosbag2  # noqa: F401
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    except ImportError:
        raise BagError("bags need the package rosbags: pip install 'smachac[bags]'") from None
    notes: list[str] = []
    topics = _messages(path, notes)
    if not topics:
        raise BagError(NO_TOPIC)
    types = get_typestore(Stores.LATEST)
    types.register(get_types_from_msg(STATUS_FIELDS, STATUS_TYPE))
    found: dict[str, list[Status]] = {}
    try:
        for topic, messages in topics.items():
            if messages:
                statuses = [_status(types.deserialize_cdr(data, kind)) for kind, data in messages]
                found[topic] = in_order([status for status in statuses if status])
    except BagError:
        raise
    except Exception as error:  # of rosbags, and of the texts
        raise BagError(f"it is broken: {_reason(error)}") from None
    if not found:
        names = ", ".join(f"`{topic}`" for topic in topics)
        raise BagError(f"there are no messages on {names}")
    return found, notes


def _messages(path: Path, notes: list[str]) -> Messages:
    """The messages on the topics with statuses. If metadata.yaml cannot be used the files are read
    one by one; a file .mcap is read up to its first damage. Raises BagError."""
    from rosbags.rosbag2 import Reader

    for log in sorted(path.glob("*.db3-wal") if path.is_dir() else [Path(f"{path}-wal")]):
        if log.is_file() and log.stat().st_size:
            file = log.name.removesuffix("-wal")
            notes.append(
                f"the last messages may be in {log.name}, which is not read; this moves them into "
                f"{file}: sqlite3 {file} 'PRAGMA wal_checkpoint(TRUNCATE)'"
            )
    found: Messages = {}
    try:
        with Reader(path) as reader:
            wanted = [
                connection for connection in reader.connections if _has_statuses(connection.topic)
            ]
            found = {connection.topic: [] for connection in wanted}
            for connection, _, data in reader.messages(wanted) if wanted else ():
                found[connection.topic].append((connection.msgtype, data))
    except Exception as error:  # of rosbags and its storages
        reason = _reason(error)
    else:
        return found
    if path.is_dir():
        return _messages_of_files(path, reason, notes)
    if path.suffix == ".mcap" and (found := _undamaged(path)):
        count = sum(map(len, found.values()))
        notes.append(
            f"{path.name} is damaged ({reason}): the {count} statuses before the damage are read; "
            f"this may find more: mcap recover {path.name} -o new.mcap"
        )
        return found
    way_out = {
        ".mcap": f"mcap recover {path.name} -o new.mcap",
        ".db3": f"sqlite3 {path.name} .recover | sqlite3 new.db3",
    }[path.suffix]
    raise BagError(f"it is broken: {reason}; this may save what is left: {way_out}")


def _messages_of_files(folder: Path, reason: str, notes: list[str]) -> Messages:
    """The messages in the files of a folder whose metadata.yaml cannot be used."""
    files = sorted(
        (path for path in folder.iterdir() if path.is_file() and is_bag(path)),
        key=lambda file: [part.zfill(20) for part in re.split(r"(\d+)", file.name)],
    )
    is_missing = not (folder / "metadata.yaml").is_file()
    if not files:
        what = "a folder without metadata.yaml, so no bag of rosbag2" if is_missing else ""
        raise BagError(f"it is {what or f'broken: {reason}'}")
    notes.append(
        f"metadata.yaml {'is missing' if is_missing else f'cannot be used ({reason})'}: the files "
        f"are read one by one; this writes it: ros2 bag reindex {folder.name}"
    )
    found: Messages = {}
    for file in files:
        for topic, messages in _messages(file, notes).items():
            found.setdefault(topic, []).extend(messages)
    return found


def _undamaged(path: Path) -> Messages:
    """The messages in a file .mcap up to its first damage; none without the package mcap."""
    try:
        from mcap.records import Channel, Message, Schema
        from mcap.stream_reader import StreamReader
    except ImportError:
        return {}
    found: Messages = {}
    kinds: dict[int, str] = {}
    channels: dict[int, tuple[str, str]] = {}
    with path.open("rb") as stream, suppress(Exception):
        for record in StreamReader(stream, record_size_limit=LARGEST_RECORD).records:
            if isinstance(record, Schema):
                kinds[record.id] = record.name
            elif isinstance(record, Channel) and _has_statuses(record.topic):
                channels[record.id] = record.topic, kinds[record.schema_id]
                found.setdefault(record.topic, [])
            elif isinstance(record, Message) and record.channel_id in channels:
                topic, kind = channels[record.channel_id]
                found[topic].append((kind, record.data))
    return found


def _has_statuses(topic: str) -> bool:
    return topic.endswith((TOPIC, JSON_TOPIC))


def _reason(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__


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

"""`smachac trace check` of bags of rosbag2: the topics that it reads, and bags that it cannot."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from smachac.commands.bag import STATUS_FIELDS, STATUS_TYPE
from smachac.commands.cli import main
from tests.support.bags import TEXT_TYPE, text_message, write_bag

pytest.importorskip("rosbags")

SCRIPT = """\
name: sm
outcomes: [done, lost]
states:
  - A: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: B, bad: lost}}
  - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""
TOPIC = "/robot_1/sm/smach/container_status_json"
RUN = (
    ("None", "Initial state"),
    ("A", "(['A'],)"),
    ("A", "HEARTBEAT"),
    ("B", "(['B'],)"),
    ("None", "(['B'], 'done')"),
)
"""The active state and the `info` of each status of a run."""


def texts(run: tuple[tuple[str, str], ...] = RUN, path: str = "/sm") -> list[bytes]:
    """The messages of a run, as JSON texts."""
    return [
        text_message(
            json.dumps({"stamp": 10.0 + at, "path": path, "active_states": [active], "info": info})
        )
        for at, (active, info) in enumerate(run)
    ]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with the script."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.yml").write_text(SCRIPT, "utf-8")
    return tmp_path


ALLOWED = (
    "1 trace, all allowed\n2 of 3 transitions taken (66 %)\n"
    "  not taken: sm/A: bad -> sm:lost  (main.yml:4)\n"
)


@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
def test_a_run_is_allowed(storage: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_bag(folder / "bag", storage, {(TOPIC, TEXT_TYPE): texts()})
    assert main(["trace", "check", "main.yml", "bag"]) == 0
    assert capsys.readouterr().out == "bag: 3 events, ended with `done`\n" + ALLOWED
    suffix = {"sqlite3": "db3", "mcap": "mcap"}[storage]
    assert main(["trace", "check", "main.yml", f"bag/bag.{suffix}"]) == 0
    assert capsys.readouterr().out.endswith(ALLOWED)


def test_a_run_that_is_not_allowed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = (*RUN[:2], ("None", "(['A'], 'done')"))
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): texts(run)})
    assert main(["trace", "check", "main.yml", "bag"]) == 1
    assert capsys.readouterr().out.startswith(
        "bag:2: no outcome of `sm/A` leads to `sm:done` (main.yml:4)\n1 trace, 1 not allowed\n"
    )


def test_messages_of_smach_msgs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    types = get_typestore(Stores.LATEST)
    types.register(get_types_from_msg(STATUS_FIELDS, STATUS_TYPE))
    import numpy

    made = []
    for at, (active, info) in enumerate(RUN):
        header = types.types["std_msgs/msg/Header"](
            stamp=types.types["builtin_interfaces/msg/Time"](sec=at, nanosec=0), frame_id=""
        )
        message = types.types[STATUS_TYPE](
            header=header, path="/sm", initial_states=["A"], active_states=[active],
            local_data=numpy.zeros(0, numpy.uint8), info=info,
        )  # fmt: skip
        made.append(bytes(types.serialize_cdr(message, STATUS_TYPE)))
    topic = "/sm/smach/container_status"
    write_bag(folder / "bag", "sqlite3", {(topic, STATUS_TYPE): made}, STATUS_FIELDS)
    assert main(["trace", "check", "main.yml", "bag"]) == 0
    assert capsys.readouterr().out == "bag: 3 events, ended with `done`\n" + ALLOWED


def test_each_node_is_a_trace(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = TOPIC.replace("robot_1", "robot_2")
    elsewhere = TOPIC.replace("sm", "fetch", 1)
    found = {
        (TOPIC, TEXT_TYPE): texts(),
        (other, TEXT_TYPE): texts(RUN[:2]),
        (elsewhere, TEXT_TYPE): texts(path="/fetch"),
    }
    write_bag(folder / "bag", "mcap", found)
    assert main(["trace", "check", "main.yml", "bag"]) == 0
    assert capsys.readouterr().out.splitlines()[:3] == [
        f"bag ({TOPIC}): 3 events, ended with `done`",
        f"bag ({other}): 1 events, has not ended",
        "2 traces, all allowed",
    ]


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The message of a command that ends with exit code 2."""
    assert main(arguments) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    (line,) = shown.err.splitlines()
    return line


def test_a_bag_without_the_topic(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_bag(folder / "bag", "mcap", {("/chatter", TEXT_TYPE): texts()})
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert "the trace bag cannot be read: it has no topic that ends with" in line
    assert "--option introspection=yes" in line


def test_a_bag_of_another_machine(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): texts(path="/fetch")})
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert line.endswith("cannot be read: it reports on `/fetch`, not on `/sm`")


@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
@pytest.mark.parametrize("length", [0, 20, 700])
def test_a_broken_bag(
    length: int, storage: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", storage, {(TOPIC, TEXT_TYPE): texts()})
    (data,) = (path for path in (folder / "bag").iterdir() if path.suffix != ".yaml")
    data.write_bytes(data.read_bytes()[:length])
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert "the trace bag cannot be read: it is broken: " in line


def allowed(capsys: pytest.CaptureFixture[str], bag: str = "bag") -> str:
    """The notes of a check of a bag with one allowed run."""
    assert main(["trace", "check", "main.yml", bag]) == 0
    shown = capsys.readouterr()
    assert shown.out.endswith(ALLOWED)
    return shown.err


KILLED = """\
rosbag2_bagfile_information:
  version: 9
  storage_identifier: ""
  relative_file_paths: []
  topics_with_message_count: []
"""
"""What rosbag2 has written when it begins to record."""


@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
@pytest.mark.parametrize(
    "text", ["", "[", "{}", "rosbag2_bagfile_information: {version: 5}", KILLED, None]
)
def test_metadata_that_cannot_be_used(
    text: str | None, storage: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", storage, {(TOPIC, TEXT_TYPE): texts()})
    metadata = folder / "bag" / "metadata.yaml"
    metadata.unlink() if text is None else metadata.write_text(text, "utf-8")
    (note,) = allowed(capsys).splitlines()
    begin = "is missing" if text is None else "cannot be used ("
    assert note.startswith(f"note: bag: metadata.yaml {begin}")
    assert note.endswith("the files are read one by one; this writes it: ros2 bag reindex bag")


def test_the_files_of_a_split_bag_are_read_in_their_order(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for number, part in ((2, RUN[:2]), (10, RUN[2:])):
        write_bag(folder / "part", "mcap", {(TOPIC, TEXT_TYPE): texts(part)})
        (folder / "bag").mkdir(exist_ok=True)
        (folder / "part" / "part.mcap").rename(folder / "bag" / f"bag_{number}.mcap")
        (folder / "part" / "metadata.yaml").unlink()
        (folder / "part").rmdir()
    assert "metadata.yaml is missing" in allowed(capsys)


def test_a_folder_without_files(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "bag").mkdir()
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert line.endswith("it is a folder without metadata.yaml, so no bag of rosbag2")
    (folder / "bag" / "metadata.yaml").write_text(KILLED, "utf-8")
    assert "it is broken: " in refused(["trace", "check", "main.yml", "bag"], capsys)


@pytest.mark.parametrize("path", ["bag", "bag/bag.mcap"])
def test_a_file_without_its_end_is_read_up_to_it(
    path: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("mcap")
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): texts()})
    file = folder / "bag" / "bag.mcap"
    file.write_bytes(file.read_bytes()[:-30])
    last = allowed(capsys, path).splitlines()[-1]
    assert f"{path}: bag.mcap is damaged (" in last
    assert "the 5 statuses before the damage are read" in last
    assert last.endswith("mcap recover bag.mcap -o new.mcap")


@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
def test_a_bag_of_any_length_is_read_or_refused(
    storage: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", storage, {(TOPIC, TEXT_TYPE): texts()})
    (file,) = (path for path in (folder / "bag").iterdir() if path.suffix != ".yaml")
    content = file.read_bytes()
    for length in range(0, len(content), 1 + len(content) // 60):
        file.write_bytes(content[:length])
        assert main(["trace", "check", "main.yml", "bag"]) in (0, 2), length
        shown = capsys.readouterr()
        assert ("damaged (" in shown.err) != ("broken: " in shown.err), length


def test_without_mcap(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "mcap.records", None)
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): texts()})
    file = folder / "bag" / "bag.mcap"
    file.write_bytes(file.read_bytes()[:-30])
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert line.endswith("this may save what is left: mcap recover bag.mcap -o new.mcap")


@pytest.mark.parametrize("path", ["bag", "bag/bag.db3"])
def test_a_database_that_was_not_closed(
    path: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", "sqlite3", {(TOPIC, TEXT_TYPE): texts()})
    (folder / "bag" / "bag.db3-wal").write_bytes(b"x")
    note = allowed(capsys, path)
    assert note.startswith(f"note: {path}: the last messages may be in bag.db3-wal, which is not")
    assert note.endswith("sqlite3 bag.db3 'PRAGMA wal_checkpoint(TRUNCATE)'\n")
    (folder / "bag" / "bag.db3-wal").write_bytes(b"")
    assert allowed(capsys, path) == ""


@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
def test_a_topic_without_messages(
    storage: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", storage, {(TOPIC, TEXT_TYPE): [], ("/chatter", TEXT_TYPE): texts()})
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert line.endswith(f"there are no messages on `{TOPIC}`")
    other = TOPIC.replace("robot_1", "robot_2")
    content = {(other, TEXT_TYPE): [], (TOPIC, TEXT_TYPE): texts()}
    write_bag(folder / "both", storage, content)
    assert allowed(capsys, "both") == ""


@pytest.mark.parametrize("data", ["", "[]", "{}", '{"path": "/sm"}', '{"info": 1, "stamp": "x"}'])
def test_texts_that_are_no_status(
    data: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): [text_message(data)]})
    assert "is broken: " in refused(["trace", "check", "main.yml", "bag"], capsys)


def test_without_rosbags(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): texts()})
    monkeypatch.setitem(sys.modules, "rosbags.rosbag2", None)
    line = refused(["trace", "check", "main.yml", "bag"], capsys)
    assert line.endswith("bags need the package rosbags: pip install 'smachac[bags]'")


@pytest.mark.parametrize("words", [["stats"], ["trace", "stats"]], ids=" ".join)
def test_no_statistics_of_a_bag(
    words: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(folder / "bag", "mcap", {(TOPIC, TEXT_TYPE): texts()})
    line = refused([*words, "main.yml", "bag"], capsys)
    assert line.endswith("a bag has no outcomes of states to count")


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"userdata": {"k": "x" * 5_000_000}}, "a status in it has more than 4,000,000 characters"),
        ({"info": "(['A'], " + "[]," * 2_000_000 + ")"}, "has more than 4,000,000 characters"),
        ({"path": "/sm/" + "a" * 100_000}, "(100003 characters)"),
        ({"active_states": ["a" * 100_000], "info": "(['A'],)"}, "(100003 characters)"),
        ({"path": "/" + "a" * 100_000}, "(100001 characters)"),
    ],
    ids=["value", "info", "path", "state", "root"],
)
def test_a_long_status_is_refused_in_a_few_words(
    folder: Path, capsys: pytest.CaptureFixture[str], fields: dict[str, object], message: str
) -> None:
    status = {"stamp": 1.0, "path": "/sm", "active_states": ["A"], "info": "(['A'],)", **fields}
    found = {(TOPIC, TEXT_TYPE): [text_message(json.dumps(status))]}
    write_bag(folder / "bag", "mcap", found)
    assert main(["trace", "check", "main.yml", "bag"]) in (1, 2)
    shown = "".join(capsys.readouterr())
    assert message in shown
    assert len(shown) < 1000

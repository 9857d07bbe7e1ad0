"""The messages to readers: their order, their limits, and readers that are late."""

from __future__ import annotations

import json
import threading
from typing import Any

from smachac.runtime.tracing.writer import NO_VALUE
from smachac.view.feed import Feed, Reader
from smachac.view.live import LiveTrace


def received(reader: Reader) -> list[Any]:
    return [json.loads(message) for message in reader.wait(0) or []]


def event(seq: int) -> dict[str, Any]:
    return {"seq": seq, "event": "enter", "path": "sm/A", "t": 0.0}


def test_a_reader_receives_messages_in_order() -> None:
    feed = Feed()
    reader = feed.open()
    feed.publish({"kind": "model", "model": 1})
    feed.append("trace", b'{"kind": "trace", "events": []}', 0)
    assert [each["kind"] for each in received(reader)] == ["model", "trace"]
    assert received(reader) == []
    feed.publish({"kind": "model", "model": 2})
    assert received(reader) == [{"kind": "model", "model": 2}]


def test_a_late_reader_receives_the_latest_of_each_kind_and_the_whole_trace() -> None:
    feed = Feed()
    for number in range(3):
        feed.publish({"kind": "model", "model": number})
        feed.publish({"kind": "control", "paused": number})
        feed.append("trace", json.dumps({"kind": "trace", "events": [event(number)]}).encode(), 1)
    kinds = [(each["kind"], each.get("model")) for each in received(feed.open())]
    assert kinds == [("model", 2), ("control", None), *[("trace", None)] * 3]


def test_what_is_no_longer_kept_is_counted() -> None:
    trace = json.dumps({"kind": "trace", "events": [event(1), event(2)]}).encode()
    feed = Feed(limit=3 * len(trace))
    early = feed.open()
    assert received(early) == []
    for _ in range(5):
        feed.append("trace", trace, 2)
    for reader in (early, feed.open()):
        first, *rest = received(reader)
        assert first == {"kind": "dropped", "count": 4}
        assert len(rest) == 3
    feed.append("trace", trace, 2)
    assert [each["kind"] for each in received(early)] == ["trace"]


def test_the_end_comes_after_the_last_message() -> None:
    feed = Feed()
    reader = feed.open()
    feed.publish({"kind": "model"})
    feed.close()
    assert reader.wait(0) is not None
    assert reader.wait(0) is None
    assert feed.readers == 1
    reader.close()
    assert feed.readers == 0


def test_a_message_wakes_a_reader() -> None:
    feed = Feed()
    reader = feed.open()
    reader.wait(0)
    found: list[Any] = []
    waiting = threading.Thread(target=lambda: found.append(reader.wait(60)), daemon=True)
    waiting.start()
    feed.publish({"kind": "model"})
    waiting.join(60)
    assert found == [[b'{"kind": "model"}']]


def test_prepared_events_are_those_of_a_trace() -> None:
    feed = Feed()
    reader = feed.open()
    trace = LiveTrace(feed)
    enter = trace.prepare([{"seq": 0, "event": "enter", "path": "sm/100 %", "t": 0.0}])
    write = trace.prepare(
        [{"seq": 0, "event": "write", "path": "p", "key": "k", "value": None, "t": 0}]
    )
    both = trace.prepare([{"seq": 0, "event": name, "path": "p", "t": 0.0} for name in ("a", "b")])
    trace.append((enter, 0.5, NO_VALUE))
    trace.append((write, 1.0, [1, "a\nb%"]))
    trace.send({"kind": "control", "paused": True})
    trace.append((both, 2.0, NO_VALUE))
    trace({**event(5), "value": {1, 2}})
    assert received(reader) == []
    trace.publish_queued()
    first, control, second = received(reader)
    assert control == {"kind": "control", "paused": True}
    assert first["events"] == [
        {"seq": 1, "event": "enter", "path": "sm/100 %", "t": 0.5},
        {"seq": 2, "event": "write", "path": "p", "key": "k", "value": [1, "a\nb%"], "t": 1.0},
    ]
    assert second["events"] == [
        {"seq": 3, "event": "a", "path": "p", "t": 2.0},
        {"seq": 4, "event": "b", "path": "p", "t": 2.0},
        {**event(5), "value": [1, 2]},
    ]


def test_the_machine_never_waits_and_what_the_queue_drops_is_counted() -> None:
    feed = Feed()
    reader = feed.open()
    trace = LiveTrace(feed, most_queued=10)
    enter = trace.prepare([{"seq": 0, "event": "enter", "path": "sm/A", "t": 0.0}])
    trace.append((enter, 0.0, NO_VALUE))
    trace.publish_queued()
    for _ in range(25):
        trace.append((enter, 0.0, NO_VALUE))
    trace.publish_queued()
    first, dropped, last = received(reader)
    assert [each["seq"] for each in first["events"]] == [1]
    assert dropped == {"kind": "dropped", "count": 15}
    assert [each["seq"] for each in last["events"]] == list(range(17, 27))


def test_what_is_queued_at_the_end_is_published() -> None:
    feed = Feed()
    reader = feed.open()
    trace = LiveTrace(feed)
    trace.start()
    for seq in range(1, 4):
        trace(event(seq))
    trace.close()
    assert [each["seq"] for message in received(reader) for each in message["events"]] == [1, 2, 3]

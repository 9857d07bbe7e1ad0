"""The picture of a view: which models it publishes."""

from __future__ import annotations

import json
from typing import Any

from smachac.ir.nodes import Machine
from smachac.view.feed import Feed
from smachac.view.picture import Picture
from tests.support.ir_machines import leaf, machine

FIRST = Machine(root=machine("sm", "done", leaf("A", {"ok": "done"})))
SECOND = Machine(root=machine("sm", "done", leaf("B", {"ok": "done"})))


def published(feed: Feed) -> list[Any]:
    """The messages that wait for a new reader."""
    reader = feed.open()
    messages = [json.loads(each) for each in reader.wait(0) or ()]
    reader.close()
    return messages


def test_a_model_has_a_greater_revision_than_those_before() -> None:
    earlier = Picture(Feed(), "sm")
    earlier.update(FIRST, [])
    picture = Picture(Feed(), "sm")
    revisions = [earlier.model["revision"]]
    for each in (FIRST, SECOND, FIRST, SECOND):
        picture.update(each, [])
        revisions.append(picture.model["revision"])
    assert sorted(set(revisions[1:])) == revisions[1:]
    assert revisions[0] <= revisions[1]
    assert revisions[-1] < 2**53  # exact in the numbers of a browser


def test_a_check_that_changes_nothing_publishes_no_model() -> None:
    feed = Feed()
    picture = Picture(feed, "sm", editable=True)
    picture.update(FIRST, [])
    ((before, _),) = [published(feed)]
    assert before == {"kind": "model", "model": picture.model}
    picture.update(FIRST, [])
    assert published(feed)[0] == before
    picture.update(SECOND, [])
    assert published(feed)[0] == {"kind": "model", "model": picture.model}
    assert picture.model["editable"]

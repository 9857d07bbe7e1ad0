"""Calls of the constructor of a base class of the project that do not fit its parameters."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {offset: 1}
states:
  - MOVE: {template: Move, input_keys: [offset], transitions: {moved: done, lost: failed}}
"""
TYPE = """\
input_keys: {offset: int}
outcomes: {moved: {}, lost: {}}
code: {python: "cell.states:Move"}
"""
BASE = """\
import smach
from cell_tools import Other, logged


class Drive(smach.State):
    def __init__(self, node, outcomes, input_keys=(), *, rate=10):
        super().__init__(outcomes=outcomes, input_keys=list(input_keys))
        self.node, self.rate = node, rate
"""
CLASS = """\
from cell.base import Drive


class Move(Drive):
    def __init__(self, node=None):
        CALL

    def execute(self, userdata):
        if userdata.offset > 0:
            return "moved"
        return "lost"
"""


def reported(call: str, base: str = BASE) -> list[tuple[str, str, str]]:
    files = {
        "main.yml": MAIN,
        "templates/Move.yml": TYPE,
        "cell/__init__.py": "",
        "cell/base.py": base,
        "cell/states.py": CLASS.replace("CALL", call),
    }
    return [(item.code, item.span.text, item.help or "") for item in analysed(files).report]


LISTS = '["moved", "lost"], ["offset"]'
ORDER = "pass them in the order of its parameters: `node`, `outcomes`, `input_keys`"
PARAMETERS = "its parameters are `node`, `outcomes`, `input_keys`, `rate`"
GOOD = f"super().__init__(node, {LISTS})"


@pytest.mark.parametrize(
    ("call", "place", "help"),
    [
        (f"super().__init__({LISTS})", '["moved", "lost"]', ORDER),
        (f"super(Move, self).__init__({LISTS})", '["moved", "lost"]', ORDER),
        (f"Drive.__init__(self, {LISTS})", '["moved", "lost"]', ORDER),
        ('super().__init__(["moved", "lost"])', "super().__init__", PARAMETERS),
        ("super().__init__(node)", "super().__init__", PARAMETERS),
        ('super().__init__(node, outcomes=["moved", "lost"], inputs=["offset"])', "inputs",
         "did you mean `input_keys`?"),
        ('super().__init__(node, ["moved", "lost"], ["offset"], 5)', "5",
         "its parameters are `node`, `outcomes`, `input_keys`"),
        ('super().__init__(node, ["moved", "lost"], outcomes=["lost"])', "outcomes",
         "remove one of the two arguments"),
    ],
)  # fmt: skip
def test_a_call_that_does_not_fit(call: str, place: str, help: str) -> None:
    assert reported(call) == [("SM609", place, help)]


@pytest.mark.parametrize(
    "call",
    [
        GOOD,
        f"Drive.__init__(self, node, {LISTS})",
        f"super().__init__(None, {LISTS}, rate=5)",
        'super().__init__(node=node, outcomes=["moved", "lost"], input_keys=["offset"])',
        "super().__init__(*dir())",
        "super().__init__(node, **dict())",
        f"make = super().__init__\n        make(node, {LISTS})",
        f"print.__init__({LISTS})",
    ],
)
def test_no_finding(call: str) -> None:
    assert [item for item in reported(call) if item[0] == "SM609"] == []


@pytest.mark.parametrize(
    "base",
    [
        BASE.replace("input_keys=(), *, rate=10", "*input_keys, rate=10, **others"),
        BASE.replace("    def __init__", "    @logged\n    def __init__"),
        BASE.replace("class Drive(smach.State)", "class Drive(Other)")
        .replace("    def __init__", "    def start"),
    ],
)  # fmt: skip
def test_a_base_class_that_accepts_more(base: str) -> None:
    found = reported('super().__init__(node, ["moved", "lost"], ["offset"], 5, speed=1)', base)
    assert [item for item in found if item[0] == "SM609"] == []


@pytest.mark.parametrize("copy", ["list(inputs)", "[*inputs]", "inputs or []", "inputs"])
def test_lists_in_another_order_than_those_of_a_base_class(copy: str) -> None:
    base = BASE.replace("node, outcomes, input_keys=()", "node, outcomes, inputs")
    base = base.replace("outcomes=outcomes, input_keys=list(input_keys)",
                        f"outcomes=list(outcomes), input_keys={copy}")  # fmt: skip
    assert [item for item in reported(GOOD, base) if item[0] == "SM609"] == []
    call = 'super().__init__(node, ["offset"], ["moved", "lost"])'
    help = ORDER.replace("input_keys", "inputs")
    assert reported(call, base)[0] == ("SM609", '["moved", "lost"]', help)


def test_a_list_that_is_no_list_of_outcomes() -> None:
    base = BASE.replace("self, node,", "self, joints,").replace("= node", "= joints")
    assert (
        reported('super().__init__(["left", "right"], ["moved", "lost"], ["offset"])', base) == []
    )


def test_lists_that_pass_through_the_base_class() -> None:
    files = {
        "main.yml": MAIN.replace("offset", "height"),
        "templates/Move.yml": TYPE.replace("offset", "height"),
        "cell/__init__.py": "",
        "cell/base.py": BASE,
        "cell/states.py": CLASS.replace("CALL", GOOD),
    }
    (one,) = analysed(files).report
    assert (one.code, one.span.text, one.span.line) == ("SM310", "offset", 9)
    assert one.help is not None
    assert one.help.startswith("write `height` in place of `offset`, also where `Move` declares it")
    assert [item.span.text for item in one.related][:1] == ['"offset"']


@pytest.mark.parametrize(
    ("call", "base", "place"),
    [
        (f'super().__init__(node, {LISTS.replace("lost", "gone")})', BASE, '"gone"'),
        (GOOD, BASE.replace("        super", "        outcomes.append('gone')\n        super"), ""),
        (GOOD, BASE.replace("        super", "        input_keys = ()\n        super"), ""),
        (GOOD.replace(', ["offset"]', ""), BASE, "Move"),
    ],
)  # fmt: skip
def test_other_lists_through_the_base_class(call: str, base: str, place: str) -> None:
    found = [item for item in reported(call, base) if item[0] == "SM603"]
    assert [item[1] for item in found] == ([place] if place else [])

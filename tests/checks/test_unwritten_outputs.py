"""Keys that are both inputs and outputs, and that a class never sets although `writes:` promises
them."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {count: 0}
output_keys: [count]
states:
  - PLACE:
      template: Place
      input_keys: [count]
      output_keys: [count]
      transitions: {placed: done, dropped: failed}
"""
INTERFACE = """\
input_keys: {count: TYPE}
output_keys: {count: TYPE}
outcomes: {placed: {}, dropped: {failure: true}}
WRITES
code: {python: "cell:Place"}
"""
CLASS = """\
import smach


class Place(smach.State):
    def __init__(self):
        super().__init__(
            outcomes=["placed", "dropped"], input_keys=["count"], output_keys=["count"]
        )

    def execute(self, userdata):
        if arm.is_empty():
            return "dropped"
CODE
        return "placed"
"""
PROMISE = "writes: {placed: [count]}"


def reported(code: str, type_: str = "int", writes: str = PROMISE) -> list[Diagnostic]:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    interface = INTERFACE.replace("TYPE", type_).replace("WRITES", writes)
    files = {"main.yml": MAIN, "templates/Place.yml": interface}
    report = analysed({**files, "cell.py": CLASS.replace("CODE", body)}).report
    return [item for item in report if item.code == "SM314"]


def test_a_sum_that_is_not_written_back() -> None:
    (item,) = reported("count = userdata.count\ncount += 1")
    assert (item.span.source.name, item.span.text) == ("cell.py", '"placed"')
    assert item.message == "`Place` returns `placed` without setting its output key `count`"
    assert item.help == "write `userdata.count = count` before this `return`"


def test_nothing_sets_the_key() -> None:
    (item,) = reported("arm.log(userdata.count)")
    assert item.help is not None
    assert item.help.startswith("set `userdata.count` before this")


@pytest.mark.parametrize(
    ("code", "type_", "writes"),
    [
        ("userdata.count = userdata.count + 1", "int", PROMISE),
        ("userdata.count += 1", "int", PROMISE),
        ("arm.count(userdata)", "int", PROMISE),  # other code may set it
        ("userdata.count.append(1)", '"list[int]"', PROMISE),  # changed in place
        ("arm.fill(userdata.count)", '"{n: int}"', PROMISE),
        ("arm.log(userdata.count)", "int", ""),  # nothing is promised
        ("arm.log(userdata.count)", "int", "writes: {dropped: [other]}"),
    ],
)
def test_no_finding(code: str, type_: str, writes: str) -> None:
    assert reported(code, type_, writes) == []


def test_a_key_that_one_outcome_sets_may_pass_through_with_another() -> None:
    promise = "writes: {placed: [count], dropped: [count]}"
    assert reported("userdata.count += 1", "int", promise) == []


OUTPUT = """\
input_keys: {load: float<kg>}
output_keys: {mass: float<kg>}
outcomes: {placed: {}, dropped: {failure: true}}
writes: {placed: [mass]}
code: {python: "cell:Place"}
"""


EXAMPLE = "set `userdata.mass` before this `return`, for example to `userdata.load`, which has its"


@pytest.mark.parametrize(
    ("code", "help"),
    [
        ("mass = arm.weigh()\narm.log(mass)", "write `userdata.mass = mass` before this `return`"),
        ("net_mass = arm.weigh()\narm.log(net_mass)", "write `userdata.mass = net_mass` before"),
        (
            "if arm.full():\n    mass = 2.0\n    arm.log(mass)",
            EXAMPLE,
        ),
        ("mass_1 = mass_2 = 1.0\narm.log(mass_1, mass_2)", EXAMPLE),
        ("arm.log(1)", EXAMPLE),
    ],
)
def test_the_value_of_an_output_that_is_not_set(code: str, help: str) -> None:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    text = CLASS.replace('["count"], output_keys=["count"]', '["load"], output_keys=["mass"]')
    main = MAIN.replace("input_keys: [count]", "input_keys: [load]").replace("[count]", "[mass]")
    main = main.replace("{count: 0}", "{load: 0.5}")
    files = {"main.yml": main, "templates/Place.yml": OUTPUT}
    report = analysed({**files, "cell.py": text.replace("CODE", body)}).report
    (item,) = [one for one in report if one.code == "SM314"]
    assert item.help is not None
    assert item.help.startswith(help)

"""Keys that the code of a state reads without declaring them as inputs: the helps that fit the
other declarations of the state."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done]
userdata: {order: [a], PRESET}
states:
  - DETECT:
      template: Detect
      input_keys: [order]
      output_keys: [parts]
      transitions: {found: SHOW}
  - SHOW: {template: PrintUserdataState, input_keys: [parts], transitions: {succeeded: done}}
"""
INTERFACE = """\
input_keys: {order: "list[str]"}
output_keys: {parts: TYPE}
outcomes: {found: {}}
code: {python: "cell:Detect"}
"""
CLASS = """\
import smach


class Detect(smach.State):
    def __init__(self):
        super().__init__(outcomes=["found"], input_keys=["order"], output_keys=["parts"])

    def execute(self, userdata):
CODE
        return "found"
"""


def reported(code: str, type_: str = '"list[str]"', preset: str = "") -> list[Diagnostic]:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    files = {
        "main.yml": MAIN.replace(", PRESET", f", {preset}" if preset else ""),
        "templates/Detect.yml": INTERFACE.replace("TYPE", type_),
        "cell.py": CLASS.replace("CODE", body),
    }
    return [item for item in analysed(files).report if item.code != "SM305"]


LOCAL = "in a local variable, and set `userdata.parts` once, before the return"
ADD = "add `parts` to the `input_keys` of the interface `Detect` and of `__init__`"
LOOP = "for name in userdata.order:\n    "


@pytest.mark.parametrize(
    ("code", "type_", "preset", "help"),
    [
        (f"userdata.parts = []\n{LOOP}userdata.parts.append(name)", '"list[str]"', "",
         f"collect the items {LOCAL}"),
        (f"userdata['parts'] = []\n{LOOP}userdata['parts'].append(name)", '"list[str]"', "",
         f"collect the items {LOCAL}"),
        (f"userdata.parts = 0\n{LOOP}userdata.parts += 1", "int", "", f"compute the value {LOCAL}"),
        (f"userdata.parts = 0\n{LOOP}userdata.parts += 1", "int", "parts: 1",
         f"compute the value {LOCAL}"),
        ("userdata.parts = 1\nprint(userdata.parts)", "int", "", f"keep the value {LOCAL}"),
        (f"{LOOP}userdata.parts.append(name)", '"list[str]"', "", f"collect the items {LOCAL}"),
        (f"{LOOP}userdata.parts.append(name)", '"list[str]"', "parts: []", ADD),
        (f"{LOOP}userdata.parts += 1", "int", "parts: 0", ADD),
    ],
)  # fmt: skip
def test_a_read_of_an_output_key(code: str, type_: str, preset: str, help: str) -> None:
    (item,) = [one for one in reported(code, type_, preset) if one.code == "SM310"]
    assert item.message.endswith("reads `parts`, which is only an output key of its interface")
    assert item.help == help


def test_a_local_variable_is_no_read_of_the_key() -> None:
    code = f"parts = []\n{LOOP}parts.append(name)\nuserdata.parts = parts"
    assert reported(code) == []


SCRIPT = """\
name: sm
template: Base
outcomes: [done]
userdata: {current: 1.0, level: 2.0}
output_keys: [current]
states:
  - SETUP:
      template: CallbacksState
      input_keys: [INPUTS]
      output_keys: [current]
      callbacks: {current: 'lambda ud: CODE'}
      transitions: {succeeded: done}
"""


def in_script(inputs: str, code: str) -> list[tuple[str, str, str]]:
    text = SCRIPT.replace("INPUTS", inputs).replace("CODE", code)
    report = analysed({"main.yml": text}).report
    return [(item.code, item.span.text, item.help or "") for item in report if item.code != "SM305"]


def test_the_only_input_is_read_under_another_name() -> None:
    for inputs, code in (("current", "ud.amps * 1.1"), ("current, level", "ud.amps * ud.level")):
        text = SCRIPT.replace("INPUTS", inputs).replace("CODE", code)
        found = [row for row in printed({"main.yml": text}) if row[0] != "SM305"]
        assert [row[:2] for row in found] == [("SM310", "amps")]
        assert found[0][2].startswith("did you mean `current`?")


@pytest.mark.parametrize(
    ("inputs", "code", "expected"),
    [
        ("current", "ud.current * 1.1", []),
        ("current, level", "ud.amps * 1.1", ["SM306", "SM306", "SM310"]),  # two are not read
        ("current", "ud.amps * ud.volts", ["SM306", "SM310", "SM310"]),  # two are not declared
        ("current, level", "ud.levle", ["SM306", "SM310"]),  # `level` is meant
    ],
)
def test_the_key_that_is_meant_is_not_known(inputs: str, code: str, expected: list[str]) -> None:
    found = in_script(inputs, code)
    assert sorted(code for code, _, _ in found) == expected
    assert not any("is read by nothing" in help for _, _, help in found)


COUNTED = """\
name: sm
template: Base
outcomes: [again, done]
userdata: {tries: 0, max_tries: 3, limit: 2}
states:
  - COUNT:
      template: CallbacksState
      input_keys: [tries]
      output_keys: [tries]
      callbacks: {tries: 'lambda ud: ud.tries + 1'}
      transitions: {succeeded: AGAIN}
  - AGAIN:
      template: ConditionalOutcomeState
      outcomes: [again]
      input_keys: [INPUTS]
      callbacks: {again: 'lambda ud: CODE'}
      default_outcome: done
      transitions: {again: again, done: done}
"""


@pytest.mark.parametrize(
    ("inputs", "code", "help"),
    [
        ("tries", "ud.tries < ud.max_tries", "write `input_keys: [tries, max_tries]` in `AGAIN`"),
        ("max_tries", "ud.tries < ud.max_tries",
         "write `input_keys: [max_tries, tries]` in `AGAIN`"),
        ("tries", 'ud["tries"] < ud["max_tries"]',
         "write `input_keys: [tries, max_tries]` in `AGAIN`"),
        ("tries", "ud.limit < ud.tries", "write `input_keys: [tries, limit]` in `AGAIN`"),
        ("max_tries", "ud.tries < 3", "write `input_keys: [max_tries, tries]` in `AGAIN`"),
        ("tries", "ud.tires < 3", "did you mean `tries`?"),
        ("tries, max_tries", "ud.tries < ud.max_tires", "did you mean `max_tries`?"),
    ],
)  # fmt: skip
def test_a_key_of_the_container_is_no_slip_of_another_one(
    inputs: str, code: str, help: str
) -> None:
    """The code reads the similar key too: with the guess it would read one key twice."""
    text = COUNTED.replace("INPUTS", inputs).replace("CODE", code)
    report = analysed({"main.yml": text}).report
    assert [item.help for item in report if item.code == "SM310"] == [help]


@pytest.mark.parametrize(
    ("value", "preset", "help"),
    [
        ("userdata.order + userdata.orders", "orders: [b]",
         "add `orders` to the `input_keys` of the interface `Detect` and of `__init__`"),
        ("userdata.order + userdata.orders", "",
         "add `orders` to the `input_keys` of the interface `Detect` and of `__init__`"),
        ("userdata.orders", "orders: [b]", "did you mean `order`?"),
    ],
)  # fmt: skip
def test_a_class_reads_a_key_of_the_container(value: str, preset: str, help: str) -> None:
    (found,) = [item for item in reported(f"userdata.parts = {value}", preset=preset)
                if item.code == "SM310"]  # fmt: skip
    assert found.help == help

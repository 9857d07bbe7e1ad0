"""Helps and notes of findings in Python classes: the text to write, and what happens."""

from __future__ import annotations

import pytest

from tests.checks.test_class_faults import CLASS, FIND, MAIN, only, report
from tests.trust.project_text import analysed

PART = "userdata.part = userdata.parts[0]"


def test_an_attribute_in_place_of_a_key() -> None:
    item = only((PART, "self.part = userdata.parts[0]"))
    assert (item.code, item.span.text, item.help) == ("SM314", "self.part", "write `userdata.part`")
    read = (PART, "self.part = userdata.parts[0]\n        print(self.part)")
    assert (only(read).code, only(read).span.text) == ("SM314", "FOUND")


def test_a_return_at_the_end_of_a_loop() -> None:
    line = "        return FOUND"
    item = only((line, f"        while self.camera.look():\n    {line}"))
    assert item.code == "SM309"
    assert (item.help or "").startswith("move `return FOUND` behind the loop")
    item = only((line, f"        while self.camera.look():\n    {line}\n            print()"))
    assert "behind the loop" not in (item.help or "")


@pytest.mark.parametrize(
    ("type_", "value", "help"),
    [
        ("one_of[left, right]", '"rigth"', "did you mean `right`?"),
        ("float", "str(width)", "write `width` without `str()`"),
        ("int", "str(1 + 2)", "write a value of the type `int`, such as `3`"),
    ],
)
def test_helps_for_values(type_: str, value: str, help: str) -> None:
    interface = ("output_keys: {part: str}", f'output_keys: {{part: "{type_}"}}')
    item = only(interface, (PART, f"width = 1\n        userdata.part = {value}"))
    assert (item.code, (item.help or "").partition(",")[0]) == ("SM304", help.partition(",")[0])


def test_a_stop_request_without_an_answer() -> None:
    stop = "if self.preempt_requested():\n            self.service_preempt\n        if not"
    item = only(("if not", stop))
    assert (item.code, item.help) == ("SM609", "write `self.service_preempt()`")
    assert "stopped at once" in (item.effect or "")


def test_the_file_without_the_class_is_named() -> None:
    item = only(("cell.find:FindPart", "cell.find:FindParts"))
    assert "is defined in `cell/find.py`" in item.message


def test_types_of_a_script_in_an_interface() -> None:
    types = "types: {Part: {name: str, at: Point}, Other: float}\nstates:"
    files = {"main.yml": MAIN.replace("states:", types, 1), "cell/find.py": CLASS}
    files["templates/Find.yml"] = FIND.replace(
        "output_keys: {part: str}", "output_keys: {part: Part}"
    )
    found = [item for item in analysed(files).report if item.code in ("SM017", "SM306")]
    assert [(item.code, item.span.text) for item in found] == [
        ("SM017", "Part"),
        ("SM306", "Other"),
    ]
    assert "write `{name: str, at: Point}`" in (found[0].help or "")


BASE = """\
{% extends "Base.tpl.py" %}
{% block imports %}
from cell.rules import best_part
{% endblock %}
"""


@pytest.mark.parametrize(("name", "near"), [("best_parts", "best_part"), ("other", "")])
def test_a_name_of_the_own_base_is_suggested(name: str, near: str) -> None:
    main = """\
name: sm
template: Own
outcomes: [succeeded]
userdata: {parts: [1]}
states:
  - CHOOSE:
      template: CallbacksState
      input_keys: [parts]
      output_keys: [best]
      callbacks: {best: NAME}
      transitions: {succeeded: SHOW}
  - SHOW: {template: PrintUserdataState, input_keys: [best]}
"""
    rules = "def best_part(ud):\n    return ud.parts[0]\n"
    files = {"main.yml": main.replace("NAME", name), "templates/Own.tpl.py": BASE}
    report_ = analysed({**files, "cell/rules.py": rules, "cell/__init__.py": ""}).report
    (item,) = [one for one in report_ if one.code == "SM019"]
    assert (item.help == f"did you mean `{near}`?") == bool(near)


def test_the_promise_of_an_interface_is_a_second_place() -> None:
    promise = ("writes: {found: [part]}", "writes: {found: [part], nothing: [part]}")
    item = only(promise)
    assert (item.code, item.span.text) == ("SM314", '"nothing"')
    assert "remove `part` from `nothing`" in (item.help or "")
    assert item.related[0].span.start == FIND.index("writes:") + len(promise[1]) - len("part]}")


STOP = "outcomes: {found: {}, nothing: {}, preempted: {}}\nblocking: true\n"


@pytest.mark.parametrize("timeout", ["", "      timeout: 5\n"])
def test_a_time_limit_that_cannot_end_the_state(timeout: str) -> None:
    steps = "nothing: failed, preempted: failed" + (", timeout: failed" if timeout else "")
    (item,) = [
        one
        for one in report(
            ("outcomes: {found: {}, nothing: {}}\n", STOP),
            ('[FOUND, "nothing"]', '[FOUND, "nothing", "preempted"]'),
            ("nothing: failed", steps),
            ("      template: Find\n", f"      template: Find\n{timeout}"),
        )
        if one.code == "SM315"
    ]
    messages = [one.message for one in item.related]
    assert ("this time limit cannot end `FIND`" in messages) == bool(timeout)
    assert item.effect == "the robot goes on until the state ends by itself"


def test_no_note_without_a_finding() -> None:
    assert report() == []

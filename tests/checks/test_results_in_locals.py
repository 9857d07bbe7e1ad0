"""What the class of a state type does with results of its own methods, and calls of its methods."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.checks.test_first_scripts import reported
from tests.support.typed_machines import BUILT_IN

SCRIPT = """\
name: sm
outcomes: [done, failed]
states:
  - READ: {template: Read, transitions: {read: SHOW, unclear: failed}}
  - SHOW: {template: PrintUserdataState, input_keys: [number], transitions: {succeeded: done}}
"""
INTERFACE = """\
name: Read
output_keys: {number: int}
outcomes: {read: {}, unclear: {failure: true}}
writes: {read: [number]}
code: {python: "lift:Read"}
"""
CLASS = """\
from smachac.runtime import smach


class Base(smach.State):
    def say(self, text, volume=0.7, *, slow=False):
        print(volume, text, slow)


class Read(Base):
    def __init__(self):
        smach.State.__init__(self, outcomes=["read", "unclear"], output_keys=["number"])

    def execute(self, userdata):
        self.say("hello", volume=0.5)
        digits = self.camera()
        if digits is None:
            return "unclear"
        userdata.number = digits
        return "read"

    def camera(self):
        return RESULT
"""


def findings(code: str, interface: str = INTERFACE) -> list[tuple[str, str, str | None]]:
    files = {"main.yml": SCRIPT, "templates/Read.yml": interface, "lift.py": code}
    return reported(files)


@pytest.mark.parametrize(
    ("result", "type_", "marked"),
    [
        # No value fits.
        ('"5" if self.lit() else None', "int", ["digits"]),
        ('"5"', "bool", ["digits"]),
        ("[1, 2]", "str", ["digits"]),
        # Each value fits, or is not known.
        ("5 if self.lit() else None", "int", []),
        ('"five" if self.lit() else 5', "int", []),
        ("self.lit()", "int", []),
        ('"5"', "str", []),
    ],
)
def test_the_result_of_an_own_method(result: str, type_: str, marked: list[str]) -> None:
    code = CLASS.replace("RESULT", result) + "\n    def lit(self):\n        return 1 < 2\n"
    found = findings(code, INTERFACE.replace("number: int", f"number: {type_}"))
    assert [place for code, place, _ in found if code == "SM304"] == marked


@pytest.mark.parametrize(
    "test",
    [
        'if digits == "none":\n            return "unclear"',
        'if digits in ("none", "dark"):\n            return "unclear"',
        'if isinstance(digits, str):\n            return "unclear"',
        'if digits.isalpha():\n            return "unclear"',
        "digits = int(digits)",
    ],
)
def test_a_tested_result_is_not_known(test: str) -> None:
    code = CLASS.replace("RESULT", '"none"').replace(
        "        userdata.number", f"        {test}\n        userdata.number"
    )
    assert [found for found in findings(code) if found[0] == "SM304"] == []


@pytest.mark.parametrize(
    ("call", "help"),
    [
        ('"hello", loudness=0.5', "remove it, or add it to the parameters"),
        ('"hello", loudness=0.5, slow=True', "did you mean `volume`?"),
        ('"hello", slowly=True', "did you mean `slow`?"),
        ('"hello", 0.5, slwo=True', "did you mean `slow`?"),
        ('text="hello", slow=True', None),
    ],
)
def test_the_keywords_of_an_own_method(call: str, help: str | None) -> None:
    code = CLASS.replace("RESULT", "5").replace('"hello", volume=0.5', call)
    found = [help for code, _, help in findings(code) if code == "SM609"]
    assert found == ([help] if help else [])


def test_a_method_that_takes_all_keywords() -> None:
    code = CLASS.replace("RESULT", "5").replace("slow=False", "slow=False, **more")
    code = code.replace("volume=0.5", "loudness=0.5")
    assert findings(code) == []


WAVE = """\
{% extends "State.tpl.py" %}
{% block meta %}
name: Wave
variables:
  times: {type: int, description: how often}
outcomes: [succeeded, aborted]
{% endblock %}
{% block class_defs %}
class Wave(smach.State):
    def __init__(self, times):
        smach.State.__init__(self, outcomes=['succeeded', 'aborted'])
        self.times = times

    def execute(self, userdata):
        return 'succeeded' if self.times < 10 else 'aborted'
{% endblock %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Wave({{ times }}), transitions={{ transitions }})
{% endblock %}
"""
GREET = """\
name: sm
outcomes: [done, failed]
states:
  - GREET: {template: Wave, times: 3, transitions: {succeeded: done, aborted: failed}}
"""


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("", "", []),
        ("Wave({{", "Waves({{", [("SM609", "Waves", "did you mean `Wave`?")]),
        ("Wave({{", "wave({{", [("SM609", "wave", "did you mean `Wave`?")]),
        ("Wave({{", "{{ class_name }}({{", []),
    ],
)  # fmt: skip
def test_the_body_of_a_template(
    old: str, new: str, found: list[tuple[str, str, str | None]]
) -> None:
    text = WAVE.replace(old, new) if old else WAVE
    assert reported({"main.yml": GREET, "templates/Wave.tpl.py": text}) == found


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("{% endblock %}\n{% block body", "{% block body", "{% block class_defs %}"),
        ("transitions }})\n{% endblock %}", "transitions }})", "{% block body %}"),
        ("{% endblock %}\n{% block body", "{# endblock #}{% block body", "{% block class_defs %}"),
    ],
)
def test_a_tag_without_its_end(old: str, new: str, place: str) -> None:
    files = {"main.yml": GREET, "templates/Wave.tpl.py": WAVE.replace(old, new)}
    library = memory_library(files, BUILT_IN)
    report = analyse(Source("main.yml", GREET), library, [], render=True).report
    assert [(item.code, item.span.text) for item in report] == [("SM605", place)]

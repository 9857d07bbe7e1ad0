"""Params in calls: those that nothing uses, and those that a call misspells."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [good, bad]
states:
  - ASK:
      script: ask
      FIELDS
      transitions: {good: good, bad: bad}
"""

ASK = """\
- ASK:
    template: ScriptedState
    outcomes: [good, bad]
    params: {PARAMS}
    output_keys: [said]
    steps: [{outcome: bad, set: {said: [[text]]}}]
"""


def report(fields: str, params: str) -> list[Diagnostic]:
    files = {"main.yml": MAIN.replace("FIELDS", fields), "ask.yml": ASK.replace("PARAMS", params)}
    return analysed(files).report


def found(fields: str, params: str) -> list[str]:
    """The findings about params: code, file and text of the place."""
    kept = [item for item in report(fields, params) if item.code in ("SM015", "SM306")]
    return [f"{item.code} {item.span.source.name} {item.span.text}" for item in kept]


@pytest.mark.parametrize(
    ("fields", "params", "unused"),
    [
        ("doc: x", "text: hello", []),
        ("steps: [{outcome: good, set: {said: 1}}]", "text: hello", []),
        ("doc: x", "text: hello, more: 1", ["SM306 ask.yml more"]),
        (
            "params: {text: bye}\n      steps: [{outcome: good, set: {said: 1}}]",
            "text: hello",
            ["SM306 main.yml text"],
        ),
        ("params: {other: &other 1}", "text: hello", ["SM306 main.yml other"]),
    ],
    ids=["used", "its use is replaced", "unused", "given in vain", "an anchor without an alias"],
)
def test_params_of_sub_scripts_that_nothing_uses(
    fields: str, params: str, unused: list[str]
) -> None:
    assert found(fields, params) == unused


@pytest.mark.parametrize(
    ("fields", "params", "place"),
    [
        ("params: {tect: hello}", "other: 1", "SM015 main.yml tect"),
        ("params: {tone: hello}", "txt: 1", "SM015 ask.yml text"),
        ("doc: x", "other: 1", "SM015 main.yml script: ask"),
    ],
    ids=["the call is wrong", "the look-up is wrong", "the call does not give it"],
)
def test_a_look_up_that_fails_is_reported_where_it_is_wrong(
    fields: str, params: str, place: str
) -> None:
    assert [item for item in found(fields, params) if "SM015" in item] == [place]


def test_a_call_that_does_not_give_the_param_is_shown() -> None:
    (item,) = [item for item in report("doc: x", "other: 1") if item.code == "SM015"]
    assert [one.span.source.name for one in item.related] == ["ask.yml"]


def test_params_of_a_call_follow_those_of_the_sub_script() -> None:
    assert found("params: {more: b}", "more: a, text: [params, more]") == []
    (wrong,) = found("params: {more: b}", "text: [params, more]")
    assert wrong == "SM015 ask.yml more"


TEMPLATE = """\
{% block meta %}
name: Speak
type: State
outcomes: [good, bad]
{% endblock meta %}
{% extends "State.tpl.py" %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Speak('{{ text }}' PARAMS))
{% endblock body %}
"""


@pytest.mark.parametrize(
    ("code", "unused"), [("", ["txt"]), (", {{ params.txt }}", []), (", {{ params }}", [])]
)
def test_a_template_uses_only_params_that_it_can_read(code: str, unused: list[str]) -> None:
    ask = ASK.replace("ScriptedState", "Speak").replace("PARAMS", "text: hello")
    ask = ask[: ask.index("    output_keys")] + "    text: [params, text]\n"
    files = {
        "main.yml": MAIN.replace("FIELDS", "params: {txt: bye}"),
        "ask.yml": ask,
        "templates/Speak.tpl.py": TEMPLATE.replace("PARAMS", code),
    }
    found = [item for item in analysed(files).report if item.code == "SM306"]
    assert [item.span.text for item in found] == unused


def test_a_param_that_the_params_of_a_call_use_is_used() -> None:
    call = "params: {who: you, text: [hello_, [params, who]]}"
    assert found(call, "who: me, text: hello") == []
    assert found("params: {text: bye}", "who: me, text: hello") == ["SM306 ask.yml who"]

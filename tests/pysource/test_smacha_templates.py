"""Templates of SMACHA's kind: guards of classes, and calls of `State.tpl.py`."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.trust.project_text import BUILT_IN, analysed

MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - GRIP: {template: Grip, outcomes: [done], transitions: {done: TURN}}
  - TURN: {template: Turn, outcomes: [done], transitions: {done: done}}
"""
TEMPLATE = """\
{% extends "State.tpl.py" %}
{% block class_defs %}
{{ super() }}
{% if 'class_GUARD' not in defined_headers %}
class NAME(smach.State):
    def __init__(self, outcomes=['done']):
        smach.State.__init__(self, outcomes=outcomes)

    def execute(self, userdata):
        return 'done'
{% do defined_headers.append('class_GUARD') %}
{% endif %}
{% endblock class_defs %}
"""


def template(name: str, guard: str = "") -> str:
    return TEMPLATE.replace("GUARD", guard or name).replace("NAME", name)


def found(grip: str, turn: str) -> list[Diagnostic]:
    files = {"main.yml": MAIN, "templates/Grip.tpl.py": grip, "templates/Turn.tpl.py": turn}
    return [each for each in analysed(files).report if each.severity.value != "info"]


@pytest.mark.parametrize(
    ("grip", "turn", "file"), [("", "Grip", "Turn"), ("Turn", "", "Grip"), ("arm", "arm", "Turn")]
)
def test_a_guard_of_another_class(grip: str, turn: str, file: str) -> None:
    (item,) = found(template("Grip", grip), template("Turn", turn))
    guard = f"class_{grip or turn}"
    assert str(item.span) == f"templates/{file}.tpl.py:4:8"
    assert item.span.text == guard
    assert item.message.startswith(f"the program does not contain the class `{file}`: its template")
    assert (item.help or "").startswith(f"write `class_{file}` here, and where the template adds")
    assert len(item.finding.related) == 2


def test_guards_that_are_right() -> None:
    assert found(template("Grip"), template("Turn")) == []
    both = template("Grip", "arm").replace("class Grip", "class Arm")
    assert found(both, both) == []  # one class for both, printed once


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ("amount, outcomes=['done']", "`State.tpl.py` does not pass `amount`, which `__init__` of"),
        (
            "amount=1",
            "`State.tpl.py` passes `outcomes`, which `__init__` of `Turn` does not accept",
        ),
        ("amount=1, outcomes=['done'], callbacks={}", None),
        ("outcomes, input_keys=[], **more", None),
    ],
)
def test_a_constructor_that_the_call_does_not_fit(parameters: str, message: str | None) -> None:
    turn = template("Turn").replace("outcomes=['done']):", f"{parameters}):")
    lines = found(template("Grip"), turn)
    assert [each.span.text for each in lines] == ["State.tpl.py"] * (message is not None)
    assert all(each.message.startswith(message or "") for each in lines)


def test_a_template_that_makes_the_state_itself() -> None:
    turn = template("Turn").replace("outcomes=['done']):", "amount, outcomes=['done']):")
    body = "{% block body %}{{ add('Turn', 2) }}{% endblock %}\n"
    assert found(template("Grip"), turn + body) == []
    only = "{% block body %}\n{{ super() }}\n{% endblock body %}\n"
    assert [each.code for each in found(template("Grip"), turn + only)] == ["SM609"]


SAY = """\
{% from "Utils.tpl.py" import render_transitions %}
{% extends "State.tpl.py" %}
{% block class_defs %}
{% if 'class_Say' not in defined_headers %}
class Say(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'])

    def execute(self, userdata):
        return 'done'
{% do defined_headers.append('class_Say') %}{% endif %}
{% endblock class_defs %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Say(),
{% if transitions is defined %}{{ render_transitions(transitions) }}{% endif %})
{% endblock body %}
"""
IN_CONTAINER = """\
name: sm
outcomes: [done]
states:
  - BOTH:
      template: CONTAINER
      outcomes: [done]
      FIELDS
      transitions: {done: done}
      states:
        - SAY: {template: Say, outcomes: [done]}
        - TELL: {template: ScriptedState, outcomes: [done]LAST}
"""
FIELDS = {
    "Concurrence": "outcome_map: {done: {SAY: done, TELL: done}}",
    "Sequence": "connector_outcome: done",
}


def in_container(kind: str, say: str, last: str = "") -> list[tuple[str, str, str | None]]:
    main = IN_CONTAINER.replace("CONTAINER", kind).replace("FIELDS", FIELDS[kind])
    files = {"main.yml": main.replace("LAST", last), "templates/Say.tpl.py": say}
    report = [
        each
        for each in analyse(
            Source("main.yml", files["main.yml"]), memory_library(files, BUILT_IN), [], render=True
        ).report
        if each.severity.value != "info"
    ]
    return [(str(each.span), each.span.text, each.help) for each in report]


def test_transitions_in_a_branch_of_a_concurrence() -> None:
    plain = SAY.replace("{% if transitions is defined %}", "").replace(
        "(transitions) }}{% endif %}", "(transitions) }}"
    )
    fixed = "{% if transitions is defined %}{{ render_transitions(transitions) }}{% endif %}"
    assert in_container("Concurrence", plain) == [
        ("templates/Say.tpl.py:15:23", "transitions", f"write `{fixed}`")
    ]
    assert in_container("Concurrence", SAY) == []


def test_an_error_inside_a_built_in_macro_is_at_its_call() -> None:
    say = SAY.replace("{% if transitions is defined %}", "{% if true %}")
    say = say.replace("render_transitions(transitions)", "render_transitions(4)")
    places = [place for place, _, _ in in_container("Concurrence", say)]
    assert places == ["templates/Say.tpl.py:15:1"]


@pytest.mark.parametrize("kind", ["Concurrence", "Sequence"])
def test_a_call_for_another_kind_of_container(kind: str) -> None:
    say = SAY.replace("smach.{{ parent_type }}.add", "smach.StateMachine.add")
    assert in_container(kind, SAY) == []
    assert in_container(kind, say) == [
        (
            "templates/Say.tpl.py:14:1",
            "smach.StateMachine.add",
            "write `smach.{{ parent_type }}.add`",
        )
    ]


def test_a_call_that_is_chosen_by_the_kind_of_container() -> None:
    chosen = "{% if parent_type == 'StateMachine' %}smach.StateMachine.add"
    chosen += "{% else %}smach.{{ parent_type }}.add{% endif %}"
    assert in_container("Concurrence", SAY.replace("smach.{{ parent_type }}.add", chosen)) == []

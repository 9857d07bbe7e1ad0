"""The block `body` of templates of SMACHA's kind: the line that makes the state, and its tests."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - MEASURE: {template: Measure, samples: 5, probe: left, transitions: {done: done}}
"""
TEMPLATE = """\
{% from "Utils.tpl.py" import render_transitions %}
{% extends "State.tpl.py" %}
{% block class_defs %}
{{ super() }}
class Measure(smach.State):
    def __init__(self, samples, probe):
        smach.State.__init__(self, outcomes=['done'])
        self._samples, self._probe = samples, probe

    def execute(self, userdata):
        print(self._samples, self._probe)
        return 'done'
{% endblock class_defs %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}',
        {{ '' }}Measure({{ samples }}, '{{ probe }}'){% if transitions is defined %},
        {{ render_transitions(transitions) }}{% endif %})
{% endblock body %}
"""


def findings(old: str, new: str) -> list[tuple[str, str, str]]:
    assert old in TEMPLATE
    files = {"main.yml": MAIN, "templates/Measure.tpl.py": TEMPLATE.replace(old, new)}
    return [
        (each.code, each.span.text, each.help or "")
        for each in analysed(files).report
        if each.severity.value != "info"
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("'{{ probe }}'", "{{ probe }}", ("SM609", "{{ probe }}", "write `'{{ probe }}'`")),
        ("{{ samples }}, '{{ probe }}'", "'{{ probe }}', {{ samples }}",
         ("SM609", "'{{ probe }}', {{ samples }}",
          "write `Measure({{ samples }}, '{{ probe }}')`")),
        ("'{{ probe }}'", "porbe='{{ probe }}'", ("SM609", "porbe", "did you mean `probe`?")),
        ("'{{ probe }}'", "probe='{{ probe }}', rate=3",
         ("SM609", "rate", "its parameters are `samples`, `probe`")),
        ("'{{ probe }}'", "{% if probe is defined %}side='{{ probe }}'{% endif %}",
         ("SM609", "side", "did you mean `probe`?")),
        ("'{{ probe }}'", "'{{ probe }}', 3",
         ("SM609", "3", "its parameters are `samples`, `probe`")),
        ("samples, probe):", "samples, probe, rate):",
         ("SM609", "Measure", "add `rate={{ rate }}` to the call, or give `rate` a default value"
          " in `__init__`")),
        ("if transitions is", "if transition is",
         ("SM605", "transition", "did you mean `transitions`?")),
    ],
)  # fmt: skip
def test_a_fault_in_a_body(old: str, new: str, expected: tuple[str, str, str]) -> None:
    assert findings(old, new) == [expected]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", ""),
        ("'{{ probe }}'", "probe='{{ probe }}'"),
        ("'{{ probe }}'", "{{ probe | quoted }}"),
        (", '{{ probe }}'", "{% if probe is defined %}, probe='{{ probe }}'{% endif %}"),
        ("{{ samples }}, '{{ probe }}'", "{{ arguments }}"),  # perhaps two
        ("{{ samples }}, '{{ probe }}'", "**{{ arguments }}"),
        ("{{ samples }}, '{{ probe }}'", "{% for each in given %}{{ each }}, {% endfor %}"),
        ("samples, probe):", "samples, probe=1):"),
        ("class Measure", "left = 3\nclass Measure"),
        ("{% if transitions is", "{% if remapping is defined %}{% endif %}{% if transitions is"),
    ],
)
def test_a_body_that_is_right_or_cannot_be_judged(old: str, new: str) -> None:
    assert [
        each for each in findings(old, new) if each[0] == "SM609" or "did you mean" in each[2]
    ] == []


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ("'{{ probe }}', {{ samples }}",
         [("SM609", "'{{ probe }}', {{ samples }}",
           "write `{{ class_name }}({{ samples }}, '{{ probe }}')`")]),
        ("{{ probe | exptostr }}, {{ samples }}",
         [("SM609", "{{ probe | exptostr }}, {{ samples }}",
           "write `{{ class_name }}({{ samples }}, {{ probe | exptostr }})`")]),
        ("{{ samples }}, {{ probe | exptostr }}", []),
    ],
)  # fmt: skip
def test_a_call_of_the_class_under_its_name_in_templates(
    arguments: str, expected: list[tuple[str, str, str]]
) -> None:
    old = "{{ '' }}Measure({{ samples }}, '{{ probe }}')"
    assert findings(old, f"{{{{ class_name }}}}({arguments})") == expected


def test_a_template_with_tags_that_begin_lines_between_brackets() -> None:
    old = """Measure({{ samples }}, '{{ probe }}'){% if transitions is defined %},
        {{ render_transitions(transitions) }}{% endif %})"""
    new = """Measure({{ samples }}, '{{ probe }}')
{%- if transitions is defined %},
        {{ render_transitions(transitions) }}{% endif %})"""
    assert findings(old, new) == []
    text = TEMPLATE.replace(old, new).replace("print(self._samples", "print(self._rate")
    files = {"main.yml": MAIN, "templates/Measure.tpl.py": text}
    found = [(each.code, each.help) for each in analysed(files).report]
    assert found == [("SM609", "did you mean `_samples`?")]


def test_a_text_that_is_a_name_of_the_template() -> None:
    text = TEMPLATE.replace("class Measure", "left = 3\nclass Measure")
    text = text.replace("'{{ probe }}'", "{{ probe }}")
    files = {"main.yml": MAIN, "templates/Measure.tpl.py": text}
    assert [each.code for each in analysed(files).report if each.code == "SM609"] == []

"""Classes in templates of SMACHA's kind whose constructors do not list a key that they use."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

META = """\
{% block meta %}
name: Weld
description: Welds one seam.
type: State
input_keys:
- current
output_keys:
- report
outcomes:
- welded
{% endblock meta %}
"""
TEMPLATE = """\
{% extends "State.tpl.py" %}
{% block class_defs %}
class Weld(smach.State):
    def __init__(self, input_keys=[], output_keys=[]):
        smach.State.__init__(self, outcomes=['welded'], LISTS)

    def execute(self, userdata):
        userdata.report = 'with {} A'.format(userdata.current)
        return 'welded'
{% endblock class_defs %}

{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Weld(),
{{ render_transitions(transitions) }})
{% endblock body %}
"""
MAIN = """\
name: sm
template: Base
outcomes: [done]
userdata: {current: 90.0}
output_keys: [report]
states:
  - WELD:
      template: Weld
      input_keys: [current]
      output_keys: [report]
      transitions: {welded: done}
"""


def findings(lists: str, template: str) -> list[tuple[str, str, str]]:
    text = template.replace("LISTS", lists)
    report = analysed({"main.yml": MAIN, "templates/Weld.tpl.py": text}).report
    return [(item.code, item.span.text, item.help or "") for item in report
            if item.code in ("SM308", "SM310", "SM609")]  # fmt: skip


ADD = "add `{}` to the `{}` of `smach.State.__init__`"


@pytest.mark.parametrize("template", [TEMPLATE, META + TEMPLATE])
@pytest.mark.parametrize(
    ("lists", "code", "key", "help"),
    [
        ("input_keys=['current']", "SM308", "report",
         ADD.format("report", "output_keys")),
        ("output_keys=['report']", "SM310", "current",
         ADD.format("current", "input_keys")),
        ("input_keys=['amps'], output_keys=['report']", "SM310", "current",
         ADD.format("current", "input_keys")),
    ],
)  # fmt: skip
def test_a_key_that_the_constructor_does_not_list(
    template: str, lists: str, code: str, key: str, help: str
) -> None:
    assert findings(lists, template) == [(code, key, help)]


def test_a_misspelt_key() -> None:
    lists = "input_keys=['current'], output_keys=['report']"
    text = TEMPLATE.replace("userdata.report", "userdata.reprot")
    assert findings(lists, text) == [("SM308", "reprot", "did you mean `report`?")]


@pytest.mark.parametrize("template", [TEMPLATE, META + TEMPLATE])
@pytest.mark.parametrize(
    "lists",
    [
        "input_keys=['current'], output_keys=['report']",
        "io_keys=['current', 'report']",
        "input_keys=input_keys, output_keys=output_keys",
        "input_keys=['current'] + KEYS, output_keys=KEYS",
        "**LISTS",
        "input_keys={{ input_keys }}, output_keys={{ output_keys }}",
        "input_keys=['current'])\n        self.register_output_keys(['report']",
    ],
)
def test_no_finding(template: str, lists: str) -> None:
    assert findings(lists, template) == []


def test_a_class_with_another_base_is_not_judged() -> None:
    text = TEMPLATE.replace("class Weld(smach.State)", "class Weld(Cell)")
    assert findings("input_keys=['current']", text) == []

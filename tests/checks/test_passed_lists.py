"""Classes of SMACHA's kind, whose constructors get the lists of names from the script."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

META = """\
{% block meta %}
name: Weigh
description: Averages samples: subtracts the tare.
type: State
input_keys:
- tare
output_keys:
- weight
outcomes:
- stable
- unstable
{% endblock meta %}
"""
BODY = """
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Weigh({{ render_input_keys(input_keys) }},
    {{ render_output_keys(output_keys) }}, {{ render_outcomes(outcomes) }}),
    {{ render_transitions(transitions) }})
{% endblock body %}
"""
TEMPLATE = """\
{% extends "State.tpl.py" %}
{% block class_defs %}
{{ super() }}
{% if 'class_Weigh' not in defined_headers %}
class Weigh(smach.State):
    def __init__(self, input_keys=[], output_keys=[], outcomes=['stable', 'unstable'],
                 callbacks={}):
        smach.State.__init__(self, input_keys=input_keys, output_keys=output_keys,
                             outcomes=outcomes)

    def execute(self, userdata):
        values = [1.0, 1.1]
        if max(values) - min(values) > 0.002:
            return 'unstable'
        userdata.weight = sum(values) - userdata.tare
        return 'stable'

{% do defined_headers.append('class_Weigh') %}
{% endif %}
{% endblock class_defs %}
"""
MAIN = """\
name: sm
template: Base
outcomes: [done, aborted]
userdata: {tare: 0.1}
output_keys: [weight]
states:
  - WEIGH:
      template: Weigh
      input_keys: [tare]
      output_keys: [weight]
      outcomes: [stable, unstable]
      transitions: {stable: done, unstable: aborted}
"""


def findings(template: str, main: str = MAIN) -> list[tuple[str, str, str]]:
    """Code, marked text and help of each finding above an info."""
    files = {"main.yml": main, "templates/Weigh.tpl.py": template}
    found = analysed(files).report
    return [(x.code, x.span.text, x.help or "") for x in found if x.severity.value != "info"]


TEMPLATES = [TEMPLATE, META + TEMPLATE + BODY, TEMPLATE.replace("input_keys=[],", "input_keys,")]


@pytest.mark.parametrize("template", TEMPLATES, ids=["no_meta", "meta", "required"])
@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", "", []),
        ("'unstable'\n", "'not_stable'\n", [("SM309", "'not_stable'", "did you mean `unstable`?")]),
        ("userdata.tare", "userdata.tear", [("SM310", "tear", "did you mean `tare`?")]),
        ("userdata.weight", "userdata.wieght", [("SM308", "wieght", "did you mean `weight`?")]),
        ("max(values)", "max(self.callbacks)",
         [("SM609", "callbacks", "write `self.callbacks = callbacks` in `__init__`")]),
        ("return 'stable'", "pass", [("SM309", "execute", "end each path with a `return`; return"
                                      " one of its outcomes: `stable`, `unstable`")]),
    ],
)  # fmt: skip
def test_the_code_is_compared_with_the_lists_of_the_script(
    template: str, old: str, new: str, expected: list[tuple[str, str, str]]
) -> None:
    assert old in template
    found = findings(template.replace(old, new) if old else template)
    assert [item for item in found if item[0] != "SM301"] == expected


@pytest.mark.parametrize(
    "template",
    [
        # The names are in a default value, in the code that adds the state, or in a further list.
        TEMPLATE.replace("'unstable']", "'unstable', 'other']"),
        META + TEMPLATE + BODY.replace("{{ render_outcomes(outcomes) }}", "['stable', 'other']"),
        TEMPLATE.replace("outcomes=outcomes)", "outcomes=outcomes + ['other'])"),
        TEMPLATE.replace("        smach.S", "        outcomes.append('other')\n        smach.S"),
        TEMPLATE.replace(
            "        smach.State", "        outcomes = [*outcomes, 'other']\n        smach.State"
        ),
    ],
)  # fmt: skip
def test_names_from_elsewhere(template: str) -> None:
    assert findings(template.replace("return 'unstable'", "return 'other'")) == []


def test_states_of_one_type_can_declare_different_names() -> None:
    first = (
        "      outcomes: [stable, unstable]\n      transitions: {stable: done, unstable: aborted}\n"
    )
    assert first in MAIN
    other = first.replace("unstable]", "unstable, heavy]").replace(
        "unstable:", "heavy: A, unstable:"
    )
    second = MAIN.partition("  - WEIGH:\n")[2]
    main = MAIN.replace(first, other) + "  - A:\n" + second
    assert findings(TEMPLATE.replace("return 'unstable'", "return 'heavy'"), main) == []

"""SM605 for a look-up that a template prints without quotes."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
  - LIGHT: {template: Lamp, channel: /front/lamp, transitions: {succeeded: DARK}}
  - DARK: {template: Lamp, channel: /rear/lamp, transitions: {succeeded: done}}
"""
TEMPLATE = """\
{% block meta %}
name: Lamp
outcomes:
- succeeded
{% endblock meta %}
{% block class_defs %}
class Lamp(smach.State):
    def __init__(self, channel):
        smach.State.__init__(self, outcomes=['succeeded'])
        self.channel = channel

    def execute(self, userdata):
        return 'succeeded'
{% endblock class_defs %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}',
        Lamp({{ channel }}){% if transitions is defined %},
        transitions={{ transitions }}{% endif %})
{% endblock body %}
"""


@pytest.mark.parametrize(
    ("template", "count"),
    [(TEMPLATE, 1), (TEMPLATE.replace("({{ channel }})", "('{{ channel }}')"), 0)],
)
def test_the_look_up_is_marked_once(
    template: str, count: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "main.yml").write_text(SCRIPT)
    (tmp_path / "templates" / "Lamp.tpl.py").write_text(template)
    main(["check", str(tmp_path / "main.yml")])
    printed = capsys.readouterr().out
    assert printed.count("error[SM605]") == count
    assert printed.count("help: write `'{{ channel }}'`") == count


QUOTED = TEMPLATE.replace("({{ channel }})", "('{{ channel }}')")


@pytest.mark.parametrize(
    ("template", "place", "help"),
    [
        (TEMPLATE.replace("({{ channel }})", "({{ channel }}, {{ channel | length }})"),
         "17:14", "help: write `'{{ channel }}'`"),
        (QUOTED.replace("'{{ name }}'", "'{{ name }}"), "16:1",
         "help: write the quotation mark at the end of the text; the printed line is"
         " `smach.StateMachine.add('LIGHT,`"),
        (QUOTED.replace("{% endif %})", "{% endif %}"), "16:1",
         "help: close the bracket with `)`; the printed line is"
         " `smach.StateMachine.add('LIGHT',`"),
        (QUOTED.replace("'{{ channel }}'", "{{ '5 6' }}, {{ '7 8' }}"), "17:14",
         "help: correct the value of `{{ '5 6' }}`, which is printed as `5 6`"),
        (QUOTED.replace("'{{ channel }}'", "'{{ channel }}' 7"), "17:9",
         "help: correct the printed line `Lamp('/front/lamp' 7),`"),
    ],
)  # fmt: skip
def test_the_line_of_the_template_is_marked(
    template: str, place: str, help: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "main.yml").write_text(SCRIPT)
    (tmp_path / "templates" / "Lamp.tpl.py").write_text(template)
    main(["check", str(tmp_path / "main.yml")])
    printed = capsys.readouterr().out
    assert f"Lamp.tpl.py:{place}\n" in printed
    assert help in printed

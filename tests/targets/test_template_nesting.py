"""Templates that are nested too deep are refused before Jinja compiles them."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

SCRIPT = """
name: sm
template: Base
outcomes: [done]
states:
  - WAVE: {template: Wave, transitions: {succeeded: done}}
"""
CLASS = """{{% block class_defs %}}
class Wave(smach.State):
    def __init__(self):
        super().__init__(outcomes=["succeeded"])

    def execute(self, userdata):
        return "succeeded"  # {inside}
{{% endblock %}}
"""


def faults(inside: str) -> list[str]:
    """The messages about a template with a text in it."""
    files = {
        "templates/Wave.yml": "name: Wave\noutcomes: [succeeded]\n",
        "templates/Wave.tpl.py": CLASS.format(inside=inside),
    }
    library = memory_library(files, BUILT_IN)
    report = analyse(Source("main.yml", SCRIPT), library, [], render=True).report
    return [item.message for item in report if item.code == "SM605"]


@pytest.mark.parametrize("count", [51, 60])
@pytest.mark.parametrize(
    ("before", "middle", "after"),
    [
        ("{{ %s1%s }}", "[", "]"),
        ("{{ %s1%s }}", "(", ")"),
        ("{{ %s1%s }}", "{1: ", "}"),
        ("%s1%s", "{% if 1 %}", "{% endif %}"),
        ("%s1%s", "{% for x in [1] %}", "{% endfor %}"),
        ("%s1%s", "{% filter upper %}", ""),
    ],
)
def test_deep_nesting_is_refused(before: str, middle: str, after: str, count: int) -> None:
    found = faults(before % (middle * count, after * count))
    assert found == ["the template has more than 50 levels of nesting"]


@pytest.mark.parametrize("count", [101, 150])
@pytest.mark.parametrize("part", [".b", "|int", "+1", "[0]~1", " and 1", " if 1 else 1"])
def test_long_expressions_are_refused(part: str, count: int) -> None:
    found = faults("{{ a" + part * count + " }}")
    assert found == ["the template has more than 100 operations in one expression"]


@pytest.mark.parametrize(
    "inside",
    [
        "{{ [" + "1 + 1, " * 1000 + "] }}",
        "{{ " + "[" * 40 + "1" + "]" * 40 + " }}",
        "{% if 1 %}1{% endif %}" * 1000,
        "{% set x = 1 %}" * 200 + "{% set y %}1{% endset %}" * 200,
    ],
)
def test_long_and_flat_templates_are_not_refused(inside: str) -> None:
    assert faults(inside) == []

"""The places and helps of findings about code in modules, headers and templates."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.trust.project_text import BUILT_IN

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - MOVE: {template: Move, transitions: {moved: GRASP, blocked: failed}}
  - GRASP: {template: Grasp, transitions: {held: done}}
"""
FILES = {
    "templates/Move.yml": "outcomes: {moved: {}, blocked: {failure: true}}\n"
    'code: {python: "cell.arm:Move"}\n',
    "templates/Grasp.yml": "outcomes: {held: {}}\n"
    'code: {python: "cell.arm:Grasp", cpp: {header: cell/grasp.hpp, class: "cell::Grasp"}}\n',
    "cell/arm.py": """\
import smach


class Move(smach.State):
    def __init__(self):
        super().__init__(outcomes=["moved", "blocked"])

    def execute(self, userdata):
        if self.drive() == 1:
            return "moved"
        return "blocked"

    def drive(self):
        return 1


class Grasp(smach.State):
    def __init__(self):
        super().__init__(outcomes=["held"])

    def execute(self, userdata):
        return "held"
""",
    "cell/grasp.hpp": """\
namespace cell {
class Grasp {
 public:
  enum class Outcome { held };
  Outcome execute() { return Outcome::held; }
  static constexpr std::uint32_t smachac_interface = 0x96ec0dfdU;
};
}  // namespace cell
""",
}


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            "cell/arm.py", 'return "blocked"', 'return "bloked"',
            ("SM309", '"bloked"', "did you mean `blocked`?"),
        ),
        (
            "cell/arm.py", 'return "blocked"', '"blocked"',
            ("SM309", '"blocked"', 'write `return "blocked"`'),
        ),
        ("cell/arm.py", "drive() == 1", "drive() = 1", ("SM608", "=", "write `==` to compare")),
        (
            "templates/Grasp.yml", "cell/grasp.hpp", "cell/grsp.hpp",
            ("SM608", "cell/grsp.hpp", "did you mean `cell/grasp.hpp`?"),
        ),
        (
            "templates/Grasp.yml", '"cell::Grasp"', '"cell::Grsp"',
            ("SM608", '"cell::Grsp"', "did you mean `Grasp`?"),
        ),
        (
            "cell/grasp.hpp", "  Outcome execute", "  explicit Grasp(Arm &arm);\n  Outcome execute",
            (
                "SM609", '"cell::Grasp"',
                'add `with: "cell::Arm& arm"` to `cpp` in the `code` of `Grasp.yml`',
            ),
        ),
        (
            "cell/arm.py", "def __init__(self):", "def __init__(self, limb):",
            (
                "SM609", "limb",
                "give `limb` a default value, or add it to the `variables` of `Move.yml` and set it"
                " at the state",
            ),
        ),
    ],
)  # fmt: skip
def test_a_slip_in_code_is_one_finding_at_its_place(
    file: str, old: str, new: str, expected: tuple[str, str, str]
) -> None:
    assert old in FILES[file]
    files = FILES | {file: FILES[file].replace(old, new, 1)}
    report = analyse(Source("main.yml", MAIN), memory_library(files, BUILT_IN), []).report
    found = [(item.code, item.span.text, item.help) for item in report]
    assert expected in found
    assert "SM315" not in [item[0] for item in found]
    assert [item for item in found if item[0] == "SM608"] == [expected][expected[0] != "SM608" :]


TEMPLATE = """\
{% block class_defs %}
class Move(smach.State):
    def __init__(self):
        super().__init__(outcomes=["moved", "blocked"])

    def execute(self, userdata):
        if {{ height | round }} < 2:
            return "moved"
        return "blocked"
{% endblock %}
"""


@pytest.mark.parametrize(
    ("old", "new", "marked", "help"),
    [
        ("round }}", "roud }}", "roud", "did you mean `round`?"),
        ("round }}", "round }", "}", "write `}}` at the end of the expression"),
        (
            "{{ height | round }} < 2:", "1 < 2", "if 1 < 2",
            "write `if 1 < 2:`",
        ),
    ],
)  # fmt: skip
def test_a_slip_in_a_template_is_at_its_word(old: str, new: str, marked: str, help: str) -> None:
    files = {
        "templates/Move.yml": "outcomes: {moved: {}, blocked: {failure: true}}\n",
        "templates/Move.tpl.py": TEMPLATE.replace(old, new, 1),
    }
    script = MAIN.replace("moved: GRASP", "moved: done").partition("  - GRASP")[0]
    report = analyse(
        Source("main.yml", script), memory_library(files, BUILT_IN), [], render=True
    ).report
    found = [(item.span.text, item.help) for item in report if item.code == "SM605"]
    assert found == [(marked, help)]


def test_a_parameter_of_another_name_is_one_finding() -> None:
    files = FILES | {
        "templates/Move.yml": "variables: {arm: str}\n" + FILES["templates/Move.yml"],
        "cell/arm.py": FILES["cell/arm.py"].replace("__init__(self):", "__init__(self, limb):", 1),
    }
    script = MAIN.replace("template: Move,", "template: Move, arm: left,")
    report = analyse(Source("main.yml", script), memory_library(files, BUILT_IN), []).report
    found = [(item.span.text, item.help) for item in report if item.code == "SM609"]
    assert found == [("limb", "rename the parameter `limb` to `arm`, which the script sets")]


def test_a_misspelt_outcome_in_a_header_is_one_finding() -> None:
    header = FILES["cell/grasp.hpp"].replace(
        "held };\n  Outcome execute() { return Outcome::held; }",
        "held, slipped, lost };\n  Outcome execute() {\n    if (closed()) return Outcome::held;\n"
        "    if (open()) return Outcome::slipped;\n    return Outcome::lst;\n  }",
    )
    header = header.replace("0x96ec0dfdU", "0xe985d29aU")
    assert "lst" in header
    files = FILES | {
        "cell/grasp.hpp": header,
        "templates/Grasp.yml": FILES["templates/Grasp.yml"].replace(
            "held: {}", "held: {}, slipped: {}, lost: {}"
        ),
    }
    report = analyse(Source("main.yml", MAIN), memory_library(files, BUILT_IN), []).report
    found = [(item.span.text, item.help) for item in report if item.code == "SM609"]
    assert found == [("lst", "did you mean `lost`?")]


def test_a_template_that_does_not_exist_is_reported_at_its_name() -> None:
    files = {
        "templates/Move.yml": "outcomes: {moved: {}, blocked: {failure: true}}\n"
        "code: {python: move.tpl.py}\n",
        "templates/Move.tpl.py": TEMPLATE,
    }
    script = MAIN.replace("moved: GRASP", "moved: done").partition("  - GRASP")[0]
    report = analyse(
        Source("main.yml", script), memory_library(files, BUILT_IN), [], render=True
    ).report
    found = [(item.span.text, item.help) for item in report if item.code == "SM605"]
    assert found == [("move.tpl.py", "did you mean `Move.tpl.py`?")]

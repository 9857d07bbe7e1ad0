"""The findings of stepped C++ machines, and their text."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import build, check, read_machine
from smachac.frontend.loader import memory_library
from smachac.targets.cpp import TARGET
from tests.cpp.compiled_traces import LIBRARY

STEP = {"mode": "step"}


def made(
    script: str, files: dict[str, str] | None = None, **options: str
) -> tuple[list[tuple[str, int, str | None]], dict[str, str]]:
    """The findings of a build, with their lines and helps, and its files."""
    library = memory_library(files or {}, LIBRARY)
    report: Report = []
    machine = read_machine(Source("main.yml", script), library, report)
    assert machine is not None, report
    checked = check(machine, report)
    assert checked is not None, report
    found: Report = []
    texts = build(checked, TARGET, library, found, {**STEP, **options})
    return [
        (item.finding.message, item.finding.span.line, item.finding.help) for item in found
    ], texts


TEXT = """
name: sm
outcomes: [done, failed]
userdata: {side: left, count: 0}
states:
  - NAME:
      template: ConditionalOutcomeState
      input_keys: [side]
      outcomes: [done, failed]
      default_outcome: failed
      callbacks: {done: 'lambda ud: ud.side == "left"'}
"""


def test_a_text_without_a_bound_is_a_finding() -> None:
    ((message, line, help_),), files = made(TEXT)
    assert message.endswith("the key `side`: `str` has no bound, and a stepped machine has no heap")
    assert line == 4
    assert help_ == "write `str<=32`, or `bounds = {text = 32, list = 8}` in smachac.toml"
    assert files == {}


def test_a_default_bound() -> None:
    findings, files = made(TEXT, text="16")
    assert findings == []
    assert "smachac::step::Key<smachac::step::TextOf<16>> side" in files["sm.hpp"]


@pytest.mark.parametrize("mark", ["throw", "std::string ", "std::vector", "#include <thread>"])
def test_nothing_of_the_heap_and_of_exceptions(mark: str) -> None:
    _, files = made(TEXT, text="16")
    assert mark not in files["sm.hpp"]


GRASP = """
name: sm
outcomes: [done]
states:
  - GRASP: {template: Grasp}
"""
INTERFACE = """
name: Grasp
input_keys: {force: float, part: "str<=16"}
output_keys: {width: float}
outcomes: {done: {}}
code: {cpp: {header: my_robot/grasp.hpp, class: "my_robot::Grasp"}}
"""
BLOCKING_CLASS = """
#include <smachac/smachac.hpp>
namespace my_robot {
class Grasp {
public:
  enum class Outcome { done };
  struct In { double force; const std::string &part; };
  struct Out { smachac::Key<double> &width; };
  static constexpr std::uint32_t smachac_interface = NUMBER;
  Outcome execute(In in, Out out) { out.width = in.force; return Outcome::done; }
};
}
"""
GIVEN = GRASP.replace("outcomes", "userdata: {force: 1.0, part: left}\noutcomes")


def with_class(text: str) -> dict[str, str]:
    from smachac.frontend.types.state_types import find_state_type
    from smachac.targets.cpp.user_classes import interface_hash

    files = {"templates/Grasp.yml": INTERFACE}
    type_ = find_state_type("Grasp", memory_library(files, LIBRARY), [])
    assert type_ is not None
    return {**files, "my_robot/grasp.hpp": text.replace("NUMBER", interface_hash(type_))}


def test_a_class_that_blocks_is_a_finding_with_the_code_to_write() -> None:
    ((message, line, help_),), files = made(GIVEN, with_class(BLOCKING_CLASS))
    assert message.endswith("`execute` of `my_robot::Grasp` blocks, and the class has no `step`")
    assert line == 6
    assert help_ == (
        "write `struct In { double force; std::string_view part; };"
        " struct Out { smachac::step::Key<double> &width; };"
        " smachac::step::Result<Outcome> step(smachac::step::Context &context, In in, Out out);`"
    )
    assert files == {}


STEP_CLASS = """
#include <smachac/step.hpp>
namespace my_robot {
class Grasp {
public:
  enum class Outcome : std::uint8_t { done };
  struct In { double force; std::string_view part; };
  struct Out { smachac::step::Key<double> &width; };
  static constexpr std::uint32_t smachac_interface = NUMBER;
  smachac::step::Result<Outcome> step(smachac::step::Context &context, In in, Out out) {
    out.width = in.force;
    return context.first ? smachac::step::Result<Outcome>(smachac::step::running) : Outcome::done;
  }
};
}
"""


def test_a_stepped_class() -> None:
    findings, files = made(GIVEN, with_class(STEP_CLASS))
    assert findings == []
    assert "::my_robot::Grasp GRASP;" in files["sm.hpp"]


def test_a_stepped_class_in_a_blocking_machine() -> None:
    ((message, _, help_),), _ = made(GIVEN, with_class(STEP_CLASS), mode="blocking")
    assert "`my_robot::Grasp` has `step` for stepped machines, and no `execute`" in message
    assert help_ is not None
    assert "mode=step" in help_


@pytest.mark.parametrize(
    ("type_", "words"),
    [
        ("dict[str, float]", "has no bound"),
        ("any", "has no bound"),
        ("list[str]<=4", "`str` has no bound"),
        ("JointState", "has no bound"),
    ],
)
def test_other_types_without_a_bound(type_: str, words: str) -> None:
    interface = INTERFACE.replace('"str<=16"', f'"{type_}"')
    files = {"templates/Grasp.yml": interface}
    script = GRASP.replace("outcomes", "input_keys: {force: float, part: any}\noutcomes")
    findings, _ = made(script, files)
    assert any(words in message for message, _, _ in findings)


@pytest.mark.parametrize(
    ("value", "words"),
    [("a text that is longer than sixteen bytes", "the bound is 16"), ("left", "")],
)
def test_a_constant_beyond_its_bound(value: str, words: str) -> None:
    findings, _ = made(TEXT.replace("side: left", f"side: {value}"), text="16")
    assert [words in message for message, _, _ in findings] == ([True] if words else [])


def test_an_expression_that_needs_the_heap() -> None:
    script = TEXT.replace('ud.side == "left"', "sorted([ud.count, 2]) == [1, 2]").replace(
        "input_keys: [side]", "input_keys: [side, count]"
    )
    ((message, _, _),), _ = made(script, text="16")
    assert "a stepped machine has no memory" in message

"""C++ classes that do not exist or cannot work as a state."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse, analyse_script, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.targets import load_target

SCRIPT = """
name: sm
outcomes: [done, lost]
states:
  - GRASP: {template: Grasp, transitions: {held: done, missed: lost}}
"""
INTERFACE = """
name: Grasp
outcomes: {held: {}, missed: {}}
code: {cpp: {header: arm/grasp.hpp, class: "arm::Grasp"}}
"""
CLASS = """\
#include "smachac/smachac.hpp"
namespace arm {
class Grasp {
public:
  enum class Outcome { held, missed };
  // Outcome::dropped was removed
  Outcome execute() { return closed() ? Outcome::held : Outcome::missed; }
  static constexpr std::uint32_t smachac_interface = 0x81314e29U;
};
}
"""
BUILT_IN = disk_library(Path("main.yml"), [])


def found(**headers: str) -> list[str]:
    files = {"main.yml": SCRIPT, "templates/Grasp.yml": INTERFACE}
    files |= {f"arm/{name}.hpp": text for name, text in headers.items()}
    report = analyse(Source("main.yml", SCRIPT), memory_library(files, BUILT_IN), []).report
    return [f"{item.code} {item.span} {item.message} {item.help}" for item in report]


def test_a_correct_class() -> None:
    assert found(grasp=CLASS) == []


@pytest.mark.parametrize(
    ("headers", "place", "words"),
    [
        ({"grasp": CLASS.replace(": Outcome::missed", ": Outcome::mised")},
         "SM609 arm/grasp.hpp:7:66",
         "`Outcome` of `arm::Grasp` has no `mised` did you mean `missed`?"),
        ({"grasp": CLASS.replace("execute", "run")}, "SM609 arm/grasp.hpp:3:7",
         "the class `arm::Grasp` has no method `execute`"),
        ({"grasp": CLASS.replace("class Grasp", "class Grip")}, "SM608 templates/Grasp.yml:4:44",
         "is defined in `arm/grasp.hpp` did you mean `Grip`?"),
        ({"grasp": CLASS.replace("class Grasp", "class Grip"), "held": CLASS},
         "SM608 templates/Grasp.yml:4:22", "but in `arm/held.hpp` write `arm/held.hpp`"),
        ({"grasp": CLASS.replace("class Grasp", "class Grip"), "held": "class Grasp;"},
         "SM608 templates/Grasp.yml:4:44", "is defined in `arm/grasp.hpp` did you mean `Grip`?"),
        ({"grisp": CLASS}, "SM608 templates/Grasp.yml:4:22", "did you mean `arm/grisp.hpp`?"),
    ],
)  # fmt: skip
def test_a_fault(headers: dict[str, str], place: str, words: str) -> None:
    (line,) = found(**headers)
    assert line.startswith(f"{place} ")
    assert words in line


@pytest.mark.parametrize(
    "text",
    [
        CLASS.replace("class Grasp {", "class Grasp : public Skill {").replace("execute", "run"),
        CLASS.replace("class Grasp", "class Grip") + '#include "arm/other.hpp"\n',
        CLASS.replace("class Grasp", "class Grip") + "using Grasp = Grip;\n",
        CLASS.replace("class Grasp", "SKILL(Grip)") + "#define SKILL(name) class name\n",
        CLASS.replace(": Outcome::missed", ": other::Outcome::mised"),
        CLASS.replace("{ held, missed }", "{ held, missed [[deprecated]] }").replace(
            "::held", "::h"
        ),
    ],
)
def test_what_cannot_be_judged(text: str) -> None:
    assert found(grasp=text) == []


def test_a_header_elsewhere_can_be_installed() -> None:
    assert found() == []


@pytest.mark.parametrize(("header", "known"), [("grsap.hpp", True), ("skills.hpp", False)])
def test_a_header_without_a_folder(header: str, known: bool) -> None:
    files = {
        "main.yml": SCRIPT,
        "templates/Grasp.yml": INTERFACE.replace("arm/grasp.hpp", header),
        "grasp.hpp": CLASS,
    }
    report = analyse(Source("main.yml", SCRIPT), memory_library(files, BUILT_IN), []).report
    expected = ["SM608 did you mean `grasp.hpp`?"] if known else []
    assert [f"{item.code} {item.help}" for item in report] == expected


def test_the_compiler_can_search_a_folder_of_the_project() -> None:
    interface = INTERFACE.replace("arm/grasp.hpp", "grasp.hpp")
    files = {"main.yml": SCRIPT, "templates/Grasp.yml": interface, "lib/grasp.hpp": CLASS}
    assert analyse(Source("main.yml", SCRIPT), memory_library(files, BUILT_IN), []).report == []


@pytest.mark.parametrize(
    ("files", "help"),
    [
        ({"grip/grasp.hpp": CLASS}, "did you mean `grip/grasp.hpp`?"),
        ({"grasp.hpp": CLASS}, "did you mean `grasp.hpp`?"),
        ({"grip/grasp.hpp": CLASS.replace("namespace arm", "namespace grip")}, None),
        ({"grip/grasp.hpp": CLASS.replace("class Grasp {", "class Grasp;")}, None),
        ({"grip/grasp.hpp": CLASS, "grap/grasp.hpp": CLASS}, None),
        ({"grip/other.hpp": CLASS}, None),
    ],
)
def test_a_header_in_another_folder(files: dict[str, str], help: str | None) -> None:
    given = {"main.yml": SCRIPT, "templates/Grasp.yml": INTERFACE, **files}
    report = analyse(Source("main.yml", SCRIPT), memory_library(given, BUILT_IN), []).report
    expected = [("SM608", "arm/grasp.hpp", help)] if help else []
    assert [(item.code, item.span.text, item.help) for item in report] == expected


PUSH = """
name: Push
variables: {speed: {type: float, default: 0.1}, name: {type: str, default: left}}
input_keys: {depth: float}
output_keys: {force: float}
outcomes: {done: {}, stuck: {}, preempted: {}}
code: {cpp: {header: arm/push.hpp, class: "arm::Push", with: "arm::Arm& arm"}}
"""
PUSH_CLASS = """\
#include "smachac/smachac.hpp"
namespace arm {
class Push {
public:
  enum class Outcome { done, stuck, preempted };
  struct In { double depth; };
  struct Out { smachac::Key<double> &force; };

  Push(Arm &arm, double speed, const std::string &name) : arm_(arm), speed_(speed), name_(name) {}

  Outcome execute(In in, Out out, smachac::Stop &stop) {
    while (!arm_.at(in.depth)) {
      if (stop.requested()) {
        stop.service();
        return Outcome::preempted;
      }
      if (arm_.force() > 10.0) return give_up();
    }
    out.force = arm_.force();
    return Outcome::done;
  }

private:
  Outcome give_up() { return Outcome::stuck; }
  Arm &arm_;
  double speed_;
  std::string name_;
  static constexpr std::uint32_t smachac_interface = 0xc15e9c14U;
};
}
"""
PUSH_SCRIPT = """
name: sm
outcomes: [done, lost, stopped]
userdata: {depth: 0.1}
output_keys: [force]
states:
  - PUSH: {template: Push, transitions: {done: done, stuck: lost, preempted: stopped}}
"""
SIGNATURE = "Outcome execute(In in, Out out, smachac::Stop &stop)"
STOP = PUSH_CLASS[PUSH_CLASS.index("      if (stop") : PUSH_CLASS.index("      if (arm_")]


def push_findings(*pairs: tuple[str, str]) -> list[str]:
    text = PUSH_CLASS
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": PUSH, "arm/push.hpp": text}
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    return [f"{item.code} {item.span.line} {item.span.text}: {item.help}" for item in report]


@pytest.mark.parametrize(
    ("pair", "found"),
    [
        (("  Outcome execute", "  bool execute"), f"11 bool: write `{SIGNATURE}`"),
        (("  Outcome execute", "  virtual std::string execute"), "11 std::string: write"),
        ((", smachac::Stop &stop", ""), f"11 In in, Out out: write `{SIGNATURE}`"),
        (("Stop &stop)", "Stop stop)"), "11 smachac::Stop stop: write `smachac::Stop &stop`"),
        (("smachac::Stop &stop)", "Stop halt)"), "11 Stop halt: write `smachac::Stop &halt`"),
        (("In in, ", ""), f"11 Out out, smachac::Stop &stop: write `{SIGNATURE}`"),
        (("Arm &arm, double speed, ", "Arm &arm, "),
         "9 Push: write `Push(Arm &arm, double speed, const std::string &name)`"),
        (("return give_up()", "return Outcome::done"), None),
        (("  Outcome give_up() { return Outcome::stuck; }\n", ""), None),
        ((STOP, ""), "5 preempted: add where it waits: `if (stop.requested()) { stop.service();"
         " return Outcome::preempted; }`"),
        (("    out.force = arm_.force();\n", ""),
         "7 force: write `out.force = ...` before a `return`, or"),
    ],
)  # fmt: skip
def test_members_of_a_class(pair: tuple[str, str], found: str | None) -> None:
    lines = push_findings(pair)
    if found is None:  # another method names the outcome, or it is not known
        assert lines == []
    else:
        (line,) = lines
        assert line.startswith(f"SM609 {found}")


def test_an_outcome_that_no_code_names() -> None:
    (line,) = push_findings(
        ("return give_up()", "return Outcome::done"), (" return Outcome::stuck;", " throw 1;")
    )
    assert line.startswith("SM609 11 execute: return it where it is meant, or remove it from")


def test_a_build_accepts_an_outcome_that_no_code_names() -> None:
    text = PUSH_CLASS.replace(STOP, "")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": PUSH, "arm/push.hpp": text}
    library = memory_library(files, BUILT_IN)
    checked = analyse(Source("main.yml", PUSH_SCRIPT), library, []).checked
    target, built = load_target("cpp"), list[Diagnostic]()
    assert checked is not None
    assert target is not None
    assert build(checked, target, library, built)
    assert built == []


@pytest.mark.parametrize(
    "pairs",
    [
        [],
        [("  Outcome execute", "  [[nodiscard]] auto execute"), ("Stop &stop) {", "Stop &) {")],
        [("{ return Outcome::stuck; }", ";"), (STOP, "")],
        [(STOP, ""), ("return Outcome::done", "return arm_.end<Outcome>()")],
        [(STOP, ""), ("return Outcome::done", "Outcome end = Outcome::done; return end")],
        [(STOP, ""), ("return Outcome::done", "return static_cast<Outcome>(2)")],
        [(SIGNATURE + " {", SIGNATURE + ";\n  void other(Out out) {"), (STOP, "")],
        [("    out.force = arm_.force();\n", "    arm_.fill(out);\n")],
        [("    out.force = arm_.force();\n", "    auto &[f] = out;\n")],
        [("  Push(Arm", "  template <class A> Push(A"), ("Out out, ", "")],
        [("const std::string &name)", "std::string name, int more = 1)"),
         ("name_(name)", "name_(name)")],
        [("  Push(Arm", "  Push() = default;\n  Push(Arm")],
    ],
)  # fmt: skip
def test_members_that_cannot_be_judged(pairs: list[tuple[str, str]]) -> None:
    assert push_findings(*pairs) == []


def test_a_class_without_the_number_of_its_interface() -> None:
    line = "  static constexpr std::uint32_t smachac_interface = 0x81314e29U;\n"
    assert line in CLASS
    (finding,) = found(grasp=CLASS.replace(line, ""))
    assert finding.startswith("SM609 arm/grasp.hpp:3:7 the class `arm::Grasp` does not contain")
    assert finding.endswith(
        "write in the class: `static constexpr std::uint32_t smachac_interface = 0x81314e29U;`"
    )
    assert found(grasp=CLASS.replace(line, "  SMACHAC_NUMBER(grasp)\n")) == []
    assert found(grasp=CLASS.replace(line, "").replace("class Grasp {", "class Grasp : B {")) == []


@pytest.mark.parametrize("wrong", ["0x81314g29U", "0x81314e29W", "1.5", "08131"])
def test_a_number_of_an_interface_that_is_no_number(wrong: str) -> None:
    (finding,) = found(grasp=CLASS.replace("0x81314e29U", wrong))
    assert finding.startswith(f"SM609 arm/grasp.hpp:8:54 `{wrong}` is no number of C++")
    assert finding.endswith("write `0x81314e29U`, the number of the interface")


def test_parameters_of_a_constructor_in_another_order() -> None:
    (line,) = push_findings(
        ("Arm &arm, double speed, const std::string &name)",
         "Arm &arm, const std::string &name, double speed)")
    )  # fmt: skip
    wanted = "Push(Arm &arm, double speed, const std::string &name)"
    assert line == f"SM609 9 const std::string &name, double speed: write `{wanted}`"


SETS = "    out.force = arm_.force();\n"
IN_LOOP = PUSH_CLASS[PUSH_CLASS.index("    while (") : PUSH_CLASS.index(SETS)]


@pytest.mark.parametrize(
    ("code", "marked"),
    [
        (SETS, []),
        (f"    if (arm_.full()) {{\n  {SETS}    }}\n", [15]),
        (f"    if (arm_.full()) return Outcome::done;\n{SETS}", [12]),
        (f"    if (arm_.full()) {{\n  {SETS}    }} else {{\n  {SETS}    }}\n", []),
        (f"    if (arm_.full()) {{\n  {SETS}    }} else {{\n      return give_up();\n    }}\n", []),
        (f"    if (arm_.full()) {{\n  {SETS}    }}\n    if (!arm_.full()) return give_up();\n", []),
        (f"    {{\n  {SETS}    }}\n", []),
        (f"    for (;;) {{\n      if (arm_.full()) return Outcome::done;\n{SETS}    }}\n", []),
        (f"    const auto set = [&] {{\n  {SETS}    }};\n    set();\n", []),
        ("    arm_.measure(out);\n    if (out.force.set()) return Outcome::done;\n", []),
    ],
)
def test_an_output_that_a_path_skips(code: str, marked: list[int]) -> None:
    text = PUSH_CLASS.replace(IN_LOOP, "").replace(SETS, code)
    interface = PUSH.replace("code:", "writes: {done: [force]}\ncode:")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": interface, "arm/push.hpp": text}
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    found = [item for item in report if "without setting its output key" in item.message]
    assert [item.span.line for item in found] == marked
    assert all(item.span.text == "return Outcome::done" for item in found)


def test_the_declaration_of_a_field_is_in_the_help() -> None:
    (line,) = push_findings(("struct In { double depth", "struct In { float depth"))
    help = "write `double depth`, or correct the interface in `Push.yml`"
    assert line == f"SM603 6 float: {help}"


def test_a_misspelt_type_of_the_interface_is_one_finding() -> None:
    interface = PUSH.replace("depth: float", "depth: flaot")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": interface, "arm/push.hpp": PUSH_CLASS}
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    assert [(item.code, item.span.text) for item in report] == [("SM017", "flaot")]


JUDGE = """
name: Judge
input_keys: {limit: float}
output_keys: {worst: float}
outcomes: {within: {}, outside: {}}
code: {cpp: {header: arm/judge.hpp, class: "arm::Judge"}}
"""
JUDGE_CLASS = """\
#include "smachac/smachac.hpp"
namespace arm {
class Judge {
public:
  enum class Outcome { within, outside };
  struct In { double limit; };
  struct Out { smachac::Key<double> &worst; };
  Outcome execute(In in, Out out) {
    if (empty()) return Outcome::outside;
    out.worst = measured();
    return in.limit > 1.0 ? Outcome::within : Outcome::outside;
  }
  static constexpr std::uint32_t smachac_interface = 0x375625f1U;
};
}
"""
JUDGE_SCRIPT = """
name: sm
outcomes: [good, bad]
userdata: {limit: 0.4}
states:
  - JUDGE: {template: Judge, transitions: {within: good, outside: WRITE}}
  - WRITE: {template: PrintUserdataState, input_keys: [worst], transitions: {succeeded: bad}}
"""

EARLY = "    if (empty()) return Outcome::outside;\n"
SET = "    out.worst = measured();\n"


@pytest.mark.parametrize(
    ("script", "old", "new", "count"),
    [
        (JUDGE_SCRIPT, "", "", 1),
        (JUDGE_SCRIPT, EARLY, "", 0),
        (JUDGE_SCRIPT, EARLY + SET, SET + EARLY, 0),
        (JUDGE_SCRIPT, "if (empty())", "while (empty())", 0),
        (JUDGE_SCRIPT, "if (empty())", "if (fill(out))", 0),
        (JUDGE_SCRIPT.replace("{limit: 0.4}", "{limit: 0.4, worst: 0.0}"), "", "", 0),
        (JUDGE_SCRIPT.replace("[worst]", "[limit]"), "", "", 0),
        (JUDGE_SCRIPT.replace("{within: good, outside: WRITE}", "{within: WRITE, outside: bad}"),
         "", "", 0),
    ],
)  # fmt: skip
def test_a_return_before_an_output_that_is_read(
    script: str, old: str, new: str, count: int
) -> None:
    text = JUDGE_CLASS
    text = text.replace(old, new) if old else text
    files = {"main.yml": script, "templates/Judge.yml": JUDGE, "arm/judge.hpp": text}
    report = analyse(Source("main.yml", script), memory_library(files, BUILT_IN), []).report
    found = [item for item in report if item.code in ("SM604", "SM608", "SM609")]
    assert [item.span.text for item in found] == ["return Outcome::outside"] * count
    for item in found:
        assert (
            "returns `Outcome::outside` here before its output key `worst` is set" in item.message
        )


def test_the_outcome_that_nothing_returns_is_meant() -> None:
    (line,) = found(grasp=CLASS.replace(": Outcome::missed", ": Outcome::empty"))
    assert line.endswith("did you mean `missed`?")


@pytest.mark.parametrize(
    ("place", "help"),
    [
        ("include/arm", "did you mean `arm/grasp.hpp`?"),
        ("lib", None),
    ],
)
def test_a_header_whose_folder_is_missing(tmp_path: Path, place: str, help: str | None) -> None:
    interface = INTERFACE.replace("arm/grasp.hpp", "grasp.hpp")
    for name, text in (
        ("main.yml", SCRIPT),
        ("templates/Grasp.yml", interface),
        (f"{place}/grasp.hpp", CLASS),
    ):
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    report = analyse_script(tmp_path / "main.yml").report
    assert [(item.code, item.help) for item in report] == ([("SM608", help)] if help else [])


@pytest.mark.parametrize(
    ("value", "help"),
    [
        ("measured()", "write `out.force = ...` before this `return`, or remove"),
        ("force", "write `out.force = force;` before this `return` too"),
        ("inner", "write `out.force = ...` before this `return`, or remove"),
    ],
)
def test_an_assignment_that_is_too_late(value: str, help: str) -> None:
    code = (
        "    const double force = arm_.now();\n"
        "    if (force > 0) { const double inner = force; }\n"
        "    if (arm_.full()) return Outcome::done;\n"
        f"    out.force = {value};\n"
    )
    text = PUSH_CLASS.replace(IN_LOOP, "").replace(SETS, code)
    interface = PUSH.replace("code:", "writes: {done: [force]}\ncode:")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": interface, "arm/push.hpp": text}
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    (found,) = [item for item in report if "without setting its output key" in item.message]
    assert found.help is not None
    assert found.help.startswith(help)


@pytest.mark.parametrize(
    ("type_", "field", "wanted"),
    [
        ("float<rad>[6]", "const std::vector<double> &", "const std::array<double, 6> &"),
        ("float<rad>[6]", "const std::array<double, 7> &", "const std::array<double, 6> &"),
        ("list[str]", "const std::vector<double> &", "const std::vector<std::string> &"),
        ("list[float]", "double", "const std::vector<double> &"),
        ("list[float]", "const std::vector<smachac::Pose> &", "const std::vector<double> &"),
        ("float?", "double", "const std::optional<double> &"),
        ("float<rad>[6]", "const Joints &", None),
        ("list[str]", "const std::vector<Name> &", None),
        ("float<rad>[6]", "const std::array<double, JOINTS> &", None),
        ("float<rad>[6]", "const std::array<double,6>& ", None),
        ("list[Pose]", "const std::vector<smachac::Pose> &", None),
    ],
)
def test_the_type_of_a_field_with_items(type_: str, field: str, wanted: str | None) -> None:
    text = PUSH_CLASS.replace("struct In { double depth", f"struct In {{ {field}depth")
    text = text.replace("doubledepth", "double depth")
    files = {
        "main.yml": PUSH_SCRIPT.replace("{depth: 0.1}", "{depth: null}"),
        "templates/Push.yml": PUSH.replace("depth: float", f"depth: '{type_}'"),
        "arm/push.hpp": text,
    }
    report = analyse(
        Source("main.yml", files["main.yml"]), memory_library(files, BUILT_IN), []
    ).report
    found = [item.message + str(item.help) for item in report if "In::depth" in item.message]
    assert len(found) == (wanted is not None)
    assert all(f"{wanted}depth" in item for item in found)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("execute(In in, Out out, ", "execute(Out out, ", "lacks the parameter `In in`"),
        ("execute(In in, Out out, ", "execute(", "lacks the parameters `In in` and `Out out`"),
        ("execute(In in, ", "execute(double in, int more, ", "has other parameters than its"),
    ],
)
def test_the_message_names_the_parameter_that_is_missing(old: str, new: str, words: str) -> None:
    files = {
        "main.yml": PUSH_SCRIPT,
        "templates/Push.yml": PUSH,
        "arm/push.hpp": PUSH_CLASS.replace(old, new),
    }
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    (found,) = [item for item in report if item.code == "SM609"]
    assert found.message.startswith(f"`execute` of `arm::Push` {words}")


def test_the_uses_of_a_wrong_outcome_are_in_the_help() -> None:
    (line,) = push_findings(
        ("{ done, stuck", "{ done, blocked"), ("Outcome::stuck", "Outcome::blocked")
    )
    assert line.startswith("SM603 5 blocked: write `stuck` in place of `blocked`, also in line 24,")


def test_the_field_of_a_new_key_is_in_the_help() -> None:
    interface = PUSH.replace("{force: float}", "{force: float, slip: 'list[float]'}")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": interface, "arm/push.hpp": PUSH_CLASS}
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    (found,) = [item for item in report if item.code == "SM604"]
    assert "write `smachac::Key<std::vector<double>> &slip;` in `Out`, then" in str(found.help)


def test_the_local_variable_that_is_meant() -> None:
    text = PUSH_CLASS.replace(SETS, "    const double force = arm_.now();\n" + "    log(force);\n")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": PUSH, "arm/push.hpp": text}
    report = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    (found,) = [item for item in report if "never sets its output key" in item.message]
    assert found.help == "write `out.force = force;` before the `return`"

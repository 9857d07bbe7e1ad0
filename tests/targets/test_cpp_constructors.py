"""C++ classes that do not fit what a program passes, and calls whose result is not used."""

from __future__ import annotations

import re

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.loader import memory_library
from smachac.targets import load_target
from smachac.targets.cpp.user_classes import interface_hash
from tests.targets.test_cpp_code_faults import (
    BUILT_IN,
    INTERFACE,
    PUSH,
    PUSH_CLASS,
    PUSH_SCRIPT,
    SCRIPT,
)


def reports(script: str, files: dict[str, str], type_: str) -> tuple[list[Diagnostic], bool]:
    """The findings of a script, and whether a build of it succeeds. The classes get the number of
    their interface."""
    for _ in range(2):
        library = memory_library({"main.yml": script, **files}, BUILT_IN)
        analysis = analyse(Source("main.yml", script), library, [])
        assert analysis.machine is not None
        number = interface_hash(analysis.machine.state_types[type_])
        files = {
            name: re.sub(r"(smachac_interface = )0x\w+", rf"\g<1>{number}", text)
            for name, text in files.items()
        }
    target = load_target("cpp")
    assert target is not None
    assert analysis.checked is not None
    return analysis.report, bool(build(analysis.checked, target, library, []))


def push_reports(with_: str, *pairs: tuple[str, str]) -> tuple[list[Diagnostic], bool]:
    text, interface = PUSH_CLASS, PUSH.replace("arm::Arm& arm", with_)
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new, 1)
    return reports(PUSH_SCRIPT, {"templates/Push.yml": interface, "arm/push.hpp": text}, "Push")


TAKES = "Arm &arm, double speed, const std::string &name"


@pytest.mark.parametrize(
    ("with_", "takes", "place", "message", "help"),
    [
        ("arm::Arm& arm", "double speed, Arm &arm, const std::string &name",
         "double speed, Arm &arm",
         "takes its parameters in another order than the program passes them: first the objects of"
         " `with` in `Push.yml`, then its variables", f"write `Push({TAKES})`"),
        ("arm::Arm& arm", f"Arm &arm, Log &log, {TAKES[10:]}", '"arm::Arm& arm"',
         "takes `Log &log`, which is neither in `with` nor a variable of `Push.yml`",
         'write `with: "arm::Arm& arm, arm::Log& log"` in `Push.yml`, or remove the parameter from'
         " the class"),
        ("arm::Arm& arm, arm::Log& log", TAKES, "Push",
         "lacks `arm::Log &log` which `with` in `Push.yml` passes",
         f"write `Push(Arm &arm, arm::Log &log, {TAKES[10:]})`"),
        ("arm::Arm& arm", "Arm &arm, const std::string &name", "Push",
         "lacks `double speed` of `Push.yml`", f"write `Push({TAKES})`"),
        ("arm::Arm& arm", f"{TAKES}, int tries", "int tries",
         "takes `int tries`, which is not a variable of `Push.yml`",
         f"write `Push({TAKES})`, or add `tries: {{type: int}}` to the `variables` of `Push.yml`"),
        ("arm::Arm& arm", "Arm &arm, double speed, double name", "double name",
         "takes `double name`, but the program passes a `std::string`",
         "write `const std::string &name_`"),
        ("arm::Arm& arm", "Arm &arm, double speed, const std::vector<int> &name",
         "const std::vector<int> &name",
         "takes `const std::vector<int> &name`, but the program passes a `std::string`",
         "write `const std::string &name_`"),
    ],
)  # fmt: skip
def test_a_constructor_that_does_not_fit(
    with_: str, takes: str, place: str, message: str, help: str
) -> None:
    used = ("speed_(speed)", "speed_(speed), log_(log)" if "Log &log" in takes else "speed_(speed)")
    (found,), built = push_reports(with_, (TAKES, takes), used)
    assert not built
    assert (found.code, found.span.text) == ("SM609", place)
    assert found.message == f"the constructor of `arm::Push` {message}"
    assert (found.help, found.effect) == (help, "the C++ compiler refuses the class")


@pytest.mark.parametrize(
    "takes",
    [
        "Arm &arm_, double velocity, std::string where",
        "Device &arm, Speed speed, Name name",
        "Arm &arm, bool speed, const char *name",
        "Arm &arm, float speed, std::string_view name",
    ],
)
def test_constructors_that_fit(takes: str) -> None:
    assert push_reports("arm::Arm& arm", (TAKES, takes)) == ([], True)


def test_an_order_that_compiles_is_no_error_of_a_build() -> None:
    interface = PUSH.replace("name: {type: str, default: left}", "depth: {type: float, default: 1}")
    text = PUSH_CLASS.replace(TAKES, "Arm &arm, double depth, double speed")
    text = text.replace("name_(name)", "name_()")
    files = {"templates/Push.yml": interface, "arm/push.hpp": text}
    (found,), built = reports(PUSH_SCRIPT, files, "Push")
    assert built
    assert found.effect is not None
    assert found.effect.startswith("it compiles, but `depth` gets the value of `speed` and `speed`")


def test_a_class_for_another_version_lacks_a_parameter() -> None:
    interface = PUSH.replace("name: {type: str", "turns: {type: int, default: 1}, name: {type: str")
    files = {"main.yml": PUSH_SCRIPT, "templates/Push.yml": interface, "arm/push.hpp": PUSH_CLASS}
    (found,) = analyse(Source("main.yml", PUSH_SCRIPT), memory_library(files, BUILT_IN), []).report
    assert (found.code, found.span.text) == ("SM604", "Push")
    assert found.message.endswith(
        "another version of `Push.yml`: its constructor lacks `std::int64_t turns`"
    )
    assert found.help is not None
    wanted = "Push(Arm &arm, double speed, std::int64_t turns, const std::string &name)"
    assert found.help.startswith(f"write `{wanted}`, then set `smachac_interface` to 0x")


FETCH = INTERFACE.replace("missed: {}", "lost: {}, missed: {failure: true}")
TAKE = """\
#include "arm/devices.hpp"
namespace arm {
class Grasp {
public:
  explicit Grasp(Device &device) : device_(device) {}
  enum class Outcome { held, lost, missed };
  Outcome execute() {
    device_.take(left());
    return Outcome::held;
  }
  static constexpr std::uint32_t smachac_interface = 0x81314e29U;
  Outcome other() { return Outcome::lost; }
  Device &device_;
};
}
"""
DEVICES = "namespace arm {\nclass Device {\npublic:\n  bool take(int limb);\n};\n}\n"


@pytest.mark.parametrize(
    ("pair", "marked", "help"),
    [
        (("", ""), "device_.take(left());\n    return Outcome::held",
         "write `return device_.take(left()) ? Outcome::held : Outcome::missed;`"),
        (("    return Outcome::held;", "    log();\n    return Outcome::held;"),
         "device_.take(left())", "write `if (!device_.take(left())) return Outcome::missed;`"),
        (("take(", "is_missed("), "device_.is_missed(left());\n    return Outcome::held",
         "write `return device_.is_missed(left()) ? Outcome::missed : Outcome::held;`"),
        (("bool take", "void take"), "execute", None),
        (("bool take", "bool take(); bool take"), "execute", None),
        (("    device_.take", "    const bool held = device_.take"), "execute", None),
        (("    device_", "    device_.take(1);\n    device_"), "execute", None),
        (("lost()", "none()"), "device_.take(left());\n    return Outcome::held",
         "write `return device_.take(left()) ? Outcome::held : Outcome::missed;`"),
    ],
)  # fmt: skip
def test_a_result_that_decides_an_outcome(
    pair: tuple[str, str], marked: str, help: str | None
) -> None:
    script = SCRIPT.replace("held: done", "held: done, lost: lost")
    interface = FETCH.replace("class:", 'with: "arm::Device& device", class:')
    header, devices = (text.replace(*pair) for text in (TAKE, DEVICES))
    files = {"templates/Grasp.yml": interface, "arm/grasp.hpp": header, "arm/devices.hpp": devices}
    (found,), built = reports(script, files, "Grasp")
    assert built
    assert found.span.text == marked
    assert found.message.startswith("`execute` of `arm::Grasp` never returns `Outcome::missed`")
    if help is not None:
        assert found.help == help

"""State types that are classes of C++: called, made, checked against their interfaces."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.frontend.types.state_types import find_state_type
from smachac.targets.cpp import TARGET
from smachac.targets.cpp.user_classes import interface_hash
from tests.cpp.compilers import BARE, COMPILERS, Compiler, last_with

PING = """
name: ping
outcomes: [done]
userdata: {count: 0}
states:
  - PING: {template: Hit, by: 2, remapping: {total: count}, transitions: {again: PONG}}
  - PONG: {template: Hit, remapping: {total: count}, transitions: {again: PING}}
"""
HIT = """
name: Hit
variables: {by: {type: int, default: 1}}
input_keys: {total: int}
output_keys: {total: int}
outcomes: {again: {}, done: {}}
code: {cpp: {header: game/hit.hpp, class: game::Hit, with: "const game::Rules& rules"}}
"""
HEADER = """
#include "smachac/smachac.hpp"
namespace game {
struct Rules { std::int64_t most; };
class Hit {
public:
  enum class Outcome { again, done };
  struct In { std::int64_t total; };
  struct Out { smachac::Key<std::int64_t> &total; };
  static constexpr std::uint32_t smachac_interface = HASH;

  Hit(const Rules &rules, std::int64_t by) : rules_(rules), by_(by) {}
  Outcome execute(In in, Out out) {
    out.total = in.total + by_;
    return out.total.get() < rules_.most ? Outcome::again : Outcome::done;
  }
private:
  const Rules &rules_;
  std::int64_t by_;
};
}
"""
MAIN = """
#include "ping.hpp"
int main() {
  const game::Rules rules{5};
  ping::States states(rules);
  ping::Userdata userdata;
  smachac::Stop stop;
  smachac::TraceWriter trace(stdout);
  const ping::Outcome outcome = ping::run(states, userdata, &trace, stop);
  return outcome == ping::Outcome::done && userdata.count.get() == 5 ? 0 : 1;
}
"""
CAUGHT = """
#include <cstdio>
#include "ping.hpp"
int main() {
  const game::Rules rules{5};
  ping::States states(rules);
  ping::Userdata userdata;
  smachac::Stop stop;
  try {
    ping::run(states, userdata, nullptr, stop);
  } catch (const smachac::StateError &error) {
    std::puts(error.what());
  }
}
"""


def made(files: Mapping[str, str]) -> tuple[Report, str]:
    """The report of building `main.yml`, and the header."""
    library = memory_library(files, disk_library(Path("main.yml"), []))
    report: Report = []
    analysis = analyse(Source("main.yml", files["main.yml"]), library, report)
    assert analysis.checked is not None, analysis.report
    built: Report = []
    printed = build(analysis.checked, TARGET, library, built)
    return built, next(iter(printed.values()), "")


def number(interface: str, name: str = "Hit") -> str:
    files = {f"templates/{name}.yml": interface}
    library = memory_library(files, disk_library(Path("main.yml"), []))
    type_ = find_state_type(name, library, [])
    assert type_ is not None
    return interface_hash(type_)


def prepared(folder: Path, header: str, hit: str = HIT) -> list[str]:
    """A folder with the machine and the class; the flags to find them."""
    report, text = made({"main.yml": PING, "templates/Hit.yml": hit})
    assert report == []
    (folder / "game").mkdir()
    (folder / "game" / "hit.hpp").write_text(header)
    (folder / "ping.hpp").write_text(text)
    return [f"-I{folder}", "-pthread"]


@COMPILERS
@pytest.mark.slow
def test_a_class_is_made_and_called(compiler: Compiler, tmp_path: Path) -> None:
    flags = prepared(tmp_path, HEADER.replace("HASH", number(HIT)))
    told = compiler.run(MAIN, tmp_path, *flags)
    assert [line for line in told.splitlines() if '"write"' in line][-1].count('"value": 5') == 1
    assert told.count('"event": "enter"') == 3


@COMPILERS
@pytest.mark.slow
def test_a_class_that_returns_no_outcome_fails(compiler: Compiler, tmp_path: Path) -> None:
    header = HEADER.replace("Outcome::again : ", "Outcome{7} : ").replace("HASH", number(HIT))
    told = compiler.run(CAUGHT, tmp_path, *prepared(tmp_path, header))
    assert told == "ping/PING (main.yml:6): ended without an outcome\n"


@COMPILERS
@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (("HASH", "1U"), "game::Hit was written for another Hit.yml"),
        (("std::int64_t total;", "double total;"), "game::Hit::In::total must be std::int64_t"),
        (("Key<std::int64_t>", "Key<double>"), "game::Hit::Out::total must be"),
        (("again, done }", "again, done, lost }"), "enumeration value .lost. not handled"),
    ],
)
@pytest.mark.slow
def test_a_class_for_another_interface_does_not_compile(
    compiler: Compiler, wrong: tuple[str, str], message: str, tmp_path: Path
) -> None:
    header = HEADER.replace(*wrong).replace("HASH", number(HIT))
    flags = prepared(tmp_path, header)
    with pytest.raises(AssertionError, match=message):
        compiler.compile(MAIN, tmp_path, *flags, "-fsyntax-only", warnings=False)


SORT = """
name: sm
outcomes: [done]
input_keys: {here: Pose, there: Pose, first: bool, last: bool, count: int, note: any}
states:
  - SORT: {template: Hit, transitions: {done: done}}
"""
SORTER = """
name: Hit
input_keys: {here: Pose, there: Pose, first: bool, last: bool, count: int, note: any}
output_keys: {left: str, right: str}
outcomes: {done: {}}
code: {cpp: {header: game/hit.hpp, class: "game::Hit"}}
"""
IN = [
    "const smachac::Pose &here", "const smachac::Pose &there", "bool first", "bool last",
    "std::int64_t count", "const std::any &note",
]  # fmt: skip
OUT = ["smachac::Key<std::string> &left", "smachac::Key<std::string> &right"]
SORTING = """
#include "smachac/smachac.hpp"
namespace game {
struct Hit {
  enum class Outcome { done };
  struct In { IN; };
  struct Out { OUT; };
  static constexpr std::uint32_t smachac_interface = HASH;
  Outcome execute(In in, Out out) {
    out.left = in.first ? "first" : "";
    out.right = in.last ? "last" : "";
    return Outcome::done;
  }
};
}
#include "sm.hpp"
int main() { return 0; }
"""


@COMPILERS
@pytest.mark.parametrize(
    ("part", "one", "other"),
    [
        ("", 0, 0),
        ("In", 0, 1),
        ("In", 2, 3),
        ("In", 3, 4),
        ("In", 0, 5),
        ("In", 4, 5),
        ("Out", 0, 1),
    ],
)
@pytest.mark.slow
def test_the_order_of_fields_is_that_of_the_interface(
    compiler: Compiler, part: str, one: int, other: int, tmp_path: Path
) -> None:
    """Two of one type would be taken for one another: nothing but their names tells them apart."""
    fields = {"In": [*IN], "Out": [*OUT]}
    if part:
        some = fields[part]
        some[one], some[other] = some[other], some[one]
    report, text = made({"main.yml": SORT, "templates/Hit.yml": SORTER})
    assert report == []
    (tmp_path / "game").mkdir()
    (tmp_path / "game" / "hit.hpp").write_text("#pragma once\n")
    (tmp_path / "sm.hpp").write_text(text)
    program = SORTING.replace("HASH", number(SORTER))
    for name, texts in fields.items():
        program = program.replace(f"{name.upper()};", f"{'; '.join(texts)};")
    if not part:
        compiler.run(program, tmp_path, f"-I{tmp_path}", "-pthread")
        return
    with pytest.raises(
        AssertionError, match=f"game::Hit::{part} must have its fields in the order"
    ):
        compiler.compile(
            program, tmp_path, f"-I{tmp_path}", "-fsyntax-only", "-pthread", warnings=False
        )


@pytest.mark.parametrize(
    "other",
    [
        HIT.replace("total: int", "total: float"),
        HIT.replace("done: {}", "over: {}"),
        HIT.replace("by: {type: int", "step: {type: int"),
        HIT.replace("outcomes: {", "blocking: true\noutcomes: {"),
    ],
)
def test_the_number_of_an_interface_is_its_own(other: str) -> None:
    assert number(other) != number(HIT)


def test_docs_and_claims_do_not_change_the_number() -> None:
    assert number(HIT + "doc: Hits it.\nclaims: [bat]\n") == number(HIT)


ROUTE = """
name: Hit
input_keys: {route: TYPE}
output_keys: {rest: TYPE}
outcomes: {done: {}}
code: {cpp: {header: game/hit.hpp, class: "game::Hit"}}
"""
ROUTED = """
name: sm
outcomes: [done]
input_keys: {route: TYPE}
states:
  - GO: {template: Hit, transitions: {done: done}}
"""


@pytest.mark.parametrize(
    "type_", ["nav_msgs/Path", "list[nav_msgs/Path]", "nav_msgs/Path?", "my_robot.Route"]
)
def test_a_type_that_cpp_lacks_in_an_interface_is_refused_at_its_key(type_: str) -> None:
    """It crashed: the assertions for the class need a C++ type for each key."""
    files = {"main.yml": ROUTED, "templates/Hit.yml": ROUTE}
    report, text = made({name: each.replace("TYPE", f'"{type_}"') for name, each in files.items()})
    assert text == ""
    first = next(item for item in report if "`route`" in item.message)
    assert (first.code, first.span.line) == ("SM601", 4)
    assert "the key `route`: the members of the type `" in first.message
    assert first.help is not None
    assert "declare the key as `any`" in first.help


def test_a_type_that_cpp_lacks_in_one_interface_only_is_refused() -> None:
    files = {
        "main.yml": ROUTED.replace("TYPE", "none"),
        "templates/Hit.yml": ROUTE.replace("TYPE", '"nav_msgs/Path?"'),
    }
    report, text = made(files)
    assert text == ""
    assert {item.code for item in report} == {"SM601"}


TWO = """
name: sm
outcomes: [done]
states:
  - LEFT: {template: Left, transitions: {done: INNER}}
  - INNER:
      template: StateMachine
      outcomes: [done]
      states:
        - RIGHT: {template: Right, transitions: {done: WAIT}}
        - WAIT: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
      transitions: {done: AGAIN}
  - AGAIN: {template: Left, transitions: {done: done}}
"""
STATE = """
name: NAME
outcomes: {done: {}}
code: {cpp: {header: game/hit.hpp, class: "game::NAME", with: "WITH"}}
"""
LEFT = STATE.replace("NAME", "Left").replace("WITH", "game::Arm& robot")
RIGHT = STATE.replace("NAME", "Right").replace(
    "WITH", "game::Base& robot, const std::map<std::string, int>& speeds"
)
TWO_CLASSES = """
#pragma once
#include <map>
#include "smachac/smachac.hpp"
namespace game {
struct Arm { int moves = 0; };
struct Base { int moves = 0; };
class Left {
public:
  enum class Outcome { done };
  static constexpr std::uint32_t smachac_interface = LEFT;
  explicit Left(Arm &arm) : arm_(arm) {}
  Outcome execute() { ++arm_.moves; return Outcome::done; }
private:
  Arm &arm_;
};
class Right {
public:
  enum class Outcome { done };
  static constexpr std::uint32_t smachac_interface = RIGHT;
  Right(Base &base, const std::map<std::string, int> &speeds) : base_(base), speeds_(speeds) {}
  Outcome execute() { base_.moves += speeds_.at("slow"); return Outcome::done; }
private:
  Base &base_;
  const std::map<std::string, int> &speeds_;
};
}
"""
TWO_MAIN = """
#include "sm.hpp"
int main() {
  game::Arm arm;
  game::Base base;
  const std::map<std::string, int> speeds{{"slow", 7}};
  sm::States states(arm, base, speeds);
  sm::Userdata userdata;
  smachac::Stop stop;
  sm::run(states, userdata, nullptr, stop);
  return arm.moves == 2 && base.moves == 7 ? 0 : 1;
}
"""


@pytest.mark.slow
def test_classes_take_several_objects_and_objects_of_one_name(tmp_path: Path) -> None:
    """Two objects of one name and different types had one parameter."""
    files = {"main.yml": TWO, "templates/Left.yml": LEFT, "templates/Right.yml": RIGHT}
    report, text = made(files)
    assert report == []
    head = "States(game::Base &robot_2, const std::map<std::string, int> &speeds)"
    assert f"  {head}\n      : RIGHT(robot_2, speeds) {{}}" in text
    (tmp_path / "game").mkdir()
    (tmp_path / "sm.hpp").write_text(text)
    header = TWO_CLASSES.replace("LEFT", number(LEFT, "Left"))
    (tmp_path / "game" / "hit.hpp").write_text(header.replace("RIGHT", number(RIGHT, "Right")))
    last_with("-O0").run(TWO_MAIN, tmp_path, f"-I{tmp_path}", "-pthread", "-Weffc++")


RACE = """
name: sm
outcomes: [done]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      output_keys: [pose]
      states:
        # smachac: allow SM405 one of them comes first
        - LEFT: {template: ScriptedState, outcomes: [ok], output_keys: [pose]}
        # smachac: allow SM405 one of them comes first
        - RIGHT: {template: ScriptedState, outcomes: [ok], KEYS}
      transitions: {done: done}
"""


@pytest.mark.parametrize("keys", ["output_keys: [pose]", "input_keys: [pose]"])
def test_a_data_race_that_a_script_allows_is_refused(keys: str) -> None:
    report, text = made({"main.yml": RACE.replace("KEYS", keys)})
    assert text == ""
    race = report[0]
    assert (race.code, race.span.line) == ("SM601", 12)
    assert "the branches `LEFT` and `RIGHT` use the key `pose` at the same time" in race.message
    assert race.help == "remap the key so that each branch has its own"


def test_keys_of_branches_that_differ_are_no_data_race() -> None:
    keys = "output_keys: [pose], remapping: {pose: other}"
    report, _ = made({"main.yml": RACE.replace("KEYS", keys)})
    assert report == []


CATCHING = """
name: sm
outcomes: [done, failed]
states:
  - COUNT:
      template: CallbacksState
      output_keys: [total]
      callbacks: {total: 'lambda ud: 1'}
      transitions: {succeeded: done, error: failed}
"""


@pytest.mark.slow
@COMPILERS
def test_a_script_that_catches_exceptions_needs_them(compiler: Compiler, tmp_path: Path) -> None:
    """Without exceptions the program ended where the script goes on."""
    report, text = made({"main.yml": CATCHING})
    assert report == []
    (tmp_path / "sm.hpp").write_text(text)
    program = '#include "sm.hpp"\nint main() {}\n'
    flags = (f"-I{tmp_path}", "-pthread", "-c")
    compiler.compile(program, tmp_path, *flags)
    message = r"the script catches the exceptions of COUNT \(main.yml:5\): compile with"
    with pytest.raises(AssertionError, match=message):
        compiler.compile(program, tmp_path, *flags, *BARE)

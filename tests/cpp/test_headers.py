"""Generated headers as their readers see them: layout, names, what the documentation says."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.frontend.types.state_types import find_state_type
from smachac.targets.cpp.user_classes import interface_hash
from smachac.verify.players.cpp import HEADERS
from tests.cpp.compilers import CLANG_FORMAT, COMPILERS, Compiler
from tests.cpp.test_user_classes import made
from tests.support.examples import every

ROOT = Path(__file__).parents[2]
GOLDEN = sorted((ROOT / "tests" / "cases").glob("**/expected/cpp/*.hpp"))
OURS = sorted((HEADERS / "smachac").glob("*.hpp"))


@pytest.mark.parametrize(
    ("files", "style"),
    [(GOLDEN, CLANG_FORMAT), (OURS, "BasedOnStyle: LLVM\nColumnLimit: 100\n")],
    ids=["generated", "runtime"],
)
def test_clang_format_changes_nothing(files: list[Path], style: str) -> None:
    tool = next(filter(None, map(shutil.which, ("clang-format", "clang-format-14"))), None)
    if tool is None:
        pytest.skip("no clang-format")
    assert len(files) > 1
    call = [tool, f"--style={{{', '.join(style.split(chr(10))[:-1])}}}", "--dry-run", "-Werror"]
    run = subprocess.run([*call, *map(str, files)], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[:3000]


def blocks(language: str) -> list[str]:
    text = (ROOT / "docs" / "cpp.md").read_text("utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


GRASP = """
name: sm
outcomes: [done]
input_keys: {block: Pose}
states:
  - GRASP:
      template: Grasp
      remapping: {target: block}
      transitions: {succeeded: done, missed: GRASP, preempted: done}
"""
ARM = """
#include "smachac/smachac.hpp"
namespace my_robot {
struct Arm {
  double close_around(const smachac::Pose &pose, double force) {
    return pose.position.x > 0.0 && force == 10.0 ? 0.05 : 0.0;
  }
};
"""
MAIN = """
#include "sm.hpp"
int main() {
  my_robot::Arm arm;
  sm::States states(arm);
  sm::Userdata userdata;
  userdata.block = smachac::Pose{{0.5, 0.0, 0.0}, {}};
  smachac::Stop stop;
  sm::run(states, userdata, nullptr, stop);
  return userdata.width.get() == 0.05 ? 0 : 1;
}
"""


NAMED_STOP = """
name: sm
outcomes: [going, standing]
userdata: {stop: false}
states:
  - JUDGE:
      template: ConditionalOutcomeState
      input_keys: [stop]
      outcomes: [standing, going]
      callbacks: {standing: 'lambda ud: ud.stop'}
      default_outcome: going
"""


def test_a_key_named_stop_is_no_request_to_stop() -> None:
    report, header = made({"main.yml": NAMED_STOP})
    assert report == []
    assert "Outcome execute(Userdata &ud) {" in header
    assert "if (ud.stop.unchecked())" in header
    assert "stop_for" not in header


@COMPILERS
@pytest.mark.slow
def test_the_class_of_the_documentation_is_one(compiler: Compiler, tmp_path: Path) -> None:
    interface, class_ = blocks("yaml")[0], blocks("cpp")[0]
    report, header = made({"main.yml": GRASP, "templates/Grasp.yml": interface})
    assert report == []
    (tmp_path / "my_robot").mkdir()
    (tmp_path / "my_robot" / "grasp.hpp").write_text(f"{ARM}}}\n{class_}")
    (tmp_path / "sm.hpp").write_text(header)
    library = memory_library({"templates/Grasp.yml": interface}, disk_library(Path("x"), []))
    type_ = find_state_type("Grasp", library, [])
    assert type_ is not None
    assert f"smachac_interface = {interface_hash(type_)};" in class_
    compiler.run(MAIN, tmp_path, f"-I{tmp_path}", "-pthread")


@COMPILERS
@pytest.mark.slow
def test_the_program_of_the_documentation_runs(compiler: Compiler, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "targets.md").read_text("utf-8")
    program = re.findall(r"^```cpp\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)[0]
    (header,) = (path for path in GOLDEN if "06_callbacks" in path.parts)
    (tmp_path / "three_tries.hpp").write_text(header.read_text("utf-8"))
    assert "finish" in compiler.run(program, tmp_path, f"-I{tmp_path}", "-pthread")


HARD = """
name: default
outcomes: [class, "true", Outcome]
userdata: {new: 1, größe: 2, EOF: 3, run: 4, int: 5}
states:
  - switch:
      template: ConditionalOutcomeState
      input_keys: [new, größe, int]
      callbacks: {class: 'lambda ud: ud.new > ud.int', State: 'lambda ud: ud.größe > 1'}
      outcomes: [class, State]
      default_outcome: Outcome
      transitions: {State: std}
  - std:
      template: StateMachine
      outcomes: ["true"]
      states:
        - places: {template: ScriptedState, outcomes: ["true"], transitions: {"true": EOF}}
        - EOF: {template: ScriptedState, outcomes: ["true"]}
"""


SYSTEM_HEADERS = "".join(
    f"#include <{name}>\n"
    for name in ("csignal", "ctime", "fcntl.h", "sys/socket.h", "sys/stat.h", "unistd.h")
)


@COMPILERS
@pytest.mark.parametrize("name", every(2, ["default", "open"]))
def test_words_of_cpp_are_names_in_scripts(name: str, compiler: Compiler, tmp_path: Path) -> None:
    _, header = made({"main.yml": HARD.replace("default\n", f"{name}\n", 1)})
    assert header
    (tmp_path / "sm.hpp").write_text(header)
    text = f'#include "sm.hpp"\n{SYSTEM_HEADERS}int main() {{}}\n'
    compiler.compile(text, tmp_path, f"-I{tmp_path}", "-pthread")


SAME = """
name: sm
outcomes: [a-b, a_b]
userdata: {x.y: 1, x_y: 2}
states:
  - ONE-TWO: {template: ScriptedState, outcomes: [a-b, a_b], transitions: {a-b: ONE_TWO}}
  - ONE_TWO: {template: ScriptedState, outcomes: [a-b, a_b]}
"""


def test_a_key_and_a_container_may_not_become_one() -> None:
    text = HARD.replace("- std:", "- int:").replace("State: std", "State: int")
    report, _ = made({"main.yml": text})
    assert [item.code for item in report] == ["SM601"]


def test_names_that_become_one_are_refused_all_at_once() -> None:
    report, header = made({"main.yml": SAME})
    assert header == ""
    assert {item.code for item in report} == {"SM601"}
    text = "\n".join(item.finding.message for item in report)
    for kind, pair in (("states", "ONE"), ("outcomes", "a"), ("keys", "x")):
        assert re.search(rf"the {kind} `{pair}", text), text

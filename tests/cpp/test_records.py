"""Records in C++: structs for the types that smachac.toml and scripts name, classes of the user."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.cpp.compilers import BARE, COMPILERS, STRICT, Compiler

SETTINGS = """
code = ["include"]

[types]
Part = {name = "str<=16", shelf = "one_of[left, right]", at = "Pose?"}
Parts = "list[Part]<=4"
"""
MACHINE = """
name: shop
outcomes: [done, failed]
types:
  Tool: {id: int, label: str<=8, "held by": Part, long: float?}
userdata:
  part: {type: Part, value: {name: bolt, shelf: left}}
  taken: {type: Parts, value: []}
  tool:
    type: Tool
    value:
      id: 3
      label: x
      held by: {name: nut, shelf: right, at: [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]}
states:
  - TAKE:
      template: ScriptedState
      input_keys: {part: Part}
      output_keys: {taken: Parts}
      outcomes: [taken, lost]
      steps:
        - outcome: taken
          set: {taken: [{name: nut, shelf: right}, {name: bolt, shelf: left}]}
      transitions: {taken: COUNT, lost: failed}
  - COUNT:
      template: CallbacksState
      input_keys: {tool: Tool, part: Part}
      output_keys: {tool: Tool}
      callbacks:
        tool: "lambda ud: {'id': ud.tool['id'] + 1, 'held by': ud.part, 'label': ud.part['shelf']}"
      transitions: {succeeded: ASK}
  - ASK:
      template: ConditionalOutcomeState
      input_keys: {part: Part, taken: Parts, tool: Tool}
      outcomes: [go]
      callbacks:
        go: "lambda ud: ud.tool['id'] == 4 and len(ud.taken) > 0 and ud.tool['label'] == 'left'
          and ud.tool['held by'] == ud.part and ud.taken[-1]['name'] == ud.part['name']"
      default_outcome: bad
      transitions: {go: done, bad: failed}
"""

LOOK = """
name: Look
input_keys: {part: Part}
output_keys: {seen: geometry_msgs/PoseStamped, found: Parts}
outcomes: {found: {}}
code: {cpp: {header: shop/look.hpp, class: "shop::Look"}}
"""
LOOKS = """
name: looks
outcomes: [done]
userdata: {part: {type: Part, value: {name: bolt, shelf: left}}}
output_keys: [seen, found]
states:
  - LOOK: {template: Look, transitions: {found: done}}
"""
MEMBERS = "std::string shelf, name; std::optional<smachac::Pose> at; int more = 0;"
PART = f"""
#pragma once
#include <optional>
#include <string>
#include "smachac/values.hpp"
namespace shop {{
struct Part {{ {MEMBERS} }};
struct Stamped {{ double seconds = 1.0; }};
}}
"""
LOOK_CLASS = """
#pragma once
#include "smachac/smachac.hpp"
#include "HEADER"
namespace shop {
class Look {
public:
  enum class Outcome { found };
  struct In { const PART &part; };
  struct Out { smachac::Key<STAMPED> &seen; smachac::Key<std::vector<PART>> &found; };
  static constexpr std::uint32_t smachac_interface = NUMBER;
  Outcome execute(In in, Out out) {
    out.seen = STAMPED{};
    PART part = in.part;
    part.at = smachac::Pose{{1.0, 2.0, 3.0}, {}};
    out.found = {part, in.part};
    return Outcome::found;
  }
};
}
"""
STEP_CLASS = """
#pragma once
#include "smachac/step.hpp"
#include "smachac/step_types.hpp"
namespace shop {
class Look {
public:
  enum class Outcome { found };
  struct In { const smachac::step::types::Part &part; };
  struct Out { smachac::step::Key<smachac::step::List<smachac::step::types::Part>> &found; };
  static constexpr std::uint32_t smachac_interface = NUMBER;
  smachac::step::Result<Outcome> step(smachac::step::Context &, In in, Out out) {
    auto part = in.part;
    part.name = "TEXT";
    out.found.push_back(part);
    return Outcome::found;
  }
};
}
"""
STEPPED = """
#include "looks.hpp"
#include <cstdio>
int main() {
  looks::Machine<> machine;
  while (true) {
    const auto result = machine.step(0);
    if (result.code() >= 0) {
      std::puts("done");
      return 0;
    }
    if (machine.failure().message != nullptr) {
      std::printf("%s: %s", machine.failure().key, machine.failure().message);
      return 0;
    }
  }
}
"""


def project(folder: Path, machine: str, settings: str = SETTINGS, **types: str) -> Path:
    """A project of these texts; the path of its machine."""
    (folder / "templates").mkdir()
    (folder / "include" / "shop").mkdir(parents=True)
    (folder / "smachac.toml").write_text(settings)
    for name, text in types.items():
        (folder / "templates" / f"{name}.yml").write_text(text)
    script = folder / "main.yml"
    script.write_text(machine)
    return script


def number(script: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """The number of the interface that a class lacks, from the report."""
    main(["build", str(script), "--target", "cpp", "-o", str(script.parent / "none")])
    return capsys.readouterr().err.partition("smachac_interface` to ")[2].split()[0]


@pytest.mark.parametrize("mode", ["blocking", "step"])
@pytest.mark.slow
def test_traces_agree(mode: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = project(tmp_path, MACHINE)
    code = main(["verify", str(script), "--targets", "cpp", "--option", f"mode={mode}"])
    shown = capsys.readouterr()
    assert code == 0, shown
    assert "cpp: agrees" in shown.out


@COMPILERS
@pytest.mark.slow
def test_headers_give_no_warning(compiler: Compiler, tmp_path: Path) -> None:
    script = project(tmp_path, MACHINE)
    out = tmp_path / "out"
    assert main(["build", str(script), "--target", "cpp", "-o", str(out), "-q"]) == 0
    text = '#include "shop.hpp"\nint main() { return 0; }'
    compiler.compile(text, tmp_path, f"-I{out}", *STRICT)
    stepped = tmp_path / "stepped"
    options = ["-o", str(stepped), "--option", "mode=step", "-q"]
    assert main(["build", str(script), "--target", "cpp", *options]) == 0
    compiler.compile(text, tmp_path, f"-I{stepped}", *BARE, *STRICT)


OWN = (
    SETTINGS
    + """
[cpp_types]
Part = {class = "shop::Part", header = "shop/part.hpp"}
"geometry_msgs/PoseStamped" = {class = "::shop::Stamped", header = "shop/part.hpp"}
"""
)


@COMPILERS
@pytest.mark.slow
def test_classes_of_the_user(
    compiler: Compiler, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    trace = tmp_path / "t.jsonl"
    script = project(tmp_path, LOOKS, OWN, Look=LOOK)
    include = tmp_path / "include"
    (include / "shop" / "part.hpp").write_text(PART)
    names = {"PART": "Part", "STAMPED": "Stamped", "HEADER": "shop/part.hpp"}
    for wanted in (None, number):
        text = LOOK_CLASS
        for old, new in names.items():
            text = text.replace(old, new)
        value = "1U" if wanted is None else wanted(script, capsys)
        (include / "shop" / "look.hpp").write_text(text.replace("NUMBER", value))
    out = tmp_path / "out"
    options = ["-o", str(out), "--option", "main=true", "-q"]
    assert main(["build", str(script), "--target", "cpp", *options]) == 0
    flags = [f"-I{out}", f"-I{include}", "-pthread"]
    program = compiler.compile((out / "main.cpp").read_text(), tmp_path, *flags)
    call = [str(program), "--trace", str(trace)]
    assert subprocess.check_output(call, text=True) == "outcome: done\n"
    events = trace.read_text()
    assert '"key": "seen", "value": null' in events
    part = '{"name": "bolt", "shelf": "left"}'
    at = '"at": [[1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0]]'
    assert f'"value": [{{{at}, {part[1:-1]}}}, {part}]' in events
    header = str(out / "looks.hpp")
    assert main(["verify", str(script), "--header", header]) == 0, capsys.readouterr()
    assert main(["verify", str(script), "--targets", "cpp"]) == 0, capsys.readouterr()
    (include / "shop" / "part.hpp").write_text(
        PART.replace("std::string shelf", "int shelf = 0; std::string")
    )
    with pytest.raises(AssertionError, match="shop::Part::shelf must be std::string"):
        compiler.compile((out / "main.cpp").read_text() + "\n", tmp_path, *flags, warnings=False)


@COMPILERS
@pytest.mark.parametrize(
    ("text", "told"),
    [("a short name", "done\n"), ("more than 16 bytes", "found: a value beyond its bound")],
)
@pytest.mark.slow
def test_a_text_beyond_its_bound_in_a_record_is_a_failure(
    compiler: Compiler, text: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    interface = LOOK.replace("seen: geometry_msgs/PoseStamped, ", "")
    script = project(tmp_path, LOOKS.replace("seen, ", ""), Look=interface)
    header = tmp_path / "include" / "shop" / "look.hpp"
    code = STEP_CLASS.replace("TEXT", text)
    header.write_text(code.replace("NUMBER", "1U"))
    header.write_text(code.replace("NUMBER", number(script, capsys)))
    options = ["-o", str(tmp_path / "out"), "--option", "mode=step", "-q"]
    assert main(["build", str(script), "--target", "cpp", *options]) == 0
    flags = [f"-I{tmp_path / 'out'}", f"-I{tmp_path / 'include'}", *BARE]
    assert compiler.run(STEPPED, tmp_path, *flags) == told


SAY = """
name: Say
variables:
  label: {type: str, default: hello}
  gains: {type: "list[float]", default: [1.0, 2.5]}
  part: {type: Part, default: {name: bolt, shelf: left}}
outcomes: {said: {}}
code: {cpp: {header: shop/say.hpp, class: "shop::Say"}}
"""
SAYS = """
name: looks
outcomes: [done]
states: [{SAY: {template: Say, label: "h\u00f6", transitions: {said: done}}}]
"""
SAY_CLASS = """
#pragma once
#include "smachac/step.hpp"
#include "smachac/step_types.hpp"
namespace shop {
class Say {
public:
  enum class Outcome { said };
  static constexpr std::uint32_t smachac_interface = NUMBER;
  Say(std::string_view label, const smachac::step::List<double> &gains,
      const smachac::step::types::Part &part)
      : fits(label.size() == 3 && gains.size() == 2 && gains[1] == 2.5 && part.name == "bolt") {}
  smachac::step::Result<Outcome> step(smachac::step::Context &context) {
    if (!fits) {
      return context.error("other values");
    }
    return Outcome::said;
  }
  bool fits;
};
}
"""


@COMPILERS
@pytest.mark.slow
def test_variables_of_a_stepped_class_need_no_heap(
    compiler: Compiler, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = project(tmp_path, SAYS, Say=SAY)
    header = tmp_path / "include" / "shop" / "say.hpp"
    header.write_text(SAY_CLASS.replace("NUMBER", "1U"))
    header.write_text(SAY_CLASS.replace("NUMBER", number(script, capsys)))
    options = ["-o", str(tmp_path / "out"), "--option", "mode=step", "-q"]
    assert main(["build", str(script), "--target", "cpp", *options]) == 0
    flags = [f"-I{tmp_path / 'out'}", f"-I{tmp_path / 'include'}", *BARE]
    assert compiler.run(STEPPED, tmp_path, *flags) == "done\n"


READS = """
name: reads
outcomes: [done]
{types}userdata:
  part: {{type: {type}, value: {value}}}
states:
  - READ:
      template: CallbacksState
      input_keys: {{part: {type}}}
      output_keys: {{label: str}}
      callbacks: {{label: "lambda ud: {code}"}}
      transitions: {{succeeded: SHOW}}
  - SHOW:
      template: PrintUserdataState
      input_keys: {{label: str}}
      transitions: {{succeeded: done}}
"""
PLAIN = "{name: bolt, shelf: left}"


@pytest.mark.parametrize(
    ("type_", "value", "code", "message"),
    [
        ("Part", PLAIN, "str(ud.part['at'])", "`at` of `smachac::types::Part` may be absent"),
        ("Part", "{name: bolt, shelf: left, at: null}", "'a'", "does not tell null from an absent"),
        ("'{a: str}'", "{a: b}", "ud.part['a']", "C++ needs a name for the record `{a: str}`"),
        ("Odd", "{a b: x, a-b: y}", "ud.part['a b']", "`a b` and `a-b` of `Odd` would both be"),
    ],
)
def test_refusals(
    type_: str,
    value: str,
    code: str,
    message: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    types = "types: {Odd: {a b: str, a-b: str}}\n" if type_ == "Odd" else ""
    text = READS.format(types=types, type=type_, value=value, code=code)
    script = project(tmp_path, text)
    assert main(["build", str(script), "--target", "cpp", "-o", str(tmp_path / "out")]) == 1
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()

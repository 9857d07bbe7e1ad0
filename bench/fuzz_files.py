"""Damaged files of every kind that a command reads, and every command over them.

    python bench/fuzz_files.py [count] [--seed N] [--only INDEX]

Each input is one project with one damaged file, and one command that reads that file. The command
runs in a process of its own. A find is an exit code of 70, a traceback, the end by a signal, an
exit code above 0 without a message, a message without words, an internal error of the language
server, or more than 10 s of CPU time.
Input `INDEX` of a seed is always the same: `--only INDEX` shows it and what happens.
Ends with 1 if there is a find. Unix only.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import re
import resource
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import fuzz

from smachac.commands.cli import main as smachac

COUNT = 1000
SECONDS = 10
LONGEST = 120
"""Seconds after which a command that waits is ended by a signal."""
BYTES = 4_000_000_000
CASES = Path(__file__).parents[1] / "tests" / "cases"

MAIN = """name: main
template: Base
outcomes: [done, lost]
types: {Speed: float<m/s>, Box: {size: float, name: str}}
params: {speed: 0.5}
userdata:
  shelf: [[0, 0, 0], [0, 0, 0, 1]]
  speed: {type: Speed, value: 0.2}
  box: {type: Box, value: {size: 1, name: a}}
properties:
  - at_most: {WAVE: 3}
  - before: {WAVE: CARRY}
states:
  - CARRY:
      template: Carry
      speed: 0.5
      remapping: {from: shelf, into: shelf}
      transitions: {done: WAVE, not-found: lost, preempted: lost}
  - WAVE: {template: Wave, times: 2, transitions: {succeeded: SUB, preempted: lost}}
  - SUB: {script: sub, transitions: {done: done}, doc: "[[params, speed]]"}
"""
SUB = """- SUB:
    template: StateMachine
    outcomes: [done]
    states:
      - WAIT:
          template: ScriptedState
          outcomes: [ok, bad]
          retry: {on: [bad], max: 3}
          transitions: {ok: done, exhausted: done, preempted: done}
"""
WAVE = "name: Wave\nvariables: {times: {type: int, default: 1}}\noutcomes: [succeeded, preempted]\n"
WAVE_CODE = """{% block class_defs %}
class Wave(smach.State):
    def __init__(self, times):
        super().__init__(outcomes=["succeeded", "preempted"])
        self.times = times

    def execute(self, userdata):
        return "succeeded" if {{ 1 + 1 }} else "preempted"
{% endblock %}
"""
ARM = """name: arm
template: PyBulletBase
robot: arm.yml
scene: scene.yml
outcomes: [done, lost]
userdata: {goal: [0.5, 1.0, 1.0]}
states:
  - MOVE:
      template: MoveToJointPositionsState
      remapping: {positions: goal}
      transitions: {succeeded: done, aborted: lost, preempted: lost}
"""
ARM_ROBOT = """name: arm
urdf: arm.urdf
base: [[0.0, 0.0, 0.4], [0.0, 0.0, 0.0, 1.0]]
arms:
  arm: {joints: [shoulder, elbow, wrist], tool: {link: tip}, home: [0.0, 0.0, 0.5]}
"""
SCENE = """bodies:
  table: {model: table, pose: [[0.5, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]}
  box: {size: [0.1, 0.1, 0.1], mass: 0.1, colour: [1, 0, 0], spread: [0.1, 0.1, 0.2]}
"""
FAULTS = """faults:
  - {kind: gripper_slips, state: MOVE, probability: 0.3, each_time: true}
  - {kind: move_body, target: box, value: [0.02, 0.0, 0.0], at: 1.5}
"""
ARM_XACRO = """<robot name="lamp" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="90"/>
  <xacro:property name="size" value="0.1"/>
  <xacro:include filename="parts.xacro"/>
  <link name="base"/>
  <xacro:turning name="shoulder" parent="base"/>
  <xacro:if value="${size > 0}"><xacro:turning name="elbow" parent="shoulder_link"/></xacro:if>
</robot>
"""
PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="turning" params="name parent">
    <link name="${name}_link">
      <inertial>
        <mass value="${size * 3}"/>
        <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/>
      </inertial>
      <collision><geometry><mesh filename="part.obj" scale="1 1 ${size}"/></geometry></collision>
      <visual><geometry><mesh filename="part.stl"/></geometry></visual>
    </link>
    <joint name="${name}" type="revolute">
      <parent link="${parent}"/>
      <child link="${name}_link"/>
      <origin xyz="0 0 0.3"/>
      <axis xyz="0 1 0"/>
      <limit lower="${-radians($(arg reach))}" upper="1.5" effort="10" velocity="1"/>
    </joint>
  </xacro:macro>
</robot>
"""
LAMP = """name: lamp
urdf: lamp.urdf.xacro
arguments: {reach: 120}
arms:
  arm: {joints: [shoulder, elbow], tool: {link: elbow_link}, home: [0.0, 0.0]}
"""
LAMP_SCRIPT = """name: light
template: PyBulletBase
robot: lamp.yml
outcomes: [done, lost]
userdata: {goal: [0.5, 1.0]}
states:
  - MOVE:
      template: MoveToJointPositionsState
      remapping: {positions: goal}
      transitions: {succeeded: done, aborted: lost, preempted: lost}
"""
OBJ = """o part
v 0 0 0
v 0.1 0 0
v 0 0.1 0
v 0 0 0.1
vn 0 0 1
f 1 3 2
f 1 2 4
f 2/1/1 3//1 4
f -4 -1 -2
"""
STL = """solid part
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 0.1 0 0
      vertex 0 0.1 0
    endloop
  endfacet
endsolid part
"""
ROS = """name: ros
template: ROSBase
outcomes: [done, lost]
userdata: {width: 0.5, part: {pin: [1]}}
states:
  - GRASP:
      template: ServiceState
      service_namespace: gripper
      service: cell_msgs/Grasp
      request_slots: [width, part]
      input_keys: [width, part]
      transitions: {succeeded: TIDY, aborted: lost, preempted: lost}
  - TIDY:
      template: SimpleActionState
      action_server_namespace: tidy
      action: cell_msgs/Tidy
      goal: {room: hall}
      transitions: {succeeded: done, aborted: lost, preempted: lost}
"""
SCENARIO = """states:
  CARRY: [{outcome: done, set: {metres: 1.0, seconds: 2.0}}]
  WAVE: [succeeded]
  SUB/WAIT: [bad, {outcome: {ok: 0.9, bad: 0.1}}]
"""
SETTINGS = """scripts = ["."]
templates = ["templates"]
code = ["."]
exclude = ["old/**"]
ros = 2
[severity]
SM204 = "error"
SM3 = "warning"
"""


def text_of(name: str) -> str:
    """A file of a case."""
    return (CASES / name).read_text()


FILES = {
    "main.yml": MAIN,
    "sub.yml": SUB,
    "templates/Wave.yml": WAVE,
    "templates/Wave.tpl.py": WAVE_CODE,
    "templates/Carry.yml": text_of("code_in_both/templates/Carry.yml"),
    "arm_skills/carry.py": text_of("code_in_both/arm_skills/carry.py"),
    "include/arm/carry.hpp": text_of("code_in_both/include/arm/carry.hpp"),
    "arm.yml": ARM_ROBOT,
    "arm_script.yml": ARM,
    "arm.urdf": text_of("bad_for_robot/arm.urdf"),
    "scene.yml": SCENE,
    "faults.yml": FAULTS,
    "lamp.urdf.xacro": ARM_XACRO,
    "parts.xacro": PARTS,
    "lamp.yml": LAMP,
    "lamp_script.yml": LAMP_SCRIPT,
    "part.obj": OBJ,
    "part.stl": STL,
    "ros.yml": ROS,
    "cell_msgs/msg/Part.msg": "# a part\nint32 PIN=1\nstring<=8 name 'a'\nint32[<=4] pin\n",
    "cell_msgs/srv/Grasp.srv": "float64 width\ncell_msgs/Part part\n---\nbool held\n",
    "cell_msgs/action/Tidy.action": "string room\n---\nint32 count\n---\nfloat32 done\n",
    "scenario.yml": SCENARIO,
    "smachac.toml": SETTINGS,
}
MADE = (
    ("run.jsonl", "run main.yml --mock scenario.yml --trace run.jsonl -q"),
    ("known.json", "check main.yml --baseline known.json --write-baseline"),
    ("sweep.db", "sweep main.yml --mock scenario.yml --runs 4 --jobs 1 --database sweep.db"),
)
"""Files that a command writes, and the command."""

SCRIPT_COMMANDS = (
    *("check {}", "check {} --format json", "check {} --format sarif", "check .", "fmt {} --diff"),
    *("build {} -t python -o out", "build {} -t cpp -o out", "build {} -t html -o out"),
    *("build {} -t dot -o out", "build {} -t ir -o out", "explain {} --failures", "migrate ."),
    *("explain {} WAVE", "explain {} --properties", "diff {} sub.yml", "diff sub.yml {}"),
    *("rename {} WAVE WAVES --diff", "rename {} shelf rack --kind key --diff"),
    *("contain {} PART StateMachine CARRY WAVE --diff", "extract {} SUB --diff"),
    *("inline {} SUB --diff", "edit {} transition WAVE succeeded lost --diff"),
    *("edit {} remove WAVE --diff", "edit {} add main NEW Wave --diff"),
    *("run {} --mock scenario.yml -q --max-steps 50", "verify {} --targets python --paths 3"),
    *("trace check {} run.jsonl", "stats {} run.jsonl", "lsp {}", "view {} --no-browser"),
    *("view {} --no-browser --attach run.jsonl", "build {} -t mermaid -o out"),
    *("sweep {} --mock scenario.yml --runs 3 --jobs 1", "build {} -t json -o out"),
    "sweep {} --mock scenario.yml --runs 2 --jobs 1 --vary params.speed=0.1..0.5",
)
MAIN_COMMANDS = tuple(command.format("main.yml") for command in SCRIPT_COMMANDS)
TYPE_COMMANDS = (
    *("check main.yml", "build main.yml -t python -o out", "build main.yml -t cpp -o out"),
    *("states", "states Carry", "states Wave --format json", "migrate .", "check ."),
    *("explain main.yml CARRY", "run main.yml --mock scenario.yml -q", "new state Wave"),
    *("new state Wave --target cpp", "new state Carry --target cpp", "lsp templates/Wave.yml"),
    *("new state Other --input shelf --output speed=float<m>", "lsp main.yml"),
)
ARM_COMMANDS = (
    *("check arm_script.yml", "check . --format json", "build arm_script.yml -t python -o out"),
    *("build arm_script.yml -t cpp -o out", "explain arm_script.yml MOVE", "lsp arm.yml"),
    *("run arm_script.yml -q", "lsp arm_script.yml", "view arm_script.yml --no-browser"),
    "sweep arm_script.yml --runs 1 --jobs 1 --vary scene.box.x=0.4..0.6",
)
LAMP_COMMANDS = (
    *("check lamp_script.yml", "run lamp_script.yml -q", "build lamp_script.yml -t cpp -o out"),
    *("run lamp_script.yml -q", "lsp lamp_script.yml", "check ."),
)
ROS_COMMANDS = ("check ros.yml", "check .", "build ros.yml -t python -o out")
SCENARIO_COMMANDS = (
    *("run main.yml --mock scenario.yml -q", "run main.yml --mock scenario.yml -q --seed 3"),
    *("explain main.yml --properties --scenario WAVE", "check scenario.yml", "check ."),
    *("sweep main.yml --mock scenario.yml --runs 3 --jobs 1", "lsp scenario.yml"),
    *("run scenario.yml -q", "run scenario.yml --mock main.yml", "rename scenario.yml WAVE WAVES"),
)
COMMANDS: dict[str, tuple[str, ...]] = {
    "main.yml": MAIN_COMMANDS,
    "sub.yml": MAIN_COMMANDS,
    "smachac.toml": (
        *MAIN_COMMANDS,
        "states",
        "check sub.yml",
        "doctor",
        "new state Other",
        "new other",
    ),
    "scenario.yml": SCENARIO_COMMANDS,
    "faults.yml": (
        *("run arm_script.yml --faults faults.yml -q", "check faults.yml"),
        "sweep arm_script.yml --faults faults.yml --runs 1 --jobs 1",
    ),
    **dict.fromkeys(
        ("lamp.urdf.xacro", "parts.xacro", "lamp.yml", "lamp_script.yml", "part.obj", "part.stl"),
        LAMP_COMMANDS,
    ),
    "arm.yml": ARM_COMMANDS,
    "arm_script.yml": ARM_COMMANDS,
    "arm.urdf": ARM_COMMANDS,
    "scene.yml": ARM_COMMANDS,
    "templates/Wave.yml": TYPE_COMMANDS,
    "templates/Wave.tpl.py": TYPE_COMMANDS,
    "templates/Carry.yml": TYPE_COMMANDS,
    "arm_skills/carry.py": TYPE_COMMANDS,
    "include/arm/carry.hpp": TYPE_COMMANDS,
    "ros.yml": ROS_COMMANDS,
    "cell_msgs/msg/Part.msg": ROS_COMMANDS,
    "cell_msgs/srv/Grasp.srv": ROS_COMMANDS,
    "cell_msgs/action/Tidy.action": ROS_COMMANDS,
    "run.jsonl": (
        *("trace check main.yml run.jsonl", "trace stats main.yml run.jsonl"),
        *("stats main.yml run.jsonl", "trace check main.yml run.jsonl --format json"),
        "view main.yml --no-browser --attach run.jsonl",
        *("build main.yml -t html --option trace=run.jsonl -o out", "check run.jsonl"),
        *("stats main.yml run.jsonl --format html", "stats main.yml run.jsonl --format dot"),
    ),
    "sweep.db": (
        *("stats main.yml sweep.db", "trace stats main.yml sweep.db"),
        "sweep main.yml --mock scenario.yml --runs 6 --jobs 1 --database sweep.db",
        "view main.yml --no-browser --attach sweep.db",
    ),
    "known.json": (
        *("check main.yml --baseline known.json", "check . --baseline known.json"),
        "check main.yml --baseline known.json --write-baseline",
    ),
}
"""The commands that read each file."""


def written(draw: random.Random, data: bytes) -> bytes:
    """Bytes changed, left out, doubled; or a file in another encoding."""
    at, other = draw.randint(0, len(data)), draw.randint(0, len(data))
    match draw.randrange(8):
        case 0:
            return data[:at]
        case 1:
            return data[:at] + bytes(draw.randrange(256) for _ in range(3)) + data[at + 3 :]
        case 2:
            return data[:at] + b"\x00" + data[at:]
        case 3:
            return data[:at] + b"\xed\xa0\x80" + data[at:]
        case 4:
            return data.decode("latin-1").encode(draw.choice(["utf-16", "utf-32", "utf-8-sig"]))
        case 5:
            return data[: max(at, other)] + data[min(at, other) :]
        case 6:
            return data.replace(b"\n", draw.choice([b"\r", b"\r\n", b"\x0b", b"\xe2\x80\xa8", b""]))
        case _:
            return draw.choice(
                [b"", b"\n", b"[]", b"null", b"1", b"{}", b'"', b"\xff", b"---\n..."]
            )


VALUES = (
    *("null", "[]", "{}", "-1", "1e999", "nan", '""', "true", "[[1]]", "{a: 1}", "0", "'a'"),
    *("1" * 5000, '{"a": 1}', "\\ud800", '"\\ud800"', "\\u0000", "<a>", "]]>", "&x;", "1e-999"),
)


def valued(draw: random.Random, text: str) -> str:
    """A word or a value replaced by a value of another shape."""
    found = [*re.finditer(r"\[[^][]*\]|\{[^{}]*\}|\"[^\"]*\"|[\w./-]+", text)]
    for part in draw.sample(found, min(len(found), draw.choice([1, 1, 2]))):
        new = draw.choice([*VALUES, *VALUES, draw.choice(found).group()])
        text = text[: part.start()] + new + text[part.end() :]
    return text


def deep(draw: random.Random, text: str) -> str:
    """Very deep nesting at some place."""
    at = draw.choice([0, len(text), draw.randint(0, len(text))])
    opening = draw.choice(
        ["[", "{", '{"a":', "(", "<link>", "- ", "a.", "a: ", "-", "{{ ", "{% if 1 %}"]
    )
    return text[:at] + opening * draw.choice([100, 1000, 20_000, 100_000]) + text[at:]


Damage = Callable[[random.Random, str], str]
KINDS: tuple[tuple[Damage | None, int], ...] = (
    *((valued, 40), (fuzz.signs, 15), (fuzz.words, 10), (fuzz.lines, 15), (deep, 5)),
    *((fuzz.splice, 3), (fuzz.noise, 2), (None, 15)),
)
"""The kinds of damage with their weights; None for that of bytes (`written`)."""


def damaged(made: dict[str, bytes], seed: int, index: int) -> tuple[str, str, bytes, str]:
    """The kind of damage, the damaged file, its content, and the command of an input."""
    draw = random.Random(f"{seed}/{index}")
    name = draw.choice([*COMMANDS])
    (kind,) = draw.choices([kind for kind, _ in KINDS], [weight for _, weight in KINDS])
    if kind is None:
        data = written(draw, made[name])
    else:
        text = made[name].decode("utf-8", "surrogateescape")
        data = kind(draw, text).encode("utf-8", "surrogatepass")
    return (kind or written).__name__, name, data, draw.choice(COMMANDS[name])


POSITIONS = ("completion", "hover", "definition", "references", "documentHighlight")
PLACES = 4
"""Places of a text that an editor asks about."""


def requests(file: Path) -> bytes:
    """What an editor sends that opens a file, asks everything about some places, and changes it."""
    text = file.read_bytes().decode("utf-8", "replace").replace("\r", "\n")
    draw = random.Random(text)
    uri, folder = file.as_uri(), file.parent.as_uri()
    document: dict[str, object] = {"textDocument": {"uri": uri}}
    found: list[tuple[str, dict[str, object]]] = [
        ("initialize", {"processId": None, "rootUri": folder, "capabilities": {}})
    ]
    opened = {"uri": uri, "languageId": "yaml", "version": 1, "text": text}
    asked = ("documentSymbol", "foldingRange", "semanticTokens/full", "codeLens")
    notes: list[tuple[str, dict[str, object]]] = [
        ("initialized", {}),
        ("textDocument/didOpen", {"textDocument": opened}),
    ]
    found += [(f"textDocument/{method}", document) for method in asked]
    options = {"tabSize": 2, "insertSpaces": True}
    found.append(("textDocument/formatting", {**document, "options": options}))
    found.append(("workspace/symbol", {"query": draw.choice(["", "WAVE", "["])}))
    context = {"includeDeclaration": True, "triggerKind": 1}
    for _ in range(PLACES):
        offset = draw.randint(0, len(text))
        line = text.count("\n", 0, offset) + draw.choice([0, 0, 0, 9])
        position = {"line": line, "character": draw.randint(0, 40)}
        place: dict[str, object] = {**document, "position": position}
        found += [(f"textDocument/{method}", {**place, "context": context})
                  for method in POSITIONS]  # fmt: skip
        area = {"start": {"line": 0, "character": 0}, "end": position}
        found.append(("textDocument/inlayHint", {**document, "range": area}))
        found.append(("textDocument/codeAction",
                      {**document, "range": area, "context": {"diagnostics": []}}))  # fmt: skip
        found.append(("textDocument/prepareRename", place))
        name = draw.choice(["NEW", "", "a/b", "\x00", "done"])
        found.append(("textDocument/rename", {**place, "newName": name}))
    found.append(("shutdown", {}))
    messages: list[dict[str, object]] = [
        {"id": number, "method": method, "params": params}
        for number, (method, params) in enumerate(found)
    ]
    messages[1:1] = [{"method": method, "params": params} for method, params in notes]
    messages.append({"method": "exit"})
    texts = [json.dumps({"jsonrpc": "2.0", **message}).encode() for message in messages]
    return b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(text), text) for text in texts)


def stopped(_: object) -> None:
    """What a command does in place of waiting for an hour that never comes: it is interrupted."""
    raise KeyboardInterrupt


def run(folder: Path, command: str) -> tuple[int, str]:
    """The exit code of a command (negative: a signal) in a child process, and what it prints."""
    words = command.split()
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as typed:
        if words[0] == "lsp":
            typed.write(requests(folder / words.pop()))
            typed.seek(0)
        child = os.fork()
        if not child:
            code = 70
            with contextlib.suppress(BaseException):
                os.setsid()
                signal.signal(signal.SIGALRM, signal.SIG_DFL)
                signal.alarm(LONGEST)
                resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
                resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
                os.chdir(folder)
                os.dup2(typed.fileno(), 0)
                os.dup2(out.fileno(), 1)
                os.dup2(out.fileno(), 2)
                sys.modules["__main__"] = ModuleType("__main__")  # a worker imports it again
                if words[0] == "view":
                    time.sleep = stopped
                try:
                    code = smachac(words)
                except SystemExit as ended:
                    code = int(ended.code or 0)
                sys.stdout.flush()
            os._exit(code)
        _, status = os.waitpid(child, 0)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # what it has left
        out.seek(0)
        return os.waitstatus_to_exitcode(status), out.read().decode("utf-8", "replace")


EMPTY = re.compile(r"(?m)^(error|warning|note|help)(\[\w+\])?: *$|: *$(?!\n)|: (None|\(\)|'')$")
"""A message without words, or one that ends where a reason must follow."""


def fault_of(command: str, code: int, printed: str) -> str:
    """What is wrong with the end of a command, or nothing."""
    if command.startswith("lsp") and re.search(r'"code": ?-32[67]0\d', printed):
        return "an error of the server"
    if command.startswith("view") and code == 130:
        return ""
    if code not in (0, 1, 2):
        return f"exit code {code}"
    if "Traceback (most recent call last)" in printed:
        return "a traceback"
    if code and not printed.strip():
        return "no message"
    return "an empty message" if EMPTY.search(printed.rstrip("\n")) else ""


def project(folder: Path) -> dict[str, bytes]:
    """Write the project into a folder, run what makes its other files; the contents of all."""
    for name, text in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    for name, command in MADE:
        code, printed = run(folder, command)
        assert (folder / name).is_file(), (command, code, printed)
    return {name: (folder / name).read_bytes() for name in COMMANDS}


def main(arguments: list[str]) -> int:
    """Print every find as it comes, then what there was."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("count", nargs="?", type=int, default=COUNT)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", type=int)
    asked = parser.parse_args(arguments)
    ends: Counter[int] = Counter()
    finds = 0
    with tempfile.TemporaryDirectory() as root:
        folder = Path(root)
        made = project(folder)
        for index in range(asked.count) if asked.only is None else [asked.only]:
            kind, name, data, command = damaged(made, asked.seed, index)
            (folder / name).write_bytes(data)
            code, printed = run(folder, command)
            ends[code] += 1
            fault = fault_of(command, code, printed)
            finds += bool(fault)
            if fault or asked.only is not None:
                print(f"--only {index}: {kind} of {name}, {command}: {fault}", flush=True)
                print(printed[-1500:] if asked.only is None else f"{data!r}\n{printed}")
            for other in made:
                if not (folder / other).exists() or (folder / other).read_bytes() != made[other]:
                    (folder / other).write_bytes(made[other])
    print(f"{ends.total():,} inputs of seed {asked.seed}: exit codes {dict(ends)}; {finds} finds")
    return 1 if finds else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

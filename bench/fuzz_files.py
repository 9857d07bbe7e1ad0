"""Damaged files of every kind that a command reads, and every command over them.

    python bench/fuzz_files.py [count] [--seed N] [--only INDEX]

Each input is one project with one damaged file, and one command that reads that file. The command
runs in a process of its own. A find is an exit code of 70, a traceback, the end by a signal, an
exit code above 0 without a message, a message without words, or more than 10 s of CPU time.
Input `INDEX` of a seed is always the same: `--only INDEX` shows it and what happens.
Ends with 1 if there is a find. Unix only.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import re
import resource
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import fuzz

from smachac.commands.cli import main as smachac

COUNT = 1000
SECONDS = 10
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
    *("trace check {} run.jsonl", "stats {} run.jsonl"),
)
MAIN_COMMANDS = tuple(command.format("main.yml") for command in SCRIPT_COMMANDS)
TYPE_COMMANDS = (
    *("check main.yml", "build main.yml -t python -o out", "build main.yml -t cpp -o out"),
    *("states", "states Carry", "states Wave --format json", "migrate .", "check ."),
    *("explain main.yml CARRY", "run main.yml --mock scenario.yml -q"),
)
ARM_COMMANDS = (
    *("check arm_script.yml", "check . --format json", "build arm_script.yml -t python -o out"),
    *("build arm_script.yml -t cpp -o out", "explain arm_script.yml MOVE"),
)
ROS_COMMANDS = ("check ros.yml", "check .", "build ros.yml -t python -o out")
SCENARIO_COMMANDS = (
    *("run main.yml --mock scenario.yml -q", "run main.yml --mock scenario.yml -q --seed 3"),
    *("explain main.yml --properties --scenario WAVE", "check scenario.yml", "check ."),
)
COMMANDS: dict[str, tuple[str, ...]] = {
    "main.yml": MAIN_COMMANDS,
    "sub.yml": MAIN_COMMANDS,
    "smachac.toml": (*MAIN_COMMANDS, "states", "check sub.yml"),
    "scenario.yml": SCENARIO_COMMANDS,
    "faults.yml": ("run arm_script.yml --faults faults.yml -q", "check faults.yml"),
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
        data = kind(draw, made[name].decode()).encode("utf-8", "surrogatepass")
    return (kind or written).__name__, name, data, draw.choice(COMMANDS[name])


def run(folder: Path, command: str) -> tuple[int, str]:
    """The exit code of a command (negative: a signal) in a child process, and what it prints."""
    with tempfile.TemporaryFile() as out:
        child = os.fork()
        if not child:
            code = 70
            with contextlib.suppress(BaseException):
                resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
                resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
                os.chdir(folder)
                os.dup2(out.fileno(), 1)
                os.dup2(out.fileno(), 2)
                try:
                    code = smachac(command.split())
                except SystemExit as ended:
                    code = int(ended.code or 0)
                sys.stdout.flush()
            os._exit(code)
        _, status = os.waitpid(child, 0)
        out.seek(0)
        return os.waitstatus_to_exitcode(status), out.read().decode("utf-8", "replace")


EMPTY = re.compile(r"(?m)^(error|warning|note|help)(\[\w+\])?: *$|: *$(?!\n)|: (None|\(\)|'')$")
"""A message without words, or one that ends where a reason must follow."""


def fault_of(code: int, printed: str) -> str:
    """What is wrong with the end of a command, or nothing."""
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
            fault = fault_of(code, printed)
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

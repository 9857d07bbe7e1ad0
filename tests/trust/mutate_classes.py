"""Mutations of the Python classes of state types: SM308 to SM310, SM314, SM315, SM608 and SM609.

The random projects have interfaces that name classes of one module. The module is written here,
first without a fault, and then one line of it is changed.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.mutate_names import swap_letters

MODULE = "my_robot/states.py"


def interfaces(project: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The interfaces whose classes are in the module, by file."""
    return {
        file: data
        for file, data in project.items()
        if isinstance(data, dict) and "my_robot.states:" in str(data.get("code"))
    }


def class_lines(interface: Mapping[str, Any]) -> list[str]:
    """A class that does what its interface declares."""
    good, bad, preempted = (json.dumps(name) for name in interface["outcomes"])
    (output,) = (json.dumps(key) for key in interface["output_keys"])
    reads = ", ".join(f"userdata[{json.dumps(key)}]" for key in interface["input_keys"])
    always = "writes" not in interface
    return [
        f"class {interface['name']}(smach.State):",
        "    def __init__(self, speed=1.0):",
        f"        super().__init__([{good}, {bad}, {preempted}],"
        f" {[*interface['input_keys']]!r}, [{output}])",
        "        self.speed = speed",
        "",
        "    def execute(self, userdata):",
        "        if self.preempt_requested():",
        f"            return {preempted}",
        f"        result = robot.move([{reads}], self.speed)",
        *([f"        userdata[{output}] = result"] if always else []),
        "        if result is None:",
        f"            return {bad}",
        *([] if always else [f"        userdata[{output}] = result"]),
        f"        return {good}",
        "",
        "",
    ]


def module_of(project: Mapping[str, Any]) -> list[str]:
    """The lines of the module with the classes of all interfaces."""
    lines = ["import smach", "from robot_driver import robot", ""]
    for interface in interfaces(project).values():
        lines += class_lines(interface)
    return lines


def changed(
    subject: Subject, start: str, new: str | None, code: str, at: str = ""
) -> Mutant | None:
    """The project with its module, in which the last line of one class that starts with `start` is
    another one, or removed. The fault is at that line, or at the one that starts with `at`."""
    held = interfaces(subject.project)
    if not held:
        return None
    interface = held[subject.draw.choice(sorted(held))]
    lines = module_of(subject.project)
    first = lines.index(f"class {interface['name']}(smach.State):")
    last = first + len(class_lines(interface))

    def line_of(text: str) -> int:
        return max(n for n in range(first, last) if lines[n].strip().startswith(text))

    fault, place = line_of(start), line_of(at or start)
    margin = lines[fault][: len(lines[fault]) - len(lines[fault].lstrip())]
    lines[fault] = margin + ("pass" if new is None else new)
    subject.project[MODULE] = "\n".join(lines)
    return Mutant(codes=(code,), lines=((MODULE, place + 1),))


@mutation
def return_another_outcome(subject: Subject) -> Mutant | None:
    return changed(subject, "return", 'return "no_outcome"', "SM309")


@mutation
def return_nothing(subject: Subject) -> Mutant | None:
    return changed(subject, "return", None, "SM309", "def execute")


@mutation
def set_no_output(subject: Subject) -> Mutant | None:
    mutant = changed(subject, "userdata[", None, "SM314", "def execute")
    held = [
        interface for interface in interfaces(subject.project).values() if "writes" in interface
    ]
    if mutant is None or not held:
        return mutant
    (place,) = mutant.lines
    rows = subject.project[MODULE].split("\n")
    ends = next(
        n for n, row in enumerate(rows) if n >= place[1] and row.startswith("        return")
    )
    return Mutant(codes=mutant.codes, lines=(place, (MODULE, ends + 1)))


@mutation
def set_another_key(subject: Subject) -> Mutant | None:
    return changed(subject, "userdata[", 'userdata["left_over"] = result', "SM308")


@mutation
def read_another_key(subject: Subject) -> Mutant | None:
    return changed(subject, "result =", 'result = robot.move(userdata["elsewhere"])', "SM310")


@mutation
def ignore_a_stop(subject: Subject) -> Mutant | None:
    mutant = changed(subject, "if self.preempt", "if False:", "SM315", "def execute")
    text = subject.project.get(MODULE, "")
    before, _, rest = text.partition("if False:\n            return ")
    if mutant is not None:
        subject.project[MODULE] = f"{before}if False:\n            pass  # {rest}"
    return mutant


@mutation
def rename_a_class(subject: Subject) -> Mutant | None:
    held = interfaces(subject.project)
    mutant = changed(subject, "class", "class Other(smach.State):", "SM608")
    if mutant is None:
        return None
    names = {line for line in subject.project[MODULE].split("\n") if line.startswith("class")}
    (file,) = [f for f, each in held.items() if f"class {each['name']}(smach.State):" not in names]
    return Mutant(codes=("SM608",), places=((file, ("code", "python")),))


@mutation
def take_no_variable(subject: Subject) -> Mutant | None:
    return changed(subject, "def __init__", "def __init__(self):", "SM609", "class")


@mutation
def require_another_variable(subject: Subject) -> Mutant | None:
    return changed(subject, "def __init__", "def __init__(self, speed, robot):", "SM609")


@mutation
def make_no_state(subject: Subject) -> Mutant | None:
    return changed(subject, "super()", None, "SM609", "def __init__")


@mutation
def misspell_execute(subject: Subject) -> Mutant | None:
    new = f"def {swap_letters('execute')}(self, userdata):"
    return changed(subject, "def execute", new, "SM609")


@mutation
def hide_a_method(subject: Subject) -> Mutant | None:
    return changed(subject, "self.speed", "self.preempt_requested = False", "SM609")

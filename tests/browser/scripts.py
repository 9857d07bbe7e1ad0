"""Scripts of large machines."""

from __future__ import annotations

import random


def large_script(machines: int, states: int) -> str:
    """A machine of machines with states that succeed, try again or fail."""
    lines = ["name: big", "outcomes: [succeeded, aborted]", "states:"]
    for machine in range(machines):
        after = f"M{machine + 1:02}" if machine + 1 < machines else "succeeded"
        lines += [
            f"  - M{machine:02}:",
            "      template: StateMachine",
            "      outcomes: [succeeded, aborted]",
            f"      transitions: {{succeeded: {after}}}",
            "      states:",
        ]
        for each in range(states):
            onward = f"S{each + 1:02}" if each + 1 < states else "succeeded"
            again = f"S{max(0, each - 3):02}"
            lines.append(
                f"        - S{each:02}: {{template: ScriptedState, outcomes: [ok, retry, aborted],"
                f" transitions: {{ok: {onward}, retry: {again}}}}}"
            )
    return "\n".join([*lines, ""])


SHAPES = ("chain", "ring", "random", "failures")


def flat_script(shape: str, count: int) -> str:
    """A machine of `count` leaf states. `chain`: each leads to the next one; `ring`: the last one
    leads to the first; `random`: two outcomes each, to any states; `failures`: a chain in which
    each state may end the machine with `aborted`."""
    generator = random.Random(count)
    lines = ["name: flat", "outcomes: [succeeded, aborted]", "states:"]
    for each in range(count):
        onward = {"ok": f"S{each + 1}" if each + 1 < count else "succeeded"}
        if shape == "ring":
            onward = {"ok": f"S{(each + 1) % count}"}
            if each == count - 1:
                onward["done"] = "succeeded"
        elif shape == "random":
            onward["other"] = f"S{generator.randrange(count)}"
            onward["far"] = f"S{generator.randrange(count)}"
        elif shape == "failures":
            onward["bad"] = "aborted"
        outcomes = ", ".join(onward)
        transitions = ", ".join(f"{outcome}: {to}" for outcome, to in onward.items())
        lines.append(
            f"  - S{each}: {{template: ScriptedState, outcomes: [{outcomes}],"
            f" transitions: {{{transitions}}}}}"
        )
    return "\n".join([*lines, ""])


def limited_script(machines: int, states: int) -> str:
    """Machines one after the other, of states with time limits and tries."""
    fields = (
        "",
        "timeout: 5 min, ",
        "retry: {on: [bad], max: 3, delay: 1s}, ",
        "timeout: 1 min, retry: {on: [bad], max: 3}, ",
    )
    lines = ["name: big", "template: Base", "outcomes: [done, failed, preempted]", "states:"]
    for number in range(machines):
        after = f"M{number + 1}" if number + 1 < machines else "done"
        lines += [
            f"  - M{number}:",
            "      template: StateMachine",
            "      outcomes: [done, failed, preempted]",
            f"      transitions: {{done: {after}, failed: failed, preempted: preempted}}",
            "      states:",
        ]
        for place in range(states):
            own = fields[place % len(fields)]
            ends = {"ok": f"S{place + 1}" if place + 1 < states else "done"}
            ends["exhausted" if "retry" in own else "bad"] = "failed"
            ends |= {"timeout": "failed"} if "timeout" in own else {}
            ends |= {"preempted": "preempted"} if own else {}
            led = ", ".join(f"{outcome}: {target}" for outcome, target in ends.items())
            lines.append(
                f"        - S{place}: {{template: ScriptedState, outcomes: [ok, bad], {own}"
                f"transitions: {{{led}}}}}"
            )
    return "\n".join([*lines, ""])

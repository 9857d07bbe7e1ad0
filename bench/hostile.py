"""CPU time of commands over hostile inputs, each of some size and of twice that size.

Usage: python bench/hostile.py [NAME ...]

Each line is an input: its size, the seconds of CPU of the whole command at that size and at twice
the size, and their quotient. The goals: 2 s at the first size, a quotient of 2.3. A run ends after
60 s of CPU or with 4 GB.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

Input = Callable[[Path, int], list[str]]
"""Writes the files of an input of a size into a folder; the arguments of smachac."""

SECONDS, BYTES = 60, 4_000_000_000
CACHE = str(Path(tempfile.gettempdir()) / "smachac-bench-bytecode")
GOAL_SECONDS, GOAL_QUOTIENT = 2.0, 2.3

HEAD = "name: sm\ntemplate: Base\noutcomes: [done]\n"
INPUTS: dict[str, tuple[int, Input]] = {}


def hostile(size: int) -> Callable[[Input], Input]:
    """Lists an input with its first size."""

    def listed(function: Input) -> Input:
        INPUTS[function.__name__] = (size, function)
        return function

    return listed


def check(folder: Path, text: str, *options: str) -> list[str]:
    """The check of a script."""
    (folder / "main.yml").write_text(text)
    return ["check", "main.yml", *options]


def chain(size: int, more: str = "") -> str:
    """A chain of states of one outcome, with more fields."""
    lines = [HEAD + "states:"]
    for number in range(size):
        target = f"S{number + 1}" if number < size - 1 else "done"
        lines.append(
            f"- S{number}: {{template: ScriptedState, outcomes: [ok],"
            f" transitions: {{ok: {target}}}{more % {'n': number}}}}"
        )
    return "\n".join(lines) + "\n"


def state(fields: str, head: str = "") -> str:
    """A script of one state with some fields."""
    return (
        f"{HEAD}{head}states:\n- A: {{template: ScriptedState, outcomes: [ok],"
        f" transitions: {{ok: done}}{fields}}}\n"
    )


def words(pattern: str, size: int) -> str:
    """A pattern for each number, separated by commas."""
    return ", ".join(pattern % {"n": number} for number in range(size))


# Names


@hostile(64_000)
def long_state_name(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2).replace("S1", "Ab_c" * (size // 4)))


@hostile(64_000)
def long_wrong_target(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2).replace("ok: S1", "ok: " + "Ab_c" * (size // 4)))


@hostile(64_000)
def long_wrong_outcome(folder: Path, size: int) -> list[str]:
    name = "Ab_c" * (size // 4)
    return check(
        folder,
        f"{HEAD}states:\n- A: {{template: SleepState, time: 1, transitions: {{{name}: done}}}}\n",
    )


@hostile(64_000)
def long_key(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", input_keys: [{'Ab_c' * (size // 4)}]", "userdata: {a: 1}\n"))


@hostile(64_000)
def long_field(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", {'Ab_c' * (size // 4)}: 1"))


@hostile(64_000)
def long_type(folder: Path, size: int) -> list[str]:
    return check(folder, state("").replace("ScriptedState", "Ab_c" * (size // 4)))


@hostile(64_000)
def long_script_name(folder: Path, size: int) -> list[str]:
    return check(folder, f"{HEAD}states:\n- A: {{script: {'Ab_c' * (size // 4)}}}\n")


@hostile(64_000)
def long_look_up(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", x: [[{'Ab_c' * (size // 4)}]]", "params: {a: 1}\n"))


@hostile(64_000)
def long_key_type(folder: Path, size: int) -> list[str]:
    return check(
        folder, state(f", input_keys: {{a: {'Ab_c' * (size // 4)}}}", "userdata: {a: 1}\n")
    )


@hostile(64_000)
def long_digits(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"userdata: {{a: {'7' * size}}}\n"))


@hostile(64_000)
def long_underscores(folder: Path, size: int) -> list[str]:
    return check(folder, state("").replace("ok: done", f"ok: {'a_' * (size // 2)}"))


@hostile(64_000)
def long_property_event(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"properties: [at_most: {{{'Ab_c' * (size // 4)}: 3}}]\n"))


@hostile(64_000)
def long_frame(folder: Path, size: int) -> list[str]:
    text = state("", f"robot: panda\nuserdata: {{frame_id: {'Ab_c' * (size // 4)}}}\n")
    return check(folder, text)


@hostile(64_000)
def long_code(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        state(", callbacks: {ok: 'lambda ud: ud." + "Ab_c" * (size // 4) + "'}").replace(
            "ScriptedState", "ConditionalOutcomeState"
        ),
    )


@hostile(64_000)
def long_command_word(folder: Path, size: int) -> list[str]:
    check(folder, chain(3))
    return ["rename", "main.yml", "Ab_c" * (size // 4), "B"]


# Wrong references


@hostile(10_000)
def wrong_targets(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ok: S", "ok: T"))


@hostile(10_000)
def wrong_targets_json(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ok: S", "ok: T"), "--format", "json")


@hostile(10_000)
def wrong_targets_sarif(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ok: S", "ok: T"), "--format", "sarif")


@hostile(10_000)
def slips_of_targets(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ok: S", "ok: SS"))


@hostile(10_000)
def near_targets(folder: Path, size: int) -> list[str]:
    """Names of equal length and letters, all of them near one another."""
    text = [HEAD + "states:"]
    for number in range(size):
        text.append(
            f"- PICK_THE_BLOCK_{number:06}: {{template: ScriptedState, outcomes: [ok],"
            f" transitions: {{ok: PICK_THE_BLOCK_{number + 500_000:06}}}}}"
        )
    return check(folder, "\n".join(text) + "\n")


@hostile(5_000)
def wrong_targets_of_a_state(folder: Path, size: int) -> list[str]:
    outcomes, steps = words("o%(n)d", size), words("o%(n)d: T%(n)d", size)
    return check(
        folder,
        f"{HEAD}states:\n- A: {{template: ScriptedState, outcomes: [{outcomes}],"
        f" transitions: {{{steps}}}}}\n",
    )


@hostile(10_000)
def wrong_outcomes(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("transitions: {ok:", "transitions: {kko:"))


@hostile(10_000)
def wrong_types(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ScriptedState", "SkriptedStat"))


@hostile(10_000)
def different_wrong_types(folder: Path, size: int) -> list[str]:
    text = [HEAD + "states:"]
    text += [f"- S{number}: {{template: Scrip{number}}}" for number in range(size)]
    return check(folder, "\n".join(text) + "\n")


@hostile(10_000)
def wrong_scripts(folder: Path, size: int) -> list[str]:
    text = [HEAD + "states:"]
    text += [f"- S{number}: {{script: pick_{number}}}" for number in range(size)]
    return check(folder, "\n".join(text) + "\n")


@hostile(10_000)
def wrong_keys(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        chain(size, ", input_keys: [part_%(n)d]").replace(
            "states:", "userdata: {prat: 1}\nstates:", 1
        ),
    )


@hostile(10_000)
def wrong_remappings(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size, ", input_keys: [a], remapping: {b%(n)d: c%(n)d}"))


@hostile(10_000)
def wrong_look_ups(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        chain(size, ", x: [[speed_%(n)d]]").replace("states:", "params: {sped: 1}\nstates:", 1),
    )


@hostile(10_000)
def wrong_code(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size, ", x: '`undefined_%(n)d(1)`'"))


@hostile(10_000)
def equal_names(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("- S", "- T").replace("T1", "T"))


# Lists


@hostile(30_000)
def unknown_fields(folder: Path, size: int) -> list[str]:
    return check(
        folder, HEAD + "states:\n- A: {template: SleepState, " + words("x%(n)d: 1", size) + "}\n"
    )


@hostile(30_000)
def unknown_fields_of_machine(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2) + words("x%(n)d: 1", size).replace(", ", "\n") + "\n")


@hostile(20_000)
def outcomes(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        f"{HEAD}states:\n- A: {{template: ScriptedState, outcomes: [{words('o%(n)d', size)}]}}\n",
    )


@hostile(20_000)
def outcomes_with_transitions(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        f"{HEAD}states:\n- A: {{template: ScriptedState, outcomes: [{words('o%(n)d', size)}],"
        f" transitions: {{{words('o%(n)d: done', size)}}}}}\n",
    )


@hostile(20_000)
def machine_outcomes(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2).replace("[done]", f"[done, {words('o%(n)d', size)}]"))


@hostile(20_000)
def transitions(folder: Path, size: int) -> list[str]:
    return check(
        folder, state("").replace("{ok: done}", f"{{ok: done, {words('o%(n)d: done', size)}}}")
    )


@hostile(20_000)
def equal_outcomes(folder: Path, size: int) -> list[str]:
    return check(folder, state("").replace("[ok]", f"[{words('ok', size)}]"))


@hostile(20_000)
def duplicate_fields(folder: Path, size: int) -> list[str]:
    return check(
        folder, HEAD + "states:\n- A: {template: SleepState, " + words("x: %(n)d", size) + "}\n"
    )


@hostile(20_000)
def userdata(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"userdata: {{{words('k%(n)d: 1', size)}}}\n"))


@hostile(20_000)
def input_keys(folder: Path, size: int) -> list[str]:
    keys = words("k%(n)d", size)
    return check(folder, state(f", input_keys: [{keys}]", f"input_keys: [{keys}]\n"))


@hostile(20_000)
def unset_keys(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", input_keys: [{words('k%(n)d', size)}]", "userdata: {a: 1}\n"))


@hostile(5_000)
def unset_beside_unread_keys(folder: Path, size: int) -> list[str]:
    """Keys that nothing sets, and presets that nothing reads, all of them near one another."""
    presets = words("key_%(n)06d: 1", size)
    names = ", ".join(f"key_{number + 500_000:06}" for number in range(size))
    return check(folder, state(f", input_keys: [{names}]", f"userdata: {{{presets}}}\n"))


@hostile(20_000)
def output_keys(folder: Path, size: int) -> list[str]:
    keys = words("k%(n)d", size)
    return check(folder, state(f", output_keys: [{keys}]", f"output_keys: [{keys}]\n"))


@hostile(20_000)
def remapping(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        state(
            f", input_keys: [{words('k%(n)d', size)}], remapping: {{{words('k%(n)d: a', size)}}}",
            "userdata: {a: 1}\n",
        ),
    )


@hostile(20_000)
def tags(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", tags: [{words('t%(n)d', size)}]"))


@hostile(20_000)
def claims(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", claims: [{words('t%(n)d', size)}]"))


@hostile(20_000)
def params(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"params: {{{words('p%(n)d: 1', size)}}}\n"))


@hostile(20_000)
def params_of_params(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"params: {{p: 1, {words('p%(n)d: [[p]]', size)}}}\n"))


@hostile(5_000)
def callbacks(folder: Path, size: int) -> list[str]:
    called = words("o%(n)d: lambda ud: ud.a < %(n)d", size)
    text = state(
        f", callbacks: {{{called}}}, input_keys: [a], default_outcome: ok",
        "userdata: {a: 1}\n",
    )
    return check(folder, text.replace("ScriptedState", "ConditionalOutcomeState"))


@hostile(3_000)
def properties(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"properties: [{words('at_most: {A: %(n)d}', size)}]\n"))


@hostile(3_000)
def properties_of_wrong_states(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"properties: [{words('at_most: {B%(n)d: 1}', size)}]\n"))


@hostile(10_000)
def property_of_many_events(folder: Path, size: int) -> list[str]:
    events = words("S%(n)d", size)
    return check(
        folder,
        chain(size).replace("states:", f"properties: [after: {{S0: [{events}]}}]\nstates:", 1),
    )


@hostile(10_000)
def claims_of_states(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size, ", claims: [arm.c%(n)d]"))


@hostile(20_000)
def types(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"types: {{{words('T%(n)d: int', size)}}}\n"))


@hostile(5_000)
def types_of_types(folder: Path, size: int) -> list[str]:
    return check(
        folder, state("", f"types: {{T: int, T0: T, {words('U%(n)d: list[T0]', size)}}}\n")
    )


@hostile(3_000)
def chained_types(folder: Path, size: int) -> list[str]:
    chained = ", ".join(f"T{number + 1}: 'T{number}[2]'" for number in range(size))
    return check(folder, state("", f"types: {{T0: int, {chained}}}\n"))


@hostile(20_000)
def record_fields(folder: Path, size: int) -> list[str]:
    types = f"types: {{T: {{{words('f%(n)d: int', size)}}}}}\n"
    value = f"userdata: {{a: {{type: T, value: {{{words('f%(n)d: 1', size)}}}}}}}\n"
    return check(folder, state("", types + value))


@hostile(20_000)
def words_of_an_enumeration(folder: Path, size: int) -> list[str]:
    types = f"types: {{T: 'one_of[{words('f%(n)d', size)}]'}}\n"
    return check(folder, state("", types + "userdata: {a: {type: T, value: g1}}\n"))


@hostile(2_000)
def rules_of_a_concurrence(folder: Path, size: int) -> list[str]:
    return concurrence(
        folder,
        12,
        f"outcome_map: {{{words('r%(n)d: {B%(n)d: ok}', size)}}}".replace("{B", "{B0, C"),
        f"[done, {words('r%(n)d', size)}]",
    )


@hostile(2_000)
def different_rules(folder: Path, size: int) -> list[str]:
    rules = ", ".join(f"r{n}: {{B{n}: ok}}" for n in range(size))
    return concurrence(
        folder, size, f"outcome_map: {{{rules}}}", f"[done, {words('r%(n)d', size)}]"
    )


@hostile(3_000)
def branches(folder: Path, size: int) -> list[str]:
    return concurrence(folder, size, "outcome_map: {}", "[done]")


@hostile(3_000)
def branches_that_write_a_key(folder: Path, size: int) -> list[str]:
    return concurrence(folder, size, "output_keys: [k]", "[done]", ", output_keys: [k]")


@hostile(3_000)
def branches_that_claim(folder: Path, size: int) -> list[str]:
    return concurrence(folder, size, "outcome_map: {}", "[done]", ", claims: [arm]")


@hostile(3_000)
def one_rule_of_all_branches(folder: Path, size: int) -> list[str]:
    return concurrence(
        folder, size, f"outcome_map: {{done: {{{words('B%(n)d: ok', size)}}}}}", "[done]"
    )


def concurrence(folder: Path, size: int, fields: str, ends: str, more: str = "") -> list[str]:
    """The check of a concurrence of some branches."""
    head = HEAD.replace("[done]", ends)
    lines = [
        f"{head}states:\n- C:\n    template: Concurrence\n    outcomes: {ends}\n"
        f"    default_outcome: done\n    {fields}\n    states:"
    ]
    lines += [
        f"    - B{n}: {{template: ScriptedState, outcomes: [ok, bad]{more}}}" for n in range(size)
    ]
    return check(folder, "\n".join(lines) + "\n")


@hostile(30)
def at_most_over_branches(folder: Path, size: int) -> list[str]:
    """Branches that retry 30 times."""
    retry = ", retry: {on: [bad], max: 30}"
    arguments = concurrence(folder, size // 5, "outcome_map: {}", "[done]", retry)
    path = folder / "main.yml"
    path.write_text(
        path.read_text().replace("states:", "properties: [at_most: {B1: 3}]\nstates:", 1)
    )
    return arguments


@hostile(30)
def at_most_large(folder: Path, size: int) -> list[str]:
    text = chain(size, ", retry: {on: [ok], max: 30}")
    return check(
        folder, text.replace("states:", f"properties: [at_most: {{S1: {size * 100}}}]\nstates:", 1)
    )


@hostile(10_000)
def at_most_in_a_ring(folder: Path, size: int) -> list[str]:
    text = state("").replace("{ok: done}", "{ok: A, no: done}").replace("[ok]", "[ok, no]")
    return check(
        folder, text.replace("states:", f"properties: [at_most: {{A: {size}}}]\nstates:", 1)
    )


# Depth and length


NEST = 300
"""Blocks one inside another: a text of more than 900 levels is refused before any other work."""


@hostile(3_000)
def nested_blocks(folder: Path, size: int) -> list[str]:
    """Blocks in nests of 300."""
    nest = "".join(" " * depth + "a:\n" for depth in range(2, NEST)) + " " * NEST + "a: 1\n"
    nests = "".join(f" k{number}:\n{nest}" for number in range(size // NEST))
    return check(folder, state("", f"userdata:\n{nests}"))


@hostile(3_000)
def nested_brackets(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"userdata: {{a: {'[' * size}{']' * size}}}\n"))


@hostile(500)
def nested_containers(folder: Path, size: int) -> list[str]:
    lines = [HEAD + "states:"]
    for depth in range(size):
        space = "  " * depth
        lines += [
            f"{space}- C{depth}:",
            f"{space}   template: StateMachine",
            f"{space}   outcomes: [done]",
            f"{space}   states:",
        ]
    lines.append("  " * size + "- A: {template: ScriptedState, outcomes: [done]}")
    return check(folder, "\n".join(lines) + "\n")


@hostile(4_500_000)
def long_text(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"doc: {'a ' * (size // 2)}\n"))


@hostile(400)
def deep_expression(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", x: '`{'(' * size}1{')' * size}`'"))


@hostile(20_000)
def long_expression(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", x: '`[{words('%(n)d + 1', size)}]`'"))


@hostile(5_000)
def long_sum(folder: Path, size: int) -> list[str]:
    return check(folder, state(f", x: '`{' + '.join(['1'] * size)}`'"))


@hostile(100_000)
def comments(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2) + "# a comment\n" * size)


@hostile(20_000)
def allowances(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2) + "# smachac: allow SM201 because\n" * size)


@hostile(20_000)
def allowances_of_wrong_codes(folder: Path, size: int) -> list[str]:
    return check(folder, chain(2) + "# smachac: allow SM9999 because\n" * size)


@hostile(10_000)
def aliases(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"userdata: {{a: &a [1], b: [{words('*a', size)}]}}\n"))


@hostile(20_000)
def anchors(folder: Path, size: int) -> list[str]:
    return check(folder, state("", f"userdata: {{a: [{words('&a%(n)d 1', size)}]}}\n"))


@hostile(20_000)
def syntax_errors(folder: Path, size: int) -> list[str]:
    return check(folder, HEAD + "states:\n" + "- A: {a: [1}\n" * size)


@hostile(20_000)
def tabs(folder: Path, size: int) -> list[str]:
    return check(folder, HEAD + "states:\n" + "\t- A:\n" * size)


@hostile(20_000)
def unclosed_brackets(folder: Path, size: int) -> list[str]:
    return check(folder, HEAD + "states:\n" + "- [\n" * size)


@hostile(20_000)
def unclosed_quotes(folder: Path, size: int) -> list[str]:
    return check(folder, HEAD + "states:\n" + '- "a\n' * size)


@hostile(500_000)
def colons(folder: Path, size: int) -> list[str]:
    return check(folder, HEAD + "states: " + "a: " * size + "\n")


@hostile(20_000)
def wrong_indents(folder: Path, size: int) -> list[str]:
    return check(
        folder, HEAD + "states:\n" + "".join(f" {' ' * (n % 5)}- A{n}:\n" for n in range(size))
    )


@hostile(20_000)
def fields_without_colon(folder: Path, size: int) -> list[str]:
    return check(folder, HEAD + "states:\n" + "- A\n    template SleepState\n" * size)


@hostile(20_000)
def fields_outside_of_states(folder: Path, size: int) -> list[str]:
    return check(
        folder,
        HEAD
        + "states:\n"
        + "".join(f"- A{n}:\n- template: SleepState\n- time: 1\n" for n in range(size)),
    )


# fmt


@hostile(3_000)
def fmt_nested_blocks(folder: Path, size: int) -> list[str]:
    nested_blocks(folder, size)
    return ["fmt", "main.yml"]


@hostile(3_000)
def fmt_nested_brackets(folder: Path, size: int) -> list[str]:
    nested_brackets(folder, size)
    return ["fmt", "main.yml"]


@hostile(4_500_000)
def fmt_long_line(folder: Path, size: int) -> list[str]:
    long_text(folder, size)
    return ["fmt", "main.yml"]


@hostile(4_500_000)
def fmt_long_quoted_line(folder: Path, size: int) -> list[str]:
    check(folder, state("", f"doc: '{'a ' * (size // 2)}'\n"))
    return ["fmt", "main.yml"]


@hostile(100_000)
def fmt_long_list(folder: Path, size: int) -> list[str]:
    check(folder, state("", f"userdata: {{a: [{words('%(n)d', size)}]}}\n"))
    return ["fmt", "main.yml"]


@hostile(100_000)
def fmt_comments(folder: Path, size: int) -> list[str]:
    comments(folder, size)
    return ["fmt", "main.yml"]


@hostile(100_000)
def fmt_empty_lines(folder: Path, size: int) -> list[str]:
    check(folder, chain(2) + " \n" * size + "forever: false\n")
    return ["fmt", "main.yml"]


@hostile(2_000)
def fmt_states(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["fmt", "main.yml"]


@hostile(20_000)
def fmt_unknown_fields(folder: Path, size: int) -> list[str]:
    unknown_fields(folder, size)
    return ["fmt", "main.yml"]


@hostile(20_000)
def fmt_outcomes(folder: Path, size: int) -> list[str]:
    outcomes(folder, size)
    return ["fmt", "main.yml"]


@hostile(20_000)
def fmt_shorthand(folder: Path, size: int) -> list[str]:
    params_of_params(folder, size)
    return ["fmt", "main.yml", "--shorthand"]


# Other commands


@hostile(20_000)
def build_outcomes(folder: Path, size: int) -> list[str]:
    outcomes_with_transitions(folder, size)
    return ["build", "main.yml", "--target", "python", "-o", "out"]


@hostile(20_000)
def build_cpp_outcomes(folder: Path, size: int) -> list[str]:
    outcomes_with_transitions(folder, size)
    return ["build", "main.yml", "--target", "cpp", "-o", "out"]


@hostile(5_000)
def build_dot(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["build", "main.yml", "--target", "dot", "-o", "out"]


@hostile(5_000)
def build_html(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["build", "main.yml", "--target", "html", "-o", "out"]


@hostile(5_000)
def build_ir(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["build", "main.yml", "--target", "ir", "-o", "out"]


@hostile(5_000)
def rename_state(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["rename", "main.yml", "S5", "T5", "--diff"]


@hostile(20_000)
def rename_outcome_of_many(folder: Path, size: int) -> list[str]:
    outcomes_with_transitions(folder, size)
    return ["rename", "main.yml", "A/o1", "p1", "--diff"]


@hostile(5_000)
def rename_key_of_many(folder: Path, size: int) -> list[str]:
    check(
        folder, chain(size, ", input_keys: [k]").replace("states:", "userdata: {k: 1}\nstates:", 1)
    )
    return ["rename", "main.yml", "k", "l", "--diff"]


@hostile(5_000)
def diff_renamed(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    (folder / "new.yml").write_text(chain(size).replace("S", "T"))
    return ["diff", "main.yml", "new.yml"]


@hostile(5_000)
def diff_reordered(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    lines = chain(size).splitlines()
    (folder / "new.yml").write_text("\n".join([*lines[:4], *reversed(lines[4:])]) + "\n")
    return ["diff", "main.yml", "new.yml"]


@hostile(20_000)
def diff_outcomes(folder: Path, size: int) -> list[str]:
    outcomes_with_transitions(folder, size)
    text = (folder / "main.yml").read_text()
    (folder / "new.yml").write_text(text.replace("o", "p").replace("ppdape", "x"))
    return ["diff", "main.yml", "new.yml"]


@hostile(20_000)
def diff_userdata(folder: Path, size: int) -> list[str]:
    userdata(folder, size)
    text = (folder / "main.yml").read_text()
    (folder / "new.yml").write_text(text.replace(": 1", ": 2"))
    return ["diff", "main.yml", "new.yml"]


@hostile(10_000)
def explain_failures(folder: Path, size: int) -> list[str]:
    text = chain(size).replace("[ok]", "[ok, aborted]").replace("{ok", "{aborted: done, ok")
    check(folder, text)
    return ["explain", "main.yml", "--failures"]


@hostile(10_000)
def explain_state(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["explain", "main.yml", "S7"]


@hostile(10_000)
def explain_key(folder: Path, size: int) -> list[str]:
    check(
        folder, chain(size, ", input_keys: [k]").replace("states:", "userdata: {k: 1}\nstates:", 1)
    )
    return ["explain", "main.yml", "k"]


@hostile(10_000)
def explain_wrong_state(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["explain", "main.yml", "T7"]


# Other files


@hostile(50_000)
def baseline(folder: Path, size: int) -> list[str]:
    findings = [
        {
            "file": "main.yml",
            "code": "SM201",
            "fingerprint": f"{number:016x}",
            "count": 1,
            "message": "m",
        }
        for number in range(size)
    ]
    (folder / "known.json").write_text(json.dumps({"version": 2, "findings": findings}))
    return check(folder, chain(3), "--baseline", "known.json")


@hostile(10_000)
def write_baseline(folder: Path, size: int) -> list[str]:
    return check(
        folder, chain(size).replace("ok: S", "ok: T"), "--baseline", "k.json", "--write-baseline"
    )


@hostile(20_000)
def project_settings(folder: Path, size: int) -> list[str]:
    (folder / "smachac.toml").write_text("\n".join(f"x{n} = 1" for n in range(size)) + "\n")
    return check(folder, chain(3))


@hostile(20_000)
def project_severities(folder: Path, size: int) -> list[str]:
    lines = "\n".join(f'SN{n} = "off"' for n in range(size))
    (folder / "smachac.toml").write_text(f"[severity]\n{lines}\n")
    return check(folder, chain(3))


@hostile(20_000)
def project_folders(folder: Path, size: int) -> list[str]:
    (folder / "smachac.toml").write_text("scripts = [" + words("'x%(n)d'", size) + "]\n")
    return check(folder, chain(3))


@hostile(20_000)
def project_excludes(folder: Path, size: int) -> list[str]:
    (folder / "smachac.toml").write_text("exclude = [" + words("'x%(n)d/**'", size) + "]\n")
    check(folder, chain(3))
    return ["check", "."]


@hostile(64_000)
def project_long_key(folder: Path, size: int) -> list[str]:
    (folder / "smachac.toml").write_text("a" * size + " = 1\n")
    return check(folder, chain(3))


def interface(folder: Path, text: str) -> list[str]:
    """The check of a state of a type with an interface."""
    (folder / "Move.yml").write_text(f"name: Move\n{text}")
    return check(folder, f"{HEAD}states:\n- A: {{template: Move, transitions: {{ok: done}}}}\n")


@hostile(20_000)
def interface_outcomes(folder: Path, size: int) -> list[str]:
    return interface(folder, f"outcomes: [ok, {words('o%(n)d', size)}]\n")


@hostile(20_000)
def interface_keys(folder: Path, size: int) -> list[str]:
    return interface(folder, f"outcomes: [ok]\ninput_keys: [{words('o%(n)d', size)}]\n")


@hostile(20_000)
def interface_variables(folder: Path, size: int) -> list[str]:
    return interface(
        folder, f"outcomes: [ok]\nvariables: {{{words('v%(n)d: {type: int}', size)}}}\n"
    )


@hostile(20_000)
def interface_fields(folder: Path, size: int) -> list[str]:
    return interface(folder, f"outcomes: [ok]\n{words('v%(n)d: 1', size)}\n".replace(", ", "\n"))


@hostile(20_000)
def interface_writes(folder: Path, size: int) -> list[str]:
    keys = words("v%(n)d", size)
    return interface(folder, f"outcomes: [ok]\noutput_keys: [{keys}]\nwrites: {{ok: [{keys}]}}\n")


@hostile(500)
def interfaces(folder: Path, size: int) -> list[str]:
    for number in range(size):
        (folder / f"Move{number}.yml").write_text(f"name: Move{number}\noutcomes: [ok]\n")
    text = [HEAD + "states:"]
    text += [f"- A{n}: {{template: Move{n}, transitions: {{ok: done}}}}" for n in range(size)]
    return check(folder, "\n".join(text) + "\n")


def message(folder: Path, text: str, value: str) -> list[str]:
    """The check of a state with a message of a type of the project."""
    package = folder / "my_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_msgs</name></package>\n")
    (package / "msg" / "Part.msg").write_text(text)
    fields = f"userdata: {{m: {{type: my_msgs/Part, value: '`Part({value})`'}}}}\n"
    return check(folder, state("", fields))


@hostile(20_000)
def message_fields(folder: Path, size: int) -> list[str]:
    text = "\n".join(f"int32 f{n}" for n in range(size))
    return message(folder, text + "\n", "f1=1, g2=3")


@hostile(20_000)
def message_constants(folder: Path, size: int) -> list[str]:
    text = "\n".join(f"int32 F{n}={n}" for n in range(size))
    return message(folder, text + "\n", "f1=1")


@hostile(5_000)
def message_arguments(folder: Path, size: int) -> list[str]:
    return message(folder, "int32 f1\n", words("f%(n)d=1", size))


@hostile(64_000)
def message_long_line(folder: Path, size: int) -> list[str]:
    return message(folder, f"int32 {'f' * size}\n{'g' * size} b\n", "f1=1")


def scene(folder: Path, text: str) -> list[str]:
    (folder / "scene.yml").write_text(text)
    return check(
        folder,
        state("", "robot: panda\nscene: scene.yml\n").replace(
            "template: Base", "template: PyBulletBase"
        ),
    )


@hostile(30_000)
def scene_bodies(folder: Path, size: int) -> list[str]:
    bodies = "\n".join(
        f"  b{n}: {{box: [0.1, 0.1, 0.1], position: [0.5, 0, 0.1]}}" for n in range(size)
    )
    return scene(folder, f"bodies:\n{bodies}\n")


@hostile(30_000)
def scene_body_list(folder: Path, size: int) -> list[str]:
    bodies = "\n".join(
        f"- {{name: b{n}, box: [0.1, 0.1, 0.1], position: [0.5, 0, 0.1]}}" for n in range(size)
    )
    return scene(folder, f"bodies:\n{bodies}\n")


def scenario(folder: Path, text: str) -> list[str]:
    check(folder, chain(100))
    (folder / "scenario.yml").write_text(text)
    return ["run", "main.yml", "--mock", "scenario.yml", "-q"]


@hostile(20_000)
def scenario_states(folder: Path, size: int) -> list[str]:
    return scenario(folder, "states:\n" + "".join(f"  T{n}: [ok]\n" for n in range(size)))


@hostile(20_000)
def scenario_steps(folder: Path, size: int) -> list[str]:
    return scenario(folder, "states:\n  S1:\n" + "    - ok\n" * size)


@hostile(20_000)
def scenario_wrong_steps(folder: Path, size: int) -> list[str]:
    return scenario(folder, "states:\n  S1:\n" + "".join(f"    - ko{n}\n" for n in range(size)))


@hostile(20_000)
def scenario_wrong_fields(folder: Path, size: int) -> list[str]:
    return scenario(
        folder,
        "states:\n" + "".join(f"  S{n % 100}: [{{otcome: ok, x{n}: 1}}]\n" for n in range(size)),
    )


def trace(folder: Path, lines: list[dict[str, object]], command: str = "check") -> list[str]:
    check(folder, chain(100))
    (folder / "run.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    return ["trace", command, "main.yml", "run.jsonl"]


def ring(folder: Path, size: int) -> list[dict[str, object]]:
    """The trace of a run of a ring of two states, of some steps, and the script."""
    lines: list[dict[str, object]] = [{"event": "enter", "path": "sm", "t": 0.0}]
    for number in range(size):
        name = f"sm/S{number % 2}"
        lines.append({"event": "enter", "path": name, "t": float(number)})
        lines.append({"event": "exit", "path": name, "outcome": "ok", "t": float(number)})
        target = f"sm/S{(number + 1) % 2}"
        lines.append(
            {"event": "transition", "from": name, "outcome": "ok", "to": target, "t": float(number)}
        )
    return lines


@hostile(50_000)
def trace_steps(folder: Path, size: int) -> list[str]:
    arguments = trace(folder, ring(folder, size))
    text = chain(2).replace("ok: done", "ok: S0, end: done").replace("[ok]", "[ok, end]")
    check(folder, text.replace("{ok: S1", "{end: done, ok: S1"))
    return arguments


@hostile(50_000)
def trace_statistics(folder: Path, size: int) -> list[str]:
    arguments = trace_steps(folder, size)
    return [arguments[0], "stats", *arguments[2:]]


@hostile(50_000)
def trace_of_unknown_states(folder: Path, size: int) -> list[str]:
    return trace(folder, [{"event": "enter", "path": f"sm/T{n}", "t": 1.0} for n in range(size)])


def seconds(arguments: list[str], folder: Path) -> tuple[float, int]:
    """CPU seconds of a command and its exit code (negative: a signal)."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))

    command = [sys.executable, "-m", "smachac", *arguments]
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": CACHE}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    with (folder / ".out").open("wb") as out:
        process = subprocess.Popen(
            command, cwd=folder, stdout=out, stderr=out, preexec_fn=limit, env=environment
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, process.returncode


def main(names: list[str]) -> None:
    print(f"{'input':32} {'size':>9} {'s':>6} {'twice':>6} {'quotient':>8}  code")
    for name, (size, write) in INPUTS.items():
        if names and name not in names:
            continue
        measured = []
        for factor in (1, 2):
            with tempfile.TemporaryDirectory() as folder:
                arguments = write(Path(folder), size * factor)
                took, code = seconds(arguments, Path(folder))
            measured.append(took)
        first, second = measured
        mark = "" if first < GOAL_SECONDS and second / first < GOAL_QUOTIENT else "  <--"
        print(
            f"{name:32} {size:9} {first:6.2f} {second:6.2f} {second / first:8.2f}  {code}{mark}",
            flush=True,
        )


if __name__ == "__main__":
    main(sys.argv[1:])

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
from collections.abc import Callable, Mapping
from functools import partial
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


def letters(size: int) -> str:
    """A name of so many letters."""
    return "Ab_c" * (size // 4)


SCRIPTS: Mapping[str, tuple[int, Callable[[int], str]]] = {
    "long_state_name": (64_000, lambda size: chain(2).replace("S1", letters(size))),
    "long_wrong_target": (64_000, lambda size: chain(2).replace("ok: S1", "ok: " + letters(size))),
    "long_key": (
        64_000,
        lambda size: state(f", input_keys: [{letters(size)}]", "userdata: {a: 1}\n"),
    ),
    "long_field": (64_000, lambda size: state(f", {letters(size)}: 1")),
    "long_type": (64_000, lambda size: state("").replace("ScriptedState", letters(size))),
    "long_script_name": (64_000, lambda size: f"{HEAD}states:\n- A: {{script: {letters(size)}}}\n"),
    "long_look_up": (64_000, lambda size: state(f", x: [[{letters(size)}]]", "params: {a: 1}\n")),
    "long_key_type": (
        64_000,
        lambda size: state(f", input_keys: {{a: {letters(size)}}}", "userdata: {a: 1}\n"),
    ),
    "long_digits": (64_000, lambda size: state("", f"userdata: {{a: {'7' * size}}}\n")),
    "long_underscores": (
        64_000,
        lambda size: state("").replace("ok: done", f"ok: {'a_' * (size // 2)}"),
    ),
    "long_property_event": (
        64_000,
        lambda size: state("", f"properties: [at_most: {{{letters(size)}: 3}}]\n"),
    ),
    "long_code": (
        64_000,
        lambda size: state(", callbacks: {ok: 'lambda ud: ud." + letters(size) + "'}").replace(
            "ScriptedState", "ConditionalOutcomeState"
        ),
    ),
    "wrong_targets": (10_000, lambda size: chain(size).replace("ok: S", "ok: T")),
    "slips_of_targets": (10_000, lambda size: chain(size).replace("ok: S", "ok: SS")),
    "wrong_outcomes": (
        10_000,
        lambda size: chain(size).replace("transitions: {ok:", "transitions: {kko:"),
    ),
    "wrong_types": (10_000, lambda size: chain(size).replace("ScriptedState", "SkriptedStat")),
    "wrong_keys": (
        10_000,
        lambda size: chain(size, ", input_keys: [part_%(n)d]").replace(
            "states:", "userdata: {prat: 1}\nstates:", 1
        ),
    ),
    "wrong_remappings": (
        10_000,
        lambda size: chain(size, ", input_keys: [a], remapping: {b%(n)d: c%(n)d}"),
    ),
    "wrong_look_ups": (
        10_000,
        lambda size: chain(size, ", x: [[speed_%(n)d]]").replace(
            "states:", "params: {sped: 1}\nstates:", 1
        ),
    ),
    "wrong_code": (10_000, lambda size: chain(size, ", x: '`undefined_%(n)d(1)`'")),
    "equal_names": (10_000, lambda size: chain(size).replace("- S", "- T").replace("T1", "T")),
    "unknown_fields": (
        30_000,
        lambda size: (
            HEAD + "states:\n- A: {template: SleepState, " + words("x%(n)d: 1", size) + "}\n"
        ),
    ),
    "unknown_fields_of_machine": (
        30_000,
        lambda size: chain(2) + words("x%(n)d: 1", size).replace(", ", "\n") + "\n",
    ),
    "outcomes": (
        20_000,
        lambda size: (
            f"{HEAD}states:\n- A: {{template: ScriptedState,"
            f" outcomes: [{words('o%(n)d', size)}]}}\n"
        ),
    ),
    "outcomes_with_transitions": (
        20_000,
        lambda size: (
            f"{HEAD}states:\n- A: {{template: ScriptedState, outcomes: [{words('o%(n)d', size)}],"
            f" transitions: {{{words('o%(n)d: done', size)}}}}}\n"
        ),
    ),
    "machine_outcomes": (
        20_000,
        lambda size: chain(2).replace("[done]", f"[done, {words('o%(n)d', size)}]"),
    ),
    "transitions": (
        20_000,
        lambda size: state("").replace(
            "{ok: done}", f"{{ok: done, {words('o%(n)d: done', size)}}}"
        ),
    ),
    "equal_outcomes": (20_000, lambda size: state("").replace("[ok]", f"[{words('ok', size)}]")),
    "duplicate_fields": (
        20_000,
        lambda size: (
            HEAD + "states:\n- A: {template: SleepState, " + words("x: %(n)d", size) + "}\n"
        ),
    ),
    "userdata": (20_000, lambda size: state("", f"userdata: {{{words('k%(n)d: 1', size)}}}\n")),
    "unset_keys": (
        20_000,
        lambda size: state(f", input_keys: [{words('k%(n)d', size)}]", "userdata: {a: 1}\n"),
    ),
    "remapping": (
        20_000,
        lambda size: state(
            f", input_keys: [{words('k%(n)d', size)}], remapping: {{{words('k%(n)d: a', size)}}}",
            "userdata: {a: 1}\n",
        ),
    ),
    "tags": (20_000, lambda size: state(f", tags: [{words('t%(n)d', size)}]")),
    "claims": (20_000, lambda size: state(f", claims: [{words('t%(n)d', size)}]")),
    "params": (20_000, lambda size: state("", f"params: {{{words('p%(n)d: 1', size)}}}\n")),
    "params_of_params": (
        20_000,
        lambda size: state("", f"params: {{p: 1, {words('p%(n)d: [[p]]', size)}}}\n"),
    ),
    "properties": (
        3_000,
        lambda size: state("", f"properties: [{words('at_most: {A: %(n)d}', size)}]\n"),
    ),
    "properties_of_wrong_states": (
        3_000,
        lambda size: state("", f"properties: [{words('at_most: {B%(n)d: 1}', size)}]\n"),
    ),
    "claims_of_states": (10_000, lambda size: chain(size, ", claims: [arm.c%(n)d]")),
    "types": (20_000, lambda size: state("", f"types: {{{words('T%(n)d: int', size)}}}\n")),
    "types_of_types": (
        5_000,
        lambda size: state("", f"types: {{T: int, T0: T, {words('U%(n)d: list[T0]', size)}}}\n"),
    ),
    "nested_brackets": (
        3_000,
        lambda size: state("", f"userdata: {{a: {'[' * size}{']' * size}}}\n"),
    ),
    "long_text": (4_500_000, lambda size: state("", f"doc: {'a ' * (size // 2)}\n")),
    "deep_expression": (400, lambda size: state(f", x: '`{'(' * size}1{')' * size}`'")),
    "long_expression": (20_000, lambda size: state(f", x: '`[{words('%(n)d + 1', size)}]`'")),
    "long_sum": (5_000, lambda size: state(f", x: '`{' + '.join(['1'] * size)}`'")),
    "comments": (100_000, lambda size: chain(2) + "# a comment\n" * size),
    "allowances": (20_000, lambda size: chain(2) + "# smachac: allow SM201 because\n" * size),
    "allowances_of_wrong_codes": (
        20_000,
        lambda size: chain(2) + "# smachac: allow SM9999 because\n" * size,
    ),
    "aliases": (
        10_000,
        lambda size: state("", f"userdata: {{a: &a [1], b: [{words('*a', size)}]}}\n"),
    ),
    "anchors": (20_000, lambda size: state("", f"userdata: {{a: [{words('&a%(n)d 1', size)}]}}\n")),
    "syntax_errors": (20_000, lambda size: HEAD + "states:\n" + "- A: {a: [1}\n" * size),
    "tabs": (20_000, lambda size: HEAD + "states:\n" + "\t- A:\n" * size),
    "unclosed_brackets": (20_000, lambda size: HEAD + "states:\n" + "- [\n" * size),
    "unclosed_quotes": (20_000, lambda size: HEAD + "states:\n" + '- "a\n' * size),
    "colons": (500_000, lambda size: HEAD + "states: " + "a: " * size + "\n"),
    "wrong_indents": (
        20_000,
        lambda size: (
            HEAD + "states:\n" + "".join(f" {' ' * (n % 5)}- A{n}:\n" for n in range(size))
        ),
    ),
    "fields_without_colon": (
        20_000,
        lambda size: HEAD + "states:\n" + "- A\n    template SleepState\n" * size,
    ),
    "fields_outside_of_states": (
        20_000,
        lambda size: (
            HEAD
            + "states:\n"
            + "".join(f"- A{n}:\n- template: SleepState\n- time: 1\n" for n in range(size))
        ),
    ),
}
"""The inputs of `check` that are one text: their first sizes, and the text of a size."""

COMMANDS: Mapping[str, tuple[int, str, str]] = {
    "fmt_nested_brackets": (3_000, "nested_brackets", "fmt main.yml"),
    "fmt_long_line": (4_500_000, "long_text", "fmt main.yml"),
    "fmt_comments": (100_000, "comments", "fmt main.yml"),
    "fmt_unknown_fields": (20_000, "unknown_fields", "fmt main.yml"),
    "fmt_outcomes": (20_000, "outcomes", "fmt main.yml"),
    "fmt_shorthand": (20_000, "params_of_params", "fmt main.yml --shorthand"),
    "build_outcomes": (
        20_000,
        "outcomes_with_transitions",
        "build main.yml --target python -o out",
    ),
    "build_cpp_outcomes": (
        20_000,
        "outcomes_with_transitions",
        "build main.yml --target cpp -o out",
    ),
    "rename_outcome_of_many": (
        20_000,
        "outcomes_with_transitions",
        "rename main.yml A/o1 p1 --diff",
    ),
}
"""Other commands over such texts: their first sizes, the name of the text, the arguments."""


def text_of(title: str, size: int) -> str:
    """The text of an input of SCRIPTS."""
    return SCRIPTS[title][1](size)


def run_over(title: str, arguments: str, folder: Path, size: int) -> list[str]:
    """A command over the text of an input of SCRIPTS."""
    check(folder, text_of(title, size))
    return arguments.split()


for title, (first, _) in SCRIPTS.items():
    INPUTS[title] = (first, partial(run_over, title, "check main.yml"))
for title, (first, script, arguments) in COMMANDS.items():
    INPUTS[title] = (first, partial(run_over, script, arguments))


# Names


@hostile(64_000)
def long_wrong_outcome(folder: Path, size: int) -> list[str]:
    name = letters(size)
    return check(
        folder,
        f"{HEAD}states:\n- A: {{template: SleepState, time: 1, transitions: {{{name}: done}}}}\n",
    )


@hostile(64_000)
def long_frame(folder: Path, size: int) -> list[str]:
    text = state("", f"robot: panda\nuserdata: {{frame_id: {letters(size)}}}\n")
    return check(folder, text)


@hostile(64_000)
def long_command_word(folder: Path, size: int) -> list[str]:
    check(folder, chain(3))
    return ["rename", "main.yml", letters(size), "B"]


# Wrong references


@hostile(10_000)
def wrong_targets_json(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ok: S", "ok: T"), "--format", "json")


@hostile(10_000)
def wrong_targets_sarif(folder: Path, size: int) -> list[str]:
    return check(folder, chain(size).replace("ok: S", "ok: T"), "--format", "sarif")


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
def different_wrong_types(folder: Path, size: int) -> list[str]:
    text = [HEAD + "states:"]
    text += [f"- S{number}: {{template: Scrip{number}}}" for number in range(size)]
    return check(folder, "\n".join(text) + "\n")


@hostile(10_000)
def wrong_scripts(folder: Path, size: int) -> list[str]:
    text = [HEAD + "states:"]
    text += [f"- S{number}: {{script: pick_{number}}}" for number in range(size)]
    return check(folder, "\n".join(text) + "\n")


# Lists


@hostile(20_000)
def input_keys(folder: Path, size: int) -> list[str]:
    keys = words("k%(n)d", size)
    return check(folder, state(f", input_keys: [{keys}]", f"input_keys: [{keys}]\n"))


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


@hostile(5_000)
def callbacks(folder: Path, size: int) -> list[str]:
    called = words("o%(n)d: lambda ud: ud.a < %(n)d", size)
    text = state(
        f", callbacks: {{{called}}}, input_keys: [a], default_outcome: ok",
        "userdata: {a: 1}\n",
    )
    return check(folder, text.replace("ScriptedState", "ConditionalOutcomeState"))


@hostile(10_000)
def property_of_many_events(folder: Path, size: int) -> list[str]:
    events = words("S%(n)d", size)
    return check(
        folder,
        chain(size).replace("states:", f"properties: [after: {{S0: [{events}]}}]\nstates:", 1),
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


# fmt


@hostile(3_000)
def fmt_nested_blocks(folder: Path, size: int) -> list[str]:
    nested_blocks(folder, size)
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
def fmt_empty_lines(folder: Path, size: int) -> list[str]:
    check(folder, chain(2) + " \n" * size + "forever: false\n")
    return ["fmt", "main.yml"]


@hostile(2_000)
def fmt_states(folder: Path, size: int) -> list[str]:
    check(folder, chain(size))
    return ["fmt", "main.yml"]


# Other commands


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
    check(folder, text_of("outcomes_with_transitions", size))
    text = (folder / "main.yml").read_text()
    (folder / "new.yml").write_text(text.replace("o", "p").replace("ppdape", "x"))
    return ["diff", "main.yml", "new.yml"]


@hostile(20_000)
def diff_userdata(folder: Path, size: int) -> list[str]:
    check(folder, text_of("userdata", size))
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

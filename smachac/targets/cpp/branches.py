"""Concurrences: a thread for each state, then the rules over their outcomes."""

from __future__ import annotations

from smachac.ir.nodes import Concurrence, OutcomeRule
from smachac.targets.cpp.inside import (
    CAUGHT,
    Inside,
    Lines,
    all_results,
    case,
    caught_switch,
    guarded,
    indented,
    results,
    switch,
)
from smachac.targets.cpp.types import cpp_literal
from smachac.targets.cpp.words import identifier


def concurrence(inside: Inside) -> Lines:
    """The body of the function of a concurrence."""
    node = inside.node
    assert isinstance(node, Concurrence)
    fields: Lines = []
    cases: Lines = []
    caught: Lines = []
    for child in node.children:
        type_ = inside.outcome(child, "x").rpartition("::")[0]
        fields.append(
            f"  {f'std::optional<{type_}>' if child.catches else type_} {identifier(child.name)};"
        )
        ways: Lines = []
        for name in results(child):
            ways.append(f"case {inside.outcome(child, name)}:")
            ways += [f"  run.exit(places, state, {cpp_literal(name)});", "  return;"]
        cases += case(inside, child, ways, f"ended.{identifier(child.name)}")
        if child.catches:
            exit_ = f"run.exit(places, state, {cpp_literal(child.catches)});"
            caught += [
                f"case State::{identifier(child.name)}:",
                f"  {CAUGHT}",
                f"  {exit_}",
                "  break;",
            ]
    return [
        "struct {",
        *fields,
        "} ended{};",
        f"smachac::Branches<Run, {len(node.children)}> branches(around, places);",
        f"branches.run({str(node.join == 'any').lower()}, [&](std::size_t branch, Run &run) {{",
        "  const auto state = static_cast<State>(branch);",
        *indented(guarded([line[2:] for line in switch(cases)], caught_switch(caught))),
        "});",
        *_rules(inside, node),
    ]


def _rules(inside: Inside, node: Concurrence) -> Lines:
    """Rules with more conditions first, of as many the last listed first (smach-semantics N5)."""
    children = {child.name: child for child in node.children}

    def order(item: tuple[int, OutcomeRule]) -> tuple[int, int]:
        return -len(item[1].when), -item[0]

    lines: Lines = []
    for _, rule in sorted(enumerate(node.rules), key=order):
        tests = []
        for one in rule.when:
            child = children.get(one.child)
            if child is None or one.outcome not in all_results(child):
                break
            how = inside.outcome(child, one.outcome)
            how = "std::nullopt" if one.outcome == child.catches else how
            tests.append(f"ended.{identifier(one.child)} == {how}")
        else:
            end = f"return {inside.ends(rule.outcome)};"
            if not tests:
                return [*lines, end]
            lines += [*_test(tests), f"  {end}", "}"]
    return [*lines, f"return {inside.ends(node.default_outcome)};"]


def _test(tests: Lines) -> Lines:
    """The head of an `if` over several tests, one a line."""
    starts = ["if (", *["    "] * (len(tests) - 1)]
    ends = [*[" &&"] * (len(tests) - 1), ") {"]
    return [start + test + end for start, test, end in zip(starts, tests, ends, strict=True)]

"""The rules over the state graph: each is one function; `RULES` lists them all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby

from smachac.analysis.context import Context
from smachac.checks.classes import class_code, interfaces, template_blocks, unusable_code
from smachac.checks.code import callables, expressions, undefined_names
from smachac.checks.concurrence import concurrence, races
from smachac.checks.names import names
from smachac.checks.outcomes import failures, outcomes, reachability
from smachac.checks.properties import properties
from smachac.checks.robot import bodies, grip, motion, open_grip, robot, values, workspace
from smachac.checks.ros import message_fields
from smachac.checks.rule import Rule
from smachac.checks.timing import loops, stops, timeouts
from smachac.checks.types import types
from smachac.checks.userdata import (
    declarations,
    initial_values,
    stale_keys,
    stores,
    undeclared_keys,
    unwritten_outputs,
    userdata,
)
from smachac.diagnostics.diagnostic import Diagnostic, Finding, Report, diagnostic
from smachac.ir.nodes import Machine
from smachac.ir.script_paths import PlainPaths, steps_in_script

MACHINE_RULES: tuple[Rule, ...] = (
    expressions.bad_expression,
    names.unknown_target,
    names.unknown_outcome,
    outcomes.undeclared_container_outcome,
    outcomes.unhandled_outcome,
    outcomes.implicit_exit,
    names.duplicate_state,
    names.name_clash,
    names.shadowed_name,
    reachability.unreachable_state,
    loops.trap,
    reachability.impossible_outcome,
    loops.unbounded_loop,
    reachability.no_initial,
    failures.unhandled_failure,
    timeouts.no_timeout,
    timeouts.no_way_to_stop,
    stops.ignored_stop,
    stops.stop_as_success,
    stops.task_after_stop,
    timeouts.short_time_limit,
    loops.unchanging_condition,
    userdata.read_before_write,
    userdata.unknown_remap,
    userdata.undeclared_container_key,
    types.type_mismatch,
    declarations.dead_key,
    declarations.unused_declaration,
    userdata.lost_output,
    undeclared_keys.lossy_write,
    class_code.undeclared_return,
    undeclared_keys.undeclared_access,
    expressions.impossible_operation,
    expressions.constant_comparison,
    initial_values.overruled_value,
    unwritten_outputs.unwritten_output,
    class_code.never_returned,
    callables.not_a_function,
    callables.wrong_arguments,
    callables.wrong_result,
    stale_keys.stale_key,
    stores.dead_store,
    initial_values.secret_in_script,
    concurrence.uncovered_combination,
    concurrence.overlapping_rules,
    concurrence.dead_rule,
    failures.masked_failure,
    races.data_race,
    races.resource_clash,
    timeouts.never_ends,
    concurrence.empty_concurrence,
    robot.wrong_length,
    robot.joint_limit,
    robot.not_a_rotation,
    robot.unit_mismatch,
    robot.unknown_frame,
    motion.too_fast,
    motion.wrong_frame,
    message_fields.unknown_field,
    grip.closed_gripper,
    bodies.body_loaded_twice,
    message_fields.untyped_message,
    open_grip.open_gripper,
    values.out_of_limits,
    values.unknown_name,
    values.doubtful_unit,
    properties.property_fails,
    properties.property_vacuous,
    properties.unknown_event,
    properties.property_undecided,
)
"""The rules that need the machine alone, in the order of their codes."""

CODE_RULES: tuple[Rule, ...] = (
    interfaces.interfaces_differ,
    interfaces.stale_code,
    template_blocks.unprinted_parts,
    unusable_code.code_not_found,
    unusable_code.unusable_class,
)
"""The rules about the code of state types, in the order of their codes. A build runs them too."""

RULES = (*MACHINE_RULES, *CODE_RULES, undefined_names.undefined_name)
"""All rules. Those that need the code of the project (`Context.project`) come last: a report lists
the files in the order of their first finding."""

PROBLEMS = workspace.PROBLEMS


def check_machine(
    machine: Machine, rules: tuple[Rule, ...] = RULES, context: Context | None = None
) -> Report:
    """The findings of all rules over a machine, in the order of the rules. `context`: the context
    of the machine, for a caller that keeps the facts which the rules need."""
    context = context or Context(machine)
    found: Report = []
    for about_code, some in groupby(rules, CODE_RULES.__contains__):
        part = _diagnostics(context, some)
        found += _in_order_of_use(part, context) if about_code else part
    return found


def _in_order_of_use(found: Iterable[Diagnostic], context: Context) -> Report:
    """The findings about code, those in the file of the first state first: a report lists the files
    in the order of their first finding."""
    ranks = {file: rank for rank, file in enumerate(context.code_facts.files)}
    return sorted(found, key=lambda item: ranks.get(item.span.source, len(ranks)))


def _diagnostics(context: Context, rules: Iterable[Rule]) -> Iterator[Diagnostic]:
    for rule in rules:
        for finding in rule.function(context):
            plain = context.plain_paths
            shown = steps_in_script(plain, finding.path)
            spans = context.spans if shown else {}
            places = tuple(spans.get(finding.path[at].node or "") for at, _ in shown)
            if plain and (finding.path or finding.node in plain):
                finding = _in_script(plain, finding, shown)
            yield diagnostic(rule.code, finding, places)


def _in_script(plain: PlainPaths, finding: Finding, shown: list[tuple[int, str]]) -> Finding:
    """A finding with the paths of the script. `shown`: the steps of its witness path."""
    path = []
    for at, label in shown:
        step = finding.path[at]
        path.append(replace(step, label=label, node=plain.get(step.node or "", step.node)))
    return replace(finding, node=plain.get(finding.node or "", finding.node), path=tuple(path))

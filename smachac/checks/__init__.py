"""The rules over the state graph: each is one function; `rules` returns them.

The modules of rules are imported where a machine has their subject: a check of ten states would
take a quarter longer with all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import groupby
from typing import TypeAlias

from smachac.analysis.context import Context
from smachac.checks import subjects
from smachac.checks.rule import Rule
from smachac.diagnostics.diagnostic import Diagnostic, Finding, Problem, Report, diagnostic
from smachac.ir.nodes import Machine
from smachac.ir.script_paths import PlainPaths, steps_in_script
from smachac.records import replace

Rules: TypeAlias = tuple[Rule, ...]


def _control_flow() -> Rules:
    from smachac.checks.names import names
    from smachac.checks.outcomes import failures, outcomes, reachability
    from smachac.checks.robot import values
    from smachac.checks.timing import loops, stops, timeouts
    from smachac.checks.types import types

    return (
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
        types.type_mismatch,
        failures.masked_failure,
        timeouts.never_ends,
        values.out_of_limits,
        values.doubtful_unit,
    )


def _code() -> Rules:
    from smachac.checks.code import callables, expressions
    from smachac.checks.robot import values

    return (
        expressions.bad_expression,
        expressions.impossible_operation,
        expressions.constant_comparison,
        callables.not_a_function,
        callables.wrong_arguments,
        callables.wrong_result,
        values.unknown_name,
    )


def _userdata() -> Rules:
    from smachac.checks.userdata import (
        declarations,
        initial_values,
        stale_keys,
        stores,
        undeclared_keys,
        userdata,
    )

    return (
        userdata.read_before_write,
        userdata.unknown_remap,
        userdata.undeclared_container_key,
        declarations.dead_key,
        declarations.unused_declaration,
        userdata.lost_output,
        undeclared_keys.lossy_write,
        undeclared_keys.undeclared_access,
        initial_values.overruled_value,
        stale_keys.stale_key,
        stores.dead_store,
        initial_values.secret_in_script,
    )


def _classes() -> Rules:
    from smachac.checks.classes import class_code
    from smachac.checks.userdata import unwritten_outputs

    return (
        class_code.undeclared_return,
        unwritten_outputs.unwritten_output,
        class_code.never_returned,
    )


def _branches() -> Rules:
    from smachac.checks.concurrence import concurrence, races

    return (
        concurrence.uncovered_combination,
        concurrence.overlapping_rules,
        concurrence.dead_rule,
        races.data_race,
        races.resource_clash,
        concurrence.empty_concurrence,
    )


def _robots() -> Rules:
    from smachac.checks.robot import bodies, grip, motion, open_grip, robot

    return (
        robot.wrong_length,
        robot.joint_limit,
        robot.not_a_rotation,
        robot.unit_mismatch,
        robot.unknown_frame,
        motion.too_fast,
        motion.wrong_frame,
        grip.closed_gripper,
        bodies.body_loaded_twice,
        open_grip.open_gripper,
    )


def _messages() -> Rules:
    from smachac.checks.ros import message_fields

    return (message_fields.unknown_field, message_fields.untyped_message)


def _properties() -> Rules:
    from smachac.checks.properties import properties

    return (
        properties.property_fails,
        properties.property_vacuous,
        properties.unknown_event,
        properties.property_undecided,
    )


def _user_code() -> Rules:
    from smachac.checks.classes import interfaces, template_blocks, unusable_code

    return (
        interfaces.interfaces_differ,
        interfaces.stale_code,
        template_blocks.unprinted_parts,
        unusable_code.code_not_found,
        unusable_code.unusable_class,
    )


def _undefined_names() -> Rules:
    from smachac.checks.code import undefined_names

    return (undefined_names.undefined_name,)


Subject: TypeAlias = Callable[[Context], bool]
"""Whether a machine has what a group of rules is about."""

MACHINE_RULES: tuple[tuple[Subject, Callable[[], Rules]], ...] = (
    (subjects.every_machine, _control_flow),
    (subjects.texts, _code),
    (subjects.userdata, _userdata),
    (subjects.classes, _classes),
    (subjects.branches, _branches),
    (subjects.robots, _robots),
    (subjects.messages, _messages),
    (subjects.properties, _properties),
)
"""The groups of rules that need the machine alone, each with its subject."""


def rules(context: Context | None = None) -> Rules:
    """All rules; with a context, those that can find something in its machine.

    Those over the machine are first, in the order of their codes. Those that need the code of the
    project (`Context.project`) come last: a report lists the files in the order of their first
    finding.
    """
    machine = [
        rule
        for subject, group in MACHINE_RULES
        if context is None or subject(context)
        for rule in group()
    ]
    machine.sort(key=lambda rule: rule.code.code)
    code = code_rules() if context is None or subjects.user_code(context) else ()
    names = _undefined_names() if context is None or subjects.texts(context) else ()
    return (*machine, *code, *names)


def code_rules() -> Rules:
    """The rules about the code of state types, in the order of their codes. A build runs them
    too."""
    return _user_code()


def problems() -> tuple[Problem[...], ...]:
    """The problems that rules report beside their own codes."""
    from smachac.checks.robot import workspace

    return workspace.PROBLEMS


def check_machine(
    machine: Machine, some: Rules | None = None, context: Context | None = None
) -> Report:
    """The findings over a machine, in the order of the rules: of all rules, or of `some`.
    `context`: the context of the machine, for a caller that keeps the facts which the rules
    need."""
    context = context or Context(machine)
    found: Report = []
    some = rules(context) if some is None else some
    for about_code, group in groupby(some, lambda rule: rule.about_code):
        part = _diagnostics(context, group)
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

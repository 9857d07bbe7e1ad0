"""The pipeline: text to tree to script to machine to judgement to files."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TypeAlias

from smachac import checks
from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Code, Diagnostic, Report, has_errors, in_order
from smachac.diagnostics.severities import apply_severities
from smachac.diagnostics.source import Source, Word
from smachac.frontend.errors import references, suppressions
from smachac.frontend.errors import script as script_errors
from smachac.frontend.errors.suppressions import unused_allowances
from smachac.frontend.loader import Library
from smachac.frontend.lower import lower
from smachac.frontend.resolve import resolve
from smachac.frontend.suppressions import Allowance, allowances, heeded
from smachac.ir.nodes import Checked, Machine
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import remapping
from smachac.targets import BuildContext, Files, Target, errors, load_target
from smachac.targets.interface_check import code_faults, target_faults
from smachac.targets.undefined_names import undefined_names

Folders: TypeAlias = "Sequence[str | PathLike[str]]"

_PROBLEMS = (
    *script_errors.PROBLEMS,
    *references.PROBLEMS,
    *suppressions.PROBLEMS,
    *checks.PROBLEMS,
    *errors.PROBLEMS,
)

CODES: Mapping[str, Code] = {
    code.code: code
    for code in sorted(
        [*(each.code for each in _PROBLEMS), *(each.code for each in checks.RULES)],
        key=lambda code: code.code,
    )
}
"""All codes, those of problems and those of rules, in order."""


def analyse_file(
    path: str | PathLike[str], scripts: Folders, templates: Folders
) -> tuple[Analysis, Library | None]:
    """The script at `path`, read and judged; and the library it was read with."""
    from pathlib import Path

    from smachac.frontend.files import disk_library, read_source

    report: Report = []
    source = read_source(Path(path), report)
    if source is None:
        return Analysis(report=report), None
    folders = [[Path(folder) for folder in each] for each in (scripts, templates)]
    library = disk_library(
        Path(path), report, scripts=folders[0], templates=folders[1], codes=CODES
    )
    return analyse(source, library, report), library


def load(source: Source, library: Library, report: Report) -> Machine | None:
    """The machine a script describes, as far as it can be read."""
    tree = library.parse(source, report)
    script = resolve(source, tree, library, report)
    return None if script is None else lower(script)


def check(machine: Machine, report: Report) -> Checked | None:
    """Judge a machine by every rule; the machine again, if neither they nor `report` object."""
    report.extend(check_machine(machine))
    return None if has_errors(report) else Checked(machine)


@dataclass(frozen=True, slots=True, kw_only=True)
class Analysis:
    """What there is to say about a script: its machine as far as it could be read, the machine
    again if it is without error, and every finding in order, but for those that are allowed.

    `unused` are the allowances of sub-scripts that were of no use to this script; `given`, all.
    """

    machine: Machine | None = None
    checked: Checked | None = None
    report: Report
    given: tuple[Allowance, ...] = ()
    unused: tuple[Allowance, ...] = ()


Judge = Callable[[Machine], Iterable[Diagnostic]]
"""A judgement that is not made of every machine, because it takes long or needs more than us."""


def analyse(
    source: Source, library: Library, report: Report, more: Judge | None = None
) -> Analysis:
    """Read a script and judge it by every rule, and by `more`; findings already in `report` count
    as well."""
    with deep_recursion():
        tree = library.parse(source, report)
        script = resolve(source, tree, library, report)
        machine = lower(script) if script is not None else None
        if machine is not None:
            report.extend(check_machine(machine))
            report.extend(code_faults(machine, library, load_target))
            report.extend(undefined_names(machine, library))
            report.extend(more(machine) if more is not None else ())
        sources = {id(text): text for text in (script.sources if script is not None else (source,))}
        sources |= {id(item.span.source): item.span.source for item in report}
        given = [
            fit
            for text in sources.values()
            for fit in allowances(text, report, CODES, library.parse)
        ]
        found, used = heeded(report, given)
        unused = [fit for fit in given if fit not in used]
        found += unused_allowances(
            Word(fit.code, fit.span) for fit in unused if fit.span.source is source
        )
        found = apply_severities(in_order(found), library.policy)
    return Analysis(
        machine=machine,
        checked=Checked(machine) if machine is not None and not has_errors(found) else None,
        report=found,
        given=tuple(given),
        unused=tuple(fit for fit in unused if fit.span.source is not source),
    )


def analyse_alone(source: Source, library: Library, report: Report) -> Analysis:
    """A sub-script that nobody calls, judged as far as that goes without its caller.

    It is called by a script made for it, which takes in the keys it needs and ends with its
    outcomes. Params come from callers, so look-ups that find nothing are passed over, as are names:
    their base may define them.
    """
    name = f"{source.name} (alone)"

    def called(outcomes: Iterable[str], inputs: Iterable[str], outputs: Iterable[str]) -> Source:
        ends = list(outcomes)
        script = {
            "name": "alone",
            "template": "Base",
            "outcomes": ends or ["done"],
            "forever": not ends,
            "input_keys": list(inputs),
            "output_keys": list(outputs),
            "states": [{"CALL": {"script": "called", "transitions": {end: end for end in ends}}}],
        }
        return Source(name, json.dumps(script, ensure_ascii=False))

    def script(word: str, by: str) -> Source | None:
        return source if by == name else library.script(word, by)

    own = replace(library, script=script)
    with deep_recursion():
        machine = load(called((), (), ()), own, [])
    if machine is None or not machine.root.children:
        outside = called((), (), ())
    else:
        state = machine.root.children[0]
        outer = remapping(state)
        keys = (
            [outer.get(key.name, key.name) for key in part]
            for part in (state.inputs, state.outputs)
        )
        outside = called([outcome.name for outcome in state.outcomes], *keys)
    found = analyse(outside, own, report)
    return replace(found, report=list(_inside(found.report, outside)), machine=None, checked=None)


def _inside(report: Report, outside: Source) -> Iterator[Diagnostic]:
    """The findings that do not speak of the script made around."""
    for item in report:
        if item.span.source is outside or item.code.code in ("SM015", "SM019"):
            continue
        finding = item.finding
        related = tuple(each for each in finding.related if each.span.source is not outside)
        yield replace(item, finding=replace(finding, related=related))


def build(
    machine: Checked,
    target: Target,
    library: Library,
    report: Report,
    options: Mapping[str, str] | None = None,
) -> Files:
    """The files a target prints; none if templates or classes of the user are at fault."""
    context = BuildContext(library=library, options=options or {})
    with deep_recursion():
        found = [*target_faults(machine, library, target)]
        files = target.emit(machine, context, found)
    report.extend(in_order(found))
    return {} if has_errors(report) else files


def together(report: Report, built: Report) -> Report:
    """What was found in a script and then in building it; a fault that both name is the latter's,
    which knows how bad it is."""
    said = {(item.code, item.finding.message, item.span) for item in built}
    return [*(i for i in report if (i.code, i.finding.message, i.span) not in said), *built]

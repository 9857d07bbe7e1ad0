"""The pipeline: read, parse, resolve, lower, check, suppress, emit.

Every command and the public API pass through these functions. Only this module makes a `Checked`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, cached_property
from os import PathLike
from pathlib import Path
from typing import NamedTuple, TypeAlias

from smachac.analysis.context import Context
from smachac.checks import check_machine, code_rules
from smachac.diagnostics.diagnostic import (
    Code,
    Diagnostic,
    Report,
    Severity,
    grouped,
    has_errors,
    in_order,
)
from smachac.diagnostics.severities import apply_severities
from smachac.diagnostics.source import Source, Span
from smachac.frontend.discovery import PYTHON_SUFFIX
from smachac.frontend.errors import script as script_errors
from smachac.frontend.files import disk_library, read_source
from smachac.frontend.loader import Library
from smachac.frontend.resolved_script import Script
from smachac.frontend.script.lower import NodeCache, lower
from smachac.frontend.script.resolve import refuse_python, resolve
from smachac.frontend.script.resolve_cache import ResolveCache
from smachac.frontend.text.suppressions import Suppression, suppress
from smachac.ir.nodes import Checked, Machine, StateType
from smachac.ir.recursion import deep_recursion
from smachac.pysource.modules.ros_names import ROS_VERSIONS
from smachac.pysource.modules.user_code import Declared, ProjectCode
from smachac.records import dataclass, field, replace
from smachac.targets import BuildContext, Files, Target, load_target

TYPE_CHECKING = False  # annotations only: a check of scripts reads no machines in Python
if TYPE_CHECKING:
    from smachac.pysource.machines.coverage import Coverage

Folders: TypeAlias = "Sequence[str | PathLike[str]]"


class _Codes(Mapping[str, Code]):
    """The codes of problems and of rules, collected at their first use: that imports all rules."""

    def __getitem__(self, code: str) -> Code:
        return self._known[code]

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    @cached_property
    def _known(self) -> dict[str, Code]:
        from smachac.checks import problems, rules
        from smachac.frontend.errors import python_machines, references, suppressions
        from smachac.targets import errors

        declared = (
            *script_errors.PROBLEMS,
            *references.PROBLEMS,
            *suppressions.PROBLEMS,
            *problems(),
            *errors.PROBLEMS,
            *python_machines.PROBLEMS,
        )
        codes = [*(problem.code for problem in declared), *(rule.code for rule in rules())]
        return {code.code: code for code in sorted(codes, key=lambda code: code.code)}


CODES: Mapping[str, Code] = _Codes()
"""All codes, those of problems and those of rules, in order."""

OF_CLASSES = ("SM608", "SM609")
"""The codes of faults for which a check reports an error and only a build for the language of the
class fails: other targets do not need the class."""

TEMPLATE_CODES = ("SM605", "SM606", "SM607")
"""The codes of findings in templates of the user, which exist only once they are rendered."""

MachineCheck: TypeAlias = "Callable[[Machine], Iterable[Diagnostic]]"
"""A check that runs on request only, because it is slow or needs more than the compiler."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Analysis:
    """The result of the pipeline up to the checks: the machine and all findings, in order.

    `script` is the name of the text, `source` the text. `machine` is the machine as far as it could
    be read; `checked` is the same machine if the report has no error. `library` is None if there is
    no text. `given` holds the suppressions of all texts of the script, `unused` those in
    sub-scripts that suppressed nothing. `alone`: the text is a sub-script that was analysed without
    a caller. `coverage`: how much of the machines of a Python file is known; None for a script, and
    for a file that cannot be read.
    """

    script: str = ""
    source: Source | None = None
    machine: Machine | None = None
    checked: Checked | None = None
    report: Report
    library: Library | None = None
    given: tuple[Suppression, ...] = ()
    unused: tuple[Suppression, ...] = ()
    alone: bool = False
    coverage: Coverage | None = None


@dataclass(slots=True)
class IncrementalState:
    """The results of the last analysis of a script that the next one can use, after some texts have
    changed. Whoever checks a script again owns one: a language server, `check --watch`."""

    kept: ResolveCache = field(default_factory=ResolveCache)
    nodes: NodeCache = field(default_factory=dict)
    context: Context | None = None


def analyse_script(
    script: str | PathLike[str] | Source,
    scripts: Folders = (),
    templates: Folders = (),
    *,
    render: bool = False,
) -> Analysis:
    """Read a script, given as a path or as a text, and analyse it.

    Its sub-scripts, templates and settings are read from disk, beside the path or the name of the
    text; `scripts` and `templates` are more folders. `render`: see `analyse`.
    """
    report: Report = []
    source = script if isinstance(script, Source) else read_source(Path(script), report)
    if source is None:
        return Analysis(report=report)
    folders = [[Path(folder) for folder in paths] for paths in (scripts, templates)]
    library = disk_library(
        Path(source.name), report, scripts=folders[0], templates=folders[1], codes=CODES
    )
    return analyse(source, library, report, render=render)


def analyse(
    source: Source,
    library: Library,
    report: Report,
    extra: MachineCheck | None = None,
    *,
    render: bool = False,
    previous: IncrementalState | None = None,
) -> Analysis:
    """Parse, resolve, lower and check a script, then apply suppressions and severities.

    Findings that are already in `report` belong to the result as well. `render`: the findings of
    the Python program are reported too, for which the templates of the user are rendered; a build
    does that in any case. `previous` are the results of the last analysis, which become those of
    this one. If there is not enough memory, that is the only finding.
    """
    try:
        return _analysis(source, library, report, extra, previous, render=render)
    except MemoryError:
        pass  # after this clause, the frames of the exception no longer hold the script
    return Analysis(script=source.name, report=[_out_of_memory(source)], library=library)


def _analysis(
    source: Source,
    library: Library,
    report: Report,
    extra: MachineCheck | None,
    previous: IncrementalState | None,
    *,
    render: bool,
) -> Analysis:
    kept = previous.kept if previous is not None else None
    with deep_recursion():
        script = parse_and_resolve(source, library, report, kept)
        nodes = previous.nodes if previous is not None else None
        machine = lower(script, nodes) if script is not None else None
        sources = script.sources if script is not None else (source,)
        del script  # its states take as much memory as the rules need
        context = _context(machine, library, previous)
        if machine is not None and context is not None:
            report.extend(check_machine(machine, context=context))
            report.extend(extra(machine) if extra is not None else ())
            report.extend(version_faults(machine, library) if render else ())
            if render and not has_errors(without_class_errors(report)):
                report.extend(template_faults(machine, library))
        complete = machine is not None
        rest, given, unused = suppress(
            report, source, sources, CODES, library.parse, complete=complete
        )
        found = grouped(apply_severities(in_order(rest), library.policy))
    return Analysis(
        script=source.name,
        source=source,
        machine=machine,
        checked=Checked(machine)
        if machine is not None and not has_errors(without_class_errors(found))
        else None,
        report=found,
        library=library,
        given=given,
        unused=unused,
    )


def _context(
    machine: Machine | None, library: Library, previous: IncrementalState | None
) -> Context | None:
    """The context of a machine, with the facts of the previous one that still hold. It becomes the
    previous context."""
    known = previous.context if previous is not None else None
    load = cache(load_target)

    def declared(language: str, type_: StateType) -> Declared | None:
        target = load(language)
        return target.declared(type_, library) if target is not None else None

    project = ProjectCode(library=library, declared=declared)
    context = Context(machine, known, project) if machine is not None else None
    if previous is not None:
        previous.context = context
    return context


def _out_of_memory(source: Source) -> Diagnostic:
    message = "there is not enough memory for this script"
    help = "split it into several scripts, or raise `--memory-limit`"
    return script_errors.too_big(Span(source, 0, 0), message, help, arguments=("memory",))


def parse_and_resolve(
    source: Source, library: Library, report: Report, kept: ResolveCache | None = None
) -> Script | None:
    """The script of a text, with its sub-scripts and look-ups filled in, as far as it can be
    read. `kept`: see `resolve`."""
    if source.name.endswith(PYTHON_SUFFIX):
        refuse_python(source, report)
        return None
    script = resolve(source, library.parse(source, report), library, report, kept)
    library.release(source)
    return script


def read_machine(source: Source, library: Library, report: Report) -> Machine | None:
    """The machine of a script, as far as it can be read; it is not checked."""
    script = parse_and_resolve(source, library, report)
    return None if script is None else lower(script)


def version_faults(machine: Machine, library: Library) -> Report:
    """What the project's version of ROS does not support, as warnings, because an option of a build
    may choose the other version; and the params that are fixed in a node of ROS 2."""
    from smachac.targets.python.ros import is_node, unsupported

    found = [replace(item, severity=Severity.WARNING) for item in unsupported(machine, library.ros)]
    if not found and machine.params and is_node(machine, library, library.ros):
        from smachac.targets.python.parameters import RESERVED, fixed_uses, ros_parameters

        found += fixed_uses(ros_parameters(machine, RESERVED))
    return found


def template_faults(machine: Machine, library: Library) -> Report:
    """The findings in templates of the user, which are rendered as for the Python program. Code for
    the other version of ROS is a warning, see `version_faults`. States with code for YASMIN or
    FlexBE alone, which these targets build, are classes here."""
    from smachac.pysource.templates.template_sources import uses_own_templates
    from smachac.targets.python import TARGET
    from smachac.targets.python.missing_templates import missing_templates
    from smachac.targets.python.ros import needs_other_version

    if not uses_own_templates(machine, library):
        return [*missing_templates(machine, library)]
    from smachac.targets.native import as_python, native_only

    program = as_python(Checked(machine), native_only(machine))
    found: Report = []
    lacking: Report = []
    for ros in dict.fromkeys((library.ros, *ROS_VERSIONS)):
        found = []
        context = BuildContext(library=library, options={"ros": str(ros)})
        made = TARGET.emit(program, context, found)
        if ros == library.ros:
            lacking = [item for item in found if needs_other_version(item)]
        if made:
            break
    found = [item for item in found if item.code in TEMPLATE_CODES]
    return [*found, *(replace(item, severity=Severity.WARNING) for item in lacking)]


def check(machine: Machine, report: Report) -> Checked | None:
    """Check a machine that has no text, and so neither suppressions nor severities of a project."""
    report.extend(check_machine(machine))
    return None if has_errors(report) else Checked(machine)


def without_class_errors(report: Report) -> Report:
    """The findings, with those of the user's classes as warnings: what does not run the classes,
    such as a scenario, a picture or a program in another language, needs none of them."""
    return [
        replace(item, severity=Severity.WARNING)
        if item.code in OF_CLASSES and item.severity is Severity.ERROR
        else item
        for item in report
    ]


class Compiled(NamedTuple):
    """The files of a target with the runtime files they need, and the findings of the script and
    of the target. There are no files if a finding is an error."""

    files: Files
    report: Report


def compile_script(
    analysis: Analysis,
    target: Target,
    options: Mapping[str, str] | None = None,
    levels: int = 0,
) -> Compiled:
    """Emit the files of a target for an analysed script. `levels`: see BuildContext."""
    from smachac.targets.runtime_files import runtime_files

    if analysis.checked is None or analysis.library is None:
        return Compiled({}, analysis.report)
    found: Report = []
    files = build(
        analysis.checked, target, analysis.library, found, options, levels, analysis.report
    )
    if files:
        context = BuildContext(library=analysis.library, options=options or {}, levels=levels)
        files |= runtime_files(target.runtime(analysis.checked, context))
    return Compiled(files, merged(without_class_errors(analysis.report), found))


def compile_files(
    analysis: Analysis,
    target: Target,
    options: Mapping[str, str] | None = None,
    levels: int = 0,
) -> Compiled:
    """As `compile_script`, for files that are written: none of them hides a module (SM611)."""
    from smachac.targets.hiding_files import hiding_files

    files, report = compile_script(analysis, target, options, levels)
    hiding = list(hiding_files(files, analysis.checked)) if analysis.checked is not None else []
    return Compiled({} if hiding else files, merged(report, hiding))


def build(
    machine: Checked,
    target: Target,
    library: Library,
    report: Report,
    options: Mapping[str, str] | None = None,
    levels: int = 0,
    findings: Sequence[Diagnostic] = (),
) -> Files:
    """The files that a target emits; none if templates or classes of the user have errors.

    `findings` are those of the script, for targets that show them.
    """
    context = BuildContext(library=library, options=options or {}, levels=levels, findings=findings)
    files: Files = {}
    try:
        with deep_recursion():
            found = code_faults(machine, target, library)
            files = target.emit(machine, context, found)
    except MemoryError:
        found = [_out_of_memory(machine.root.span.source)]
    report.extend(in_order(found))
    return {} if has_errors(report) else files


def code_faults(machine: Machine, target: Target, library: Library) -> Report:
    """The faults in the code of state types that a program of a target contains, as errors."""
    project = ProjectCode(
        library=library,
        declared=lambda _, type_: target.declared(type_, library),
        target=target.name,
    )
    return check_machine(machine, code_rules(), Context(machine, project=project))


def draw(
    machine: Machine,
    target: Target,
    library: Library,
    options: Mapping[str, str] | None = None,
    findings: Sequence[Diagnostic] = (),
) -> Files:
    """The picture of a machine that may have errors. `target` is one of pictures; `findings` are
    those of the machine. Raises OptionError."""
    context = BuildContext(library=library, options=options or {}, findings=findings)
    with deep_recursion():
        return target.emit(Checked(machine), context, [])


def merged(report: Report, built: Report) -> Report:
    """The findings of a script, then those of a target. A finding that both have is taken from the
    target, which decides its severity."""
    repeated = {(item.code, item.span, item.finding.arguments) for item in built}
    rest = [i for i in report if (i.code, i.span, i.finding.arguments) not in repeated]
    return [*rest, *built]

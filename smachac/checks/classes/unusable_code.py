"""The code of state types that is missing, or does not work: SM608 and SM609."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.checks.findings import notation
from smachac.checks.findings.types_with_code import used_here
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.source import Span
from smachac.pysource.modules.user_code import StateFault
from smachac.pysource.templates.template_sources import template_sources, uses_own_templates
from smachac.records import replace


@rule(
    "SM608",
    "code-not-found",
    Severity.ERROR,
    unsuppressible=True,
    effect="Python raises ImportError: the program stops when it starts",
    about_code=True,
)
def code_not_found(context: Context) -> Iterator[Finding]:
    """The class that an interface names as the code of a state type does not exist, its file cannot
    be parsed, or an import in it or in a template fails, also because it is circular.

    The generated program stops when it starts.

    Exactly: of a class, its module and those of its base classes are read, of a template the block
    `imports`; there, imports of modules of the project are checked. A module is missing if the
    folder of its package has other modules, or if a module with nearly the same name exists. Other
    modules can be installed packages, which are not searched. In a circular import, a name is
    imported from a module that has begun to load and has not defined it yet. A build for another
    language than that of the class reports a warning.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grip"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done"])

            def execute(self, userdata):
                return "done"

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grasp"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done"])

            def execute(self, userdata):
                return "done"
    """
    for item in context.code_facts.faults:
        if item.fault.kind.missing:
            yield _finding(item)
    yield from _template_imports(context)


def _template_imports(context: Context) -> Iterator[Finding]:
    """The imports in the user's templates that fail: errors, or warnings in a block with tags of
    Jinja, which can leave the import out."""
    project, machine = context.project, context.machine
    if project is None or project.target not in ("", "python"):
        return
    if not uses_own_templates(machine, project.library):
        return
    from smachac.pysource.modules.imports import missing_in_template

    for file, source in template_sources(machine, project.library):
        if project.library.own_template(file) is not None:
            for fault, is_printed in missing_in_template(source, project.library):
                severity = None if is_printed else Severity.WARNING
                yield _finding(StateFault(fault, "python", "", file, ()), severity)


@rule(
    "SM609",
    "unusable-class",
    Severity.ERROR,
    unsuppressible=True,
    effect="the generated program stops with an error when it makes the state or runs it",
    about_code=True,
)
def unusable_class(context: Context) -> Iterator[Finding]:
    """The class of a state type does not work as a state: a method is missing or hidden, or the
    constructor does not fit the interface.

    The generated program stops with an error when it makes the state or runs it.

    Exactly: the class is read, never run. A program makes the state with the variables that a
    script sets, passed by their names. `check` reports an error if the program cannot make the
    state, or stops each time that the state runs; other faults are warnings. A build for the
    language of the class fails with all of them, a build for another language with none. Found are
    also misspelt names, names that only another function defines, usual
    modules that are not imported, methods of `self` that no class defines, methods without `()`,
    `is` with a text or a number, `==` in place of `=`, and keys that are not in a list; outcomes
    that `execute` makes and does not return, names without a value after an `except`, attributes
    that nothing sets, methods that a plain class of the project lacks, and calls with too few
    or too many arguments, also through an object or in a template. Where a name can be defined
    elsewhere, nothing is reported.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp, force: 5.0}
        == templates/Grasp.yml ==
        name: Grasp
        variables: {force: {type: float}}
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grasp"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done"])

            def execute(self, userdata):
                return "done"

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp, force: 5.0}
        == templates/Grasp.yml ==
        name: Grasp
        variables: {force: {type: float}}
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grasp"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self, force):
                super().__init__(outcomes=["done"])
                self.force = force

            def execute(self, userdata):
                return "done"
    """
    built = context.project is not None and context.project.target
    for item in context.code_facts.faults:
        kind = item.fault.kind
        if not kind.missing:
            yield _finding(item, None if built or kind.stops else Severity.WARNING)
    yield from _faults_of_program(context)


def _faults_of_program(context: Context) -> Iterator[Finding]:
    """The faults of the classes of a program in Python, each once."""
    seen: set[Span] = set()
    for path, leaf, facts, _ in context.leaves_with_class:
        if not notation.is_python(leaf) or facts.name is None:
            continue
        for fault in facts.faults:
            if fault.kind.early or fault.name.span in seen:
                continue
            seen.add(fault.name.span)
            name = facts.name.text
            item = StateFault(fault, "python", name, name, used_here(leaf))
            found = _finding(item, None if fault.kind.stops else Severity.WARNING)
            yield replace(found, node=path, effect=found.effect or STOPS)


STOPS = "the program stops with an error when it makes the state or runs it"
"""What most faults of a class do in a program that is written in Python."""


def _finding(item: StateFault, severity: Severity | None = None) -> Finding:
    """The finding for a fault of the code of a state type, in the words of its kind."""
    fault = item.fault
    kind, word, near = fault.kind, fault.name.text, fault.near
    fields = {
        "word": word,
        "name": item.class_name,
        "type": item.type_name,
        "lists": item.lists,
        "near": near,
        "file": fault.file,
        "more": fault.more,
        "owner": fault.owner,
        "place": f"`{fault.file}`" if fault.file else kind.unnamed.format(type=item.type_name),
        "suggestion": _suggestion(word, near) if near is not None else "",
    }
    help = kind.near_help if near is not None and kind.near_help else kind.help
    return Finding(
        span=fault.name.span,
        message=kind.message.format_map(fields),
        arguments=(item.language, item.type_name, kind.name, word),
        help=fault.help or help.format_map(fields),
        effect=kind.effect.format_map(fields) if kind.effect is not None else None,
        related=item.related,
        severity=severity,
    )


def _suggestion(word: str, near: str) -> str:
    """The help that proposes a name, or other code, for a word."""
    if near in ("None", "True", "False"):
        return f"write `{near}`: Python has no `{word}`"
    is_code = near.startswith('"') or "." in near
    return f"write `{near}`" if is_code else f"did you mean `{near}`?"

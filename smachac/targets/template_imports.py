"""Imports of modules of the project that fail, in templates of the user (SM608)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.frontend.loader import Library
from smachac.ir.nodes import Machine
from smachac.pysource.imports import missing_in_template
from smachac.targets.errors import class_fault


def template_imports(machine: Machine, library: Library) -> Iterator[Diagnostic]:
    """The imports in the user's templates that fail: errors, or warnings in a block with tags of
    Jinja, which can leave the import out."""
    from smachac.targets.python.template_sources import template_sources, uses_own_templates

    if not uses_own_templates(machine, library):
        return
    for file, source in template_sources(machine, library):
        if library.own_template(file) is not None:
            for fault, is_printed in missing_in_template(source, library):
                found = class_fault(fault, "python", "", file, ())
                yield found if is_printed else replace(found, severity=Severity.WARNING)

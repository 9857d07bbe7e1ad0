"""Templates that interfaces name as code and no folder has: SM605."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.spelling import guesser
from smachac.frontend.errors.references import template_error
from smachac.frontend.loader import Library
from smachac.ir.nodes import Machine, StateType
from smachac.pysource.modules.user_code import user_types


def missing_templates(machine: Machine, library: Library) -> Iterator[Diagnostic]:
    """SM605 for each type of a machine whose template does not exist."""
    for _, type_ in user_types(machine, library):
        found = missing_template(type_, library)
        if found is not None:
            yield found


def missing_template(type_: StateType, library: Library) -> Diagnostic | None:
    """SM605 for the file of a template that an interface names and no folder has."""
    file, place = type_.code.get("python", ""), type_.class_spans.get(("python", ""))
    if place is None or not file.endswith((".py", ".tpl")) or library.template(file) is not None:
        return None
    ending = ".tpl.py"
    names = [name for name in library.template_names() if library.own_template(f"{name}{ending}")]
    near = guesser(names)(file.removesuffix(ending))
    help = f"add the file `{file}` to a folder of templates"
    if near is not None:
        help = f"did you mean `{near}{ending}`?"
    message = f"the template `{file}` of the state type `{type_.name}` was not found"
    return template_error(place, message, help, (type_.name,))

"""The `code` of an interface file: the class or the template of each language."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend import schema
from smachac.frontend.errors.script import Choice, Owner, unknown_variable, wrong_shape
from smachac.frontend.text.unquoted import check_unquoted, is_name
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Tree
from smachac.frontend.types.value_facts import check_language
from smachac.ir.nodes import NATIVE

Section: TypeAlias = tuple[Entry, ...]
"""The entries of a part of an interface."""

CLASS_FIELDS = ("header", "class", "with")
"""The fields of code that is a class: its file, its name, the parameter of its constructor."""

TEMPLATE_ENDINGS = frozenset(["py", "tpl", "j2", "jinja", "jinja2"])
"""The endings of files of templates: a dotted text with another ending names a class."""


def declared_in(section: Section) -> list[tuple[str, Tree]]:
    """The named entries of a section, without `"*"`."""
    return [(str(entry.key.value), entry.value) for entry in section if entry.key.value != "*"]


def code_by_language(section: Section, report: Report) -> dict[str, str]:
    """The code by language; a reference to a class of Python must be importable."""
    found = {}
    for entry in section:
        check_language(Word(str(entry.key.value), entry.key.span), report)
    for language, value in declared_in(section):
        if isinstance(value, Scalar):
            found[language] = str(value.value)
            help = _suggested_class(language, found[language])
            if help is not None:
                message = f"`{value.value}` is not the name of a class in a Python module"
                arguments = ("class", str(value.value))
                report.append(wrong_shape(value.span, message, help, arguments=arguments))
    return found


def _suggested_class(language: str, text: str) -> str | None:
    """The help for a text that is neither `module:Class` nor, for Python, the name of a template;
    None for one of these and for other languages."""
    if language not in ("python", *NATIVE):
        return None
    names = text.replace(":", ".", 1).split(".")
    importable = all(map(is_name, names))
    has_template = language == "python"
    if ":" in text or not has_template:
        form = "write it as `my_robot.states:Grasp`"
        form += ", or give the file name of a template" if has_template else ""
        return None if ":" in text and importable else form
    if not importable or len(names) < 2 or names[-1] in TEMPLATE_ENDINGS:
        return None
    return f"write a colon before the class: `{'.'.join(names[:-1])}:{names[-1]}`"


def classes_by_language(section: Section, report: Report) -> dict[str, dict[str, str]]:
    """The classes by language, for code that is a mapping."""
    found = {}
    for language, value in declared_in(section):
        if not isinstance(value, Map):
            continue
        given: dict[str, str] = {}
        for entry in value.entries:
            name = str(entry.key.value)
            if name not in CLASS_FIELDS:
                word = Word(name, entry.key.span)
                owner = Owner("code", "the code of a state type")
                choice = Choice(owners=schema.special_owners(name))
                report.append(unknown_variable(word, owner, CLASS_FIELDS, choice))
            elif isinstance(entry.value, Scalar):
                given[name] = str(entry.value.value)
                if language == "cpp":
                    check_unquoted(entry.value, name, report)
        missing = [name for name in CLASS_FIELDS[:2] if name not in given]
        if missing:
            message = f"the code for `{language}` has no `{missing[0]}`"
            help = "write it as `{header: my_robot/grasp.hpp, class: my_robot::Grasp}`"
            arguments = ("code", language, missing[0])
            report.append(wrong_shape(value.span, message, help, arguments=arguments))
        else:
            found[language] = given
    return found


def class_spans(section: Section) -> dict[tuple[str, str], Span]:
    """The places of the texts of `classes_by_language`, by language and field; those of
    `code_by_language` have no field."""
    found = {
        (language, ""): value.span
        for language, value in declared_in(section)
        if isinstance(value, Scalar)
    }
    return found | {
        (language, str(entry.key.value)): entry.value.span
        for language, value in declared_in(section)
        if isinstance(value, Map)
        for entry in value.entries
    }


def python_code(section: Section, code: Mapping[str, str], source: Source) -> Word | None:
    """The Python code of an interface with its place; that of the template beside it has none."""
    for language, value in declared_in(section):
        if language == "python" and isinstance(value, Scalar):
            return Word(str(value.value), value.span)
    return Word(code["python"], Span(source, 0, 0)) if "python" in code else None

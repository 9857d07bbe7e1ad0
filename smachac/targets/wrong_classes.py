"""Interfaces that name the class of another state type while the module has a class of their own
name: one finding (SM603) at the name of the class, in place of those in its code."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report
from smachac.diagnostics.source import Span, Word
from smachac.frontend.cpp_text import class_head, without_literals
from smachac.frontend.loader import Library
from smachac.frontend.python_modules import Module, find_class, load_module
from smachac.ir.nodes import Leaf, Machine, StateType
from smachac.ir.script_paths import plain_paths
from smachac.ir.traversal import walk
from smachac.targets.errors import Difference, interfaces_differ

IN_CLASS = ("SM308", "SM309", "SM310", "SM314", "SM315", "SM603", "SM604", "SM609")
"""The findings that a class causes which is not that of its interface."""


class _Named(NamedTuple):
    """The class that an interface names in its code, at its place, and the text to write there."""

    language: str
    word: Word
    meant: str


def with_wrong_classes(report: Report, machine: Machine, library: Library) -> Report:
    """The findings, with one at the name of a class in an interface in place of those in the class,
    where the class is that of another interface."""
    if not any(item.code in IN_CLASS for item in report):
        return report
    leaves, types = _leaves(machine)
    for name, leaf in leaves.items():
        type_ = machine.state_types.get(name)
        if type_ is None or type_.built_in or type_.open:
            continue
        caused = [item for item in report if _is_caused(item, type_, types)]
        named = _other_class(type_, machine, library) if caused else None
        if named is not None:
            text = f"it belongs to another interface, and the class `{name}` exists"
            difference = Difference(Word(text, named.word.span), f"write `{named.meant}`")
            used = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{name}`")
            found = interfaces_differ(used, named.language, name, named.word.text, [difference])
            report = [*(item for item in report if item not in caused), found]
    return report


def _leaves(machine: Machine) -> tuple[dict[str, Leaf], dict[str, str]]:
    """The first state of each type, and the type of each path in the script."""
    leaves: dict[str, Leaf] = {}
    types: dict[str, str] = {}
    plain = plain_paths(machine.root)
    for path, node in walk(machine.root):
        if isinstance(node, Leaf):
            leaves.setdefault(node.type, node)
            types[path] = types[plain.get(path, path)] = node.type
    return leaves, types


def _is_caused(item: Diagnostic, type_: StateType, types: Mapping[str, str]) -> bool:
    """Whether a finding is about the class of a state type."""
    if item.code not in IN_CLASS:
        return False
    finding = item.finding
    return type_.name in finding.arguments or types.get(finding.node or "") == type_.name


def _other_class(type_: StateType, machine: Machine, library: Library) -> _Named | None:
    """The class in the code of a state type, where it is the class of another interface and there
    is one with the name of the type."""
    code, place = type_.code.get("python", ""), type_.class_spans.get(("python", ""))
    given = type_.classes.get("cpp", {})
    if place is not None:
        found = _in_python(type_.name, code, place, library)
    else:
        found = _in_cpp(type_, given, library) if "class" in given else None
    if found is None or found.word.text == type_.name:
        return None
    owner = library.own_template(f"{found.word.text}.yml") is not None
    return found if owner or _is_shared(type_, code, given, machine) else None


def _is_shared(type_: StateType, code: str, given: Mapping[str, str], machine: Machine) -> bool:
    """Whether another state type has the same code."""
    others = (each for each in machine.state_types.values() if each.name != type_.name)
    return any(
        (code and each.code.get("python") == code) or (given and each.classes.get("cpp") == given)
        for each in others
    )


def _in_python(name: str, code: str, place: Span, library: Library) -> _Named | None:
    """The class or the template that `code` names, with the one of a name beside it."""
    module, colon, class_ = code.partition(":")
    if colon:
        loaded = load_module(module, library)
        own = find_class(loaded, name, library) if isinstance(loaded, Module) else None
        pair = isinstance(own, tuple)
        return _named("python", class_, place, f"{module}:{name}") if pair else None
    class_, dot, ending = code.partition(".")
    file = f"{name}{dot}{ending}"
    return _named("python", class_, place, file) if library.own_template(file) else None


def _in_cpp(type_: StateType, given: Mapping[str, str], library: Library) -> _Named | None:
    """The class of C++ that `code` names, with the one of the name of its type in its header."""
    space, colons, class_ = given["class"].rpartition("::")
    source = library.code(given["header"])
    place = type_.class_spans.get(("cpp", "class"))
    if source is None or place is None or type_.name not in source.text:
        return None
    if not re.search(class_head(type_.name), without_literals(source.text)):
        return None
    return _named("cpp", class_, place, f"{space}{colons}{type_.name}")


def _named(language: str, class_: str, place: Span, meant: str) -> _Named:
    start = place.source.text.rfind(class_, place.start, place.end)
    span = Span(place.source, start, start + len(class_)) if start >= 0 else place
    return _Named(language, Word(class_, span), meant)

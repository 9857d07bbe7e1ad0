"""The import of an XML file, SCXML or that of YASMIN: its machine as a script, with a proof."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source, Span
from smachac.frontend.errors.script import unreadable_file
from smachac.frontend.files import Disk, lies_inside
from smachac.ir.nodes import Leaf
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import walk
from smachac.pysource.machines.constructions import Constructions
from smachac.refactor.imports import scxml, yasmin_xml
from smachac.refactor.imports.project import (
    Imported,
    Incomplete,
    built_in_names,
    completed,
    in_order,
)
from smachac.refactor.imports.scripts import PythonMachine, script_files, settings
from smachac.refactor.imports.xml_source import Loader, UnreadableMachineError, XmlMachine, local
from smachac.robots.xml_tree import Element, FormatHelp, XmlError, parse


class Format(NamedTuple):
    """A format of XML: its name, its helps, and its reader, which raises UnreadableMachineError."""

    name: str
    help: FormatHelp
    read: Callable[[Source, Element, Loader], XmlMachine]


FORMATS: Mapping[str, Format] = {
    scxml.ROOT: Format("SCXML", scxml.FORMAT, scxml.read_machine),
    yasmin_xml.ROOT: Format("YASMIN", yasmin_xml.FORMAT, yasmin_xml.read_machine),
}
"""The formats by the first tag of a file."""

SUFFIXES = (".scxml", ".xml")
"""The ends of the names of such files."""


def import_xml(path: Path, folder: Path, disk: Disk, wanted: str | None = None) -> Imported:
    """The script of the machine in an XML file, as it will be in a folder. Nothing is written."""
    report: Report = []
    source = disk.read(path, report)
    machine = _read(source, report, disk) if source is not None else None
    if machine is None:
        return Imported(report=report, is_read=False)
    root = machine.root
    if wanted not in (None, root.name):
        return Imported(report=report, all_names=[root.name])
    places = tuple((node.span, f"`{node.name}` has no states") for _, node in walk(root)
                   if not isinstance(node, Leaf) and not node.children)  # fmt: skip
    if places:
        return Imported(report=report, names=[root.name], all_names=[root.name],
                        incomplete=[Incomplete(name=root.name, unknown=places)])  # fmt: skip
    made = script_files([_machine(machine)], path, folder, 0, built_in_names())
    made.lost += machine.lost
    made.texts["smachac.toml"] = settings([], 0)
    texts, proofs = completed(made, path, folder, (), disk)
    return Imported(report=report, texts=texts, lost=in_order(made.lost), proofs=proofs,
                    names=[root.name], all_names=[root.name])  # fmt: skip


def _machine(machine: XmlMachine) -> PythonMachine:
    root = machine.root
    name = re.sub(r"\W+", "_", root.name).strip("_") or "sm"
    made = Constructions(states=machine.states, userdata=machine.userdata, items={}, callbacks={},
                         noted=(), shared=(), modules={}, one_rule=machine.one_rule)  # fmt: skip
    return PythonMachine(name=name, label=root.name, root=root, constructions=made)


def _read(source: Source, report: Report, disk: Disk) -> XmlMachine | None:
    """The machine of a file; None with a finding if it cannot be read."""

    def load(user: str, name: str) -> tuple[Source, Element] | None:
        path = Path(user).parent / name
        if not lies_inside(path, Path(user).parent) or not disk.is_file(path):
            return None
        found = disk.read(path, report)
        if found is None:
            return None
        try:
            return found, parse(found.text, yasmin_xml.FORMAT)
        except XmlError as error:
            raise UnreadableMachineError(
                error.message, Span(found, *error.place), error.help
            ) from None

    help = scxml.FORMAT if source.name.endswith(".scxml") else yasmin_xml.FORMAT
    try:
        root = parse(source.text, help)
        format = FORMATS.get(local(root.tag))
        if format is None:
            message = f"`<{root.tag}>` is no machine"
            help_ = "name a file whose first tag is `<scxml>`, or `<StateMachine>` for YASMIN"
            raise UnreadableMachineError(message, _place(source, root), help_)
        with deep_recursion():
            return format.read(source, root, load)
    except XmlError as error:
        span = Span(source, *error.place)
        report.append(unreadable_file(span, error.message, error.help, arguments=("xml",)))
    except UnreadableMachineError as fault:
        report.append(unreadable_file(fault.span, str(fault), fault.help, arguments=("xml",)))
    return None


def _place(source: Source, element: Element) -> Span:
    return Span(source, *element.place(source.text))

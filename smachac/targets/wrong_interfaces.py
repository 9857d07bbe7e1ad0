"""Keys and variables that an interface has wrong where the class and the script agree: one finding
(SM603) at the name in the interface, in place of those that follow from it. Its outcomes are judged
before the script is lowered (frontend/meant_declarations.py)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import replace
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.frontend.class_reader import PARAMETERS
from smachac.frontend.loader import Library
from smachac.ir.class_facts import Parameter
from smachac.ir.nodes import Container, Leaf, Machine, Remap, StateType
from smachac.ir.script_paths import plain_paths
from smachac.ir.traversal import enclosing, outer_inputs, outer_outputs, walk
from smachac.targets.errors import Difference, interfaces_differ
from smachac.targets.interface_check import Load

IN_SCRIPT = ("SM003", "SM004", "SM301", "SM302", "SM305", "SM306")
"""The findings in a script about a name that an interface lacks or has wrong."""

ANYWHERE = ("SM301", "SM305", "SM306")
"""Those about a key, at any place that sets or reads it."""

IN_CODE = ("SM002", "SM004", "SM308", "SM309", "SM310", "SM314", "SM315", "SM603", "SM604", "SM609")
"""Those in the interface and in the class."""

OF_PARAMETERS = ("no parameter", "required parameter", "other parameter", "renamed parameter")
"""The kinds of faults of a class (SM609) that a wrong variable of its interface causes."""


class _Part(NamedTuple):
    """The keys or the variables of an interface: their field, what a name of it is, the names that
    the interface has, those of the class, and those that the script uses. `whole`: the class has no
    others."""

    field: str
    what: str
    interface: Sequence[str]
    code: Set[str]
    script: Set[str]
    whole: bool = True

    @property
    def more(self) -> list[str]:
        """The names that only the interface has; where the class can have others, those that are
        one slip away from a missing one."""
        found = [name for name in self.interface if name not in self.code]
        sure = guesser(self.missing).sure
        return found if self.whole else [name for name in found if sure(name) is not None]

    @property
    def missing(self) -> list[str]:
        """The names that the class has and the interface lacks."""
        return sorted(self.code - {*self.interface})


class _Code(NamedTuple):
    """The names in a class: those that it declares (None: not known) and those that it uses."""

    language: str
    name: str
    inputs: Sequence[Word] | None
    outputs: Sequence[Word] | None
    reads: Sequence[Word] = ()
    writes: Sequence[Word] = ()
    parameters: Sequence[Parameter] | None = None


class _Use(NamedTuple):
    """A state of a type, the container around it in the script, and its remappings there."""

    leaf: Leaf
    around: Container
    remaps: Sequence[Remap]


def with_wrong_interfaces(report: Report, machine: Machine, library: Library, load: Load) -> Report:
    """The findings, with one for a wrong name of an interface in place of those that it causes."""
    if not any(item.code in ("SM003", *IN_CODE) for item in report):
        return report
    uses, paths = _uses(machine)
    for name, used in uses.items():
        type_ = machine.state_types.get(name)
        source = library.own_template(f"{name}.yml")
        code = _code(type_, library, load) if type_ is not None and source is not None else None
        if type_ is None or type_.open or code is None or source is None:
            continue
        parts = [*_parts(type_, code, used, report)]
        wrong = [each for each in parts if _is_wrong(each)]
        others = [each for each in parts if each not in wrong and (each.more or each.missing)]
        if len(wrong) == 1 and not others:
            names = {*wrong[0].more, *wrong[0].missing}
            names |= {each.to for one in used for each in one.remaps if each.key in names}
            rest = [item for item in report if not _follows(item, names, type_, source, paths)]
            rest = [item for item in rest if not _is_empty(item, wrong[0].field, source)]
            field = next((item for item in rest if _is_field(item, source)), None)
            found = _finding(wrong[0], type_, code, used[0].leaf, source)
            if field is not None:
                rest.remove(field)
                help = f"write `{wrong[0].field}`"
                found = replace(field, finding=replace(field.finding, help=help))
            report = [*rest, found]
    return report


def _is_field(item: Diagnostic, source: Source) -> bool:
    """Whether a finding is about an unknown field of an interface."""
    here = item.span.source.name == source.name
    return here and item.code == "SM003" and item.finding.arguments[1:] == ("interface",)


def _is_empty(item: Diagnostic, field: str, source: Source) -> bool:
    """Whether a finding is that a field of an interface has no value."""
    span = item.span
    nothing = item.finding.arguments == ("map", "nothing") and span.source.name == source.name
    return nothing and span.source.text[: span.start].rstrip(": \n").endswith(field)


def _uses(machine: Machine) -> tuple[dict[str, list[_Use]], dict[str, str]]:
    """The states of each type, and the type of each path in the script."""
    uses: dict[str, list[_Use]] = {}
    paths: dict[str, str] = {}
    around = enclosing(machine.root)
    plain = plain_paths(machine.root)
    for path, node in walk(machine.root):
        if not isinstance(node, Leaf):
            continue
        above, container = around[path]
        remaps = [*node.remaps]
        while container.sugar:
            remaps += container.remaps
            above, container = around[above]
        uses.setdefault(node.type, []).append(_Use(node, container, remaps))
        paths[plain.get(path, path)] = node.type
    return uses, paths


def _code(type_: StateType, library: Library, load: Load) -> _Code | None:
    """The names in the class of a type: that in Python, else that in C++."""
    facts = type_.class_facts
    if facts is not None:
        name = facts.name.text if facts.name is not None else type_.name
        return _Code(
            "python", name, facts.inputs, facts.outputs, facts.reads, facts.writes, facts.parameters
        )
    target = load("cpp") if "cpp" in type_.classes else None
    found = target.declared(type_, library) if target is not None else None
    if found is None:
        return None
    return _Code("cpp", found.name, found.inputs, found.outputs)


def _parts(type_: StateType, code: _Code, used: Sequence[_Use], report: Report) -> Iterator[_Part]:
    """The parts of an interface with the names in the class that are known."""
    remapped = {each.key for one in used for each in one.remaps}
    unknown = {
        item.finding.arguments[0]
        for item in report
        if item.code == "SM003" and item.finding.arguments[1:] == (type_.name,)
    }
    inputs = [each.name for each in type_.input_keys]
    outputs = [each.name for each in type_.output_keys]
    if "input_keys" not in type_.given:
        has = _texts(code.inputs or ())
        has |= set() if code.inputs is not None else _texts(code.reads) - {*outputs}
        known = remapped | {name for one in used for name in _keys(one.around)}
        yield _Part("input_keys", "input key", inputs, has, known, code.inputs is not None)
    if "output_keys" not in type_.given:
        has = _texts(code.outputs or ())
        has |= set() if code.outputs is not None else _texts(code.writes) - {*inputs}
        known = remapped | _unset(type_, report) | _read(used)
        yield _Part("output_keys", "output key", outputs, has, known, code.outputs is not None)
    if code.parameters is not None and "variables" not in type_.given:
        optional = {each.word.text for each in code.parameters if not each.required}
        kept = {*PARAMETERS, "node", *optional} - type_.variables.keys() - unknown
        has = {each.word.text for each in code.parameters} - kept
        yield _Part("variables", "variable", [*type_.variables], has, unknown)


def _read(used: Sequence[_Use]) -> set[str]:
    """The keys that other states beside those of a type read, and those that the containers around
    them give."""
    leaves = {one.leaf.name for one in used}
    found = {each.name for one in used for each in one.around.outputs}
    for around in {id(one.around): one.around for one in used}.values():
        for child in around.children:
            if child.name not in leaves:
                found.update(outer_inputs(child))
    return found


def _texts(words: Sequence[Word]) -> set[str]:
    return {word.text for word in words}


def _keys(container: Container) -> Iterator[str]:
    """The keys of a container that something in it sets, and its own ones."""
    yield from (each.key for each in container.userdata)
    yield from (each.name for each in container.inputs)
    for child in container.children:
        yield from outer_outputs(child)


def _unset(type_: StateType, report: Report) -> set[str]:
    """The keys in `writes` that the interface does not declare."""
    return {
        name
        for item in report
        if item.code == "SM004"
        and item.finding.arguments[:1] == ("output_keys",)
        and item.span.source.name.rpartition("/")[2] == f"{type_.name}.yml"
        for name in item.finding.arguments[1:]
    }


def _is_wrong(part: _Part) -> bool:
    """Whether the interface lacks names that the class and the script have, or has another name in
    place of one."""
    more, missing = part.more, part.missing
    agreed = bool(missing) and part.script >= {*missing}
    return agreed and (not more or (len(more) == len(missing) == 1 and more[0] not in part.script))


def _follows(
    item: Diagnostic, names: Set[str], type_: StateType, source: Source, paths: Mapping[str, str]
) -> bool:
    """Whether a finding is about one of the names, at a state of the type or in its files."""
    arguments = {*item.finding.arguments}
    if item.code in ("SM603", "SM604"):
        return type_.name in arguments
    if item.code == "SM609" and arguments.isdisjoint(OF_PARAMETERS):
        return False
    if arguments.isdisjoint(names) or item.code not in (*IN_SCRIPT, *IN_CODE):
        return False
    here = paths.get(item.finding.node or "") == type_.name or item.code in ANYWHERE
    return here or type_.name in arguments or item.span.source.name == source.name


def _finding(part: _Part, type_: StateType, code: _Code, leaf: Leaf, source: Source) -> Diagnostic:
    more, missing = part.more, part.missing
    title = re.compile(rf"^{part.field}\b", re.M)
    if more:
        found = re.compile(rf"\b{re.escape(more[0])}\b").search(source.text, _start(title, source))
        text = f"the {part.what} `{more[0]}` is `{missing[0]}` in the class and in the script"
        help = f"write `{missing[0]}` in place of `{more[0]}`"
    else:
        found = title.search(source.text)
        entries = ", ".join(f"{each}: {{}}" for each in missing)
        several = f"{part.what}s" if len(missing) > 1 else part.what
        does = "are" if len(missing) > 1 else "is"
        text = f"the {several} {listed(missing)} {does} missing here"
        help = f"add `{entries}` to `{part.field}`"
        if found is None:
            found = re.compile(r"\w+").search(source.text)
            help = f"add `{part.field}: {{{entries}}}`"
    start, end = found.span() if found is not None else (0, 0)
    difference = Difference(Word(text, Span(source, start, end)), help)
    used = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{type_.name}`")
    return interfaces_differ(used, code.language, type_.name, code.name, [difference])


def _start(title: re.Pattern[str], source: Source) -> int:
    """The place of a field in an interface."""
    found = title.search(source.text)
    return found.end() if found is not None else 0

"""The interface check: the declared interfaces of the user's classes against their state types.

A target reads the interface that a class in its language declares (`Declared`), without running the
class. Parts that cannot be read are not checked.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from typing import Protocol

from smachac.diagnostics.diagnostic import Diagnostic, Related, Severity
from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.frontend.errors.references import template_error
from smachac.frontend.loader import Library
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind, Parameter, renamed_name
from smachac.ir.nodes import Leaf, Machine, StateMachine, StateType
from smachac.ir.traversal import inputs_from, outer_outputs, remapping, walk
from smachac.pysource.import_cycles import circular_imports
from smachac.records import dataclass, field
from smachac.targets.errors import (
    Difference,
    class_fault,
    interfaces_differ,
    stale_code,
)
from smachac.targets.smacha_templates import call_faults, guard_faults
from smachac.targets.template_bodies import body_faults

NO_SUCH_PARAMETER = FaultKind(
    name="no such parameter",
    message="`__init__` of `{name}` does not accept `{word}`, which is set here",
    help="add the parameter `{word}` to `__init__`, or remove it here",
    near_help=SUGGESTION,
    effect="the program passes each variable by its name: the call raises a TypeError",
    stops=True,
)
MISSING_ARGUMENT = FaultKind(
    name="missing argument",
    message="`__init__` of `{name}` requires `{word}`, which this state does not set",
    help="add `{word}: ...` to the state, or give `{word}` a default value in `__init__`",
    effect="the program makes the state without this argument: the call raises a TypeError",
    stops=True,
)

OF_CLASSES = ("SM608", "SM609")
"""The codes of faults for which a check reports an error and only a build for the language of the
class fails: other targets do not need the class."""

Words = tuple[Word, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Declared:
    """The interface that a class declares, with the names of the state type where they correspond.

    A part that could not be read is None. `others` are further differences.
    `stale` is the place of an outdated interface hash in the class, with the present hash.
    `faults` are those of a class that does not exist or does not work as a state. `uses` are the
    places where its code names outcomes. `fields` are the declarations of keys, by their part and
    name, where they can be added to those that the class has.
    """

    name: str
    span: Span
    outcomes: Words | None = None
    inputs: Words | None = None
    outputs: Words | None = None
    others: tuple[Difference, ...] = ()
    stale: Word | None = None
    faults: tuple[ClassFault, ...] = ()
    uses: Words = ()
    fields: Mapping[tuple[str, str], str] = field(default_factory=dict)


class Language(Protocol):
    """The part of a Target that reads the user's classes: its name and its class reader."""

    @property
    def name(self) -> str: ...
    @property
    def declared(self) -> Callable[[StateType, Library], Declared | None]: ...


Load = Callable[[str], Language | None]


def code_faults(machine: Machine, library: Library, load: Load) -> Iterator[Diagnostic]:
    """The differences between classes and interfaces, at the first state of each type. They are
    errors if the program certainly stops when it starts, or when the state runs; otherwise
    warnings: only a build for the language of the class fails.
    """
    targets: dict[str, Language | None] = {}
    found: list[Diagnostic] = []
    for leaf, type_ in own_types(machine, library):
        for language in languages(type_):
            if language not in targets:
                targets[language] = load(language)
            target = targets[language]
            if target is not None:
                found.extend(type_faults(leaf, type_, target, library, machine))
    found += [*cycles(machine, library, found), *argument_faults(machine, library)]
    for item in (*_once(found), *_smacha_faults(machine, library)):
        judged = item.code in OF_CLASSES
        yield item if judged else replace(item, severity=Severity.WARNING)


def cycles(machine: Machine, library: Library, found: Sequence[Diagnostic]) -> list[Diagnostic]:
    """The circular import (SM608) at which the Python program stops, if its modules load otherwise
    (`found` are the other faults of the classes)."""
    if any(item.code == "SM608" for item in found):
        return []
    users: dict[str, tuple[Leaf, StateType, str]] = {}
    for leaf, type_ in own_types(machine, library):
        module, is_class, name = type_.code.get("python", "").partition(":")
        if is_class:
            users.setdefault(module, (leaf, type_, name))
    faults = circular_imports(sorted(users), library)  # the program imports them in this order
    for fault in faults:
        leaf, type_, name = next(iter(users.values()))
        used = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{type_.name}`")
        return [class_fault(fault, "python", type_.name, name, (used,))]
    return []


def missing_templates(machine: Machine, library: Library) -> list[Diagnostic]:
    """SM605 for each type of a machine whose template does not exist."""
    found = (missing_template(type_, library) for _, type_ in own_types(machine, library))
    return [each for each in found if each is not None]


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


def target_faults(machine: Machine, library: Library, target: Language) -> Iterator[Diagnostic]:
    """The same differences for the language of one target, as errors; not those of a type without
    an interface, whose template may belong to another project."""
    found: list[Diagnostic] = []
    for leaf, type_ in own_types(machine, library):
        if target.name in languages(type_) and not type_.open:
            found.extend(type_faults(leaf, type_, target, library))
    if target.name == "python":
        found += cycles(machine, library, found)
    found = [*_once(found)]
    if target.name == "python":
        found += [*argument_faults(machine, library), *_smacha_faults(machine, library)]
    for item in found:
        yield replace(item, severity=Severity.ERROR) if item.code == "SM609" else item


def _smacha_faults(machine: Machine, library: Library) -> Iterator[Diagnostic]:
    """The faults of templates of SMACHA's kind."""
    yield from guard_faults(machine, library)
    yield from call_faults(machine)
    yield from body_faults(machine, library)


def _once(found: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The findings, with one for each fault of a module or base class that several types use."""
    seen: set[tuple[Span, tuple[str, ...]]] = set()
    for item in found:
        fault = item.finding.arguments[2:]
        if item.code in OF_CLASSES:
            if (item.span, fault) in seen:
                continue
            seen.add((item.span, fault))
        yield item


def argument_faults(machine: Machine, library: Library) -> Iterator[Diagnostic]:
    """The states whose variables do not fit the constructor of their Python class, where the
    interface accepts any variable (`"*": {}`)."""
    types: dict[str, tuple[StateType, str, tuple[Parameter, ...]]] = {}
    for name, type_ in machine.state_types.items():
        facts = type_.class_facts
        if "variables" not in type_.given or facts is None or facts.name is None:
            continue
        if facts.parameters:
            types[name] = type_, facts.name.text, facts.parameters
    for _, leaf in walk(machine.root) if types else ():
        if not isinstance(leaf, Leaf) or leaf.type not in types:
            continue
        type_, class_name, parameters = types[leaf.type]
        given = {*type_.given, *(["outcomes"] if type_.optional else ())}
        given |= {"node"} if library.ros == 2 and parameters[0].word.text == "node" else set()
        for fault, related in _argument_faults(leaf, type_, parameters, given):
            yield class_fault(fault, "python", type_.name, class_name, related)


def _argument_faults(
    leaf: Leaf, type_: StateType, parameters: Sequence[Parameter], given: Set[str]
) -> Iterator[tuple[ClassFault, tuple[Related, ...]]]:
    known = {each.word.text: each for each in parameters}
    set_ = {one.name: one for one in leaf.variables}
    passed = {*set_, *type_.variables, *given}
    guess = guesser([name for name in known if name not in passed])
    meant = set()
    for name in sorted(set_.keys() - known.keys() - type_.variables.keys()):
        near = guess(name)
        meant.add(near)
        yield ClassFault(kind=NO_SUCH_PARAMETER, name=Word(name, set_[name].span), near=near), ()
    for name in sorted(known.keys() - passed - meant):
        if known[name].required:
            place = Related(span=known[name].word.span, message="the constructor requires it")
            yield ClassFault(kind=MISSING_ARGUMENT, name=Word(name, leaf.span)), (place,)


def languages(type_: StateType) -> tuple[str, ...]:
    """The languages that an interface names code in."""
    return tuple(dict.fromkeys((*type_.code, *type_.classes)))


def own_types(machine: Machine, library: Library) -> Iterator[tuple[Leaf, StateType]]:
    """The state types of the user whose interface or class is known, each with its first state."""
    seen: set[str] = set()
    for _, node in walk(machine.root):
        if isinstance(node, Leaf) and node.type not in seen:
            seen.add(node.type)
            type_ = machine.state_types.get(node.type)
            if type_ is None:
                continue
            declared = not type_.open and library.own_template(f"{node.type}.yml") is not None
            if declared or type_.class_facts is not None:
                yield node, type_


def type_faults(
    leaf: Leaf,
    type_: StateType,
    target: Language,
    library: Library,
    machine: Machine | None = None,
) -> Iterator[Diagnostic]:
    """The faults of the code of one state type in one language. With the machine in a check, whose
    rules report what the code of its Python class does beyond its interface."""
    checked = machine is not None
    found = target.declared(type_, library)
    if found is None:
        return
    for fault in found.faults:
        if fault.kind.accepted and not checked:
            continue
        used: tuple[Related, ...] = (
            Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{type_.name}`"),
        )
        if fault.also is not None:
            used = (Related(span=fault.also.span, message=fault.also.text), *used)
        if fault.kind.early:
            reader = _reader(machine, type_, fault) if machine is not None else None
            if reader is None:
                continue
            used = (reader, *used)
        if fault.name.span.source is NOWHERE.source:
            fault = replace(fault, name=Word(fault.name.text, leaf.span))
            used = ()
        fault = _with_set_variable(fault, leaf)
        yield class_fault(fault, target.name, type_.name, found.name, used, _lists(type_))
    facts = type_.class_facts if checked and target.name == "python" else None
    if found.stale is None and facts is not None:
        # Returned outcomes that the interface lacks are SM309, such reads SM310, such writes SM308.
        found = replace(
            found,
            outcomes=_without(
                found.outcomes, facts.returns, [each.name for each in type_.outcomes]
            ),
            inputs=_without(found.inputs, facts.reads, [each.name for each in type_.input_keys]),
            outputs=_without(
                found.outputs, facts.writes, [each.name for each in type_.output_keys]
            ),
        )
    differences = [*_differences(type_, found)]
    if found.stale is not None:
        yield stale_code(leaf.span, type_.name, found.name, found.stale, differences)
    elif differences:
        field = "" if target.name == "python" else "class"
        place = type_.class_spans.get((target.name, field))
        named = [] if place is None else [Related(span=place, message="the class is named here")]
        here = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{type_.name}`")
        yield interfaces_differ((*named, here), target.name, type_.name, found.name, differences)


def _with_set_variable(fault: ClassFault, leaf: Leaf) -> ClassFault:
    """A fault of a parameter that has another name than a variable: the help is to rename the
    parameter if the script sets the variable."""
    variable, near = fault.variable, fault.near
    if near is None or all(each.name != variable for each in leaf.variables):
        return fault
    parameter = near if variable == fault.name.text else fault.name.text
    renamed = f"rename the parameter `{parameter}` to `{variable}`, which the script sets"
    return replace(fault, help=f"{renamed}{fault.more}")


def _reader(machine: Machine, type_: StateType, fault: ClassFault) -> Related | None:
    """The state that reads an output key directly after the outcome with which it is not set, where
    nothing else in the state machine sets it."""
    key, outcome = fault.name.text, fault.near
    for _, container in walk(machine.root):
        if not isinstance(container, StateMachine):
            continue
        states = {each.name: each for each in container.children}
        setters: Counter[str] | None = None
        for leaf in container.children:
            if not isinstance(leaf, Leaf) or leaf.type != type_.name:
                continue
            outer = remapping(leaf)[key]
            targets = {each.outcome: each.target for each in leaf.transitions}
            reader = states.get(targets.get(outcome or "", ""))
            if not isinstance(reader, Leaf) or reader is leaf:
                continue
            setters = _setters(container) if setters is None else setters
            read = any(each.type.name != "optional" for each in inputs_from(reader, outer))
            if read and setters[outer] == 1:
                text = f"`{reader.name}` reads `{outer}` after `{leaf.name}` ends with `{outcome}`"
                return Related(span=reader.span, message=text)
    return None


def _setters(container: StateMachine) -> Counter[str]:
    """How many places give each key of a container a value: its inputs, presets and states."""
    found = Counter(each.name for each in container.inputs)
    found.update(each.key for each in container.userdata)
    for child in container.children:
        found.update({*outer_outputs(child)})
    return found


def _lists(type_: StateType) -> str:
    """The arguments of the constructor of `smach.State` that fit an interface."""
    parts = (
        ("outcomes", type_.outcomes),
        ("input_keys", type_.input_keys),
        ("output_keys", type_.output_keys),
    )
    return ", ".join(
        f"{field}=[{', '.join([*(json.dumps(each.name) for each in named), *more])}]"
        for field, named in parts
        for more in (["..."] if field in type_.given else [],)
        if named or more or field == "outcomes"
    )


def _without(words: Words | None, used: Words, known: Sequence[str]) -> Words | None:
    """The names that a class declares, without those that its code uses and its interface lacks:
    in place of each is the name that is probably meant."""
    if words is None:
        return None
    reported = {word.text for word in used}.difference(known)
    guess, renamed = guesser(known), renamed_name(words, known)

    def near(name: str) -> str | None:
        return renamed[1] if renamed is not None and renamed[0].text == name else guess(name)

    meant = (Word(near(word.text) or "", word.span) for word in words if word.text in reported)
    kept = (word for word in words if word.text not in reported)
    return (*kept, *(word for word in meant if word.text))


def _differences(type_: StateType, found: Declared) -> Iterator[Difference]:
    parts = (
        ("outcome", found.outcomes, type_.outcomes),
        ("input key", found.inputs, type_.input_keys),
        ("output key", found.outputs, type_.output_keys),
    )
    for what, words, wanted in parts:
        left_to_the_script = f"{what.replace(' ', '_')}s" in type_.given
        if words is None or left_to_the_script or (what == "outcome" and type_.optional):
            continue
        names = [each.name for each in wanted]
        yield from _unlike(f"`{type_.name}.yml`", what, words, names, found)
    yield from found.others


_LACKED = {
    "outcome": "SMACH accepts only the outcomes of the class: the machine stops with an error",
    "input key": "SMACH lets the state read only the input keys of the class: the machine stops"
    " with an error",
    "output key": "SMACH discards the value of a key that is not an output key of the class",
}
"""What happens where a class lacks a part of its interface, in Python."""


def _whole_list(what: str, name: str, words: Words) -> str:
    """The help that adds a name to the list of a class in Python, if the list is written there."""
    added = f"add `{name}` to the {what}s of the class"
    if not words or len({word.span.line for word in words}) > 1:
        return added
    for word in words:
        if word.span.text not in (f"'{word.text}'", f'"{word.text}"'):
            return added
    quote = words[0].span.text[0]
    first, last = words[0].span, words[-1].span
    text = first.source.text
    if text[first.start - 1 : first.start] != "[" or text[last.end : last.end + 1] != "]":
        return added
    return f"write `{text[first.start - 1 : last.end]}, {quote}{name}{quote}]`"


def _unlike(
    file: str, what: str, words: Words, wanted: Sequence[str], found: Declared
) -> Iterator[Difference]:
    names = [word.text for word in words]
    missing = [name for name in wanted if name not in names]
    more = [word for word in words if word.text not in {*wanted}]
    if len(missing) == len(more) == 1:  # probably two names of the same thing
        text = f"it has the {what} `{more[0].text}`, the interface has `{missing[0]}`"
        uses = [word.span.line for word in found.uses if word.text == more[0].text]
        lines = ", ".join(map(str, dict.fromkeys(uses))) if what == "outcome" else ""
        also = f", also in line {lines}" if lines else ""
        change = f"write `{missing[0]}` in place of `{more[0].text}`{also}"
        help = f"{change}, or correct {file}"
        yield Difference(Word(text, more[0].span), help, change=change)
        return
    for name in missing:
        change = found.fields.get((what, name)) or _whole_list(what, name, words)
        place = Word(f"the {what} `{name}` is missing", words[0].span if words else found.span)
        help = f"{change}, or remove `{name}` from {file}"
        yield Difference(place, help, _LACKED[what], change)
    for word in more:
        change = f"remove `{word.text}` from the {what}s of the class"
        help = f"add `{word.text}` to the {what}s in {file}, or remove it from the class"
        text = f"the {what} `{word.text}` is not in the interface"
        yield Difference(Word(text, word.span), help, change=change)

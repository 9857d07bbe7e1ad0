"""The code of the state types of a machine: the interfaces that its classes declare, and the faults
of its classes and templates.

A target reads the class in its language (`Declared`), without running it. Parts that cannot be read
are not judged.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence, Set

from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import NOWHERE, Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind, Parameter
from smachac.ir.nodes import Leaf, Machine, StateMachine, StateType
from smachac.ir.traversal import inputs_from, outer_outputs, remapping, walk
from smachac.pysource.modules.import_cycles import circular_imports
from smachac.pysource.modules.user_code import (
    CodeFacts,
    Declared,
    ProjectCode,
    StateClass,
    StateFault,
    TemplateBody,
    UserCode,
    languages,
    user_types,
)
from smachac.pysource.templates.smacha_templates import call_faults, guard_faults
from smachac.pysource.templates.template_bodies import body_faults, template_bodies
from smachac.records import replace

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


def state_classes(machine: Machine, project: ProjectCode) -> Iterator[StateClass]:
    """The classes of the state types that are read. For a program, those in its language; not that
    of a type without an interface, whose template may belong to another project."""
    for leaf, type_ in user_types(machine, project.library):
        for language in languages(type_):
            built = project.target == language and not type_.open
            found = project.declared(language, type_) if built or not project.target else None
            if found is not None:
                yield StateClass(leaf, type_, language, found)


def code_facts(machine: Machine, project: ProjectCode) -> CodeFacts:
    """The facts about the code of the user, those of a state type at its first state."""
    classes = tuple(state_classes(machine, project))
    bodies: tuple[TemplateBody, ...] = ()
    found: list[StateFault] = []
    files: list[Source] = []
    for of in classes:
        own = [*_class_faults(of, machine, project.target)]
        found += own
        files += [*map(_file, own), *_declared_in(of.declared)]
    if project.target in ("", "python"):
        if not any(item.fault.kind.missing for item in found):
            found += _cycles(machine, project.library)
        found += _argument_faults(machine, project.library)
        bodies = tuple(template_bodies(machine, project.library))
    found = [*_once(found)]
    if project.target in ("", "python"):
        found += [*guard_faults(machine, project.library), *call_faults(machine)]
        files += map(_file, found)
        files += [body.template for body in bodies]
        found += body_faults(machine, project.library, bodies)
    return CodeFacts(classes, bodies, tuple(found), tuple(dict.fromkeys(files)))


def _file(item: StateFault) -> Source:
    return item.fault.name.span.source


def _declared_in(declared: Declared) -> Iterator[Source]:
    """The files in which a class declares its interface."""
    for words in (declared.outcomes, declared.inputs, declared.outputs):
        yield from (word.span.source for word in words or ())
    yield from (difference.word.span.source for difference in declared.others)
    yield declared.span.source


def _once(found: Iterable[StateFault]) -> Iterator[StateFault]:
    """The faults, with one for each fault of a module or base class that several types use."""
    seen: set[tuple[Span, str, str]] = set()
    for item in found:
        name = item.fault.name
        fault = name.span, item.fault.kind.name, name.text
        if fault not in seen:
            seen.add(fault)
            yield item


def _cycles(machine: Machine, library: UserCode) -> list[StateFault]:
    """The circular import at which the Python program stops, if its modules load otherwise."""
    users: dict[str, tuple[Leaf, StateType, str]] = {}
    for leaf, type_ in user_types(machine, library):
        module, is_class, name = type_.code.get("python", "").partition(":")
        if is_class:
            users.setdefault(module, (leaf, type_, name))
    faults = circular_imports(sorted(users), library)  # the program imports them in this order
    for fault in faults:
        leaf, type_, name = next(iter(users.values()))
        used = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{type_.name}`")
        return [StateFault(fault, "python", type_.name, name, (used,))]
    return []


def _argument_faults(machine: Machine, library: UserCode) -> Iterator[StateFault]:
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
        for fault, related in _unfit_arguments(leaf, type_, parameters, given):
            yield StateFault(fault, "python", type_.name, class_name, related)


def _unfit_arguments(
    leaf: Leaf, type_: StateType, parameters: Sequence[Parameter], given: Set[str]
) -> Iterator[tuple[ClassFault, tuple[Related, ...]]]:
    known = {parameter.word.text: parameter for parameter in parameters}
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


def _class_faults(of: StateClass, machine: Machine, target: str) -> Iterator[StateFault]:
    """The faults of one class. A build accepts those that a compiler or Python accepts."""
    leaf, type_ = of.leaf, of.type
    for fault in of.declared.faults:
        if target and (fault.kind.accepted or fault.kind.early):
            continue
        used: tuple[Related, ...] = (of.user,)
        if fault.also is not None:
            used = (Related(span=fault.also.span, message=fault.also.text), *used)
        if fault.kind.early:
            reader = _reader(machine, type_, fault)
            if reader is None:
                continue
            used = (reader, *used)
        if fault.name.span.source is NOWHERE.source:
            fault = replace(fault, name=Word(fault.name.text, leaf.span))
            used = ()
        fault = _with_set_variable(fault, leaf)
        yield StateFault(fault, of.language, type_.name, of.declared.name, used, _lists(type_))


def _with_set_variable(fault: ClassFault, leaf: Leaf) -> ClassFault:
    """A fault of a parameter that has another name than a variable: the help is to rename the
    parameter if the script sets the variable."""
    variable, near = fault.variable, fault.near
    if near is None or all(other.name != variable for other in leaf.variables):
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
        states = {child.name: child for child in container.children}
        setters: Counter[str] | None = None
        for leaf in container.children:
            if not isinstance(leaf, Leaf) or leaf.type != type_.name:
                continue
            outer = remapping(leaf)[key]
            targets = {transition.outcome: transition.target for transition in leaf.transitions}
            reader = states.get(targets.get(outcome or "", ""))
            if not isinstance(reader, Leaf) or reader is leaf:
                continue
            setters = _setters(container) if setters is None else setters
            read = any(input_.type.name != "optional" for input_ in inputs_from(reader, outer))
            if read and setters[outer] == 1:
                text = f"`{reader.name}` reads `{outer}` after `{leaf.name}` ends with `{outcome}`"
                return Related(span=reader.span, message=text)
    return None


def _setters(container: StateMachine) -> Counter[str]:
    """How many places give each key of a container a value: its inputs, presets and states."""
    found = Counter(input_.name for input_ in container.inputs)
    found.update(preset.key for preset in container.userdata)
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
        f"{field}=[{', '.join([*(json.dumps(item.name) for item in named), *more])}]"
        for field, named in parts
        for more in (["..."] if field in type_.given else [],)
        if named or more or field == "outcomes"
    )

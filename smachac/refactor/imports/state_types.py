"""The state types of an imported machine: their interfaces, which name the classes of the user, and
a module with classes for what an interface cannot name: a function as a state, a parameter with the
name of a field, a state whose code was not taken over."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from smachac.diagnostics.source import Span
from smachac.frontend import schema
from smachac.frontend.text.unquoted import is_name
from smachac.ir.nodes import Expression, Key, Leaf
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY, Type
from smachac.pysource.machines.constructions import Argument, Construction
from smachac.records import dataclass, field, replace
from smachac.refactor.imports.yaml_text import mapping_text, name_text, names_text, quoted

OPTIONAL = Type("optional", (ANY,))

OWN_MODULE = "imported_states"
"""The module with the classes that an import writes."""

_SIMPLE_ACTION = {
    "action_name": "action_server_namespace", "action_spec": "action", "goal": "goal",
    "goal_slots": "goal_slots", "goal_cb": "goal_cb", "result_slots": "result_slots",
    "result_cb": "result_cb",
}  # fmt: skip
_SERVICE = {
    "service_name": "service_namespace", "service_spec": "service", "request": "request",
    "request_slots": "request_slots", "request_cb": "request_cb",
    "response_slots": "response_slots", "response_cb": "response_cb",
}  # fmt: skip
_CONDITION = {name: name for name in ("cond_cb", "poll_rate", "timeout", "max_checks")}
BUILT_IN: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "smach_ros.SimpleActionState": ("SimpleActionState", _SIMPLE_ACTION),
    "smach_ros.ServiceState": ("ServiceState", _SERVICE),
    "smach_ros.MonitorState": (
        "MonitorState", {name: name for name in ("topic", "msg_type", "cond_cb", "max_checks")},
    ),
    "smach_ros.ConditionState": ("ConditionState", _CONDITION),
    "smach.ConditionState": ("ConditionState", _CONDITION),
}  # fmt: skip
"""The built-in state type of a class that is ready to use, and its variable for each parameter."""

_TYPES = ("action_spec", "service_spec", "msg_type")
_INTERFACE = ("outcomes", "input_keys", "output_keys", "io_keys")

OUTCOMES = {
    "SimpleActionState": ("succeeded", "aborted", "preempted"),
    "ServiceState": ("succeeded", "aborted", "preempted"),
    "MonitorState": ("valid", "invalid", "preempted"),
    "ConditionState": ("true", "false", "preempted"),
}

_USABLE = frozenset(["robot", "timeout", "retry", "for_each"])
"""Fields whose names a state type can give to its variables."""

_LANGUAGES = {
    "python": ("smach.State", "userdata"),
    "yasmin": ("yasmin.State", "blackboard"),
    "flexbe": ("flexbe_core.EventState", "userdata"),
}
"""The base class of the classes that an import writes, and the argument of their `execute`, by the
key of the `code` of interfaces."""

RESERVED = frozenset({*schema.VARIABLES, *schema.LONG, "callbacks", "cb"}) - _USABLE
"""Words that no variable of a state type has as its name: fields of scripts."""


def is_optional(key: Key) -> bool:
    """Whether a state can do without a key."""
    return key.type == OPTIONAL


def keys_text(keys: Iterable[Key]) -> str:
    """Keys as a list, or as a mapping to types if the state can do without one of them."""
    keys = [*keys]
    if not any(map(is_optional, keys)):
        return names_text(key.name for key in keys)
    return mapping_text({key.name: '"any?"' if is_optional(key) else "any" for key in keys})


@dataclass(slots=True, kw_only=True)
class ImportedType:
    """A state type to write. `variables` counts the states that set each. `code` is the reference
    to the class of the user; if it is empty, the import writes a class, which passes `fixed`
    arguments and those variables that its parameters name in `passed`."""

    name: str
    leaf: Leaf
    construction: Construction
    place: str
    code: str = ""
    fixed: tuple[str, ...] = ()
    passed: dict[str, str] = field(default_factory=dict)
    states: int = 0
    variables: dict[str, int] = field(default_factory=dict)


class StateTypes:
    """The state types of a project. `place(span)` is a place as text, `taken` are names that no
    type can have."""

    def __init__(self, place: Callable[[Span], str], taken: Iterable[str]) -> None:
        self.place = place
        self.taken = {name.casefold() for name in taken}
        self.known: dict[object, ImportedType] = {}

    def built_in(
        self, leaf: Leaf, construction: Construction
    ) -> tuple[str, dict[str, Argument]] | None:
        """The built-in state type of a state, and its variables; None if it needs one of its
        own."""
        found = BUILT_IN.get(construction.library)
        if found is None or construction.obstacle:
            return None
        name, words = found
        if not set(outcome_names(leaf)) <= set(OUTCOMES[name]):
            return None
        variables: dict[str, Argument] = {}
        for argument in construction.arguments:
            if argument.name in _INTERFACE:
                continue
            if argument.name not in words:
                return None
            if argument.name in _TYPES:
                type_ = construction.types.get(argument.name)
                if type_ is None:
                    return None
                argument = Argument(name=argument.name, data=type_, span=argument.span)
            elif not argument.is_known:
                return None
            variables[words[argument.name]] = argument
        return name, variables

    def of(self, leaf: Leaf, construction: Construction) -> tuple[str, dict[str, Argument]]:
        """The name of the state type of a state, and the variables of the state."""
        if construction.node:
            construction = replace(construction, obstacle="it needs the node of ROS 2")
        wrapped = _is_wrapped(construction)
        fixed, variables, passed = _split(construction, leaf, wrapped=wrapped)
        obstacle = construction.obstacle
        which = (
            construction.cls, construction.library, construction.file, construction.code, fixed,
            construction.calls,
            tuple(passed) if wrapped else (),
            obstacle and construction.short, obstacle, leaf.open, outcome_names(leaf),
            tuple((key.name, is_optional(key)) for key in leaf.inputs),
            tuple(key.name for key in leaf.outputs),
            construction.span if obstacle and not construction.file else None,
        )  # fmt: skip
        if which not in self.known:
            cls = construction.cls
            self.known[which] = ImportedType(
                name=self._name(construction.short or leaf.name), leaf=leaf,
                construction=construction, fixed=fixed, passed=passed,
                place=self.place(construction.cls_span or construction.span),
                code=f"{cls.module}:{cls.name}" if cls is not None and not wrapped else "",
            )  # fmt: skip
        found = self.known[which]
        found.states += 1
        for name in variables:
            found.variables[name] = found.variables.get(name, 0) + 1
        return found.name, variables

    def _name(self, word: str) -> str:
        base = re.sub(r"\W+", "_", word).strip("_")
        base = base if is_name(base) else f"State_{base}".rstrip("_")
        name, number = base, 2
        while name.casefold() in self.taken:
            name, number = f"{base}_{number}", number + 1
        self.taken.add(name.casefold())
        return name

    def files(self) -> dict[str, str]:
        """The interfaces of the state types, and the module with their classes."""
        files = {f"templates/{made.name}.yml": _interface(made) for made in self.known.values()}
        own = [made for made in self.known.values() if not made.code]
        if own:
            files[f"{OWN_MODULE}.py"] = _module(own)
        return files


def _is_wrapped(construction: Construction) -> bool:
    """Whether the import writes a class for a state: there is none to name, an argument has only a
    place, a parameter is a word that a script has for itself, or calls follow the constructor."""
    return (
        construction.cls is None
        or bool(construction.obstacle or construction.calls)
        or any(argument.name in {"", *RESERVED} for argument in construction.arguments)
    )


def _split(
    construction: Construction, leaf: Leaf, *, wrapped: bool
) -> tuple[tuple[str, ...], dict[str, Argument], dict[str, str]]:
    """The arguments that a class of the import passes as they are, as code; the variables of the
    state; and the parameter for which each variable is, which is empty for one with a place."""
    if construction.obstacle:
        given = {argument.name: argument for argument in construction.parameters}
        return (), {_variable(name): argument for name, argument in given.items()}, {}
    fixed: list[str] = []
    variables: dict[str, Argument] = {}
    passed: dict[str, str] = {}
    for at, argument in enumerate(construction.arguments, 1):
        name = argument.name
        is_smach = construction.code == "python"
        if construction.library and name in _INTERFACE and is_smach:
            continue
        if wrapped and name and isinstance(argument.data, Expression):
            fixed.append(f"{name}={argument.data.text}")
            continue
        if construction.library and name in _INTERFACE and isinstance(argument.data, tuple):
            fixed.append(f"{name}={[*argument.data]!r}")
            continue
        variable = _variable(name) if name else f"argument_{at}"
        variables[variable] = argument
        passed[variable] = name
    if construction.library and construction.code == "python":
        fixed.append(f"outcomes={[*outcome_names(leaf)]!r}")
        fixed += [f"{name}={[key.name for key in keys]!r}" for name, keys in
                  (("input_keys", leaf.inputs), ("output_keys", leaf.outputs)) if keys]  # fmt: skip
    return tuple(fixed), variables, passed


def _variable(parameter: str) -> str:
    """The variable for a parameter, which has no name of a field."""
    name = re.sub(r"\W+", "_", parameter)
    return f"{name}_argument" if name in RESERVED or not is_name(name) else name


def _interface(made: ImportedType) -> str:
    """The text of an interface."""
    leaf = made.leaf
    own = made.construction.doc
    doc = f"{own} ({made.place})" if own else f"Imported from {made.place}."
    lines = [f"name: {name_text(made.name)}", f"doc: {quoted(doc)}"]
    if made.variables:
        needed = {
            name: "{}" if count == made.states else "{default: null}"
            for name, count in made.variables.items()
        }
        lines.append(f"variables: {mapping_text(needed)}")
    for word, keys in (("input_keys", leaf.inputs), ("output_keys", leaf.outputs)):
        if keys:
            lines.append(f"{word}: {keys_text(keys)}")
        elif leaf.open or made.construction.code == "yasmin":  # one blackboard has all keys
            lines.append(f'{word}: {{"*": {{}}}}')
    lines.append(f"outcomes: {mapping_text(dict.fromkeys(outcome_names(leaf), '{}'))}")
    code = made.code or f"{OWN_MODULE}:{made.name}"
    lines.append(f"code: {{{made.construction.code}: {quoted(code)}}}")
    return "\n".join(lines) + "\n"


def _module(types: Iterable[ImportedType]) -> str:
    """The module with the classes of an import."""
    bodies: list[str] = []
    for made in types:
        bodies += ["", "", *(_stub(made) if made.construction.obstacle else _wrapper(made))]
    text = "\n".join(bodies)
    libraries = [name for name in ("smach", "smach_ros") if f"({name}." in text]
    modules = sorted({made.construction.cls.module for made in types
                      if made.construction.cls is not None and not made.construction.obstacle}
                     | _modules_in(types))  # fmt: skip
    lines = ['"""Classes for the states of the scripts in this folder."""']
    plain = [name for name in ("yasmin", "yasmin_ros", "flexbe_core") if f"({name}." in text]
    if plain:
        lines += ["", *(f"import {name}" for name in plain)]
    if libraries:
        lines += [
            "", "try:", *(f"    import {name}" for name in libraries),
            "except ImportError:  # without SMACH",
            *(f"    from smachac.runtime import {name}" for name in libraries),
        ]  # fmt: skip
    if modules:
        lines += ["", *(f"import {name}" for name in modules)]
    return "\n".join([*lines, text]) + "\n"


def _modules_in(types: Iterable[ImportedType]) -> set[str]:
    """The modules in the code of fixed arguments."""
    return {module for made in types for argument in made.construction.arguments
            if made.fixed for module in argument.modules}  # fmt: skip


def _wrapper(made: ImportedType) -> list[str]:
    """A class that passes arguments to that of the user or of the framework."""
    cls = made.construction.cls
    base = f"{cls.module}.{cls.name}" if cls is not None else made.construction.library
    given = [f"{name}={variable}" if name else variable for variable, name in made.passed.items()]
    given += made.fixed
    parameters = "".join(f", {name}" for name in made.passed)
    lines = [f"class {made.name}({base}):", f'    """{made.place}"""', "",
             f"    def __init__(self{parameters}):"]  # fmt: skip
    calls = [f"        self.{call}" for call in made.construction.calls]
    if sum(map(len, given)) < 60:
        return [*lines, f"        super().__init__({', '.join(given)})", *calls]
    return [*lines, "        super().__init__(", *(f"            {part}," for part in given),
            "        )", *calls]  # fmt: skip


def _stub(made: ImportedType) -> list[str]:
    """A class for a state whose code was not taken over."""
    leaf = made.leaf
    lists = {
        "outcomes": [*outcome_names(leaf)],
        "input_keys": [key.name for key in leaf.inputs],
        "output_keys": [key.name for key in leaf.outputs],
    }
    given = [f"            {name}={names!r}," for name, names in lists.items() if names]
    counts = sorted(made.variables.items(), key=lambda item: item[1] < made.states)
    parameters = "".join(f", {name}" if count == made.states else f", {name}=None"
                         for name, count in counts)  # fmt: skip
    why = re.sub(r'[\\"]', "'", f"{made.place}: {made.construction.obstacle}.")
    base, argument = _LANGUAGES[made.construction.code]
    return [
        f"class {made.name}({base}):", f'    """{why}"""', "",
        f"    def __init__(self{parameters}):", "        super().__init__(", *given, "        )",
        *(f"        self.{name} = {name}" for name in made.variables), "",
        f"    def execute(self, {argument}):",
        f"        raise NotImplementedError({made.place!r})",
    ]  # fmt: skip


def in_comment(path: str, folder: Path) -> str:
    """A path from a folder as a comment can have it, in YAML, Python and Jinja."""
    text = relative(path, folder).replace("#}", "# }")
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def relative(path: str, folder: Path) -> str:
    """A path from a folder, with `/`."""
    return os.path.relpath(path, folder).replace(os.sep, "/")

"""The state types of an imported machine: their interfaces, and templates where a class cannot be
named in an interface alone."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from smachac.diagnostics.source import Span
from smachac.frontend import schema
from smachac.ir.nodes import Expression, Key, Leaf
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY, Type
from smachac.pysource.machines.constructions import Argument, Construction
from smachac.records import dataclass, field
from smachac.refactor.python_import.yaml_text import mapping_text, name_text, names_text, quoted

OPTIONAL = Type("optional", (ANY,))

TO_WRITE = "states_to_write"
"""The module with the classes of states that cannot be taken over."""

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

_FIELDS = frozenset(schema.names_for("state")) - frozenset(["timeout", "retry", "for_each"])

RESERVED = frozenset({
    *_FIELDS, *(short for short, long in schema.LONG.items() if long in _FIELDS),
    "callbacks", "cb", "arguments",
})  # fmt: skip
"""Words that no variable of a state type can have as its name: fields of a state."""


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
    """A state type to write. `variables` counts the states that set each; `code` is the reference
    to the class, `template` the text of a template. Both are empty for a class that is to be
    written by hand, as `obstacle` says."""

    name: str
    leaf: Leaf
    construction: Construction
    place: str
    code: str = ""
    template: str = ""
    obstacle: str = ""
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

    def of(self, leaf: Leaf, construction: Construction) -> tuple[str, dict[str, list[Argument]]]:
        """The name of the state type of a state, and the variables of the state. A variable with
        several arguments is a list of them."""
        variables, listed = _variables(construction)
        which = (
            construction.cls, construction.library, construction.short, construction.file,
            construction.obstacle, listed, leaf.open,
            outcome_names(leaf), tuple((key.name, is_optional(key)) for key in leaf.inputs),
            tuple(key.name for key in leaf.outputs),
            construction.span if construction.obstacle and not construction.file else None,
        )  # fmt: skip
        if which not in self.known:
            name = self._name(construction.short or leaf.name)
            made = ImportedType(
                name=name, leaf=leaf, construction=construction, obstacle=construction.obstacle,
                place=self.place(construction.cls_span or construction.span),
            )  # fmt: skip
            if not construction.obstacle:
                _set_code(made, variables, listed=listed)
            self.known[which] = made
        found = self.known[which]
        found.states += 1
        if found.obstacle:
            return found.name, {}
        for name in variables:
            found.variables[name] = found.variables.get(name, 0) + 1
        return found.name, variables

    def _name(self, word: str) -> str:
        base = re.sub(r"\W+", "_", word).strip("_")
        base = base if base.isidentifier() else f"State_{base}".rstrip("_")
        name, number = base, 2
        while name.casefold() in self.taken:
            name, number = f"{base}_{number}", number + 1
        self.taken.add(name.casefold())
        return name

    def files(self) -> dict[str, str]:
        """The interfaces and templates of the state types, and the module of the classes that are
        to be written."""
        files: dict[str, str] = {}
        for made in self.known.values():
            files[f"templates/{made.name}.yml"] = _interface(made)
            if made.template:
                files[f"templates/{made.name}.tpl.py"] = made.template
        missing = [made for made in self.known.values() if made.obstacle]
        if missing:
            files[f"{TO_WRITE}.py"] = _to_write(missing)
        return files


def _variables(construction: Construction) -> tuple[dict[str, list[Argument]], bool]:
    """The variables of a state by name, and whether one of them lists all arguments that have no
    name."""
    found: dict[str, list[Argument]] = {}
    library = bool(construction.library)
    listed = any(not argument.name for argument in construction.arguments)
    for argument in construction.arguments:
        if library and argument.name in _INTERFACE:
            continue
        if not argument.name:
            found.setdefault("arguments", []).append(argument)
        else:
            found[variable_name(argument.name)] = [argument]
    return found, listed


def variable_name(parameter: str) -> str:
    """The name of the variable for a parameter: a script has some words for itself."""
    return f"{parameter}_argument" if parameter in RESERVED else parameter


def _set_code(made: ImportedType, variables: Mapping[str, object], *, listed: bool) -> None:
    """Sets the reference to the class, or the template."""
    construction = made.construction
    named = [argument.name for argument in construction.arguments if argument.name]
    renamed = any(variable_name(name) != name for name in named)
    if construction.cls is not None and not listed and not renamed:
        made.code = f"{construction.cls.module}:{construction.cls.name}"
        return
    cls = construction.library
    imports = ""
    if construction.cls is not None:
        cls = construction.cls.name
        imports = f"from {construction.cls.module} import {cls}"
    given = ["*arguments"] if listed else []
    if construction.library:
        leaf = made.leaf
        given += [f"{name}={variable_name(name)}" for name in dict.fromkeys(named)
                  if name not in _INTERFACE]  # fmt: skip
        given += [f"outcomes={[*outcome_names(leaf)]!r}"]
        given += [f"{name}={[key.name for key in keys]!r}" for name, keys in
                  (("input_keys", leaf.inputs), ("output_keys", leaf.outputs)) if keys]  # fmt: skip
    else:
        given += [f"{name}={variable_name(name)}" for name in dict.fromkeys(named)]
    block = f"{{% block imports %}}\n{{{{ super() }}}}\n{imports}\n{{% endblock imports %}}\n"
    made.template = (
        f'{{% extends "State.tpl.py" %}}\n{block if imports else ""}'
        f"{{% block body %}}\n{{{{ add({', '.join([quoted(cls), *given])}) }}}}\n"
        f"{{% endblock body %}}\n"
    )


def _interface(made: ImportedType) -> str:
    """The text of an interface."""
    leaf = made.leaf
    lines = [f"name: {name_text(made.name)}", f"doc: {quoted(f'Imported from {made.place}.')}"]
    if made.variables:
        needed = {
            name: "{}" if count == made.states else "{default: null}"
            for name, count in made.variables.items()
        }
        lines.append(f"variables: {mapping_text(needed)}")
    for word, keys in (("input_keys", leaf.inputs), ("output_keys", leaf.outputs)):
        if keys:
            lines.append(f"{word}: {keys_text(keys)}")
        elif leaf.open:
            lines.append(f'{word}: {{"*": {{}}}}')
    lines.append(f"outcomes: {mapping_text(dict.fromkeys(outcome_names(leaf), '{}'))}")
    code = made.code or f"{made.name}.tpl.py"
    if made.obstacle:
        code = f"{TO_WRITE}:{made.name}"
    lines.append(f"code: {{python: {quoted(code)}}}")
    return "\n".join(lines) + "\n"


def _to_write(missing: Iterable[ImportedType]) -> str:
    """The module with a class for each state that could not be taken over."""
    lines = [
        '"""The states that were not taken over: write `execute` of each."""', "",
        "try:", "    import smach", "except ImportError:  # without SMACH",
        "    from smachac.runtime import smach",
    ]  # fmt: skip
    for made in missing:
        leaf = made.leaf
        lists = {
            "outcomes": [*outcome_names(leaf)],
            "input_keys": [key.name for key in leaf.inputs],
            "output_keys": [key.name for key in leaf.outputs],
        }
        given = [f"            {name}={names!r}," for name, names in lists.items() if names]
        why = re.sub(r'[\\"]', "'", f"{made.place}: {made.obstacle}.")
        lines += [
            "", "", f"class {made.name}(smach.State):", f'    """{why}"""', "",
            "    def __init__(self):", "        super().__init__(", *given, "        )", "",
            "    def execute(self, userdata):",
            f"        raise NotImplementedError({made.place!r})",
        ]  # fmt: skip
    return "\n".join(lines) + "\n"


def code_of(argument: Argument) -> str:
    """The code in an argument, or an empty text."""
    return argument.data.text if isinstance(argument.data, Expression) else ""


def relative(path: str, folder: Path) -> str:
    """A path from a folder, with `/`."""
    return os.path.relpath(path, folder).replace(os.sep, "/")

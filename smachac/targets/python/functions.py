"""The functions of a generated module: the containers that are built in a function of their own.

A sub-script is a function, and so is a container that is large or deeply nested. Calls of a
sub-script that differ in a few values only are calls of one function, with parameters.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from keyword import iskeyword
from pathlib import PurePath

from smachac.ir.nodes import (
    Container,
    Data,
    Expression,
    Leaf,
    Machine,
    StateType,
    Struct,
)
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import containers, expressions, walk
from smachac.records import dataclass, field, replace

MOST_STATES = 8
"""The most states that a container has which is built inside the function of its parent."""

MOST_NESTED = 3
"""The most containers that are nested inside one function."""

MOST_NESTED_IN_ONE = 12
"""As MOST_NESTED, for programs that are one function. Python allows 20 nested blocks."""

CALLS = ("timeout", "retry")
"""The sugar that is a call around its state (sugar.py)."""

MOST_PARAMETERS = 5
"""The most parameters of a function. Calls with more differences get a function each."""

Place = tuple[str, str]
"""The path of a state and the name of a value of it: a variable, a key, or ITEMS."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Use:
    """A value that uses parameters of the program: its data, with the names of the parameters in
    code, and these names."""

    data: Data
    names: tuple[str, ...]


Uses = Mapping[Place, Use]
"""The values that use parameters of the program."""

ITEMS = "items"
"""The name of the items of an Iterator among its values."""

Inlined = Callable[[Container], bool]
"""Whether a container is never built in a function: a template of the user prints it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Function:
    """A function that builds a container.

    `key` identifies it: the path of the first container that it builds. `word` is its name without
    prefix and number, `variable` that of the container. `script` is the file of the sub-script, or
    empty. `doc` is the documentation that all its containers share. `parameters` are names by
    place, with paths from the container.
    """

    key: str
    word: str
    variable: str
    script: str = ""
    doc: str = ""
    parameters: Mapping[Place, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Call:
    """The call for one container: the function, and the value of each of its parameters."""

    function: Function
    arguments: Mapping[str, Data] = field(default_factory=dict)


Plan = Mapping[str, Call]
"""The containers that are built in functions, by path."""


def one_function(machine: Machine, inlined: Inlined, _uses: Uses) -> Plan:
    """The plan of a program that is one function, as SMACHA's are: a function only for what is
    nested too deeply."""
    return {
        path: Call(function=Function(key=path, word=name, variable=name))
        for path, name in (
            (path, variable_name(node))
            for path, node in _extracted(machine, inlined, MOST_NESTED_IN_ONE, None)
        )
    }


def functions(machine: Machine, inlined: Inlined, uses: Uses) -> Plan:
    """The plan of a program of functions. `uses`: its values that use parameters."""
    found = list(_extracted(machine, inlined, MOST_NESTED, MOST_STATES))
    shared = _shared(machine, found, inlined, uses)
    plan = {}
    for path, node in found:
        plan[path] = shared.get(path) or Call(function=_function(path, node))
    return plan


def script_of(node: Container) -> str:
    """The file of the sub-script that a container calls, without folders; empty if it calls none.
    The name of such a container stands in another file than its states."""
    file = node.children[0].span.source.name if node.children else node.span.source.name
    if file == node.span.source.name:
        return ""
    return PurePath(file.replace("\\", "/")).name


def _function(path: str, node: Container) -> Function:
    script, name = script_of(node), variable_name(node)
    word = PurePath(script).stem if script else name
    return Function(key=path, word=word, variable=name, script=script, doc=node.doc)


def variable_name(node: Container) -> str:
    """The name of the variable of a container, without prefix: that of the container. In the sugar
    of a state it begins with the name of the state."""
    state = name_in_script(node)
    return node.name if state == node.name else f"{state}_{node.name}"


def _extracted(
    machine: Machine, inlined: Inlined, nested: int, states: int | None
) -> list[tuple[str, Container]]:
    """The containers that get a function, in the order of the script. `states` is the most states
    of others; without it, only the depth counts."""
    found = []
    below: dict[str, tuple[int, int]] = {}
    """The depth and the number of states that a container adds to the function around it."""
    for path, node in reversed(list(containers(machine.root))):
        depth, count = 1, 0
        for child in node.children:
            inner, more = below.pop(f"{path}/{child.name}", (0, 0))
            depth, count = max(depth, inner + 1), count + more + 1
        if node.sugar in CALLS:  # a call around its state
            below[path] = depth - 1, count - len(node.children)
            continue
        large = states is not None and (count > states or script_of(node) != "")
        if path != machine.root.name and (large or depth >= nested) and not inlined(node):
            found.append((path, node))
            depth = count = 0
        below[path] = (depth, count)
    return found[::-1]


# Functions for several calls


@dataclass(frozen=True, slots=True, kw_only=True)
class _Value:
    """A value in a container, by its path in it. `text` identifies it: equal numbers of different
    types differ in it."""

    state: str
    name: str
    data: Data

    @property
    def text(self) -> str:
        return repr(self.data)


def _shared(
    machine: Machine, found: Iterable[tuple[str, Container]], inlined: Inlined, uses: Uses
) -> dict[str, Call]:
    """The calls of functions that several calls of a sub-script share, by path."""
    same_place: dict[object, list[tuple[str, Container]]] = {}
    for path, node in found:
        if script := script_of(node):
            same_place.setdefault((script, node.children[0].span), []).append((path, node))
    groups = [group for group in same_place.values() if len(group) > 1]
    if not groups:
        return {}
    forms = _forms(machine, inlined)
    calls: dict[str, Call] = {}
    for group in groups:
        alike: dict[object, list[tuple[str, Container]]] = {}
        for path, node in group:
            if forms[path] is not None:
                alike.setdefault(forms[path], []).append((path, node))
        for occurrences in alike.values():
            if len(occurrences) > 1:
                calls |= _calls(occurrences, machine.state_types, uses)
    return calls


def _calls(
    occurrences: list[tuple[str, Container]], types: Mapping[str, StateType], uses: Uses
) -> dict[str, Call]:
    """The calls of one function for containers of one form; none if they differ in too much."""
    path, node = occurrences[0]
    columns = zip(*(_values(at, container, uses) for at, container in occurrences), strict=True)
    varying: dict[object, list[tuple[_Value, ...]]] = {}
    for number, column in enumerate(columns):
        texts = tuple(value.text for value in column)
        if len(set(texts)) > 1:
            # Two lists are never one object in a program, so that a state may change its own.
            plain = not any(isinstance(value.data, Expression | Struct | tuple) for value in column)
            varying.setdefault(texts if plain else number, []).append(column)
    if len(varying) > MOST_PARAMETERS:
        return {}
    taken = _words(node, types).union(*(use.names for use in uses.values()))
    parameters: dict[Place, str] = {}
    arguments: list[dict[str, Data]] = [{} for _ in occurrences]
    for equal in varying.values():
        name = _fresh_name(equal[0][0], taken)
        parameters |= {(column[0].state, column[0].name): name for column in equal}
        for given, value in zip(arguments, equal[0], strict=True):
            given[name] = value.data
    docs = {container.doc for _, container in occurrences}
    function = _function(path, node)
    function = replace(
        function,
        variable=function.word,
        doc=docs.pop() if len(docs) == 1 else "",
        parameters=parameters,
    )
    return {
        path: Call(function=function, arguments=given)
        for (path, _), given in zip(occurrences, arguments, strict=True)
    }


def _values(path: str, container: Container, uses: Uses) -> Iterator[_Value]:
    """The values in a container that may become parameters, in the order of the script."""
    for inner, node in walk(container):
        state = inner[len(container.name) :]
        values: list[tuple[str, Data]] = []
        if isinstance(node, Leaf):
            values += [(v.name, v.value.data) for v in node.variables if v.role != "callbacks"]
        else:
            values += [(preset.key, preset.value.data) for preset in node.userdata]
        if isinstance(node, IteratorNode) and node.items is not None and node.sugar not in CALLS:
            values.append((ITEMS, node.items.data))
        for name, data in values:
            use = uses.get((path + state, name))
            yield _Value(state=state, name=name, data=use.data if use is not None else data)


def _forms(machine: Machine, inlined: Inlined) -> dict[str, int | None]:
    """A number for the form of each container: all that its function prints, except the values that
    may become parameters. None if a template prints a state in it."""
    numbers: dict[object, int] = {}
    found: dict[str, int | None] = {}
    for path, node in reversed(list(containers(machine.root))):
        parts: list[object] = [_outside(node)]
        parts += [preset.key for preset in node.userdata]
        for child in node.children:
            inner = None
            if isinstance(child, Leaf):
                type_ = machine.state_types.get(child.type)
                if type_ is None or type_.prints_itself:
                    break
                callbacks = [v for v in child.variables if v.role == "callbacks"]
                parts += [v.name for v in child.variables]
                parts.append(repr([v.value.data for v in callbacks]))
                if child.variables or child.claims:
                    child = replace(child, variables=(), claims=())
            else:
                inner = found[f"{path}/{child.name}"]
                if inner is None or inlined(child):
                    break
                child = replace(_bare(child), claims=())
            parts += [inner, child.span, child]
        else:
            found[path] = numbers.setdefault(tuple(parts), len(numbers))
            continue
        found[path] = None
    return found


def _outside(node: Container) -> Container:
    """A container without its states, its values, and what the function of its parent prints."""
    return replace(_bare(node), name="", doc="", transitions=(), remaps=(), claims=(), catches="")


def _bare(node: Container) -> Container:
    """A container without its states and values."""
    node = replace(node, children=(), userdata=())
    if isinstance(node, IteratorNode) and node.items is not None and node.sugar not in CALLS:
        node = replace(node, items=replace(node.items, data=None))
    return node


def _words(container: Container, types: Mapping[str, StateType]) -> set[str]:
    """The words that the code of a container may use as names."""
    found = {"smach"}
    for _, node in walk(container):
        found |= {
            node.type,
            *_WORD.findall(" ".join(expression.text for expression in expressions(node))),
        }
        if node.type in types:
            found |= set(_WORD.findall(types[node.type].code.get("python", "")))
    return found


_WORD = re.compile(r"\w+")


def _fresh_name(value: _Value, taken: set[str]) -> str:
    """A name for a parameter: that of its value, if necessary after that of its state. It is added
    to `taken`."""
    state = value.state.rpartition("/")[2]
    for name in (value.name, f"{state}_{value.name}".lower().lstrip("_")):
        if name not in taken and _is_plain(name):
            break
    else:
        number = 1
        while (name := f"value_{number}") in taken:
            number += 1
    taken.add(name)
    return name


def _is_plain(name: str) -> bool:
    """Whether a name is that of a variable: lower case, as no variable of a container begins."""
    return (
        name.isascii()
        and name.isidentifier()
        and not iskeyword(name)
        and name == name.lower()
        and not name.startswith(("_", "sm_", "build_"))
    )


# What templates print


def stand_alone(
    tree: ast.Module, functions: Collection[str], apart: Collection[str], *, with_names: bool
) -> bool:
    """Whether a module has these functions, each name once; those `apart` are not in the tree.
    `with_names`: and none of them uses a variable of another one, as the text that a template of
    the user prints may do."""
    top = Counter(name for node in tree.body for name in _bound(node))
    top.update(apart)
    if any(top[name] != 1 for name in functions):
        return False
    if not with_names:
        return True
    variables: dict[str, set[str]] = {}
    used: dict[str, set[str]] = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name in functions:
            variables[node.name], used[node.name] = _names(node)
    everywhere = Counter(name for names in variables.values() for name in names)
    return not any(
        everywhere[name] and name not in variables[function] and name not in top
        for function, names in used.items()
        for name in names
    )


def _bound(statement: ast.stmt) -> Iterator[str]:
    """The names that a statement of a module binds."""
    if isinstance(statement, ast.FunctionDef | ast.ClassDef):
        yield statement.name
        return
    for node in ast.walk(statement):
        match node:
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
            case ast.alias(name=name, asname=other):
                yield other or name


def _names(function: ast.FunctionDef) -> tuple[set[str], set[str]]:
    """The variables of a function, and all names that it uses."""
    variables: set[str] = set()
    used: set[str] = set()
    for node in ast.walk(function):
        match node:
            case ast.Name(id=name, ctx=ast.Load()):
                used.add(name)
            case ast.Name(id=name) | ast.arg(arg=name):
                variables.add(name)
    return variables, used

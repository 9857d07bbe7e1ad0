"""The module around a machine: what its states' templates bring, gathered into the base's."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from textwrap import indent

from smachac import problems
from smachac.ir.nodes import Container, Leaf, Machine
from smachac.ir.walk import own_outcomes, walk
from smachac.states import StateType, find_state_type
from smachac.targets import Context, made_by
from smachac.targets.blocks import BlockError, Blocks
from smachac.targets.python import body
from smachac.targets.python.expressions import standard_imports
from smachac.targets.python.layout import call, literal, names
from smachac.targets.python.smacha import plain, state_variables

APPENDED = ("base_header", "imports", "defs", "class_defs", "cb_defs", "main_def")
"""Blocks that come out in the order of the states."""

CATCHING = '''def error_as_outcome(state, outcome):
    """Let a state end with an outcome where it would raise an exception, which is logged."""

    def attempt(*userdata):
        try:
            return state.attempted(*userdata)
        except Exception as error:
            smach.logerr(traceback.format_exc(chain=False))
            state.caught = error
            return outcome

    state.attempted, state.execute = state.execute, attempt
    state.caught = None
    state.register_outcomes([outcome])
    return state'''
"""What stands in a module in which a state catches. Traces look at `caught`; `attempted` is what
a scenario replaces."""

PREPENDED = ("footer", "execute", "base_footer", "main")
"""Blocks that come out in reverse order, so that what was opened last is closed first."""

KEYED = ("header", "header_userdata")
"""Blocks that go to the container around the state, before its states."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Used:
    """A state type as this module uses it: its class, and the template that brings it.

    `whole`: the template prints its own `body`, as SMACHA's do, so all of it is rendered for each
    state; else the class is brought once.
    """

    type: StateType
    class_name: str
    template: str = ""
    whole: bool = False


@dataclass(slots=True)
class _Gathered:
    """What the states bring, by name of block, and what they share while they are printed."""

    blocks: Blocks
    context: Context
    fresh: Callable[[str, bool], str] = field(default_factory=body.variable_names)
    buffers: dict[str, list[str]] = field(
        default_factory=lambda: {name: [] for name in (*APPENDED, *PREPENDED)}
    )
    used: dict[str, _Used] = field(default_factory=dict)
    defined_headers: list[str] = field(default_factory=list)
    functions: list[str] = field(default_factory=list)


def module_text(machine: Machine, context: Context) -> str:
    """The text of the module. Raises BlockError when a template is at fault."""
    gathered = _Gathered(Blocks(context.library.template), context)
    root = gathered.fresh(machine.root.name, True)
    lines = _container(machine.root, None, root, 1, machine.root.name, gathered)
    if any(node.catches for _, node in walk(machine.root)):
        gathered.buffers["imports"].append("import traceback")
        gathered.buffers["defs"].append(CATCHING)
    buffers = {name: "\n\n\n".join(texts) for name, texts in gathered.buffers.items()}
    buffers["imports"] = _imports([*gathered.buffers["imports"], *standard_imports(machine)])
    variables = {
        **{variable.name: plain(variable.value.data) for variable in machine.variables},
        **buffers,
        "name": machine.root.name,
        "sm_name": root,
        "title": _title(machine),
        "made_by": f"# {made_by(machine)}",
        "body": indent(lines, "    "),
        "functions": "\n\n\n".join(gathered.functions),
        "defined_headers": gathered.defined_headers,
    }
    template = _base_template(machine, gathered)
    return gathered.blocks.render_whole(template, variables) + "\n"


def _title(machine: Machine) -> str:
    """The first line of the docstring: it must not end the string it stands in."""
    doc = machine.root.doc or f"The state machine `{machine.root.name}`."
    return doc.replace("\\", "\\\\").replace('"""', "'''").rstrip('"')


def _imports(texts: list[str]) -> str:
    """Import lines, each once: modules first, then names out of modules."""
    lines = {line.rstrip() for text in texts for line in text.splitlines() if line.strip()}
    return "\n".join(sorted(lines, key=lambda line: (line.startswith("from"), line)))


def _base_template(machine: Machine, gathered: _Gathered) -> str:
    for file in (f"{machine.base}.tpl.py", f"{machine.base}.tpl"):
        if gathered.blocks.source(file) is not None:
            return file
    message = f"the base `{machine.base}` has no template for Python"
    raise BlockError(problems.template_error(machine.root.span, message))


def _container(
    node: Container,
    parent: Container | None,
    variable: str,
    depth: int,
    path: str,
    gathered: _Gathered,
) -> str:
    """The lines of a container and all below it, relative to the block they stand in."""
    if depth % body.MOST_NESTED == 0:
        return _function(node, parent, variable, depth, path, gathered)
    header: list[str] = []
    states = []
    for child in body.children(node):
        below = f"{path}/{child.name}"
        if isinstance(child, Leaf):
            states.append(_leaf(child, node, variable, depth + 1, below, header, gathered))
        else:
            inner = gathered.fresh(child.name, False)
            states.append(_container(child, node, inner, depth + 1, below, gathered))
    variables = {
        "place": body.place(node),
        "name": node.name,
        "sm_name": variable,
        "construct": body.construct(node, variable, depth),
        "userdata": [*body.userdata(node, variable, depth), *header],
        "children": indent("\n\n".join(states) or "pass", "    "),
        "after": body.initial(node, variable),
        "add": body.add(node, parent, body.made(node, variable), depth)
        if parent is not None
        else "",
    }
    return gathered.blocks.render(f"{body.kind(node)}.tpl.py", "body", variables)


def _function(
    node: Container,
    parent: Container | None,
    variable: str,
    depth: int,
    path: str,
    gathered: _Gathered,
) -> str:
    """A container nested so deep that it gets a function of its own; the line that calls it."""
    inner = _container(node, None, variable, 1, path, gathered)
    text = f'def _{variable}():\n    """The container `{path}`."""\n{indent(inner, "    ")}'
    gathered.functions.append(f"{text}\n    return {variable}")
    assert parent is not None
    return body.add(node, parent, body.made(node, f"_{variable}()"), depth)


def _leaf(
    leaf: Leaf,
    parent: Container,
    variable: str,
    depth: int,
    path: str,
    header: list[str],
    gathered: _Gathered,
) -> str:
    used = _used(leaf, gathered)
    if used.whole:
        return _whole(leaf, parent, variable, path, used, header, gathered)
    arguments: body.Arguments = []
    if "outcomes" in used.type.given:
        arguments.append(("outcomes=", names(own_outcomes(leaf))))
    arguments += [(f"{one.name}=", literal(one.value.data)) for one in leaf.variables]
    given = used.type.given
    arguments += body.key_arguments(
        leaf.inputs if "input_keys" in given else (),
        leaf.outputs if "output_keys" in given else (),
    )
    variables = {
        "place": body.place(leaf),
        "name": leaf.name,
        "add": body.add(leaf, parent, body.made(leaf, call(used.class_name, arguments)), depth),
    }
    return gathered.blocks.render("State.tpl.py", "body", variables)


def _used(leaf: Leaf, gathered: _Gathered) -> _Used:
    """The state type of a leaf; at its first use what its template brings is gathered."""
    if leaf.type in gathered.used:
        return gathered.used[leaf.type]
    type_ = find_state_type(leaf.type, gathered.context.library, [])
    type_ = type_ or StateType(name=leaf.type, open=True)
    code = type_.code.get("python", f"{leaf.type}.tpl.py")
    if ":" in code:
        module, _, class_name = code.partition(":")
        gathered.buffers["imports"].append(f"from {module} import {class_name}")
        used = _Used(type=type_, class_name=class_name)
    elif gathered.blocks.source(code) is None:
        message = f"state type `{leaf.type}` has no code for Python"
        raise BlockError(problems.template_error(leaf.span, message, f"`{code}` was looked for"))
    else:
        found = gathered.blocks.names(code)
        used = _Used(
            type=type_,
            class_name=re.sub(r"\W+", "_", leaf.type),
            template=code,
            whole="body" in found,
        )
        if not used.whole:
            _gather(code, {"class_name": used.class_name}, gathered)
    gathered.used[leaf.type] = used
    return used


def _gather(template: str, variables: dict[str, object], gathered: _Gathered) -> None:
    """Put the blocks of a template to those of the same name."""
    variables = {"defined_headers": gathered.defined_headers, **variables}
    found = gathered.blocks.names(template)
    for name in (*APPENDED, *PREPENDED):
        if name not in found:
            continue
        text = gathered.blocks.render(template, name, variables)
        buffer = gathered.buffers[name]
        if text.strip() and text not in buffer:  # templates share definitions by `extends`
            buffer.insert(0 if name in PREPENDED else len(buffer), text)


def _whole(
    leaf: Leaf,
    parent: Container,
    variable: str,
    path: str,
    used: _Used,
    header: list[str],
    gathered: _Gathered,
) -> str:
    """A state whose template prints itself, with the variables SMACHA gave it."""
    if leaf.catches:
        message = f"the template of `{leaf.type}` prints its states itself, so that `{leaf.name}`"
        help = "take the block `body` out of the template, or put the state into a StateMachine"
        message += " cannot end with its exceptions"
        raise BlockError(problems.template_error(leaf.span, message, help))
    variables = state_variables(leaf, parent, variable)
    variables["uuid"] = hashlib.sha256(path.encode()).hexdigest()[:32]
    variables["defined_headers"] = gathered.defined_headers
    _gather(used.template, variables, gathered)
    found = gathered.blocks.names(used.template)
    for name in KEYED:
        if name in found:
            header.extend(gathered.blocks.render(used.template, name, variables).splitlines())
    text = gathered.blocks.render(used.template, "body", variables)
    return f"# {body.place(leaf)}\n{text}"

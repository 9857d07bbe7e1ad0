"""The containers and states of a machine, each printed by us or by a template of the user's."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from textwrap import indent

from smachac.frontend import schema
from smachac.frontend.errors.references import template_error
from smachac.frontend.state_types import StateType, find_state_type
from smachac.ir.leaf import CALLING, variable
from smachac.ir.nodes import Container, Data, Iterator, Leaf, Node
from smachac.ir.traversal import own_outcomes
from smachac.targets.python import structure
from smachac.targets.python.add_call import NotAddedError, adapted
from smachac.targets.python.buffers import KEYED, PREPENDED, Buffers, Gathered, Used, buffers
from smachac.targets.python.formatter import call, literal, names
from smachac.targets.python.smacha_context import adding, container_variables, state_variables
from smachac.targets.templates.engine import BlockError, Page

_PRESET = re.compile(r"\s*\w+\.userdata\.(\w+) = ")
"""A line by which a state's template sets userdata; the container has set it already."""

WITH_CALLBACKS = '''def with_callbacks(state, callbacks):
    """Let a state first call functions of its userdata, each for the key of its name."""

    def call_and_execute(userdata):
        for key in sorted(callbacks):
            function = callbacks[key]
            if not smach.has_smach_interface(function):
                userdata[key] = function(userdata)
            else:  # it writes its keys itself
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return execute(userdata)

    execute, state.execute = state.execute, call_and_execute
    return state'''
"""What stands in a module with a state of ours, other than CallbacksState, that has callbacks."""

DEFINED = "\n\n\n"
"""Between definitions."""

Headers = dict[str, dict[str, list[str]]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Inside:
    """Where a state is printed: the container, its variable, its path, how deep it stands.

    `headers` are the lines that states bring for containers, by block and name of the container.
    """

    node: Container
    variable: str
    path: str
    depth: int
    headers: Headers = field(default_factory=lambda: {name: {} for name in KEYED})

    def lines(self) -> list[str]:
        """The lines that belong before the states of this container."""
        return [line for name in KEYED for line in self.headers[name].get(self.node.name, ())]


def container(
    node: Container,
    parent: Inside | None,
    variable: str,
    depth: int,
    path: str,
    gathered: Gathered,
) -> str:
    """The lines of a container and all below it, relative to the block they stand in."""
    template = _own_template(node, gathered) if parent is not None else None
    if template is not None and parent is not None:
        return _by_template(node, parent, template, path, gathered)
    if depth % structure.MOST_NESTED == 0:
        return _function(node, parent, variable, depth, path, gathered)
    inside = Inside(node=node, variable=variable, path=path, depth=depth)
    states = children(inside, gathered)
    return gathered.blocks.render(
        "Container.tpl.py", "body", container_block(inside, parent, states)
    )


def container_block(inside: Inside, parent: Inside | None, states: str) -> dict[str, object]:
    """What our template of a container needs, with the lines that add its states."""
    node, variable, depth = inside.node, inside.variable, inside.depth
    return {
        "place": structure.place(node),
        "name": node.name,
        "sm_name": variable,
        "construct": structure.construct(node, variable, depth),
        "presets": [*structure.userdata(node, variable, depth), *inside.lines()],
        "children": indent(states or "pass", "    "),
        "after": structure.initial(node, variable),
        "add": structure.add(node, parent.node, structure.made(node, variable), depth)
        if parent is not None
        else "",
    }


def children(inside: Inside, gathered: Gathered) -> str:
    """The lines that add the states of a container."""
    states = []
    for child in structure.children(inside.node):
        below = f"{inside.path}/{child.name}"
        try:
            if isinstance(child, Leaf):
                states.append(_leaf(child, inside, below, gathered))
            else:
                variable = gathered.fresh(child.name, False)
                depth = inside.depth + 1
                states.append(container(child, inside, variable, depth, below, gathered))
        except BlockError as error:
            gathered.fault(error, child)
    return "\n\n".join(states)


def _own_template(node: Container, gathered: Gathered) -> str | None:
    """The template of the user's that prints a container; none for what sugar was made into."""
    if node.sugar or not node.type:
        return None
    library = gathered.context.library
    for file in (f"{node.type}.tpl.py", f"{node.type}.tpl"):
        if library.own_template(file) is not None:
            return file
    if node.type in schema.CONTAINERS:
        return None
    type_ = find_state_type(node.type, library, [])
    return type_.code.get("python") if type_ is not None else None


def _by_template(
    node: Container, parent: Inside, template: str, path: str, gathered: Gathered
) -> str:
    """A container that a template of SMACHA's kind prints, its states' blocks in its variables.

    What the template has no block for, or does not print there, goes on to the container around.
    """
    variables = container_variables(node, parent.node, parent.variable, path)
    variable = str(variables.get("sm_name", f"sm_{node.name.lower()}"))
    inside = Inside(node=node, variable=variable, path=path, depth=parent.depth + 1)
    outer, gathered.buffers = gathered.buffers, buffers()
    try:
        states = children(inside, gathered)
        inner, gathered.buffers = gathered.buffers, buffers()
        page = gathered.blocks.page(
            template,
            {
                **container_block(inside, parent, states), **variables, **joined(inner),
                **headers(inside), "body": states, "defined_headers": gathered.defined_headers,
            },
        )  # fmt: skip
        gathered.gather(page, node)
        for name, lines in inner.items():
            own = gathered.buffers[name]
            if name not in page.names or lost("\n".join(lines), "\n".join(own)):
                gathered.buffers[name] = {**lines, **own}
        _headers(page, parent, node, gathered)
        text = _adapted(gathered.code(page, "body", node), node, parent)
        if lost(states, text):
            span = gathered.blocks.block_span(template, "body") or node.span
            raise BlockError(template_error(span, *NO_BODY))
        return f"# {structure.place(node)}\n{text}"
    finally:
        _pass_on(gathered.buffers, outer)
        gathered.buffers = outer


def lost(inner: str, text: str) -> bool:
    """Whether nothing of what the states of a container bring is in what its template prints."""
    printed = {line.strip() for line in text.splitlines()}
    lines = [line.strip() for line in inner.splitlines() if line.strip()]
    return bool(lines) and printed.isdisjoint(lines)


NO_BODY = (
    "block `body` does not print `{{ body }}`: the states would be lost",
    "print `{{ body | indent(4) }}` in the `with` of the container",
)
"""Message and help where a container or base leaves its states out."""


def headers(inside: Inside) -> dict[str, object]:
    """The blocks that states bring for containers, as a template sees them."""
    return {
        block: {name: "\n".join(lines) for name, lines in texts.items()}
        for block, texts in inside.headers.items()
    }


def joined(texts: Buffers) -> dict[str, str]:
    """Buffers as a template sees them."""
    return {
        name: (DEFINED if name.endswith("defs") else "\n\n")
        .join(reversed(lines) if name in PREPENDED else lines)
        .strip()
        for name, lines in texts.items()
    }


def _pass_on(inner: Buffers, outer: Buffers) -> None:
    for name, texts in inner.items():
        outer[name].update(texts)


def _function(
    node: Container,
    parent: Inside | None,
    variable: str,
    depth: int,
    path: str,
    gathered: Gathered,
) -> str:
    """A container nested so deep that it gets a function of its own; the line that calls it."""
    inner = container(node, None, variable, 1, path, gathered)
    text = f'def _{variable}():\n    """The container `{path}`."""\n{indent(inner, "    ")}'
    gathered.functions.append(f"{text}\n    return {variable}")
    assert parent is not None
    return structure.add(node, parent.node, structure.made(node, f"_{variable}()"), depth)


def _leaf(leaf: Leaf, inside: Inside, path: str, gathered: Gathered) -> str:
    used = _used(leaf, gathered)
    if used.whole:
        return _whole(leaf, inside, path, used, gathered)
    arguments: structure.Arguments = []
    dropped = len(own_outcomes(leaf)) < len(used.type.outcomes)
    if "outcomes" in used.type.given or (used.type.optional and dropped):
        arguments.append(("outcomes=", names(own_outcomes(leaf))))
    callbacks = _called_first(leaf, used, gathered)
    arguments += [
        (f"{one.name}=", literal(one.value.data))
        for one in leaf.variables
        if callbacks is None or one.name != "callbacks"
    ]
    given = used.type.given
    arguments += structure.key_arguments(
        leaf.inputs if "input_keys" in given else (),
        leaf.outputs if "output_keys" in given else (),
    )
    made = structure.made(leaf, call(used.class_name, arguments), callbacks)
    return f"# {structure.place(leaf)}\n{structure.add(leaf, inside.node, made, inside.depth + 1)}"


def _called_first(leaf: Leaf, used: Used, gathered: Gathered) -> Data:
    """The functions that are called before a state of ours, which does not know of them."""
    data = variable(leaf, "callbacks")
    own = gathered.context.library.own_template(used.template) is not None
    if own or data is None or leaf.type not in CALLING or leaf.type == "CallbacksState":
        return None
    gathered.buffers["defs"][WITH_CALLBACKS] = None
    return data


def _used(leaf: Leaf, gathered: Gathered) -> Used:
    """The state type of a leaf; at its first use what its template brings is gathered."""
    if leaf.type in gathered.used:
        return gathered.used[leaf.type]
    type_ = find_state_type(leaf.type, gathered.context.library, [])
    type_ = type_ or StateType(name=leaf.type, open=True)
    code = type_.code.get("python", f"{leaf.type}.tpl.py")
    if ":" in code:
        module, _, class_name = code.partition(":")
        gathered.buffers["imports"][f"from {module} import {class_name}"] = None
        used = Used(type=type_, class_name=class_name)
    elif gathered.blocks.source(code) is None:
        message = f"state type `{leaf.type}` has no code for Python"
        raise BlockError(template_error(leaf.span, message, f"`{code}` was looked for"))
    else:
        found = gathered.blocks.names(code)
        used = Used(
            type=type_,
            class_name=re.sub(r"\W+", "_", leaf.type),
            template=code,
            whole="body" in found,
        )
        if not used.whole:
            variables: dict[str, object] = {
                "class_name": used.class_name,
                "defined_headers": gathered.defined_headers,
            }
            gathered.gather(gathered.blocks.page(code, variables), leaf)
    gathered.used[leaf.type] = used
    return used


def _whole(leaf: Leaf, inside: Inside, path: str, used: Used, gathered: Gathered) -> str:
    """A state whose template prints itself, with the variables SMACHA gave it."""
    own = gathered.context.library.own_template(used.template) is not None
    variables = state_variables(leaf, inside.node, inside.variable, path)
    variables["defined_headers"] = gathered.defined_headers
    if not own:  # ours take the keys of their interface beside those of the script
        variables["inputs"] = [key.name for key in leaf.inputs]
    callbacks = _called_first(leaf, used, gathered)
    variables["add"] = adding(leaf, inside.node, inside.depth + 1, callbacks)
    page = gathered.blocks.page(used.template, variables)
    gathered.gather(page, leaf)
    _headers(page, inside, leaf, gathered)
    text = gathered.code(page, "body", leaf)
    return f"# {structure.place(leaf)}\n{_adapted(text, leaf, inside) if own else text}"


def _adapted(text: str, node: Node, inside: Inside) -> str:
    """What a template of the user's prints for a state, where that has to stand in an Iterator or
    to catch its exceptions."""
    try:
        return adapted(text, node, inside.node, inside.depth + 1)
    except NotAddedError as error:
        message = f"the template of `{node.type}` {error}, so that `{node.name}` cannot"
        message += " stand in an Iterator" if isinstance(inside.node, Iterator) else ""
        message += "" if isinstance(inside.node, Iterator) else " end with its exceptions"
        help = "let it extend `State.tpl.py` without a block `body`, or print that line"
        raise BlockError(template_error(node.span, message, help)) from error


def _headers(page: Page, inside: Inside, node: Node, gathered: Gathered) -> None:
    """The lines that a state has for its container, without userdata that this has of itself."""
    presets = {preset.key.lower() for preset in inside.node.userdata}
    for name in KEYED:
        if name not in page.names:
            continue
        known = inside.headers[name].setdefault(inside.node.name, [])
        for line in gathered.code(page, name, node).splitlines():
            found = _PRESET.match(line)
            again = found is not None and (found[1].lower() in presets or line in known)
            if line.strip() and not again:
                known.append(line)

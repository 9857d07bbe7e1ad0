"""The code of the containers and states of a machine: from structure.py, or from a template of the
user."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import chain, count
from textwrap import indent

from smachac.analysis.code_slots import called_with_userdata
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import guesser
from smachac.frontend import schema
from smachac.frontend.errors.references import template_error
from smachac.frontend.resolved_script import TIMER
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import (
    NATIVE,
    Concurrence,
    Container,
    Data,
    Expression,
    Iterator,
    Leaf,
    Node,
    Sequence,
    StateType,
    Variable,
)
from smachac.ir.traversal import own_outcomes
from smachac.records import dataclass, field, replace
from smachac.targets.python import structure
from smachac.targets.python.add_call import NotAddedError, OtherContainerError, adapted
from smachac.targets.python.buffers import (
    KEYED,
    PREPENDED,
    Buffers,
    ModuleParts,
    PrintedFunction,
    UsedType,
    buffers,
)
from smachac.targets.python.formatter import (
    WIDTH,
    Doc,
    Group,
    call,
    docstring_lines,
    flat,
    laid_out,
    literal,
    names,
)
from smachac.targets.python.functions import ITEMS, Function, Use, Uses, variable_name
from smachac.targets.python.missing_templates import missing_template
from smachac.targets.python.ros import takes_node
from smachac.targets.python.smacha_context import (
    adding,
    container_variables,
    plain,
    state_variables,
)
from smachac.targets.python.sugar import Layer, layers, wrapped
from smachac.targets.templates.engine import BlockError, Page

_PRESET = re.compile(r"\s*\w+\.userdata\.(\w+) = ")
"""A line of a state's template that sets userdata, which the container may have set already."""

DEFINED = "\n\n\n"
"""The text between two definitions."""

Headers = dict[str, dict[str, list[str]]]


@dataclass(frozen=True, slots=True, kw_only=True)
class EmittedContainer:
    """The container whose states are printed: its node, its variable, its path and its depth in the
    function.

    `headers` are the lines that states add to containers, by block and name of the container.
    `uses` are the values that use parameters of the function.
    """

    node: Container
    variable: str
    path: str
    depth: int
    headers: Headers = field(default_factory=lambda: {name: {} for name in KEYED})
    uses: Uses = field(default_factory=dict)

    def lines(self) -> list[str]:
        """The header lines of this container, which precede its states."""
        return [line for name in KEYED for line in self.headers[name].get(self.node.name, ())]

    def value(self, path: str, name: str, data: Data) -> Doc:
        """The code of a value, with the names of the parameters that it uses."""
        use = self.uses.get((path, name))
        return literal(data if use is None else use.data)


@dataclass(frozen=True, slots=True, kw_only=True)
class Added:
    """A state to be added to a container: `outer` is the node with its name and transitions, which
    is the state itself or the outermost container of its sugar; `around` are the containers of
    sugar that are calls."""

    outer: Node
    around: list[Layer] = field(default_factory=list)

    def statement(
        self,
        node: Node,
        made: Doc,
        inside: EmittedContainer,
        module: ModuleParts,
        *,
        callbacks: Data = None,
        place: bool = True,
    ) -> str:
        """The statement that adds the state `node`, made by an expression, to a container. `place`:
        with its place in the script."""
        state = structure.made(node, made, module.additions, callbacks)
        whole = wrapped(state, self.around, module.additions)
        note = structure.place(self.outer) if place else ""
        return structure.add(self.outer, inside.node, whole, inside.depth + 1, note)


def _state(node: Node, inside: EmittedContainer, path: str, module: ModuleParts) -> str:
    """The code of a state with everything in it, without the indentation of its block."""
    around, inner, inner_path = layers(node, path, inside.value)
    if around and _is_added_by_template(inner, module):
        around, inner, inner_path = [], node, path
    added = Added(outer=node, around=around)
    if isinstance(inner, Leaf):
        return _leaf(inner, added, inside, inner_path, module)
    return _container(inner, added, inside, inner_path, module)


def _is_added_by_template(node: Node, module: ModuleParts) -> bool:
    """Whether a template of the user adds a state to its container, or defines the timer."""
    library = module.context.library
    if library.own_template(f"{TIMER}.tpl.py") is not None:
        return True
    if not isinstance(node, Leaf):
        return own_template(node, module) is not None
    used = _used(node, module)
    return used.whole and library.own_template(used.template) is not None


def _container(
    node: Container, added: Added, parent: EmittedContainer, path: str, module: ModuleParts
) -> str:
    template = own_template(node, module)
    if template is not None:
        return _by_template(node, parent, template, path, module)
    if path in module.plan:
        return _called(node, added, parent, path, module)
    inside = EmittedContainer(
        node=node,
        variable=module.fresh(variable_name(node), "sm_"),
        path=path,
        depth=parent.depth + 1,
        uses=parent.uses,
    )
    states = children(inside, module)
    notes = structure.documentation(added.outer.doc, inside.depth).rstrip("\n")
    add = added.statement(node, inside.variable, parent, module, place=False)
    block = container_block(inside, states, notes, add)
    return module.blocks.render("Container.tpl.py", "body", block)


def container_block(
    inside: EmittedContainer,
    states: str,
    notes: str = "",
    add: str = "",
    after: Iterable[str] = (),
    *,
    place: bool = True,
) -> dict[str, object]:
    """The variables of the built-in template of a container. `states` is the code of its states,
    `notes` the comment above it, `add` the statement that adds it to its container, and `after` are
    statements that follow its states. `place`: with the place of it in the script."""
    node, variable, depth = inside.node, inside.variable, inside.depth
    return {
        "place": structure.place(node),
        "notes": notes,
        "name": node.name,
        "sm_name": variable,
        "construct": structure.construct(
            node, variable, depth, _items(inside), structure.place(node) if place else ""
        ),
        "presets": [*structure.userdata(variable, depth, _presets(inside)), *inside.lines()],
        "children": indent(states or "pass", "    "),
        "after": [*structure.initial(node, variable), *after],
        "add": add,
    }


def _items(inside: EmittedContainer) -> Doc | None:
    """The items of an Iterator; None if they are userdata, and for other containers."""
    if not isinstance(inside.node, Iterator) or inside.node.items is None:
        return None
    data = inside.node.items.data
    items = inside.value(inside.path, ITEMS, data)
    if isinstance(data, Expression) and called_with_userdata(data.text):
        # SMACH calls a function without arguments for the items.
        return f"lambda: ({flat(items)})({inside.variable}.userdata)"
    return items


def _presets(inside: EmittedContainer) -> list[tuple[str, Doc]]:
    """The userdata that a container sets: keys and values."""
    return [
        (preset.key, inside.value(inside.path, preset.key, preset.value.data))
        for preset in inside.node.userdata
    ]


def children(inside: EmittedContainer, module: ModuleParts) -> str:
    """The code that adds the states of a container."""
    states = []
    for child in structure.children(inside.node):
        below = f"{inside.path}/{child.name}"
        try:
            states.append(_state(child, inside, below, module))
        except BlockError as error:
            module.fault(_in_container(error, inside.node), child)
    return "\n\n".join(states)


def own_template(node: Container, module: ModuleParts) -> str | None:
    """The template of the user that prints a container; None for a container made from sugar."""
    if node.sugar or not node.type:
        return None
    if node.type not in module.own_templates:
        module.own_templates[node.type] = _own_template(node.type, module)
    return module.own_templates[node.type]


def is_printed_by_template(module: ModuleParts, node: Container) -> bool:
    """Whether a template of the user prints a container."""
    return own_template(node, module) is not None


def _own_template(type_name: str, module: ModuleParts) -> str | None:
    library = module.context.library
    for file in (f"{type_name}.tpl.py", f"{type_name}.tpl"):
        if library.own_template(file) is not None:
            return file
    if type_name in schema.CONTAINERS:
        return None
    type_ = module.state_types.get(type_name)
    return type_.code.get("python") if type_ is not None else None


def _by_template(
    node: Container, parent: EmittedContainer, template: str, path: str, module: ModuleParts
) -> str:
    """The code of a container from a SMACHA template, whose variables are the blocks of its states.

    A block that the template lacks, or does not print, is passed on to the outer container.
    """
    variables = container_variables(node, parent.node, parent.variable, path)
    variable = str(variables.get("sm_name", f"sm_{node.name.lower()}"))
    inside = EmittedContainer(node=node, variable=variable, path=path, depth=parent.depth + 1)
    outer, module.buffers = module.buffers, buffers()
    try:
        states = children(inside, module)
        inner, module.buffers = module.buffers, buffers()
        made = structure.made(node, variable, module.additions)
        add = structure.add(node, parent.node, made, inside.depth)
        page = module.blocks.page(
            template,
            {
                **container_block(inside, states, add=add), **variables, **joined(inner),
                **headers(inside), "body": states, "defined_headers": module.defined_headers,
            },
        )  # fmt: skip
        module.gather(page, node)
        for name, lines in inner.items():
            own = module.buffers[name]
            if name not in page.names or lost("\n".join(lines), "\n".join(own)):
                module.buffers[name] = {**lines, **own}
        _headers(page, parent, node, module)
        text = _adapted(module.code(page, "body", node), node, parent, page, module)
        if lost(states, text):
            span = module.blocks.block_span(template, "body") or node.span
            raise BlockError(template_error(span, *NO_BODY, ("body",)))
        return f"{structure.notes(node, inside.depth)}\n{text}"
    finally:
        _pass_on(module.buffers, outer)
        module.buffers = outer


def lost(inner: str, text: str) -> bool:
    """Whether the text of a container's template has no line of the code of its states."""
    printed = {line.strip() for line in text.splitlines()}
    lines = [line.strip() for line in inner.splitlines() if line.strip()]
    return bool(lines) and printed.isdisjoint(lines)


NO_BODY = (
    "the block `body` does not print `{{ body }}`, so the states are missing",
    "print `{{ body | indent(4) }}` inside the `with` statement of the container",
)
"""Message and help for a template of a container or base that omits the states."""


def headers(inside: EmittedContainer) -> dict[str, object]:
    """The header lines for containers as template variables: text by block and container."""
    return {
        block: {name: "\n".join(lines) for name, lines in texts.items()}
        for block, texts in inside.headers.items()
    }


def joined(texts: Buffers) -> dict[str, str]:
    """Buffers as template variables: text by block."""
    return {
        name: (DEFINED if name.endswith("defs") else "\n\n")
        .join(reversed(lines) if name in PREPENDED else lines)
        .strip()
        for name, lines in texts.items()
    }


def _pass_on(inner: Buffers, outer: Buffers) -> None:
    for name, texts in inner.items():
        outer[name].update(texts)


def _called(
    node: Container, added: Added, parent: EmittedContainer, path: str, module: ModuleParts
) -> str:
    """The code that adds a container which a function of the module builds. The function is printed
    at its first call."""
    planned = module.plan[path]
    function = planned.function
    places = {
        (path + state, name): parameter for (state, name), parameter in function.parameters.items()
    }
    arguments: dict[str, Doc] = {
        parameter: parent.value(*place, planned.arguments[parameter])
        for place, parameter in places.items()
    }
    uses = {
        place: use
        for place, use in parent.uses.items()
        if place not in places and f"{place[0]}/".startswith(f"{path}/")
    }
    arguments |= {name: name for use in uses.values() for name in use.names}
    uses |= {
        place: Use(data=Expression(text=parameter, span=node.span), names=(parameter,))
        for place, parameter in places.items()
    }
    node_parameter = ["node"] if module.node else []
    if function.key not in module.functions:
        name = module.fresh(function.word, "build_")
        module.functions[function.key] = PrintedFunction(name=name)  # its place in the order
        variable = module.fresh(function.variable, "sm_")
        inside = EmittedContainer(node=node, variable=variable, path=path, depth=1, uses=uses)
        text = _function(name, [*node_parameter, *arguments], inside, function, module)
        module.functions[function.key] = PrintedFunction(name=name, text=text)
    name, depth = module.functions[function.key].name, parent.depth + 1
    given = [("", text) for text in node_parameter]
    made = call(
        name, [*given, *((f"{parameter}=", value) for parameter, value in arguments.items())]
    )
    doc = added.outer.doc if added.outer.doc != function.doc else ""
    add = added.statement(node, made, parent, module)
    return structure.documentation(doc, depth) + add


def _function(
    name: str,
    parameters: list[str],
    inside: EmittedContainer,
    function: Function,
    module: ModuleParts,
) -> str:
    """The function that builds a container."""
    states = children(inside, module)
    block = container_block(inside, states, place=False)
    lines = module.blocks.render("Container.tpl.py", "body", block)
    head = Group(f"def {name}(", tuple(("", parameter) for parameter in parameters), "):")
    kind = structure.WORDS[structure.kind(inside.node)]
    what = f"of `{function.script}`" if function.script else f"`{inside.node.name}`"
    doc = docstring_lines(f"Build the {kind} {what}.\n\n{function.doc}", WIDTH - 4)
    body = f"{doc}\n{lines}\nreturn {inside.variable}"
    return f"{laid_out(head, WIDTH)}\n{indent(body, '    ')}"


def _leaf(
    leaf: Leaf, added: Added, inside: EmittedContainer, path: str, module: ModuleParts
) -> str:
    used = _used(leaf, module)
    if used.whole:
        return _whole(leaf, added, inside, path, used, module)
    arguments: structure.Arguments = [("", "node")] if used.takes_node else []
    dropped = len(own_outcomes(leaf)) < len(used.type.outcomes)
    if "outcomes" in used.type.given or (used.type.optional and dropped):
        arguments.append(("outcomes=", names(own_outcomes(leaf))))
    called = _called_first(leaf, used, module)
    arguments += [
        (f"{one.name}=", inside.value(path, one.name, one.value.data))
        for one in leaf.variables
        if one is not called
    ]
    arguments += _required_defaults(leaf, used.type)
    given = used.type.given
    arguments += structure.key_arguments(
        leaf.inputs if "input_keys" in given else (),
        leaf.outputs if "output_keys" in given else (),
    )
    callbacks = called.value.data if called is not None else None
    made = call(used.class_name, arguments)
    wrapper = module.context.wrappers.get(leaf.type)
    if wrapper is not None:
        module.additions[wrapper] = None
        keys = structure.key_arguments(leaf.inputs, leaf.outputs)
        made = call(wrapper, [("", made), ("", names(own_outcomes(leaf))), *keys])
    add = added.statement(leaf, made, inside, module, callbacks=callbacks)
    return structure.documentation(added.outer.doc, inside.depth + 1) + add


def _defaults(type_: StateType) -> dict[str, object]:
    """The defaults of the interface, without null."""
    given = {name: fact.default for name, fact in type_.variables.items()}
    return {
        name: plain(default.data)
        for name, default in given.items()
        if default is not None and default.data is not None
    }


def _required_defaults(leaf: Leaf, type_: StateType) -> structure.Arguments:
    """The defaults of the interface for variables that the script does not set and the constructor
    of the class requires."""
    facts = type_.class_facts
    known = facts.parameters if facts is not None and not type_.built_in else None
    set_ = {one.name for one in leaf.variables}
    required = [parameter.word.text for parameter in known or () if parameter.required]
    defaults = {name: type_.variables[name].default for name in required if name in type_.variables}
    return [
        (f"{name}=", literal(default.data))
        for name, default in defaults.items()
        if default is not None and name not in set_
    ]


def _called_first(leaf: Leaf, used: UsedType, module: ModuleParts) -> Variable | None:
    """The functions that are called before a state whose class does not call them itself."""
    held = variable_of(leaf, "callbacks")
    known = used.type.variables.get(held.name) if held is not None else None
    if held is None or held.value.data is None or known is None or not known.called_first:
        return None
    return held


def _used(leaf: Leaf, module: ModuleParts) -> UsedType:
    """The state type of a leaf; its first use adds the blocks of its template to the module."""
    if leaf.type in module.used:
        return module.used[leaf.type]
    type_ = module.state_types.get(leaf.type) or StateType(name=leaf.type, open=True)
    code = type_.code.get("python", f"{leaf.type}.tpl.py")
    node = takes_node(type_, module.context.library, module.ros)
    if ":" in code:
        own = module.classes.setdefault(code, _own_name(code.partition(":")[2], leaf.type, module))
        used = UsedType(
            type=type_,
            class_name=own,
            takes_node=node,
        )
    elif module.blocks.source(code) is None:
        message = f"the state type `{leaf.type}` has no code for Python"
        named = 'python: "MODULE:CLASS"'
        has_code = type_.code or type_.classes
        way = f"add `{named}` to the `code`" if has_code else f"write `code: {{{named}}}`"
        help = f"add the template `{code}`, or {way} in `{leaf.type}.yml`"
        for target in NATIVE.keys() & type_.code.keys():
            help = f"it is a class of {NATIVE[target]}: build it with `--target {target}`, or {way}"
        package, _, class_ = code.rpartition(".")
        if package and not code.endswith((".py", ".tpl")):
            help = f'write `code: {{python: "{package}:{class_}"}}` in `{leaf.type}.yml`'
        first = module.without_code.setdefault(leaf.type, leaf.span)
        missing = missing_template(type_, module.context.library)
        raise BlockError(missing or template_error(first, message, help, (leaf.type,)))
    else:
        found = module.blocks.names(code)
        used = UsedType(
            type=type_,
            class_name=_class_name(leaf.type),
            template=code,
            whole="body" in found,
            takes_node=node,
        )
        if _is_imported(code, used.class_name, module):
            module.additions[used.class_name] = None
        elif not used.whole:
            variables: dict[str, object] = {
                "class_name": used.class_name,
                "defined_headers": module.defined_headers,
            }
            try:
                module.gather(module.blocks.page(code, variables), leaf)
            except BlockError as error:
                raise BlockError(_own_variable(error.diagnostic, type_)) from error
    module.used[leaf.type] = used
    module.names.named.add(used.class_name)
    return used


def _is_imported(template: str, class_name: str, module: ModuleParts) -> bool:
    """Whether the program imports the class of a built-in state type."""
    own = module.context.library.own_template(template) is not None
    return class_name in module.added.classes and not own and not module.standalone


def _own_variable(found: Diagnostic, type_: StateType) -> Diagnostic:
    """An undefined name in the class of a template, with the help for a variable of the interface:
    the class is printed once for all states of its type."""
    match found.finding.arguments:
        case ("undefined", name):
            near = name if name in type_.variables else guesser(type_.variables)(name)
            if near is not None:
                help = f"accept the parameter `{near}` in `__init__`, keep it as `self.{near}`, and"
                help += f" write `self.{near}` here: all states of the type share the class"
                return replace(found, finding=replace(found.finding, help=help))
    return found


def _unprinted_variable(found: Diagnostic, leaf: Leaf, type_: StateType) -> Diagnostic:
    """An undefined name in a template, with the only variable of the state that the template does
    not use: it is probably meant."""
    match found.finding.arguments:
        case ("undefined", name):
            used, own = type_.used, [variable.name for variable in leaf.variables]
            idle = [text for text in own if used is not None and text not in used]
            if len(idle) == 1 and guesser(own).unique_match(name) is None:
                help = f"did you mean `{idle[0]}`? `{leaf.name}` sets it, and the template does not"
                help += " use it"
                return replace(found, finding=replace(found.finding, help=help))
    return found


def _own_name(class_name: str, type_: str, module: ModuleParts) -> str:
    """The name of an imported class in the module: where another state type has a class of the same
    name, that of its own state type, or a number is added."""
    taken = {*module.classes.values()}
    taken |= {
        _class_name(name)
        for name, other in module.state_types.items()
        if name != type_ and ":" not in other.code.get("python", "")
    }
    candidates = (f"{class_name}_{number}" for number in count(2))
    return next(
        text for text in chain([class_name, _class_name(type_)], candidates) if text not in taken
    )


def _class_name(type_: str) -> str:
    """The name of the class of a state type with a template."""
    return re.sub(r"\W+", "_", type_)


def _whole(
    leaf: Leaf,
    added: Added,
    inside: EmittedContainer,
    path: str,
    used: UsedType,
    module: ModuleParts,
) -> str:
    """The code of a state whose template has a block `body`, from the variables of SMACHA."""
    own = module.context.library.own_template(used.template) is not None
    variables = state_variables(leaf, inside.node, inside.variable, path)
    variables["defined_headers"] = module.defined_headers
    for name in variables:
        if (path, name) in inside.uses:
            variables[name] = plain(inside.uses[path, name].data)
    if own:
        variables = {**_defaults(used.type), **variables}
    else:  # built-in templates take the keys of the interface beside those of the script
        variables["inputs"] = [key.name for key in leaf.inputs]
    called = _called_first(leaf, used, module)
    callbacks = called.value.data if called is not None else None
    variables["add"] = adding(
        lambda made: added.statement(leaf, made, inside, module, callbacks=callbacks, place=not own)
    )
    try:
        page = module.blocks.page(used.template, variables)
        module.gather(page, leaf)
        _headers(page, inside, leaf, module)
        text = module.code(page, "body", leaf)
    except BlockError as error:
        raise BlockError(_unprinted_variable(error.diagnostic, leaf, used.type)) from error
    if not own:
        return structure.documentation(added.outer.doc, inside.depth + 1) + text
    notes = structure.notes(added.outer, inside.depth + 1)
    return f"{notes}\n{_adapted(text, leaf, inside, page, module)}"


def _adapted(
    text: str, node: Node, inside: EmittedContainer, page: Page, module: ModuleParts
) -> str:
    """The text of a template of the user, completed for an Iterator and for caught exceptions."""
    try:
        return adapted(text, node, inside.node, inside.depth + 1, module.additions)
    except OtherContainerError as error:
        raise BlockError(_other_container(error.words, node, inside.node, page)) from error
    except NotAddedError as error:
        message = f"the template of `{node.type}` {error}, so `{node.name}` cannot"
        message += " be in an Iterator" if isinstance(inside.node, Iterator) else ""
        message += (
            "" if isinstance(inside.node, Iterator) else " have an outcome for its exceptions"
        )
        help = "extend `State.tpl.py` without a block `body`, or print this line in the template"
        raise BlockError(
            template_error(node.span, message, help, (node.type, node.name))
        ) from error


def _other_container(words: str, node: Node, parent: Container, page: Page) -> Diagnostic:
    """A template that adds its state to one kind of container, used in another."""
    kind = structure.kind(parent)
    found = template_error(
        page.blocks.text_span(page.file, words) or node.span,
        f"the template adds the state to a `{words.split('.')[1]}`, but `{node.name}` is in the"
        f" {kind} `{parent.name}`",
        "write `smach.{{ parent_type }}.add`",
        ("container", words, kind),
    )
    effect = f"the program stops with InvalidStateError: the open container is a {kind}"
    if isinstance(parent, Sequence) and "StateMachine" in words:
        effect = "the outcome that links the states of the sequence leads to no state"
    return replace(found, finding=replace(found.finding, effect=effect))


def _in_container(error: BlockError, parent: Container) -> BlockError:
    """An error in the template of a state; one for `transitions`, which a state in a Concurrence
    does not have, with the help for that."""
    found = error.diagnostic
    if found.finding.arguments != ("undefined", "transitions"):
        return error
    if not isinstance(parent, Concurrence):
        return error
    shown = _printed(found.span)
    finding = replace(
        found.finding,
        message="the template uses `transitions`, which a branch of a Concurrence does not have",
        help=f"write `{{% if transitions is defined %}}{shown}{{% endif %}}`",
    )
    return BlockError(replace(found, finding=finding))


def _printed(word: Span) -> str:
    """The expression of a template, with its braces, around a word; `...` if it is not clear."""
    text = word.source.text
    start, end = text.rfind("{{", 0, word.start), text.find("}}", word.end)
    inside = text[start : end + 2] if start >= 0 <= end else ""
    return inside if inside.count("{{") == inside.count("}}") == 1 and "\n" not in inside else "..."


def _headers(page: Page, inside: EmittedContainer, node: Node, module: ModuleParts) -> None:
    """Adds the header lines of a state to its container, without userdata that this sets."""
    presets = {preset.key.lower() for preset in inside.node.userdata}
    for name in KEYED:
        if name not in page.names:
            continue
        known = inside.headers[name].setdefault(inside.node.name, [])
        for line in module.code(page, name, node).splitlines():
            found = _PRESET.match(line)
            again = found is not None and (found[1].lower() in presets or line in known)
            if line.strip() and not again:
                known.append(line)

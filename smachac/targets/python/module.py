"""The module around a machine: what its states' templates bring, gathered into the base's."""

from __future__ import annotations

import ast
import re
from textwrap import indent

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.frontend.errors.references import template_error
from smachac.frontend.state_types import find_state_type
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk
from smachac.targets import BuildContext, made_by
from smachac.targets.errors import python_2_code
from smachac.targets.python.buffers import PREPENDED, Gathered
from smachac.targets.python.imports import (
    import_lines,
    standard_imports,
    unbound_names,
    with_fallback,
)
from smachac.targets.python.python2 import modern
from smachac.targets.python.smacha_context import FILTERS, TESTS, container_variables, plain
from smachac.targets.python.states import (
    NO_BODY,
    Inside,
    children,
    container_block,
    headers,
    joined,
    lost,
)
from smachac.targets.templates.engine import BlockError, Blocks

ONE_FUNCTION = {"Program.tpl.py": "Base.tpl.py", "ROSProgram.tpl.py": "ROSBase.tpl.py"}
"""What prints a program whose states bring code around its run: all of it in one function, where
such code sees its own names, as in SMACHA."""

NODE_IMPORTS = [f"import {name}" for name in ("os", "rospy", "signal", "threading", "time")]
"""What ROSNode.tpl.py uses."""

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


def module_text(machine: Machine, context: BuildContext, report: Report) -> str | None:
    """The text of the module; None where templates are at fault, which is reported."""
    shown = frozenset(
        name
        for option, names in (
            ("comments", ("upper_comments", "lower_comments")),
            ("introspection", ("introspection_server", "spin")),
        )
        if context.options.get(option, "no") == "yes"
        for name in names
    )
    blocks = Blocks(context.library.template, filters=FILTERS, tests=TESTS, shown=shown)
    gathered = Gathered(blocks, context)
    text = None
    try:
        text = _text(machine, context, gathered)
    except BlockError as error:
        gathered.fault(error, machine.root)
    report.extend(gathered.faults)
    return text


def _text(machine: Machine, context: BuildContext, gathered: Gathered) -> str | None:
    template = _base_template(machine, context, gathered)
    root = gathered.fresh(machine.root.name, True)
    inside = Inside(node=machine.root, variable=root, path=machine.root.name, depth=1)
    states = children(inside, gathered)
    if has_errors(gathered.faults):
        return None
    if any(node.catches for _, node in walk(machine.root)):
        gathered.buffers["imports"]["import traceback"] = None
        gathered.buffers["defs"][CATCHING] = None
    lines = gathered.blocks.render(
        "Container.tpl.py", "body", container_block(inside, None, states)
    )
    texts = joined(gathered.buffers)
    parts = [*texts.values(), lines, *gathered.functions]
    if template == "Program.tpl.py" and any(map(_NEEDS_NODE.search, parts)):
        template = "ROSProgram.tpl.py"
    if template in ONE_FUNCTION and any(texts[name] for name in PREPENDED):
        template = ONE_FUNCTION[template]
    modules = unbound_names(parts)
    imports = [*gathered.buffers["imports"], *standard_imports(machine), *modules]
    if template in ("ROSProgram.tpl.py", "ROSBase.tpl.py"):
        imports += NODE_IMPORTS
    variables: dict[str, object] = {
        **{variable.name: plain(variable.value.data) for variable in machine.variables},
        **container_variables(machine.root, None, "", machine.root.name),
        **headers(inside),
        **texts,
        "imports": import_lines(imports),
        "definitions": [
            "\n\n\n".join(gathered.buffers[name])
            for name in ("defs", "class_defs", "cb_defs")
            if gathered.buffers[name]
        ],
        "sm_name": root,
        "title": _title(machine),
        "made_by": f"# {made_by(machine)}",
        "body": states,
        "machine": indent(lines, "    "),
        "functions": "\n\n\n".join(gathered.functions),
        "defined_headers": gathered.defined_headers,
        "smach_ros": any("smach_ros." in part for part in parts),
        "introspection": context.options.get("introspection", "no") == "yes",
    }
    text = _rendered(template, variables, imports, gathered) + "\n"
    if lost(states, text):
        span = gathered.blocks.block_span(template, "body") or machine.root.span
        raise BlockError(template_error(span, *NO_BODY))
    return _checked(text, template, machine, gathered)


def _rendered(
    template: str, variables: dict[str, object], imports: list[str], gathered: Gathered
) -> str:
    """The base's template as a whole; once more where its own code, known only now, lacks imports
    or works in a node alone."""
    printed = gathered.defined_headers.copy()
    text = gathered.blocks.render_whole(template, variables)
    if template in ONE_FUNCTION:
        return text
    can_be = "node" in gathered.blocks.names(template) and "init_node" not in text
    is_node = can_be and _NEEDS_NODE.search(text) is not None
    more = NODE_IMPORTS if is_node else []
    lacking = unbound_names([modern(text)[0], *more], ["smach", "smach_ros"])
    if not lacking and not is_node:
        return text
    again = {
        **variables,
        "imports": import_lines([*imports, *lacking, *more]),
        "is_node": is_node,
        "defined_headers": printed,
    }
    return gathered.blocks.render_whole(template, again)


def _title(machine: Machine) -> str:
    """The first line of the docstring: it must not end the string it stands in."""
    doc = machine.root.doc or f"The state machine `{machine.root.name}`."
    return doc.replace("\\", "\\\\").replace('"""', "'''").rstrip('"')


def _base_template(machine: Machine, context: BuildContext, gathered: Gathered) -> str:
    type_ = find_state_type(machine.base, context.library, [])
    file = type_.code.get("python", "") if type_ is not None else ""
    if not file or gathered.blocks.source(file) is None:
        message = f"the base `{machine.base}` has no template for Python"
        raise BlockError(template_error(machine.root.span, message))
    return file


def _checked(text: str, template: str, machine: Machine, gathered: Gathered) -> str | None:
    """The module, tidied where its base is in SMACHA's style; None where it is no Python."""
    text, changes = modern(text)
    for line, change in changes:
        place = gathered.blocks.line_span(template, line) or machine.root.span
        gathered.note(python_2_code(place, change))
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        lines = text.splitlines()
        number = min(getattr(error, "lineno", None) or 1, len(lines))
        words = getattr(error, "msg", None) or str(error) or "it is nested too deep"
        line = lines[number - 1]
        place = gathered.blocks.line_span(template, line) or machine.root.span
        message = f"the base `{machine.base}` makes no Python: {words}"
        help = f"the line it prints is `{line.strip()}`"
        raise BlockError(template_error(place, message, help)) from error
    text = with_fallback(text, tree)
    tree = ast.parse(text)
    tidy = _TRAILING.sub("", _BLANKS.sub("\n\n\n", text))
    if tidy != text and ast.dump(ast.parse(tidy)) == ast.dump(tree):
        text = tidy
    mark = f"# {made_by(machine)}\n"
    if mark not in text:
        first = text.index("\n") + 1 if text.startswith("#!") else 0
        text = text[:first] + mark + text[first:]
    return text


_NEEDS_NODE = re.compile(
    r"\brospy\.(?:Publisher|Subscriber|Service|ServiceProxy|Timer|Rate|sleep|spin|on_shutdown"
    r"|get_param|wait_for_\w+)\b|\bsmach_ros\.|\bTF2ListenerSingleton\b"
)
"""Code that works in a node alone. SMACHA's first base made one for every program."""

_BLANKS = re.compile(r"\n(?:[ \t]*\n){3,}")
_TRAILING = re.compile(r"[ \t]+$", re.M)

"""The generated module: the template of the base, filled with the code of the machine."""

from __future__ import annotations

import ast
import re
from functools import partial
from textwrap import indent

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.frontend.errors.references import template_error
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk
from smachac.targets import BuildContext, made_by
from smachac.targets.errors import python_2_code
from smachac.targets.python import structure
from smachac.targets.python.buffers import PREPENDED, ModuleParts
from smachac.targets.python.formatter import WIDTH, docstring_lines
from smachac.targets.python.functions import functions, one_function, stand_alone
from smachac.targets.python.imports import (
    class_imports,
    import_lines,
    standard_imports,
    unbound_names,
    with_fallback,
)
from smachac.targets.python.python2 import modern
from smachac.targets.python.smacha_context import FILTERS, TESTS, container_variables, plain
from smachac.targets.python.states import (
    NO_BODY,
    EmittedContainer,
    children,
    container_block,
    headers,
    is_printed_by_template,
    joined,
    lost,
)
from smachac.targets.python.stop_requests import stop_functions, wrappers
from smachac.targets.python.template_sources import uses_own_templates
from smachac.targets.templates.engine import BlockError, Blocks

ONE_FUNCTION = {"Program.tpl.py": "Base.tpl.py", "ROSProgram.tpl.py": "ROSBase.tpl.py"}
"""The template for a program whose states add code around its run, by the usual template: the whole
program is one function, in which that code sees the names of the states, as in SMACHA."""

NODE_IMPORTS = [f"import {name}" for name in ("os", "rospy", "signal", "threading", "time")]
"""The imports of ROSNode.tpl.py."""

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
"""The function that a module contains if a state catches its exceptions. A trace reads `caught`;
a scenario replaces `attempted`."""


def module_text(machine: Machine, context: BuildContext, report: Report) -> str | None:
    """The text of the module; None if templates have errors, which are reported."""
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
    text, faults = None, report[:0]
    for plan in (functions, one_function):
        module = ModuleParts(blocks, context, machine.state_types)
        module.plan = plan(machine, partial(is_printed_by_template, module))
        module.wrappers = wrappers(machine)
        try:
            text = _text(machine, context, module, whole=plan is one_function)
        except BlockError as error:
            module.fault(error, machine.root)
        faults = module.faults
        if text is not None or has_errors(faults):
            break
    report.extend(faults)
    return text


def _text(
    machine: Machine, context: BuildContext, module: ModuleParts, *, whole: bool
) -> str | None:
    """The text of the module; None if there are errors, and if the program must be one function,
    unless it is planned so (`whole`)."""
    template = _base_template(machine, context, module)
    root = module.fresh(machine.root.name, "")
    inside = EmittedContainer(node=machine.root, variable=root, path=machine.root.name, depth=1)
    states = children(inside, module)
    if has_errors(module.faults):
        return None
    module.buffers["defs"] |= dict.fromkeys(stop_functions(machine, module.wrappers))
    if any(node.catches for _, node in walk(machine.root)):
        module.buffers["imports"]["import traceback"] = None
        module.buffers["defs"][CATCHING] = None
    notes = structure.notes(machine.root, 1, "")
    block = container_block(inside, None, states, notes, module)
    lines = module.blocks.render("Container.tpl.py", "body", block)
    texts = joined(module.buffers)
    built = [function.text for function in module.functions.values()]
    needed, own = class_imports(module.classes, context.levels)
    parts = [*texts.values(), own, lines, *built]
    if template == "Program.tpl.py" and any(map(_needs_node, parts)):
        template = "ROSProgram.tpl.py"
    if template in ONE_FUNCTION and any(texts[name] for name in PREPENDED):
        template = ONE_FUNCTION[template]
    modules = unbound_names(parts)
    imports = [*module.buffers["imports"], *standard_imports(machine), *modules, *needed]
    if template in ("ROSProgram.tpl.py", "ROSBase.tpl.py"):
        imports += NODE_IMPORTS
    variables: dict[str, object] = {
        **{variable.name: plain(variable.value.data) for variable in machine.variables},
        **container_variables(machine.root, None, "", machine.root.name),
        **headers(inside),
        **texts,
        "imports": _separate(import_lines(imports), own),
        "definitions": [
            "\n\n\n".join(module.buffers[name])
            for name in ("defs", "class_defs", "cb_defs")
            if module.buffers[name]
        ],
        "sm_name": root,
        "title": _title(machine),
        "made_by": f"# {made_by(machine)}",
        "body": states,
        "machine": indent(lines, "    "),
        "functions": "\n\n\n".join(built),
        "defined_headers": module.defined_headers,
        "smach_ros": any(_uses(part, _SMACH_ROS) for part in parts),
        "introspection": context.options.get("introspection", "no") == "yes",
    }
    text = _rendered(template, variables, imports, own, module) + "\n"
    if lost(states, text):
        span = module.blocks.block_span(template, "body") or machine.root.span
        raise BlockError(template_error(span, *NO_BODY, ("body",)))
    if built and not whole and texts["main_def"]:
        return None
    return _checked(text, template, machine, module, whole=whole)


def _rendered(
    template: str, variables: dict[str, object], imports: list[str], own: str, module: ModuleParts
) -> str:
    """The whole template of the base. It is rendered a second time if its own code, which is known
    only after the first, needs imports or a ROS node. `own` imports the classes of the user."""
    printed = module.defined_headers.copy()
    text = module.blocks.render_whole(template, variables)
    if template in ONE_FUNCTION:
        return text
    can_be = "node" in module.blocks.names(template) and "init_node" not in text
    is_node = can_be and _needs_node(text)
    more = NODE_IMPORTS if is_node else []
    lacking = unbound_names([modern(text)[0], *more], ["smach", "smach_ros"])
    if not lacking and not is_node:
        return text
    again = {
        **variables,
        "imports": _separate(import_lines([*imports, *lacking, *more]), own),
        "is_node": is_node,
        "defined_headers": printed,
    }
    return module.blocks.render_whole(template, again)


def _separate(*parts: str) -> str:
    """Texts with an empty line between them."""
    return "\n\n".join(filter(None, parts))


def _needs_node(text: str) -> bool:
    """Whether code needs a ROS node."""
    return _uses(text, _NEEDS_NODE)


def _uses(text: str, names: re.Pattern[str]) -> bool:
    """Whether code, not a comment or a string in it, uses one of the names."""
    if names.search(text) is None:
        return False
    try:
        tree = ast.parse(modern(text)[0])
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return True
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=owner), attr=name):
                used = f"{owner}.{name}"
            case ast.Name(id=used):
                pass
            case _:
                continue
        if names.match(used):
            return True
    return False


def _title(machine: Machine) -> str:
    """The docstring of the module, without its quotes."""
    doc = machine.root.doc or f"The state machine `{machine.root.name}`."
    return docstring_lines(doc, WIDTH).removeprefix('"""').removesuffix('"""')


def _base_template(machine: Machine, context: BuildContext, module: ModuleParts) -> str:
    type_ = machine.state_types.get(machine.base)
    file = type_.code.get("python", "") if type_ is not None else ""
    if not file or module.blocks.source(file) is None:
        message = f"the base `{machine.base}` has no template for Python"
        help = f"name a template under `code` in `{machine.base}.yml`"
        raise BlockError(template_error(machine.root.span, message, help, (machine.base,)))
    return file


def _checked(
    text: str, template: str, machine: Machine, module: ModuleParts, *, whole: bool
) -> str | None:
    """The module, without surplus blank lines and trailing spaces; None as in `_text`. Raises
    BlockError if it is no Python."""
    text, changes = modern(text)
    for old, new in changes:
        place = module.blocks.line_span(template, old) or machine.root.span
        module.note(python_2_code(place, old.strip(), new.strip()))
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        lines = text.splitlines()
        number = min(getattr(error, "lineno", None) or 1, len(lines))
        words = getattr(error, "msg", None) or str(error) or "it is nested too deeply"
        line = lines[number - 1]
        place = module.blocks.line_span(template, line) or machine.root.span
        message = f"the template of the base `{machine.base}` does not print valid Python: {words}"
        help = f"correct the printed line `{line.strip()}`"
        names = (machine.base, line.strip())
        raise BlockError(template_error(place, message, help, names)) from error
    if module.functions and not whole:
        named = ["build", *(each.name for each in module.functions.values())]
        own = uses_own_templates(machine, module.context.library)
        if not stand_alone(tree, named, with_names=own):
            return None
    text = with_fallback(text, tree)
    tree = ast.parse(text)
    lines = _BLANKS.sub("\n\n\n", text).split("\n")
    tidy = "\n".join(line.rstrip(" \t") for line in lines)
    if tidy != text and ast.dump(ast.parse(tidy)) == ast.dump(tree):
        text = tidy
    mark = f"# {made_by(machine)}\n"
    if mark not in text:
        first = text.index("\n") + 1 if text.startswith("#!") else 0
        text = text[:first] + mark + text[first:]
    return text


_SMACH_ROS = re.compile(r"\bsmach_ros\.")

_NEEDS_NODE = re.compile(
    r"\brospy\.(?:Publisher|Subscriber|Service|ServiceProxy|Timer|Rate|sleep|spin|on_shutdown"
    r"|get_param|wait_for_\w+)\b|\bsmach_ros\.|\bTF2ListenerSingleton\b"
)
"""Code of templates that needs a ROS node. SMACHA's first base made every program a node."""

_BLANKS = re.compile(r"\n(?:[ \t]*\n){3,}")

"""The generated module: the template of the base, filled with the code of the machine."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Mapping
from functools import partial
from textwrap import indent

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.frontend.errors.references import template_error
from smachac.ir.nodes import Machine
from smachac.ir.python_code import parse_module
from smachac.pysource.modules.ros_names import Ros
from smachac.pysource.templates.template_sources import template_finder, uses_own_templates
from smachac.targets import BuildContext, made_by
from smachac.targets.errors import python_2_code
from smachac.targets.python.additions import MODULE, Additions
from smachac.targets.python.buffers import PREPENDED, ModuleParts, printed_line_help
from smachac.targets.python.formatter import WIDTH, docstring_lines
from smachac.targets.python.functions import functions, one_function, stand_alone
from smachac.targets.python.imports import (
    ProgramNames,
    class_imports,
    expression_texts,
    import_lines,
    standard_imports,
    type_texts,
    unbound_names,
    with_fallback,
)
from smachac.targets.python.parameters import (
    NO_NODE,
    RESERVED,
    RosParameters,
    node_variables,
    ros_parameters,
    runs_once,
)
from smachac.targets.python.python2 import modern, parsed
from smachac.targets.python.ros import action_type, is_managed, is_node, standalone, version
from smachac.targets.python.smacha_context import TESTS, container_variables, filters, plain
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
from smachac.targets.python.stop_requests import passes_requests_on
from smachac.targets.templates.engine import BlockError, Blocks

ONE_FUNCTION = {"Program.tpl.py": "Base.tpl.py", "ROSProgram.tpl.py": "ROSBase.tpl.py"}
"""The template for a program whose states add code around its run, by the usual template: the whole
program is one function, in which that code sees the names of the states, as in SMACHA."""

MOST_BRACKETS = 80
"""The most brackets of code that is never nested too deeply for Python, which allows 200 levels: a
value of the script that contains the code has up to 100."""

STOP_IMPORTS = [f"import {name}" for name in ("os", "signal", "socket", "threading")]
"""The imports of a program that handles signals by itself (StopSignals.tpl.py)."""

SIGNALS = "from smachac.runtime import signals"
"""The import of a program that lets the bundled runtime handle signals."""

NODE_IMPORTS: Mapping[Ros, list[str]] = {
    1: [*STOP_IMPORTS, "import rospy", "import time"],
    2: ["from smachac.runtime.smach_ros2 import program"],
}
"""The imports of a program that is a node, by version of ROS."""


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
    ros = version(context)
    find = template_finder(context.library, ros)
    action = action_type(machine, context)
    is_standalone = standalone(context)
    additions = Additions()
    library = context.library
    blocks = Blocks(
        find,
        filters={**filters(ros), "addition": additions.text},
        tests=TESTS,
        shown=shown,
        is_own=lambda file: library.own_template(file) is not None,
    )
    text, faults = None, report[:0]
    for plan in (functions, one_function):
        module = ModuleParts(blocks, context, machine.state_types, ros)
        module.node = is_node(machine, context.library, ros)
        whole = plan is one_function
        settable = RosParameters()
        if module.node and not whole:
            settable = ros_parameters(machine, RESERVED)
        inlined = partial(is_printed_by_template, module)
        module.plan = plan(machine, inlined, settable.uses)
        module.action = action
        module.standalone, module.added = is_standalone, additions
        try:
            text = _text(machine, settable, module, whole=whole)
        except BlockError as error:
            module.fault(error, machine.root)
        faults = module.faults
        if text is not None or has_errors(faults):
            break
    report.extend(faults)
    return text


def _text(
    machine: Machine, settable: RosParameters, module: ModuleParts, *, whole: bool
) -> str | None:
    """The text of the module; None if there are errors, and if the program must be one function,
    unless it is planned so (`whole`)."""
    context = module.context
    template = _base_template(machine, context, module)
    root = module.fresh(machine.root.name, "")
    inside = EmittedContainer(
        node=machine.root, variable=root, path=machine.root.name, depth=1, uses=settable.uses
    )
    states = children(inside, module)
    if has_errors(module.faults):
        return None
    block = container_block(inside, states, after=_after(machine, root, module))
    _add_additions(module)
    lines = module.blocks.render("Container.tpl.py", "body", block)
    texts = joined(module.buffers)
    built = [function.text for function in module.functions.values()]
    needed, own = class_imports(module.classes, context.levels)
    parts = [*texts.values(), own, lines, *built]
    template = _program_template(template, parts, texts, module)
    uses_ros = any(_uses(part, _SMACH_ROS) for part in parts)
    introspection = context.options.get("introspection", "no") == "yes"
    expressions = expression_texts(machine)
    module.names.bound.add(root)
    imports = [
        *_imports(expressions, type_texts(machine), module),
        *needed,
        *_node_imports(template, settable, module, uses_ros=uses_ros or introspection),
    ]
    code, function_code = indent(lines, "    "), "\n\n\n".join(built)
    variables: dict[str, object] = {
        **{variable.name: plain(variable.value.data) for variable in machine.variables},
        **_simulated_robot(machine),
        **container_variables(machine.root, None, "", machine.root.name),
        **headers(inside),
        **texts,
        "imports": _separate(import_lines(imports), own),
        "definitions": _definitions(module),
        "sm_name": root,
        "title": _title(machine),
        "made_by": f"# {made_by(machine)}",
        "body": states,
        "machine": code,
        "functions": function_code,
        "defined_headers": module.defined_headers,
        "smach_ros": uses_ros,
        "introspection": introspection,
        "standalone": module.standalone,
        **(_node_variables(machine, settable, root, module)),
    }
    text = _rendered(template, variables, imports, own, module) + "\n"
    own_code = uses_own_templates(machine, context.library) and built and not whole
    deep = any(sum(map(expression.count, "([{")) > MOST_BRACKETS for expression in expressions)
    frame, left_out = _frame(text, () if deep or own_code else (code, function_code))
    if code not in left_out.values() and lost(states, text):
        span = module.blocks.block_span(template, "body") or machine.root.span
        raise BlockError(template_error(span, *NO_BODY, ("body",)))
    if built and not whole and texts["main_def"]:
        return None
    tidy, tree = _checked(frame, template, machine, module)
    named = [function.name for function in module.functions.values()] if not whole else []
    apart = named if function_code in left_out.values() else []
    if named and not stand_alone(tree, ["build", *named], apart, with_names=bool(own_code)):
        return None
    for statement, part in left_out.items():
        tidy = tidy.replace(statement, part)
    return tidy


def _after(machine: Machine, root: str, module: ModuleParts) -> list[str]:
    """The statement after the states of a machine in the variable `root`, if it is needed."""
    if not passes_requests_on(machine):
        return []
    module.additions["pass_on_stop_requests"] = None
    return [f"pass_on_stop_requests({root})"]


def _add_additions(module: ModuleParts) -> None:
    """Import what the module uses of runtime/additions.py, or add its text to the definitions."""
    if not module.additions:
        return
    if not module.standalone:
        module.buffers["imports"][f"from {MODULE} import {', '.join(module.additions)}"] = None
        return
    needed = module.added.needed(module.additions)
    module.buffers["imports"] |= dict.fromkeys(module.added.imports(needed))
    for name in needed:
        block = "class_defs" if name in module.added.classes else "defs"
        module.buffers[block][module.added.text(name)] = None


def _definitions(module: ModuleParts) -> list[str]:
    """The functions and classes of the module, those of one kind as one text."""
    kinds = (module.buffers[name] for name in ("defs", "class_defs", "cb_defs"))
    return ["\n\n\n".join(kind) for kind in kinds if kind]


def _program_template(
    template: str, parts: Iterable[str], texts: Mapping[str, str], module: ModuleParts
) -> str:
    """The template of the program: that of the base, unless the code of its states needs a node or
    adds code around the run."""
    node = module.node if module.ros == 2 else any(map(_needs_node, parts))
    if template == "Program.tpl.py" and node:
        template = "ROSProgram.tpl.py"
    if template in ONE_FUNCTION and any(texts[name] for name in PREPENDED):
        template = ONE_FUNCTION[template]
    return template


def _node_variables(
    machine: Machine, settable: RosParameters, root: str, module: ModuleParts
) -> Mapping[str, object]:
    """The variables of the template for a node."""
    if not module.node:
        return NO_NODE
    return node_variables(machine, settable, root, module.action, module.context.options)


def _node_imports(
    template: str, settable: RosParameters, module: ModuleParts, *, uses_ros: bool
) -> list[str]:
    """The imports of the code that starts the node, and of that for signals; `uses_ros`: with the
    states of smach_ros."""
    if template in ("Program.tpl.py", "Base.tpl.py"):
        return STOP_IMPORTS if module.standalone else [SIGNALS]
    if template not in ("ROSProgram.tpl.py", "ROSBase.tpl.py"):
        return []
    reads = settable.declared and not runs_once(module.context.options)
    more = ["from smachac.runtime.smach_ros2 import parameters"] if reads else []
    if template == "ROSProgram.tpl.py" and module.ros == 2:
        names = "smach, smach_ros" if uses_ros else "smach"
        more.append(f"from smachac.runtime.installed import {names}")
    if module.node and is_managed(module.context):
        more.append("from smachac.runtime.smach_ros2 import lifecycle")
    if module.action is not None:
        more.append(f"from {module.action.package}.action import {module.action.name}")
        more.append("from smachac.runtime.smach_ros2 import serving")
    return [*NODE_IMPORTS[module.ros], *more]


def _imports(expressions: list[str], types: set[str], module: ModuleParts) -> list[str]:
    """The imports that templates print, and those that the code of the script and of templates
    needs. `types` are the expressions that name types of messages."""
    read = [(text, parsed(text)) for text in expressions]
    trees = [(text, tree) for text, tree in read if isinstance(tree, ast.Module)]
    for text, tree in trees:
        module.names.add(tree, messages=text not in types)
    needed = unbound_names(module.names, module.ros, node=module.node)
    return [*module.buffers["imports"], *standard_imports(tree for _, tree in trees), *needed]


def _frame(text: str, parts: Iterable[str]) -> tuple[str, dict[str, str]]:
    """The program without its parts that were made of parsed code, and these parts by the statement
    that stands in place of each: to parse the code of a large machine again takes long.

    A part stays if the template prints it in another form, or if it is not tidy.
    """
    left_out: dict[str, str] = {}
    for number, part in enumerate(parts):
        tidy = not any(untidy in f"{part}\n" for untidy in (" \n", "\t\n", "\n\n\n\n"))
        margin = " " * (len(part) - len(part.lstrip(" ")))
        statement = f"{margin}pass  # part {number}"
        if part and tidy and part in text and statement not in text:
            text = text.replace(part, statement, 1)
            left_out[statement] = part
    return text, left_out


def _simulated_robot(machine: Machine) -> dict[str, object]:
    """The variable `robot` of a base that runs in the simulation, where it is another one than the
    script names: a URDF file with the joints of a built-in robot."""
    base, robot = machine.state_types.get(machine.base), machine.robot
    if base is None or not base.simulation or robot is None or not robot.description:
        return {}
    return {"robot": plain(robot.description)}


def _rendered(
    template: str, variables: dict[str, object], imports: list[str], own: str, module: ModuleParts
) -> str:
    """The whole template of the base. It is rendered a second time if its own code, which is known
    only after the first, needs imports or a ROS node. `own` imports the classes of the user."""
    printed = module.defined_headers.copy()
    text = module.blocks.render_whole(template, variables)
    if template in ONE_FUNCTION:
        return text
    can_be = module.ros == 1 and "node" in module.blocks.names(template)
    can_be = can_be and "init_node" not in text
    node = can_be and _needs_node(text)
    # The template of a user's base may extend that of a node of ROS 2.
    started = module.ros == 2 and "program.start_node(" in text and template != "ROSBase.tpl.py"
    more = NODE_IMPORTS[module.ros] if node or started else []
    if "signals.stop_at_signals(" in text and SIGNALS not in text:
        more = [*more, SIGNALS]
    names = ProgramNames()
    for tree in (modern(text).tree, *map(parsed, more)):
        if isinstance(tree, ast.Module):
            names.add(tree)
    lacking = unbound_names(names, module.ros, ["smach", "smach_ros"])
    if not lacking and not more:
        return text
    again = {
        **variables,
        "imports": _separate(import_lines([*imports, *lacking, *more]), own),
        "is_node": node,
        "defined_headers": printed,
    }
    return module.blocks.render_whole(template, again)


def _separate(*parts: str) -> str:
    """Texts with an empty line between them."""
    return "\n\n".join(filter(None, parts))


def _needs_node(text: str) -> bool:
    """Whether code needs a ROS node; most texts have none of these words."""
    words = ("rospy.", "smach_ros.", "TF2ListenerSingleton")
    return any(word in text for word in words) and _uses(text, _NEEDS_NODE)


def _uses(text: str, names: re.Pattern[str]) -> bool:
    """Whether code, not a comment or a string in it, uses one of the names."""
    if names.search(text) is None:
        return False
    try:
        tree = parse_module(modern(text)[0])
    except SyntaxError:
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
    text: str, template: str, machine: Machine, module: ModuleParts
) -> tuple[str, ast.Module]:
    """The module, without surplus blank lines and trailing spaces, and its tree. Raises BlockError
    if it is no Python."""
    text, changes, tree = modern(text)
    for old, new in changes:
        place = module.blocks.line_span(template, old) or machine.root.span
        module.note(python_2_code(place, old.strip(), new.strip()))
    if isinstance(tree, Exception):
        lines = text.splitlines()
        number = min(getattr(tree, "lineno", None) or 1, len(lines))
        words = getattr(tree, "msg", None) or str(tree) or "it is nested too deeply"
        line = lines[number - 1]
        place = module.blocks.line_span(template, line) or machine.root.span
        message = f"the template of the base `{machine.base}` does not print valid Python: {words}"
        help = printed_line_help(words, line.strip())
        names = (machine.base, line.strip())
        raise BlockError(template_error(place, message, help, names)) from tree
    text = with_fallback(text, tree)
    lines = _BLANKS.sub("\n\n\n", text).split("\n")
    tidy = "\n".join(line.rstrip(" \t") for line in lines)
    if tidy != text and ast.dump(parse_module(tidy)) == ast.dump(parse_module(text)):
        text = tidy
    mark = f"# {made_by(machine)}\n"
    if mark not in text:
        first = text.index("\n") + 1 if text.startswith("#!") else 0
        text = text[:first] + mark + text[first:]
    return text, tree


_SMACH_ROS = re.compile(r"\bsmach_ros\.")

_NEEDS_NODE = re.compile(
    r"\brospy\.(?:Publisher|Subscriber|Service|ServiceProxy|Timer|Rate|sleep|spin|on_shutdown"
    r"|get_param|wait_for_\w+)\b|\bsmach_ros\.|\bTF2ListenerSingleton\b"
)
"""Code of templates that needs a ROS node. SMACHA's first base made every program a node."""


_BLANKS = re.compile(r"\n(?:[ \t]*\n){3,}")

"""The generated module: the template of the base, filled with the code of the machine."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable
from textwrap import indent

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.frontend.errors.references import template_error
from smachac.ir.nodes import Machine
from smachac.ir.traversal import ends_preempted, walk
from smachac.targets import BuildContext, made_by
from smachac.targets.errors import python_2_code
from smachac.targets.python.buffers import PREPENDED, ModuleParts
from smachac.targets.python.formatter import docstring
from smachac.targets.python.imports import (
    Names,
    expression_texts,
    import_lines,
    standard_imports,
    unbound_names,
    with_fallback,
)
from smachac.targets.python.python2 import modern, parsed
from smachac.targets.python.smacha_context import FILTERS, TESTS, container_variables, plain
from smachac.targets.python.states import (
    NO_BODY,
    EmittedContainer,
    children,
    container_block,
    headers,
    joined,
    lost,
)
from smachac.targets.python.structure import stoppable
from smachac.targets.templates.engine import BlockError, Blocks

ONE_FUNCTION = {"Program.tpl.py": "Base.tpl.py", "ROSProgram.tpl.py": "ROSBase.tpl.py"}
"""The template for a program whose states add code around its run, by the usual template: the whole
program is one function, in which that code sees the names of the states, as in SMACHA."""

MOST_BRACKETS = 80
"""The most brackets of code that is never nested too deeply for Python, which allows 200 levels: a
value of the script that contains the code has up to 100."""

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


PASSING_ON = '''def withdraw(state):
    """Take back the unanswered stop requests of a state and of the states inside."""
    if state.preempt_requested():
        state.recall_preempt()
        for child in getattr(state, "get_children", dict)().values():
            withdraw(child)


def stoppable(container):
    """Let a container pass on every stop request, also an early one and a second one."""
    if not getattr(smach, "compat", True):  # the bundled runtime does so itself
        return container
    run, request = container.execute, container.request_preempt
    children = container.get_children
    concurrent = isinstance(container, smach.Concurrence)
    container.busy = container.asked = False

    def pass_on():
        for label in container.get_active_states() or list(children()):
            child = children().get(label)
            again = hasattr(child, "get_children")
            if child and (again or not child.preempt_requested()):
                child.request_preempt()

    def request_preempt():
        if not container.busy:
            return request()
        container.asked = True
        if not concurrent:
            smach.State.request_preempt(container)
        pass_on()

    def execute(*userdata):
        container.busy, container.asked = True, container.preempt_requested()
        if container.asked:
            pass_on()
        if concurrent:  # with its own request, SMACH for ROS 1 ends as preempted
            container.service_preempt()
        unanswered = True
        try:
            outcome = run(*userdata)
            unanswered = any(child.preempt_requested() for child in children().values())
            return outcome
        finally:
            container.busy = False
            for child in children().values():
                withdraw(child)
            if concurrent and container.asked and unanswered:
                request()

    if concurrent and container._child_termination_cb:
        ends = container._child_termination_cb

        def ends_others(outcomes):
            return not container.asked and ends(outcomes)

        container._child_termination_cb = ends_others
    container.execute, container.request_preempt = execute, request_preempt
    return container'''
"""The functions that a module contains if it has Iterators or Concurrences: SMACH itself does not
pass on a request to stop that comes before they run (rules P9, P10)."""

SECOND_REQUEST = '''def stoppable_again(machine):
    """Let a machine pass on a second stop request while the same container in it runs."""
    request, children = machine.request_preempt, machine.get_children

    def request_preempt():
        again = machine.preempt_requested() and getattr(smach, "compat", True)
        request()
        for label in machine.get_active_states() if again else ():
            if hasattr(children().get(label), "get_children"):
                children()[label].request_preempt()

    machine.request_preempt = request_preempt
    return machine'''
"""The function that a module contains if a machine has a container in it: SMACH itself does not
pass on a second request (rule P2)."""

STOPPING = '''def ends_preempted(container):
    """Let a time limit or loop end as preempted after a request to stop."""
    run, request = container.execute, container.request_preempt
    recall = container.recall_preempt

    def request_preempt():
        container.stopped = True
        request()

    def recall_preempt():
        container.stopped = False
        recall()

    def execute(*userdata):
        container.stopped = container.stopped or container.preempt_requested()
        try:
            outcome = run(*userdata)
            if container.stopped:
                container.service_preempt()
                outcome = "preempted"
            return outcome
        finally:
            container.stopped = False

    container.execute, container.stopped = execute, False
    container.request_preempt = request_preempt
    container.recall_preempt = recall_preempt
    return container'''
"""The function that a module contains if a state has a time limit, retries or a loop."""


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
    module = ModuleParts(blocks, context, machine.state_types)
    text = None
    try:
        text = _text(machine, context, module)
    except BlockError as error:
        module.fault(error, machine.root)
    report.extend(module.faults)
    return text


def _text(machine: Machine, context: BuildContext, module: ModuleParts) -> str | None:
    template = _base_template(machine, context, module)
    root = module.fresh(machine.root.name, True)
    inside = EmittedContainer(node=machine.root, variable=root, path=machine.root.name, depth=1)
    states = children(inside, module)
    if has_errors(module.faults):
        return None
    wrappers = {stoppable(node) for _, node in walk(machine.root)}
    for wrapper, text in (("stoppable", PASSING_ON), ("stoppable_again", SECOND_REQUEST)):
        if wrapper in wrappers:
            module.buffers["defs"][text] = None
    if any(ends_preempted(node) for _, node in walk(machine.root)):
        module.buffers["defs"][STOPPING] = None
    if any(node.catches for _, node in walk(machine.root)):
        module.buffers["imports"]["import traceback"] = None
        module.buffers["defs"][CATCHING] = None
    lines = module.blocks.render("Container.tpl.py", "body", container_block(inside, None, states))
    texts = joined(module.buffers)
    parts = [*texts.values(), lines, *module.functions]
    if template == "Program.tpl.py" and any(map(_needs_node, parts)):
        template = "ROSProgram.tpl.py"
    if template in ONE_FUNCTION and any(texts[name] for name in PREPENDED):
        template = ONE_FUNCTION[template]
    expressions = expression_texts(machine)
    module.names.bound.add(root)
    imports = _imports(expressions, module)
    if template in ("ROSProgram.tpl.py", "ROSBase.tpl.py"):
        imports += NODE_IMPORTS
    code, functions = indent(lines, "    "), "\n\n\n".join(module.functions)
    variables: dict[str, object] = {
        **{variable.name: plain(variable.value.data) for variable in machine.variables},
        **container_variables(machine.root, None, "", machine.root.name),
        **headers(inside),
        **texts,
        "imports": import_lines(imports),
        "definitions": [
            "\n\n\n".join(module.buffers[name])
            for name in ("defs", "class_defs", "cb_defs")
            if module.buffers[name]
        ],
        "sm_name": root,
        "title": _title(machine),
        "made_by": f"# {made_by(machine)}",
        "body": states,
        "machine": code,
        "functions": functions,
        "defined_headers": module.defined_headers,
        "smach_ros": any("smach_ros." in part for part in parts),
        "introspection": context.options.get("introspection", "no") == "yes",
    }
    text = _rendered(template, variables, imports, module) + "\n"
    deep = any(sum(map(each.count, "([{")) > MOST_BRACKETS for each in expressions)
    frame, left_out = _frame(text, () if deep else (code, functions))
    if code not in left_out.values() and lost(states, text):
        span = module.blocks.block_span(template, "body") or machine.root.span
        raise BlockError(template_error(span, *NO_BODY, ("body",)))
    text = _checked(frame, template, machine, module)
    for statement, part in left_out.items():
        text = text.replace(statement, part)
    return text


def _imports(expressions: list[str], module: ModuleParts) -> list[str]:
    """The imports that templates print, and those that the code of the script and of templates
    needs."""
    trees = [tree for tree in map(parsed, expressions) if isinstance(tree, ast.Module)]
    for tree in trees:
        module.names.add(tree)
    needed = unbound_names(module.names)
    return [*module.buffers["imports"], *standard_imports(trees), *needed]


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


def _rendered(
    template: str, variables: dict[str, object], imports: list[str], module: ModuleParts
) -> str:
    """The whole template of the base. It is rendered a second time if its own code, which is known
    only after the first, needs imports or a ROS node."""
    printed = module.defined_headers.copy()
    text = module.blocks.render_whole(template, variables)
    if template in ONE_FUNCTION:
        return text
    can_be = "node" in module.blocks.names(template) and "init_node" not in text
    is_node = can_be and _needs_node(text)
    more = NODE_IMPORTS if is_node else []
    names = Names()
    for tree in (modern(text).tree, *map(parsed, more)):
        if isinstance(tree, ast.Module):
            names.add(tree)
    lacking = unbound_names(names, ["smach", "smach_ros"])
    if not lacking and not is_node:
        return text
    again = {
        **variables,
        "imports": import_lines([*imports, *lacking, *more]),
        "is_node": is_node,
        "defined_headers": printed,
    }
    return module.blocks.render_whole(template, again)


def _title(machine: Machine) -> str:
    """The first line of the docstring, escaped so that it does not end the string."""
    doc = machine.root.doc or f"The state machine `{machine.root.name}`."
    return docstring(doc)


def _base_template(machine: Machine, context: BuildContext, module: ModuleParts) -> str:
    type_ = machine.state_types.get(machine.base)
    file = type_.code.get("python", "") if type_ is not None else ""
    if not file or module.blocks.source(file) is None:
        message = f"the base `{machine.base}` has no template for Python"
        help = f"name a template under `code` in `{machine.base}.yml`"
        raise BlockError(template_error(machine.root.span, message, help, (machine.base,)))
    return file


def _checked(text: str, template: str, machine: Machine, module: ModuleParts) -> str:
    """The module, without surplus blank lines and trailing spaces. Raises BlockError if it is no
    Python."""
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
        help = f"correct the printed line `{line.strip()}`"
        names = (machine.base, line.strip())
        raise BlockError(template_error(place, message, help, names)) from tree
    text = with_fallback(text, tree)
    lines = _BLANKS.sub("\n\n\n", text).split("\n")
    tidy = "\n".join(line.rstrip(" \t") for line in lines)
    if tidy != text and ast.dump(ast.parse(tidy)) == ast.dump(ast.parse(text)):
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
"""Code of templates that needs a ROS node. SMACHA's first base made every program a node."""


def _needs_node(text: str) -> bool:
    """Whether a text has such code; most texts have none of these words."""
    words = ("rospy.", "smach_ros.", "TF2ListenerSingleton")
    return any(word in text for word in words) and _NEEDS_NODE.search(text) is not None


_BLANKS = re.compile(r"\n(?:[ \t]*\n){3,}")

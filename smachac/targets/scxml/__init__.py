"""SCXML: one document in the ECMAScript data model, for any engine of W3C SCXML.

machine.py makes the states of containers, leaves.py those of leaves; expressions.py prints the
expressions of the script in JavaScript, over the functions in functions.js. A host runs the states
whose code is not in the script: `runtime/scxml/scion_host.js` is one for SCION.
"""

from __future__ import annotations

import re

from smachac.diagnostics.diagnostic import Report, has_errors, in_order
from smachac.ir.nodes import Checked, Leaf, Machine
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import outcome_names, walk
from smachac.targets import BuildContext, Files, OptionError, Target, made_by, stem
from smachac.targets.scxml.document import (
    Code,
    Comment,
    Element,
    element,
    functions_in,
    lines_of,
)
from smachac.targets.scxml.machine import datamodel, root
from smachac.targets.scxml.plan import Plan

HOST = "scion_host.js"

_EVENT = re.compile(r"[\w-]+")


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The document of a machine, `<name>.scxml`.

    Raises OptionError for an invalid value of an option.
    """
    given = context.options.get("trace", "false")
    if given not in ("true", "false"):
        raise OptionError(f"`trace` must be true or false, not `{given}`")
    found: Report = []
    text = document(machine, found, traced=given == "true")
    report.extend(in_order(found))
    return {} if has_errors(found) else {f"{stem(machine)}.scxml": text}


def document(machine: Machine, report: Report, *, traced: bool) -> str:
    """The text of the document; adds to `report` what SCXML cannot express. `traced`: it logs each
    event of a trace."""
    plan = Plan(machine, report, traced=traced)
    _refuse_structure(plan)
    if has_errors(report):
        return ""
    with deep_recursion():
        states = root(plan)
    texts = _texts(states)
    code = functions_in(texts)
    used = frozenset(word for text in [*texts, *code] for word in re.findall(r"\w+", text))
    data = datamodel(plan, used)
    script = element("script", Code("\n\n".join(code)))
    scxml = element(
        "scxml",
        data,
        script,
        *states,
        xmlns="http://www.w3.org/2005/07/scxml",
        version="1.0",
        datamodel="ecmascript",
        name=machine.root.name,
        initial=plan.ids[machine.root.name],
    )
    head = ['<?xml version="1.0" encoding="UTF-8"?>', f"<!-- {made_by(machine)} -->"]
    return "\n".join([*head, *lines_of(scxml), ""])


def _texts(states: list[Element | Comment]) -> list[str]:
    """The expressions and scripts of elements."""
    found = []
    todo: list[object] = [*states]
    while todo:
        node = todo.pop()
        if isinstance(node, str):
            found.append(node)
        elif isinstance(node, Element):
            found += [value for value in node.attributes.values() if value]
            todo += node.content
    return found


def _refuse_structure(plan: Plan) -> None:
    """Refuses containers without states, and outcomes that are no names of events."""
    for _, node in walk(plan.machine.root):
        if not isinstance(node, Leaf) and not node.children:
            plan.refuse(node.span, "a container without states", "add a state", node.name)
        for outcome in outcome_names(node) if isinstance(node, Leaf) else ():
            if not _EVENT.fullmatch(outcome):
                message = f"the outcome `{outcome}` is no name of an event"
                help_ = "use letters, digits, `_` and `-`"
                plan.refuse(node.span, message, help_, node.name, outcome)


TARGET = Target(
    name="scxml",
    description="a W3C SCXML document, whose states a host runs",
    emit=emit,
    lacks=(
        "Python code that is no portable expression; functions and modules as values",
        "tuples, `dict` of pairs, `str` of numbers that may be integers, powers of floats",
        "integers beyond 53 bits",
        "outcomes of states that are no names of events",
    ),
    options={"trace": "true: the document logs each event of a trace (default: false)"},
    runtime=lambda machine, context: {HOST: f"scxml/{HOST}"},
)

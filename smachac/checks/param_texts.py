"""Params of a script whose name is written as a text where the value of the param is meant."""

from __future__ import annotations

import re
from collections.abc import Mapping

from smachac.analysis.context import Context
from smachac.diagnostics.source import Span
from smachac.ir.nodes import Machine
from smachac.ir.traversal import expressions, walk

_PARAM_IN_CODE = re.compile(r"\bparams(?:\.|\[['\"])(\w+)")


_SUBSTITUTION = re.compile(
    r"\$\((?:(?:arg|param|var|optenv|env) )?\s*(\w+)\)|\$\{(?:params?[.:/])?(\w+)\}|\$(\w+)"
    r"|\{\{\s*(?:params?\.)?(\w+)\s*\}\}|\{(\w+)\}|<(\w+)>"
)
"""The value of a param in the syntax of other tools: launch files of ROS, shells, templates."""


def params_in_code(machine: Machine) -> set[str]:
    """The params that code of the script names as if they were variables: `params.limit`."""
    codes = [code.text for _, node in walk(machine.root) for code in expressions(node)]
    return {name for text in codes for name in _PARAM_IN_CODE.findall(text)}


def params_as_text(context: Context) -> Mapping[str, Span]:
    """The params that nothing uses and whose name is the value of a variable of a state, as a text,
    in one place; also in the syntax of other tools: `$(arg speed)`."""
    machine = context.machine
    names = {each.word.text for each in machine.unused if each.what == "param"}
    names -= params_in_code(machine) if names else set()
    found: dict[str, list[Span]] = {}
    for _, leaf in context.leaves_with_variables if names else ():
        for held in leaf.variables:
            data = held.value.data
            if not isinstance(data, str):
                continue
            other = _SUBSTITUTION.fullmatch(data)
            name = next(filter(None, other.groups())) if other is not None else data
            if name in names and (other is not None or data == held.value.span.text):
                found.setdefault(name, []).append(held.value.span)
    return {name: spans[0] for name, spans in found.items() if len(spans) == 1}


def look_up_help(name: str) -> str:
    """The help for a text that means the value of a param."""
    return f"write `[params, {name}]` for the value of the param"

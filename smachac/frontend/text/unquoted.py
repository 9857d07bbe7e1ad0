"""Shapes of texts that generated programs contain without quotes: names, types, functions.

A text of another shape would become code of its own. An interface gives the shape of a variable
(`unquoted: type`); the files and classes that it names have a shape as well.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from keyword import iskeyword

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Span
from smachac.frontend.errors.script import wrong_shape
from smachac.frontend.text.yaml_tree import Scalar, Tree
from smachac.ir.script_code import script_code

_NAME = r"[A-Za-z_][A-Za-z0-9_]*"
_QUALIFIED = rf"(?:::)?{_NAME}(?:::{_NAME})*"
_ANGLES = r"(?:<[\w:, <>]*>)?"
_HEADER = r"[\w./+-]+"
_CLASS = _QUALIFIED + _ANGLES
_PARAMETER = rf"(?:const +)?{_QUALIFIED}{_ANGLES}(?: *[&*] *| +){_NAME}"


def is_name(text: str) -> bool:
    """Whether a text is a name in Python."""
    return text.isidentifier() and not iskeyword(text)


def is_dotted(text: str) -> bool:
    """Whether a text is a name in Python, or several with dots between them."""
    return all(map(is_name, text.split(".")))


def is_ros_type(text: str) -> bool:
    """`std_srvs/Trigger`, `std_srvs/srv/Trigger`, `std_srvs.srv.Trigger` or `Trigger`."""
    return is_dotted(text.replace("/", "."))


def is_function(text: str) -> bool:
    """The name of a function, a lambda, or a call that returns a function; maybe in backticks."""
    text = text.strip()
    if len(text) > 2 and text[0] == text[-1] == "`":
        text = text[1:-1].strip()
    return is_dotted(text) or isinstance(script_code(text).tree, ast.Lambda | ast.Call)


def is_expression(text: str) -> bool:
    """Whether a text is an expression of Python on one line."""
    return "\n" not in text and "#" not in text and script_code(text.strip()).tree is not None


def is_header(text: str) -> bool:
    """The path of a C++ header, as in `#include "..."`."""
    return re.fullmatch(_HEADER, text, re.ASCII) is not None


def is_class(text: str) -> bool:
    """The qualified name of a C++ class."""
    return re.fullmatch(_CLASS, text, re.ASCII) is not None


def parameters(text: str) -> list[str]:
    """The texts between the commas that are not in angle brackets."""
    found, depth = [""], 0
    for character in text:
        depth += (character == "<") - (character == ">")
        if character == "," and depth == 0:
            found.append("")
        else:
            found[-1] += character
    return [text.strip() for text in found]


def are_parameters(text: str) -> bool:
    """Parameters of a C++ function, each a type and a name."""
    return all(
        re.fullmatch(_PARAMETER, parameter, re.ASCII) is not None for parameter in parameters(text)
    )


Shape = tuple[Callable[[str], bool], str, str]
"""The test of a shape, its name with an article, and an example."""

SHAPES: Mapping[str, Shape] = {
    "name": (is_name, "a name in Python", "`run_robot`"),
    "type": (is_ros_type, "the name of a ROS type or of a class", "`std_srvs/Trigger`"),
    "function": (is_function, "a function", "`fill_request` or `lambda ud, request: request`"),
    "expression": (is_expression, "an expression of Python", "`folder() + '/block.urdf'`"),
    "header": (is_header, "the path of a C++ header", "`my_robot/grasp.hpp`"),
    "class": (is_class, "the qualified name of a C++ class", "`my_robot::Grasp`"),
    "with": (are_parameters, "parameters of a C++ function", "`my_robot::Arm &arm`"),
}

VARIABLE_SHAPES = ("name", "type", "function", "expression")
"""The shapes that an interface may give to a variable."""


def check_unquoted(tree: Tree, shape: str, report: Report) -> None:
    """Reports a value that has not a shape of `SHAPES`; null has any shape."""
    fits, what, example = SHAPES[shape]
    if isinstance(tree, Scalar) and tree.value is None:
        return
    if isinstance(tree, Scalar) and isinstance(tree.value, str) and fits(tree.value):
        return
    if shape == "function" and isinstance(tree, Scalar) and _reads_userdata(str(tree.value)):
        return  # SM316
    report.append(wrong_shape(tree.span, f"this must be {what}", f"write it as in {example}"))


def _reads_userdata(text: str) -> bool:
    """Whether a text is an expression with a usual name of userdata, such as `ud.n > 0`."""
    tree = script_code(text.strip().strip("`")).tree
    names = (node.id for node in ast.walk(tree) if isinstance(node, ast.Name)) if tree else ()
    return any(name in ("ud", "userdata") for name in names)


def check_name(name: str, span: Span, report: Report) -> None:
    """Reports the name of a variable that is no name in Python."""
    if not is_name(name):
        message = f"the variable `{name}` must have a name that is one in Python"
        report.append(wrong_shape(span, message, "write letters, digits and `_`"))

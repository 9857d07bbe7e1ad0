"""The template context of SMACHA: the variables, tests and filters that its templates expect."""

from __future__ import annotations

import ast
import hashlib
import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from types import NoneType
from typing import Any

from smachac.ir.nodes import Concurrence, Container, Data, Expression, Leaf, Node, Struct, Variable
from smachac.ir.script_code import script_code
from smachac.ir.traversal import own_outcomes, remapping
from smachac.pysource.modules.ros_names import Ros
from smachac.targets.python.formatter import Doc, call, docstring, flat, literal, string
from smachac.targets.python.ros import replaced_names, ros_type


class CodeText(str):
    """A string that is code: it is printed without quotes, also inside a list."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


class ScriptText(str):
    """A string of the script that is text, even if it has the form of code."""

    __slots__ = ()


class Headers(list[str]):
    """`defined_headers`: a list of the definitions printed so far, with fast look-up."""

    def __init__(self, names: Iterable[str] = ()) -> None:
        super().__init__(names)
        self._known = set(self)

    def copy(self) -> Headers:
        """An independent list of the same names."""
        return Headers(self)

    def append(self, name: str) -> None:
        self._known.add(name)
        super().append(name)

    def __contains__(self, name: object) -> bool:
        return name in self._known


_TICKED = re.compile(r"`(.*)`", re.DOTALL)
_DOTTED = re.compile(r"\D+[.]\D+")


def is_dotted_or_call(text: str) -> bool:
    """Whether a text has the form of code for SMACHA: a dot between characters that are no digits,
    or parentheses on its first line."""
    line = text.partition("\n")[0]
    return _DOTTED.match(text) is not None or 0 <= line.find("(") < line.rfind(")")


def is_expression(value: object) -> bool:
    """SMACHA's test `expression`: a string in backticks, or code of a script."""
    if isinstance(value, CodeText):
        return True
    return isinstance(value, str) and _TICKED.fullmatch(value) is not None


def is_not_string(value: object) -> bool:
    """SMACHA's test `not_string`: a value that is printed without quotes.

    A string of a script is marked as text or code; another string is judged by its form.
    """
    if not isinstance(value, str) or isinstance(value, CodeText):
        return value is not None
    if isinstance(value, ScriptText) or value.startswith("'"):
        return False
    try:
        float(value)
    except ValueError:
        return is_dotted_or_call(value)
    return True


def without_ticks(value: object) -> object:
    """SMACHA's filter `exptostr`: the expression in backticks."""
    if not isinstance(value, str):
        return value
    return CodeText(_TICKED.sub(r"\1", value))


def as_literal(value: object) -> str:
    """A value as Python code, in double quotes where it is text."""
    return flat(literal(_data(value)))


def _data(value: object) -> Data:
    if isinstance(value, Mapping):
        return Struct(entries=tuple((str(key), _data(item)) for key, item in value.items()))
    if isinstance(value, list | tuple):
        return tuple(_data(item) for item in value)
    if isinstance(value, CodeText) or (isinstance(value, str) and is_not_string(value)):
        from smachac.diagnostics.source import NOWHERE

        return Expression(text=str(value), span=NOWHERE)
    if isinstance(value, str):
        quoted = len(value) > 1 and value[0] == value[-1] == "'"
        quoted = quoted and not isinstance(value, ScriptText)
        return value[1:-1] if quoted else str(value)
    return value if isinstance(value, int | float) or value is None else str(value)


TESTS: Mapping[str, Callable[..., Any]] = {
    "expression": is_expression,
    "not_string": is_not_string,
}


def ros_class(ros: Ros, value: object, module: str) -> CodeText:
    """The class that a ROS type names: `Trigger` of `std_srvs/Trigger`, `std_srvs.srv.Trigger`."""
    found = ros_type(str(value), module, ros)
    return CodeText(found.name if found is not None else value)


def ros_import(ros: Ros, value: object, module: str, code: object = "") -> str:
    """The import of a ROS type with a package name; empty for other types. `code` may use a related
    class of ROS 1, such as `TestGoal` beside `TestAction`."""
    found = ros_type(str(value), module, ros)
    if found is None:
        return ""
    text = code if isinstance(code, str) else ""
    parts = RELATED.get(module, ()) if ros == 1 else ()
    short = found.name.removesuffix("Action") if module == "action" else found.name
    names = [found.name, *(f"{short}{part}" for part in parts if f"{short}{part}(" in text)]
    return f"from {found.package}.{found.module} import {', '.join(names)}"


def ros_code(ros: Ros, code: object, value: object, module: str) -> object:
    """Code with the names that the parts of a ROS type have in a version of ROS: `TestGoal` in ROS
    1, `Test.Goal` in ROS 2."""
    found = ros_type(str(value), module, ros)
    if found is None or not isinstance(code, CodeText):
        return code
    short = found.name.removesuffix("Action") if module == "action" else found.name
    pairs = [(f"{short}{part}", f"{short}.{part}") for part in RELATED.get(module, ())]
    names = {new: old for old, new in pairs} if ros == 1 else dict(pairs)
    return CodeText(replaced_names(code, names))


def ros_fields(ros: Ros, value: object, text: object, module: str, part: str) -> object:
    """A message with the fields of a mapping: the code `filled(Test.Goal(), {...})`, in ROS 1
    `filled(TestGoal(), {...})`. `part` is the part of the service or action `text`."""
    if not isinstance(value, Mapping):
        return value
    name = ros_class(ros, text, module)
    message = f"{name}.{part}" if ros == 2 else f"{name.removesuffix('Action')}{part}"
    return CodeText(f"filled({message}(), {as_literal(value)})")


def checking(callback: object, kind: str) -> CodeText:
    """A callback of ROS 2 that calls another one, if there is one, and checks the message `kind`
    that the state sends: `checking(Test.Goal, fill)`. The states of SMACH's own smach_ros, which a
    program uses where it is installed, check nothing."""
    given = "" if callback is None else f", {without_ticks(callback)}"
    return CodeText(f"checking({kind}{given})")


RELATED = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
"""The parts of services and actions, which are messages."""


def filters(ros: Ros) -> dict[str, Callable[..., Any]]:
    """The filters of templates, for a version of ROS."""
    return {
        **FILTERS,
        "ros_class": partial(ros_class, ros),
        "ros_import": partial(ros_import, ros),
        "ros_code": partial(ros_code, ros),
        "ros_fields": partial(ros_fields, ros),
    }


def besides(keys: Any, slots: Any, *callbacks: Any) -> Any:
    """The keys that a state of ROS does not have by its slots; undefined if there are none. If it
    has callbacks, all keys are theirs too."""
    from jinja2 import Undefined

    absent = (Undefined, NoneType)
    if isinstance(keys, absent) or isinstance(slots, absent):
        return keys
    if not all(isinstance(callback, absent) for callback in callbacks):
        return keys
    return [key for key in keys if key not in slots] or Undefined()


FILTERS: Mapping[str, Callable[..., Any]] = {
    "besides": besides,
    "checking": checking,
    "exptostr": without_ticks,
    "literal": as_literal,
    "code": lambda value: CodeText(value) if isinstance(value, str) else value,
    "docstring": docstring,
    "word": lambda value: re.sub(r"\W", "_", str(value)),
    "quoted": lambda value: string(str(value)),
}


def plain(data: Data) -> object:
    """A value as Python data, with expressions and strings marked as CodeText and ScriptText."""
    match data:
        case Expression(text=text):
            return CodeText(text)
        case Struct(entries=entries):
            return {key: plain(value) for key, value in entries}
        case tuple():
            return [plain(item) for item in data]
        case str():
            return ScriptText(data)
    return data


def written(variables: Iterable[Variable]) -> dict[str, object]:
    """The values of variables by name. In `callbacks` the text of a lambda is code too."""
    found = {variable.name: plain(variable.value.data) for variable in variables}
    callbacks = found.get("callbacks")
    if isinstance(callbacks, dict):
        found["callbacks"] = {key: _function(callback) for key, callback in callbacks.items()}
    return found


def _function(value: object) -> object:
    is_lambda = isinstance(value, ScriptText) and isinstance(script_code(value).tree, ast.Lambda)
    return CodeText(value) if is_lambda else value


def stable_id(path: str) -> str:
    """The variable `uuid`: 32 hexadecimal digits that depend on the path of the state only."""
    return hashlib.sha256(path.encode("utf-8", "surrogatepass")).hexdigest()[:32]


def adding(added: Callable[[Doc], str]) -> Callable[..., str]:
    """The function `add` of templates: it returns the statement that adds an object of a class.
    `added` makes it of the expression for the object. Undefined named arguments are omitted."""

    def add(class_name: object, *values: object, **named: object) -> str:
        from jinja2 import Undefined

        arguments = [("", literal(_data(value))) for value in values]
        arguments += [
            (f"{name}=", literal(_data(value)))
            for name, value in named.items()
            if not isinstance(value, Undefined)
        ]
        return added(call(str(class_name), arguments))

    return add


def place_variables(parent: Container, parent_sm_name: str, path: str) -> dict[str, object]:
    """The variables for the position of a state in its machine."""
    return {
        "uuid": stable_id(path),
        "parent_name": parent.name,
        "parent_sm_name": parent_sm_name,
        "parent_type": type(parent).__name__,
        "parent_template": parent.type,
    }


def edges(node: Node, parent: Container | None) -> dict[str, object]:
    """The variables `transitions` and `remapping`, unless empty. In a Concurrence there are no
    transitions: its `add` has no such parameter."""
    steps = {edge.outcome: edge.target for edge in node.transitions if edge.origin == "written"}
    remaps = remapping(node)
    found = {"transitions": {} if isinstance(parent, Concurrence) else steps, "remapping": remaps}
    return {name: value for name, value in found.items() if value}


def state_variables(
    leaf: Leaf, parent: Container, parent_sm_name: str, path: str
) -> dict[str, object]:
    """The variables of a leaf's template: those of the script, and its position."""
    variables = written(leaf.written)
    # With sugar these two belong to the container that was made around the state.
    variables.pop("transitions", None)
    variables.pop("remapping", None)
    return {
        **variables,
        **edges(leaf, parent),
        **place_variables(parent, parent_sm_name, path),
        "name": leaf.name,
        "class_name": leaf.type,
    }


def container_variables(
    node: Container, parent: Container | None, parent_sm_name: str, path: str
) -> dict[str, object]:
    """The variables of a container's template; without a parent, those of the base's template."""
    variables: dict[str, object] = {
        "outcomes": list(own_outcomes(node)),
        "input_keys": [key.name for key in node.inputs],
        "output_keys": [key.name for key in node.outputs],
        "userdata": {preset.key: plain(preset.value.data) for preset in node.userdata},
    }
    if isinstance(node, Concurrence):
        variables["default_outcome"] = node.default_outcome or node.rules[-1].outcome
        variables["outcome_map"] = {
            rule.outcome: {one.child: one.outcome for one in rule.when} for rule in node.rules
        }
    variables = {name: value for name, value in variables.items() if value or name == "outcomes"}
    around = place_variables(parent, parent_sm_name, path) if parent is not None else {}
    own = {"name": node.name, "class_name": node.type}
    variables |= edges(node, parent)
    return {**written(node.written), **variables, **around, **own}

"""The two versions of ROS in generated programs: names of types, and signs of a ROS node."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import either
from smachac.frontend.loader import Library
from smachac.frontend.types.smacha_meta import extended
from smachac.ir.nodes import Leaf, Machine, StateType
from smachac.ir.traversal import expressions, walk
from smachac.pysource.modules.ros_names import ROS_VERSIONS, Ros
from smachac.records import dataclass
from smachac.targets import BuildContext, OptionError
from smachac.targets.errors import unsupported_by_target

_WORDS = r"[/.]"

OTHER_MODULES = {
    1: ("rclpy", "rclpy_action", "rclpy_lifecycle"),
    2: ("rospy", "roslib", "rospkg", "rostopic", "actionlib", "rosbag"),
}
"""The Python modules that exist only in the other version of ROS."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RosType:
    """A type of ROS: its package, the module in it, and the name of its class."""

    package: str
    module: str
    name: str


def version(context: BuildContext) -> Ros:
    """The version of ROS of a program: that of the option, else that of the project."""
    match context.options.get("ros"):
        case None:
            return context.library.ros
        case "1":
            return 1
        case "2":
            return 2
        case other:
            raise OptionError(f"`ros` must be `1` or `2`, not `{other}`")


def action_type(machine: Machine, context: BuildContext) -> RosType | None:
    """The type of the action that a node offers its machine as, by the option. Raises
    OptionError."""
    value = context.options.get("action")
    if value is None:
        return None
    found = ros_type(value, "action", 2)
    if found is None:
        raise OptionError(f"`action` must be a type such as `my_msgs/action/Fetch`, not `{value}`")
    if not is_node(machine, context.library, version(context)):
        raise OptionError("`action` needs a node of ROS 2: a script with the base `ROSBase`")
    return found


def standalone(context: BuildContext) -> bool:
    """Whether a program contains what it needs beside SMACH, and so runs without smachac; by
    default those for ROS 1 do, which has SMACH. Raises OptionError."""
    value = context.options.get("standalone", "true" if version(context) == 1 else "false")
    if value not in ("true", "false"):
        raise OptionError(f"`standalone` must be `true` or `false`, not `{value}`")
    return value == "true"


def is_managed(context: BuildContext) -> bool:
    """Whether the options want a managed node, with a lifecycle."""
    return context.options.get("lifecycle") == "true"


def ros_type(text: str, module: str, ros: Ros) -> RosType | None:
    """The type of a text such as `std_srvs/Trigger`, `std_srvs/srv/Trigger` or
    `std_srvs.srv.Trigger`; None if it names no package. `module`: `msg`, `srv` or `action`.

    An action of ROS 1 is the message `TestAction`, one of ROS 2 the type `Test`; either name is
    read for both.
    """
    words = re.split(_WORDS, text)
    if len(words) < 2 or not all(word.isidentifier() for word in words):
        return None
    name = words[-1]
    if module == "action":
        short = name.removesuffix("Action") if "action" not in words[1:-1] else name
        if ros == 2:
            return RosType(package=words[0], module="action", name=short or name)
        return RosType(package=words[0], module="msg", name=f"{short}Action")
    return RosType(package=words[0], module=module, name=name)


def unsupported(machine: Machine, ros: Ros) -> Iterator[Diagnostic]:
    """What a script has that only the other version of ROS supports: variables, values, code."""
    other = 3 - ros
    language = _language(ros)
    for _, node in walk(machine.root):
        type_ = machine.state_types.get(node.type)
        variables = type_.variables if type_ is not None else {}
        for held in node.variables if isinstance(node, Leaf) else ():
            known, value = variables.get(held.name), held.value.data
            needed = known.ros if known is not None and value is not None else {}
            if other not in (needed.get(""), needed.get(value) if isinstance(value, str) else None):
                continue
            shown = f"`{held.name}: {value}`" if isinstance(value, str) else f"`{held.name}`"
            message = f"{shown} of {node.type} needs ROS {other}"
            use = "remove it"
            if known is not None and known.required:
                choices = [
                    argument for argument in known.type.args if needed.get(str(argument)) != other
                ]
                use = f"write {either(f'{held.name}: {choice}' for choice in choices)}"
            help = f"{use}, or set `ros = {other}` in the project file"
            place = (node.name, held.name)
            yield unsupported_by_target(held.value.span, language, message, help, place)
        for expression in expressions(node):
            if not any(name in expression.text for name in OTHER_MODULES[ros]):
                continue
            from smachac.targets.python.python2 import parsed

            tree = parsed(expression.text.strip())
            used = other_modules(tree, ros) if isinstance(tree, ast.Module) else ()
            for name in dict.fromkeys(name for _, name in used):
                yield other_version(expression.span, name, ros)


def other_modules(tree: ast.AST, ros: Ros) -> Iterator[tuple[int, str]]:
    """The uses of modules that only the other version of ROS has: line and module."""
    others = OTHER_MODULES[ros]
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=name, lineno=line)) if name in others:
                yield line, name
            case ast.Import(names=names, lineno=line):
                yield from ((line, found) for found in _roots(names) if found in others)
            case ast.ImportFrom(module=str(module), level=0, lineno=line):
                root = module.partition(".")[0]
                if root in others:
                    yield line, root


def _roots(names: Iterable[ast.alias]) -> Iterator[str]:
    return (name.name.partition(".")[0] for name in names)


def other_version(span: Span, name: str, ros: Ros) -> Diagnostic:
    """The finding for code of the other version of ROS."""
    other = 3 - ros
    help = f"write it for ROS {ros}, or set `ros = {other}` in the project file"
    help += f" (`--option ros={other}` for one build)"
    message = f"`{name}` is a module of ROS {other}"
    return unsupported_by_target(span, _language(ros), message, help, (name,))


def needs_other_version(found: Diagnostic) -> bool:
    """Whether a finding of a program is about a part that only the other version of ROS
    supports."""
    arguments = found.finding.arguments
    return arguments[:1] in [(_language(ros),) for ros in ROS_VERSIONS]


def _language(ros: Ros) -> str:
    """The language of a program, in findings."""
    return f"Python for ROS {ros}"


def is_node(machine: Machine, library: Library, ros: Ros) -> bool:
    """Whether a program for ROS 2 is a node: its base is one, or extends one, or a state gets the
    node."""
    types = [machine.state_types[name] for name in [machine.base] if name in machine.state_types]
    if ros == 2 and any(_extends_node(type_, library) for type_ in types):
        return True
    types += [type_ for type_ in machine.state_types.values() if type_.kind == "state"]
    return any(takes_node(type_, library, ros) for type_ in types)


def may_be_node(machine: Machine, library: Library, ros: Ros) -> bool:
    """Whether a program is a node or, for ROS 1, may be one: there the base template makes the
    node, and the code of a user's template is not read."""
    if ros == 2:
        return is_node(machine, library, ros)
    return machine.base != "Base" or library.own_template("Base.tpl.py") is not None


def _extends_node(base: StateType, library: Library) -> bool:
    """Whether the template of a base extends one of a node, through others of the user."""
    code, seen = base.code.get("python", f"{base.name}.tpl.py"), set[str]()
    while code not in seen and (own := library.own_template(code)) is not None:
        seen.add(code)
        code = extended(own)
    return bool(seen) and code not in seen and _is_of_ros2(code, library)


def takes_node(type_: StateType, library: Library, ros: Ros) -> bool:
    """Whether the states of a type get the node of ROS 2: the built-in types for ROS 2, and classes
    of the user whose first parameter is `node`."""
    code = type_.code.get("python", f"{type_.name}.tpl.py")
    if ros == 1:
        return False
    if ":" in code:
        return has_node_parameter(type_)
    return _is_of_ros2(code, library)


def _is_of_ros2(code: str, library: Library) -> bool:
    """Whether a template is a built-in one for ROS 2."""
    return library.own_template(code) is None and library.template(f"ros2/{code}") is not None


def has_node_parameter(type_: StateType) -> bool:
    """Whether the class of a state type has a first parameter `node` that is no variable."""
    facts = type_.class_facts
    known = facts.parameters if facts is not None else None
    first = known[0].word.text if known else ""
    return first == "node" and "node" not in type_.variables


def replaced_names(code: str, names: Mapping[str, str]) -> str:
    """Python code with other names of classes, such as `Test.Goal` for `TestGoal`."""
    for old, new in names.items():
        code = re.sub(rf"(?<![\w.]){re.escape(old)}\b", new, code)
    return code

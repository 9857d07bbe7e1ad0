"""The imports of a generated module: those of its templates, and those that its code needs."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator, Mapping
from textwrap import indent

from smachac.ir.nodes import DEFINITION_KINDS, Leaf, Machine
from smachac.ir.python_code import parse_module
from smachac.ir.traversal import expressions, walk
from smachac.pysource.modules.ros_names import MESSAGES, MODULE_OF, ROS_MODULES, Ros, message_module
from smachac.records import dataclass, field
from smachac.targets.python.formatter import WIDTH, laid_out, names

FALLBACK = """
try:
    import {0}
except ImportError:  # it is not on this machine: the same names without it
    from smachac.runtime import {0}

"""


def with_fallback(text: str, tree: ast.Module) -> str:
    """The module with a fallback for its own imports of SMACH, as templates of SMACHA's bases have
    them: without SMACH they import the bundled runtime."""
    lines = text.splitlines(keepends=True)
    for node in tree.body:
        match node:
            case ast.Import(names=[ast.alias(name="smach" | "smach_ros" as name, asname=None)]):
                if lines[node.lineno - 1].strip() == f"import {name}":
                    lines[node.lineno - 1] = FALLBACK.format(name)
    return "".join(lines)


def import_lines(texts: Iterable[str]) -> str:
    """Imports without duplicates, those of the standard library first: modules, then names of
    modules; then other statements."""
    modules: set[str] = set()
    members: dict[str, set[str]] = {}
    others: dict[str, None] = {}
    for text in texts:
        try:
            body = parse_module(text).body
        except SyntaxError:
            body = [ast.Pass()]
        if not all(isinstance(node, ast.Import | ast.ImportFrom) for node in body):
            others[text.strip()] = None
            continue
        for node in body:
            if isinstance(node, ast.ImportFrom):
                module = "." * node.level + (node.module or "")
                members.setdefault(module, set()).update(map(ast.unparse, node.names))
            elif isinstance(node, ast.Import):
                modules.update(map(ast.unparse, node.names))
    sections: tuple[list[str], list[str]] = [], []
    for name in sorted(modules):
        sections[_is_installed(name)].append(f"import {name}")
    for module in sorted(members):
        sections[_is_installed(module)].append(_from_import(module, sorted(members[module])))
    sections[1].extend(filter(None, others))
    return "\n\n".join("\n".join(lines) for lines in sections if lines)


def _is_installed(module: str) -> bool:
    """Whether a module, `os.path as path`, is not one of the standard library."""
    return module.partition(" ")[0].partition(".")[0] not in sys.stdlib_module_names


NOT_FOUND = """\
except ModuleNotFoundError as error:
    modules = {modules}
    if __name__ != "__main__" or error.name not in modules:
        raise
    searched = "\\n  ".join(sys.path)
    raise SystemExit(
        f"{{error}}; it was searched in these folders:\\n  {{searched}}\\n"
        "Add the folder that contains it to PYTHONPATH."
    ) from None"""
"""The handler for modules of the user that are not found. Modules that these import are not meant,
and a program that imports this one gets the exception."""


def class_imports(classes: Mapping[str, str], levels: int) -> tuple[list[str], str]:
    """The code that imports the user's classes of states, `module:Class` with the name that the
    program gives it, and the imports that it needs. `levels`: the modules are in the folder so many
    levels above that of the program."""
    pairs = [class_.partition(":")[::2] for class_ in classes]
    if not pairs:
        return [], ""
    listed = names(sorted({name for module, _ in pairs for name in _packages(module)}))
    modules = laid_out(listed, WIDTH - 4, len("modules = ")).replace("\n", "\n    ")
    own = zip(pairs, classes.values(), strict=True)
    lines = import_lines(
        f"from {module} import {name}" + (f" as {new}" if new != name else "")
        for (module, name), new in own
    )
    text = f"try:\n{indent(lines, '    ')}\n{NOT_FOUND.format(modules=modules)}"
    if not levels:
        return ["import sys"], text
    path = f"sys.path.insert(0, str(Path(__file__).resolve().parents[{levels}]))"
    return ["import sys", "from pathlib import Path"], f"{path}\n{text}"


def _packages(module: str) -> Iterator[str]:
    """A module and the packages around it."""
    while module:
        yield module
        module = module.rpartition(".")[0]


def _from_import(module: str, imported: list[str]) -> str:
    stars = ["*"] if "*" in imported else imported
    line = f"from {module} import {', '.join(stars)}"
    if len(line) <= WIDTH:
        return line
    return f"from {module} import (\n" + "".join(f"    {name},\n" for name in stars) + ")"


@dataclass(frozen=True, slots=True)
class ProgramNames:
    """The names in the code of a program: those with an attribute (`rospy` in `rospy.loginfo`), all
    that are read, those that the code binds, the modules of which it imports all names, and the
    modules of messages that it names (`std_msgs.msg`)."""

    used: set[str] = field(default_factory=set)
    named: set[str] = field(default_factory=set)
    bound: set[str] = field(default_factory=set)
    everything: set[str] = field(default_factory=set)
    messages: set[str] = field(default_factory=set)

    def add(self, tree: ast.AST, *, messages: bool = True) -> None:
        """Add the names in a piece of code; `messages`: also the modules of messages."""
        for node in ast.walk(tree):
            match node:
                case ast.Attribute(value=ast.Name(id=name)):
                    self.used.add(name)
                case ast.Attribute() if (module := message_module(node)) is not None:
                    self.messages.update([module] * messages)
                case ast.Name(id=name, ctx=ast.Load()):
                    self.named.add(name)
                case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                    self.bound.add(name)
                case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                    self.bound.add(name)
                case ast.ImportFrom(module=str(module), names=[ast.alias(name="*")]):
                    self.everything.add(module)
                case ast.Import(names=names) | ast.ImportFrom(names=names):
                    self.bound.update(name.asname or name.name.partition(".")[0] for name in names)


def unbound_names(
    names: ProgramNames, ros: Ros, also: Iterable[str] = (), *, node: bool = False
) -> list[str]:
    """Imports for names that code uses and does not bind: modules by their attributes
    (`rospy.loginfo`), messages by their names (`Point()`, `std_msgs.msg.Bool()`); `also` are
    further modules. `node`: the program is a node of ROS 2. `import *` binds the names in MESSAGES;
    from a module that is not listed there it may bind any message."""
    used, named, bound = names.used, names.named, names.bound
    known, modules_of = ROS_MODULES[ros], MODULE_OF[ros]
    modules = sys.stdlib_module_names | {*known, *also}
    found = [f"import {name}" for name in sorted(used - bound) if name in modules]
    found += [
        f"import {name}" for name in sorted(names.messages) if name.partition(".")[0] not in bound
    ]
    unknown = any(module not in MESSAGES for module in names.everything)
    is_ros = node or any(name in used | named | bound for name in (*known, "smach_ros"))
    if unknown or not is_ros:
        return found
    return found + [
        f"from {modules_of[name]} import {name}"
        for name in sorted(named - bound)
        if name in modules_of and modules_of[name] not in names.everything
    ]


def expression_texts(machine: Machine) -> list[str]:
    """The code of the script, each text once."""
    found = (
        expression.text.strip()
        for _, node in walk(machine.root)
        for expression in expressions(node)
    )
    return [*dict.fromkeys(found)]


def type_texts(machine: Machine) -> set[str]:
    """The texts of the script that name types of messages, services and actions, and are no code
    elsewhere: a program imports these classes by their names."""
    types: set[str] = set()
    code: set[str] = set()
    for _, node in walk(machine.root):
        held = node.variables if isinstance(node, Leaf) else ()
        own = [variable.value.data for variable in held if variable.role in DEFINITION_KINDS]
        for expression in expressions(node):
            (types if expression in own else code).add(expression.text.strip())
    return types - code


def standard_imports(trees: Iterable[ast.AST]) -> list[str]:
    """Imports of the modules of the standard library that code of the script uses: `math.pi`."""
    found = {name for tree in trees for name in _modules(tree)}
    return [f"import {name}" for name in sorted(found)]


def _modules(tree: ast.AST) -> set[str]:
    """The standard modules at the roots of dotted names, except arguments of a lambda."""
    nodes = list(ast.walk(tree))
    arguments = {node.arg for node in nodes if isinstance(node, ast.arg)}
    roots = {
        node.value.id
        for node in nodes
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
    }
    return (roots - arguments) & sys.stdlib_module_names

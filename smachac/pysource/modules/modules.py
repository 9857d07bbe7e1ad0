"""Modules and classes of the user in Python: the class of a name, its base classes, its methods.

Names are followed through imports and base classes to files that the library finds, and no
further. Where a name can be bound in another way, the answer is None: not known.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Literal, TypeAlias, get_args

from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import DID_YOU_MEAN, ClassFault, FaultKind
from smachac.pysource.modules.source import ASSIGNED, PythonText, python_text, syntax_error
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode
from smachac.records import dataclass, replace

NO_MODULE = FaultKind(
    name="no module",
    message="the code of `{type}` is in the module `{word}`, which does not exist",
    help="correct the name in the `code` of `{type}.yml`, or create the module",
    near_help=DID_YOU_MEAN,
    effect="Python raises ModuleNotFoundError: the program stops when it starts",
    missing=True,
)
NO_CLASS = FaultKind(
    name="no class",
    message="no class `{word}` is defined in {place}",
    help="correct the name in the `code` of `{type}.yml`, or define the class",
    near_help=DID_YOU_MEAN,
    missing=True,
    unnamed="the module that `{type}` names",
)
CLASS_ELSEWHERE = replace(
    NO_CLASS, message="no class `{word}` is defined in {place}, but in `{more}`", near_help=""
)
SYNTAX = FaultKind(
    name="syntax",
    message="{place} is not valid Python: {word}",
    help="correct the code at the mark, or just before it",
    effect="Python raises SyntaxError: the program stops when it starts",
    missing=True,
    unnamed="the code of `{type}`",
)

MOST_STEPS = 10
"""The most imports, and the most base classes, that are followed."""

Root: TypeAlias = Literal["state", "object", "unknown"]
"""The class at the end of a chain of base classes: `smach.State`, none, or one that is not read."""

AttributeUse: TypeAlias = Literal["any", "read", "changed", "stored", "outside"]
"""The uses of attributes in a module; `changed` is stored or deleted."""

Names: TypeAlias = Mapping[str, tuple[ast.AST, ...]]
"""The statements that bind each name of a module or a class."""

_INNER = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda


@dataclass(frozen=True, kw_only=True)
class Module:
    """A module with the names that it binds; `dynamic`: it can bind others.

    `name` is its dotted name, empty for a template; `package`: it is the file of a package. What
    each of its classes needs of the whole module is computed once.
    """

    text: PythonText
    name: str
    package: bool
    names: Names
    dynamic: bool

    @cached_property
    def nodes(self) -> tuple[ast.AST, ...]:
        """All nodes, in the order of `ast.walk`."""
        return (*walk_code(self.text.tree),)

    @cached_property
    def identifiers(self) -> frozenset[str]:
        """The names that it reads, binds or deletes anywhere."""
        return frozenset(node.id for node in self.nodes if isinstance(node, ast.Name))

    @cached_property
    def constants(self) -> frozenset[object]:
        """The values of all constants."""
        return frozenset(node.value for node in self.nodes if isinstance(node, ast.Constant))

    @cached_property
    def called(self) -> frozenset[ast.expr]:
        """The expressions that are called."""
        return frozenset(node.func for node in self.nodes if isinstance(node, ast.Call))

    @cached_property
    def tried(self) -> frozenset[ast.AST]:
        """The nodes in the bodies of `try`."""
        bodies = (line for node in self.nodes if isinstance(node, ast.Try) for line in node.body)
        return frozenset(inner for line in bodies for inner in walk_code(line))

    @cached_property
    def attributes(self) -> Mapping[AttributeUse, frozenset[str]]:
        """The names of attributes by their use, of any object. `outside` are those that are stored
        elsewhere than on the `self` of a state of SMACH at the top of the module."""
        found: dict[AttributeUse, set[str]] = {use: set() for use in get_args(AttributeUse)}
        own = self._of_states
        for node in self.nodes:
            if isinstance(node, ast.Attribute):
                found["any"].add(node.attr)
                if isinstance(node.ctx, ast.Load):
                    found["read"].add(node.attr)
                    continue
                found["changed"].add(node.attr)
                if isinstance(node.ctx, ast.Store):
                    found["stored"].add(node.attr)
                    if node not in own:
                        found["outside"].add(node.attr)
        return {use: frozenset(names) for use, names in found.items()}

    @cached_property
    def _of_states(self) -> set[ast.AST]:
        """The attributes of `self` in the states of SMACH at the top of the module."""
        return {
            part
            for node in self.text.tree.body
            if isinstance(node, ast.ClassDef)
            and len(node.bases) == 1 and is_smach_state(self, node.bases[0])
            for part in walk_code(node)
            if isinstance(part, ast.Attribute) and _is_self(part.value)
        }  # fmt: skip

    @cached_property
    def compared(self) -> frozenset[str]:
        """The attributes in comparisons that are statements of their own (`compared`)."""
        found = filter(None, map(compared, self.nodes))
        return frozenset(node.left.attr for node in found if isinstance(node.left, ast.Attribute))

    @cached_property
    def variables(self) -> frozenset[str]:
        """The names of parameters, and of what is assigned or deleted anywhere."""
        found = set[str]()
        for node in self.nodes:
            match node:
                case ast.arg(arg=name) | ast.Name(id=name, ctx=ast.Store() | ast.Del()):
                    found.add(name)
        return frozenset(found)

    @cached_property
    def definitions(self) -> frozenset[str]:
        """The names of functions and classes anywhere."""
        return frozenset(
            node.name for node in self.nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)
        )

    @cached_property
    def rebound(self) -> frozenset[str]:
        """The names that anything but a definition or an import at its top binds."""
        found = {*self.variables}
        top = {*self.text.tree.body}
        for node in self.nodes:
            match node:
                case ast.FunctionDef(name=name) | ast.ClassDef(name=name) if node not in top:
                    found.add(name)
                case ast.Import(names=names) | ast.ImportFrom(names=names) if node not in top:
                    found |= {alias.asname or alias.name.partition(".")[0] for alias in names}
                case ast.Attribute(value=owner, ctx=ast.Store() | ast.Del()):
                    head = first_name(owner)
                    found |= {head} if head is not None else set()
        return frozenset(found)


@dataclass(frozen=True, kw_only=True)
class OwnClass:
    """A class with its base classes that are known, the derived class first, and their root."""

    classes: tuple[tuple[Module, ast.ClassDef], ...]
    names: tuple[Names, ...]
    root: Root

    def method(self, name: str) -> tuple[Module, ast.FunctionDef] | None:
        """The method of a name; None if it is not known or does not exist."""
        for (module, node), names in zip(self.classes, self.names, strict=True):
            match names.get(name, ()):
                case ():
                    continue
                case (*_, ast.FunctionDef() as last) as bound:
                    plain = all(isinstance(node, ast.FunctionDef) for node in bound)
                    return (module, last) if plain and last in node.body else None
                case _:
                    return None
        return None

    def binds(self, name: str) -> bool:
        """Whether one of the classes binds a name."""
        return any(name in names for names in self.names)

    def assigned(self) -> Mapping[str, list[tuple[Module, ast.expr | None, Span]]]:
        """The attributes of the object that its methods assign: `self.name = value`."""
        return self._assigned

    @cached_property
    def _assigned(self) -> dict[str, list[tuple[Module, ast.expr | None, Span]]]:
        found: dict[str, list[tuple[Module, ast.expr | None, Span]]] = {}
        for module, node in self.classes:
            others = of_other_objects(node)
            for method in walk_code(node):
                if method in others:
                    continue
                if isinstance(method, ast.Assign | ast.AnnAssign | ast.AugAssign):
                    targets = method.targets if isinstance(method, ast.Assign) else [method.target]
                    value = None if isinstance(method, ast.AugAssign) else method.value
                    for target in targets:
                        for inner in walk_code(target):
                            if isinstance(inner, ast.Attribute) and _is_self(inner.value):
                                whole = value if inner is target else None
                                entry = (module, whole, module.text.span(inner))
                                found.setdefault(inner.attr, []).append(entry)
        return found


def _is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id == "self"


def first_name(node: ast.expr) -> str | None:
    """The name at the start of `tools.math.pi`; None where it starts with another expression."""
    while isinstance(node, ast.Attribute):
        node = node.value
    return node.id if isinstance(node, ast.Name) else None


def compared(node: ast.AST) -> ast.Compare | None:
    """The comparison `x == y` that is a statement of its own, in place of `x = y`."""
    match node:
        case ast.Expr(
            value=ast.Compare(
                left=ast.Attribute() | ast.Subscript() | ast.Name(), ops=[ast.Eq()]
            ) as found
        ):
            return found
    return None


def of_other_objects(node: ast.ClassDef) -> set[ast.AST]:
    """The nodes in a class whose `self` is another object: those of inner classes, and of functions
    in a method that have a parameter of this name."""
    found: set[ast.AST] = set()
    own = {*node.body}
    for other in walk_code(node):
        inner = other is not node and isinstance(other, ast.ClassDef)
        if isinstance(other, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            given = [arg.arg for arg in walk_code(other.args) if isinstance(arg, ast.arg)]
            inner = other not in own and "self" in given
        if inner and other not in found:
            found.update(walk_code(other))
    return found


def template_module(source: Source) -> Module | None:
    """The Python in a template; None if it cannot be parsed."""
    text = python_text(source, template=True)
    return _module(text, "", package=False) if text is not None else None


def load_module(name: str, library: UserCode) -> Module | ClassFault | None:
    """The module of a dotted name; a fault if it certainly does not exist or cannot be parsed."""
    path = name.replace(".", "/")
    for file, package in ((f"{path}/__init__.py", True), (f"{path}.py", False)):
        source = library.code(file)
        if source is None:
            continue
        key = file, source
        if key not in library.modules:
            library.modules[key] = _read(source, name, file, package=package)
        found = library.modules[key]
        assert found is None or isinstance(found, Module | ClassFault)
        return found
    return None


def _read(source: Source, name: str, file: str, *, package: bool) -> Module | ClassFault | None:
    """The module in a text; a fault if it cannot be parsed."""
    text = python_text(source, template=False)
    if text is not None:
        return _module(text, name, package=package)
    error = syntax_error(source)
    if error is None:
        return None
    message = error.text.partition(". Maybe you meant")[0]
    help = _syntax_help(error.text)
    return ClassFault(kind=SYNTAX, name=Word(message, error.span), file=file, help=help)


def _syntax_help(message: str) -> str:
    """The help for a syntax error of Python, by the message of its parser; empty: not known."""
    if message == "expected ':'":
        return "write `:` at the mark"
    if message.endswith(ASSIGNED):
        return "write `==` to compare"
    if message.endswith("was never closed"):
        closing = {"'('": ")", "'['": "]", "'{'": "}"}.get(message.split(" ")[0])
        return f"close the bracket: write `{closing}`" if closing else "close the bracket"
    if message == "'await' outside async function":
        return "remove `await`, or write `asyncio.run(...)` in its place"
    if message.startswith("unterminated"):
        return "write the quotation mark at the end of the text"
    if message.startswith("expected an indented block"):
        return "indent this line by 4 spaces more"
    return ""


def module_of(text: PythonText, name: str, *, package: bool) -> Module:
    """The module in a text that is parsed already."""
    return _module(text, name, package=package)


def file_of(module: Module) -> str:
    """The file of a module, below a folder with code."""
    path = module.name.replace(".", "/")
    return f"{path}/__init__.py" if module.package else f"{path}.py"


def absent_module(word: Word, library: UserCode) -> ClassFault | None:
    """The fault that a module is in no searched folder; None where it can be an installed one.

    It is certain if the folder of its package has other modules, or if a module with nearly the
    same name exists.
    """
    parts = word.text.split(".")
    for at, part in enumerate(parts):
        here = library.code_names("/".join(parts[:at]))
        names = sorted({text.removesuffix(".py") for text in here if is_module(text)})
        if part in names:
            continue
        if any(text.startswith(f"{part}.") for text in here):  # an extension module
            return None
        guess = guesser(names)
        near = guess(part) if at else guess.unique_match(part)
        if near is None and (not at or not any(_is_package_file(text) for text in here)):
            return None
        meant = ".".join([*parts[:at], near, *parts[at + 1 :]]) if near is not None else None
        return ClassFault(kind=NO_MODULE, name=word, near=meant)
    return None


def is_module(file: str) -> bool:
    """Whether a name of a file or folder can be that of a module."""
    return file.removesuffix(".py").isidentifier() and not file.startswith("__")


def _is_package_file(file: str) -> bool:
    """Whether a file shows that its folder is a package. `setup.py` is beside one."""
    return file.endswith(".py") and file != "setup.py"


def find_class(
    module: Module, name: str, library: UserCode, steps: int = MOST_STEPS
) -> tuple[Module, ast.ClassDef] | ClassFault | None:
    """The class of a name in a module, also where the module imports it."""
    bound = module.names.get(name, ())
    match bound:
        case ():
            if module.dynamic:
                return None
            classes = [key for key, by in module.names.items() if isinstance(by[-1], ast.ClassDef)]
            top = Span(module.text.source, 0, 0)
            return ClassFault(kind=NO_CLASS, name=Word(name, top), near=guesser(classes)(name))
        case (ast.ImportFrom() as imported,) if steps and imported in module.text.tree.body:
            return _imported(module, imported, name, library, steps)
        case (*_, ast.ClassDef() as last) if all(isinstance(node, ast.ClassDef) for node in bound):
            at_top = all(node in module.text.tree.body for node in bound)
            return (module, last) if at_top or len(bound) == 1 else None
    return None


def find_function(
    module: Module, called: ast.expr, library: UserCode
) -> tuple[Module, ast.FunctionDef] | None:
    """The function of a module that an expression names, also where the module imports it:
    `refine`, `tools.refine`."""
    match called:
        case ast.Name(id=name):
            match module.names.get(name, ()):
                case (ast.FunctionDef() as function,):
                    return module, function
                case (ast.ImportFrom() as imported,) if imported in module.text.tree.body:
                    own = next(alias.name for alias in imported.names
                               if (alias.asname or alias.name) == name)  # fmt: skip
                    return _function_in(source_module(module, imported), own, library)
        case ast.Attribute(value=ast.Name() | ast.Attribute() as owner, attr=name):
            imported_module = module_name(module, ast.unparse(owner))
            return _function_in(imported_module, name, library) if imported_module else None
    return None


def _function_in(
    module_name: str, name: str, library: UserCode
) -> tuple[Module, ast.FunctionDef] | None:
    module = load_module(module_name, library)
    if not isinstance(module, Module) or module.dynamic:
        return None
    match module.names.get(name, ()):
        case (ast.FunctionDef() as function,) if function in module.text.tree.body:
            return module, function
    return None


def module_name(module: Module, written: str) -> str | None:
    """The dotted name of the imported module that is written so in a module: `tools` after
    `from cell import tools`."""
    head, _, rest = written.partition(".")
    match module.names.get(head, ()):
        case (ast.ImportFrom() as node,) if node in module.text.tree.body and not rest:
            own = next(name.name for name in node.names if (name.asname or name.name) == head)
            return f"{source_module(module, node)}.{own}".lstrip(".")
        case (ast.Import() as node,) if node in module.text.tree.body:
            for alias in node.names:
                if alias.asname == head and not rest:
                    return alias.name
                if alias.asname is None and alias.name == written:
                    return written
    return None


def _imported(
    module: Module, node: ast.ImportFrom, name: str, library: UserCode, steps: int
) -> tuple[Module, ast.ClassDef] | ClassFault | None:
    own = next(alias.name for alias in node.names if (alias.asname or alias.name) == name)
    other = load_module(source_module(module, node), library)
    if not isinstance(other, Module):
        return other
    found = find_class(other, own, library, steps - 1)
    return found if isinstance(found, tuple) or _is_syntax(found) else None


def _is_syntax(found: ClassFault | None) -> bool:
    return found is not None and found.kind is SYNTAX


def source_module(module: Module, node: ast.ImportFrom) -> str:
    """The dotted name of the module that a statement imports from."""
    if not node.level:
        return node.module or ""
    parts = module.name.split(".")
    kept = parts[: len(parts) - node.level + module.package]
    return ".".join([*kept, node.module] if node.module else kept)


def with_bases(module: Module, node: ast.ClassDef, library: UserCode) -> OwnClass:
    """A class with its base classes, as far as each has one base."""
    classes = [(module, node)]
    root: Root | None = None
    while root is None:
        module, node = classes[-1]
        if node.decorator_list or node.keywords or len(node.bases) > 1:
            root = "unknown"
            break
        if not node.bases:
            root = "object"
            break
        base = node.bases[0]
        if is_smach_state(module, base):
            root = "state"
            break
        found = None
        if isinstance(base, ast.Name) and base.id == "object" and "object" not in module.names:
            root = "object"
        elif isinstance(base, ast.Name):
            found = find_class(module, base.id, library)
            again = isinstance(found, tuple) and any(found[1] is class_ for _, class_ in classes)
            if not isinstance(found, tuple) or again or len(classes) == MOST_STEPS:
                root = "unknown"
            else:
                classes.append(found)
        else:
            root = "unknown"
    names = tuple(names_of(class_.body)[0] for _, class_ in classes)
    return OwnClass(classes=tuple(classes), names=names, root=root)


def is_smach_state(module: Module, base: ast.expr) -> bool:
    """Whether an expression is the class `State` of SMACH. In a template, whose imports are in
    other templates, it is by its name."""
    match base:
        case ast.Attribute(value=ast.Name(id=owner), attr="State"):
            bound = module.names.get(owner, ())
            return owner == "smach" or any("smach" in _imports(node, owner) for node in bound)
        case ast.Name(id=name):
            bound = module.names.get(name, ())
            if not bound:
                return name == "State" and not module.name
            froms = [node for node in bound if isinstance(node, ast.ImportFrom)]
            own = {alias.name for node in froms for alias in node.names
                   if (alias.asname or alias.name) == name}  # fmt: skip
            modules = {(node.module or "").rpartition(".")[2] for node in froms}
            return len(froms) == len(bound) and own == {"State"} and modules <= {"smach", "state"}
    return False


def _imports(node: ast.AST, name: str) -> set[str]:
    """The last parts of what a statement imports under a name."""
    names = node.names if isinstance(node, ast.Import | ast.ImportFrom) else ()
    return {
        alias.name.rpartition(".")[2]
        for alias in names
        if (alias.asname or alias.name.partition(".")[0]) == name
    }


def constant(names: Names, name: str) -> str | None:
    """The text that a name is bound to, if it is bound once, and to a text."""
    node = constant_node(names, name)
    return str(node.value) if node is not None else None


def constant_node(names: Names, name: str) -> ast.Constant | None:
    """The text that a name is bound to, as `constant`, in the tree."""
    match names.get(name, ()):
        case (ast.Assign(targets=[ast.Name()], value=ast.Constant(str()) as node),):
            return node
        case (ast.AnnAssign(value=ast.Constant(str()) as node),):
            return node
    return None


def _module(text: PythonText, name: str, *, package: bool) -> Module:
    names, dynamic = names_of(text.tree.body)
    if "__getattr__" in names:
        dynamic = True
    return Module(text=text, name=name, package=package, names=names, dynamic=dynamic)


def names_of(body: list[ast.stmt]) -> tuple[Names, bool]:
    """The statements that bind each name in a body, in their order, and whether there can be
    other names."""
    found: dict[str, list[ast.AST]] = {}
    dynamic = False
    for statement, node in _own(body):
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                found.setdefault(node.name, []).append(node)
            case ast.Import():
                for alias in node.names:
                    name = alias.asname or alias.name.partition(".")[0]
                    found.setdefault(name, []).append(node)
            case ast.ImportFrom():
                for alias in node.names:
                    found.setdefault(alias.asname or alias.name, []).append(node)
                    dynamic = dynamic or alias.name == "*"
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
                found.setdefault(name, []).append(statement)
            case ast.Call(func=ast.Name(id="exec" | "globals" | "locals" | "vars")):
                dynamic = True
    return {name: tuple(bound) for name, bound in found.items()}, dynamic


def _own(body: list[ast.stmt]) -> Iterator[tuple[ast.AST, ast.AST]]:
    """The nodes of a body in their order, without those inside functions and classes, each with
    its innermost statement."""
    todo: list[tuple[ast.AST, ast.AST]] = [(node, node) for node in reversed(body)]
    while todo:
        statement, node = todo.pop()
        yield statement, node
        if not isinstance(node, _INNER):
            children = reversed([*ast.iter_child_nodes(node)])
            todo.extend(
                (child if isinstance(child, ast.stmt) else statement, child) for child in children
            )

"""Names of modules of Python's library: the attributes that a module certainly does not have.

Only modules of a short list are imported, whose import has no effect, and only from the library of
the Python that runs; nothing of a user is imported. Names of other versions of Python, and of other
systems, count as known.
"""

from __future__ import annotations

import ast
import re
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from importlib.util import find_spec
from inspect import isfunction, ismethoddescriptor
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

if TYPE_CHECKING:
    from smachac.pysource.modules.modules import Module, OwnClass

NO_ATTRIBUTE = FaultKind(
    name="no attribute",
    message="the module `{file}` of Python has no `{word}`",
    help="correct the name",
    near_help=SUGGESTION,
    effect="the code raises AttributeError when it runs: the machine stops",
)

MODULES = frozenset([
    "collections", "copy", "datetime", "functools", "itertools", "json", "math", "operator", "os",
    "os.path", "random", "re", "statistics", "string", "sys", "threading", "time",
])  # fmt: skip
"""The modules whose names are read."""

OTHER_VERSIONS = frozenset([
    "UTC", "batched", "binomialvariate", "call", "cbrt", "clock", "exp2", "exception", "fma",
    "fabs", "isreserved", "kde", "kde_random", "monitoring", "NOFLAG", "pairwise", "PatternError",
    "Placeholder", "replace", "sumprod", "template", "templatelib", "ulp", "nextafter",
    "fsum", "hypot", "lcm", "perm", "prod", "comb", "dist", "isqrt", "activate_stack_trampoline",
    "ShutDown", "is_none", "is_not_none", "splitroot", "isdevdrive", "isjunction", "remote_exec",
    "fmean", "correlation", "covariance", "linear_regression", "quantiles", "multimode",
    "exc_clear",
    "exc_type", "maxint", "maketrans", "letters", "lowercase", "uppercase", "join", "izip", "imap",
    "ifilter", "getcwdu", "Callable", "Iterable", "Mapping", "MutableMapping", "Sequence", "Set",
])  # fmt: skip
"""Names that some version of Python has in one of the modules, and this one may lack."""

BY_SYSTEM = frozenset(["os", "sys", "time", "threading", "os.path"])
"""Modules with other names on other systems: of these, only habits and slips are found."""

HABITS = {
    "time": {"now": "time.time()", "wait": "time.sleep()", "delay": "time.sleep()",
             "current": "time.time()", "get_time": "time.time()"},
    "math": {"squareroot": "math.sqrt()", "square_root": "math.sqrt()", "root": "math.sqrt()",
             "power": "math.pow()", "arctan2": "math.atan2()", "arctan": "math.atan()",
             "arccos": "math.acos()", "arcsin": "math.asin()", "abs": "abs()", "max": "max()",
             "min": "min()", "round": "round()", "deg2rad": "math.radians()", "PI": "math.pi",
             "rad2deg": "math.degrees()", "norm": "math.hypot()"},
    "random": {"rand": "random.random()", "normal": "random.gauss()", "float": "random.random()",
               "int": "random.randint()", "integer": "random.randint()"},
    "json": {"parse": "json.loads()", "stringify": "json.dumps()", "write": "json.dump()",
             "read": "json.load()"},
    "copy": {"deep_copy": "copy.deepcopy()", "clone": "copy.copy()"},
    "threading": {"sleep": "time.sleep()"},
    "os": {"exists": "os.path.exists()", "join": "os.path.join()"},
}  # fmt: skip
"""What is meant by names that modules of Python do not have."""


def module_of_library(name: str) -> ModuleType | None:
    """A module of MODULES, if Python finds it in its own library."""
    if name not in MODULES:
        return None
    if name == "os.path":
        found = module_of_library("os")
        return getattr(found, "path", None)
    try:
        spec = getattr(sys.modules.get(name), "__spec__", None) or find_spec(name)
    except (ImportError, ValueError):
        return None
    origin = spec.origin if spec is not None else None
    if origin is None:
        return None
    if origin not in ("built-in", "frozen"):
        path = Path(origin).resolve()
        folders = {sysconfig.get_path(key) for key in ("stdlib", "platstdlib")}
        parents = [Path(folder).resolve() for folder in folders if folder]
        inside = any(parent in path.parents for parent in parents)
        if not inside or {"site-packages", "dist-packages"} & {*path.parts}:
            return None
    return import_module(name)


def missing_name(module: str, name: str) -> str | None:
    """What is probably meant by a name that a module of the library does not have, with the module;
    empty if it is not known. None if the module has it, or if it cannot be judged."""
    found = module_of_library(module)
    if found is None or hasattr(found, name) or name.startswith("_"):
        return None
    meant = HABITS.get(module, {}).get(name)
    if meant is not None:
        return meant
    public = [text for text in dir(found) if not text.startswith("_")]
    inner = getattr(found, module, None)
    if isinstance(inner, type) and hasattr(inner, name):
        return f"{module}.{module}.{name}"
    if name in OTHER_VERSIONS:
        return None
    guess = guesser(public)
    near = guess.unique_match(name) if module in BY_SYSTEM else guess(name)
    if near is None and module in BY_SYSTEM:
        return None
    return f"{module}.{near}" if near is not None else ""


def attributes(tree: ast.AST) -> Iterator[tuple[str, ast.Attribute]]:
    """The attributes of names in code that may be modules, with the name of each module."""
    for node in walk_code(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=name)) if name in MODULES:
                yield name, node
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="os"), attr="path")):
                yield "os.path", node


def missing_attributes(
    module: Module, node: ast.ClassDef, library: UserCode
) -> Iterator[ClassFault]:
    """The attributes of modules of the library that a class uses and that these do not have: of
    modules that a plain `import` binds, and nothing else."""
    used = [(name, attribute) for name, attribute in attributes(node) if _is_plain(module, name)]
    if not used:
        return
    done = set[tuple[str, str]]()
    for name, attribute in used:
        span = module.text.span(attribute)
        set_here = (
            attribute.attr in module.constants or attribute.attr in module.attributes["changed"]
        )
        other = set_here or attribute in module.tried or (name, attribute.attr) in done
        if other or name.partition(".")[0] in module.variables or module.text.is_filled(span):
            continue
        meant = missing_name(name, attribute.attr)
        if meant is not None and not is_shadowed(name, library):
            done.add((name, attribute.attr))
            word = Word(attribute.attr, Span(span.source, span.end - len(attribute.attr), span.end))
            help = f"write `{meant}`" if meant.endswith(")") else f"did you mean `{meant}`?"
            yield ClassFault(kind=NO_ATTRIBUTE, name=word, file=name, help=help if meant else "")


def _is_plain(module: Module, name: str) -> bool:
    """Whether a name of a module is bound by `import name` at its top, and by nothing else."""
    head = name.partition(".")[0]
    bound = module.names.get(head, ())
    return bool(bound) and not module.dynamic and all(
        isinstance(node, ast.Import) and _aliases(node).get(head, "").partition(".")[0] == head
        for node in bound
    )  # fmt: skip


def _aliases(node: ast.Import) -> dict[str, str]:
    return {name.asname or name.name.partition(".")[0]: name.name for name in node.names}


def is_shadowed(name: str, library: UserCode) -> bool:
    """Whether the project has a module of the name of one in the library."""
    head = name.partition(".")[0]
    return any(library.code(file) for file in (f"{head}.py", f"{head}/__init__.py"))


def only_imported(name: str, texts: Iterable[str]) -> bool:
    """Whether templates that contain the name of a module only import it and use its attributes."""
    head = re.escape(name.partition(".")[0])
    other = re.compile(rf"(?<![\w.])(?<!^import ){head}\b(?!\.\w)|as {head}\b", re.M)
    return not any(other.search(text) for text in texts)


def methods_of_objects(own: OwnClass) -> Mapping[str, frozenset[str]]:
    """The methods of the attributes of an object to which only an object of one class of Python's
    library is assigned, as `self.done = threading.Event()`."""
    found: dict[str, frozenset[str]] = {}
    for name, values in own.assigned().items():
        classes = {_class_of_library(module, value) for module, value, _ in values}
        kind = classes.pop() if len(classes) == 1 else None
        if kind is not None:
            found[name] = frozenset(
                name for name, member in vars(kind).items()
                if isfunction(member) or ismethoddescriptor(member)
            )  # fmt: skip
    return found


def _class_of_library(module: Module, value: ast.expr | None) -> type | None:
    """The class of Python's library that a call makes an object of."""
    match value:
        case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr=attribute)):
            bound = module.names.get(name, ())
            imported = bool(bound) and all(isinstance(node, ast.Import) for node in bound)
            library = module_of_library(name) if imported else None
            kind = getattr(library, attribute, None)
            return kind if isinstance(kind, type) else None
    return None

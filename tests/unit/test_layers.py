"""The order of the layers: who may import whom, and what may be imported only where it is used."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath

import pytest

LAYERS = (
    ("source",),
    ("diagnostics", "problems", "spelling", "grammars"),
    ("syntax", "ir", "shapes", "policy"),
    (
        "states",
        "meta",
        "script",
        "schema",
        "lookups",
        "calls",
        "typed",
        "sugar",
        "robots",
        "urdf",
        "variables",
        "unused",
    ),
    (
        "lower",
        "presets",
        "quirks",
        "template_quirks",
        "desugar",
        "catching",
        "conditions",
        "values",
        "checks",
        "targets",
    ),
    ("driver", "report", "refactor", "project", "files", "execute", "reach"),
    ("__init__", "runs", "streams", "survey", "discover", "baseline"),
    ("fixes", "verify"),
    ("checkup", "rewriting", "migrate"),
    ("rework", "scaffold"),
    (
        "beginning",
        "telling",
    ),
    ("verbs", "arguments"),
    ("cli",),
    ("__main__",),
)
"""The parts of the compiler, lowest first: a part may import every part of the rows above it."""

WITHIN = {
    ("problems", "diagnostics"),
    ("problems", "spelling"),
    ("spelling", "diagnostics"),
    ("shapes", "syntax"),
    ("policy", "syntax"),
    ("script", "states"),
    ("template_quirks", "quirks"),
    ("template_quirks", "targets"),
    ("script", "schema"),
    ("script", "lookups"),
    ("script", "typed"),
    ("states", "typed"),
    ("states", "meta"),
    ("script", "calls"),
    ("script", "robots"),
    ("script", "variables"),
    ("script", "unused"),
    ("unused", "states"),
    ("unused", "lookups"),
    ("unused", "typed"),
    ("variables", "states"),
    ("variables", "schema"),
    ("variables", "sugar"),
    ("robots", "states"),
    ("robots", "urdf"),
    ("sugar", "states"),
    ("lower", "values"),
    ("lower", "presets"),
    ("presets", "values"),
    ("targets", "values"),
    ("lower", "conditions"),
    ("lower", "desugar"),
    ("lower", "catching"),
    ("desugar", "values"),
    ("files", "project"),
}
"""The imports, as (who, whom), that are allowed inside one row."""

ASIDE: Mapping[str, frozenset[str]] = {
    "runtime": frozenset({"rospy", "rosgraph", "actionlib", "actionlib_msgs", "genpy"}),
    "sim": frozenset({"pybullet", "pybullet_data", "numpy", "PIL", "imageio_ffmpeg"}),
}
"""What generated code stands on, with the packages it may import; no other part of ours."""

USES_ASIDE = {"execute", "reach", "runs", "verify"}
"""The parts of the compiler that run what it made, and so may import the parts above."""

FACTS = {"smachac.__version__"}
"""What everyone may know of the package as a whole."""

HEAVY = {"networkx", "lark", "jinja2", "pybullet", "pybullet_data", "numpy", "PIL"}
"""Packages slow to load: imported inside the functions that use them, or for types alone."""

LATE = {"smachac/targets/bounds.py"}
"""Modules that are made of a heavy package, and so are imported where they are used."""

Tree = Mapping[str, str]
"""Source texts by their path from the root of the repository, as `smachac/ir/nodes.py`."""


def module_name(path: str) -> str:
    parts = PurePosixPath(path).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def part_of(module: str) -> str:
    """`ir` of `smachac.ir.nodes`; the package itself is the part `__init__`."""
    return f"{module}.__init__".split(".")[1]


def absolute(node: ast.ImportFrom, path: str) -> str:
    """The module that a `from` names, its dots resolved against the file it stands in."""
    if not node.level:
        return node.module or ""
    package = PurePosixPath(path).parts[: -node.level]
    return ".".join([*package, *filter(None, [node.module])])


def imported(node: ast.AST, path: str, modules: set[str]) -> Iterator[str]:
    """The modules that one statement or one call of `import_module` loads."""
    match node:
        case ast.Import(names=names):
            yield from (alias.name for alias in names)
        case ast.ImportFrom(names=names):
            base = absolute(node, path)
            for alias in names:
                module = f"{base}.{alias.name}"
                yield module if module in modules | FACTS else base
        case ast.Call(
            func=ast.Name(id="import_module" | "__import__")
            | ast.Attribute(attr="import_module" | "__import__"),
            args=[ast.Constant(value=str(name)), *_],
        ):
            yield name


def layer_faults(tree: Tree) -> Iterator[str]:
    """Each import against the order of the layers, as `path:line: what is wrong`."""
    modules = {module_name(path) for path in tree}
    modules |= {
        str(parent).replace("/", ".") for path in tree for parent in PurePosixPath(path).parents
    }
    for path, text in tree.items():
        part = part_of(module_name(path))
        if part not in ASIDE and not any(part in row for row in LAYERS):
            yield f"{path}:1: `{part}` has no layer: give it a place in LAYERS"
            continue
        for node in ast.walk(ast.parse(text)):
            for module in imported(node, path, modules):
                if fault := fault_of(part, module):
                    yield f"{path}:{getattr(node, 'lineno', 1)}: {fault}"


def fault_of(part: str, module: str) -> str | None:
    package = module.partition(".")[0]
    if package != "smachac":
        known = part not in ASIDE or package in ASIDE[part] | sys.stdlib_module_names
        return None if known else f"`{part}` may not import the package `{package}`"
    other = part_of(module)
    if other == part or module in FACTS or (other in ASIDE and part in USES_ASIDE):
        return None
    if part not in ASIDE and other not in ASIDE and ((part, other) in WITHIN or above(other, part)):
        return None
    return f"`{part}` may not import `{other}`"


def above(upper: str, lower: str) -> bool:
    rows = {part: number for number, row in enumerate(LAYERS) for part in row}
    return rows.get(upper, len(LAYERS)) < rows[lower]


def heavy_faults(tree: Tree) -> Iterator[str]:
    """Each heavy package that is loaded as soon as a module is."""
    late = {module_name(path) for path in LATE}
    for path, text in tree.items():
        for node in at_import(ast.parse(text)) if path not in LATE else ():
            for module in imported(node, path, set()):
                if module.partition(".")[0] in HEAVY or module in late:
                    yield f"{path}:{getattr(node, 'lineno', 1)}: `{module}` belongs in a function"


def at_import(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes that run when a module is imported: none in functions, none for types alone."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(child, ast.If) and ast.unparse(child.test).endswith("TYPE_CHECKING"):
            yield from (inner for other in child.orelse for inner in [other, *at_import(other)])
            continue
        yield child
        yield from at_import(child)


@pytest.fixture(scope="module")
def ours() -> Tree:
    root = Path(__file__).parents[2]
    paths = sorted((root / "smachac").rglob("*.py"))
    modules = [path for path in paths if "." not in path.stem]
    assert len(modules) > 5
    return {path.relative_to(root).as_posix(): path.read_text("utf-8") for path in modules}


def test_our_imports_keep_the_order_of_the_layers(ours: Tree) -> None:
    assert list(layer_faults(ours)) == []


def test_our_modules_load_no_heavy_package_when_imported(ours: Tree) -> None:
    assert list(heavy_faults(ours)) == []


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("smachac/cli.py", "import smachac\nfrom smachac import driver, load"),
        ("smachac/lower.py", "from smachac import __version__"),
        ("smachac/driver.py", "from smachac.script import resolve"),
        ("smachac/ir/graph.py", "from .nodes import Leaf\nfrom .. import source"),
        ("smachac/execute.py", "import smachac.sim.film"),
        ("smachac/sim/world.py", "def step():\n    import numpy, time"),
        ("smachac/script.py", "from smachac.states import Interface"),
    ],
)
def test_imports_from_lower_layers_are_fine(path: str, text: str) -> None:
    assert list(layer_faults(example(path, text))) == []


@pytest.mark.parametrize(
    ("path", "text", "fault"),
    [
        ("smachac/source.py", "import smachac.cli", "1: `source` may not import `cli`"),
        ("smachac/ir/nodes.py", "from smachac import lower", "1: `ir` may not import `lower`"),
        ("smachac/ir/nodes.py", "from ..checks import names", "1: `ir` may not import `checks`"),
        ("smachac/ir/__init__.py", "from .. import lower", "1: `ir` may not import `lower`"),
        ("smachac/states.py", "\nfrom . import script", "2: `states` may not import `script`"),
        (
            "smachac/states.py",
            "def f():\n from smachac.cli import main",
            "2: `states` may not import `cli`",
        ),
        (
            "smachac/syntax.py",
            "import typing\nif typing.TYPE_CHECKING:\n    from smachac.ir import nodes",
            "3: `syntax` may not import `ir`",
        ),
        ("smachac/lower.py", "from smachac import load", "1: `lower` may not import `__init__`"),
        (
            "smachac/lower.py",
            "import importlib\nimportlib.import_module('smachac.checks')",
            "2: `lower` may not import `checks`",
        ),
        (
            "smachac/runtime/smach/__init__.py",
            "from ...sim import world",
            "1: `runtime` may not import `sim`",
        ),
        (
            "smachac/runtime/trace.py",
            "import smachac.source",
            "1: `runtime` may not import `source`",
        ),
        (
            "smachac/runtime/trace.py",
            "import numpy",
            "1: `runtime` may not import the package `numpy`",
        ),
        (
            "smachac/sim/world.py",
            "import networkx",
            "1: `sim` may not import the package `networkx`",
        ),
        ("smachac/driver.py", "import smachac.sim", "1: `driver` may not import `sim`"),
        ("smachac/lower.py", "import smachac.novelty", "1: `lower` may not import `novelty`"),
        ("smachac/novelty.py", "", "1: `novelty` has no layer: give it a place in LAYERS"),
    ],
)
def test_imports_against_the_order_are_found(path: str, text: str, fault: str) -> None:
    assert list(layer_faults(example(path, text))) == [f"{path}:{fault}"]


@pytest.mark.parametrize(
    "text",
    [
        "import networkx as nx",
        "class A:\n    from lark import Lark",
        "try:\n    import PIL.Image\nexcept ImportError:\n    pass",
        "if TYPE_CHECKING:\n    pass\nelse:\n    import numpy",
    ],
)
def test_heavy_packages_at_the_top_are_found(text: str) -> None:
    assert len(list(heavy_faults(example("smachac/checks/structure.py", text)))) == 1


@pytest.mark.parametrize(
    "text",
    [
        "def f():\n    import networkx",
        "class A:\n    async def f(self):\n        from jinja2 import Environment",
        "import typing\nif typing.TYPE_CHECKING:\n    from lark import Tree",
        "import json",
    ],
)
def test_heavy_packages_in_functions_and_for_types_are_fine(text: str) -> None:
    assert list(heavy_faults(example("smachac/checks/structure.py", text))) == []


def example(path: str, text: str) -> Tree:
    """A tree with one module of interest, and the empty modules that the texts above name."""
    names = ["__init__", "source", "states", "script", "lower", "driver", "files", "cli"]
    names += [f"{part}/__init__" for part in ("ir", "checks", "sim", "runtime")]
    return {**{f"smachac/{name}.py": "" for name in names}, "smachac/sim/world.py": "", path: text}

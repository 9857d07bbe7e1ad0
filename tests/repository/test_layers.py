"""The order of the layers, no import circles, and heavy packages only where they are used."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path, PurePosixPath

import networkx as nx
import pytest

LAYERS = (
    ("robots", "records"),
    ("sim", "runtime", "grammars", "diagnostics", "version"),
    ("ir",),
    ("pysource", "interpreter"),
    ("analysis", "frontend"),
    ("targets", "checks"),
    ("driver", "report"),
    ("__init__", "repair", "diff", "verify"),
    ("refactor", "sweep"),
    ("lsp", "view"),
    ("commands",),
    ("__main__",),
)
"""The rooms of smachac/, lowest first: a room imports only from the rows above its own here."""

PACKAGES: Mapping[str, frozenset[str]] = {
    "runtime": frozenset(
        {
            "rospy",
            "rosgraph",
            "actionlib",
            "actionlib_msgs",
            "genpy",
            "smach_msgs",
            "yaml",
            "flexbe_core",
            "yasmin",
        }
    ),
    "robots": frozenset({"yaml", "xacro"}),
    "sim": frozenset({"pybullet", "pybullet_data", "numpy", "PIL", "imageio_ffmpeg"}),
}
"""The rooms that generated programs stand on, with the packages that they may import."""

HEAVY = {
    *("networkx", "jinja2", "pybullet", "pybullet_data", "numpy", "PIL"),
    *("pygls", "lsprotocol", "ray"),
}
"""Packages slow to load: imported inside the functions that use them, or for types alone."""

LATE = {"smachac/targets/templates/sandbox.py", "smachac/lsp/server.py"}
"""Modules that are made of a heavy package, and so are imported where they are used."""

FLOORS = {"smachac.checks": 5, "smachac.frontend": 5, "smachac.pysource": 5, "smachac": 11}
"""The most levels of imports between the folders and files directly in a room, and between the
rooms."""

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
                yield module if module in modules else base
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
        if not any(part in row for row in LAYERS):
            yield f"{path}:1: `{part}` has no layer: give it a place in LAYERS"
            continue
        for node in ast.walk(ast.parse(text)):
            for module in imported(node, path, modules):
                if fault := fault_of(part, module):
                    yield f"{path}:{getattr(node, 'lineno', 1)}: {fault}"


def fault_of(part: str, module: str) -> str | None:
    package = module.partition(".")[0]
    if package != "smachac":
        known = part not in PACKAGES or package in PACKAGES[part] | sys.stdlib_module_names
        return None if known else f"`{part}` may not import the package `{package}`"
    rows = {name: number for number, row in enumerate(LAYERS) for name in row}
    other = part_of(module)
    if other == part or rows.get(other, len(LAYERS)) < rows[part]:
        return None
    return f"`{part}` may not import `{other}`"


def import_circles(tree: Tree) -> list[str]:
    """The modules that import each other, one line for each circle of all that are entangled.

    Imports inside functions and for types alone count too.
    """
    return circles(import_pairs(tree))


def circles(pairs: Iterable[tuple[str, str]]) -> list[str]:
    components = nx.strongly_connected_components(nx.DiGraph(pairs))
    return sorted(" ".join(sorted(names)) for names in components if len(names) > 1)


def import_pairs(tree: Tree) -> Iterator[tuple[str, str]]:
    """Each import of one module of the tree by another one: the importer, the imported."""
    modules = {module_name(path) for path in tree}
    for path, text in tree.items():
        for node in ast.walk(ast.parse(text)):
            for module in imported(node, path, modules):
                if module in modules and module != module_name(path):
                    yield module_name(path), module


def rule_imports(tree: Tree) -> list[str]:
    """Each import of a module with rules within `checks/`, except by the list of all rules: shared
    code belongs in a module of its subject that has no rules."""
    rules = {module_name(path) for path, text in tree.items() if has_rule(ast.parse(text))}
    return sorted(
        f"{importer} imports {module}"
        for importer, module in set(import_pairs(tree))
        if module in rules and importer != "smachac.checks" and part_of(importer) == "checks"
    )


def has_rule(module: ast.Module) -> bool:
    """Whether a module has a function with the decorator `@rule(...)`."""
    return any(
        isinstance(function, ast.FunctionDef)
        and any(ast.unparse(decorator).startswith("rule(") for decorator in function.decorator_list)
        for function in module.body
    )


def rule_folder_imports(tree: Tree) -> list[str]:
    """Each import of a folder with rules by another one: what both need is in `findings/`, or in
    `analysis/` if it is a fact of a machine."""
    rules = {
        part_inside(module_name(path), "smachac.checks")
        for path, text in tree.items()
        if path.startswith("smachac/checks/") and has_rule(ast.parse(text))
    }
    pairs = part_pairs(set(import_pairs(tree)), "smachac.checks")
    return sorted(f"{one} imports {other}" for one, other in pairs if {one, other} <= rules)


def part_pairs(pairs: Iterable[tuple[str, str]], room: str) -> set[tuple[str, str]]:
    """Each import between two parts of a room: the importer, the imported."""
    parts = {
        (part_inside(importer, room), part_inside(module, room))
        for importer, module in pairs
        if f"{importer}.".startswith(f"{room}.") and f"{module}.".startswith(f"{room}.")
    }
    return {(one, other) for one, other in parts if one != other}


def part_inside(module: str, room: str) -> str:
    """The part of a room that has a module: a folder or a file directly in the room. The package of
    the room itself, as `smachac.checks`, is a part too."""
    return ".".join(module.split(".")[: room.count(".") + 2])


def floors(pairs: Iterable[tuple[str, str]], room: str) -> int:
    """The number of levels of the imports between the parts of a room: a part is one above the
    highest that it imports. Raises NetworkXUnfeasible if parts import each other."""
    graph: nx.DiGraph[str] = nx.DiGraph(part_pairs(pairs, room))
    return len(list(nx.topological_generations(graph)))


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


@pytest.mark.slow
def test_our_imports_keep_the_order_of_the_layers(ours: Tree) -> None:
    assert list(layer_faults(ours)) == []


@pytest.mark.slow
def test_our_modules_do_not_import_each_other_in_a_circle(ours: Tree) -> None:
    assert import_circles(ours) == []


@pytest.mark.slow
def test_only_the_list_of_our_rules_imports_modules_with_rules(ours: Tree) -> None:
    assert rule_imports(ours) == []


@pytest.mark.slow
def test_our_folders_of_rules_do_not_import_each_other(ours: Tree) -> None:
    assert rule_folder_imports(ours) == []


@pytest.mark.slow
def test_our_rooms_have_few_floors(ours: Tree) -> None:
    pairs = set(import_pairs(ours))
    found = {room: floors(pairs, room) for room in FLOORS}
    assert all(1 < found[room] <= most for room, most in FLOORS.items()), found


def test_our_modules_load_no_heavy_package_when_imported(ours: Tree) -> None:
    assert list(heavy_faults(ours)) == []


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("smachac/commands/cli.py", "import smachac\nfrom smachac import driver, load"),
        ("smachac/targets/__init__.py", "from smachac.version import __version__"),
        ("smachac/driver/__init__.py", "from smachac.frontend.script.lower import lower"),
        ("smachac/ir/graph.py", "from .nodes import Leaf\nfrom .. import diagnostics"),
        ("smachac/targets/runner.py", "import smachac.sim.world"),
        ("smachac/sim/world.py", "def step():\n    import numpy, time"),
        ("smachac/frontend/script/lower.py", "from smachac.frontend.script.resolve import Script"),
    ],
)
def test_imports_from_lower_layers_are_fine(path: str, text: str) -> None:
    assert list(layer_faults(example(path, text))) == []


@pytest.mark.parametrize(
    ("path", "text", "fault"),
    [
        ("smachac/diagnostics/source.py", "import smachac.driver", "1: diagnostics > driver"),
        ("smachac/ir/nodes.py", "from smachac import frontend", "1: ir > frontend"),
        ("smachac/ir/nodes.py", "from ..checks import names", "1: ir > checks"),
        ("smachac/ir/__init__.py", "from .. import frontend", "1: ir > frontend"),
        ("smachac/analysis/context.py", "\nfrom .. import frontend", "2: analysis > frontend"),
        (
            "smachac/checks/names/names.py",
            "def f():\n from smachac.commands.cli import main",
            "2: checks > commands",
        ),
        (
            "smachac/diagnostics/source.py",
            "import typing\nif typing.TYPE_CHECKING:\n    from smachac.ir import nodes",
            "3: diagnostics > ir",
        ),
        ("smachac/driver/__init__.py", "from smachac import load", "1: driver > __init__"),
        (
            "smachac/frontend/script/lower.py",
            "import importlib\nimportlib.import_module('smachac.checks')",
            "2: frontend > checks",
        ),
        ("smachac/runtime/trace.py", "from ..sim import world", "1: runtime > sim"),
        ("smachac/runtime/trace.py", "import smachac.diagnostics", "1: runtime > diagnostics"),
        ("smachac/frontend/script/lower.py", "import smachac.novelty", "1: frontend > novelty"),
    ],
)
def test_imports_against_the_order_are_found(path: str, text: str, fault: str) -> None:
    line, _, rooms = fault.partition(": ")
    lower, _, upper = rooms.partition(" > ")
    expected = f"{path}:{line}: `{lower}` may not import `{upper}`"
    assert list(layer_faults(example(path, text))) == [expected]


@pytest.mark.parametrize(
    ("path", "package"),
    [("smachac/runtime/trace.py", "numpy"), ("smachac/sim/world.py", "networkx")],
)
def test_packages_that_generated_programs_may_not_need_are_found(path: str, package: str) -> None:
    room = path.split("/")[1]
    expected = f"{path}:1: `{room}` may not import the package `{package}`"
    assert list(layer_faults(example(path, f"import {package}"))) == [expected]


def test_a_room_without_a_layer_is_found() -> None:
    expected = "smachac/novelty.py:1: `novelty` has no layer: give it a place in LAYERS"
    assert list(layer_faults(example("smachac/novelty.py", ""))) == [expected]


@pytest.mark.parametrize(
    "text",
    [
        "from smachac.sim import world",
        "from . import world",
        "import smachac.sim.world",
        "def f():\n    from smachac.sim.world import World",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .world import World",
    ],
)
def test_circles_are_found(text: str) -> None:
    tree = {**example("smachac/sim/arm.py", text), "smachac/sim/world.py": "from .arm import Arm"}
    assert import_circles(tree) == ["smachac.sim.arm smachac.sim.world"]


def test_a_package_that_its_own_module_imports_is_a_circle() -> None:
    tree = {"smachac/ir/__init__.py": "from .nodes import Leaf", "smachac/ir/nodes.py": ""}
    assert import_circles(tree) == []
    tree["smachac/ir/nodes.py"] = "from smachac import ir"
    assert import_circles(tree) == ["smachac.ir smachac.ir.nodes"]


RULE = """
from smachac.checks.rule import rule

@rule("SM999", "example", Severity.ERROR)
def example(context): ...
"""


@pytest.mark.parametrize(
    "text",
    [
        "from smachac.checks.timing.stops import witness",
        "from .stops import witness",
        "import smachac.checks.timing.stops",
        "def f():\n    from smachac.checks.timing import stops",
    ],
)
def test_imports_of_modules_with_rules_are_found(text: str) -> None:
    stops = "smachac/checks/timing/stops.py"
    tree = {**example("smachac/checks/timing/timeouts.py", text), stops: ""}
    assert rule_imports(tree) == []
    tree[stops] = RULE
    expected = "smachac.checks.timing.timeouts imports smachac.checks.timing.stops"
    assert rule_imports(tree) == [expected]


@pytest.mark.parametrize("path", ["smachac/checks/__init__.py", "smachac/commands/cli.py"])
def test_the_list_of_rules_imports_modules_with_rules(path: str) -> None:
    text = "from smachac.checks.timing import stops"
    assert rule_imports({path: text, "smachac/checks/timing/stops.py": RULE}) == []


@pytest.mark.parametrize(
    ("path", "text", "fault"),
    [
        ("timing/stops.py", "from smachac.checks.robot import grip", "timing imports robot"),
        ("timing/waits.py", "def f():\n    from ..robot.words import at", "timing imports robot"),
        ("robot/words.py", "import smachac.checks.timing.timeouts", "robot imports timing"),
        ("robot/words.py", "from smachac.checks.robot import grip", None),
        ("timing/waits.py", "from smachac.checks.findings import places", None),
        ("__init__.py", "from smachac.checks.timing import timeouts", None),
    ],
)
def test_imports_of_other_folders_of_rules_are_found(
    path: str, text: str, fault: str | None
) -> None:
    names = ("timing/timeouts.py", "robot/grip.py")
    tree = {f"smachac/checks/{name}": RULE for name in names}
    tree |= {"smachac/checks/robot/words.py": "", "smachac/checks/findings/places.py": ""}
    assert rule_folder_imports(tree) == []
    expected = [fault.replace("timing", "smachac.checks.timing")] if fault else []
    expected = [line.replace("robot", "smachac.checks.robot") for line in expected]
    assert rule_folder_imports({**tree, f"smachac/checks/{path}": text}) == expected


def test_floors_are_levels_of_imports_between_parts() -> None:
    tree = {
        "smachac/checks/__init__.py": "from smachac.checks.robot import grip",
        "smachac/checks/robot/grip.py": "def f():\n    from smachac.checks import rule",
        "smachac/checks/robot/motion.py": "from smachac.checks.robot import grip",
        "smachac/checks/rule.py": "from smachac.ir import nodes",
        "smachac/checks/words.py": "",
        "smachac/ir/nodes.py": "",
    }
    rooms = ("smachac.checks", "smachac.ir", "smachac")
    assert [floors(import_pairs(tree), room) for room in rooms] == [3, 0, 2]
    tree["smachac/checks/rule.py"] = "from smachac.checks.robot import motion"
    with pytest.raises(nx.NetworkXUnfeasible):
        floors(import_pairs(tree), "smachac.checks")


@pytest.mark.parametrize(
    "text",
    [
        "import networkx as nx",
        "class A:\n    from numpy import array",
        "try:\n    import PIL.Image\nexcept ImportError:\n    pass",
        "if TYPE_CHECKING:\n    pass\nelse:\n    import numpy",
    ],
)
def test_heavy_packages_at_the_top_are_found(text: str) -> None:
    assert len(list(heavy_faults(example("smachac/checks/names/names.py", text)))) == 1


@pytest.mark.parametrize(
    "text",
    [
        "def f():\n    import networkx",
        "class A:\n    async def f(self):\n        from jinja2 import Environment",
        "import typing\nif typing.TYPE_CHECKING:\n    from numpy import array",
        "import json",
    ],
)
def test_heavy_packages_in_functions_and_for_types_are_fine(text: str) -> None:
    assert list(heavy_faults(example("smachac/checks/names/names.py", text))) == []


def example(path: str, text: str) -> Tree:
    """A tree with one module of interest, and the empty modules that the texts above name."""
    rooms = ("checks", "commands", "diagnostics", "frontend", "ir", "runtime", "sim", "targets")
    names = ["__init__", "driver", "commands/cli", "ir/nodes", "frontend/resolve", "sim/world"]
    names += [f"{room}/__init__" for room in rooms]
    return {**{f"smachac/{name}.py": "" for name in names}, path: text}

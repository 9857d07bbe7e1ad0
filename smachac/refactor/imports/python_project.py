"""The import of a Python file: its machines as scripts, with a proof of each."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.source import Span
from smachac.driver.python_machines import Built, PythonProject
from smachac.frontend.files import Disk, lies_inside
from smachac.ir.nodes import Leaf, Node
from smachac.ir.traversal import walk
from smachac.pysource.machines.constructions import Constructions
from smachac.pysource.machines.coverage import unknown_states
from smachac.pysource.machines.graph import ELSEWHERE, Graph
from smachac.pysource.machines.project import module_text
from smachac.pysource.modules.python2 import looks_like_python2
from smachac.refactor.imports.project import (
    Imported,
    Incomplete,
    built_in_names,
    completed,
    in_order,
)
from smachac.refactor.imports.scripts import (
    Lost,
    PythonMachine,
    ScriptFiles,
    script_files,
    settings,
)
from smachac.refactor.imports.state_types import OWN_MODULE, relative


def import_python(
    path: Path, folder: Path, disk: Disk, wanted: str | None = None,
    assumed: Mapping[str, bool] | None = None,
) -> Imported:  # fmt: skip
    """The scripts of the machines in a Python file, as they will be in a folder; only of the one
    that is `wanted`. `assumed` are the values of conditions that are not known, by their code.
    Nothing is written."""
    built: list[Built] = []
    project = PythonProject(disk, assumed=assumed)
    file = project.read(path, built=built)
    vain = [code for code in assumed or () if code not in project.used_assumptions()]
    machines, incomplete = _machines(built)
    all_names = [*(machine.label for machine in machines), *(one.name for one in incomplete)]
    machines = [machine for machine in machines if wanted in (None, machine.label)]
    incomplete = [machine for machine in incomplete if wanted in (None, machine.name)]
    names = [*(machine.name for machine in machines), *(one.name for one in incomplete)]
    report, is_read = file.report, file.coverage is not None
    if not machines:
        return Imported(report=report, is_read=is_read, incomplete=incomplete, names=names,
                        all_names=all_names, vain=vain)  # fmt: skip
    ros = max(machine.constructions.ros for machine in machines)
    made = script_files(machines, path, folder, ros, built_in_names())
    made.lost += _lost_in_modules(made, ros, disk)
    folders, outside = _code_folders(made, folder)
    made.lost += _not_found(machines[0].root.span, outside)
    made.texts["smachac.toml"] = settings(folders, ros)
    texts, proofs = completed(made, path, folder, (item.code for item in report), disk)
    return Imported(
        report=report, is_read=is_read, texts=texts, lost=in_order(made.lost), proofs=proofs,
        incomplete=incomplete, names=names, all_names=all_names, vain=vain,
    )  # fmt: skip


def _machines(built: Sequence[Built]) -> tuple[list[PythonMachine], list[Incomplete]]:
    """The machines that are known as a whole, and the others."""
    machines: list[PythonMachine] = []
    incomplete: list[Incomplete] = []
    modules = {module for _, constructions in built for module in constructions.modules}
    taken = {"main", OWN_MODULE, *(name.partition(".")[0].casefold() for name in modules)}
    labels: set[str] = set()
    for graph, constructions in built:
        root = graph.machine.root
        label = _free(root.name, labels)
        labels.add(label.casefold())
        refusals = _refusals(graph, constructions)
        if refusals:
            name = graph.framework.name
            incomplete.append(Incomplete(name=label, unknown=refusals, framework=name))
            continue
        if not _is_known(graph):
            incomplete.append(Incomplete(name=label, unknown=_unknown(graph)))
            continue
        name = _free(re.sub(r"\W+", "_", root.name) or "sm", taken)
        taken.add(name.casefold())
        machines.append(
            PythonMachine(name=name, label=label, root=root, constructions=constructions)
        )
    return machines, incomplete


def _refusals(graph: Graph, constructions: Constructions) -> tuple[tuple[Span, str], ...]:
    """The places of what no script can have, each with the reason."""
    found = {(made.span, f"`{names[-1]}`: {made.refusal}"): None
             for names, made in constructions.states.items() if made.refusal}  # fmt: skip
    return tuple(found)


def _free(word: str, taken: Collection[str]) -> str:
    """A name that is not taken: the word, or one with a number."""
    name, number = word, 2
    while name.casefold() in taken:
        name, number = f"{word}_{number}", number + 1
    return name


def _is_known(graph: Graph) -> bool:
    """Whether all states and transitions of a machine are known, and it has states."""
    nodes = [node for _, node in walk(graph.machine.root)]
    return not any(_is_empty(node) or (isinstance(node, Leaf) and node.synthetic
                                       and node.type == ELSEWHERE) for node in nodes)  # fmt: skip


def _is_empty(node: Node) -> bool:
    return not isinstance(node, Leaf) and not node.children


def _unknown(graph: Graph) -> tuple[tuple[Span, str], ...]:
    empty = {node.span: f"`{node.name}` has no states"
             for _, node in walk(graph.machine.root) if _is_empty(node)}  # fmt: skip
    if empty:
        return tuple(empty.items())
    places = dict(graph.coverage.unknown)
    if not places:
        reasons = unknown_states(graph)
        places = {node.span: reasons[path] for path, node in walk(graph.machine.root)
                  if path in reasons}  # fmt: skip
    return tuple(places.items())


def _code_folders(made: ScriptFiles, folder: Path) -> tuple[list[str], dict[str, list[str]]]:
    """The folders with the modules of the user, from that of the project; and those that a project
    file cannot name, as they are outside its git repository, with their modules."""
    above = (folder.absolute(), *folder.absolute().parents)
    root = next((path for path in above if (path / ".git").exists()), folder)
    inside: list[str] = []
    outside: dict[str, list[str]] = {}
    for name, place in made.modules.items():
        if not lies_inside(Path(place), root):
            outside.setdefault(place, []).append(name)
        elif Path(place) != folder:
            inside.append(relative(place, folder))
    return inside, outside


def _not_found(span: Span, outside: Mapping[str, Sequence[str]]) -> Iterator[Lost]:
    for folder, names in outside.items():
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        yield Lost(
            span=span,
            text=f"the folder `{folder or '.'}`, which has the module `{names[0]}`{more}, is"
            " outside the project, and no git repository has both",
            help=f"set PYTHONPATH={folder or '.'} for the programs, or import into a folder of the"
            " same git repository",
        )


def _lost_in_modules(made: ScriptFiles, ros: int, disk: Disk) -> Iterator[Lost]:
    """What the modules of the user do when a program for a version of ROS imports them."""
    for name, folder in made.modules.items():
        stem = Path(folder, *name.split("."))
        path = stem / "__init__.py" if (stem / "__init__.py").is_file() else stem.with_suffix(".py")
        source = disk.read(path, [])
        text = module_text(source) if source is not None else None
        if source is None or text is None:
            continue
        if looks_like_python2(source):
            yield Lost(span=Span(source, 0, 0), text="this module is code for Python 2",
                       help="port it to Python 3: the programs are in Python 3")  # fmt: skip
        for line in text.tree.body:
            if ros == 2 and "rospy" in _imported(line):
                yield Lost(span=text.span(line), text="this module is code for ROS 1",
                           help="port it to ROS 2: the programs are for ROS 2")  # fmt: skip
            match line:
                case ast.Expr(value=ast.Call(func=called)) if _runs(called):
                    yield Lost(
                        span=text.span(line), text="each program that imports the module runs this",
                        help='put it below `if __name__ == "__main__":`',
                    )  # fmt: skip


def _imported(line: ast.stmt) -> list[str]:
    """The packages that a statement imports."""
    match line:
        case ast.Import(names=names):
            return [alias.name.partition(".")[0] for alias in names]
        case ast.ImportFrom(module=str() as module, level=0):
            return [module.partition(".")[0]]
    return []


def _runs(called: ast.expr) -> bool:
    """Whether a call at the top of a module does the work of a program."""
    match called:
        case ast.Name():
            return True
        case ast.Attribute(attr=name):
            return name in ("execute", "spin", "init_node", "init", "start")
    return False

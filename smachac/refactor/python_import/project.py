"""The import of a Python file: its machines as scripts, with a proof of each."""

from __future__ import annotations

import ast
import hashlib
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source, Span
from smachac.driver import CODES, Analysis, analyse
from smachac.driver.python_machines import Built, PythonFile, PythonProject
from smachac.frontend.files import BUILT_IN, Disk, disk_library, lies_inside
from smachac.ir.nodes import Leaf, Node
from smachac.ir.traversal import walk
from smachac.pysource.coverage import unknown_states
from smachac.pysource.machines.graph import ELSEWHERE, Graph
from smachac.pysource.machines.project import module_text
from smachac.pysource.python2 import looks_like_python2
from smachac.records import dataclass, field
from smachac.refactor.formatter import format_script
from smachac.refactor.python_import.proof import differences
from smachac.refactor.python_import.scripts import (
    Lost,
    PythonMachine,
    ScriptFiles,
    script_files,
    settings,
    state_count,
)
from smachac.refactor.python_import.state_types import OWN_MODULE, in_comment, relative

MARK = re.compile(
    r"(?:# |\{#- )Imported from (.*) by smachac; the lines below have the sha256 ([0-9a-f]{16})\.?"
    r"(?: -#\})?\n"
)
"""The first line of each file of an import. Its digest shows whether the file was edited."""

ROUNDS = 3
"""The most checks of a script: each can show what the faults of the one before have hidden."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """The comparison of the graph of a script with that of its machine in Python. `script` is the
    name of the file, `report` has the errors in it: the faults of the machine in Python."""

    script: str
    states: int
    transitions: int
    differences: tuple[str, ...]
    report: Report = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class Incomplete:
    """A machine that cannot be imported, as parts of it are not known."""

    name: str
    unknown: tuple[tuple[Span, str], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Imported:
    """The project of a Python file: the texts by path, what was not taken over, the proofs, and the
    machines that are not known as a whole. `names` are those of the machines that were wanted,
    `all_names` those of all machines of the file. `vain` are assumed conditions that the file does
    not have, or whose values are known."""

    file: PythonFile
    texts: Mapping[str, str] = field(default_factory=dict)
    lost: Sequence[Lost] = ()
    proofs: Sequence[Proof] = ()
    incomplete: Sequence[Incomplete] = ()
    names: Sequence[str] = ()
    all_names: Sequence[str] = ()
    vain: Sequence[str] = ()


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
    if not machines:
        return Imported(
            file=file, incomplete=incomplete, names=names, all_names=all_names, vain=vain
        )
    ros = max(machine.constructions.ros for machine in machines)
    made = script_files(machines, folder, ros, _built_in_names())
    made.lost += _lost_in_modules(made, file, disk)
    folders, outside = _code_folders(made, folder)
    made.lost += [_not_found(made.main, name) for name in outside]
    made.texts["smachac.toml"] = settings(folders, ros)
    made.texts = _formatted(made.texts)
    proofs = _checked(made, folder, file, disk)
    source = in_comment(str(path), folder)
    texts = {name: _marked(name, text, source) for name, text in sorted(made.texts.items())}
    lost = sorted(made.lost, key=lambda item: (item.span.source.name, item.span.start, item.text))
    return Imported(
        file=file, texts=texts, lost=lost, proofs=proofs, incomplete=incomplete, names=names,
        all_names=all_names, vain=vain,
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
        if not _is_known(graph):
            incomplete.append(Incomplete(name=label, unknown=_unknown(graph)))
            continue
        name = _free(re.sub(r"\W+", "_", root.name) or "sm", taken)
        taken.add(name.casefold())
        machines.append(
            PythonMachine(name=name, label=label, root=root, constructions=constructions)
        )
    return machines, incomplete


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


def _built_in_names() -> list[str]:
    return sorted(path.stem for folder in BUILT_IN for path in folder.glob("*.yml"))


def _code_folders(made: ScriptFiles, folder: Path) -> tuple[list[str], list[str]]:
    """The folders with the modules of the user, from that of the project; and the modules in those
    that a project file cannot name, as they are outside its git repository."""
    above = (folder.absolute(), *folder.absolute().parents)
    root = next((path for path in above if (path / ".git").exists()), folder)
    inside = {
        name: place for name, place in made.modules.items()
        if lies_inside(Path(place), root)
    }  # fmt: skip
    return (
        [relative(place, folder) for place in inside.values() if Path(place) != folder],
        [name for name in made.modules if name not in inside],
    )


def _not_found(main: Mapping[str, PythonMachine], module: str) -> Lost:
    first = next(iter(main.values()))
    folder = first.constructions.modules[module]
    return Lost(
        span=first.root.span,
        text=f"the folder of the module `{module}` is outside the project and no git repository has"
        " both",
        help=f"set PYTHONPATH={folder or '.'} for the programs, or import into a folder of the"
        " same git repository",
    )


def _lost_in_modules(made: ScriptFiles, file: PythonFile, disk: Disk) -> Iterator[Lost]:
    """What the modules of the user do when a program imports them."""
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
            match line:
                case ast.Expr(value=ast.Call(func=called)) if _runs(called):
                    yield Lost(
                        span=text.span(line), text="each program that imports the module runs this",
                        help='put it below `if __name__ == "__main__":`',
                    )  # fmt: skip


def _runs(called: ast.expr) -> bool:
    """Whether a call at the top of a module does the work of a program."""
    match called:
        case ast.Name():
            return True
        case ast.Attribute(attr=name):
            return name in ("execute", "spin", "init_node", "init", "start")
    return False


# --- the check of the scripts


def _checked(made: ScriptFiles, folder: Path, file: PythonFile, disk: Disk) -> list[Proof]:
    """The proofs. A finding that the machine in Python does not have, as it is about one of several
    states of a class for example, is allowed in the script."""
    known = {item.code for item in file.report}
    analyses: dict[str, Analysis] = {}
    for _ in range(ROUNDS):
        source = in_comment(str(file.path), folder)
        texts = {name: _marked(name, text, source) for name, text in made.texts.items()}
        analyses = {name: _analysis(name, texts, folder, disk) for name in made.main}
        places: dict[str, dict[int, set[str]]] = {}
        for analysis in analyses.values():
            for item in analysis.report:
                name = relative(item.span.source.name, folder)
                fault = item.severity is Severity.ERROR and item.code not in known
                if (
                    fault
                    and not item.kind.unsuppressible
                    and name in made.texts
                    and name.endswith(".yml")
                ):
                    places.setdefault(name, {}).setdefault(item.span.line, set()).add(item.code)
        if not places:
            break
        for name, lines in places.items():
            made.texts[name] = _allowed(made.texts[name], lines, in_comment(file.path.name, Path()))
    return [_proof(name, made.main[name], analysis) for name, analysis in analyses.items()]


def _allowed(text: str, places: Mapping[int, set[str]], name: str) -> str:
    """A text with comments that allow findings in some lines of its file, which has one more line
    at its top."""
    lines = text.split("\n")
    for number in sorted(places, reverse=True):
        line = lines[number - 2]
        space = line[: len(line) - len(line.lstrip(" "))]
        codes = ", ".join(sorted(places[number]))
        lines.insert(number - 2, f"{space}# smachac: allow {codes} it is so in {name}")
    return "\n".join(lines)


def _analysis(name: str, texts: Mapping[str, str], folder: Path, disk: Disk) -> Analysis:
    """The analysis of a script that is not on disk."""
    for path, text in texts.items():
        disk.replace(folder / path, text)
    report: Report = []
    source = disk.read(folder / name, report)
    assert source is not None
    library = disk_library(folder / name, report, disk=disk, codes=CODES)
    return analyse(source, library, report)


def _proof(name: str, machine: PythonMachine, analysis: Analysis) -> Proof:
    states, transitions = state_count(machine.root)
    errors = [item for item in analysis.report if item.severity is Severity.ERROR]
    found = ["the script cannot be read"]
    if analysis.machine is not None:
        root = analysis.machine.root
        found = differences(machine.root, root, machine.constructions)
    return Proof(script=name, states=states, transitions=transitions,
                 differences=tuple(found), report=errors)  # fmt: skip


def _formatted(texts: Mapping[str, str]) -> dict[str, str]:
    """The texts, with the scripts in the standard layout."""
    found = dict(texts)
    for name, text in texts.items():
        if name.endswith(".yml") and "/" not in name:
            found[name] = format_script(Source(name, text)) or text
    return found


# --- files of an import


def _marked(name: str, text: str, python: str) -> str:
    """A text below the line that shows where it comes from."""
    digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]
    words = f"Imported from {python} by smachac; the lines below have the sha256 {digest}"
    return f"{{#- {words} -#}}\n{text}" if name.endswith(".tpl.py") else f"# {words}.\n{text}"


def imported_from(text: str) -> str | None:
    """The Python file from which a text was imported, from the folder of the project; None if the
    text is no file of an import, or was edited since."""
    found = MARK.match(text)
    if found is None:
        return None
    rest = text[found.end() :].encode("utf-8", "surrogatepass")
    return found[1] if hashlib.sha256(rest).hexdigest()[:16] == found[2] else None

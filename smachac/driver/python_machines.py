"""Python files with machines of a framework: read, checked by the rules, suppressed."""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from smachac.checks import check_machine, rules
from smachac.diagnostics.diagnostic import Diagnostic, Report, Severity, grouped, in_order
from smachac.diagnostics.severities import apply_severities
from smachac.diagnostics.source import Source, Span, Word
from smachac.driver import CODES, Analysis
from smachac.driver.python_cache import Cache, Known, digest_of
from smachac.frontend.discovery import PYTHON_SUFFIX
from smachac.frontend.errors import python_machines as errors
from smachac.frontend.errors.suppressions import vain_description
from smachac.frontend.files import Disk, disk_library, lies_inside
from smachac.frontend.text.suppressions import MARK, suppress
from smachac.ir.nodes import Machine
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import walk
from smachac.pysource.machines.class_facts import ClassReader
from smachac.pysource.machines.constructions import Constructions, constructions
from smachac.pysource.machines.coverage import Coverage, coverage_of, unknown_states
from smachac.pysource.machines.dead_code import contains
from smachac.pysource.machines.evaluator import Evaluator
from smachac.pysource.machines.graph import Graph, graphs
from smachac.pysource.machines.libraries import FRAMEWORKS
from smachac.pysource.machines.project import Repository, module_text
from smachac.pysource.machines.roots import Roots, machines_of, variants_of
from smachac.pysource.machines.values import UseFault
from smachac.pysource.modules.python2 import (
    INSTALL,
    is_installed,
    looks_like_python2,
    python2_error,
)
from smachac.pysource.modules.source import (
    LONGEST,
    PythonText,
    is_readable,
    is_too_deep,
    syntax_error,
)
from smachac.records import dataclass, replace

CANNOT_WORK = frozenset({
    "SM101", "SM102", "SM103", "SM104", "SM106", "SM201", "SM301", "SM308", "SM309", "SM310",
    "SM403", "SM609",
})  # fmt: skip
"""The codes of rules that are reported of Python files: with such a fault a machine cannot work.
Only errors of these are, because a warning can be about a path that is impossible. A race of two
branches (SM405) is none of them: both can use parts of one value, as entries of a dictionary."""

_ALL_RULES = rules()

_RULES = frozenset(rule.code.code for rule in _ALL_RULES)

IN_ALL = frozenset({"SM201", "SM203"})
"""The codes of findings that count only if they are true of each instance of a container: another
one can have other transitions."""

Built: TypeAlias = tuple[Graph, Constructions]
"""A machine with the constructions of its states."""

MOST_FILES, MOST_ENTRIES = 20_000, 200_000
"""The most Python files, and files and folders, of a repository that are searched for modules."""

_SKIPPED = ("__pycache__", "node_modules", "build", "install", "devel", "log")


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonFile:
    """The machines of a Python file, the findings about them, and how much of them is known; None
    if the file cannot be read."""

    path: Path
    source: Source | None
    graphs: tuple[Graph, ...] = ()
    report: Report
    coverage: Coverage | None = None


class PythonProject:
    """Reads Python files of repositories; modules that several files import are read once, until
    `forget`.
    `cached`: what is known from the last run is used, without the graphs, and kept for the next
    one by `keep`. `assumed` are the values of conditions that are not known, by their code."""

    def __init__(
        self, disk: Disk, *, cached: bool = False, assumed: Mapping[str, bool] | None = None
    ) -> None:
        self.disk = disk
        self.assumed = assumed
        self.cached = cached
        self.caches: dict[str, Cache] = {}
        self.repositories: dict[tuple[str, bool], tuple[Repository, Evaluator, ClassReader]] = {}
        self.readers: dict[tuple[str, bool], tuple[ClassReader, frozenset[str]]] = {}
        self.files: dict[str, list[str]] = {}
        self.trees: dict[tuple[str, bool], tuple[Source, PythonText | None]] = {}

    def read(
        self, path: Path, *, everything: bool = False, built: list[Built] | None = None
    ) -> PythonFile:
        """The machines of a file with the findings about them; with `everything`, those of all
        rules. `built` gets each machine with the constructions of its states."""
        report: Report = []
        source = self.disk.read(path, report)
        library = disk_library(path, report, disk=self.disk, codes=CODES)
        if source is None:
            return PythonFile(path=path, source=None, report=report)
        cache = self._cache(path) if self.cached else None
        key = f"{path} {everything} {library.policy}"
        known = cache.get(key, self._text) if cache is not None else None
        if known is not None:
            return PythonFile(
                path=path, source=source, report=[*report, *known.report], coverage=known.coverage
            )
        if self._tree(source) is None:
            report.append(_unreadable(source))
            found = grouped(apply_severities(in_order(report), library.policy))
            return PythonFile(path=path, source=source, report=found)
        read_before = [*report]
        whole_rules = everything or MARK in source.text  # a comment can be about any finding
        repository, evaluator, reader = self._repository(path, whole_rules)
        del evaluator.faults[:]

        def made(roots: Roots) -> list[Graph]:
            return [*graphs(roots, evaluator, reader)]

        def made_first(roots: Roots) -> list[Graph]:
            found = made(roots)
            if built is not None:
                built.extend((graph, constructions(graph, evaluator, repository))
                             for graph in found)  # fmt: skip
            return found

        with deep_recursion():
            several = machines_of(repository, evaluator, str(path), made_first)
            whole = [graph for some in several for graph in some]
            findings = [item for graph in whole for item in _checked(graph, whole=whole_rules)]
            findings = _in_file(findings, str(path))
            variants: list[Graph] = []
            stops = _stops(whole)
            if any(item.code in IN_ALL and (everything or _is_default(item, stops))
                   for item in findings):  # fmt: skip
                some = variants_of(repository, evaluator, str(path), made)
                variants = [graph for several in some for graph in several]
                more = (item for graph in variants for item in _checked(graph, whole=whole_rules))
                own = _in_file([*more], str(path))
                findings += [item for item in own if item.code in IN_ALL]
        report += _true_of_all(findings, [graph.machine for graph in (*whole, *variants)])
        report += _of_uses([*evaluator.faults, *repository.faults_of(str(path))])
        report += map(vain_description, reader.comments.unused(source))
        if evaluator.exhausted and not whole:
            report.append(_too_long(source))
        self.disk.searched.update(repository.files_of(str(path)))
        rest, _, _ = suppress([*map(_of_python, report)], source, (source,), CODES)
        if not everything:
            rest = [item for item in rest if _is_default(item, stops)]
        found = grouped(apply_severities(in_order(rest), library.policy))
        coverage = coverage_of(whole)
        if cache is not None and not read_before:
            cache.set(key, Known(report=found, coverage=coverage))
        return PythonFile(
            path=path, source=source, graphs=tuple(whole), report=found, coverage=coverage
        )

    def forget(self, changed: Collection[str]) -> None:
        """Reads again what the change of some files, by real path, concerns. Texts that are the
        same keep their trees, and classes their facts, unless a module has changed that other code
        imports."""
        for key, (repository, _, reader) in self.repositories.items():
            modules = {*repository.loaded, *filter(None, reader.files.values())}
            self.readers[key] = reader, frozenset(map(os.path.realpath, modules))
        self.repositories.clear()
        for key, (reader, read) in [*self.readers.items()]:
            if not read.isdisjoint(changed):
                del self.readers[key]
                continue
            for file in [file for file in reader.modules if os.path.realpath(file) in changed]:
                reader.forget(file)

    def list_again(self) -> None:
        """Lists the files of repositories again: some may be new or gone."""
        self.files.clear()
        self.readers.clear()
        self.repositories.clear()
        self.trees.clear()

    def used_assumptions(self) -> frozenset[str]:
        """The conditions that were not known and whose assumed values were needed."""
        known = (evaluator.used for _, evaluator, _ in self.repositories.values())
        return frozenset().union(*known)

    def keep(self) -> None:
        """Writes what is known for the next run."""
        for cache in self.caches.values():
            cache.write()

    def _cache(self, path: Path) -> Cache:
        root = repository_of(path)
        name = os.path.realpath(root)
        if name not in self.caches:
            read = ((str(file), self._text(str(file))) for file in python_files(root))
            texts = ((file, source.text) for file, source in read if source is not None)
            self.caches[name] = Cache(f"{name} {Path.cwd()}", digest_of(texts))
        return self.caches[name]

    def _repository(
        self, path: Path, everything: bool
    ) -> tuple[Repository, Evaluator, ClassReader]:
        root = repository_of(path)
        key = os.path.realpath(root), everything
        if key not in self.repositories:
            if key[0] not in self.files:
                self.files[key[0]] = [*map(str, python_files(root))]
            repository = Repository(self.files[key[0]], self._text, self._tree)
            evaluator = Evaluator(repository, self.assumed)
            reader, _ = self.readers.pop(key, (ClassReader(repository, whole=everything), ()))
            reader.repository = repository
            self.repositories[key] = repository, evaluator, reader
        return self.repositories[key]

    def _text(self, file: str) -> Source | None:
        return self.disk.read(Path(file), [])

    def _tree(self, source: Source, *, compiled: bool = True) -> PythonText | None:
        """As `module_text`; each text is parsed once."""
        key = source.name, compiled
        known = self.trees.get(key)
        if known is None or known[0] != source:
            known = self.trees[key] = source, module_text(source, compiled=compiled)
        return known[1]


def repository_of(path: Path) -> Path:
    """The folder in which the modules of a file are searched: that of its git repository, or that
    of its package of ROS and of the packages beside it, or its own."""
    folder = path.parent
    above = [folder, *Path(os.path.abspath(folder)).parents]  # noqa: PTH100
    for parent in above:
        if (parent / ".git").exists():
            return _as_given(parent, path)
    for parent in above[:8]:
        if (parent / "package.xml").is_file():
            beside = len([*parent.parent.glob("*/package.xml")])
            return _as_given(parent.parent if beside > 1 else parent, path)
    return folder


def _as_given(folder: Path, path: Path) -> Path:
    """A folder relative to the current one, or absolute as a path in it, so that findings name
    files as users write them."""
    return folder if path.is_absolute() else Path(os.path.relpath(folder))


def python_files(folder: Path) -> Iterator[Path]:
    """The Python files below a folder, sorted; no links that lead out of it. Of a very large folder
    only the first ones."""
    count = visited = 0
    for top, folders, names in os.walk(folder):
        folders[:] = [name for name in sorted(folders)
                      if not name.startswith(".") and name not in _SKIPPED]  # fmt: skip
        visited += 1 + len(names)
        if visited > MOST_ENTRIES or count >= MOST_FILES:
            return
        for name in sorted(name for name in names if name.endswith(PYTHON_SUFFIX)):
            path = Path(top, name)
            if not path.is_symlink() or lies_inside(path, folder):
                count += 1
                yield path


def files_with_machines(folder: Path, disk: Disk) -> list[Path]:
    """The Python files below a folder whose text names a container of a framework."""
    found = []
    for path in python_files(folder):
        source = disk.read(path, [])
        if source is not None and builds_machines(source):
            found.append(path)
    return found


def builds_machines(source: Source) -> bool:
    """Whether the text of a Python file names a framework and one of its containers."""
    text = source.text
    return any(
        framework.packages[0] in text
        and any(name.rpartition(".")[2] in text for name in framework.containers)
        for framework in FRAMEWORKS
    )


def _unreadable(source: Source) -> Diagnostic:
    if looks_like_python2(source) and not is_installed():
        span = Span(source, 0, 0)
        return errors.unreadable_module(span, "this is code for Python 2", INSTALL)
    word = None if is_too_deep(source.text) else syntax_error(source)
    if word is None:
        span = Span(source, 0, 0)
        message = "the code in this file is nested more deeply than smachac reads"
        help = "assign parts of its longest expression to variables"
        if len(source.text) > LONGEST:
            message, help = f"this file has more than {LONGEST:,} characters", "split the file"
        elif not is_readable(source.text):
            message = "lines of this file end with a carriage return alone"
            help = "end its lines with a line feed"
        return errors.unreadable_module(span, message, help)
    message = f"this is not valid Python 3: {word.text.partition('. Maybe you meant')[0]}"
    help, place = "correct the code at the mark", word.span
    of_python2 = python2_error(source) if looks_like_python2(source) else None
    if of_python2 is not None:
        message, place = "this is valid neither in Python 2 nor in Python 3", of_python2
        if place.start == len(source.text):
            help = "close the bracket or text that is open at the end of the file"
    if place.source.line(place.line).startswith("<<<<<<<"):
        help = "keep one version, and remove the lines with `<<<<<<<`, `=======` and `>>>>>>>`"
    return errors.unreadable_module(place, message, help)


def _stops(graphs: Sequence[Graph]) -> frozenset[str]:
    """The codes of rules that are reported by default: with such a fault a machine cannot work in
    its framework."""
    frameworks = {graph.framework.name: graph.framework for graph in graphs}.values()
    return frozenset().union(*(
        CANNOT_WORK if framework.effects is None else framework.effects.keys() - framework.works
        for framework in frameworks
    ))  # fmt: skip


def _checked(graph: Graph, *, whole: bool) -> Iterator[Diagnostic]:
    """The findings of rules about a machine: of all if `whole`. For a framework with other rules
    they are the errors that are faults in it too, with their effects in its terms."""
    effects = graph.framework.effects
    stops = _stops([graph])
    chosen = tuple(rule for rule in _ALL_RULES if whole or rule.code.code in stops)
    for item in check_machine(graph.machine, chosen):
        if effects is None:
            yield item
        elif item.severity is Severity.ERROR and item.code in effects:
            effect = effects[item.code] or item.effect
            yield replace(item, finding=replace(item.finding, effect=effect))


def _is_default(item: Diagnostic, stops: frozenset[str]) -> bool:
    """Whether a finding is reported by default: not those of rules about what can work."""
    of_rule = item.code in _RULES
    return not of_rule or (item.code in stops and item.severity is Severity.ERROR)


def _of_python(item: Diagnostic) -> Diagnostic:
    """A finding as it is reported of a Python file. It has no repair: those of rules write YAML. It
    can be allowed and be in a baseline, as no program is generated."""
    finding = replace(item.finding, edits=(), repairs=())
    return replace(item, kind=replace(item.kind, unsuppressible=False), finding=finding)


def _too_long(source: Source) -> Diagnostic:
    message = "reading this file takes too many steps, before it has built a machine"
    help = "build the machine in a function that needs no long loop"
    return errors.unreadable_module(Span(source, 0, 0), message, help)


def _in_file(findings: Report, file: str) -> Report:
    """The findings, without those of IN_ALL in other files: other machines can have instances of
    the same code."""
    return [item for item in findings if item.code not in IN_ALL or item.span.source.name == file]


def _true_of_all(findings: Report, machines: Sequence[Machine]) -> Iterator[Diagnostic]:
    """The findings, without those about a state that another instance of the same code does not
    have."""
    counted: Counter[Span] = Counter()
    for machine in machines:
        counted.update(node.span for _, node in walk(machine.root))
    found = Counter((item.code, item.span) for item in findings)
    for item in findings:
        single = item.code not in IN_ALL or found[item.code, item.span] >= counted[item.span]
        if single:
            yield item


def _of_uses(faults: Sequence[UseFault]) -> Iterator[Diagnostic]:
    """The findings about wrong uses of a framework; the names that a module lacks are one for each
    file that uses them."""
    members: dict[tuple[Source, str, str], list[Word]] = {}
    for fault in dict.fromkeys(faults):
        name = fault.names[0] if fault.names else ""
        match fault.kind:
            case "text as list":
                yield errors.text_as_list(Word(name, fault.span))
            case "shared transitions":
                yield errors.shared_transitions(fault.span, name, fault.other)
            case "missing member":
                _, module, home = fault.names
                which = fault.span.source, module, home
                members.setdefault(which, []).append(Word(name, fault.span))
            case "repeated key":
                yield errors.repeated_key(Word(name, fault.span), fault.other)
            case "state named as outcome":
                yield errors.state_named_as_outcome(Word(name, fault.span))
            case "no such start state":
                yield errors.no_start_state(Word(name, fault.span))
            case _:
                yield errors.wrong_call(fault.span, fault.kind, fault.names)
    for (_, module, home), words in members.items():
        yield errors.missing_member(module, words, home)


def graphs_by_name(file: PythonFile) -> Mapping[str, Graph]:
    """The machines of a file by name; later ones of a name have a number."""
    named: dict[str, Graph] = {}
    for graph in file.graphs:
        own = graph.machine.root.name
        name, number = own, 2
        while name in named:
            name, number = f"{own}_{number}", number + 1
        named[name] = graph
    return named


def analyses_by_name(file: PythonFile) -> Mapping[str, Analysis]:
    """Each machine of a file with its findings, by the names of the machines. `checked` is empty:
    no program can be generated."""
    places = [node.span for graph in file.graphs for _, node in walk(graph.machine.root)]
    return {
        name: Analysis(
            script=str(file.path), source=file.source, machine=drawn(graph, name),
            report=_renamed(_of_machine(file.report, graph.machine, places),
                            graph.machine.root.name, name),
        )
        for name, graph in graphs_by_name(file).items()
    }  # fmt: skip


def drawn(graph: Graph, name: str) -> Machine:
    """A machine with a name, and with what pictures show of it: the digest of its files, and the
    states that are not known exactly."""
    machine = graph.machine
    machine = replace(machine, root=replace(machine.root, name=name))
    unknown = unknown_states(graph._replace(machine=machine))
    digest = hashlib.sha256()
    for source in dict.fromkeys(node.span.source for _, node in walk(machine.root)):
        digest.update(source.text.encode("utf-8", "surrogatepass"))
        digest.update(b"\0")
    return replace(machine, base="", digest=digest.hexdigest(), unknown=unknown)


def _of_machine(report: Report, machine: Machine, places: Sequence[Span]) -> Report:
    """The findings of a file that are about one of its machines. One about no state belongs to the
    machines with a call around it, or to all. `places` are the calls of all machines."""
    with deep_recursion():
        own = {(item.code, item.span) for item in check_machine(machine)}
    calls = [node.span for _, node in walk(machine.root)]

    def is_own(item: Diagnostic) -> bool:
        if item.finding.node is not None:
            return (item.code, item.span) in own
        inside = [place for place in calls if contains(place, item.span)]
        return bool(inside) or not any(contains(place, item.span) for place in places)

    return [item for item in report if is_own(item)]


def _renamed(report: Report, old: str, new: str) -> Report:
    """Findings about a machine that has another name, in the paths of its states."""
    return [
        replace(item, finding=replace(item.finding, node=new + item.finding.node[len(old) :]))
        if item.finding.node is not None and old != new
        else item
        for item in report
    ]

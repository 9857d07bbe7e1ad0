"""The commands that move or rename states: worked out in memory, proven, then shown or written."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Container, Iterator, Mapping
from functools import partial
from pathlib import Path

from smachac.commands.fmt import put
from smachac.commands.output import FINDINGS, print_report, usage
from smachac.diagnostics.diagnostic import Code, Diagnostic, Finding, Report, Severity, has_errors
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.spelling import is_plain
from smachac.driver import CODES, Analysis, analyse
from smachac.frontend.discovery import scripts_of
from smachac.frontend.files import Disk, disk_library
from smachac.frontend.loader import Library
from smachac.frontend.smacha_meta import keys_in_code
from smachac.frontend.yaml_tree import Map
from smachac.ir.nodes import Leaf, Machine, Node, StateMachine, StateType
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import walk
from smachac.refactor.contain import contain, equal_after_contain, plan_container, preset_keys
from smachac.refactor.cst import Atom, UnsupportedYamlError
from smachac.refactor.editor import RefusedError, ScriptEditor
from smachac.refactor.equivalence import equal_after_rename, same_machine
from smachac.refactor.extract_inline import extract, inline
from smachac.refactor.locate import NotFoundError, different_container_error, find_named, find_state
from smachac.refactor.open_states import TemplateFacts, with_inferred_interfaces
from smachac.refactor.rename import Renaming, rename_key, rename_outcome, rename_state

Texts = Mapping[str, str]

NO_ERRORS = "mend these errors first, for nobody knows what the machine would be"


class Desk:
    """One script with all it is made of, before a change; line ends are line feeds alone."""

    def __init__(self, arguments: Namespace) -> None:
        self.arguments = arguments
        self.path: Path = arguments.script
        self.disk = Disk(plain=True)
        self.analysis = self.read(self.disk)
        self.sheets: dict[str, ScriptEditor] = {}
        self.made: dict[str, str] = {}

    def read(self, disk: Disk, path: Path | None = None) -> Analysis:
        """What there is to say of the script, or of another one, read from a disk."""
        path = path or self.path
        report: Report = []
        source = disk.read(path, report)
        if source is None:
            return Analysis(report=report)
        library = disk_library(
            path,
            report,
            scripts=self.arguments.scripts,
            templates=self.arguments.templates,
            disk=disk,
            codes=CODES,
        )
        return analyse(source, library, report)

    def library(self) -> Library:
        """What the script may call and use, as it was before."""
        return disk_library(self.path, [], scripts=self.arguments.scripts,
                            templates=self.arguments.templates, disk=self.disk)  # fmt: skip

    @property
    def machine(self) -> Machine:
        """The machine before the change. Raises RefusedError where the script has errors."""
        if self.analysis.checked is None:
            place = Span(Source(str(self.path), ""), 0, 0)
            raise RefusedError(place, NO_ERRORS)
        return self.analysis.checked

    def sheet(self, source: Source) -> ScriptEditor:
        """The text that a source holds, to be changed."""
        name = os.path.realpath(source.name)
        if name not in self.sheets:
            try:
                self.sheets[name] = ScriptEditor(source)
            except UnsupportedYamlError as error:
                words = f"{source.name} cannot be rewritten: {error}"
                raise RefusedError(Span(source, 0, 0), words) from error
        return self.sheets[name]

    def texts(self) -> dict[str, str]:
        """What has become of the texts, by real path; those that stay the same are left out."""
        found = {name: sheet.result() for name, sheet in self.sheets.items()}
        changed = {
            name: text for name, text in found.items() if text != self.sheets[name].source.text
        }
        return {**changed, **self.made}

    def others(self, changed: Container[str]) -> Iterator[tuple[Path, Machine]]:
        """The machines of the other scripts beside this one that use one of these files, as far as
        they have no errors."""
        mine = os.path.realpath(self.path)
        for path in scripts_of([self.path.parent], self.disk):
            if os.path.realpath(path) == mine:
                continue
            self.disk.asked.clear()
            source = self.disk.read(path, [])
            if source is None or not isinstance(self.disk.parse(source, []), Map):
                continue
            found = self.read(self.disk, path)
            if found.checked is not None and any(name in changed for name in self.disk.asked):
                yield path, found.checked

    def proven(self, span: Span, same: Callable[[Machine, Machine], bool]) -> Analysis:
        """The script after the change. Raises RefusedError unless it is as good as before, and so
        is every other script beside it that uses a file that changes."""
        texts = self.texts()
        disk = Disk(texts, plain=True)
        after = self.read(disk)
        if after.checked is None:
            first = next(item for item in after.report if item.severity is Severity.ERROR)
            message = f"the script would have an error: {first.finding.message}"
            anchors = "alias" in first.finding.message
            help = "write out what the alias stands for" if anchors else first.finding.help
            raise RefusedError(span, message, help)
        if not same(self.machine, after.checked):
            raise RefusedError(span, "the machine would not do the same any more")
        for path, machine in self.others(texts.keys() - {os.path.realpath(self.path)}):
            other = self.read(disk, path).checked
            if other is None or not same(machine, other):
                raise RefusedError(span, f"{path} would not do the same any more")
        return after

    def written(self) -> int:
        """Write what has become, or show it; the exit code."""
        texts: dict[str, str] = {}
        sources: dict[str, Source] = {}
        disk = Disk()
        for name, text in self.texts().items():
            shown = next((sheet.source.name for path, sheet in self.sheets.items() if path == name),
                         os.path.relpath(name))  # fmt: skip
            if name in self.made:
                texts[name], sources[name] = text, Source(shown, "")
                continue
            before = disk.read(Path(shown), [])
            assert before is not None
            crlf = "\r\n" in before.text[: before.text.find("\n") + 1]
            texts[name] = text.replace("\n", "\r\n") if crlf else text
            sources[name] = before
        if not texts:
            print("nothing to do")
        return put(texts, sources, self.arguments, "changed", new=frozenset(self.made))


def perform(arguments: Namespace, verb: str, change: Callable[[Desk], int]) -> int:
    """Run one of the commands below, and tell why it cannot be done."""
    with deep_recursion():
        desk = Desk(arguments)
        try:
            if desk.analysis.checked is None:
                errors = (each for each in desk.analysis.report if has_errors([each]))
                print_report(list(errors), arguments, sys.stderr)
            return change(desk)
        except NotFoundError as error:
            return usage(str(error))
        except RefusedError as error:
            if error.message == NO_ERRORS and has_errors(desk.analysis.report):
                if desk.analysis.machine is not None:
                    print(f"nothing was changed: {error.message}", file=sys.stderr)
                return FINDINGS
            code = Code(code=verb, name=verb, severity=Severity.ERROR, explanation="")
            finding = Finding(span=error.span, message=error.message, help=error.help)
            told = Diagnostic(code=code, severity=Severity.ERROR, finding=finding)
            print_report([told], arguments, sys.stderr)
            return FINDINGS


def run_extract(arguments: Namespace) -> int:
    """Make a sub-script of a container."""

    def change(desk: Desk) -> int:
        path, node = find_state(desk.machine, arguments.state)
        if path == desk.machine.root.name:
            raise RefusedError(node.span, "this is the whole script")
        sheet = desk.sheet(node.span.source)
        folder = Path(node.span.source.name).parent
        name = arguments.to or Path(f"{node.name.lower()}.yml")
        target = folder / name
        if name.suffix not in (".yml", ".yaml") or len(name.parts) != 1:
            return usage("--to wants the name of a file beside the script, such as `pick.yml`")
        text = extract(sheet, node.span, name.stem)
        if target.exists() or desk.disk.is_file(target):
            raise RefusedError(node.span, f"{target} is there already", "choose another: --to")
        desk.made[os.path.realpath(target)] = text
        desk.proven(node.span, same_machine)
        return desk.written()

    return perform(arguments, "extract", change)


def run_inline(arguments: Namespace) -> int:
    """Put a sub-script in the place of its call."""

    def change(desk: Desk) -> int:
        _, node = find_state(desk.machine, arguments.state)
        sheet = desk.sheet(node.span.source)
        sub = _called(desk, node)
        inline(sheet, node.span, ScriptEditor(sub))
        desk.proven(node.span, same_machine)
        return desk.written()

    return perform(arguments, "inline", change)


def run_rename(arguments: Namespace) -> int:
    """Give a state, an outcome or a key another name."""
    if not is_plain(arguments.new):
        return usage(f"`{arguments.new}` is no name that YAML takes as it stands")

    def change(desk: Desk) -> int:
        kind, declared, old = find_named(desk.machine, arguments.path, arguments.kind)
        if old == arguments.new:
            return desk.written()
        _check_written(desk.machine, kind, declared, old)
        work = Renaming(old, arguments.new, desk.sheet)
        rename = {"state": rename_state, "outcome": rename_outcome, "key": rename_key}[kind]
        rename(work, desk.machine, declared)
        shared = desk.sheets.keys() - {os.path.realpath(desk.path)}
        for _, machine in desk.others(shared) if shared else ():
            rename(work, machine, declared)
        desk.proven(declared, lambda one, other: equal_after_rename(one, other, old, arguments.new))
        return desk.written()

    return perform(arguments, "rename", change)


def _check_written(machine: Machine, kind: str, declared: Span, old: str) -> None:
    """Raises RefusedError where a name does not stand in a script for itself."""
    nodes = [node for _, node in walk(machine.root)]
    texts = {id(node.span.source) for node in nodes}
    mine = next((node for node in nodes
                 if any(each.span == declared for each in node.outcomes)), None)  # fmt: skip
    if kind == "outcome" and mine is not None and id(declared.source) not in texts:
        message = f"`{old}` is an outcome of the state type `{mine.type}`, whatever its name here"
        help = f"rename it in the interface of `{mine.type}`, or put the state into a container"
        raise RefusedError(mine.span, message, help)
    if kind != "key" and declared.text.strip("'\"") != old:
        message = f"nobody wrote `{old}` here: it comes from the language, or from a look-up"
        raise RefusedError(declared, message)


def run_contain(arguments: Namespace) -> int:
    """Put states into a container of their own."""
    if not is_plain(arguments.name):
        return usage(f"`{arguments.name}` is no name that YAML takes as it stands")

    def change(desk: Desk) -> int:
        before = desk.machine
        path, _ = find_state(before, arguments.states[0])
        above = path.rpartition("/")[0]
        if not above:
            raise RefusedError(before.root.span, "this is the whole script")
        _, parent = find_state(before, above)
        assert not isinstance(parent, Leaf)
        if isinstance(parent, StateMachine):
            told = partial(_told, before.state_types, desk.library())
            parent = with_inferred_interfaces(parent, told)
        known = {child.name: child for child in parent.children}
        names = [each.rpartition("/")[2] for each in arguments.states]
        for name in names:
            if name not in known:
                raise different_container_error(before, above, name, known)
        inside = [child for child in parent.children if child.name in names]
        presets = preset_keys(desk.sheet(inside[0].span.source), inside)
        made = plan_container(parent, inside, presets, arguments.name, arguments.type)
        contain(desk.sheet, made)
        after = desk.proven(inside[0].span, lambda one, two: equal_after_contain(one, two, made))
        _no_worse(desk.analysis, after, inside[0].span)
        return desk.written()

    return perform(arguments, "contain", change)


def _told(types: Mapping[str, StateType], library: Library, leaf: Leaf) -> TemplateFacts:
    """The keys in the template of a state without an interface."""
    type_ = types.get(leaf.type)
    template = library.template(type_.code.get("python", "")) if type_ is not None else None
    if type_ is None or template is None:
        return TemplateFacts()
    reads, writes = keys_in_code(template)
    listed = any(variable.name == "outcomes" for variable in leaf.written)
    return TemplateFacts(reads=reads, writes=writes, outcomes=listed or bool(type_.outcomes))


def _no_worse(before: Analysis, after: Analysis, span: Span) -> None:
    """Raises RefusedError where the flow of data has a fault that it had not."""

    def flaws(analysis: Analysis) -> Counter[str]:
        grave = (each for each in analysis.report if each.severity is not Severity.INFO)
        return Counter(each.code.code for each in grave if each.code.code.startswith("SM3"))

    new = flaws(after) - flaws(before)
    found = next((item for item in after.report if item.code.code in new), None)
    if found is not None:
        message = f"the script would have a fault: {found.finding.message} ({found.code.code})"
        raise RefusedError(span, message, found.finding.help)


def _called(desk: Desk, node: Node) -> Source:
    """The text of the sub-script that a state calls. Raises RefusedError."""
    from smachac.refactor.editor import variable
    from smachac.refactor.field_order import variables_of

    sheet = desk.sheet(node.span.source)
    body = variables_of(sheet.state(node.span).item)
    script = variable(body, "script") if body is not None else None
    if script is None:
        help = "`smachac extract` is what goes the other way"
        raise RefusedError(node.span, f"`{node.name}` calls no sub-script", help)
    words = script.value.text.strip("'\"") if isinstance(script.value, Atom) else ""
    found = desk.library().script(words, node.span.source.name)
    if found is None:
        message = "the name of the sub-script comes from a look-up"
        raise RefusedError(node.span, message, "write it out first")
    return found

"""The commands `contain`, `extract`, `inline` and `rename`.

A change is made in memory. The changed script is analysed again and compared with the script
before; only a change that keeps its behaviour is shown or written.
"""

from __future__ import annotations

import argparse
import os
import sys
from argparse import Namespace
from collections import Counter
from contextlib import suppress

from smachac.commands.arguments import SCRIPT, as_path, colour, dry_run, search_folders
from smachac.commands.output import FINDINGS, print_report, usage

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterator, Mapping
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Source, Span
    from smachac.driver import Analysis
    from smachac.frontend.files import Disk
    from smachac.frontend.loader import Library
    from smachac.ir.nodes import Leaf, Machine, Node, StateType
    from smachac.refactor.editor import ScriptEditor
    from smachac.refactor.open_states import TemplateFacts

EXIT_CODES = """\
exit codes: 0 success, 1 refused, or a file would change (--check, --diff), 2 wrong usage,
70 a bug in smachac
"""

CONTAIN_EXAMPLES = f"""\
examples:
  smachac contain main.yml LOAD StateMachine LOAD_TABLE LOAD_BLOCK   two states in sequence
  smachac contain main.yml LOOK Concurrence FIND WARM_UP             at the same time from now on
  smachac contain main.yml LOAD StateMachine LOAD_TABLE LOAD_BLOCK --diff   show a patch

{EXIT_CODES}"""

EXTRACT_EXAMPLES = f"""\
examples:
  smachac extract main.yml PICK_BLOCK              into pick_block.yml beside main.yml
  smachac extract main.yml sm/PICK --to grasp.yml  into a file with another name
  smachac extract main.yml PICK_BLOCK --diff       show a patch

{EXIT_CODES}"""

INLINE_EXAMPLES = f"""\
examples:
  smachac inline main.yml PICK_BLOCK         replace the call of pick_block.yml by its content
  smachac inline main.yml PICK_BLOCK --diff  show a patch

{EXIT_CODES}"""

RENAME_EXAMPLES = f"""\
examples:
  smachac rename main.yml PICK_BLOCK GRASP        a state, and the transitions to it
  smachac rename main.yml PICK_BLOCK/aborted lost an outcome, inside the state and around it
  smachac rename main.yml block_pose part_pose    a key of the machine
  smachac rename main.yml PICK_BLOCK/pose goal    a key of a container
  smachac rename main.yml done ready --kind key   if the name stands for several things

{EXIT_CODES}"""


def contain_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = CONTAIN_EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("name", metavar="NAME", help="the name of the new container")
    parser.add_argument("type", metavar="TYPE", choices=("StateMachine", "Concurrence"),
                        help="StateMachine or Concurrence")  # fmt: skip
    parser.add_argument("states", metavar="STATE", nargs="+",
                        help="states of one container, by name or path")  # fmt: skip
    _common_arguments(parser)


def extract_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXTRACT_EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("state", metavar="STATE",
                        help="a container, by its path or the end of its path")  # fmt: skip
    parser.add_argument("--to", type=as_path, metavar="FILE",
                        help="name of the new file (default: that of the state)")  # fmt: skip
    _common_arguments(parser)


def inline_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = INLINE_EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("state", metavar="STATE", help="a state that calls a sub-script, by its"
                        " path or the end of its path")  # fmt: skip
    _common_arguments(parser)


def rename_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = RENAME_EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("path", metavar="PATH", help="a state, by its path or the end of its path;"
                        " or such a path and the name of an outcome or a key")  # fmt: skip
    parser.add_argument("new", metavar="NEW", help="the new name")
    parser.add_argument("--kind", choices=("state", "outcome", "key"),
                        help="what PATH names, if it is ambiguous")  # fmt: skip
    _common_arguments(parser)


def _common_arguments(parser: argparse.ArgumentParser) -> None:
    dry_run(parser)
    search_folders(parser)
    colour(parser)


class HasErrorsError(Exception):
    """The script has errors, so its machine is not known."""


class EditedScript:
    """One script with all texts it is read from, before a change, with line feeds as line ends."""

    def __init__(self, arguments: Namespace) -> None:
        from smachac.frontend.files import Disk

        self.arguments = arguments
        self.path: Path = arguments.script
        self.disk = Disk(plain=True)
        self.analysis = self.read(self.disk)
        self.editors: dict[str, ScriptEditor] = {}
        self.made: dict[str, str] = {}

    def read(self, disk: Disk, path: Path | None = None) -> Analysis:
        """The analysis of the script, or of another one, read from a disk."""
        from smachac.driver import CODES, Analysis, analyse
        from smachac.frontend.files import disk_library

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
        """The library of the script before the change."""
        from smachac.frontend.files import disk_library

        return disk_library(self.path, [], scripts=self.arguments.scripts,
                            templates=self.arguments.templates, disk=self.disk)  # fmt: skip

    @property
    def machine(self) -> Machine:
        """The machine before the change. Raises HasErrorsError."""
        if self.analysis.checked is None:
            raise HasErrorsError
        return self.analysis.checked

    def editor(self, source: Source) -> ScriptEditor:
        """The editable text of a source. Raises RefusedError."""
        from smachac.diagnostics.source import Span
        from smachac.refactor.cst import UnsupportedYamlError
        from smachac.refactor.editor import RefusedError, ScriptEditor

        name = os.path.realpath(source.name)
        if name not in self.editors:
            try:
                self.editors[name] = ScriptEditor(source)
            except UnsupportedYamlError as error:
                words = f"{source.name} cannot be rewritten: {error}"
                raise RefusedError(Span(source, 0, 0), words) from error
        return self.editors[name]

    def texts(self) -> dict[str, str]:
        """The changed texts and the new ones, by real path."""
        found = {name: editor.result() for name, editor in self.editors.items()}
        changed = {
            name: text for name, text in found.items() if text != self.editors[name].source.text
        }
        return {**changed, **self.made}

    def others(self, changed: Container[str]) -> Iterator[tuple[Path, Machine]]:
        """The machines of the other scripts in the same folder that use one of these files and have
        no errors."""
        from smachac.frontend.discovery import scripts_of
        from smachac.frontend.yaml_tree import Map

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
        """The script after the change. Raises RefusedError unless it and every other script in the
        folder that uses a changed file behave as before."""
        from smachac.diagnostics.diagnostic import Severity
        from smachac.frontend.files import Disk
        from smachac.refactor.editor import RefusedError

        texts = self.texts()
        disk = Disk(texts, plain=True)
        after = self.read(disk)
        if after.checked is None:
            first = next(item for item in after.report if item.severity is Severity.ERROR)
            message = f"the script would have an error: {first.message}"
            alias = first.code == "SM001" and first.span.text.startswith("*")
            help = "replace the alias by its value" if alias else first.help
            raise RefusedError(span, message, help)
        if not same(self.machine, after.checked):
            raise RefusedError(span, "the machine would behave differently")
        for path, machine in self.others(texts.keys() - {os.path.realpath(self.path)}):
            other = self.read(disk, path).checked
            if other is None or not same(machine, other):
                raise RefusedError(span, f"the machine of {path} would behave differently")
        return after

    def put(self) -> int:
        """Write the changes, or show them; the exit code."""
        from pathlib import Path

        from smachac.commands.files import put_changes
        from smachac.diagnostics.source import Source
        from smachac.frontend.files import Disk
        from smachac.refactor.line_ends import with_line_ends

        texts: dict[str, str] = {}
        sources: dict[str, Source] = {}
        disk = Disk()
        script = disk.read(self.path, [])
        for name, text in self.texts().items():
            known = self.editors.get(name)
            shown = known.source.name if known is not None else os.path.relpath(name)
            if name in self.made:
                texts[name] = with_line_ends(text, script.text) if script is not None else text
                sources[name] = Source(shown, "")
                continue
            before = disk.read(Path(shown), [])
            assert before is not None
            texts[name] = with_line_ends(text, before.text)
            sources[name] = before
        if not texts:
            print("nothing to change")
        return put_changes(texts, sources, self.arguments, "changed", new=frozenset(self.made))


def perform(arguments: Namespace, command: str, change: Callable[[EditedScript], int]) -> int:
    """Run one of the commands below, and report why a change is refused; the exit code."""
    from smachac.diagnostics.diagnostic import Code, Diagnostic, Finding, Severity, has_errors
    from smachac.ir.recursion import deep_recursion
    from smachac.refactor.editor import RefusedError
    from smachac.refactor.locate import NotFoundError

    with deep_recursion():
        script = EditedScript(arguments)
        try:
            return change(script)
        except HasErrorsError:
            errors = [each for each in script.analysis.report if has_errors([each])]
            print_report(errors, arguments, sys.stderr)
            if script.analysis.machine is not None:
                print("nothing was changed: fix the errors of the script first", file=sys.stderr)
            return FINDINGS
        except NotFoundError as error:
            return usage(str(error))
        except RefusedError as error:
            code = Code(code=command, name=command, severity=Severity.ERROR, explanation="")
            finding = Finding(span=error.span, message=error.message, help=error.help)
            refusal = Diagnostic(kind=code, severity=Severity.ERROR, finding=finding)
            print_report([refusal], arguments, sys.stderr)
            return FINDINGS


def extract_command(arguments: Namespace) -> int:
    """Move a container into a new sub-script; the exit code."""
    from pathlib import Path

    from smachac.refactor.editor import RefusedError
    from smachac.refactor.equivalence import same_machine
    from smachac.refactor.extract_inline import extract
    from smachac.refactor.locate import find_state

    def change(script: EditedScript) -> int:
        path, node = find_state(script.machine, arguments.state)
        if path == script.machine.root.name:
            raise RefusedError(node.span, "this is the whole script")
        editor = script.editor(node.span.source)
        folder = Path(node.span.source.name).parent
        name = arguments.to or Path(f"{node.name.lower()}.yml")
        target = folder / name
        if name.suffix not in (".yml", ".yaml") or len(name.parts) != 1:
            return usage("--to needs the name of a file without a folder, such as `pick.yml`")
        text = extract(editor, node.span, name.stem)
        if target.exists() or script.disk.is_file(target):
            raise RefusedError(
                node.span, f"{target} exists already", "choose another name with --to"
            )
        script.made[os.path.realpath(target)] = text
        script.proven(node.span, same_machine)
        return script.put()

    return perform(arguments, "extract", change)


def inline_command(arguments: Namespace) -> int:
    """Replace the call of a sub-script by its content; the exit code."""
    from smachac.refactor.editor import ScriptEditor
    from smachac.refactor.equivalence import same_machine
    from smachac.refactor.extract_inline import inline
    from smachac.refactor.locate import find_state

    def change(script: EditedScript) -> int:
        _, node = find_state(script.machine, arguments.state)
        editor = script.editor(node.span.source)
        sub = _called(script, node)
        inline(editor, node.span, ScriptEditor(sub))
        script.proven(node.span, same_machine)
        return script.put()

    return perform(arguments, "inline", change)


def rename_command(arguments: Namespace) -> int:
    """Rename a state, an outcome or a key; the exit code."""
    from smachac.diagnostics.spelling import is_plain
    from smachac.refactor.equivalence import equal_after_rename
    from smachac.refactor.locate import find_named
    from smachac.refactor.rename import Renaming, rename_key, rename_outcome, rename_state

    if not is_plain(arguments.new):
        return usage(f"`{arguments.new}` needs quotes in YAML: choose another name")

    def change(script: EditedScript) -> int:
        kind, declared, old = find_named(script.machine, arguments.path, arguments.kind)
        if old == arguments.new:
            return script.put()
        _check_written(script.machine, kind, declared, old)
        work = Renaming(old, arguments.new, script.editor)
        rename = {"state": rename_state, "outcome": rename_outcome, "key": rename_key}[kind]
        rename(work, script.machine, declared)
        shared = script.editors.keys() - {os.path.realpath(script.path)}
        for _, machine in script.others(shared) if shared else ():
            rename(work, machine, declared)
        script.proven(
            declared, lambda one, other: equal_after_rename(one, other, old, arguments.new)
        )
        return script.put()

    return perform(arguments, "rename", change)


def _check_written(machine: Machine, kind: str, declared: Span, old: str) -> None:
    """Raises RefusedError if a script does not contain the declaration of a name."""
    from smachac.ir.traversal import walk
    from smachac.refactor.editor import RefusedError

    nodes = [node for _, node in walk(machine.root)]
    texts = {id(node.span.source) for node in nodes}
    mine = next((node for node in nodes
                 if any(each.span == declared for each in node.outcomes)), None)  # fmt: skip
    if kind == "outcome" and mine is not None and id(declared.source) not in texts:
        message = f"`{old}` is an outcome of the state type `{mine.type}`, not of the script"
        help = f"rename it in the interface of `{mine.type}`, or put the state into a container"
        raise RefusedError(mine.span, message, help)
    if kind != "key" and declared.text.strip("'\"") != old:
        message = (
            f"the script does not contain `{old}` here: it is a default or comes from a look-up"
        )
        raise RefusedError(declared, message)


def contain_command(arguments: Namespace) -> int:
    """Move states into a new container; the exit code."""
    from functools import partial

    from smachac.diagnostics.spelling import is_plain
    from smachac.ir.nodes import Leaf, StateMachine
    from smachac.ir.script_paths import plain_paths
    from smachac.ir.traversal import walk
    from smachac.refactor.contain import contain, equal_after_contain, plan_container, preset_keys
    from smachac.refactor.editor import RefusedError
    from smachac.refactor.locate import different_container_error, find_state
    from smachac.refactor.open_states import with_inferred_interfaces

    if not is_plain(arguments.name):
        return usage(f"`{arguments.name}` needs quotes in YAML: choose another name")

    def change(script: EditedScript) -> int:
        before = script.machine
        path, _ = find_state(before, arguments.states[0])
        above = path.rpartition("/")[0]
        if not above:
            raise RefusedError(before.root.span, "this is the whole script")
        parent = dict(walk(before.root))[above]
        assert not isinstance(parent, Leaf)
        if isinstance(parent, StateMachine):
            facts = partial(_facts, before.state_types, script.library())
            parent = with_inferred_interfaces(parent, facts)
        known = {child.name: child for child in parent.children}
        names = [_name_in(before, above, each, known) for each in arguments.states]
        for name in names:
            if name not in known:
                around = plain_paths(before.root).get(above, above)
                raise different_container_error(before, around, name, known)
        inside = [child for child in parent.children if child.name in names]
        presets = preset_keys(script.editor(inside[0].span.source), inside)
        made = plan_container(parent, inside, presets, arguments.name, arguments.type)
        contain(script.editor, made)
        after = script.proven(inside[0].span, lambda one, two: equal_after_contain(one, two, made))
        _no_worse(script.analysis, after, inside[0].span)
        return script.put()

    return perform(arguments, "contain", change)


def _name_in(machine: Machine, above: str, word: str, known: Mapping[str, Node]) -> str:
    """The name of a state of the container at a full path, given by its name or a path."""
    from smachac.refactor.locate import NotFoundError, find_state

    name = word.rpartition("/")[2]
    if name in known:
        return name
    with suppress(NotFoundError):
        path, _ = find_state(machine, word)
        around, _, found = path.rpartition("/")
        return found if around == above else name
    return name


def _facts(types: Mapping[str, StateType], library: Library, leaf: Leaf) -> TemplateFacts:
    """Keys and outcomes of a state without an interface, read from its template."""
    from smachac.frontend.smacha_meta import keys_in_code
    from smachac.refactor.open_states import TemplateFacts

    type_ = types.get(leaf.type)
    template = library.template(type_.code.get("python", "")) if type_ is not None else None
    if type_ is None or template is None:
        return TemplateFacts()
    reads, writes = keys_in_code(template)
    listed = any(variable.name == "outcomes" for variable in leaf.written)
    return TemplateFacts(reads=reads, writes=writes, outcomes=listed or bool(type_.outcomes))


def _no_worse(before: Analysis, after: Analysis, span: Span) -> None:
    """Raises RefusedError if the change adds a fault of the data flow."""
    from smachac.diagnostics.diagnostic import Severity
    from smachac.refactor.editor import RefusedError

    def flaws(analysis: Analysis) -> Counter[str]:
        grave = (each for each in analysis.report if each.severity is not Severity.INFO)
        return Counter(each.code for each in grave if each.code.startswith("SM3"))

    new = flaws(after) - flaws(before)
    found = next((item for item in after.report if item.code in new), None)
    if found is not None:
        message = f"the script would have a fault: {found.message} ({found.code})"
        raise RefusedError(span, message, found.help)


def _called(script: EditedScript, node: Node) -> Source:
    """The text of the sub-script that a state calls. Raises RefusedError."""
    from smachac.refactor.cst import Atom
    from smachac.refactor.editor import RefusedError, variable
    from smachac.refactor.field_order import variables_of

    editor = script.editor(node.span.source)
    body = variables_of(editor.state(node.span).item)
    called = variable(body, "script") if body is not None else None
    if called is None:
        help = "`smachac extract` makes a sub-script of a container"
        raise RefusedError(node.span, f"`{node.name}` calls no sub-script", help)
    words = called.value.text.strip("'\"") if isinstance(called.value, Atom) else ""
    found = script.library().script(words, node.span.source.name)
    if found is None:
        message = "the name of the sub-script comes from a look-up"
        raise RefusedError(node.span, message, "replace the look-up by the name first")
    return found

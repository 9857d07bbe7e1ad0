"""The commands `contain`, `extract`, `inline`, `rename` and `edit`.

A change is made in memory. The changed script is analysed again and compared with the script
before; only a change that keeps its behaviour is shown or written.
"""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import SCRIPT, as_path, colour, dry_run, quiet, search_folders
from smachac.commands.output import FINDINGS, print_report, shown, usage
from smachac.commands.swapped import swapped_arguments

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Callable

    from smachac.refactor.edited_script import EditedScript

EXIT_CODES = """\
exit codes: 0 success, 1 refused, or a file would change (--check, --diff), 2 wrong usage,
70 a bug in smachac
"""

CONTAIN_EXAMPLES = f"""\
examples:
  smachac contain main.yml LOAD StateMachine LOAD_TABLE LOAD_BLOCK   two states in sequence
  smachac contain main.yml LOOK Concurrence FIND WARM_UP             let both run at the same time
  smachac contain main.yml LOAD StateMachine LOAD_TABLE LOAD_BLOCK --outcome RECOVER=lost
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


EDIT_EXAMPLES = f"""\
examples:
  smachac edit main.yml transition PICK aborted RECOVER   let an outcome lead to a state or outcome
  smachac edit main.yml transition PICK aborted           remove the transition from the script
  smachac edit main.yml add sm RECOVER GripperState       a new state of a type, behind the others
  smachac edit main.yml add sm RECOVER GripperState --after PICK --on aborted
  smachac edit main.yml remove WAIT                       transitions to it lead to its successor
  smachac edit main.yml remove WAIT --to PARK --diff      show a patch

{EXIT_CODES}"""

NEEDS_QUOTES = "`{}` needs quotes in YAML: choose another name"

EDITS = {
    "transition": ("STATE OUTCOME [TARGET]", ("outcome", "target"), 2),
    "add": ("CONTAINER NAME TYPE", ("name", "type"), 3),
    "remove": ("STATE", (), 1),
}
"""The operations of `edit`: their words, the arguments that stand behind the path, and the least
number of words."""


def contain_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = CONTAIN_EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("name", metavar="NAME", help="the name of the new container")
    parser.add_argument("type", metavar="TYPE", choices=("StateMachine", "Concurrence"),
                        help="StateMachine or Concurrence")  # fmt: skip
    parser.add_argument("states", metavar="STATE", nargs="+",
                        help="states of one container, by name or path")  # fmt: skip
    parser.add_argument("--outcome", action="append", default=[], metavar="TARGET=NAME",
                        help="the name of the new outcome that leads to a state or outcome"
                        " (repeatable)")  # fmt: skip
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


def edit_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EDIT_EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("operation", choices=tuple(EDITS), help="what to do")
    parser.add_argument("words", nargs="+", metavar="WORD", help="; ".join(
        f"{name} {words}" for name, (words, _, _) in EDITS.items()))  # fmt: skip
    parser.add_argument("--after", metavar="STATE", help="with add: the state before the new one")
    parser.add_argument("--on", metavar="OUTCOME", help="with add: the outcome of the state before"
                        " that leads to the new one")  # fmt: skip
    parser.add_argument("--to", metavar="TARGET", help="with remove: where transitions to the state"
                        " lead afterwards")  # fmt: skip
    _common_arguments(parser)


def _common_arguments(parser: argparse.ArgumentParser) -> None:
    dry_run(parser)
    quiet(parser)
    search_folders(parser)
    colour(parser)


def put(script: EditedScript, arguments: Namespace) -> int:
    """Write the changes of a script, or show them; the exit code."""
    from smachac.commands.files import put_changes

    found = script.results()
    if not found:
        print("nothing to change")
    texts = {name: text for name, (_, text) in found.items()}
    sources = {name: source for name, (source, _) in found.items()}
    return put_changes(texts, sources, arguments, "changed", new=frozenset(script.made))


def perform(arguments: Namespace, change: Callable[[EditedScript], object]) -> int:
    """Run one of the commands below, and report why a change is refused; the exit code."""
    from smachac.diagnostics.diagnostic import Code, Diagnostic, Finding, Severity, has_errors
    from smachac.ir.recursion import deep_recursion
    from smachac.refactor.edited_script import EditedScript, HasErrorsError
    from smachac.refactor.editor import RefusedError
    from smachac.refactor.locate import NotFoundError

    with deep_recursion():
        script = EditedScript(arguments.script, arguments.scripts, arguments.templates)
        caller = script.caller()
        if caller is not None:
            if not arguments.quiet:
                print(f"{shown(arguments.script)} is a part of {shown(caller)}")
            script = EditedScript(caller, arguments.scripts, arguments.templates)
        try:
            change(script)
        except HasErrorsError:
            if right := swapped_arguments(arguments):
                return usage(right)
            errors = [
                diagnostic for diagnostic in script.analysis.report if has_errors([diagnostic])
            ]
            print_report(errors, arguments, sys.stderr)
            if script.analysis.machine is not None:
                print("nothing was changed: fix the errors of the script first", file=sys.stderr)
            return FINDINGS
        except NotFoundError as error:
            return usage(str(error))
        except RefusedError as error:
            command: str = arguments.command
            code = Code(code=command, name=command, severity=Severity.ERROR, explanation="")
            finding = Finding(span=error.span, message=error.message, help=error.help)
            refusal = Diagnostic(kind=code, severity=Severity.ERROR, finding=finding)
            print_report([refusal], arguments, sys.stderr)
            return FINDINGS
        return put(script, arguments)


def extract_command(arguments: Namespace) -> int:
    """Move a container into a new sub-script; the exit code."""
    from smachac.refactor.refactorings import extract_state

    name = arguments.to
    if name is not None and (name.suffix not in (".yml", ".yaml") or len(name.parts) != 1):
        return usage("--to needs the name of a file without a folder, such as `pick.yml`")
    return perform(arguments, lambda script: extract_state(script, arguments.state, name))


def inline_command(arguments: Namespace) -> int:
    """Replace the call of a sub-script by its content; the exit code."""
    from smachac.refactor.refactorings import inline_state

    return perform(arguments, lambda script: inline_state(script, arguments.state))


def rename_command(arguments: Namespace) -> int:
    """Rename a state, an outcome or a key; the exit code."""
    from smachac.diagnostics.spelling import is_plain
    from smachac.refactor.refactorings import rename_name

    path, new, kind = arguments.path, arguments.new, arguments.kind
    if not is_plain(new):
        return usage(swapped_arguments(arguments) or NEEDS_QUOTES.format(new))
    return perform(arguments, lambda script: rename_name(script, path, new, kind))


def contain_command(arguments: Namespace) -> int:
    """Move states into a new container; the exit code."""
    from smachac.diagnostics.spelling import is_plain
    from smachac.refactor.refactorings import contain_states

    name, type_, states = arguments.name, arguments.type, arguments.states
    if not is_plain(name):
        return usage(swapped_arguments(arguments) or NEEDS_QUOTES.format(name))
    outcomes: dict[str, str] = {}
    for text in arguments.outcome:
        target, equals, outcome = text.partition("=")
        if not equals or not is_plain(outcome):
            return usage(f"--outcome needs TARGET=NAME, not `{text}`")
        outcomes[target] = outcome
    return perform(arguments, lambda script: contain_states(script, name, type_, states, outcomes))


def edit_command(arguments: Namespace) -> int:
    """Change a transition, add or remove a state; the exit code."""
    from smachac.view.graphical_edit import BadEditError, Edit, EditResult
    from smachac.view.graphical_edit import perform as perform_edit

    form, names, least = EDITS[arguments.operation]
    words = arguments.words
    if not least <= len(words) <= 1 + len(names):
        right = f"write: smachac edit SCRIPT {arguments.operation} {form}"
        return usage(swapped_arguments(arguments) or right)
    given = dict(zip(names, words[1:], strict=False))
    for option, operation in (("after", "add"), ("on", "add"), ("to", "remove")):
        if (value := getattr(arguments, option)) is not None:
            if arguments.operation != operation:
                return usage(f"--{option} needs the operation `{operation}`")
            given[option] = value
    edit = Edit(operation=arguments.operation, path=words[0], arguments=given)
    found: list[EditResult] = []
    try:
        code = perform(arguments, lambda script: found.append(perform_edit(script, edit)))
    except BadEditError as error:
        return usage(str(error))
    for result in found:
        print_report(result.findings_added, arguments, sys.stderr)
    return code

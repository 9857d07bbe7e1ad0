"""Targets: each turns a checked machine into files of one language or format.

A target is a folder with a value `TARGET` of the class Target, registered as an entry point of the
group `smachac.targets`. The targets of smachac and those of other packages are found the same way.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from keyword import iskeyword

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked, Machine, StateType
from smachac.pysource.modules.user_code import Declared
from smachac.records import dataclass, field
from smachac.version import __version__

TYPE_CHECKING = False  # annotations only: only pictures show the states
if TYPE_CHECKING:
    from smachac.ir.written import Written

GROUP = "smachac.targets"

COMMENT_WIDTH = 88
"""The length of a line with documentation in a program."""

Files = dict[str, str]
"""The output of a target: relative file name to text. The caller writes the files."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BuildContext:
    """The input of a target beside the machine.

    `library` finds templates and interfaces. `options` are the `--option NAME=VALUE` of the
    command line. `levels` is the number of folders from that of the script down to that of the
    output; 0 if the output is elsewhere. `findings` are those of the script. `wrappers` are the
    functions of runtime/additions.py around the states of a type, by its name; each takes a state
    and its outcomes.
    """

    library: Library
    options: Mapping[str, str] = field(default_factory=dict)
    levels: int = 0
    findings: Sequence[Diagnostic] = ()
    wrappers: Mapping[str, str] = field(default_factory=dict)


class OptionError(ValueError):
    """The value of an option is not valid."""


Emit = Callable[[Checked, BuildContext, Report], Files]


def _no_runtime(_machine: Checked, _context: BuildContext) -> Mapping[str, str]:
    return {}


def _no_code(_type: StateType, _library: Library) -> bool:
    return False


def _nothing_declared(_type: StateType, _library: Library) -> Declared | None:
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """A target: a name, a description in one line, and five parts with these contracts.

    `emit(machine, context, report)` returns the files, the main file first. It appends to `report`
    what the language cannot express and the faults of the user's templates, and returns no files
    if there is an error among them. It raises OptionError, and nothing else that the user can
    cause. `options` maps the name of each option to a line of help. The value of those in
    `file_options` is the name of a file: the target gets its text. `runtime(machine, context)` is
    the support code that the files need beside them: file name to path under smachac/runtime.
    `has_code(type, library)` is whether the target can emit states of a type.
    `declared(type, library)` is the interface that the user's class for a type declares; None if it
    cannot be read. `lacks` are the constructs, in words, that the target cannot express: `emit`
    reports each at its place. `is_picture`: `emit` also accepts a machine with errors, and one that
    was read from Python.
    """

    name: str
    description: str
    emit: Emit
    lacks: tuple[str, ...] = ()
    is_picture: bool = False
    options: Mapping[str, str] = field(default_factory=dict)
    file_options: frozenset[str] = frozenset()
    runtime: Callable[[Checked, BuildContext], Mapping[str, str]] = _no_runtime
    has_code: Callable[[StateType, Library], bool] = _no_code
    declared: Callable[[StateType, Library], Declared | None] = _nothing_declared


def made_by(machine: Machine) -> str:
    """The line that marks a file as generated: the version of smachac and the script."""
    file = comment(machine.source)
    return f"Made by smachac {__version__} from {file} (sha256 {machine.digest[:16]})."


def comment(text: str) -> str:
    """A text in a comment of one line: characters that end or hide it are escaped, and a backslash
    at the end, which continues a comment of C++, is followed by a mark."""
    if text.isascii() and text.isprintable() and text[-1:] not in "\\/":
        return text
    text = "".join(
        word if word.isprintable() or word == "\t" else ascii(word)[1:-1] for word in text
    )
    return f"{text} //" if text.rstrip().endswith(("\\", "??/")) else text


def comment_lines(text: str, width: int) -> list[str]:
    """A text of several lines as lines of comments: long lines are broken between words."""
    lines: list[str] = []
    for paragraph in text.strip().splitlines():
        line = ""
        for word in paragraph.split():
            if line and len(line) + 1 + len(word) > width:
                lines.append(line)
                line = word
            else:
                line = f"{line} {word}".lstrip()
        lines.append(line)
    return [comment(line) for line in lines]


def stem(machine: Machine) -> str:
    """The name of the machine as a file name without suffix, and as a module name of Python."""
    word = re.sub(r"\W+", "_", machine.root.name).strip("_") or "machine"
    return f"_{word}" if word[0].isdigit() or iskeyword(word) else word


def levels_open(options: Mapping[str, str], view: Written) -> int:
    """The option `depth` of pictures: the number of levels that are drawn open; without it, as many
    as a page has room for.

    Raises OptionError if it is not a number.
    """
    depth = options.get("depth")
    if depth is not None and not (depth.isdecimal() and len(depth) < 10 and int(depth) > 0):
        raise OptionError(f"`depth` must be a number of levels, 1 or more, not `{depth}`")
    return int(depth) if depth else view.fitting_depth()


def view_of(machine: Machine, options: Mapping[str, str]) -> Written:
    """The states that a picture shows: those of the script, or with the option `generated` all of
    the graph.

    Raises OptionError if it is neither `true` nor `false`.
    """
    from smachac.ir.written import generated, written

    wanted = options.get("generated", "false")
    if wanted not in ("true", "false"):
        raise OptionError(f"`generated` must be true or false, not `{wanted}`")
    return generated(machine) if wanted == "true" else written(machine)


GENERATED = "true: also the states that `timeout`, `retry` and `for_each` add"
"""The description of the option `generated` of pictures."""

DEPTH = (
    "levels of containers that are drawn open; deeper ones are closed boxes (default: as many as"
    " show at most 40 states)"
)
"""The description of the option `depth` of pictures."""


DIRECTION = "where the picture runs to: TB (down, the default), LR, BT or RL"
"""The description of the option of pictures that names a direction."""

DIRECTIONS = ("TB", "LR", "BT", "RL")


def direction_of(options: Mapping[str, str], name: str) -> str:
    """The direction of a picture, the value of the option `name`; `TB` without it.

    Raises OptionError for another word.
    """
    direction = options.get(name, DIRECTIONS[0])
    if direction not in DIRECTIONS:
        raise OptionError(f"`{name}` must be one of {', '.join(DIRECTIONS)}, not `{direction}`")
    return direction


def target_names() -> list[str]:
    """The names of all installed targets."""
    from importlib.metadata import entry_points

    return sorted({entry.name for entry in entry_points(group=GROUP)})


def load_target(name: str) -> Target | None:
    """The target of a name, imported by this call; None if there is none."""
    from importlib.metadata import entry_points

    for entry in entry_points(group=GROUP, name=name):
        target: Target = entry.load()
        return target
    return None

"""Command lines with their arguments in another order."""

from __future__ import annotations

import shlex
from pathlib import Path

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from argparse import Action, Namespace
    from collections.abc import Sequence


def swapped_option(arguments: Namespace, *options: str) -> str | None:
    """What to write if the file of an option, such as `mock`, is a script and `arguments.script`
    is none; otherwise None."""
    for option in options:
        path = getattr(arguments, option)
        if path is not None and is_script(path) and not is_script(arguments.script):
            words = [arguments.command, path, f"--{option}", arguments.script]
            return _words(path, arguments.script, words)
    return None


def swapped_arguments(arguments: Namespace) -> str | None:
    """What to write if an argument behind `script` is the script and `arguments.script` is none;
    otherwise None."""
    if is_script(arguments.script):
        return None
    actions = arguments.parser.positionals
    given: list[str] = []
    for action in actions:
        value = getattr(arguments, action.dest)
        given += map(str, value if isinstance(value, list) else [value])
    words = in_right_order(actions, given)
    if words is None:
        return None
    script = next(word for word in words if is_script(Path(word)))
    return _words(script, arguments.script, [arguments.command, *words])


def in_right_order(actions: Sequence[Action], words: Sequence[str]) -> list[str] | None:
    """The words of a command line, without options, in the order of its positional arguments: a
    script for `script`, one of the choices for an argument with choices, the others as they are
    written. None if there is no such word."""
    left = [*words]
    found: dict[str, str] = {}
    for action in actions:
        if action.dest != "script" and action.choices is None:
            continue
        fitting = (word for word in left if (word in action.choices if action.choices is not None
                                             else is_script(Path(word))))  # fmt: skip
        word = next(fitting, None)
        if word is None:
            return None
        found[action.dest] = word
        left.remove(word)
    ordered = []
    for action in actions:
        if action.dest in found:
            ordered.append(found[action.dest])
        elif left:
            ordered.append(left.pop(0))
    return [*ordered, *left]


def _words(script: Path | str, other: Path, words: Sequence[object]) -> str:
    return f"`{script}` is a script and `{other}` is none: write `{command_text(words)}`"


def command_text(words: Sequence[object]) -> str:
    """A command as a shell reads it, with the words behind `smachac`."""
    return shlex.join(["smachac", *map(str, words)])


def is_script(path: Path) -> bool:
    """Whether a file is a mapping with a list `states`, as every script is; in a scenario `states`
    is a mapping."""
    from smachac.frontend.files import read_source
    from smachac.frontend.text.yaml_tree import Map, Seq, parse

    if path.suffix.lower() not in (".yml", ".yaml"):
        return False
    source = read_source(path, [])
    tree = parse(source, []) if source is not None else None
    states = tree.get("states") if isinstance(tree, Map) else None
    return states is not None and isinstance(states.value, Seq)

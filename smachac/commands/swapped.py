"""Command lines with the script and another file in each other's place."""

from __future__ import annotations

import shlex
from pathlib import Path

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from argparse import Namespace
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


def swapped_argument(
    script: Path, others: Sequence[Path | str], command: Sequence[str]
) -> str | None:
    """What to write if an argument behind `script` is the script and `script` is none; otherwise
    None. `command` are the words before the arguments."""
    found = next((word for word in others if is_script(Path(word))), None)
    if found is None or is_script(script):
        return None
    rest = [word for word in others if word is not found]
    return _words(found, script, [*command, found, script, *rest])


def _words(script: Path | str, other: Path, words: Sequence[object]) -> str:
    right = shlex.join(["smachac", *map(str, words)])
    return f"`{script}` is a script and `{other}` is none: write `{right}`"


def is_script(path: Path) -> bool:
    """Whether a file is a mapping with a list `states`, as every script is; in a scenario `states`
    is a mapping."""
    from smachac.frontend.files import read_source
    from smachac.frontend.yaml_tree import Map, Seq, parse

    if path.suffix.lower() not in (".yml", ".yaml"):
        return False
    source = read_source(path, [])
    tree = parse(source, []) if source is not None else None
    states = tree.get("states") if isinstance(tree, Map) else None
    return states is not None and isinstance(states.value, Seq)

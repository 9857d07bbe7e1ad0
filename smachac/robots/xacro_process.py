"""Expands a xacro file: a program, which `robots.xacro_files` starts.

It reads a JSON object from its standard input and writes one: the expanded text and the files that
were read, or the message, place and help of a mistake. The file may be untrusted, so xacro runs
with these restrictions: expressions are evaluated by `robots.xacro_expressions` and not by Python;
files are read only in the project of the file and in packages; the environment is not read;
`$(eval ...)` is refused; time, memory and the size of files are limited.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

_LONGEST_TEXT = 5_000_000
"""Largest size of a file, and of the expanded text, in bytes."""
_LIMITS = {"RLIMIT_CPU": 10, "RLIMIT_AS": 2_000_000_000, "RLIMIT_FSIZE": 0}
"""Limits of the process: seconds of CPU, bytes of memory, bytes that are written to a file."""


class RefusedError(Exception):
    """Something that a file may not do; `written` is the text in the file that does it."""

    def __init__(self, message: str, help: str, written: str = "") -> None:
        super().__init__(message)
        self.help, self.written = help, written


class MissingError(RefusedError, FileNotFoundError):
    """A file that is not there."""


class Files:
    """The files that may be read: those in the project, and those in packages."""

    def __init__(self, main: Path, packages: Mapping[str, Path]) -> None:
        from smachac.robots.files import project_folder

        self.main, self.packages = main, packages
        self.project = project_folder(main)
        self.installed: list[Path] = []
        self.read_texts: dict[str, str] = {}

    def read(self, name: str) -> str:
        """The text of a file. Raises RefusedError and OSError."""
        from os.path import relpath

        from smachac.robots.encodings import decoded

        path = Path(name).absolute()
        name = relpath(path, self.main.parent)
        inside = path.resolve().is_relative_to(self.project.resolve())
        # Installed packages often consist of links to their sources.
        if not inside and not any(
            ".." not in path.parts and path.is_relative_to(folder) for folder in self.installed
        ):
            message = f"the file `{name}` is outside of the project and of all packages"
            raise RefusedError(message, f"copy it into the folder `{self.project}`", path.name)
        if not path.is_file():
            message = f"the file `{name}` was not found"
            raise MissingError(message, "correct the name of the file", path.name)
        if path.stat().st_size > _LONGEST_TEXT:
            message = f"the file `{name}` is too large"
            raise RefusedError(message, "name a smaller file", path.name)
        try:
            text = decoded(path.read_bytes(), path.name)
        except ValueError as error:  # also UnicodeDecodeError
            help = "save it as UTF-8"
            raise RefusedError(f"the file `{name}` cannot be read: {error}", help) from None
        self.read_texts[str(path)] = text
        return text

    def find(self, package: str) -> str:
        """The folder of a package. Raises RefusedError."""
        from os import environ

        from smachac.robots.files import PACKAGES_SEARCHED, installed_packages, package_folders

        for folder in package_folders(package, self.main, self.packages):
            if folder.is_dir():
                if folder in installed_packages(package, environ):
                    self.installed.append(folder.absolute())
                return str(folder.absolute())
        message = f"the package `{package}` was not found"
        raise RefusedError(message, PACKAGES_SEARCHED, f"$(find {package})")


def expand(task: Mapping[str, Any]) -> dict[str, Any]:
    """The answer to a task. Raises ImportError without the package `xacro`."""
    import xacro
    from xacro import substitution_args

    from smachac.robots.xacro_calls import MacroCalls
    from smachac.robots.xacro_expressions import Evaluator
    from smachac.robots.xml_tree import XmlError, parse

    main = Path(task["file"]).absolute()
    files = Files(main, {name: Path(folder) for name, folder in task["packages"].items()})
    evaluator = Evaluator(xacro.NameSpace, xacro.YamlDictWrapper)
    calls = MacroCalls(xacro)
    current = {"file": str(main)}

    def parsed(_: object, name: str | None = None) -> Any:
        from xml.dom.minidom import parseString

        assert name is not None
        try:
            text = files.read(name)
        except MissingError as error:
            raise xacro.XacroException(exc=error) from None  # an include may be optional
        finally:
            if str(Path(name).absolute()) not in files.read_texts:
                xacro.filestack.pop()
        current["file"] = str(Path(name).absolute())
        parse(text)  # raises XmlError with the place, and refuses a document type
        return parseString(text)  # a text has no encoding: what it declares is not used

    def opened(name: str) -> Any:
        from io import StringIO

        return StringIO(files.read(name))

    xacro.handle_macro_call = calls
    _restrict(xacro, substitution_args, files, evaluator, parsed, opened)
    written = attribute = ""
    try:
        document: Any = xacro.process_file(str(main), mappings=dict(task["arguments"]))
        text = document.toprettyxml("  ")
        if len(text) > _LONGEST_TEXT:
            raise RefusedError("the expanded text is too large", "name a file with fewer parts")
        return {"text": text, "files": [*files.read_texts]}
    except RecursionError:
        message, help = "a macro calls itself without an end", "call it in `<xacro:if>` only"
    except XmlError as error:
        source = files.read_texts[current["file"]]
        return _answer(error.message, error.help, current["file"], source, error.place)
    except Exception as error:  # xacro raises many kinds
        cause = _cause(error)
        message = str(cause) or type(cause).__name__
        if isinstance(cause, MemoryError):
            message = "it takes more memory to expand than is allowed"
        help = getattr(cause, "help", "correct the macro file; `xacro FILE` prints the result")
        written = getattr(cause, "written", "") or evaluator.failed
        if isinstance(cause, substitution_args.ArgException):
            message = f"the argument `{cause}` has no value"
            help = f"write `arguments: {{{cause}: ...}}` in the description of the robot"
            written = f"$(arg {cause})"
        if fault := calls.fault(cause):
            message, help, attribute = fault
            written = ""
    texts = _innermost_first(xacro, files.read_texts)
    for file, source in texts:
        if written and (start := source.find(written)) >= 0:
            return _answer(message, help, file, source, (start, start + len(written)))
    file, place = calls.place(texts, attribute) or (texts[0][0] if texts else str(main), (0, 0))
    return _answer(message, help, file, files.read_texts.get(file, ""), place)


def _innermost_first(xacro: Any, texts: Mapping[str, str]) -> list[tuple[str, str]]:
    """The files that were read, with their texts: first those of the macros that are expanded, then
    those that include others, then the rest."""
    macros = [macro.history[-1][-1] for macro in reversed(xacro.macrostack or [])]
    names = [*macros, *reversed(xacro.filestack or [])]
    order = [str(Path(name).absolute()) for name in names if name]
    return [(name, texts[name]) for name in dict.fromkeys([*order, *texts]) if name in texts]


def _restrict(
    xacro: Any,
    substitution_args: Any,
    files: Files,
    evaluator: Any,
    parsed: Callable[..., Any],
    opened: Callable[..., Any],
) -> None:
    """Replace the functions of xacro that evaluate, read files or read the environment."""

    def refused(what: str, help: str) -> Callable[..., str]:
        def refuse(*_: object) -> str:
            raise RefusedError(f"`{what}` is not read", help, what.partition(" ")[0])

        return refuse

    def find(resolved: str, text: str, words: list[str], _: object) -> str:
        if len(words) != 1:
            raise RefusedError(f"`$({text})` has no name of a package", "write `$(find PACKAGE)`")
        return resolved.replace(f"$({text})", files.find(words[0]))

    def optenv(resolved: str, text: str, words: list[str], _: object) -> str:
        return resolved.replace(f"$({text})", " ".join(words[1:]))

    argument = "write `<xacro:arg .../>` and `$(arg NAME)`, with a value in the description"
    xacro.safe_eval = evaluator
    xacro.parse = parsed
    xacro.open = opened
    substitution_args._env = refused("$(env ...)", argument)
    substitution_args._eval = refused("$(eval ...)", "write the expression as `${...}`")
    substitution_args._optenv = optenv
    substitution_args._find = find


def _cause(error: BaseException) -> BaseException:
    """The exception that xacro has wrapped."""
    while getattr(error, "exc", None) is not None:
        error = error.exc  # type: ignore[attr-defined]
    return error


def _answer(
    message: str, help: str, file: str, source: str, place: tuple[int, int]
) -> dict[str, Any]:
    keys = ("message", "help", "file", "source", "place")
    return dict(zip(keys, (message, help, file, source, place), strict=True))


def _limit() -> None:
    """Limit this process, where the system can."""
    try:
        import resource
    except ImportError:
        return
    for name, value in _LIMITS.items():
        resource.setrlimit(getattr(resource, name), (value, value))


def main() -> None:
    """Answer one task."""
    task = json.load(sys.stdin)
    sys.path[:] = task["path"]
    output, sys.stdout = sys.stdout, sys.stderr  # xacro prints
    _limit()
    try:
        answer = expand(task)
    except ImportError:
        from smachac.robots.xacro_files import INSTALL

        message = "the package `xacro`, which expands macro files, is not installed"
        answer = _answer(message, INSTALL, task["file"], "", (0, 0))
    json.dump(answer, output)


if __name__ == "__main__":
    main()

"""The project file: `smachac.toml`, or `[tool.smachac]` of a `pyproject.toml`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Code, Diagnostic, Report, Severity, did_you_mean
from smachac.diagnostics.severities import Policy
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import too_big, unreadable_file
from smachac.frontend.text.type_names import Aliases, filled, record_text
from smachac.ir.types import MOST_BOUND, WORDS, Bounds, CppClass, parse_type, unknown_words
from smachac.pysource.modules.ros_names import DEFAULT_ROS, ROS_VERSIONS, Ros
from smachac.records import dataclass, field

SETTINGS: Mapping[str, str] = {
    "scripts": "Folders with sub-scripts, relative to this file.",
    "templates": "Folders with state types: their interfaces and templates.",
    "code": "Folders with the Python modules and C++ headers of state types.",
    "exclude": "Patterns of files to exclude when a folder is checked or formatted.",
    "ros": "The version of ROS of generated programs: 1 or 2.",
    "bounds": "In stepped C++, the bounds of texts (bytes) and lists (items) that have none:"
    " {text = 32, list = 8}.",
    "types": "Names of types for all scripts and interfaces: Part = {name = 'str', at = 'Pose?'}.",
    "cpp_types": "Classes of C++ for names of types:"
    " Part = {class = 'shop::Part', header = 'shop/part.hpp'}.",
    "severity": 'Severities by code, or by the beginning of codes: SM204 = "error".',
}
"""The settings of a project file, with their descriptions."""

PROJECT_FILES = ("smachac.toml", "pyproject.toml")
"""The names of project files; the first one in a folder counts."""

FOLDERS = ("scripts", "templates", "code")
"""The settings that name search folders."""

LEVELS: Mapping[str, Severity | None] = {
    **{severity.value: severity for severity in Severity},
    "off": None,
}
"""The severities that a project file may set."""


_WORDS_FOR_OFF = frozenset(["ignore", "none", "disable", "disabled", "false", "never"])
"""Words of other tools for the severity `off`."""

MOST_DOTS = 200
"""The most dots of a line, and so the most parts of a key."""

MOST_WRONG = 100
"""The most faults of a project file that are reported: each costs a search for its place."""

LONGEST_FILE = 100_000
"""In characters: a larger `smachac.toml` is not read."""

LONGEST_KEY = 200
"""The longest key that is looked for in the text, in characters."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """The settings of a project file: search folders, absolute or relative to the working folder;
    patterns of files to exclude when a folder is checked, relative to `folder`; the version of ROS
    of generated programs; the bounds of texts and lists that have none; the types that have names,
    and the classes of C++ for some of these names and for types of messages; severities.
    `readable`: no setting with search folders was left out."""

    folder: Path = Path()
    scripts: tuple[Path, ...] = ()
    templates: tuple[Path, ...] = ()
    code: tuple[Path, ...] = ()
    exclude: tuple[str, ...] = ()
    ros: Ros = DEFAULT_ROS
    bounds: Bounds = Bounds()
    types: Aliases = field(default_factory=dict)
    cpp_types: Mapping[str, CppClass] = field(default_factory=dict)
    policy: Policy = field(default_factory=Policy)
    readable: bool = True


def _is_too_big(source: Source, path: Path, report: Report) -> bool:
    """Whether a file exceeds a limit, which is reported."""
    settings_of = len(source.text) if path.name == "smachac.toml" else 0
    if settings_of > LONGEST_FILE:
        message = f"the file has {settings_of:,} characters; the limit is {LONGEST_FILE:,}"
        help = "keep only settings of smachac in it"
        report.append(too_big(Span(source, 0, 0), message, help, arguments=("characters",)))
        return True
    crowded = next((line for line in source.text.split("\n") if line.count(".") > MOST_DOTS), None)
    if crowded is not None:  # tomllib takes time and memory quadratic in the parts of a key
        place = Span(source, *[source.text.index(crowded)] * 2)
        message = f"a line has {crowded.count('.'):,} dots; the limit is {MOST_DOTS}"
        report.append(too_big(place, message, "break it into lines", arguments=("dots",)))
    return crowded is not None


def read_project(
    source: Source, path: Path, report: Report, codes: Mapping[str, Code] | None = None
) -> Project | None:
    """The project that a file describes; None if the file has no settings of smachac.

    Wrong settings are reported (SM007) and left out. `codes` are those whose severity can be set;
    without them the codes in the file are not checked.
    """
    if _is_too_big(source, path, report):
        return Project(readable=False)
    try:
        import tomllib as toml
    except ImportError:  # Python 3.10
        import tomli as toml  # type: ignore[import-not-found,no-redef,unused-ignore]
    try:
        data = toml.loads(source.text)
    except (ValueError, RecursionError) as error:  # also a number or an array that is too long
        report.append(_not_toml(source, str(error)))
        return Project(readable=False)
    settings = data if path.name == "smachac.toml" else _tool(data)
    if settings is None and _looks_like_settings(data.get("smachac")):
        message = "`[smachac]` of a pyproject.toml is not read"
        _wrong(source, "smachac", message, "write `[tool.smachac]`", report, ("table", "smachac"))
    if not isinstance(settings, dict):
        return None
    folders: dict[str, tuple[Path, ...]] = {}
    texts: dict[str, tuple[str, ...]] = {}
    policy, ros, bounds = Policy(), DEFAULT_ROS, Bounds()
    types: Aliases = {}
    cpp_types: Mapping[str, CppClass] = {}
    given = settings
    settings = _with_recovered_settings(settings)
    _report_unknown(source, path, data, given, report)
    for key, value in settings.items():
        if key not in SETTINGS:
            continue
        if key == "severity":
            policy = Policy(severities=_severities(source, value, report, codes))
        elif key == "ros":
            ros = _ros(source, value, report)
        elif key == "bounds":
            bounds = _bounds(source, value, report)
        elif key == "types":
            types = _types(source, value, report)
        elif key == "cpp_types":
            cpp_types = _cpp_types(source, value, report)
        elif not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            kind = "patterns" if key == "exclude" else "folders"
            message = f"`{key}` must be a list of {kind}"
            help = f'write it as `{key} = ["..."]`'
            _wrong(source, key, message, help, report, ("list", key), at_value=True)
        elif key == "exclude":
            texts[key] = tuple(value)
        else:
            folders[key] = tuple(path.parent / item for item in value)
    return Project(
        folder=path.parent,
        scripts=folders.get("scripts", ()),
        templates=folders.get("templates", ()),
        code=folders.get("code", ()),
        exclude=texts.get("exclude", ()),
        ros=ros,
        bounds=bounds,
        types=types,
        cpp_types=cpp_types,
        policy=policy,
        readable=all(isinstance(settings.get(key, []), list) for key in FOLDERS)
        and not any(isinstance(settings[key], list) for key in settings.keys() - SETTINGS.keys()),
    )


def _report_unknown(
    source: Source, path: Path, data: dict[str, Any], given: Iterable[str], report: Report
) -> None:
    """Report settings that do not exist."""
    for key in given:
        if key == "tool" and path.name == "smachac.toml" and _tool(data) is not None:
            message = "`[tool.smachac]` is for pyproject.toml; all of smachac.toml is for smachac"
            help = "write its settings without a table, and `[severity]` for the severities"
            _wrong(source, key, message, help, report, ("setting", key))
        elif key not in SETTINGS:
            message = f"`{key}` is not a setting of smachac"
            _wrong(source, key, message, _near(key, SETTINGS), report, ("setting", key))


def _with_recovered_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings, with those of unknown names under the names that are meant, where that is
    certain: then one misspelt name is one finding."""
    sure = guesser(SETTINGS).unique_match
    meant = {key: sure(key) if key not in SETTINGS else key for key in settings}
    names = {key: name if name not in settings else key for key, name in meant.items()}
    return {names[key] or key: value for key, value in settings.items()}


def _ros(source: Source, value: object, report: Report) -> Ros:
    """The version of ROS; the default one in place of a wrong one."""
    if value is not True and value in ROS_VERSIONS:
        return value
    help = "write `ros = 2`, or `ros = 1` for a ROS 1 distribution such as Noetic"
    message = "`ros` must be 1 or 2"
    if isinstance(value, str) and value in {str(known) for known in ROS_VERSIONS}:
        message, help = f"{message}, a number without quotes", f"write `ros = {value}`"
    _wrong(source, "ros", message, help, report, ("ros",), at_value=True)
    return DEFAULT_ROS


def _bounds(source: Source, value: object, report: Report) -> Bounds:
    """The bounds of texts and lists; none in place of a wrong one."""
    if isinstance(value, dict) and value.keys() <= {*Bounds._fields}:
        sizes = value.values()
        if all(type(size) is int and 0 < size <= MOST_BOUND for size in sizes):
            return Bounds(**value)
    message = f"`bounds` must have `text` and `list`, numbers from 1 to {MOST_BOUND}"
    help = "write `bounds = {text = 32, list = 8}`"
    _wrong(source, "bounds", message, help, report, ("bounds",))
    return Bounds()


def _types(source: Source, value: object, report: Report) -> Aliases:
    """The types by their names; a type may use earlier names. Wrong ones are left out."""
    if not isinstance(value, dict):
        help = "write `[types]`, and below it lines such as `Part = {name = 'str', at = 'Pose?'}`"
        _wrong(source, "types", "`types` must be a table", help, report, ("table",))
        return {}
    found: dict[str, str] = {}
    for name, written in value.items():
        text = record_text(written)
        type_ = parse_type(filled(text, found)) if text is not None else None
        unknown = unknown_words(type_) if type_ is not None else ()
        if not name.isidentifier() or name in WORDS:
            message = f"`{name}` cannot be the name of a type"
            help = "use letters, digits and `_`, and no word that is a type already"
            _wrong(source, name, message, help, report, ("type", name))
        elif type_ is None or unknown:
            what = f"`{unknown[0]}` is no type" if unknown else "this is no type"
            near = did_you_mean(unknown[0], [*found, *WORDS]) if unknown else None
            help = near or "write a type in quotes, or a table of fields: {name = 'str'}"
            _wrong(source, name, f"{what} (`{name}`)", help, report, ("type", name), at_value=True)
        else:
            found[name] = str(type_)
    return found


def _cpp_types(source: Source, value: object, report: Report) -> Mapping[str, CppClass]:
    """The classes of C++ by the names of types. Wrong ones are left out."""
    help = "write it as `{class = 'shop::Part', header = 'shop/part.hpp'}`"
    if not isinstance(value, dict):
        _wrong(source, "cpp_types", "`cpp_types` must be a table", help, report, ("table",))
        return {}
    found: dict[str, CppClass] = {}
    for name, written in value.items():
        texts = dict(written) if isinstance(written, dict) else {}
        class_, header = texts.pop("class", None), texts.pop("header", None)
        if texts or not isinstance(class_, str) or not isinstance(header, str):
            message = f"`{name}` must have a class and a header"
            _wrong(source, name, message, help, report, ("class", name))
        elif (
            re.fullmatch(_CLASS, class_, re.ASCII) is None
            or re.fullmatch(_HEADER, header, re.ASCII) is None
        ):
            message = f"`{name}` names no class of C++ in a header"
            _wrong(source, name, message, help, report, ("class", name))
        else:
            found[name] = CppClass(class_.removeprefix("::"), header)
    return found


_CLASS = r"(?:::)?[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*"
_HEADER = r"[\w.+-]+(?:/[\w.+-]+)*"


def _looks_like_settings(table: object) -> bool:
    return isinstance(table, dict) and not table.keys().isdisjoint(SETTINGS)


_WITHOUT_QUOTES = r"[ \t]*(?:\"?[\w.-]+\"?)[ \t]*=[ \t]*([^\W\d][\w./-]*)[ \t]*(?:#|$)"
"""A setting with a text that has no quotes."""

_YAML_LINE = r"[ \t]*([\w-]+)[ \t]*(:)(?=[ \t]|$)"
_BRACKETS = {"[": "]", "{": "}"}
_PART = re.compile(r""" "(?:\\.|[^"\\\n])*" | '[^'\n]*' | \#[^\n]* | [][{}] """, re.VERBOSE)
"""The parts of TOML in which brackets count, and those in which they do not."""

_VALUE = re.compile(r"""[ \t]*=[ \t]*("[^"\n]*"|'[^'\n]*'|\[[^]\n]*\]|[^\s#,}]+)""")
"""A value on the line of its key, after the key."""

_NEXT = re.compile(r"[\w-]+[ \t]*=")
"""The next setting."""

_POSITION = r" \(at line (\d+), column (\d+)\)$"


def _not_toml(source: Source, error: str) -> Diagnostic:
    """SM007 at the character that TOML does not allow: its parser states the place in its
    message only."""
    position = re.search(_POSITION, error)
    message, help = error, "correct the syntax: strings have quotes, lists have brackets"
    span = Span(source, 0, 0)
    if position is not None:
        line, column = int(position[1]), int(position[2])
        start = source.line_starts[min(line, len(source.line_starts)) - 1]
        at = min(start + column - 1, max(len(source.text) - 1, 0))
        span = Span(source, at, min(at + 1, len(source.text)))
        message = error[: position.start()]
        found = re.match(_YAML_LINE, source.line(line))
        if found is not None:
            span = Span(source, start + found.start(2), start + found.end(2))
            message, help = f"`:` follows `{found[1]}`", f"TOML writes `{found[1]} = [...]`"
        bare = re.match(_WITHOUT_QUOTES, source.line(line))
        if bare is not None and start + bare.start(1) <= at <= start + bare.end(1):
            span = Span(source, start + bare.start(1), start + bare.end(1))
            message, help = f"`{bare[1]}` is a text without quotes", f'write `"{bare[1]}"`'
    at = span.start if position is not None else len(source.text)
    opened = _open_bracket(source.text, at)
    if opened is not None and (message.startswith("Unclosed") or _NEXT.match(source.text, at)):
        opening = source.text[opened]
        span = Span(source, opened, opened + 1)
        message, help = f"`{opening}` is not closed", f"write the `{_BRACKETS[opening]}`"
        if source.text[at : at + 1] in ("'", '"'):
            span = Span(source, at, at + 1)
            message, help = "a `,` is missing before this text", "write a `,` between two texts"
    message = f"the project file is not valid TOML: {message}"
    return unreadable_file(span, message, help, arguments=("toml",))


def _open_bracket(text: str, end: int) -> int | None:
    """The index of the innermost bracket that is open at `end`."""
    opened: list[int] = []
    for part in _PART.finditer(text, 0, end):
        if part[0] in _BRACKETS:
            opened.append(part.start())
        elif part[0] in ("]", "}") and opened:
            opened.pop()
    return opened[-1] if opened else None


def _tool(data: dict[str, Any]) -> object:
    """The table `[tool.smachac]`; None if there is none."""
    tool = data.get("tool")
    return tool.get("smachac") if isinstance(tool, dict) else None


def _severities(
    source: Source, value: object, report: Report, codes: Mapping[str, Code] | None
) -> dict[str, Severity | None]:
    if not isinstance(value, dict):
        help = 'write `[severity]`, and below it lines such as `SM204 = "error"`'
        _wrong(source, "severity", "`severity` must be a table", help, report, ("table",))
        return {}
    found: dict[str, Severity | None] = {}
    for code, word in value.items():
        if not code or (codes and not any(known.startswith(code) for known in codes)):
            message = f"no code begins with `{code}`"
            _wrong(source, code, message, _near(code, codes or ()), report, ("code", code))
        elif not isinstance(word, str):
            message = f"a severity is a text, not {_kind(word)}"
            help = f"write one of {listed(LEVELS)} in quotes"
            _wrong(source, code, message, help, report, ("severity", code), at_value=True)
        elif word not in LEVELS:
            message = f"`{word}` is not a severity"
            arguments = ("severity", code, word)
            help = "did you mean `off`?" if word in _WORDS_FOR_OFF else _near(word, LEVELS)
            _wrong(source, code, message, help, report, arguments, at_value=True)
        elif codes and code in codes and codes[code].unsuppressible and word != "error":
            help = "remove the line: no program can be generated with this fault"
            _wrong(source, code, f"{code} is always an error", help, report, ("firm", code))
        else:
            found[code] = LEVELS[word]
    return found


def _kind(value: object) -> str:
    """The kind of a value of TOML."""
    kinds = {bool: "a truth value", int: "a number", float: "a number", list: "a list"}
    return "a table" if isinstance(value, dict) else kinds.get(type(value), "a time")


def _near(word: str, known: Iterable[str]) -> str:
    names = list(known)
    return did_you_mean(word, names) or f"use one of {listed(names)}"


def _wrong(
    source: Source,
    key: str,
    message: str,
    help: str,
    report: Report,
    arguments: tuple[str, ...],
    *,
    at_value: bool = False,
) -> None:
    """SM007 at the key or at its value; nothing after MOST_WRONG findings."""
    if len(report) >= MOST_WRONG:
        return
    span = _key(source, key)
    value = _VALUE.match(source.text, span.end) if at_value else None
    if value is not None:
        span = Span(source, *value.span(1))
    report.append(unreadable_file(span, message, help, arguments=arguments))


def folder_places(source: Source, setting: str, base: Path) -> Callable[[Path], Word]:
    """A function from a folder of a setting to its text there, and its place: that of the setting,
    if no text is found. `base` is the folder of the project file."""
    key = _key(source, setting)
    written: dict[Path, Word] = {}
    for found in _PART.finditer(source.text, key.end):
        text = found[0][1:-1]
        if found[0][0] in "'\"":
            written.setdefault(base / text, Word(text, Span(source, *found.span())))
    return lambda folder: written.get(folder) or Word(str(folder), key)


def _key(source: Source, key: str) -> Span:
    """The place of a key, if a search finds it: TOML parsers give no positions."""
    for start in source.line_starts if 0 < len(key) <= LONGEST_KEY else ():
        line = source.text[start : start + 2 * LONGEST_KEY].split("\n", 1)[0]
        before, found, after = line.partition(key)
        lead = before.lstrip(" \t")
        quote = lead[-1:] if lead[-1:] in ("'", '"') else ""
        name = lead.removesuffix(quote)
        is_key = not name or (name[0] == "[" and "]" not in name)
        if found and is_key and not (after[:1].isalnum() or after[:1] == "_"):
            at = start + len(before)
            closed = after[:1] in ("'", '"')
            return Span(source, at - len(quote), at + len(key) + closed)
    return Span(source, 0, 0)

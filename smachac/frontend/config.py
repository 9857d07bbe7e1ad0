"""The project file: `smachac.toml`, or `[tool.smachac]` of a `pyproject.toml`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from smachac.diagnostics.diagnostic import Code, Report, Severity, did_you_mean
from smachac.diagnostics.severities import Policy
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import unreadable_file

SETTINGS = ("scripts", "templates", "code", "exclude", "severity")
LEVELS: Mapping[str, Severity | None] = {
    **{severity.value: severity for severity in Severity},
    "off": None,
}
"""The severities that a project file may set."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """The settings of a project file: search folders, absolute or relative to the working folder;
    patterns of files to exclude when a folder is checked, relative to `folder`; severities."""

    folder: Path = Path()
    scripts: tuple[Path, ...] = ()
    templates: tuple[Path, ...] = ()
    code: tuple[Path, ...] = ()
    exclude: tuple[str, ...] = ()
    policy: Policy = field(default_factory=Policy)


def read_project(
    source: Source, path: Path, report: Report, codes: Mapping[str, Code] | None = None
) -> Project | None:
    """The project that a file describes; None if the file has no settings of smachac.

    Wrong settings are reported (SM007) and left out. `codes` are those whose severity can be set;
    without them the codes in the file are not checked.
    """
    try:
        import tomllib as toml
    except ImportError:  # Python 3.10
        import tomli as toml  # type: ignore[import-not-found,no-redef,unused-ignore]
    try:
        data = toml.loads(source.text)
    except toml.TOMLDecodeError as error:
        report.append(unreadable_file(Span(source, 0, 0), f"not TOML: {error}"))
        return Project()
    settings = data if path.name == "smachac.toml" else data.get("tool", {}).get("smachac")
    if not isinstance(settings, dict):
        return None
    folders: dict[str, tuple[Path, ...]] = {}
    texts: dict[str, tuple[str, ...]] = {}
    policy = Policy()
    for key, value in settings.items():
        if key not in SETTINGS:
            _wrong(source, key, f"unknown setting `{key}`", _near(key, SETTINGS, "it has"), report)
        elif key == "severity":
            policy = Policy(severities=_severities(source, value, report, codes))
        elif not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            kind = "patterns" if key == "exclude" else "folders"
            _wrong(source, key, f"`{key}` must be a list of {kind}", None, report)
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
        policy=policy,
    )


def _severities(
    source: Source, value: object, report: Report, codes: Mapping[str, Code] | None
) -> dict[str, Severity | None]:
    if not isinstance(value, dict):
        help = 'write `[severity]`, and below it lines such as `SM204 = "error"`'
        _wrong(source, "severity", "`severity` must be a table", help, report)
        return {}
    found: dict[str, Severity | None] = {}
    for code, word in value.items():
        if codes is not None and not any(known.startswith(code) for known in codes):
            help = _near(code, codes, "known are")
            _wrong(source, code, f"there is no code `{code}`", help, report)
        elif not isinstance(word, str) or word not in LEVELS:
            help = _near(str(word), LEVELS, "it is one of")
            _wrong(source, code, f"{word!r} is not a severity", help, report)
        elif codes and code in codes and codes[code].firm and word != "error":
            help = "remove the line: no code could be made of a machine with such a fault"
            _wrong(source, code, f"{code} is always an error", help, report)
        else:
            found[code] = LEVELS[word]
    return found


def _near(word: str, known: Iterable[str], lead: str) -> str:
    names = list(known)
    return did_you_mean(word, names) or f"{lead} {listed(names)}"


def _wrong(source: Source, key: str, message: str, help: str | None, report: Report) -> None:
    """SM007 at the key, if a search finds it: TOML parsers give no positions."""
    found = re.search(
        rf"^[ \t]*(?:\[[^\]\n]*?)?([\"']?{re.escape(key)}\b[\"']?)", source.text, re.M
    )
    span = Span(source, *found.span(1)) if found else Span(source, 0, 0)
    report.append(unreadable_file(span, message, help))

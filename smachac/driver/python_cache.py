"""The findings about Python files of the last run, kept in the user's cache folder.

They hold as long as no Python file of the repository, no project file, and no file of smachac has
changed. Only data is stored, as JSON; a file that is damaged counts as empty.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    PathStep,
    Related,
    Report,
    Severity,
)
from smachac.diagnostics.source import Source, Span
from smachac.driver import CODES
from smachac.frontend.files import PACKAGE
from smachac.pysource.machines.coverage import Coverage, UnknownPlace
from smachac.records import dataclass, replace
from smachac.version import __version__

Reader = Callable[[str], "Source | None"]
"""Returns the text of a file by its path."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Known:
    """What is known of a Python file: its findings, and how much of its machines was read."""

    report: Report
    coverage: Coverage


def cache_folder() -> Path | None:
    """The folder for files that can be made again; None if there is none."""
    own = os.environ.get("LOCALAPPDATA" if os.name == "nt" else "XDG_CACHE_HOME")
    if own:
        return Path(own, "smachac")
    home = os.path.expanduser("~")  # noqa: PTH111 (Path.home raises an error without a home)
    if home == "~":
        return None
    return Path(home, "Library/Caches" if sys.platform == "darwin" else ".cache", "smachac")


def digest_of(files: Iterable[tuple[str, str]]) -> str:
    """A digest of texts by name, of the version of Python, and of the files of smachac."""
    found = hashlib.sha256(f"{__version__} {sys.version}".encode())
    for path in own_files(PACKAGE):
        stat = os.stat(path)  # noqa: PTH116 (twice as fast)
        found.update(f"{path} {stat.st_size} {stat.st_mtime_ns}\n".encode())
    for name, text in files:
        found.update(f"{name}\0{len(text)}\0{text}\0".encode("utf-8", "surrogatepass"))
    return found.hexdigest()


def own_files(package: Path) -> Iterator[str]:
    """The paths of the Python files of a package, in the same order in each run."""
    for top, folders, names in os.walk(package):
        folders.sort()
        for name in sorted(names):
            if name.endswith(".py"):
                yield os.path.join(top, name)  # noqa: PTH118 (twice as fast)


class Cache:
    """The file with what is known of one repository; `digest` is that of its texts."""

    def __init__(self, root: str, digest: str) -> None:
        folder = cache_folder()
        name = hashlib.sha256(root.encode("utf-8", "surrogatepass")).hexdigest()[:24]
        self.file = folder / f"python-{name}.json" if folder is not None else None
        self.digest = digest
        self.changed = False
        self.records: dict[str, Any] = self._read()

    def _read(self) -> dict[str, Any]:
        if self.file is None:
            return {}
        try:
            data = json.loads(self.file.read_text("utf-8"))
            records = data["files"] if data["digest"] == self.digest else {}
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            return {}
        return records if isinstance(records, dict) else {}

    def get(self, key: str, read: Reader) -> Known | None:
        """What is known of a file; None if it has to be read."""
        try:
            return _known(self.records[key], read)
        except (KeyError, ValueError, TypeError, IndexError, AttributeError):
            return None

    def set(self, key: str, known: Known) -> None:
        self.records[key] = {
            "report": [_data(item) for item in known.report],
            "states": known.coverage.states,
            "exact": known.coverage.exact,
            "unknown": [[_place(span), reason] for span, reason in known.coverage.unknown],
        }
        self.changed = True

    def write(self) -> None:
        """Writes the file, if something is new; where that is not possible, nothing happens."""
        if self.file is None or not self.changed:
            return
        text = json.dumps({"digest": self.digest, "files": self.records}, ensure_ascii=False)
        part = self.file.with_suffix(f".{os.getpid()}.part")
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            part.write_bytes(text.encode("utf-8", "surrogatepass"))
            part.replace(self.file)
        except OSError:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)


def _place(span: Span) -> list[Any]:
    return [span.source.name, span.start, span.end]


def _data(item: Diagnostic) -> dict[str, Any]:
    finding = item.finding
    return {
        "code": item.code,
        "severity": item.severity.value,
        "place": _place(item.span),
        "message": finding.message,
        "arguments": finding.arguments,
        "help": finding.help,
        "effect": finding.effect,
        "related": [[_place(place.span), place.message] for place in finding.related],
        "path": [[step.label, step.node, step.is_outcome] for step in finding.path],
        "node": finding.node,
        "group": finding.group,
        "steps": [None if span is None else _place(span) for span in item.steps],
    }


def _known(record: Mapping[str, Any], read: Reader) -> Known:
    """Raises an error where the data has another form."""

    def span(place: Any) -> Span:
        source = read(place[0])
        if source is None:
            raise ValueError
        return Span(source, int(place[1]), int(place[2]))

    def item(data: Mapping[str, Any]) -> Diagnostic:
        finding = Finding(
            span=span(data["place"]),
            message=data["message"],
            arguments=tuple(data["arguments"]),
            help=data["help"],
            effect=data["effect"],
            related=tuple(Related(span=span(p), message=text) for p, text in data["related"]),
            path=tuple(PathStep(*step) for step in data["path"]),
            node=data["node"],
            group=tuple(data["group"]),
        )
        steps = tuple(None if place is None else span(place) for place in data["steps"])
        severity = Severity(data["severity"])
        kind = replace(CODES[data["code"]], unsuppressible=False)
        return Diagnostic(kind=kind, severity=severity, finding=finding, steps=steps)

    unknown = (UnknownPlace(span(place), str(reason)) for place, reason in record["unknown"])
    coverage = Coverage(int(record["states"]), int(record["exact"]), tuple(unknown))
    return Known(report=[item(data) for data in record["report"]], coverage=coverage)

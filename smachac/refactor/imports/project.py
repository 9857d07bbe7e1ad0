"""The project of an import: the texts of its files, and a proof of each script."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source, Span
from smachac.driver import CODES, Analysis, analyse
from smachac.frontend.files import BUILT_IN, Disk, disk_library
from smachac.records import dataclass, field
from smachac.refactor.formatter import format_script
from smachac.refactor.imports.proof import differences
from smachac.refactor.imports.scripts import Lost, PythonMachine, ScriptFiles, state_count
from smachac.refactor.imports.state_types import in_comment, relative

MARK = re.compile(
    r"(?:# |\{#- )Imported from (.*) by smachac; the lines below have the sha256 ([0-9a-f]{16})\.?"
    r"(?: -#\})?\n"
)
"""The first line of each file of an import. Its digest shows whether the file was edited."""

ROUNDS = 3
"""The most checks of a script: each can show what the faults of the one before have hidden."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """The comparison of the graph of a script with that of the machine it was made of. `script`
    is the name of the file, `report` has the errors in it: the faults of that machine."""

    script: str
    states: int
    transitions: int
    differences: tuple[str, ...]
    report: Report = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class Incomplete:
    """A machine that cannot be imported, as parts of it are not known, or as no script can have
    what `framework` has at these places."""

    name: str
    unknown: tuple[tuple[Span, str], ...]
    framework: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Imported:
    """The project of a file with machines: the texts by path, what was not taken over, the proofs,
    and the machines that are not known as a whole. `report` are the findings about the file;
    `is_read`: it can be read. `names` are those of the machines that were wanted, `all_names` those
    of all machines of the file. `vain` are assumed conditions that the file does not have, or whose
    values are known."""

    report: Report
    is_read: bool = True
    texts: Mapping[str, str] = field(default_factory=dict)
    lost: Sequence[Lost] = ()
    proofs: Sequence[Proof] = ()
    incomplete: Sequence[Incomplete] = ()
    names: Sequence[str] = ()
    all_names: Sequence[str] = ()
    vain: Sequence[str] = ()


# --- the check of the scripts


def completed(
    made: ScriptFiles, path: Path, folder: Path, known: Iterable[str], disk: Disk
) -> tuple[dict[str, str], list[Proof]]:
    """The texts of the files as they are written, and the proofs. `path` is the file that is
    imported, `known` are the codes of its findings."""
    made.texts = _formatted(made.texts)
    proofs = _checked(made, path, folder, frozenset(known), disk)
    source = in_comment(str(path), folder)
    return {name: _marked(name, text, source) for name, text in sorted(made.texts.items())}, proofs


def in_order(lost: Iterable[Lost]) -> list[Lost]:
    """What was not taken over, by its place."""
    return sorted(lost, key=lambda item: (item.span.source.name, item.span.start, item.text))


def built_in_names() -> list[str]:
    """The names of the built-in state types."""
    return sorted(path.stem for folder in BUILT_IN for path in folder.glob("*.yml"))


def _checked(
    made: ScriptFiles, path: Path, folder: Path, known: frozenset[str], disk: Disk
) -> list[Proof]:
    """The proofs. A finding that the imported machine does not have, as it is about one of several
    states of a class for example, is allowed in the script."""
    analyses: dict[str, Analysis] = {}
    for _ in range(ROUNDS):
        source = in_comment(str(path), folder)
        texts = {name: _marked(name, text, source) for name, text in made.texts.items()}
        analyses = {name: _analysis(name, texts, folder, disk) for name in made.main}
        places: dict[str, dict[int, set[str]]] = {}
        for analysis in analyses.values():
            for item in analysis.report:
                name = relative(item.span.source.name, folder)
                fault = item.severity is Severity.ERROR and item.code not in known
                if (
                    fault
                    and not item.kind.unsuppressible
                    and name in made.texts
                    and name.endswith(".yml")
                ):
                    places.setdefault(name, {}).setdefault(item.span.line, set()).add(item.code)
        if not places:
            break
        for name, lines in places.items():
            made.texts[name] = _allowed(made.texts[name], lines, in_comment(path.name, Path()))
    return [_proof(name, made.main[name], analysis) for name, analysis in analyses.items()]


def _allowed(text: str, places: Mapping[int, set[str]], name: str) -> str:
    """A text with comments that allow findings in some lines of its file, which has one more line
    at its top."""
    lines = text.split("\n")
    for number in sorted(places, reverse=True):
        line = lines[number - 2]
        space = line[: len(line) - len(line.lstrip(" "))]
        codes = ", ".join(sorted(places[number]))
        lines.insert(number - 2, f"{space}# smachac: allow {codes} it is so in {name}")
    return "\n".join(lines)


def _analysis(name: str, texts: Mapping[str, str], folder: Path, disk: Disk) -> Analysis:
    """The analysis of a script that is not on disk."""
    for path, text in texts.items():
        disk.replace(folder / path, text)
    report: Report = []
    source = disk.read(folder / name, report)
    assert source is not None
    library = disk_library(folder / name, report, disk=disk, codes=CODES)
    return analyse(source, library, report)


def _proof(name: str, machine: PythonMachine, analysis: Analysis) -> Proof:
    states, transitions = state_count(machine.root)
    errors = [item for item in analysis.report if item.severity is Severity.ERROR]
    found = ["the script cannot be read"]
    if analysis.machine is not None:
        root = analysis.machine.root
        found = differences(machine.root, root, machine.constructions)
    return Proof(script=name, states=states, transitions=transitions,
                 differences=tuple(found), report=errors)  # fmt: skip


def _formatted(texts: Mapping[str, str]) -> dict[str, str]:
    """The texts, with the scripts in the standard layout."""
    found = dict(texts)
    for name, text in texts.items():
        if name.endswith(".yml") and "/" not in name:
            found[name] = format_script(Source(name, text)) or text
    return found


# --- files of an import


def _marked(name: str, text: str, source: str) -> str:
    """A text below the line that shows where it comes from."""
    digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]
    words = f"Imported from {source} by smachac; the lines below have the sha256 {digest}"
    return f"{{#- {words} -#}}\n{text}" if name.endswith(".tpl.py") else f"# {words}.\n{text}"


def imported_from(text: str) -> str | None:
    """The file from which a text was imported, from the folder of the project; None if the
    text is no file of an import, or was edited since."""
    found = MARK.match(text)
    if found is None:
        return None
    rest = text[found.end() :].encode("utf-8", "surrogatepass")
    return found[1] if hashlib.sha256(rest).hexdigest()[:16] == found[2] else None

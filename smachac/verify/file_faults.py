"""Faults of a program file that make it unplayable, as text with the place in the file and help."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from smachac.diagnostics.source import Source
from smachac.records import dataclass
from smachac.report.terminal import on_one_line
from smachac.verify.test_case import UnplayableError

MOST_FAULTS = 10
"""Limit on the faults that are shown."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FileFault:
    """One fault of a program file; `line` is 0 if it has no place there."""

    message: str
    line: int = 0
    help: str = ""


def unplayable(source: Source, faults: Sequence[FileFault]) -> UnplayableError:
    """The error that reports the faults of a file."""
    blocks = ["\n".join(_lines(source, fault)) for fault in faults[:MOST_FAULTS]]
    if len(faults) > MOST_FAULTS:
        blocks.append(f"... and {len(faults) - MOST_FAULTS} faults more")
    return UnplayableError("\n\n".join(blocks))


def _lines(source: Source, fault: FileFault) -> Iterator[str]:
    name = on_one_line(source.name)
    yield f"error: {on_one_line(fault.message)}"
    if fault.line:
        digits = len(str(fault.line))
        yield f"{' ' * digits}--> {name}:{fault.line}"
        yield f"{' ' * digits} |"
        yield f"{fault.line} | {on_one_line(source.line(fault.line))}"
    else:
        yield f" --> {name}"
    if fault.help:
        yield f"help: {on_one_line(fault.help)}"

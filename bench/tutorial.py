"""How long the tutorial takes: one shell runs docs/tutorial.md as printed, from an empty folder.

    python bench/tutorial.py [--installed]

Every file is written and every command is run in the order of the page. What a command prints is
compared with the page; only times in seconds may differ. Section 1 clones this repository (git's
`insteadOf` replaces the address), makes a virtual environment and installs with pip from the
network. `--installed` leaves section 1 out: then `smachac` is the program of that name on PATH.
The exit code is 1 if a command fails or prints something else.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "tutorial.md"
ADDRESS = "https://example.org/smachac.git"
INSTALL = "1. Install"
END = "end of command:"
"""A line that the shell prints after each command, with its exit code."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A command of the page; `shown` is its output there, None where the page shows none."""

    section: str
    command: str
    shown: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class File:
    """A file of the page; its first line is a comment with its name."""

    name: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Done:
    """A command that has ended, after `seconds`."""

    step: Step
    printed: str
    code: int
    seconds: float

    @property
    def as_printed(self) -> bool:
        """Whether it printed what the page shows; without an output there, whether it succeeded."""
        if self.step.shown is None:
            return self.code == 0
        return without_times(self.printed) == without_times(self.step.shown)


def steps(text: str) -> Iterator[Step | File]:
    """The files and commands of a page, in order."""
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        section, _, body = part.partition("\n")
        for kind, block in re.findall(r"^```(\w+)\n(.*?)^```$", body, re.MULTILINE | re.DOTALL):
            if kind == "sh":
                for command in block.splitlines():
                    yield Step(section=section, command=command, shown=None)
            elif kind == "console":
                for item in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
                    command, _, shown = item.partition("\n")
                    yield Step(section=section, command=command, shown=shown)
            else:
                yield File(name=block.split()[1], text=block)


def without_times(text: str) -> str:
    return re.sub(r"\d+\.\d\d s$", "0.00 s", text, flags=re.MULTILINE)


def typed(folder: Path, *, installed: bool, environment: dict[str, str]) -> Iterator[Done]:
    """Every command of the tutorial, run by one shell that starts in `folder`."""
    git = {"GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": f"url.{ROOT}.insteadOf"}
    shell = subprocess.Popen(
        ["bash"],
        cwd=folder,
        env={**environment, **git, "GIT_CONFIG_VALUE_0": ADDRESS},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    with shell:
        for step in steps(PAGE.read_text("utf-8")):
            if isinstance(step, File):
                here, _ = run(shell, "pwd")
                Path(here.strip(), step.name).write_text(step.text, "utf-8")
            elif not (installed and step.section == INSTALL):
                started = time.perf_counter()
                printed, code = run(shell, step.command)
                seconds = time.perf_counter() - started
                yield Done(step=step, printed=printed, code=code, seconds=seconds)


def run(shell: subprocess.Popen[str], command: str) -> tuple[str, int]:
    """What a command prints, and its exit code; the shell keeps its folder and its variables."""
    assert shell.stdin is not None
    assert shell.stdout is not None
    shell.stdin.write(f"{{ {command}\n}} </dev/null\necho; echo '{END}' $?\n")
    shell.stdin.flush()
    lines: list[str] = []
    for line in shell.stdout:
        if line.startswith(END):
            return "".join(lines).removesuffix("\n"), int(line.removeprefix(END))
        lines.append(line)
    raise RuntimeError(f"the shell ended at `{command}`: {''.join(lines)}")


def main(installed: bool) -> int:
    total, first, code = 0.0, 0.0, 0
    section = ""
    with tempfile.TemporaryDirectory() as folder:
        for done in typed(Path(folder), installed=installed, environment=dict(os.environ)):
            if done.step.section != section:
                section = done.step.section
                print(section)
            total += done.seconds
            if done.step.command.startswith("smachac run"):
                first = first or total
            print(f"  {done.seconds:7.2f} s  {done.step.command}")
            if not done.as_printed:
                code = 1
                print(f"    exit code {done.code}; it printed:\n{done.printed}")
    print(f"{first:.1f} s to the end of the first run, {total:.1f} s to the end of the page")
    return code


if __name__ == "__main__":
    sys.exit(main("--installed" in sys.argv[1:]))

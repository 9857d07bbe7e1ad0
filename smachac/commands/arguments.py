"""Arguments that several commands have."""

from __future__ import annotations

import argparse

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    import pathlib

SCRIPT = "the script: a YAML file, not a folder"
SCRIPTS = "scripts, folders or patterns (default: the current folder)"
FORMAT = "format of the report"


def machine_name(parser: argparse.ArgumentParser) -> None:
    """`--machine`."""
    parser.add_argument("--machine", metavar="NAME", help="the machine of a Python file with"
                        " several")  # fmt: skip


def as_path(text: str) -> pathlib.Path:
    """A path; pathlib is imported when the first one is given."""
    from pathlib import Path

    return Path(text)


def search_folders(parser: argparse.ArgumentParser) -> None:
    """`--scripts` and `--templates`: where else sub-scripts and state types are."""
    folder(parser, "scripts", "sub-scripts")
    folder(parser, "templates", "templates and interfaces")


def generated_states(parser: argparse.ArgumentParser) -> None:
    """`--generated`: the states of the graph in place of those that are written."""
    parser.add_argument("--generated", action="store_true",
                        help="also show the states that `timeout`, `retry` and `for_each` add"
                        )  # fmt: skip


def folder(parser: argparse.ArgumentParser, name: str, what: str) -> None:
    """An option that names one more folder each time it is given."""
    parser.add_argument(f"--{name}", type=as_path, action="append", default=[], metavar="DIR",
                        help=f"another folder with {what} (repeatable)")  # fmt: skip


def colour(parser: argparse.ArgumentParser) -> None:
    """`--colour`."""
    parser.add_argument("--colour", "--color", choices=["auto", "always", "never"], default="auto",
                        help="colours in reports (default: auto, on a terminal only)")  # fmt: skip


def memory_limit(parser: argparse.ArgumentParser) -> None:
    """`--memory-limit`."""
    from smachac.commands.memory import DEFAULT

    parser.add_argument("--memory-limit", type=megabytes, default=DEFAULT, metavar="MB",
                        help=f"the most memory of this process; 0: no limit (default: {DEFAULT:,})"
                        )  # fmt: skip


def time_limit(parser: argparse.ArgumentParser) -> None:
    """`--time-limit`."""
    from smachac.commands.cpu_time import DEFAULT

    parser.add_argument("--time-limit", type=seconds, default=DEFAULT, metavar="S",
                        help=f"the most CPU time of this process, in seconds; 0: no limit"
                        f" (default: {DEFAULT:,})")  # fmt: skip


def report_output(parser: argparse.ArgumentParser, *formats: str) -> None:
    """`--format`, of which the first format is the default, and `-o FILE`; see report_file.py."""

    def known(text: str) -> str:
        return "md" if text == "markdown" else text

    if formats:
        parser.add_argument("--format", type=known, choices=formats, default=formats[0],
                            help=FORMAT)  # fmt: skip
    parser.add_argument("-o", "--output", dest="report_file", type=as_path, metavar="FILE",
                        help="write the report to a file, not to standard output")  # fmt: skip


def quiet(parser: argparse.ArgumentParser) -> None:
    """`--quiet`."""
    parser.add_argument("-q", "--quiet", action="store_true",
                        help="print findings and errors only")  # fmt: skip


def dry_run(parser: argparse.ArgumentParser) -> None:
    """`--check` and `--diff` of the commands that change scripts."""
    parser.add_argument("--check", action="store_true",
                        help="write nothing; exit with 1 if a file would change")  # fmt: skip
    parser.add_argument("--diff", action="store_true",
                        help="write nothing; print the changes as a patch")  # fmt: skip


def names(text: str) -> list[str]:
    """Names with commas between them."""
    return [name.strip() for name in text.split(",") if name.strip()]


def megabytes(text: str) -> int:
    """An amount of memory, or 0."""
    if not text.isdecimal() or len(text) > 9:
        raise argparse.ArgumentTypeError(f"must be a number of megabytes, not `{text[:20]}`")
    return int(text)


def seconds(text: str) -> int:
    """A time in whole seconds, or 0."""
    if not text.isdecimal() or len(text) > 9:
        raise argparse.ArgumentTypeError(f"must be a number of seconds, not `{text[:20]}`")
    return int(text)


def seed(text: str) -> int:
    """The seed of random numbers: a whole number."""
    try:
        return int(text)
    except ValueError:
        shown = text if len(text) <= 20 else f"{text[:20]}..."
        raise argparse.ArgumentTypeError(f"must be a whole number, not `{shown}`") from None


def count(text: str) -> int:
    """A number of things, at least one."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number from 1, not `{text}`")
    return int(text)

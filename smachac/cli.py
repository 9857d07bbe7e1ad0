"""The command line: arguments, and what becomes of exceptions."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from smachac import __version__

BUG, INTERRUPTED = 70, 130
"""Exit codes beside those of verbs.py: our fault; Ctrl-C."""

EPILOG = """\
examples:
  smachac check main.yml                     what is wrong with a script
  smachac build main.yml --target python     print it as Python for SMACH
  smachac run main.yml --record film.gif     run it on the simulated arm
  smachac run main.yml --mock scenario.yml   run it without robot or simulation
  smachac explain SM201                      what a code means, with examples

exit codes: 0 clean, 1 findings, 2 wrong usage, 70 a bug in smachac
"""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="smachac",
        description="Compiles robot task state machines from YAML, and checks them.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"smachac {__version__}")
    verbs = parser.add_subparsers(dest="verb", metavar="COMMAND", required=True)

    check = _verb(verbs, "check", "judge scripts by every rule")
    check.add_argument("script", nargs="+", type=Path, help="a script (.yml, .yaml)")
    _search_folders(check)
    check.add_argument("--format", choices=["text", "json"], default="text")
    check.add_argument("--strict", action="store_true", help="warnings fail as errors do")
    _colour(check)

    build = _verb(verbs, "build", "print a script for a target")
    build.add_argument("script", type=Path, help="a script (.yml, .yaml)")
    build.add_argument("--target", "-t", required=True, help="see `smachac targets`")
    build.add_argument("-o", "--output", type=Path, default=Path(), metavar="DIR",
                       help="where to write (default: here; `-` prints)")  # fmt: skip
    build.add_argument("--option", action="append", default=[], metavar="NAME=VALUE",
                       help="an option of the target")  # fmt: skip
    build.add_argument("--check", action="store_true",
                       help="write nothing; fail if the files are not up to date")  # fmt: skip
    build.add_argument("--force", action="store_true",
                       help="overwrite files that smachac did not write")  # fmt: skip
    _search_folders(build)
    _colour(build)

    run = _verb(verbs, "run", "run a script: on the simulated arm, or with mock states")
    run.add_argument("script", type=Path, help="a script (.yml, .yaml)")
    run.add_argument("--gui", action="store_true", help="show the simulation in a window")
    run.add_argument("--record", type=Path, metavar="FILE", help="film it: .gif or .mp4")
    run.add_argument("--trace", type=Path, metavar="FILE", help="write every event, a JSON a line")
    run.add_argument("--seed", type=int, default=0, help="of everything random (default 0)")
    run.add_argument("--mock", type=Path, metavar="FILE", help="play a scenario instead")
    run.add_argument("--expect", metavar="OUTCOME", help="fail unless it ends with this outcome")
    run.add_argument("--quiet", "-q", action="store_true", help="no progress, only the outcome")
    _search_folders(run)
    _colour(run)

    explain = _verb(verbs, "explain", "what a code means, with examples")
    explain.add_argument("code", help="such as SM201")

    _verb(verbs, "targets", "list what can be built")
    return parser


def _verb(verbs: Any, name: str, text: str) -> Any:
    return verbs.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")


def _search_folders(parser: argparse.ArgumentParser) -> None:
    for name, what in (("scripts", "sub-scripts"), ("templates", "templates and interfaces")):
        parser.add_argument(f"--{name}", type=Path, action="append", default=[], metavar="DIR",
                            help=f"another folder with {what} (repeatable)")  # fmt: skip


def _colour(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--colour", "--color", choices=["auto", "always", "never"], default="auto")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code. An exception that gets here is a bug of ours."""
    given = _parser().parse_args(arguments)
    from smachac import verbs

    _never_fail_to_print()
    gc.disable()  # what a compiler makes lives to its end; collecting costs a third of the time
    try:
        code = verbs.VERBS[given.verb](given)
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except Exception:
        import traceback

        traceback.print_exc()
        print(f"\nsmachac {__version__}: this is a bug in smachac, please report it with the"
              " lines above and the script", file=sys.stderr)  # fmt: skip
        return BUG


def _never_fail_to_print() -> None:
    """Streams that cannot show a character show an escape instead."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


if __name__ == "__main__":
    sys.exit(main())

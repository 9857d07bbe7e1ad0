"""The command `lsp`: the language server for editors, over standard input and output."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from argparse import Namespace

from smachac.commands.output import OK, USAGE

EXAMPLES = """\
examples:
  smachac lsp          started by the editor (docs/editors.md has the settings for each)

It needs the extra `lsp`: pip install 'smachac[lsp]'
exit codes: 0 success, 2 wrong usage, 70 a bug in smachac
"""


def lsp_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("--stdio", action="store_true",
                        help="accepted, because some editors pass it")  # fmt: skip


def lsp_command(arguments: Namespace) -> int:
    """Serve an editor until it ends the session; the exit code."""
    try:
        from smachac.lsp.server import make_server
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] not in ("pygls", "lsprotocol"):
            raise
        print("smachac: error: the language server needs pygls: pip install 'smachac[lsp]'",
              file=sys.stderr)  # fmt: skip
        return USAGE
    gc.freeze()  # the server collects garbage between two checks
    with open(os.dup(sys.stdout.fileno()), "wb") as stream:  # the server closes it  # noqa: PTH123
        make_server().start_io(stdout=stream)
    return OK

"""The command `docs`: list the pages of the documentation, or print one."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.output import FINDINGS, OK, usage

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from pathlib import Path

EXAMPLES = """\
examples:
  smachac docs                   the pages, each with its subject
  smachac docs language          the reference of scripts, as Markdown
  smachac docs tutorial | less   page by page

exit codes: 0 success, 1 the pages are not installed, 2 wrong usage or unknown page,
70 a bug in smachac
"""

INSTALLED = "share/doc/smachac/"
"""The folder of the pages below the prefix of an installation (pyproject.toml, data-files)."""

INDEX = "README"


def docs_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("page", nargs="?", metavar="PAGE", help="the name of a page")


def docs_command(arguments: Namespace) -> int:
    """Print a page, or the names of all; the exit code."""
    pages = documentation_pages()
    if not pages:
        print("the pages of the documentation are not installed", file=sys.stderr)
        return FINDINGS
    name: str | None = arguments.page
    if name is None:
        width = max(map(len, pages))
        for page, path in pages.items():
            subject = path.read_text("utf-8").partition("\n")[0].lstrip("# ")
            print(f"{page:<{width}}  {subject}")
        return OK
    wanted = pages.get(name.removeprefix("docs/").removesuffix(".md"))
    if wanted is None:
        return usage(f"there is no page `{name}`", name, list(pages))
    sys.stdout.write(wanted.read_text("utf-8"))
    return OK


def documentation_pages() -> dict[str, Path]:
    """The files of the pages by name: those of the repository that smachac runs from, else those
    that were installed with it."""
    from importlib.metadata import PackageNotFoundError, files
    from pathlib import Path

    import smachac

    folder = Path(smachac.__file__).parents[1] / "docs"
    found = sorted(folder.glob("*.md")) if (folder / "smachac.1").is_file() else []
    if not found:
        try:
            listed = files("smachac") or []
        except PackageNotFoundError:
            listed = []
        found = sorted(
            Path(str(file.locate()))
            for file in listed
            if file.suffix == ".md" and file.as_posix().endswith(f"{INSTALLED}{file.name}")
        )
    return {path.stem: path for path in found if path.stem != INDEX and path.is_file()}

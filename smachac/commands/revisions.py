"""The files of a git revision, in a temporary folder."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from smachac.frontend.discovery import GitError


@contextmanager
def checked_out(revision: str, paths: Iterable[Path]) -> Iterator[None]:
    """While it is entered, the current folder is the same folder in a git revision.

    The files are written into a temporary folder; the working tree of the user, the index and the
    repository stay as they are. Raises GitError, also if one of `paths` is not in the repository.
    """
    try:
        top = _git("rev-parse", "--show-toplevel")
    except GitError as error:
        raise GitError(f"git finds no repository in this folder: {error}") from error
    for path in paths:
        if not Path(os.path.realpath(path)).is_relative_to(os.path.realpath(top)):
            raise GitError(f"`{path}` is not in the git repository {top}")
    commit = _git("rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    if not commit and not _git("rev-list", "--all", "--max-count=1"):
        raise GitError(f"the git repository {top} has no commits")
    if not commit:
        raise GitError(f"git has no revision `{revision}`")
    here = _git("rev-parse", "--show-prefix")
    old = Path.cwd()
    with tempfile.TemporaryDirectory(prefix="smachac-") as temporary:
        folder = Path(temporary, "tree")
        # The index is in the temporary folder, too. The folder `.git` ends the search for
        # project files.
        (folder / ".git").mkdir(parents=True)
        index = {"GIT_INDEX_FILE": str(Path(temporary, "index"))}
        _git("-C", top, "read-tree", commit, **index)
        _git("-C", top, "checkout-index", "--all", "--quiet", f"--prefix={folder}/", **index)
        inside = folder / here
        inside.mkdir(parents=True, exist_ok=True)
        os.chdir(inside)
        try:
            yield
        finally:
            os.chdir(old)


def _git(*arguments: str, **variables: str) -> str:
    """The output of a git command, without its line end; empty if git finds nothing."""
    try:
        ended = subprocess.run(
            ["git", *arguments], capture_output=True, check=False, encoding="utf-8",
            errors="surrogateescape", env={**os.environ, **variables},
        )  # fmt: skip
    except OSError as error:
        raise GitError(f"git does not run: {error.strerror or error}") from error
    if ended.returncode not in (0, 1):
        raise GitError(ended.stderr.strip().removeprefix("fatal: ") or "git failed")
    return ended.stdout.rstrip("\n")

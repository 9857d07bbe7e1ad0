"""Git, as `diff` and `--changed-since` use it: revisions and their files, read from its objects.

The settings in the `.git/config` of a checkout can name programs. No command here starts one of
them: git compares and writes no files of the working tree, so no filter and no program for
differences runs, and the settings in `_OFF` replace those of the checkout. Git itself refuses the
repository of another user (`safe.directory`); that is left as it is.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import IO

from smachac.frontend.files import TooBigError, lies_inside, read_bytes
from smachac.records import dataclass

_OFF = {
    "core.fsmonitor": "false",
    "core.hooksPath": os.devnull,
    "safe.bareRepository": "explicit",
}
"""Settings of git that replace those of the checkout: no monitor of the file system, no hooks, no
repository that is a part of the files of another one."""

_OFFLINE = {"GIT_ALLOW_PROTOCOL": "", "GIT_NO_LAZY_FETCH": "1", "GIT_TERMINAL_PROMPT": "0"}
"""Variables for git: objects that are missing are not fetched, with any program."""

_COPIED = 1 << 20
"""Bytes that are copied at once."""


class GitError(Exception):
    """Git failed, or a revision does not exist; the message has the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Blob:
    """A file of a revision: its path below the top folder, the id of its content, and whether the
    content is the target of a symbolic link."""

    path: str
    id: str
    is_link: bool


def top_folder() -> Path:
    """The top folder of the working tree around the current folder, as a real path. Raises
    GitError."""
    try:
        return Path(os.path.realpath(_git("rev-parse", "--show-toplevel")))
    except GitError as error:
        raise GitError(f"git finds no repository in this folder: {error}") from error


def _commit_of(revision: str) -> str:
    """The id of the commit that a revision names. Raises GitError if there is none."""
    commit = _git("rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    if not commit and not _git("rev-list", "--all", "--max-count=1"):
        raise GitError("the git repository has no commits")
    if not commit:
        raise GitError(f"git has no revision `{revision}`")
    return commit


def changed_since(revision: str, used: frozenset[str]) -> set[str]:
    """The real paths in `used` of files that differ from the merge base of this branch and
    `revision`.

    Uncommitted changes count, also new and removed files; line ends do not. Raises GitError.
    """
    top, commit = top_folder(), _commit_of(revision)
    blobs = _blobs(_git("merge-base", commit, "HEAD") or commit)
    old = {blob.path for blob in blobs}
    # Of the files on disk, new ones are those that git lists and the base does not have.
    listed = _git("-C", str(top), "ls-files", "--cached", "--others", "--exclude-standard", "-z")
    changed = {os.path.realpath(top / name) for name in listed.split("\0") if name not in old}
    for blob in blobs:
        path = top / blob.path
        real = os.path.realpath(path)
        if real in used and not _is_content_of(blob, path):
            changed.add(real)
    return changed & used


def _is_content_of(blob: Blob, path: Path) -> bool:
    """Whether a file on disk has the content of a blob, apart from line ends."""
    try:
        if blob.is_link or path.is_symlink():
            return blob.is_link and _id(os.fsencode(path.readlink()), blob.id) == blob.id
        data = read_bytes(path)
    except (OSError, TooBigError):
        return False
    plain = data.replace(b"\r\n", b"\n")
    return blob.id in (_id(data, blob.id), _id(plain, blob.id))


def _id(data: bytes, like: str) -> str:
    """The id of a content, with the hash function of another id: SHA-1, or SHA-256 in repositories
    of that format (gitformat-hash-function-transition)."""
    digest = hashlib.sha1 if len(like) == 40 else hashlib.sha256
    return digest(b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()


def _blobs(commit: str) -> list[Blob]:
    """The files and links of a commit; no submodules. Raises GitError."""
    found = []
    for line in _git("ls-tree", "-r", "-z", "--full-tree", commit).split("\0")[:-1]:
        about, _, path = line.partition("\t")
        mode, kind, id = about.split(" ")
        if kind == "blob" and _is_inside(path):
            found.append(Blob(path=path, id=id, is_link=mode == "120000"))
    return found


def _is_inside(path: str) -> bool:
    """Whether a path of a tree is below its top folder, and outside of `.git`."""
    pure = PurePath(path)
    parts = {part.lower() for part in pure.parts}
    return not pure.anchor and parts.isdisjoint({"..", ".git"}) and "\0" not in path


@contextmanager
def checked_out(revision: str) -> Iterator[Path]:
    """While it is entered, the current folder is the same folder in a git revision; its top folder.

    The files are written into a temporary folder; the working tree of the user, the index and the
    repository stay as they are. Raises GitError.
    """
    commit, here, old = _commit_of(revision), _git("rev-parse", "--show-prefix"), Path.cwd()
    with tempfile.TemporaryDirectory(prefix="smachac-") as temporary:
        top = Path(os.path.realpath(temporary), "tree")
        (top / ".git").mkdir(parents=True)  # it ends the search for project files
        _write_commit(commit, top)
        inside = top / here
        try:
            inside.mkdir(parents=True, exist_ok=True)
            os.chdir(inside)
            yield top
        finally:
            os.chdir(old)


def _write_commit(commit: str, folder: Path) -> None:
    """Write the files of a commit, as they are in its objects: without conversions by filters. The
    links are written last, so that no file is written through one. Raises GitError."""
    blobs = sorted(_blobs(commit), key=lambda blob: blob.is_link)
    with tempfile.TemporaryFile() as ids, tempfile.TemporaryFile() as contents:
        ids.write("".join(f"{blob.id}\n" for blob in blobs).encode())
        ids.seek(0)
        _run(["cat-file", "--batch"], stdin=ids, stdout=contents)
        contents.seek(0)
        try:
            for blob in blobs:
                _write(blob, contents, folder / blob.path)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise GitError(f"the files of {commit[:12]} cannot be written: {reason}") from error


def _write(blob: Blob, contents: IO[bytes], path: Path) -> None:
    """Write one file or link, whose content is next in the output of `git cat-file --batch`."""
    _, kind, *size = contents.readline().split()
    if kind != b"blob":
        raise GitError(f"git has no content of `{blob.path}`")
    path.parent.mkdir(parents=True, exist_ok=True)
    left = int(size[0])
    if not blob.is_link:
        with path.open("xb") as file:
            while left and (data := contents.read(min(left, _COPIED))):
                left -= file.write(data)
    elif lies_inside(path.parent, path.parent.parent):
        path.symlink_to(os.fsdecode(contents.read(left)))
    else:
        raise GitError(f"the folder of `{blob.path}` is a link")
    contents.read(1)  # the line feed after it


def _git(*arguments: str) -> str:
    """The output of a git command, without its line end; empty if git reports that there is no
    result. Raises GitError."""
    return _run(arguments).rstrip("\n")


def _run(
    arguments: Sequence[str], stdin: IO[bytes] | None = None, stdout: IO[bytes] | None = None
) -> str:
    settings = [word for name, value in _OFF.items() for word in ("-c", f"{name}={value}")]
    try:
        ended = subprocess.run(
            ["git", "--no-pager", *settings, *arguments], check=False,
            stdin=stdin or subprocess.DEVNULL, stdout=stdout or subprocess.PIPE,
            stderr=subprocess.PIPE, env={**os.environ, **_OFFLINE},
        )  # fmt: skip
    except OSError as error:
        raise GitError(f"git does not run: {error.strerror or error}") from error
    if ended.returncode not in (0, 1):
        reason = ended.stderr.decode("utf-8", "replace").strip().removeprefix("fatal: ")
        raise GitError(reason or "git failed")
    return os.fsdecode(ended.stdout or b"")

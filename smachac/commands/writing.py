"""Writing bytes to several files: to all of them, or to none."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import signal
import stat
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from smachac.records import dataclass

SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")
"""Signals that are delivered after the writing."""

PREFIX = ".smachac-"
"""How the names of temporary files begin: a name made of the file's own could be too long."""


class PartlyWrittenError(Exception):
    """The writing stopped, and some files could not be restored; the message names them."""


@dataclass(slots=True)
class _Change:
    """One file to write. `new` is a temporary file with the new content, `old` another one with the
    old content if there is any. `in_place`: the file has several names, or an owner that a new file
    would not have; so its content is replaced, not the file. `begun`: the file may have changed."""

    path: Path
    new: Path
    old: Path | None = None
    in_place: bool = False
    begun: bool = False


def put_all(contents: Mapping[Path, bytes]) -> None:
    """Write bytes to all paths or to none.

    First all new contents go to temporary files; the old contents are kept until the last file is
    replaced, and are restored after an error. Permissions, owner, extended attributes and hard
    links of a file stay. A symbolic link is replaced, not its target. Raises OSError, after which
    nothing has changed, or PartlyWrittenError.
    """
    changes: list[_Change] = []
    lost: list[_Change] = []
    with _signals_wait():
        try:
            for path, data in contents.items():
                _prepare(path, data, changes)
            for change in changes:
                _replace(change)
        except BaseException as error:
            lost = [change for change in reversed(changes) if not _restore(change)]
            if lost:
                raise PartlyWrittenError(_partly_written(lost, error)) from error
            raise
        finally:
            for change in changes:
                change.new.unlink(missing_ok=True)
                if change.old is not None and change not in lost:
                    change.old.unlink(missing_ok=True)


@contextlib.contextmanager
def _signals_wait() -> Iterator[None]:
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    waiting = {getattr(signal, name) for name in SIGNALS}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, waiting)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare(path: Path, data: bytes, changes: list[_Change]) -> None:
    """Write the temporary files of one path."""
    status = path.lstat() if os.path.lexists(path) else None
    if status is not None and stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if status is not None and not (stat.S_ISREG(status.st_mode) or stat.S_ISLNK(status.st_mode)):
        raise OSError(errno.EINVAL, "not a regular file", str(path))
    handle, name = tempfile.mkstemp(prefix=PREFIX, dir=path.parent)
    change = _Change(path, Path(name))
    changes.append(change)
    with os.fdopen(handle, "wb") as stream:
        stream.write(data)
    if status is None or stat.S_ISLNK(status.st_mode):
        change.new.chmod(0o666 & ~_umask())
    else:
        change.in_place = status.st_nlink > 1 or not _made_alike(change.new, path, status)
    if status is not None:
        old = Path(f"{name}.old")
        change.old = old
        if change.in_place:
            shutil.copyfile(path, old)
            old.chmod(0o600)
        else:
            _link(path, old)


def _umask() -> int:
    """The permissions that this process withholds from a new file."""
    mask = os.umask(0o077)  # the only way to read it: a file of another thread is private meanwhile
    os.umask(mask)
    return mask


def _made_alike(new: Path, path: Path, status: os.stat_result) -> bool:
    """Set owner, extended attributes and permissions of a file to those of another; whether that is
    permitted."""
    try:
        made = new.stat()
        if (made.st_uid, made.st_gid) != (status.st_uid, status.st_gid):
            os.chown(new, status.st_uid, status.st_gid)
        if hasattr(os, "listxattr"):
            for attribute in os.listxattr(path):
                os.setxattr(new, attribute, os.getxattr(path, attribute))
        new.chmod(stat.S_IMODE(status.st_mode))
    except OSError:
        return False
    return True


def _link(path: Path, old: Path) -> None:
    """Give a file a second name, or copy it where the file system has no links."""
    try:
        os.link(path, old, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(path, old, follow_symlinks=False)


def _replace(change: _Change) -> None:
    change.begun = True
    if change.in_place:
        shutil.copyfile(change.new, change.path)
    else:
        os.replace(change.new, change.path)  # noqa: PTH105 (a test replaces it)


def _restore(change: _Change) -> bool:
    """Undo a change; whether the file has its old content again."""
    if not change.begun:
        return True
    try:
        if change.old is None:
            if not change.new.exists():  # else it was not renamed, and the path is not ours
                change.path.unlink(missing_ok=True)
        elif change.in_place:
            shutil.copyfile(change.old, change.path)
        else:
            change.old.replace(change.path)
    except OSError:
        return False
    return True


def _partly_written(lost: list[_Change], error: BaseException) -> str:
    reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
    files = ", ".join(
        f"{change.path} (its old content is in {change.old})" if change.old is not None
        else f"{change.path} (new)"
        for change in lost
    )  # fmt: skip
    return f"{reason}; these files were changed and could not be restored: {files}"

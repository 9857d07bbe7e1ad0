"""Writing files: all of them or none, and never over files of the user."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from smachac.diagnostics.source import Source
from smachac.frontend.files import _decoded

MARK = "Made by smachac"
"""What every file we write says in its first lines: so we know our own."""


def foreign_files(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Files that are in the way: they exist and were not written by us."""
    found = []
    for name in files:
        path = folder / name
        if path.exists():
            with contextlib.suppress(OSError), path.open(encoding="utf-8", errors="replace") as old:
                if MARK in old.read(2000):
                    continue
            found.append(path)
    return found


def present_files(folder: Path, files: Iterable[str]) -> list[Path]:
    """Those of some files that are there, whoever wrote them."""
    return [folder / name for name in files if (folder / name).exists()]


def changed_files(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Files whose content on disk is not what would be written."""
    changed = []
    for name, text in files.items():
        path = folder / name
        if not path.is_file() or path.read_bytes() != text.encode("utf-8"):
            changed.append(path)
    return changed


def write_files(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Write all files or none, each to a temporary file that is then renamed.

    Raises OSError; nothing is left behind then.
    """
    paths = {folder / name: text.encode("utf-8") for name, text in files.items()}
    made: list[Path] = []
    try:
        for path in paths:
            missing = [each for each in path.parents if not each.exists()]
            for each in reversed(missing):
                each.mkdir(exist_ok=True)
                made.append(each)
        _put_all({path: (data, 0o644) for path, data in paths.items()})
    except BaseException:
        for each in reversed(made):
            with contextlib.suppress(OSError):
                each.rmdir()
        raise
    return list(paths)


class ChangedError(Exception):
    """A file is not what it was when it was read; the words name it."""


def rewrite_files(texts: Mapping[str, str], before: Mapping[str, Source]) -> None:
    """Give files, named by real path, new texts: all of them or none, in the encoding and with the
    permissions they have. What `before` does not hold is a new file.

    Raises OSError, also for a file that nobody may write or a new one that is there, and
    ChangedError where somebody else has written since `before` was read.
    """
    contents: dict[Path, tuple[bytes, int]] = {}
    for name, text in texts.items():
        path = Path(name)
        if name not in before:
            if path.exists():
                raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), name)
            contents[path] = (text.encode("utf-8"), 0o644)
            continue
        data = path.read_bytes()
        mode = path.stat().st_mode & 0o7777
        if _decoded(data) != before[name].text:
            raise ChangedError(f"{before[name].name} was changed by somebody else meanwhile")
        if not mode & 0o222:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), before[name].name)
        contents[path] = (_encoded(text, data), mode)
    _put_all(contents)


def _encoded(text: str, like: bytes) -> bytes:
    """A text in the encoding of other bytes, as `_decoded` reads it."""
    for mark, encoding in ((b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be"),
                           (b"\xef\xbb\xbf", "utf-8")):  # fmt: skip
        if like.startswith(mark):
            return mark + text.encode(encoding)
    return text.encode("utf-8")


def _put_all(contents: Mapping[Path, tuple[bytes, int]]) -> None:
    """Write bytes, with their permissions, to all paths or to none."""
    written: list[tuple[str, Path]] = []
    try:
        for path, (data, mode) in contents.items():
            handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
            written.append((temporary, path))
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
            Path(temporary).chmod(mode)
        for _, path in written:
            if path.is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        for temporary, path in written:
            Path(temporary).replace(path)
    except BaseException:
        for temporary, _ in written:
            with contextlib.suppress(OSError):
                Path(temporary).unlink()
        raise

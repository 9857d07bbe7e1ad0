"""Scripts checked in several processes: copies of this one, which send their results back."""

from __future__ import annotations

import contextlib
import io
import os
import pickle
import signal
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from smachac.diagnostics.source import Source
from smachac.frontend.files import Disk

TYPE_CHECKING = False  # annotations only: few checks start processes
if TYPE_CHECKING:
    from multiprocessing.connection import Connection

Work: TypeAlias = "Callable[[Path], tuple[object, frozenset[str]]]"
"""What is done with one script: its result, and the real paths of the files that it needs."""


def results_of(
    work: Work, paths: Sequence[Path], disk: Disk, processes: int
) -> Mapping[Path, bytes]:
    """The results of scripts, packed. Missing are those with a text that is no file, those of a
    process that ends before its time, and those from one on for which `work` raises an exception.
    """
    from multiprocessing import connection, get_context

    context = get_context("fork")
    started = []
    ends: list[Connection] = []
    for first in range(processes):
        ours, theirs = context.Pipe(duplex=False)
        part = paths[first::processes]
        process = context.Process(target=_serve, args=(work, part, disk, theirs), daemon=True)
        process.start()
        theirs.close()
        started.append(process)
        ends.append(ours)
    found: dict[Path, bytes] = {}
    try:
        while ends:
            ready = connection.wait(ends)
            for end in [known for known in ends if known in ready]:
                try:
                    path, result = end.recv()
                except (EOFError, OSError):
                    ends.remove(end)
                else:
                    found[path] = result
    finally:
        for process in started:
            process.kill()
            process.join()
    return found


def _serve(work: Work, paths: Sequence[Path], disk: Disk, results: Connection) -> None:
    """Send the results of scripts in their order, up to one on which the work fails."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the first process reports that it is stopped
    try:
        for path in paths:
            with contextlib.suppress(pickle.PicklingError):
                results.send((path, _packed(*work(path), disk)))
    except BaseException:  # the first process does this work again, and reports the fault
        os._exit(1)


class _Packer(pickle.Pickler):
    """Writes a source that was read from a file as the real path of that file. Other sources raise
    PicklingError: two processes make two of them."""

    def __init__(self, stream: io.BytesIO, disk: Disk) -> None:
        super().__init__(stream, protocol=pickle.HIGHEST_PROTOCOL)
        self.disk = disk

    def persistent_id(self, obj: object) -> str | None:
        if not isinstance(obj, Source):
            return None
        path = os.path.realpath(obj.name)
        if self.disk.known(path) is not obj:
            raise pickle.PicklingError(obj.name)
        return path


class _Unpacker(pickle.Unpickler):
    """Reads what a `_Packer` has written, with the sources of this process."""

    def __init__(self, stream: io.BytesIO, disk: Disk) -> None:
        super().__init__(stream)
        self.disk = disk

    def persistent_load(self, path: Any) -> Source:
        source = self.disk.known(path)
        if source is None:
            raise pickle.UnpicklingError(path)
        return source


def _packed(result: object, uses: frozenset[str], disk: Disk) -> bytes:
    stream = io.BytesIO()
    read = {path: source for path in uses if (source := disk.known(path)) is not None}
    texts = {path: (source.name, hash(source.text)) for path, source in read.items()}
    pickle.dump(texts, stream)
    _Packer(stream, disk).dump((result, uses))
    return stream.getvalue()


def unpacked(data: bytes, disk: Disk) -> tuple[Any, frozenset[str]] | None:
    """A result with the paths of its files. None if the disk of this process has another name or
    another text for one of the files: the result is then not valid here."""
    stream = io.BytesIO(data)
    for path, (name, text) in pickle.load(stream).items():
        source = disk.read(Path(name), [])
        if source is None or (source.name, hash(source.text)) != (name, text):
            return None
        if disk.known(path) is not source:
            return None
    result, uses = _Unpacker(stream, disk).load()
    return result, uses

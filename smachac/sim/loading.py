"""Files are loaded into the physics engine, after another process has tried to load them.

PyBullet may end its process while it reads a file: with a signal, or by a call of `exit`. So each
file that is not shipped with PyBullet or smachac is first loaded by a child process.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

from smachac.sim.physics import Engine, quiet
from smachac.sim.robot_file import EngineFile, explained

_LONGEST_TRIAL = 120.0
"""Time (s) in which the child process has to load its files."""

_tried: set[str] = set()
"""Digests of the files that a child of this process has loaded: a sweep loads them in each run."""


def load(engine: Engine, file: EngineFile, **options: Any) -> tuple[int, ...]:
    """Load a URDF or SDF file; PyBullet's numbers of the bodies in it. Raises LoadError.

    `options` are further arguments of PyBullet's loadURDF.
    """
    with _on_disk([file]) as (name,), tempfile.TemporaryFile() as output:
        bodies: Sequence[int] = (-1,)
        # PyBullet raises its own class, pybullet.error.
        with quiet(output), contextlib.suppress(Exception):
            is_sdf = name.lower().endswith(".sdf")
            bodies = engine.loadSDF(name) if is_sdf else (engine.loadURDF(name, **options),)
        if bodies and bodies[0] >= 0:
            return tuple(bodies)
        output.seek(0)
        text = output.read().decode("utf-8", "replace")
        raise explained(file, text, name, "" if bodies else "finds no body in it")


@contextlib.contextmanager
def tried(files: Iterable[EngineFile]) -> Iterator[None]:
    """Load files in a child process while the block runs.

    Files that were loaded before, and those of PyBullet and smachac, are not tried. Raises
    LoadError at the end of the block for the first file that the child does not load.
    """
    new = {_digest(file): file for file in files if not file.is_shipped}
    wanted = {digest: file for digest, file in new.items() if digest not in _tried}
    if not wanted or not sys.executable:
        yield
        return
    with _on_disk([*wanted.values()]) as names, tempfile.TemporaryDirectory() as folder:
        progress = Path(folder) / "progress"
        with _child(names, progress) as child:
            yield
            output, ended = _result(child)
        loaded = int(progress.read_text("utf-8")) if progress.exists() else None
        # A child that could not start has no result: its files are loaded without it.
        if loaded is not None and loaded < len(names):
            file = [*wanted.values()][loaded]
            try_out(map(_mesh_alone, file.meshes))  # the error of a mesh, if that is the reason
            raise explained(file, output, names[loaded], ended)
    _tried.update(wanted)


def try_out(files: Iterable[EngineFile]) -> None:
    """Load files in a child process, see `tried`. Raises LoadError."""
    with tried(files):
        pass


def _mesh_alone(mesh: Path) -> EngineFile:
    """The file of a body that consists of a mesh."""
    shape = f"<geometry><mesh filename={quoteattr(str(mesh))}/></geometry>"
    link = f'<link name="mesh">\n<visual>{shape}</visual>\n<collision>{shape}</collision>\n</link>'
    return EngineFile(path=mesh, text=f'<robot name="mesh">\n{link}\n</robot>\n')


@contextlib.contextmanager
def _child(names: Sequence[str], progress: Path) -> Iterator[subprocess.Popen[bytes]]:
    task = json.dumps({"path": sys.path, "files": names, "progress": str(progress)})
    script = Path(__file__).with_name("trial.py")
    with subprocess.Popen(
        [sys.executable, "-I", str(script), task],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    ) as child:
        try:
            yield child
        finally:
            child.kill()


def _result(child: subprocess.Popen[bytes]) -> tuple[str, str]:
    """What a child printed, and how it ended if that was not its regular end."""
    try:
        output, _ = child.communicate(timeout=_LONGEST_TRIAL)
        ended = _end(child.returncode)
    except subprocess.TimeoutExpired as error:
        output, ended = error.stdout or b"", f"did not end within {_LONGEST_TRIAL:g} s"
    return output.decode("utf-8", "replace"), ended


def _end(code: int) -> str:
    """How a process ended; empty for its regular end."""
    if code == 0:
        return ""
    with contextlib.suppress(ValueError):
        return f"ended with the signal {signal.Signals(-code).name}"
    return f"ended with the exit code {code}"


@contextlib.contextmanager
def _on_disk(files: Sequence[EngineFile]) -> Iterator[list[str]]:
    """The names of files for PyBullet; printed texts are written to a temporary folder."""
    with tempfile.TemporaryDirectory() as folder:
        names = []
        for number, file in enumerate(files):
            path = file.path.absolute()
            if file.text is not None:
                path = Path(folder) / f"{number}.urdf"
                path.write_text(file.text, encoding="utf-8")
            names.append(str(path))
        yield names


def _digest(file: EngineFile) -> str:
    """A digest of what PyBullet reads: the text, and the size and time of the other files."""
    read = file.meshes if file.text is not None else (file.path,)
    states = [(str(path), path.stat().st_size, path.stat().st_mtime_ns) for path in read]
    return hashlib.blake2b(repr((file.text, states)).encode()).hexdigest()

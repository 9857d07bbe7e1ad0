"""Files are loaded into the physics engine, after another process has tried to load them.

PyBullet may end its process while it reads a file: with a signal, or by a call of `exit`. So each
file that is not shipped with PyBullet or smachac is first loaded by a child process.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

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
        bodies: Sequence[int] = ()
        # PyBullet raises its own class, pybullet.error
        with quiet(output), contextlib.suppress(Exception):
            if _is_sdf(name):
                bodies = engine.loadSDF(name)
            else:
                bodies = (engine.loadURDF(name, **options),)
        if bodies and bodies[0] >= 0:
            return tuple(bodies)
        output.seek(0)
        raise explained(file, output.read().decode("utf-8", "replace"), name)


def try_out(files: Iterable[EngineFile]) -> None:
    """Load files in a child process. Raises LoadError for the first that does not load there.

    Files that were loaded before, and those of PyBullet and smachac, are not tried.
    """
    new = {_digest(file): file for file in files if not file.is_shipped}
    wanted = {digest: file for digest, file in new.items() if digest not in _tried}
    if wanted and sys.executable:
        _try_out([*wanted.values()])
        _tried.update(wanted)


def _try_out(files: Sequence[EngineFile]) -> None:
    with _on_disk(files) as names, tempfile.TemporaryDirectory() as folder:
        progress = Path(folder) / "progress"
        task = {"path": sys.path, "files": names, "progress": str(progress)}
        script = Path(__file__).with_name("trial.py")
        try:
            done = subprocess.run(
                [sys.executable, "-I", str(script), json.dumps(task)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                timeout=_LONGEST_TRIAL,
                check=False,
            )
            output, ended = done.stdout, _end(done.returncode)
        except subprocess.TimeoutExpired as error:
            output, ended = error.stdout or b"", f"did not end within {_LONGEST_TRIAL:g} s"
        loaded = int(progress.read_text()) if progress.exists() else None
    if loaded is None or loaded == len(files):
        return  # a child that cannot start has no result: the files are loaded without it
    text = output.decode("utf-8", "replace")
    if ended:
        text += f"\nPyBullet {ended} while it loaded the file"
    raise explained(files[loaded], text, names[loaded])


def _end(code: int) -> str:
    """How a process ended that did not report a result; empty if it did."""
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
            name = os.path.abspath(file.path)
            if file.text is not None:
                name = os.path.join(folder, f"{number}.urdf")
                Path(name).write_text(file.text, encoding="utf-8")
            names.append(name)
        yield names


def _digest(file: EngineFile) -> str:
    """A digest of what PyBullet reads: the text, and the size and time of the other files."""
    read = file.meshes if file.text is not None else (file.path,)
    states = [(str(path), os.stat(path).st_size, os.stat(path).st_mtime_ns) for path in read]
    return hashlib.blake2b(repr((file.text, states)).encode()).hexdigest()


def _is_sdf(name: str) -> bool:
    return name.lower().endswith(".sdf")

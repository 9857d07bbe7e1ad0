"""The database of a sweep: SQLite, one row for each run, and the digests of the inputs."""

from __future__ import annotations

import json
import sqlite3
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from smachac.sweep.task import Run
from smachac.verify.coverage import CoverageItem
from smachac.verify.trace_statistics import StateStatistics

APPLICATION = 0x536D4353
"""The number that marks databases of sweeps (`PRAGMA application_id`)."""

VERSION = 1
"""The version of the tables."""

COLUMNS = (
    *("seed", "vary", "outcome", "error", "seconds", "wall"),
    *("steps", "states", "covered", "faults", "world"),
)
TABLES = """
CREATE TABLE IF NOT EXISTS inputs (name TEXT PRIMARY KEY, digest TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS runs (
  seed INTEGER PRIMARY KEY, vary TEXT, outcome TEXT, error TEXT, seconds REAL, wall REAL,
  steps TEXT, states TEXT, covered TEXT, faults TEXT, world TEXT
);
"""

BUSY = 60.0
"""Seconds to wait for another process that writes to the database."""


class DatabaseError(Exception):
    """A database cannot be used; the message has the reason and help."""


class Database:
    """The results of a sweep by seed. A run is in it once, whoever adds it how often.

    `path` is a file, or None for a database in memory. `inputs` are the digests of what the sweep
    depends on, by name; None: any. Raises DatabaseError for a file with other inputs, or that is no
    database of a sweep.
    """

    def __init__(self, path: Path | None, inputs: Mapping[str, str] | None) -> None:
        self._path = path
        with self._errors():
            self._connection = sqlite3.connect(":memory:" if path is None else path, timeout=BUSY)
            try:
                self._open(inputs)
                self._file = self._identity()
            except BaseException:
                self._connection.close()
                raise

    def _open(self, inputs: Mapping[str, str] | None) -> None:
        connection = self._connection
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        (version,) = connection.execute("PRAGMA user_version").fetchone()
        (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if (tables or inputs is None) and application != APPLICATION:
            raise DatabaseError(f"{self._path} is not a database of `smachac sweep`")
        if tables and version != VERSION:
            raise DatabaseError(f"{self._path} was made by another version of smachac")
        if inputs is None:
            return
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("BEGIN IMMEDIATE")  # two sweeps may begin at the same time
        with connection:
            connection.execute(f"PRAGMA application_id = {APPLICATION}")
            connection.execute(f"PRAGMA user_version = {VERSION}")
            for statement in TABLES.split(";"):
                connection.execute(statement)
            found = dict(connection.execute("SELECT name, digest FROM inputs"))
            if not found:
                connection.executemany("INSERT INTO inputs VALUES (?, ?)", inputs.items())
            elif found != dict(inputs):
                names = sorted(
                    name for name in {*found, *inputs} if found.get(name) != inputs.get(name)
                )
                raise DatabaseError(
                    f"{self._path} has runs with other inputs: {', '.join(names)}\n"
                    "delete it, or give another file with --database"
                )

    @contextmanager
    def _errors(self) -> Iterator[None]:
        """Raises DatabaseError for errors of SQLite: no access, a full disk."""
        try:
            yield
        except sqlite3.Error as error:
            raise DatabaseError(f"the database {self._path} cannot be used: {error}") from None

    def close(self) -> None:
        self._connection.close()

    def _identity(self) -> tuple[int, int] | None:
        """The device and the inode of the file; None without a file."""
        try:
            found = None if self._path is None else self._path.stat()
        except OSError:
            return None
        return found and (found.st_dev, found.st_ino)

    def check_file(self) -> None:
        """Raises DatabaseError if the file is not there any more: SQLite would go on writing to the
        deleted file."""
        if self._identity() != self._file:
            raise DatabaseError(
                f"the database {self._path} was deleted or replaced during the sweep: its runs are"
                " lost"
            )

    def inputs(self) -> dict[str, str]:
        """The digests of what the sweep depends on, by name."""
        with self._errors():
            return dict(self._connection.execute("SELECT name, digest FROM inputs"))

    def seeds(self) -> set[int]:
        """The seeds whose runs are done."""
        with self._errors():
            return {seed for (seed,) in self._connection.execute("SELECT seed FROM runs")}

    def has(self, seed: int) -> bool:
        """Whether the run with a seed is done, in this process or another one."""
        with self._errors():
            rows = self._connection.execute("SELECT 1 FROM runs WHERE seed = ?", (seed,))
            return rows.fetchone() is not None

    def add(self, run: Run) -> bool:
        """Add a run; False if the run with its seed is there already. Raises DatabaseError."""
        self.check_file()
        marks = ", ".join("?" * len(COLUMNS))
        statement = f"INSERT OR IGNORE INTO runs ({', '.join(COLUMNS)}) VALUES ({marks})"
        with self._errors(), self._connection:
            return self._connection.execute(statement, _row(run)).rowcount > 0

    def runs(self, first: int | None = None, count: int = 0) -> Iterator[Run]:
        """The runs in the order of their seeds: all, or those of `count` seeds from `first` on.

        Raises DatabaseError, also for a row whose values are not those of a run.
        """
        select = f"SELECT {', '.join(COLUMNS)} FROM runs"
        where = "" if first is None else f" WHERE seed >= {first:d} AND seed < {first + count:d}"
        with self._errors():
            for row in self._connection.execute(f"{select}{where} ORDER BY seed"):
                try:
                    run = _run(row)
                except (ValueError, TypeError, AttributeError, KeyError):
                    raise DatabaseError(
                        f"the database {self._path} cannot be used:"
                        f" the values of the run with seed {row[0]} are wrong"
                    ) from None
                yield run


def _row(run: Run) -> tuple[Any, ...]:
    states = {
        path: [dict(state.outcomes), state.seconds, state.longest, state.unfinished]
        for path, state in run.states.items()
    }
    return (
        run.seed,
        json.dumps(dict(run.values)),
        run.outcome,
        run.error,
        run.seconds,
        run.wall,
        json.dumps(run.steps),
        json.dumps(states),
        json.dumps(run.covered),
        json.dumps(run.faults),
        run.world,
    )


def _run(row: tuple[Any, ...]) -> Run:
    seed, values, outcome, error, seconds, wall, steps, states, covered, faults, world = row
    return Run(
        seed=seed,
        values=dict(json.loads(values)),
        outcome=outcome,
        error=error,
        seconds=float(seconds),
        wall=float(wall),
        steps=[(path, end) for path, end in _listed(json.loads(steps))],
        states={
            path: StateStatistics(Counter(outcomes), total, longest, unfinished)
            for path, (outcomes, total, longest, unfinished) in json.loads(states).items()
        },
        covered=[CoverageItem(*item) for item in _listed(json.loads(covered))],
        faults=[str(fault) for fault in _listed(json.loads(faults))],
        world=world,
    )


def _listed(data: Any) -> list[Any]:
    """A list. Raises TypeError for other data."""
    if not isinstance(data, list):
        raise TypeError
    return data

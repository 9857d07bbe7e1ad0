"""Compiled C++ against what SMACH itself did, machine by recorded machine.

The sanitizers get every machine. Of the other compilers, each gets a part of them, with
SMACHAC_CPP=all in the environment every one.
"""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.conformance_ir import test_ir_vectors as recorded
from tests.conformance_ir.ir_vectors import nodes_of
from tests.cpp.compilers import BARE, SANITIZED, THREADED, Compiler, compilers, last_with
from tests.cpp.vector_programs import Part, Ran, part, replay

Json = Any

EVERYTHING = os.environ.get("SMACHAC_CPP") == "all"

REFUSED = {
    "h089-concurrence-empty": "the container has no states",
    "h116-iterator-items-from-userdata": "the items key `jobs` is `any`, not a list",
    "h120-iterator-items-key-missing": "the items key `nope` is `any`, not a list",
    "h121-iterator-without-child": "the container has no states",
}
"""What C++ cannot say, and what it says of it."""

DEVIATIONS = {
    "h066-reference-sharing": "containers copy values at their borders",
    **dict.fromkeys(
        ("A20-026", "A20-043", "A20-122", "A20-342", "A20-385"),
        "after a failure that ends the run, shared keys hold what was written last",
    ),
}
"""Where C++ does something else, and why."""

DECLARED = {
    *("h082-concurrence-unregistered-child-outcome", "A20-034", "A20-226", "A20-338"),
    *("h115-iterator-raw-userdata", "A20-006", "A20-139", "A20-370"),
}
"""Where SMACH goes on with outcomes and keys that nobody declares. In C++ they are declared, and
the same happens."""

WITHOUT_OUTCOME = {"h097-concurrence-child-none", "h114-iterator-child-none"}
"""Where C++ fails with an error of its own, which stands for what was recorded."""

NAMES = [name for name in recorded.RUN if name not in REFUSED]
CHUNK = 100


def shares() -> list[Any]:
    """The machines of each compiler, in parts for a program each. The last compiler, of several,
    has none: it compiles every machine for the sanitizers."""
    found = []
    alone = compilers()[: len(compilers()) if EVERYTHING else max(len(compilers()) - 1, 1)]
    for at, compiler in enumerate(alone):
        names = NAMES if EVERYTHING else NAMES[at :: len(compilers())]
        for start in range(0, len(names), CHUNK):
            chunk = names[start : start + CHUNK]
            marks = pytest.mark.nightly if at else ()
            found.append(
                pytest.param(compiler, chunk, id=f"{compiler.name}-{chunk[0]}", marks=marks)
            )
    return found or [pytest.param(None, (), marks=pytest.mark.skip("no C++ compiler"))]


@functools.cache
def made(name: str) -> Part:
    found = part(recorded.CASES[name], f"v{recorded.RUN.index(name)}")
    assert isinstance(found, Part), found
    return found


def told(case: Json, ran: Ran) -> Json:
    """One run in the form that is compared."""
    nodes = dict(nodes_of(case))
    concurrences = {path for path, node in nodes.items() if node["type"] == "concurrence"}
    leaves = {path for path, node in nodes.items() if node["type"] == "leaf"}
    result = {
        "outcome": ran.outcome,
        "category": ran.category,
        "userdata": ran.userdata["/root"],
        "scopes": {
            path.removeprefix("/root"): held
            for path, held in ran.userdata.items()
            if path not in ("", "/root")
        },
        "events": recorded._nested(
            ran.events, concurrences, leaves if case.get("preempt") else set()
        ),
    }
    return result if "parent" not in case else {**result, "parent": ran.userdata[""]}


def without_shared(run: Json, part: Part) -> Json:
    """One run of the interpreter without the keys that containers share in C++: they have no value
    of their own there. What states read and write is compared for all keys."""

    def own(path: str, held: Json) -> Json:
        return {key: value for key, value in held.items() if key not in part.shared[path]}

    scopes = {path: own(path, held) for path, held in run["scopes"].items()}
    return {**run, "userdata": own("", run["userdata"]), "scopes": scopes}


def agree(names: Iterable[str], compiler: Compiler, folder: Path, *flags: str) -> None:
    """Compare compiled machines with the interpreter, which does what was recorded."""
    names = list(names)
    runs = replay([made(name) for name in names], compiler, folder, *flags)
    for name in names:
        case = recorded.CASES[name]
        ours = [without_shared(run, made(name)) for run in recorded.replay(case)]
        theirs = [told(case, ran) for ran in runs[name]]
        if name in DEVIATIONS:
            assert theirs != ours, f"{name} does not deviate any more"
        else:
            assert theirs == ours, name


@pytest.mark.parametrize(("compiler", "names"), shares())
@pytest.mark.slow
def test_machines_do_what_smach_did(compiler: Compiler, names: list[str], tmp_path: Path) -> None:
    agree(names, compiler, tmp_path)


def sanitized() -> Iterator[Any]:
    """Every machine for the sanitizers of memory; those with threads for that of races."""
    threaded = [name for name in NAMES if has_branches(name)]
    for flags, kind, names in ((SANITIZED, "memory", NAMES), (THREADED, "threads", threaded)):
        for start in range(0, len(names), CHUNK):
            chunk = names[start : start + CHUNK]
            yield pytest.param(flags, chunk, id=f"{kind}-{chunk[0]}")


@pytest.mark.nightly
@pytest.mark.parametrize("start", range(0, len(NAMES), CHUNK))
def test_machines_run_without_exceptions_and_type_information(start: int, tmp_path: Path) -> None:
    chunk = NAMES[start : start + CHUNK]
    agree(filter(without_error, chunk), last_with(*BARE), tmp_path, *BARE)


def without_error(name: str) -> bool:
    """Whether no run of a machine ended with an error, in SMACH and in the interpreter."""
    runs = [*recorded.CASES[name]["expect"]["runs"], *recorded.replay(recorded.CASES[name])]
    return all(run.get("category") is None for run in runs)


def test_most_machines_end_without_an_error() -> None:
    assert sum(map(without_error, NAMES)) == 326


def test_docs_say_which_machines_differ() -> None:
    docs = (Path(__file__).parents[2] / "docs" / "cpp.md").read_text("utf-8")
    table = docs.partition("### Recorded machines")[2].partition("\n## ")[0]
    named = re.findall(r"`((?:h\d+|A\d+)-[\w-]+)`", table)
    assert sorted(named) == sorted({*REFUSED, *DEVIATIONS, *DECLARED, *WITHOUT_OUTCOME})


def has_branches(name: str) -> bool:
    return any(node["type"] == "concurrence" for _, node in nodes_of(recorded.CASES[name]))


@pytest.mark.nightly
@pytest.mark.parametrize(("flags", "names"), [*sanitized()])
def test_sanitizers_find_nothing(flags: tuple[str, ...], names: list[str], tmp_path: Path) -> None:
    agree(names, last_with(*flags), tmp_path, *flags)


@pytest.mark.parametrize("name", REFUSED)
def test_what_cpp_cannot_say_is_refused(name: str) -> None:
    assert part(recorded.CASES[name], "v") == [f"not supported in C++: {REFUSED[name]}"]

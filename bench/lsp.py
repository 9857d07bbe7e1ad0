"""What the language server costs: a change of one line in a project of 1,000 states, every answer
there, and random edits of the examples with the findings of a fresh check beside them.

    python bench/lsp.py             the project
    python bench/lsp.py file        the same states in one file
    python bench/lsp.py edits 10000 random edits: faults, differences, memory

Everything is CPU time of one process; as in the server, garbage is collected after a check, when
nobody types, which has its own figure.
"""

from __future__ import annotations

import gc
import os
import random
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from smachac.diagnostics.diagnostic import Diagnostic, in_order
from smachac.driver.batch import check_scripts
from smachac.frontend.files import Disk
from smachac.ir.recursion import deep_recursion
from smachac.lsp import symbols
from smachac.lsp.completion import complete
from smachac.lsp.facts import Facts
from smachac.lsp.hints import hints
from smachac.lsp.hover import hover
from smachac.lsp.navigation import definitions, named_at, references
from smachac.lsp.place import Place, place_at
from smachac.lsp.session import Session, View
from tests.support.lsp_answers import answers
from tests.support.lsp_edits import Edit, edited

ROOT = Path(__file__).parents[1] / "examples"

PARTS, STATES = 40, 25
"""The sub-scripts of the project, and the states in each."""

STATE = """\
    - S{n}:
        template: PoseToJointPositionsState
        remapping: {{pose: goal, joints: joints_{n}}}
        transitions: {{succeeded: {next}, aborted: aborted}}
"""


def project(folder: Path) -> Path:
    """A project of 1,000 states: a script that calls 40 sub-scripts."""
    calls = []
    for part in range(PARTS):
        rows = [
            STATE.format(n=n, next=f"S{n + 1}" if n < STATES - 1 else "succeeded")
            for n in range(STATES)
        ]
        head = (
            f"- PART_{part}:\n    template: StateMachine\n    outcomes: [succeeded, aborted]\n"
            "    input_keys: [goal]\n    states:\n"
        )
        (folder / f"part_{part}.yml").write_text(head + "".join(rows), "utf-8")
        after = f"PART_{part + 1}" if part < PARTS - 1 else "succeeded"
        calls.append(
            f"- PART_{part}:\n    script: part_{part}\n"
            f"    transitions: {{succeeded: {after}, aborted: aborted}}\n"
        )
    main = folder / "main.yml"
    head = (
        "name: big\ntemplate: Base\noutcomes: [succeeded, aborted]\n"
        "userdata: {goal: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}\nstates:\n"
    )
    main.write_text(head + "".join(calls), "utf-8")
    return main


def cpu(action: Callable[[], object]) -> float:
    start = time.process_time()
    action()
    return (time.process_time() - start) * 1000


def time_project(rounds: int = 11) -> None:
    """The time of a check after a change of one line, and of every answer."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name).resolve()
        main = str(project(folder))
        part = str(folder / "part_20.yml")
        session = Session([folder])
        print(f"first check          {cpu(lambda: session.check(main)):7.1f} ms")
        whole = Path(part).read_text("utf-8")
        session.change(part, whole)
        session.check(part)
        rows: dict[str, list[float]] = {}
        for number in range(rounds):
            text = whole.replace("S12, aborted", f"S{13 + number % 3}, aborted")
            session.change(part, text)
            rows.setdefault("check", []).append(cpu(lambda: session.check(part)))
            rows.setdefault("a collection of garbage", []).append(cpu(gc.collect))
            with deep_recursion():
                for kind, taken in ask(session, part, text):
                    rows.setdefault(kind, []).append(taken)
        for kind, taken_each in rows.items():
            middle = sorted(taken_each)[len(taken_each) // 2]
            print(f"{kind:<24} {middle:7.1f} ms (the slowest of {rounds}: {max(taken_each):.1f})")


def time_file(parts: int, rounds: int = 21) -> None:
    """The time of a check after a change of one line in a file of 1,000 states."""
    with tempfile.TemporaryDirectory() as name:
        path = str(Path(name).resolve() / "main.yml")
        session, text = Session([Path(name)]), one_file(parts)
        session.change(path, text)
        print(f"{parts:>2} containers, first check {cpu(lambda: session.check(path)):7.1f} ms")
        taken, collections = [], []
        target = "S12" if parts else "S612"
        at = text.index(f"{target}, aborted", len(text) // 2)
        for number in range(rounds):
            new = text[:at] + f"S{int(target[1:]) + 1 + number % 3}" + text[at + len(target) :]
            session.change(path, new)
            taken.append(cpu(lambda: session.check(path)))
            collections.append(cpu(gc.collect))
        middle = sorted(taken)[rounds // 2]
        print(f"   after a change          {middle:7.1f} ms (the fastest: {min(taken):.1f})")
        print(f"   a collection of garbage {min(collections):7.1f} ms")


def one_file(parts: int) -> str:
    """A script of 1,000 states, in containers or not."""
    text = [
        "name: big\ntemplate: Base\noutcomes: [succeeded, aborted]\n"
        "userdata: {goal: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}\nstates:\n"
    ]
    size = STATES if parts else PARTS * STATES
    rows = [
        STATE.format(n=n, next=f"S{n + 1}" if n < size - 1 else "succeeded") for n in range(size)
    ]
    if not parts:
        return "".join([*text, *(row.replace("\n    ", "\n")[4:] for row in rows)])
    for part in range(parts):
        after = f"PART_{part + 1}" if part < parts - 1 else "succeeded"
        text += [
            f"- PART_{part}:\n    template: StateMachine\n    outcomes: [succeeded, aborted]\n"
            f"    input_keys: [goal]\n    transitions: {{succeeded: {after}, aborted: aborted}}\n"
            "    states:\n",
            *rows,
        ]
    return "".join(text)


def ask(session: Session, path: str, text: str) -> list[tuple[str, float]]:
    """The time of each answer in a text."""
    offset = text.index("goal, joints: joints_12")
    found: list[tuple[str, float]] = []

    def note(kind: str, action: Callable[[View, Place, Facts], object]) -> None:
        def run() -> object:
            view = session.view(path)
            assert view is not None
            place = place_at(view.tree, offset)
            assert place is not None
            known = view.machine.state_types if view.machine is not None else {}
            return action(view, place, Facts(view.library, path, known))

        found.append((kind, cpu(run)))

    note("hover", lambda view, place, facts: hover(place, facts, view, path))
    note("completion", lambda view, place, facts: complete(text, offset, path, view))
    note("definition", lambda view, place, facts: definitions(place, facts))
    named = named_at_offset(session, path, offset)
    note("references", lambda view, place, facts: named(facts))
    note("symbols", lambda view, place, facts: symbols.symbols(view.tree))
    note("folds", lambda view, place, facts: symbols.folds(view.tree))
    note("tokens", lambda view, place, facts: symbols.tokens(view.tree))
    note("hints", lambda view, place, facts: hints(view, path))
    return found


def named_at_offset(session: Session, path: str, offset: int) -> Callable[[Facts], object]:
    def run(facts: Facts) -> object:
        view = session.view(path)
        place = place_at(view.tree, offset) if view is not None else None
        named = named_at(place, facts) if place is not None else None
        return references(named, session.machines(path)) if named is not None else None

    return run


def random_edits(number: int, seed: int = 0) -> None:
    """Random edits of the examples; every answer is computed after each."""
    source = random.Random(seed)
    scripts = sorted(ROOT.resolve().rglob("main.yml"))
    session = Session([ROOT.resolve()])
    differences = 0
    memory: list[int] = []
    history: list[str] = []
    path = scripts[0]
    started = time.process_time()
    for count in range(number):
        if count % 10 == 0:
            session.close(str(path))
            path = source.choice(scripts)
            history = [path.read_text("utf-8")]
        kinds = ["insert", "insert", "delete", "delete", "paste", "undo"]
        edit = Edit(source.choice(kinds), source.random(), source.randint(1, 200),
                    source.randint(0, 10_000))  # fmt: skip
        text, offset = edited(history, edit)
        found = answers(session, str(path), text, offset)
        fresh = check_scripts([path], Disk({str(path): text})).report
        differences += sorted(map(row, found)) != sorted(map(row, in_order(fresh)))
        if count % max(number // 10, 1) == 0:
            memory.append(resident())
            print(f"{count:>6} edits, {memory[-1]} MB", flush=True)
    taken = time.process_time() - started
    print(f"{number} edits: no exception, {differences} with other findings than a fresh check,"
          f" {memory[0]} to {resident()} MB, {taken:.0f} s of CPU")  # fmt: skip


def resident() -> int:
    """The memory of this process in MB."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * resource.getpagesize() // 1_000_000
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1_000


def row(item: Diagnostic) -> tuple[object, ...]:
    # A file that several scripts share has the name by which the first of them calls it.
    name = os.path.realpath(item.span.source.name)
    return item.code, item.severity.value, name, item.span.start, item.message


if __name__ == "__main__":
    if sys.argv[1:2] == ["edits"]:
        random_edits(int(sys.argv[2]) if len(sys.argv) > 2 else 10_000)
        sys.exit()
    gc.disable()
    if sys.argv[1:2] == ["file"]:
        time_file(PARTS)
        time_file(0)
    else:
        time_project()

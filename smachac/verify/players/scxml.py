"""Player of the SCXML target: one process of Node with SCION runs all test cases.

The document logs the events of its trace. Each leaf is an `<invoke>`, which the host answers with
the steps of the test case; on live paths some leaves are those of the document, so that there is
one more document for these.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Report
from smachac.interpreter.behaviours import is_made_of_functions
from smachac.ir.nodes import Leaf, Machine, Node, Outcome, StateMachine
from smachac.ir.traversal import walk
from smachac.records import replace
from smachac.targets.scxml import document
from smachac.targets.scxml.plan import Plan
from smachac.verify.guidance import possible_leaf_outcomes
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError

PACKAGE = "@scion-scxml/scxml"

DONE = "--"
"""The line after each trace."""


def player(machine: Machine, report: Report, *, folders: Sequence[Path]) -> Player:
    """A player of the generated document. Adds to `report` what SCXML cannot express.

    SCION is found in `node_modules` of the working folder, of `folders` and of those around them,
    and in NODE_PATH. The player raises UnplayableError if Node or SCION is missing.
    """
    live = frozenset(
        path
        for path, node in walk(machine.root)
        if isinstance(node, Leaf) and is_made_of_functions(node)
    )
    document(scripted(machine, live), report, traced=True)

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        stages = sorted({case.live for case in cases}, key=sorted)
        texts = [document(scripted(machine, stage), [], traced=True) for stage in stages]
        ids = Plan(machine, [], traced=False).ids
        rows = [_case(case, stages.index(case.live), ids) for case in cases]
        yield from traces(texts, rows, folders=folders, scripted=True)

    return play


def scripted(machine: Machine, live: frozenset[str]) -> Machine:
    """The machine whose leaves, except for live ones, have the code of a host."""
    made: dict[str, Node] = {}
    for path, node in reversed(list(walk(machine.root))):
        if isinstance(node, Leaf):
            made[path] = node if path in live else _scripted(node)
        else:
            children = tuple(made[f"{path}/{child.name}"] for child in node.children)
            made[path] = replace(node, children=children)
    root = made[machine.root.name]
    assert isinstance(root, StateMachine)
    return replace(machine, root=root)


def _scripted(leaf: Leaf) -> Leaf:
    names = possible_leaf_outcomes(leaf)
    outcomes = leaf.outcomes or tuple(Outcome(name=name, span=leaf.span) for name in names)
    return replace(leaf, built_in="", variables=(), outcomes=outcomes, open=False)


def _case(case: TestCase, number: int, ids: Mapping[str, str]) -> dict[str, Any]:
    return {
        "document": number,
        "inputs": case.userdata,
        "stopped": case.stopped,
        "most": case.most,
        "paths": {ids[path]: path for path in case.rows},
        "rows": {ids[path]: [step._asdict() for step in row] for path, row in case.rows.items()},
        "reads": {ids[path]: list(keys) for path, keys in case.reads.items()},
    }


def traces(
    documents: Sequence[str],
    cases: Sequence[Mapping[str, Any]],
    *,
    folders: Sequence[Path] = (),
    scripted: bool,
) -> Iterator[list[Event]]:
    """The traces of cases (see play.js). `scripted`: leaves perform steps; otherwise they are those
    that scion_host.js has. Raises UnplayableError."""
    node = shutil.which("node")
    if node is None:
        raise UnplayableError("Node is not here: install it, to run documents of SCXML")
    where = scion(node, folders)
    with (
        resources.as_file(resources.files("smachac.verify").joinpath("play.js")) as program,
        resources.as_file(
            resources.files("smachac.runtime").joinpath("scxml/scion_host.js")
        ) as host,
        tempfile.TemporaryFile("w+", encoding="utf-8") as given,
    ):
        job = {"host": str(host), "scion": where, "documents": documents, "cases": cases}
        json.dump(job | {"scripted": scripted}, given)
        given.seek(0)
        with subprocess.Popen(
            [node, str(program)], stdin=given, stdout=subprocess.PIPE, encoding="utf-8"
        ) as process:
            assert process.stdout is not None
            events: list[Event] = []
            try:
                for line in process.stdout:
                    if line.strip() == DONE:
                        yield events
                        events = []
                    else:
                        events.append(json.loads(line))
            finally:
                if process.poll() is None:
                    process.kill()
        if events:
            yield events


def scion(node: str, folders: Sequence[Path]) -> str:
    """The path of the package SCION. Raises UnplayableError if it is not installed."""
    places = [str(Path.cwd()), *map(str, folders)]
    search = f"require.resolve({json.dumps(PACKAGE)}, {{paths: {json.dumps(places)}}})"
    found = subprocess.run(
        [node, "-p", search], capture_output=True, encoding="utf-8", env=dict(os.environ)
    )
    if found.returncode != 0:
        raise UnplayableError(f"SCION is not here: run `npm install {PACKAGE}` beside the script")
    return found.stdout.strip()

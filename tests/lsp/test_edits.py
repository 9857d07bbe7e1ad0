"""Random edits: no answer is an error, and the findings are those of `smachac check`."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.driver.batch import check_scripts
from smachac.frontend.files import Disk
from smachac.lsp.session import Session
from tests.support.examples import examples
from tests.support.lsp_answers import answers
from tests.support.lsp_client import Client
from tests.support.lsp_edits import Edit, edited, edits

ROOT = Path(os.path.realpath(Path(__file__).parents[2] / "examples"))
SCRIPTS = sorted(ROOT.rglob("main.yml"))
SEVERITY = {"error": 1, "warning": 2, "info": 3}


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    pytest.importorskip("pygls")
    with Client(ROOT) as running:
        yield running
        assert running.end() == ""


def expected(path: Path, text: str) -> list[tuple[Any, ...]]:
    """The findings of `smachac check` in a script with a text that is not saved."""
    real = os.path.realpath(path)
    report = check_scripts([path], Disk({real: text})).report
    return sorted(
        (item.code, SEVERITY[item.severity.value], *item.span.source.position(item.span.start),
         item.message)
        for item in report
        if os.path.realpath(item.span.source.name) == real
    )  # fmt: skip


def published(client: Client, uri: str, text: str) -> list[tuple[Any, ...]]:
    found = []
    for item in client.findings(uri):
        start = item["range"]["start"]
        line = text.split("\n")[start["line"]]
        column = len(line.encode("utf-16-le")[: 2 * start["character"]].decode("utf-16-le"))
        message = item["message"].split("\n")[0]
        found.append((item["code"], item["severity"], start["line"] + 1, column + 1, message))
    return sorted(found)


def ask_everything(client: Client, uri: str, text: str, offset: int) -> None:
    """All questions of an editor about a place."""
    before = text[:offset]
    column = len(before[before.rfind("\n") + 1 :].encode("utf-16-le")) // 2
    position = {"line": before.count("\n"), "character": column}
    document = {"textDocument": {"uri": uri}}
    options = {"tabSize": 2, "insertSpaces": True}
    for method in ("completion", "hover", "definition", "prepareRename", "documentHighlight"):
        client.ask(f"textDocument/{method}", **document, position=position)
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 9999, "character": 0}}
    for method in ("documentSymbol", "foldingRange", "semanticTokens/full", "codeLens"):
        client.ask(f"textDocument/{method}", **document)
    client.ask("textDocument/inlayHint", **document, range=whole)
    here = {"start": position, "end": position}
    client.ask("textDocument/codeAction", **document, range=here, context={"diagnostics": []})
    client.ask("textDocument/formatting", **document, options=options)


def start_of(path: Path) -> list[str]:
    return [path.read_text("utf-8")]


@settings(max_examples=15, deadline=None, derandomize=True,
          suppress_health_check=[HealthCheck.function_scoped_fixture])  # fmt: skip
@given(st.sampled_from(SCRIPTS), st.lists(edits(), min_size=1, max_size=5))
@pytest.mark.slow
def test_random_edits_in_a_server(client: Client, path: Path, steps: list[Edit]) -> None:
    uri = client.open(path)
    history = start_of(path)
    for step in steps:
        text, offset = edited(history, step)
        client.change(uri, text)
        ask_everything(client, uri, text, offset)
        assert published(client, uri, text) == expected(path, text)
    client.tell("textDocument/didClose", textDocument={"uri": uri})


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.parent.name, marks=[] if place < 3 else pytest.mark.slow)
        for place, path in enumerate(SCRIPTS)
    ],
)
@settings(max_examples=examples(8), deadline=None, derandomize=True)
@given(st.lists(edits(), min_size=1, max_size=6))
def test_random_edits_of_a_session(path: Path, steps: list[Edit]) -> None:
    session = Session([ROOT])
    history = start_of(path)
    for step in steps:
        text, offset = edited(history, step)
        found = answers(session, str(path), text, offset)
        report = check_scripts([path], Disk({str(path): text})).report
        assert sorted(map(identity_of, found)) == sorted(map(identity_of, report))


def identity_of(item: Diagnostic) -> tuple[Any, ...]:
    source = os.path.realpath(item.span.source.name)
    return item.code, item.severity.value, source, item.span.start, item.span.end, item.message

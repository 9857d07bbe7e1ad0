"""The language server over its streams, in a process of its own, as an editor runs it."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.support.lsp_client import Client, ResponseError

pytest.importorskip("pygls")

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(os.path.realpath(tmp_path_factory.mktemp("workspace")))


@pytest.fixture(scope="module")
def server(root: Path) -> Iterator[Client]:
    with Client(root) as running:
        yield running
        assert running.end() == ""


@pytest.fixture
def folder(root: Path, request: pytest.FixtureRequest) -> Path:
    copied: Path = root / request.node.name
    shutil.copytree(EXAMPLES / "08_pick_and_place", copied)
    return copied


@pytest.fixture
def client(server: Client, folder: Path) -> Iterator[Client]:
    """The server, in which a test leaves no document open."""
    yield server
    server.close_all()


def words(items: list[dict[str, Any]]) -> list[str]:
    return [item["label"] for item in items]


def where(found: list[dict[str, Any]]) -> list[tuple[str, int]]:
    """File and line, counted from 1, of locations."""
    return [(Path(item["uri"]).name, item["range"]["start"]["line"] + 1) for item in found]


def applied(text: str, edits: list[dict[str, Any]]) -> str:
    """A text after edits."""
    lines = text.splitlines(keepends=True)

    def offset(position: dict[str, int]) -> int:
        return sum(map(len, lines[: position["line"]])) + position["character"]

    for edit in reversed(edits):
        start, end = offset(edit["range"]["start"]), offset(edit["range"]["end"])
        text = text[:start] + edit["newText"] + text[end:]
    return text


def line_of(text: str, word: str) -> int:
    return text[: text.index(word)].count("\n")


def here(text: str, word: str) -> dict[str, Any]:
    """The range of a word."""
    line = line_of(text, word)
    column = text.split("\n")[line].index(word)
    return {"start": {"line": line, "character": column},
            "end": {"line": line, "character": column + len(word)}}  # fmt: skip


@pytest.mark.slow
def test_findings_as_one_types(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)
    assert client.findings(uri) == []
    client.change(uri, text.replace("LOAD_BLOCK, aborted", "LOAD_BLOK, aborted"))
    (finding,) = client.findings(uri)
    assert (finding["code"], finding["severity"], finding["source"]) == ("SM101", 1, "smachac")
    assert finding["range"]["end"] == {"line": 17, "character": 40}
    assert finding["message"].splitlines()[1:] == [
        "SMACH refuses to run such a container: none of its states runs",
        "did you mean `LOAD_BLOCK`?",
    ]
    client.change(uri, text + "  - : [")
    assert [item["code"] for item in client.findings(uri)] == ["SM001"]
    client.change(uri, text)
    assert client.findings(uri) == []


def test_findings_have_related_places(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8").replace("  - LOAD_MARK:", "  - LOAD_TABLE:")
    uri = client.open(main, text)
    finding = next(item for item in client.findings(uri) if item["code"] == "SM106")
    (related,) = finding["relatedInformation"]
    assert related["location"]["range"]["start"]["line"] == line_of(text, "LOAD_TABLE:")


def test_findings_in_a_sub_script_are_those_of_its_callers(client: Client, folder: Path) -> None:
    sub = folder / "pick_block.yml"
    text = sub.read_text("utf-8")
    uri = client.open(sub)
    assert client.findings(uri) == []  # alone, its params would be unknown
    client.change(uri, text.replace("succeeded: LIFT", "succeeded: LIF"))
    assert "SM101" in [finding["code"] for finding in client.findings(uri)]


def test_a_change_of_a_sub_script_is_seen_in_its_callers(client: Client, folder: Path) -> None:
    main, sub = folder / "main.yml", folder / "pick_block.yml"
    main_uri = client.open(main)
    assert client.findings(main_uri) == []
    version = client.version
    sub_uri = client.open(
        sub,
        sub.read_text("utf-8").replace(
            "outcomes: [succeeded, ab", "outcomes: [done, succeeded, ab"
        ),
    )
    client.findings(sub_uri)
    while not client.diagnostics[main_uri]["diagnostics"]:
        client.note(client.receive())
    assert client.diagnostics[main_uri]["version"] == version


def test_quick_fixes_and_suppressions(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    good = main.read_text("utf-8")
    text = good.replace("LOAD_BLOCK, aborted", "LOAD_BLOK, aborted")
    uri = client.open(main, text)
    client.findings(uri)
    document = {"textDocument": {"uri": uri}}
    found = client.ask("textDocument/codeAction", **document, range=here(text, "LOAD_BLOK"),
                       context={"diagnostics": []})  # fmt: skip
    (fix,) = [item for item in found if item["kind"] == "quickfix"]
    assert (fix["title"], fix["isPreferred"]) == ("Replace `LOAD_BLOK` by `LOAD_BLOCK`", True)
    assert applied(text, fix["edit"]["changes"][uri]) == good
    text = good.replace("  home: [", "  home2: 1\n  home: [", 1)
    client.change(uri, text)
    (finding,) = client.findings(uri)
    found = client.ask("textDocument/codeAction", **document, range=finding["range"],
                       context={"diagnostics": []})  # fmt: skip
    allow = next(item for item in found if item["title"] == f"Allow {finding['code']} here")
    client.change(uri, applied(text, allow["edit"]["changes"][uri]))
    assert client.findings(uri) == []


def test_completion(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)
    found = client.at("completion", uri, text, "succeeded: LOAD_|BLOCK")["items"]
    assert words(found)[0] == "LOAD_BLOCK"
    found = client.at("completion", uri, text, "transitions: {suc|ceeded: LOAD_MARK")["items"]
    assert words(found)[:1] == ["succeeded"]
    found = client.at("completion", uri, text, "remapping: {positions: ho|me")["items"]
    assert {item["label"]: item.get("detail") for item in found}["home"] == "float<rad>[7]"
    found = client.at("completion", uri, text, "template: Load|ModelState")["items"]
    assert "Adds a model" in found[0]["documentation"]
    half = text.replace("transitions: {succeeded: LOAD_BLOCK, aborted: aborted}", "transitions: {")
    client.change(uri, half)
    found = client.at("completion", uri, half, "transitions: {|")["items"]
    assert words(found) == ["succeeded", "aborted"]


def test_hover(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)

    def hover(word: str) -> str:
        value: str = client.at("hover", uri, text, word)["contents"]["value"]
        return value

    assert "key `home` of pick_and_place: float<rad>[7]" in hover("positions: ho|me")
    assert "read  by MOVE_TO_START as `positions`: always set (main.yml:41:19)" in hover("ho|me:")
    assert "claims   arm" in hover("- PICK_BL|OCK")
    assert "Adds a model to the simulated world." in hover("template: Load|Model")
    assert "Where each outcome leads" in hover("trans|itions:")
    assert "outcome `aborted` of MOVE_TO_START" in hover("PICK_BLOCK, abor|ted")
    assert client.at("hover", uri, text, "# Pi|cks") is None


def test_definitions_and_references(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)

    def go(word: str) -> list[tuple[str, int]]:
        return where(client.at("definition", uri, text, word))

    assert go("succeeded: LOAD_B|LOCK") == [("main.yml", line_of(text, "- LOAD_BLOCK") + 1)]
    assert go("script: pick_bl|ock") == [("pick_block.yml", 2)]
    assert [name for name, _ in go("template: Load|Model")] == [
        "LoadModelState.yml", "LoadModelState.tpl.py",
    ]  # fmt: skip
    assert go("succeeded: PLACE_BLOCK, abo|rted: LET_GO") == [("pick_block.yml", 5)]
    assert go("params: {bl|ock") == []
    found = where(client.at("references", uri, text, "- PICK_BL|OCK",
                            context={"includeDeclaration": True}))  # fmt: skip
    assert found == [("main.yml", 44), ("main.yml", 42)]
    found = where(client.at("references", uri, text, "{pick_pose: block|_pose",
                            context={"includeDeclaration": False}))  # fmt: skip
    assert [line for _, line in found] == [25, 47]


def test_rename(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)
    assert client.at("prepareRename", uri, text, "- PICK_BL|OCK") is not None
    assert client.at("prepareRename", uri, text, "scri|pt: pick_block") is None
    edit = client.at("rename", uri, text, "- PICK_BL|OCK", newName="GRASP")
    (change,) = edit["documentChanges"]
    new = applied(text, change["edits"])
    assert new == text.replace("PICK_BLOCK", "GRASP")
    edit = client.at("rename", uri, text, "succeeded: PLACE_BLOCK, abo|rted", newName="lost")
    files = {Path(item["textDocument"]["uri"]).name for item in edit["documentChanges"]}
    assert files == {"main.yml", "pick_block.yml"}
    for new_name, reason in (("GO_HOME", "already has a state"), ("a: b", "needs quotes")):
        with pytest.raises(ResponseError, match=reason):
            client.at("rename", uri, text, "- PICK_BL|OCK", newName=new_name)
    client.change(uri, text.replace("LOAD_BLOCK, aborted", "LOAD_BLOK, aborted"))
    with pytest.raises(ResponseError, match="fix the errors"):
        client.at("rename", uri, text, "- PICK_BL|OCK", newName="GRASP")


def test_refactorings(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)
    document = {"textDocument": {"uri": uri}}

    def action(title: str, at: dict[str, Any]) -> list[dict[str, Any]]:
        found = client.ask("textDocument/codeAction", **document, range=at,
                           context={"diagnostics": []})  # fmt: skip
        one = next(item for item in found if item["title"] == title)
        changes: list[dict[str, Any]] = client.ask("codeAction/resolve", **one)["edit"][
            "documentChanges"
        ]
        return changes

    (change,) = action("Inline the sub-script of PICK_BLOCK", here(text, "PICK_BLOCK:"))
    inlined = applied(text, change["edits"])
    assert "MOVE_DOWN" in inlined
    client.change(uri, inlined)
    assert client.findings(uri) == []
    (folder / "pick_block.yml").unlink()
    found = action("Extract PICK_BLOCK into pick_block.yml", here(inlined, "PICK_BLOCK:"))
    (created,) = [item for item in found if "kind" in item]
    changes = [item for item in found if "kind" not in item]
    assert (created["kind"], Path(created["uri"]).name) == ("create", "pick_block.yml")
    assert {Path(item["textDocument"]["uri"]).name for item in changes} == {
        "main.yml", "pick_block.yml",
    }  # fmt: skip
    shutil.copy(EXAMPLES / "08_pick_and_place" / "pick_block.yml", folder)
    client.change(uri, text)
    span = {"start": here(text, "LOAD_TABLE:")["start"], "end": here(text, "LOAD_BLOCK:")["end"]}
    (change,) = action("Contain LOAD_TABLE, LOAD_BLOCK in a new StateMachine", span)
    client.change(uri, applied(text, change["edits"]))
    assert client.findings(uri) == []


def test_structure(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main)
    document = {"textDocument": {"uri": uri}}
    (root,) = client.ask("textDocument/documentSymbol", **document)
    assert [item["name"] for item in root["children"]][:2] == ["LOAD_TABLE", "LOAD_BLOCK"]
    found = client.ask("workspace/symbol", query="close_gr")
    found = [item for item in found if item["location"]["uri"].startswith(folder.as_uri())]
    assert [(item["name"], item["containerName"]) for item in found] == [
        ("CLOSE_GRIPPER", "PICK_BLOCK")
    ]
    folds = client.ask("textDocument/foldingRange", **document)
    first = line_of(text, "- LOAD_TABLE")
    assert {"startLine": first, "endLine": first + 7} in folds
    lenses = client.ask("textDocument/codeLens", **document)
    assert [lense["command"]["title"] for lense in lenses] == ["Run", "Build", "Draw"]
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}
    hints = client.ask("textDocument/inlayHint", **document, range=whole)
    assert [hint["label"] for hint in hints] == [": float<rad>[7]", ": Pose"]
    picture = client.ask("workspace/executeCommand", command="smachac.picture", arguments=[uri])
    assert picture["dot"].startswith('digraph "pick_and_place"')
    assert picture["places"]["pick_and_place/PICK_BLOCK/LIFT"]["uri"].endswith("pick_block.yml")
    assert all(f'"{name}"' in picture["dot"] or f"cluster_{name}" in picture["dot"]
               for name in picture["places"] if "/" in name)  # fmt: skip


def test_formatting(client: Client, folder: Path) -> None:
    main = folder / "main.yml"
    text = main.read_text("utf-8")
    uri = client.open(main, text.replace("  doc: Pick", "    doc:   Pick").replace(
        "aborted: aborted}", "aborted:   aborted}"))  # fmt: skip
    options = {"tabSize": 2, "insertSpaces": True}
    edits = client.ask("textDocument/formatting", textDocument={"uri": uri}, options=options)
    assert applied(text.replace("aborted: aborted}", "aborted:   aborted}"), edits) == text
    client.change(uri, "states: [")
    assert client.ask("textDocument/formatting", textDocument={"uri": uri}, options=options) is None


def test_tokens_of_code(client: Client) -> None:
    path = EXAMPLES.resolve() / "06_callbacks" / "main.yml"
    text = path.read_text("utf-8")
    uri = client.open(path)
    data = client.ask("textDocument/semanticTokens/full", textDocument={"uri": uri})["data"]
    line, column, size, kind, _ = data[:5]
    assert (line, kind) == (line_of(text, "'lambda ud: ud.tries + 1'"), 0)
    assert text.split("\n")[line][column : column + size] == "lambda"
    assert [data[at] for at in range(3, 35, 5)] == [0, 1, 1, 2, 5, 3, 0]


def test_implicit_transitions_are_shown(client: Client, folder: Path) -> None:
    path = folder / "short.yml"
    text = (
        "name: short\ntemplate: Base\noutcomes: [succeeded]\nstates:\n"
        "- WAIT:\n    template: SleepState\n    time: 1\n"
    )
    uri = client.open(path, text)
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}
    (hint,) = client.ask("textDocument/inlayHint", textDocument={"uri": uri}, range=whole)
    assert (hint["label"], hint["position"]) == (
        " succeeded \u2192 succeeded", {"line": 4, "character": 7},
    )  # fmt: skip


def test_interfaces_are_checked_with_the_scripts_that_use_them(
    client: Client, folder: Path
) -> None:
    (folder / "templates").mkdir()
    interface = folder / "templates" / "Grasp.yml"
    interface.write_text("name: Grasp\noutcomes: {held: {}, lost: {}}\n", "utf-8")
    main = folder / "grasp.yml"
    text = (
        "name: grasp\ntemplate: Base\noutcomes: [held, lost]\nstates:\n- GRASP: {template: Grasp}\n"
    )
    main_uri = client.open(main, text)
    assert [
        finding["code"] for finding in client.findings(main_uri) if finding["severity"] < 2
    ] == []
    uri = client.open(interface)
    assert client.findings(uri) == []
    client.change(uri, "name: Grasp\noutcomes: {held: {}, gone: {}}\nkind: machine\n")
    assert [finding["code"] for finding in client.findings(uri)] == ["SM004"]
    while (
        "SM102" not in str(client.diagnostics[main_uri])
        and not client.diagnostics[main_uri]["diagnostics"]
    ):
        client.note(client.receive())
    assert client.diagnostics[main_uri]["diagnostics"]


def test_positions_in_utf_8_and_without_files(folder: Path) -> None:
    with Client(folder, encodings=["utf-8"]) as client:
        assert client.capabilities["positionEncoding"] == "utf-8"
        uri = client.open(folder / "new.yml", "name: r\u00f6b\nstates: \U0001f916 x: [\n")
        client.findings(uri)
        document = {"textDocument": {"uri": "untitled:Untitled-1"}}
        assert client.ask("textDocument/documentSymbol", **document) is None

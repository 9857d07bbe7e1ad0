"""The language server over pygls: messages of the protocol, converted to questions and answers.

This is the only module that imports pygls. Positions and files of the protocol are converted here;
all answers are computed by the other modules of this package.
"""

# pyright: reportMissingImports=false
from __future__ import annotations

import asyncio
import gc
import logging
import os
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.spelling import is_plain
from smachac.ir.recursion import deep_recursion
from smachac.lsp import actions, symbols
from smachac.lsp.completion import complete
from smachac.lsp.facts import Facts
from smachac.lsp.hints import hints
from smachac.lsp.hover import hover_at
from smachac.lsp.navigation import definitions, named_at, references
from smachac.lsp.picture import picture
from smachac.lsp.place import Place, place_at
from smachac.lsp.positions import Encoding, Positions
from smachac.lsp.session import Session, View, is_python
from smachac.refactor.formatter import format_script
from smachac.version import __version__

LONGEST_DELAY = 0.3
"""The longest time, in seconds, that a check waits for the next key stroke."""

IDLE, MOST_UNCOLLECTED = 0.5, 50
"""The seconds after a check before garbage is collected, which the next one puts off, and the most
checks between two collections: automatic collection is off."""

SEVERITIES = {
    Severity.ERROR: lsp.DiagnosticSeverity.Error,
    Severity.WARNING: lsp.DiagnosticSeverity.Warning,
    Severity.INFO: lsp.DiagnosticSeverity.Information,
}

COMPLETION_KINDS = {
    "field": lsp.CompletionItemKind.Property,
    "state": lsp.CompletionItemKind.Function,
    "outcome": lsp.CompletionItemKind.EnumMember,
    "key": lsp.CompletionItemKind.Variable,
    "type": lsp.CompletionItemKind.TypeParameter,
    "template": lsp.CompletionItemKind.Class,
    "script": lsp.CompletionItemKind.File,
    "param": lsp.CompletionItemKind.Constant,
    "value": lsp.CompletionItemKind.Value,
}

T = TypeVar("T")


class Server(LanguageServer):
    """The server, its session, and the checks that are due."""

    def __init__(self) -> None:
        super().__init__(
            "smachac", __version__, text_document_sync_kind=lsp.TextDocumentSyncKind.Full
        )
        self.session = Session()
        self.encoding: Encoding = "utf-16"
        self.versions: dict[str, int | None] = {}
        self.due: dict[str, None] = {}
        self.timer: asyncio.TimerHandle | None = None
        self.delay = 0.0
        self.collection: asyncio.TimerHandle | None = None
        self.uncollected = 0
        self.published: dict[str, frozenset[str]] = {}
        self.uris: dict[str, str] = {}

    # --- conversions

    def path_of(self, uri: str) -> str | None:
        """The real path of a file; None for other documents."""
        name = to_fs_path(uri) if uri.startswith("file:") else None
        if name is None:
            return None
        path = os.path.realpath(name)
        self.uris[path] = uri
        return path

    def uri_of(self, path: str) -> str:
        """The URI of a file, as the editor wrote it."""
        return self.uris.get(path) or from_fs_path(path) or ""

    def positions(self, source: Source) -> Positions:
        return Positions(source.text, self.encoding)

    def range(self, positions: Positions, start: int, end: int) -> lsp.Range:
        first, last = positions.at(start), positions.at(end)
        return lsp.Range(lsp.Position(*first), lsp.Position(*last))

    def location(self, span: Span) -> lsp.Location:
        path = os.path.realpath(span.source.name)
        where = self.range(self.positions(span.source), span.start, span.end)
        return lsp.Location(uri=self.uri_of(path), range=where)

    def offset(self, view: View, position: lsp.Position) -> int:
        return self.positions(view.source).offset(position.line, position.character)

    # --- checks

    def check_later(self, paths: Iterable[str]) -> None:
        """Check texts soon: after as long as the last check took, so that typing comes first."""
        self.due |= dict.fromkeys(paths)
        if self.timer is not None:
            self.timer.cancel()
        loop = asyncio.get_running_loop()
        self.timer = loop.call_later(min(self.delay, LONGEST_DELAY), self.check_now)

    def check_now(self) -> None:
        """Check the texts that are due and publish the findings."""
        self.timer = None
        started = time.process_time()
        while self.due:
            path = next(iter(self.due))
            del self.due[path]
            if path in self.session.open:
                self.publish(path)
        self.delay = time.process_time() - started
        self.collect_later()

    def collect_later(self) -> None:
        """Collect garbage as soon as nobody types: that takes half as long as a check."""
        if self.collection is not None:
            self.collection.cancel()
        self.uncollected += 1
        wait = IDLE if self.uncollected < MOST_UNCOLLECTED else 0.0
        self.collection = asyncio.get_running_loop().call_later(wait, self.collect)

    def collect(self) -> None:
        self.collection = None
        self.uncollected = 0
        gc.collect()

    def publish(self, path: str) -> None:
        """Publish the findings of the check of a text; files that no longer have any are
        cleared."""
        found = self.session.check(path)
        before = self.published.get(path, frozenset())
        others = {file for other, files in self.published.items() if other != path
                  for file in files}  # fmt: skip
        for file in (*found, *(before - found.keys() - others)):
            if file != path and file in self.session.open:
                continue  # it has a check of its own
            items = [self.diagnostic(diagnostic) for diagnostic in found.get(file, [])]
            self.text_document_publish_diagnostics(
                lsp.PublishDiagnosticsParams(
                    uri=self.uri_of(file), diagnostics=items, version=self.versions.get(file)
                )
            )
        self.published[path] = frozenset(file for file, items in found.items() if items)

    def diagnostic(self, item: Diagnostic) -> lsp.Diagnostic:
        span = item.span
        texts = filter(None, (item.message, item.effect, item.help))
        related = [(related.span, related.message) for related in item.related]
        related += [(at, f"on the path: {step.label}")
                    for step, at in zip(item.finding.path, item.steps, strict=False)
                    if at is not None]  # fmt: skip
        return lsp.Diagnostic(
            range=self.range(self.positions(span.source), span.start, span.end),
            severity=SEVERITIES[item.severity],
            code=item.code,
            source="smachac",
            message="\n".join(texts),
            related_information=[
                lsp.DiagnosticRelatedInformation(location=self.location(at), message=message)
                for at, message in related
            ],
        )

    # --- questions

    def ask(self, uri: str, answer: Callable[[View, str], T]) -> T | None:
        """An answer about a text as far as it can be read; None without one."""
        path = self.path_of(uri)
        if path is None:
            return None
        with deep_recursion():
            view = self.session.view(path)
            return answer(view, path) if view is not None else None

    def place(self, view: View, position: lsp.Position) -> Place | None:
        return place_at(view.tree, self.offset(view, position))

    def facts(self, view: View, path: str) -> Facts:
        known = view.machine.state_types if view.machine is not None else {}
        return Facts(view.library, path, known)

    def workspace_edit(self, results: actions.Results) -> lsp.WorkspaceEdit:
        """New texts as an edit of the changed lines; new files are created."""
        found: list[Any] = []
        for path, (before, text) in results.items():
            uri = self.uri_of(path)
            if not os.path.lexists(path) and not before.text:
                found.append(lsp.CreateFile(uri=uri))
            at = self.positions(before)
            edits = [lsp.TextEdit(range=self.range(at, start, end), new_text=new)
                     for start, end, new in actions.changes(before.text, text)]  # fmt: skip
            document = lsp.OptionalVersionedTextDocumentIdentifier(
                uri=uri, version=self.versions.get(path)
            )
            found.append(lsp.TextDocumentEdit(text_document=document, edits=edits))
        return lsp.WorkspaceEdit(document_changes=found)


def make_server() -> Server:
    """The server with all its features."""
    logging.getLogger("pygls.protocol.json_rpc").addFilter(_is_fault)
    server = Server()
    _documents(server)
    parts = (_words, _places, _structure, _additions, _lenses, _pictures, _changes, _code_actions)
    for features in parts:
        features(server)
    return server


def _documents(server: Server) -> None:
    """The life of the session and of its texts."""

    @server.feature(lsp.INITIALIZE)
    def initialize(params: lsp.InitializeParams) -> None:
        folders = [folder.uri for folder in params.workspace_folders or ()]
        folders = folders or ([params.root_uri] if params.root_uri else [])
        named = [name for folder in folders if (name := to_fs_path(folder)) is not None]
        server.session = Session([Path(name) for name in named])

    @server.feature(lsp.INITIALIZED)
    def initialized(params: lsp.InitializedParams) -> None:
        chosen = server.server_capabilities.position_encoding
        if chosen is not None:
            server.encoding = lsp.PositionEncodingKind(chosen).value

    def changed(uri: str, text: str, version: int | None) -> None:
        path = server.path_of(uri)
        if path is None:
            return
        server.versions[path] = version
        server.session.change(path, text)
        server.check_later([path, *server.session.users(path)])

    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: lsp.DidOpenTextDocumentParams) -> None:
        document = params.text_document
        changed(document.uri, document.text, document.version)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def edited(params: lsp.DidChangeTextDocumentParams) -> None:
        for change in params.content_changes[-1:]:
            changed(params.text_document.uri, change.text, params.text_document.version)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: lsp.DidCloseTextDocumentParams) -> None:
        path = server.path_of(params.text_document.uri)
        if path is None:
            return
        users = server.session.users(path)
        server.session.close(path)
        server.versions.pop(path, None)
        server.due.pop(path, None)
        for file in {path, *server.published.pop(path, ())} - {*server.session.open}:
            server.text_document_publish_diagnostics(
                lsp.PublishDiagnosticsParams(uri=server.uri_of(file), diagnostics=[])
            )
        server.check_later(users)

    @server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(params: lsp.DidSaveTextDocumentParams) -> None:
        server.check_later(server.session.refresh())

    @server.feature(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def files_changed(params: lsp.DidChangeWatchedFilesParams) -> None:
        server.session.forget_all()
        server.check_later(server.session.open)


def _words(server: Server) -> None:
    """Answers about the word at a position."""

    @server.feature(
        lsp.TEXT_DOCUMENT_COMPLETION,
        lsp.CompletionOptions(trigger_characters=[" ", "{", "[", ",", ":"]),
    )
    def completion(params: lsp.CompletionParams) -> lsp.CompletionList | None:
        def answer(view: View, path: str) -> lsp.CompletionList:
            text = server.session.text(path)
            positions = Positions(text, server.encoding)
            offset = positions.offset(params.position.line, params.position.character)
            found = complete(text, offset, path, view)
            items = [
                lsp.CompletionItem(
                    label=completion.word,
                    kind=COMPLETION_KINDS[completion.kind],
                    detail=completion.detail or None,
                    documentation=completion.doc or None,
                    sort_text=f"{number:05}",
                    insert_text=completion.text or completion.word,
                )
                for number, completion in enumerate(found)
            ]
            return lsp.CompletionList(is_incomplete=False, items=items)

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.TEXT_DOCUMENT_HOVER)
    def hovered(params: lsp.HoverParams) -> lsp.Hover | None:
        def answer(view: View, path: str) -> lsp.Hover | None:
            offset = server.offset(view, params.position)
            found = hover_at(view, path, offset, server.facts(view, path))
            if found is None:
                return None
            text, start, end = found
            at = server.range(server.positions(view.source), start, end)
            content = lsp.MarkupContent(kind=lsp.MarkupKind.Markdown, value=text)
            return lsp.Hover(contents=content, range=at)

        return server.ask(params.text_document.uri, answer)


def _places(server: Server) -> None:
    """Answers that are places of the texts."""

    @server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def definition(params: lsp.DefinitionParams) -> list[lsp.Location] | None:
        def answer(view: View, path: str) -> list[lsp.Location]:
            if view.python is not None:
                from smachac.lsp import python_view

                spans = python_view.definitions(view.python, server.offset(view, params.position))
                return [server.location(span) for span in spans]
            place = server.place(view, params.position)
            found = definitions(place, server.facts(view, path)) if place is not None else []
            return [server.location(span) for span in found]

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    def all_references(params: lsp.ReferenceParams) -> list[lsp.Location] | None:
        def answer(view: View, path: str) -> list[lsp.Location]:
            place = server.place(view, params.position)
            named = named_at(place, server.facts(view, path)) if place is not None else None
            if named is None:
                return []
            spans = references(named, server.session.machines(path))
            if not params.context.include_declaration:
                spans = [span for span in spans if span not in named.places]
            return [server.location(span) for span in spans]

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlights(params: lsp.DocumentHighlightParams) -> list[lsp.DocumentHighlight] | None:
        def answer(view: View, path: str) -> list[lsp.DocumentHighlight]:
            place = server.place(view, params.position)
            named = named_at(place, server.facts(view, path)) if place is not None else None
            spans = references(named, server.session.machines(path)) if named is not None else []
            at = server.positions(view.source)
            return [lsp.DocumentHighlight(range=server.range(at, span.start, span.end))
                    for span in spans if os.path.realpath(span.source.name) == path]  # fmt: skip

        return server.ask(params.text_document.uri, answer)


def _structure(server: Server) -> None:
    """Answers about a whole text, or about all."""

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def document_symbols(params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol] | None:
        def answer(view: View, path: str) -> list[lsp.DocumentSymbol]:
            at = server.positions(view.source)

            def convert(each: symbols.Symbol) -> lsp.DocumentSymbol:
                return lsp.DocumentSymbol(
                    name=each.name,
                    detail=each.detail,
                    kind=_symbol_kind(each),
                    range=server.range(at, each.start, each.end),
                    selection_range=server.range(at, each.name_start, each.name_end),
                    children=[convert(inner) for inner in each.children],
                )

            return [convert(symbol) for symbol in symbols_of(view)]

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.WORKSPACE_SYMBOL)
    def workspace_symbols(params: lsp.WorkspaceSymbolParams) -> list[lsp.WorkspaceSymbol]:
        found: list[lsp.WorkspaceSymbol] = []
        with deep_recursion():
            for source, tree in server.session.texts():
                at = server.positions(source)
                for symbol, above in symbols.all_symbols(symbols.symbols(tree)):
                    if params.query.lower() in symbol.name.lower():
                        uri = server.uri_of(os.path.realpath(source.name))
                        where = server.range(at, symbol.name_start, symbol.name_end)
                        found.append(lsp.WorkspaceSymbol(
                            name=symbol.name, kind=_symbol_kind(symbol), container_name=above,
                            location=lsp.Location(uri=uri, range=where)))  # fmt: skip
        return found

    @server.feature(lsp.TEXT_DOCUMENT_FOLDING_RANGE)
    def folding(params: lsp.FoldingRangeParams) -> list[lsp.FoldingRange] | None:
        def answer(view: View, path: str) -> list[lsp.FoldingRange]:
            at = server.positions(view.source)
            lines = [(at.at(start)[0], at.at(end)[0]) for start, end in symbols.folds(view.tree)]
            return [lsp.FoldingRange(start_line=first, end_line=last)
                    for first, last in dict.fromkeys(lines) if last > first]  # fmt: skip

        return server.ask(params.text_document.uri, answer)


def _additions(server: Server) -> None:
    """What editors show in addition to a text: colours and hints."""

    legend = lsp.SemanticTokensLegend(token_types=list(symbols.TOKEN_KINDS), token_modifiers=[])

    @server.feature(lsp.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend)
    def semantic_tokens(params: lsp.SemanticTokensParams) -> lsp.SemanticTokens | None:
        def answer(view: View, path: str) -> lsp.SemanticTokens:
            at = server.positions(view.source)
            data: list[int] = []
            line = column = 0
            for start, size, kind in symbols.tokens(view.tree):
                (here, first), (_, last) = at.at(start), at.at(start + size)
                data += [here - line, first - column if here == line else first,
                         last - first, kind, 0]  # fmt: skip
                line, column = here, first
            return lsp.SemanticTokens(data=data)

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.TEXT_DOCUMENT_INLAY_HINT)
    def inlay_hints(params: lsp.InlayHintParams) -> list[lsp.InlayHint] | None:
        def answer(view: View, path: str) -> list[lsp.InlayHint]:
            at = server.positions(view.source)
            first, last = params.range.start.line, params.range.end.line
            kinds = {True: lsp.InlayHintKind.Type, False: None}
            found = [(at.at(hint.offset), hint) for hint in hints(view, path)]
            return [lsp.InlayHint(position=lsp.Position(*where), label=hint.text,
                                  kind=kinds[hint.is_type])
                    for where, hint in found if first <= where[0] <= last]  # fmt: skip

        return server.ask(params.text_document.uri, answer)


def _lenses(server: Server) -> None:
    """The commands above the first line of a text."""

    @server.feature(lsp.TEXT_DOCUMENT_CODE_LENS)
    def lenses(params: lsp.CodeLensParams) -> list[lsp.CodeLens] | None:
        def answer(view: View, path: str) -> list[lsp.CodeLens]:
            names = [("Run", "smachac.run"), ("Build", "smachac.build"), ("Draw", "smachac.draw")]
            if view.python is not None and view.python.graphs:
                names = names[2:]  # no program is generated from a Python file
            elif not symbols.is_script(view.tree):
                return []
            span = symbols.first_line(view.source)
            at = server.range(server.positions(view.source), span.start, span.end)
            uri = params.text_document.uri
            return [
                lsp.CodeLens(range=at, command=lsp.Command(title=title, command=name,
                                                           arguments=[uri]))
                for title, name in names
            ]  # fmt: skip

        return server.ask(params.text_document.uri, answer)


def _pictures(server: Server) -> None:
    """The picture of a machine beside its text."""

    @server.command("smachac.picture")
    def drawn(uri: str, *more: Any) -> dict[str, Any] | None:
        """The picture of a script as DOT, and the places of its states by node. Of a Python file
        it is that of the machine at a line, counted from 0: `more` begins with its number."""
        line = next((number + 1 for number in more[:1] if isinstance(number, int)), None)

        def answer(view: View, path: str) -> dict[str, Any] | None:
            found = picture(view, line)
            if found is None:
                return None
            text, places = found
            shown = {name: server.location(span) for name, span in places.items()}
            return {
                "dot": text,
                "places": {
                    name: {"uri": at.uri, "line": at.range.start.line,
                           "character": at.range.start.character}
                    for name, at in shown.items()
                },
            }  # fmt: skip

        return server.ask(uri, answer)


def symbols_of(view: View) -> list[symbols.Symbol]:
    """The symbols of a text."""
    if view.python is None:
        return symbols.symbols(view.tree)
    from smachac.lsp import python_view

    return python_view.symbols(view.python)


def _symbol_kind(symbol: symbols.Symbol) -> lsp.SymbolKind:
    return lsp.SymbolKind.Class if symbol.is_container else lsp.SymbolKind.Function


def _changes(server: Server) -> None:
    """Answers that change texts."""

    @server.feature(lsp.TEXT_DOCUMENT_FORMATTING)
    def formatting(params: lsp.DocumentFormattingParams) -> list[lsp.TextEdit] | None:
        path = server.path_of(params.text_document.uri)
        source = server.session.source(path) if path is not None else None
        if path is None or source is None or is_python(path):
            return None
        if server.session.disk.parse(source, []) is None:
            return None
        if server.session.kind(path) not in ("script", "interface"):
            return None
        new = format_script(source)
        at = server.positions(source)
        found = actions.changes(source.text, new or source.text)
        return [lsp.TextEdit(range=server.range(at, start, end), new_text=text)
                for start, end, text in found]  # fmt: skip

    @server.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare_rename(params: lsp.PrepareRenameParams) -> lsp.Range | None:
        def answer(view: View, path: str) -> lsp.Range | None:
            place = server.place(view, params.position)
            if place is None or named_at(place, server.facts(view, path)) is None:
                return None
            return server.range(server.positions(view.source), place.word.start, place.word.end)

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    def renamed(params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        def answer(view: View, path: str) -> lsp.WorkspaceEdit:
            place = server.place(view, params.position)
            named = named_at(place, server.facts(view, path)) if place is not None else None
            roots = server.session.script_roots(path)
            if named is None or view.machine is None or not roots:
                raise refused("there is no state, outcome or key here")
            if not is_plain(params.new_name):
                raise refused(f"`{params.new_name}` needs quotes in YAML: choose another name")
            try:
                results = actions.rename(named, params.new_name, view.machine, path, roots[0],
                                         server.session.disk.texts)  # fmt: skip
            except actions.RefusedActionError as error:
                raise refused(str(error)) from error
            return server.workspace_edit(results)

        return server.ask(params.text_document.uri, answer)


def _code_actions(server: Server) -> None:
    """Fixes and refactorings."""

    @server.feature(
        lsp.TEXT_DOCUMENT_CODE_ACTION,
        lsp.CodeActionOptions(
            code_action_kinds=[
                lsp.CodeActionKind.QuickFix,
                lsp.CodeActionKind.RefactorExtract,
                lsp.CodeActionKind.RefactorInline,
            ],
            resolve_provider=True,
        ),
    )
    def code_actions(params: lsp.CodeActionParams) -> list[lsp.CodeAction] | None:
        def answer(view: View, path: str) -> list[lsp.CodeAction]:
            start = server.offset(view, params.range.start)
            end = server.offset(view, params.range.end)
            report = server.session.check(path).get(path, [])
            session = server.session
            fixes = actions.fixes(report, start, end, path, lambda item: session.repair(path, item))
            found = [_fix_action(server, fix) for fix in fixes]
            roots = server.session.script_roots(path)
            if view.machine is not None and roots:
                place = place_at(view.tree, start)
                chosen = actions.selected_states(place, start, max(end, start + 1))
                for offer in actions.offers(place, chosen, view.machine, path):
                    kind = (lsp.CodeActionKind.RefactorInline if offer.kind == "inline"
                            else lsp.CodeActionKind.RefactorExtract)  # fmt: skip
                    data = {"kind": offer.kind, "name": offer.name, "states": [*offer.states],
                            "root": roots[0]}  # fmt: skip
                    found.append(lsp.CodeAction(title=offer.title, kind=kind, data=data))
            return found

        return server.ask(params.text_document.uri, answer)

    @server.feature(lsp.CODE_ACTION_RESOLVE)
    def resolve(action: lsp.CodeAction) -> lsp.CodeAction:
        data = action.data
        if isinstance(data, dict):
            try:
                results = actions.perform_offer(
                    data["kind"], data["name"], data["states"], data["root"],
                    server.session.disk.texts,
                )  # fmt: skip
                action.edit = server.workspace_edit(results)
            except actions.RefusedActionError as error:
                raise refused(str(error)) from error
        return action


class RefusedRequestError(JsonRpcException):
    """A request that the protocol allows to fail: the editor shows the message."""

    CODE = lsp.LSPErrorCodes.RequestFailed.value
    MESSAGE = "Request failed"


def _is_fault(record: logging.LogRecord) -> bool:
    """Whether a record of pygls is about a fault: a refused request is none."""
    return record.exc_info is None or not isinstance(record.exc_info[1], RefusedRequestError)


def refused(message: str) -> RefusedRequestError:
    return RefusedRequestError(message=message)


def _fix_action(server: Server, fix: actions.Fix) -> lsp.CodeAction:
    """A correction as a code action with its edit."""
    by_file: dict[str, list[lsp.TextEdit]] = {}
    for edit in fix.edits:
        at = server.positions(edit.span.source)
        where = server.range(at, edit.span.start, edit.span.end)
        uri = server.uri_of(os.path.realpath(edit.span.source.name))
        by_file.setdefault(uri, []).append(lsp.TextEdit(range=where, new_text=edit.text))
    return lsp.CodeAction(
        title=fix.title,
        kind=lsp.CodeActionKind.QuickFix,
        diagnostics=[server.diagnostic(fix.finding)],
        is_preferred=fix.preferred or None,
        edit=lsp.WorkspaceEdit(changes=by_file),
    )

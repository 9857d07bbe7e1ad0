"""The parts of a generated module that the templates of its states contribute, by block."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    Related,
    Report,
    Severity,
    identity,
)
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.spelling import guesser
from smachac.frontend.errors.references import template_error
from smachac.ir.nodes import Leaf, Node, StateType
from smachac.pysource.modules.ros_names import Ros
from smachac.records import dataclass, field, replace
from smachac.targets import BuildContext
from smachac.targets.errors import defined_twice, python_2_code
from smachac.targets.python import structure
from smachac.targets.python.additions import Additions
from smachac.targets.python.functions import Plan
from smachac.targets.python.imports import ProgramNames
from smachac.targets.python.python2 import modern, parsed
from smachac.targets.python.ros import RosType, other_modules, other_version
from smachac.targets.python.smacha_context import Headers
from smachac.targets.templates.engine import BlockError, Blocks, Page

APPENDED = ("base_header", "imports", "defs", "class_defs", "cb_defs", "main_def")
"""Blocks that are printed in the order of the states."""

PREPENDED = ("footer", "execute", "base_footer", "main")
"""Blocks that are printed in reverse order: what is opened last is closed first."""

KEYED = ("header", "header_userdata")
"""Blocks that belong to the container of the state and precede its states."""

Buffers = dict[str, dict[str, None]]
"""Texts by block, without duplicates, in the order of the states."""


def buffers() -> Buffers:
    return {name: {} for name in (*APPENDED, *PREPENDED)}


@dataclass(frozen=True, slots=True, kw_only=True)
class UsedType:
    """A state type in this module: its class and the template that defines it.

    `whole`: the template has a block `body`, as SMACHA's have, so that it is rendered for each
    state; other templates are rendered once. `takes_node`: the first argument of the class is the
    node of ROS 2.
    """

    type: StateType
    class_name: str
    template: str = ""
    whole: bool = False
    takes_node: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedFunction:
    """A function of the module that builds a container."""

    name: str
    text: str = ""


_ARGUMENT = r",\s*{0}\b(?=\s*[,)])|(?<=[(,])\s*{0}\b\s*,\s*"
"""A name as an argument of a call, with the comma before or after it."""


def _key_help(found: Finding, type_: StateType) -> str | None:
    """The help for an undefined name in a template that is a userdata key of its state type."""
    kind, *names = found.arguments
    if kind != "undefined":
        return None
    lists = {"input": type_.input_keys, "output": type_.output_keys}
    what = [part for part, keys in lists.items() if names[0] in [key.name for key in keys]]
    if not what:
        return None
    text, at = found.span.source.text, found.span.start
    begin, end = text.rfind("{{", 0, at), text.find("}}", at)
    call = text[begin : end + 2] if begin >= 0 <= end else ""
    changed = re.sub(_ARGUMENT.format(re.escape(names[0])), "", call)
    sets = "reads it from the userdata" if what[0] == "input" else "sets it in the userdata"
    why = f"`{names[0]}` is an {what[0]} key, and the class {sets}"
    is_line = changed != call and "\n" not in call
    return f"write `{changed}`: {why}" if is_line else f"remove `{names[0]}` here: {why}"


@dataclass(slots=True)
class ModuleParts:
    """The contributions of the states to a module, by block, and the state of its generation.

    `classes` are the classes of the user that it imports, `module:Class`, with their names in it.
    `plan` holds the containers that functions build, and `functions` those functions, by their key.
    `additions` are the functions and classes of runtime/additions.py (`added`) that it uses, of
    which it contains the text if it is `standalone`. `own_templates` are the files of the
    user's templates for containers, by type. `names` are those in the printed code. `faults` are
    the findings about templates, without duplicates. `ros` is the version of ROS; `node`: the
    functions of the module have the node of ROS 2 as a parameter. `action`: the type of the action
    that it offers the machine as.
    """

    blocks: Blocks
    context: BuildContext
    state_types: Mapping[str, StateType]
    ros: Ros = 1
    node: bool = False
    action: RosType | None = None
    plan: Plan = field(default_factory=dict)
    standalone: bool = False
    added: Additions = field(default_factory=Additions)
    additions: dict[str, None] = field(default_factory=dict)
    fresh: Callable[[str, str], str] = field(default_factory=structure.variable_names)
    buffers: Buffers = field(default_factory=buffers)
    used: dict[str, UsedType] = field(default_factory=dict)
    classes: dict[str, str] = field(default_factory=dict)
    defined_headers: Headers = field(default_factory=Headers)
    functions: dict[str, PrintedFunction] = field(default_factory=dict)
    own_templates: dict[str, str | None] = field(default_factory=dict)
    names: ProgramNames = field(default_factory=ProgramNames)
    faults: Report = field(default_factory=list)
    without_code: dict[str, Span] = field(default_factory=dict)
    defined: dict[str, tuple[str, Node]] = field(default_factory=dict)

    def fault(self, error: BlockError, node: Node) -> None:
        """Add an error, related to the first state that it was found for."""
        found = error.diagnostic
        type_ = self.state_types.get(node.type) if isinstance(node, Leaf) else None
        help = _key_help(found.finding, type_) if type_ is not None else None
        if help is not None:
            found = replace(found, finding=replace(found.finding, help=help))
        if found.span.source is not node.span.source:
            place = Related(span=node.span, message=f"`{node.name}` uses the template")
            finding = replace(found.finding, related=(*found.finding.related, place))
            found = Diagnostic(kind=found.kind, severity=found.severity, finding=finding)
        self.note(found)

    def note(self, found: Diagnostic) -> None:
        if identity(found) not in map(identity, self.faults):
            self.faults.append(found)

    def gather(self, page: Page, node: Node) -> None:
        """Add the blocks of a template to the buffers, after those of the templates it includes."""
        for inner in page.inner:
            self.gather(inner, node)
        self._unused_blocks(page, node)
        for name in (*APPENDED, *PREPENDED):
            if name not in page.own:
                continue
            text = self.code(page, name, node, alone=True)
            buffer = self.buffers[name]
            if text.strip() and text not in buffer:  # templates share definitions by `extends`
                buffer[text] = None
                if name in ("defs", "class_defs", "cb_defs"):
                    self.define(text, page, name, node)

    def _unused_blocks(self, page: Page, node: Node) -> None:
        """Report the misspelt blocks of a template of the user, whose text no program contains."""
        own = self.context.library.own_template(page.file)
        if own is None:
            return
        spans = {name: self.blocks.block_span(page.file, name) for name in page.own}
        known = (*APPENDED, *PREPENDED, *KEYED, "body")
        here = {name for name, span in spans.items() if span is not None and span.source == own}
        guess = guesser(name for name in known if name not in here)
        for name in sorted(page.own.difference(known)):
            near = guess.unique_match(name)
            span = spans[name]
            if near is not None and span is not None:
                place = Span(span.source, span.end - len(name), span.end)
                found = template_error(
                    place,
                    f"the block `{name}` is not one of those that a program contains",
                    f"did you mean `{near}`?",
                    (page.file, name),
                )
                finding = replace(found.finding, effect="its text is not in the program")
                found = replace(found, severity=Severity.WARNING, finding=finding)
                self.fault(BlockError(found), node)

    def define(self, text: str, page: Page, block: str, node: Node) -> None:
        """Report a class or function with two different definitions: only the last one counts."""
        tree = parsed(text)
        for inner in tree.body if isinstance(tree, ast.Module) else ():
            if isinstance(inner, ast.ClassDef | ast.FunctionDef):
                new = ast.dump(inner)
                old, first = self.defined.setdefault(inner.name, (new, node))
                if old != new:
                    what = "class" if isinstance(inner, ast.ClassDef) else "function"
                    line = text.splitlines()[inner.lineno - 1]
                    span = self._place(page, block, line) or node.span
                    states = ((first.name, first.span), (node.name, node.span))
                    self.note(defined_twice(span, what, inner.name, states))

    def code(self, page: Page, block: str, node: Node, *, alone: bool = False) -> str:
        """A block of Python as Python 3; `alone`: without the blocks of included templates."""
        rendered = page.render(block, alone=alone)
        if not rendered:
            return rendered
        text, changes, tree = modern(rendered)
        for old, new in changes:
            span = self._place(page, block, old) or node.span
            self.note(python_2_code(span, old.strip(), new.strip()))
        if isinstance(tree, ast.Module):
            self.names.add(tree)
            self._other_version(tree, text, page, block, node)
        else:
            words = getattr(tree, "msg", None) or str(tree) or "it is nested too deeply"
            number = getattr(tree, "lineno", None) or 1
            lines = text.splitlines() or [""]
            line = lines[min(number, len(lines)) - 1]
            unquoted = self._unquoted(page, text, line)
            if unquoted is not None:
                self.fault(BlockError(unquoted), node)
                return text
            span = self._place(page, block, line) or node.span
            help = printed_line_help(words, line.strip())
            written = self._written(page, line)
            if written is not None:
                span = Span(written.source, *written.span)
            column = (getattr(tree, "offset", None) or 1) - 1
            tag = written.at(column) if written is not None else None
            if (
                written is not None
                and tag is not None
                and not isinstance(modern(tag.printed)[2], ast.Module)
            ):
                span = Span(written.source, tag.start, tag.end)
                help = f"correct the value of `{span.text}`, which is printed as `{tag.printed}`"
            message = f"the block `{block}` does not print valid Python: {words}"
            self.fault(BlockError(template_error(span, message, help, (block, line.strip()))), node)
        return text

    def _written(self, page: Page, line: str) -> _WrittenLine | None:
        """The line of a template of the page that has most probably printed a line."""
        found = [other for one in walk_pages(page)
                 if (source := self.blocks.source(one.file)) is not None
                 for other in _written_lines(source, line) if other.literal]  # fmt: skip
        return max(found, key=lambda line: line.literal, default=None)

    def _unquoted(self, page: Page, text: str, line: str) -> Diagnostic | None:
        """SM605 for a look-up `{{ x }}` of a template without quotes, if the printed text is Python
        with them. `line` is the first line of `text` that is no Python."""
        for other in walk_pages(page):
            source = self.blocks.source(other.file)
            if source is None:
                continue
            tags = [tag for written in _written_lines(source, line) for tag in written.tags]
            for tag in tags:
                rest = line[tag.column + len(tag.printed) :]
                quoted = f"{line[: tag.column]}{tag.printed!r}{rest}"
                if not isinstance(modern(text.replace(line, quoted, 1))[2], ast.Module):
                    continue
                span = Span(source, tag.start, tag.end)
                message = f"the template prints `{tag.printed}` without quotes, which is not valid"
                help = f"write `'{span.text}'`"
                return template_error(span, f"{message} Python", help, (span.text,))
        return None

    def _other_version(
        self, tree: ast.Module, text: str, page: Page, block: str, node: Node
    ) -> None:
        """Report code of a template of the user for the other version of ROS."""
        if self.context.library.own_template(page.file) is None:
            return
        for line, name in other_modules(tree, self.ros):
            span = self._place(page, block, text.splitlines()[line - 1]) or node.span
            self.note(other_version(span, name, self.ros))

    def _place(self, page: Page, block: str, line: str) -> Span | None:
        """The place of a printed line in a template; if it is not found, the place of the block."""
        for other in walk_pages(page):
            found = self.blocks.line_span(other.file, line)
            if found is not None:
                return found
        return self.blocks.block_span(page.file, block)


_TAG = re.compile(r"\{\{.*?\}\}|\{%.*")


class _Tag(NamedTuple):
    """A look-up of a template at its place, with the text that it has printed, and its column."""

    start: int
    end: int
    printed: str
    column: int


class _WrittenLine(NamedTuple):
    """A line of a template that can have printed a line of Python, with its look-ups, and how many
    characters are no look-ups."""

    source: Source
    span: tuple[int, int]
    tags: tuple[_Tag, ...]
    literal: int

    def at(self, column: int) -> _Tag | None:
        """The look-up that has printed the text at a column."""
        return next((tag for tag in self.tags
                     if tag.column <= column < tag.column + len(tag.printed)), None)  # fmt: skip


def _written_lines(source: Source, line: str) -> Iterator[_WrittenLine]:
    """The lines of a template that can have printed a line."""
    printed, start = line.strip(), 0
    indent = len(line) - len(line.lstrip())
    for written in source.text.splitlines(keepends=True):
        pattern, tags = "", []
        first = at = len(written) - len(written.lstrip())
        for tag in _TAG.finditer(written):
            pattern += re.escape(written[at : tag.start()])
            at = tag.end()
            pattern += ".*" if tag[0].startswith("{%") else "(.*?)"
            tags += [] if tag[0].startswith("{%") else [tag]
        found = re.fullmatch(pattern + re.escape(written[at:].rstrip()), printed) if tags else None
        if found is not None:
            places = [_Tag(start + tag.start(), start + tag.end(), found[number],
                           indent + found.start(number))
                      for number, tag in enumerate(tags, 1)]  # fmt: skip
            literal = len(printed) - sum(len(tag.printed) for tag in places)
            span = (start + first, start + len(written.rstrip()))
            yield _WrittenLine(source, span, tuple(places), literal)
        start += len(written)


def printed_line_help(words: str, line: str) -> str:
    """The help for a printed line that is no Python, by the message of Python."""
    if words == "expected ':'" and ":" not in line:
        return f"write `{line}:`"
    if words.endswith("was never closed"):
        closing = {"'('": ")", "'['": "]", "'{'": "}"}.get(words.split(" ")[0], "")
        return f"close the bracket with `{closing}`; the printed line is `{line}`"
    if words.startswith("unterminated"):
        return f"write the quotation mark at the end of the text; the printed line is `{line}`"
    return f"correct the printed line `{line}`"


def walk_pages(page: Page) -> Iterator[Page]:
    """A template and those that it includes."""
    yield page
    for inner in page.inner:
        yield from walk_pages(inner)

"""The template engine: it renders the blocks of Jinja templates one by one, as SMACHA does.

The target decides where the text of a block goes. Templates run in a sandbox with a budget; they
may extend and include one another.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.spelling import guesser
from smachac.frontend.errors.references import template_error
from smachac.pysource.modules.jinja_tags import tags

if TYPE_CHECKING:
    from jinja2 import Template, nodes
    from jinja2.runtime import Context as JinjaContext

Find = Callable[[str], Source | None]
Names = Callable[[], Mapping[str, object]]
IsOwn = Callable[[str], bool]

SKIPPED = ("meta", "upper_comments", "lower_comments", "introspection_server", "spin")
"""Blocks that are printed only on request."""


class BlockError(Exception):
    """A template cannot be parsed or rendered; `diagnostic` has the place and the reason."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.finding.message)
        self.diagnostic = diagnostic


class Blocks:
    """The templates of one build, by file name. `shown` are those of SKIPPED to be printed;
    `is_own`: whether a template is the user's, in which errors are reported."""

    def __init__(
        self,
        find: Find,
        *,
        filters: Mapping[str, Callable[..., Any]] | None = None,
        tests: Mapping[str, Callable[..., Any]] | None = None,
        shown: frozenset[str] = frozenset(),
        is_own: IsOwn = bool,
    ) -> None:
        from jinja2.loaders import FunctionLoader

        from smachac.targets.templates.sandbox import BoundedEnvironment

        self._sources: dict[str, Source | None] = {}
        self._find = find
        self._is_own = is_own
        self._chains: dict[str, list[Template]] = {}
        self._names: dict[str, frozenset[str]] = {}
        self._page: Page | None = None
        self._skipped = frozenset(SKIPPED) - shown
        self._environment = BoundedEnvironment(
            self._include,
            loader=FunctionLoader(self._load),
            extensions=["jinja2.ext.do"],
            lstrip_blocks=True,
            keep_trailing_newline=True,
            autoescape=False,  # the output is code, not HTML
            cache_size=-1,
        )
        self._environment.add_filters(filters or {})
        self._environment.add_tests(tests or {})

    def source(self, file: str) -> Source | None:
        """The text of a template, read once. If there is no `X.tpl`, `X.tpl.py` is used, and the
        reverse."""
        if file not in self._sources:
            other = file.removesuffix(".py") if file.endswith(".tpl.py") else f"{file}.py"
            found = self._find(file)
            if found is None and other.endswith((".tpl", ".tpl.py")):
                found = self._find(other)
            self._sources[file] = found
        return self._sources[file]

    def check_syntax(self, file: str) -> None:
        """Raises BlockError if a template cannot be parsed."""
        with self._converting(file):
            self._environment.get_template(file)

    def names(self, file: str) -> frozenset[str]:
        """The names of the blocks of a template, and of those that it extends or includes."""
        with self._converting(file):
            return self._all_names(file, frozenset())

    def page(self, file: str, variables: Mapping[str, object]) -> Page:
        """A template with the variables of one state, ready to render its blocks. Raises
        BlockError."""
        with self._converting(file):
            self._environment.meter.begin([*variables.values()])
            return Page(self, file, variables)

    def render(self, file: str, block: str, variables: Mapping[str, object]) -> str:
        """One block of a template, without the line ends around it. Raises BlockError."""
        return self.page(file, variables).render(block)

    def render_whole(self, file: str, variables: Mapping[str, object]) -> str:
        """A whole template, without the space around it. Raises BlockError."""
        with self._converting(file):
            self._environment.meter.begin([*variables.values()])
            template = self._chain(file)[0]
            context = template.new_context(dict(variables))
            for name in self._skipped & self._all_names(file, frozenset()):
                context.blocks[name] = [_nothing]
            return "".join(template.root_render_func(context)).strip()

    def block_span(self, file: str, block: str) -> Span | None:
        """The place where a block begins, in the template or in one that it extends."""
        opening = re.compile(rf"\{{%[-+]?\s*block\s+{re.escape(block)}\b")
        for template in self._chain(file):
            source = self.source(str(template.name))
            found = opening.search(source.text) if source is not None else None
            if source is not None and found is not None:
                return Span(source, *found.span())
        return None

    def line_span(self, file: str, line: str) -> Span | None:
        """The line of a template, or of one that it extends, that is equal to a line of output."""
        for template in self._chain(file):
            source = self.source(str(template.name))
            for number, start in enumerate(source.line_starts if source else (), start=1):
                assert source is not None
                text = source.line(number)
                if text.strip() == line.strip():
                    return Span(source, start + len(text) - len(text.lstrip()), start + len(text))
        return None

    def text_span(self, file: str, text: str) -> Span | None:
        """The first place of a text in a template, or in one that it extends."""
        for template in self._chain(file):
            source = self.source(str(template.name))
            start = source.text.find(text) if source is not None else -1
            if source is not None and start >= 0:
                return Span(source, start, start + len(text))
        return None

    def _load(self, file: str) -> tuple[str, str, Callable[[], bool]] | None:
        from smachac.targets.templates.nesting import refuse_deep

        source = self.source(file)
        if source is None:
            return None
        refuse_deep(self._environment, source.text, file)
        return source.text, file, lambda: True

    def _chain(self, file: str) -> list[Template]:
        """A template, the one it extends, and so on."""
        if file not in self._chains:
            chain = [self._environment.get_template(file)]
            seen = {file}
            while (parent := self._parent(str(chain[-1].name))) is not None:
                if parent in seen:
                    raise RecursionError(f"`{parent}` extends itself")
                seen.add(parent)
                chain.append(self._environment.get_template(parent))
            self._chains[file] = chain
        return self._chains[file]

    def _parent(self, file: str) -> str | None:
        """The template that a template extends, if its name is constant."""
        from jinja2 import nodes

        for found in self._tree(file, "extends").find_all(nodes.Extends):
            if isinstance(found.template, nodes.Const):
                return str(found.template.value)
        return None

    def _tree(self, file: str, word: str) -> nodes.Template:
        """The tree of a template; an empty one, to save time, if its text does not have a word."""
        from jinja2 import Environment, nodes

        source = self.source(file)
        if source is None or word not in source.text:
            return nodes.Template([])
        return Environment._parse(self._environment, source.text, file, file)

    def _all_names(self, file: str, seen: frozenset[str]) -> frozenset[str]:
        """`names` with the exceptions of Jinja; `seen` are the templates that include this one."""
        if file in seen:
            raise RecursionError(f"`{file}` includes itself")
        if file not in self._names:
            chain = self._chain(file)
            names = {name for template in chain for name in template.blocks}
            for template in chain:
                for other in _included(self._tree(str(template.name), "include")):
                    if self.source(other) is not None:
                        names |= self._all_names(other, seen | {file})
            self._names[file] = frozenset(names)
        return self._names[file]

    def _include(self, names: Any, context: JinjaContext, may_be_missing: bool) -> str:
        """The text of `{% include %}`: of the included template, the block that is rendered."""
        from jinja2 import TemplateNotFound

        files = [names] if isinstance(names, str) else [str(name) for name in names]
        file = next((name for name in files if self.source(name) is not None), None)
        if file is None:
            if may_be_missing:
                return ""
            raise TemplateNotFound(", ".join(files))
        page = self._page
        if page is None or not self._all_names(file, frozenset()):
            template = self._environment.get_template(file)
            inner = template.new_context(context.get_all(), shared=True)
            return "".join(template.root_render_func(inner))
        if page.target is None:
            page.included.append(file)
            return ""
        return Page(self, file, context.get_all(), page.target).text(page.target)

    def _converting(self, file: str, names: Names | None = None) -> _ErrorConverter:
        """The `with` block in which exceptions of Jinja become a BlockError. `names` gives
        the variables of the template."""
        return _ErrorConverter(self, file, names)


class Page:
    """A template with variables: its own blocks, and those of the templates that it includes.

    `target` is the block that is being rendered. The top level of the template has been run for its
    imports, its `set` statements and its includes; the text of the top level is not used.
    """

    def __init__(
        self, blocks: Blocks, file: str, variables: Mapping[str, object], target: str | None = None
    ) -> None:
        self.blocks = blocks
        self.file = file
        self.target: str | None = None
        self.included: list[str] = []
        chain = blocks._chain(file)
        self.own = {name for template in chain for name in template.blocks}
        self.context = chain[0].new_context(dict(variables))
        before, blocks._page = blocks._page, self
        try:
            if any(_HAS_TOP_LEVEL.search(_text(blocks, template)) for template in chain):
                self.context.blocks = {name: [_nothing] for name in self.own}
                for _ in chain[0].root_render_func(self.context):
                    pass
        finally:
            blocks._page = before
        self.context.blocks = {}
        for template in chain:
            for name, function in template.blocks.items():
                self.context.blocks.setdefault(name, []).append(function)
        self.inner: list[Page] = [
            Page(blocks, other, self.context.get_all()) for other in self.included
        ]
        self.names: set[str] = self.own.union(*(page.names for page in self.inner))
        self.target = target

    def render(self, block: str, *, alone: bool = False) -> str:
        """One block, without the line ends around it. Raises BlockError."""
        with self.blocks._converting(self.file, self.context.get_all):
            return self.text(block, alone=alone).strip("\n").rstrip()

    def text(self, block: str, *, alone: bool = False) -> str:
        """One block: its text in the templates included at the top level, then its text in this
        template. A `body` adds the state to its container: the own `body` replaces the others."""
        parts = []
        if not alone and (block != "body" or block not in self.own):
            parts = [page.text(block) for page in self.inner if block in page.names]
        if block in self.own:
            before, self.blocks._page = self.blocks._page, self
            self.target = block
            try:
                parts.append("".join(self.context.blocks[block][0](self.context)))
            finally:
                self.blocks._page = before
        return "\n".join(part for part in parts if part.strip())


_HAS_TOP_LEVEL = re.compile(r"\{%[-+]?\s*(?:set|import|from|do|macro|include)\b")


_EXTENDS = re.compile(r"\{%[-+]?\s*extends\s+[\"']([^\"']+)")
_INNERMOST = re.compile(r"innermost block that needs to be closed is '(\w+)'")
_UNKNOWN = re.compile(r"No (filter|test) named '(\w+)'")
_UNEXPECTED = re.compile(r"unexpected '(.{1,20})'$")
_STATEMENT = re.compile(r"\{%[-+]?\s*(\w+)")
_UNCLOSED = re.compile(r"^Unexpected end of template\..* needs to be closed is '(\w+)'")


def _nothing(context: JinjaContext) -> Iterator[str]:
    """The function of an empty block."""
    return iter(())


def _text(blocks: Blocks, template: Template) -> str:
    source = blocks.source(str(template.name))
    return source.text if source is not None else ""


def _included(tree: nodes.Template) -> Iterator[str]:
    """The names of the templates that a template includes outside of its blocks."""
    from jinja2 import nodes

    todo: list[nodes.Node] = [tree]
    while todo:
        node = todo.pop()
        if isinstance(node, nodes.Include) and isinstance(node.template, nodes.Const):
            value = node.template.value
            yield from [value] if isinstance(value, str) else map(str, value)
        elif not isinstance(node, nodes.Block):
            todo.extend(node.iter_child_nodes())


class _ErrorConverter:
    """A `with` block that converts exceptions of Jinja to a BlockError with the line of the
    template."""

    def __init__(self, blocks: Blocks, file: str, names: Names | None) -> None:
        self.blocks = blocks
        self.file = file
        self.names = names

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: object, error: BaseException | None, trace: Any) -> None:
        if error is None or isinstance(error, BlockError) or not isinstance(error, Exception):
            return
        span = self._place(error, trace)
        message, help = _message_and_help(error)
        name = getattr(error, "undefined_name", None)
        names = (message,) if name is None else ("undefined", name)
        if name is not None:
            near = guesser(sorted(self.names() if self.names else ())).unique_match(name)
            help = f"did you mean `{near}`?" if near is not None else help
            span = _marked(span, rf"\b{re.escape(name)}\b")
        opening = _unclosed_tag(error, span.source)
        span = span if opening is None else opening
        found = _at_a_word(error, self.blocks._environment.filters)
        if found is not None:
            message, help, pattern = found
            span = _marked(span, pattern)
        raise BlockError(template_error(span, message, help, names)) from error

    def _place(self, error: Exception, trace: Any) -> Span:
        """The line of the template that an exception comes from: in a template of the user, if one
        of them has called the code with the error."""
        from jinja2 import TemplateError

        file, line = self.file, 1
        if isinstance(error, TemplateError) and getattr(error, "lineno", None):
            file = getattr(error, "name", None) or file
            line = int(getattr(error, "lineno", 1))
        else:
            own = False
            while trace is not None:
                name = trace.tb_frame.f_code.co_filename
                if self.blocks.source(name) is not None and own <= self.blocks._is_own(name):
                    own = self.blocks._is_own(name)
                    template = self.blocks._environment.get_template(name)
                    file, line = name, template.get_corresponding_lineno(trace.tb_lineno)
                trace = trace.tb_next
            if not own and self.blocks._is_own(self.file):
                return self._extending() or self._line(file, line)
        return self._line(file, line)

    def _extending(self) -> Span | None:
        """The place at which the template names the one that it extends."""
        source = self.blocks.source(self.file)
        found = _EXTENDS.search(source.text) if source is not None else None
        return Span(source, *found.span(1)) if source is not None and found is not None else None

    def _line(self, file: str, line: int) -> Span:
        source = self.blocks.source(file) or Source(file, "")
        starts = source.line_starts
        start = starts[min(line, len(starts)) - 1]
        return Span(source, start, start + len(source.line(line)))


def _unclosed_tag(error: Exception, source: Source) -> Span | None:
    """The last tag of a template that is not closed, if that is the error."""
    unclosed = _UNCLOSED.search(getattr(error, "message", None) or "")
    if unclosed is None:
        return None
    opened: list[Span] = []
    for start, end in tags(source.text, "#%"):
        word = _STATEMENT.match(source.text, start, end)
        if word is not None and word[1] == unclosed[1]:
            opened.append(Span(source, start, end))
        elif word is not None and word[1] == f"end{unclosed[1]}" and opened:
            opened.pop()
    return opened[-1] if opened else None


def _at_a_word(error: Exception, filters: Iterable[str]) -> tuple[str, str | None, str] | None:
    """Message, help and the pattern of the wrong word for an error at one word of a template."""
    text = getattr(error, "message", None) or ""
    if (unknown := _UNKNOWN.match(text)) is not None:
        kind, name = unknown.groups()
        near = guesser(sorted(filters) if kind == "filter" else ())(name)
        help = f"did you mean `{near}`?" if near is not None else None
        return f"there is no {kind} `{name}`", help, rf"\b{name}\b"
    if (token := _UNEXPECTED.match(text)) is not None:
        sign = re.escape(token[1])
        help = "write `}}` at the end of the expression" if token[1] == "}" else None
        return f"`{token[1]}` is not expected here", help, f"(?<!{sign}){sign}(?!{sign})"
    return None


def _marked(line: Span, pattern: str) -> Span:
    """The only place of a pattern in a line; the line if it has none or several."""
    found = [*re.finditer(pattern, line.text)]
    if len(found) != 1:
        return line
    return Span(line.source, line.start + found[0].start(), line.start + found[0].end())


def _message_and_help(error: Exception) -> tuple[str, str | None]:
    """Message and help for an exception; some messages of Jinja are replaced by clearer ones."""
    from jinja2 import TemplateNotFound, UndefinedError
    from jinja2.exceptions import SecurityError

    text = getattr(error, "message", None) or str(error) or type(error).__name__
    unclosed = _UNCLOSED.search(text)
    if unclosed is not None:
        tag = unclosed.group(1)
        help = f"write `{{% end{tag} %}}` after the last line of the `{tag}`"
        return f"this `{tag}` has no `{{% end{tag} %}}`", help
    inner = _INNERMOST.search(text)
    text = text.split(". ")[0].rstrip(".")  # without the explanations of Jinja
    unknown = text.removeprefix("Encountered unknown tag ").strip("'")
    if unknown != text.strip("'"):
        help = f"remove `{unknown}`, or correct its name"
        if unknown.startswith("end") and inner is not None:
            message = f"`{unknown}` stands before the end of the `{inner[1]}` above it"
            return message, f"write `{{% end{inner[1]} %}}` before `{{% {unknown} %}}`"
        if unknown.startswith("end"):
            help = f"remove `{unknown}`: no `{unknown.removeprefix('end')}` is open here"
        return f"there can be no tag `{unknown}` here", help
    if isinstance(error, UndefinedError) and text.endswith(" is undefined"):
        name = text.removesuffix(" is undefined").strip("'")
        help = (
            f"correct the name, or set `{name}: VALUE` at each state of this type; where the type"
            f" has an interface, add `{name}` to its `variables` first"
        )
        return f"the template uses `{name}`, which is not defined", help
    if isinstance(error, RecursionError):
        return "the template extends, includes or calls itself endlessly", None
    if isinstance(error, MemoryError):
        return "the template needs too much memory", None
    if isinstance(error, TemplateNotFound):
        help = "put the template into one of the template folders"
        return f"there is no template `{text}`", help
    if isinstance(error, SecurityError):
        help = "use the variables of the state: a template has no access to Python itself"
        return text, help
    return text, None

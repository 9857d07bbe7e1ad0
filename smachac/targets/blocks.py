"""Templates whose blocks are rendered one by one and gathered, as SMACHA did.

The text of a block goes where the target puts blocks of that name. Templates are Jinja, sandboxed
and strict about undefined names; they may extend and include one another.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from smachac import problems
from smachac.diagnostics import Diagnostic
from smachac.source import Source, Span

if TYPE_CHECKING:
    from jinja2 import Template
    from jinja2.runtime import Context as JinjaContext

Find = Callable[[str], Source | None]


class BlockError(Exception):
    """A template does not parse or render; `diagnostic` says where and why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.finding.message)
        self.diagnostic = diagnostic


class Blocks:
    """The templates of one build, by file name."""

    def __init__(self, find: Find) -> None:
        from jinja2 import StrictUndefined
        from jinja2.loaders import FunctionLoader
        from jinja2.sandbox import SandboxedEnvironment

        self._sources: dict[str, Source | None] = {}
        self._find = find
        self._chains: dict[str, list[Template]] = {}
        self._environment = SandboxedEnvironment(
            loader=FunctionLoader(self._load),
            undefined=StrictUndefined,
            extensions=["jinja2.ext.do"],
            lstrip_blocks=True,
            keep_trailing_newline=True,
            autoescape=False,  # the output is code, not HTML
        )

    def source(self, file: str) -> Source | None:
        """The text of a template, read once."""
        if file not in self._sources:
            self._sources[file] = self._find(file)
        return self._sources[file]

    def names(self, file: str) -> frozenset[str]:
        """The blocks that a template and those it extends have."""
        with self._located(file):
            return frozenset(name for template in self._chain(file) for name in template.blocks)

    def render(self, file: str, block: str, variables: Mapping[str, object]) -> str:
        """One block of a template, without the line ends around it. Raises BlockError."""
        with self._located(file):
            context = self._context(file, variables)
            return "".join(context.blocks[block][0](context)).strip("\n")

    def render_whole(self, file: str, variables: Mapping[str, object]) -> str:
        """A whole template, without the space around it. Raises BlockError."""
        with self._located(file):
            return self._environment.get_template(file).render(variables).strip()

    def _load(self, file: str) -> tuple[str, str, Callable[[], bool]] | None:
        source = self.source(file)
        return None if source is None else (source.text, file, lambda: True)

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
        from jinja2 import nodes

        source = self.source(file)
        if source is None or "extends" not in source.text:
            return None
        for found in self._environment.parse(source.text, file, file).find_all(nodes.Extends):
            if isinstance(found.template, nodes.Const):
                return str(found.template.value)
        return None

    def _context(self, file: str, variables: Mapping[str, object]) -> JinjaContext:
        """A context with the blocks of the whole chain, own ones first, so that `super()` works.

        The top level of each template is run for its imports and `set`s; its text is dropped.
        """
        chain = self._chain(file)
        context = chain[0].new_context(dict(variables))
        context.blocks = {}
        for template in reversed(chain):
            if _HAS_TOP_LEVEL.search(self._text(template)):
                kept = context.blocks
                context.blocks = {name: [_nothing] for name in template.blocks}
                for _ in template.root_render_func(context):
                    pass
                context.blocks = kept
        context.blocks = {}
        for template in chain:
            for name, function in template.blocks.items():
                context.blocks.setdefault(name, []).append(function)
        return context

    def _text(self, template: Template) -> str:
        source = self.source(str(template.name))
        return source.text if source is not None else ""

    def _located(self, file: str) -> _Located:
        return _Located(self, file)


_HAS_TOP_LEVEL = re.compile(r"\{%-?\s*(?:set|import|from|do)\b")


def _nothing(context: JinjaContext) -> Iterator[str]:
    return iter(())


class _Located:
    """Turns what Jinja raises into a BlockError with the line of the template."""

    def __init__(self, blocks: Blocks, file: str) -> None:
        self.blocks = blocks
        self.file = file

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: object, error: BaseException | None, trace: Any) -> None:
        from jinja2 import TemplateError

        if error is None or isinstance(error, BlockError) or not isinstance(error, Exception):
            return
        file, line = self.file, 1
        if isinstance(error, TemplateError) and getattr(error, "lineno", None):
            file = getattr(error, "name", None) or file
            line = int(getattr(error, "lineno", 1))
        else:
            while trace is not None:  # Jinja maps its frames to lines of the template
                name = trace.tb_frame.f_code.co_filename
                if self.blocks.source(name) is not None:
                    file, line = name, trace.tb_lineno
                trace = trace.tb_next
        source = self.blocks.source(file) or Source(file, "")
        starts = source.line_starts
        start = starts[min(line, len(starts)) - 1]
        span = Span(source, start, start + len(source.line(line)))
        words = getattr(error, "message", None) or str(error) or type(error).__name__
        words = words.split(". ")[0].rstrip(".")  # Jinja explains at length
        if isinstance(error, RecursionError):
            words = "the template extends or includes itself"
        if type(error).__name__ == "TemplateNotFound":
            words = f"there is no template `{words}`"
        raise BlockError(problems.template_error(span, words)) from error

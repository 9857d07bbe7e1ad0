"""Differences between SMACHA and smachac in a template, and its Python 2 code.

The template is parsed, not rendered, so that templates without a script can be checked.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import Source, Span
from smachac.frontend import schema
from smachac.frontend.types import smacha_meta
from smachac.pysource.modules.jinja_tags import meta_block, tags
from smachac.records import dataclass, field
from smachac.refactor.smacha.script_differences import SmachaDifference
from smachac.targets.python.buffers import APPENDED, KEYED, PREPENDED
from smachac.targets.python.python2 import translated
from smachac.targets.templates.engine import SKIPPED

if TYPE_CHECKING:
    from jinja2 import nodes

Find = Callable[[str], Source | None]

BLOCKS = (*APPENDED, *KEYED, "body", *PREPENDED, *SKIPPED)
"""The blocks of states and containers that are printed."""

GIVEN = (
    *("name", "class_name", "uuid", "params", "parent_name", "parent_sm_name", "parent_type"),
    *("parent_template", "defined_headers", "local_vars", "add"),
)
"""The variables of every template of a state or container."""

GONE = re.compile(
    r"(?:\.(?:iteritems|itervalues|iterkeys|has_key)\(|\b(?:xrange|unicode|basestring|raw_input)\b)"
)
"""Names that Python 3 does not have, although their use compiles."""

_OPENING = re.compile(r"\{[{%]")
_UUID = re.compile(r"\buuid\b")
_OLD = re.compile(r"\{%[-+]?\s*include\s+[\"']State\.tpl(?:\.py)?[\"']\s*[-+]?%\}")
_BASES = ("Base", "ROSBase", "Program", "ROSProgram")


@dataclass(slots=True)
class TemplateNames:
    """The use of names in a template and the templates it extends.

    `sets` are set or imported at the top level, `exports` are those that SMACHA handed to other
    templates, `used` are used without a definition, `tested` may be undefined.
    """

    sets: dict[str, int] = field(default_factory=dict)
    exports: dict[str, int] = field(default_factory=dict)
    used: dict[str, int] = field(default_factory=dict)
    tested: set[str] = field(default_factory=set)
    blocks: dict[str, int] = field(default_factory=dict)
    inner_blocks: set[str] = field(default_factory=set)
    loose: int = 0


def template_differences(
    source: Source,
    find: Find,
    given: frozenset[str],
    sets: Mapping[str, str],
    *,
    used: bool = True,
) -> Iterator[SmachaDifference]:
    """The differences in a template, in the order of its text.

    `find` finds templates by name, `given` are the variables that scripts give to states, `sets`
    are the names that templates set at their top level, each with one such template. `used`:
    scripts use the template; otherwise it is not known which variables they would give.
    """
    chain = _chain(source, find)
    if not chain:
        return
    found = [*_of_names(source, chain, given, sets), *_of_text(source, chain), *_of_blocks(chain)]
    found = [difference for difference in found if used or difference.name != "unknown-name"]
    yield from sorted(found, key=lambda difference: difference.span.start)


def top_level_sets(source: Source) -> tuple[str, ...]:
    """The names that a template sets outside of its blocks; in SMACHA other templates saw them."""
    names = _names(source)
    return tuple(names.exports) if names is not None else ()


def _chain(source: Source, find: Find) -> list[tuple[Source, TemplateNames]]:
    """A template, and all readable templates that it extends or includes; itself first."""
    found: dict[str, tuple[Source, TemplateNames]] = {}
    todo: list[Source | None] = [source]
    while todo:
        each = todo.pop()
        names = _names(each) if each is not None and each.name not in found else None
        if each is None or names is None:
            continue
        found[each.name] = (each, names)
        todo += [find(name) for name in _OTHERS.findall(each.text)]
    return list(found.values())


_OTHERS = re.compile(r"\{%[-+]?\s*(?:extends|include)\s+[\"']([^\"']+)[\"']")


def _names(source: Source) -> TemplateNames | None:
    """The use of names in a template; None if it cannot be parsed."""
    from jinja2 import Environment, TemplateError, nodes
    from jinja2.meta import find_undeclared_variables

    try:
        tree = Environment(extensions=["jinja2.ext.do"], autoescape=False).parse(source.text)
        unmade = find_undeclared_variables(tree)
    except (TemplateError, RecursionError, ValueError):
        return None
    names = TemplateNames()
    for node in _outside(tree):
        if isinstance(node, nodes.Assign | nodes.Macro | nodes.Import | nodes.FromImport):
            found = dict.fromkeys(_assigned_names(node), node.lineno)
            names.sets |= found
            if isinstance(node, nodes.Assign | nodes.Macro):  # Jinja exports no imported names
                names.exports |= {k: line for k, line in found.items() if not k.startswith("_")}
        elif isinstance(node, nodes.Block):
            names.blocks.setdefault(node.name, node.lineno)
            names.inner_blocks |= {block.name for block in node.find_all(nodes.Block)}
        elif isinstance(node, nodes.TemplateData) and node.data.strip():
            before = len(node.data) - len(node.data.lstrip())
            names.loose = names.loose or node.lineno + node.data[:before].count("\n")
    for node in tree.find_all((nodes.Test, nodes.If, nodes.Filter, nodes.CondExpr)):
        names.tested |= _tested(node)
    for name in tree.find_all(nodes.Name):
        if name.ctx == "load" and name.name in unmade:
            names.used.setdefault(name.name, name.lineno)
    return names


def _outside(tree: nodes.Node) -> Iterator[nodes.Node]:
    """The nodes outside of blocks, and the blocks."""
    from jinja2 import nodes

    for node in tree.iter_child_nodes():
        yield node
        if not isinstance(node, nodes.Block | nodes.Macro | nodes.For):  # with names of their own
            yield from _outside(node)


def _assigned_names(node: nodes.Node) -> list[str]:
    """The names that a statement defines."""
    from jinja2 import nodes

    match node:
        case nodes.Macro(name=name):
            return [name]
        case nodes.Import(target=target):
            return [target]
        case nodes.FromImport(names=names):
            return [name if isinstance(name, str) else name[1] for name in names]
    return [name.name for name in node.find_all(nodes.Name) if name.ctx == "store"]


def _tested(node: nodes.Node) -> set[str]:
    """The names that a node allows to be undefined."""
    from jinja2 import nodes

    match node:
        case nodes.Test(name="defined" | "undefined", node=nodes.Name(name=name)):
            return {name}
        case nodes.Filter(name="default" | "d", node=nodes.Name(name=name)):
            return {name}
        case nodes.If(test=test) | nodes.CondExpr(test=test):
            return _truths(test)
    return set()


def _truths(test: nodes.Node) -> set[str]:
    """The names of which a condition uses only the truth, which is false for undefined ones."""
    from jinja2 import nodes

    match test:
        case nodes.Name(name=name):
            return {name}
        case nodes.Not(node=inner):
            return _truths(inner)
        case nodes.And(left=left, right=right) | nodes.Or(left=left, right=right):
            return _truths(left) | _truths(right)
    return set()


def _of_names(
    source: Source,
    chain: list[tuple[Source, TemplateNames]],
    given: frozenset[str],
    sets: Mapping[str, str],
) -> Iterator[SmachaDifference]:
    """Undefined names, and names that SMACHA took from other templates."""
    own = chain[0][1]
    known = {*GIVEN, *BLOCKS, *schema.VARIABLES, "range", "dict", "loop", "super"}
    known |= {"self", "cycler", "joiner", "namespace", "caller", "varargs", "kwargs"}
    known |= {name for _, names in chain for name in (*names.sets, *names.tested)}
    for other, _ in chain:
        meta = smacha_meta.read_meta(other)
        if meta is not None:
            known |= {*meta.variables, *(word.text for word in (*meta.input_keys,))}
    for name, line in own.used.items():
        if name in known or (name in given and name not in sets):
            continue
        span = _word(source, line, name)
        if name in sets:
            message = (
                f"SMACHA took `{name}` from `{sets[name]}`, which sets it, if that came before"
            )
            message += "; here it is that template's own, and scripts have to give it"
            yield SmachaDifference(span=span, name="leaked-set", message=message)
        else:
            hint = did_you_mean(name, sorted({*known, *given}))
            message = f"no script gives `{name}`: SMACHA printed nothing, here it is an error"
            message += f"; {hint}" if hint else ""
            yield SmachaDifference(span=span, name="unknown-name", message=message, variable=name)
    if "params" in own.used and "params" not in own.tested:
        span = _word(source, own.used["params"], "params")
        message = "SMACHA gave the params of the container; here the state's own are in as well"
        yield SmachaDifference(span=span, name="own-params", message=message)


def _of_text(
    source: Source, chain: list[tuple[Source, TemplateNames]]
) -> Iterator[SmachaDifference]:
    """Differences in the text: Python 2 code, old style, uuids."""
    text = source.text
    if meta := meta_block(text):
        text = text[: meta[0]] + "\n" * text.count("\n", meta[0], meta[3]) + text[meta[3] :]
    if line := _line_of_uuid(text):
        message = "SMACHA made a `uuid` anew in each run; here it is the same in each build"
        yield SmachaDifference(
            span=_word(source, line, "uuid"), name="stable-uuid", what="note", message=message
        )
    if found := _OLD.search(source.text):
        message = "it includes `State.tpl` and adds its state itself, as older templates do"
        span = Span(source, found.start(), found.end())
        yield SmachaDifference(span=span, name="old-style", what="note", message=message)
    printed = chain[0][1].blocks.keys() - {"meta"}  # none in a template of macros
    if chain[0][1].loose and printed and not smacha_meta.extended(source) and not _is_base(chain):
        line = chain[0][1].loose
        message = "SMACHA printed what is outside of blocks once for each block; here it is not"
        yield SmachaDifference(span=_line(source, line), name="text-outside", message=message)
    python = _without_tags(text)
    for number, code in enumerate(python.splitlines(), start=1):
        if gone := GONE.search(code.partition("#")[0]):
            message = f"`{gone[0].strip('.(')}` is Python 2: the program fails where it comes to it"
            yield SmachaDifference(
                span=_line(source, number), name="python-2", what="edit", message=message
            )
        elif translated(code) not in (None, code):
            message = f"`{_line(source, number).text}` is Python 2; it is printed as Python 3"
            yield SmachaDifference(
                span=_line(source, number), name="python-2", what="note", message=message
            )


def _line_of_uuid(text: str) -> int:
    """The number of the first line that has `uuid` in a tag; 0 without one."""
    line = 1
    for piece in text.split("}"):
        opening = _OPENING.search(piece)
        found = _UUID.search(piece, opening.end()) if opening is not None else None
        if found is not None:
            return line + piece.count("\n", 0, found.end())
        line += piece.count("\n")
    return 0


def _without_tags(text: str) -> str:
    """A text with `x` in place of each tag, on the same lines."""
    parts, at = [], 0
    for start, end in tags(text):
        parts += [text[at:start], "x", "\n" * text.count("\n", start, end)]
        at = end
    return "".join([*parts, text[at:]])


def _of_blocks(chain: list[tuple[Source, TemplateNames]]) -> Iterator[SmachaDifference]:
    """Blocks that are not printed."""
    source, own = chain[0]
    if _is_base(chain):
        return
    inner = {name for _, names in chain for name in names.inner_blocks}
    for name, line in own.blocks.items():
        if name not in BLOCKS and name not in inner:
            hint = did_you_mean(name, BLOCKS)
            message = f"no block `{name}` is printed anywhere" + (f"; {hint}" if hint else "")
            yield SmachaDifference(
                span=_word(source, line, name), name="lost-block", message=message
            )


def _is_base(chain: list[tuple[Source, TemplateNames]]) -> bool:
    """Whether a template is a base template, or extends one: it is printed as a whole."""
    for source, names in chain:
        meta = smacha_meta.read_meta(source)
        stem = re.split(r"[\\/]", source.name)[-1].partition(".")[0]
        if stem in _BASES or (meta is not None and meta.kind == "base"):
            return True
        if meta is None and {"main", "body"} <= {*names.blocks} and "body" in names.used:
            return True
    return False


def _line(source: Source, number: int) -> Span:
    """A line of a template, without surrounding space."""
    text, start = source.line(number), source.line_starts[number - 1]
    return Span(source, start + len(text) - len(text.lstrip()), start + len(text.rstrip()))


def _word(source: Source, number: int, word: str) -> Span:
    """A word at a line of a template or, in a tag of several lines, below it; otherwise the
    line."""
    start = source.line_starts[number - 1]
    found = re.compile(rf"\b{re.escape(word)}\b").search(source.text, start)
    return Span(source, *found.span()) if found is not None else _line(source, number)

"""State types of SMACHA's templates, from the meta block and from the text of the template.

SMACHA uses meta blocks only for its help, and many are malformed; such parts are left out.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.text.values import as_value
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse
from smachac.frontend.types.type_annotations import read_type
from smachac.ir.nodes import Key, Outcome, StateKind, Value
from smachac.ir.types import ANY, Type
from smachac.pysource.modules.jinja_tags import meta_block, tags
from smachac.records import dataclass

_BODY = re.compile(r"\{%[-+]?\s*block\s+body\b")
_BODY_TEXT = re.compile(r"\{%[-+]?\s*block\s+body\b[^%]*%\}(.*?)\{%[-+]?\s*endblock\b", re.DOTALL)
_ONLY_SUPER = re.compile(r"\s*\{\{[-+]?\s*super\s*\(\s*\)\s*[-+]?\}\}\s*")
_AROUND = r"\{\{[-+]?\s*(?:body\b|super\s*\()"
_EXTENDS = re.compile(r"\{%[-+]?\s*extends\s+[\"']([^\"']+)[\"']")
_OUTCOMES = r"\boutcomes\s*=\s*\[([^\[\]{}]*)\]"
_DEFAULT = re.compile(r"\bdef\s+\w+\([^()]*$")
_KEYS = re.compile(r"\b(input|output)_keys\s*=\s*\[([^\[\]{}]*)\]")
_BRINGS = r"\s*(?:[-+]\s*)?(?:extends|include|import|from)\b\s*(.*)"
_INIT = (
    r"\b(?:State|super\([^()]*\))\.__init__"
    r"\(\s*(?:self\s*,\s*)?(?:outcomes\s*=\s*)?\[([^\[\]{}]*)\]"
)
_MAKER = r"\bdef\s+__init__\s*\(([^()]*)\)"
_WORD = r"[^\W\d]\w*"
_FILES = r"[\"']([^\"']+)[\"']"
_QUOTED = r"([\"'])(\w+)\1"


PRINTED_TYPES = frozenset(["int", "float", "bool", "one_of"])
"""The types of variables that are checked: a template prints a number as a text, too, and a list
can be a string construct."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Meta:
    """A meta block. Its keys are those that every such state has; scripts may add others. `types`
    are those of its variables and keys, by field and name; types in words are left out."""

    kind: StateKind
    doc: str
    variables: tuple[str, ...]
    defaults: Mapping[str, Value]
    input_keys: tuple[Word, ...]
    output_keys: tuple[Word, ...]
    outcomes: tuple[Outcome, ...]
    simulation: bool
    types: Mapping[str, Mapping[str, Type]]

    def type_of(self, part: str, name: str) -> Type:
        """The type of a variable or key."""
        return self.types.get(part, {}).get(name, ANY)


def has_body(template: Source) -> bool:
    """Whether a template has a block `body`: it prints the code that adds the state."""
    return _BODY.search(template.text) is not None


def makes_state(template: Source) -> bool:
    """Whether a template has a block `body` with more than that of the template it extends."""
    bodies = _BODY_TEXT.findall(template.text)
    return has_body(template) and not (bodies and all(map(_ONLY_SUPER.fullmatch, bodies)))


def extended(template: Source) -> str:
    """The file that a template extends, or nothing."""
    found = _EXTENDS.search(template.text)
    return found.group(1) if found else ""


def extended_span(template: Source) -> Span:
    """The place of the name of the file that a template extends."""
    found = _EXTENDS.search(template.text)
    return Span(template, *found.span(1)) if found else Span(template, 0, 0)


def read_meta(template: Source) -> Meta | None:
    """The meta block of a template; None if there is none or it is no YAML."""
    found = meta_block(template.text)
    text = template.text[found[1] : found[2]] if found is not None else ""
    # Empty lines before the block give its parts the lines that they have in the template.
    above = "\n" * template.text.count("\n", 0, found[1]) if found is not None else ""
    tree = parse(Source(template.name, above + text), []) if found is not None else None
    if not isinstance(tree, Map):
        return None

    variables = tree.get("variables")

    def listed(part: str, *, optional: bool) -> tuple[Word, ...]:
        entry = tree.get(part)
        return tuple(_names(entry.value, optional)) if entry else ()

    return Meta(
        kind=_kind(_text(tree, "type"), template),
        doc=_text(tree, "description"),
        variables=tuple(word.text for word in listed("variables", optional=True)),
        defaults=dict(_defaults(variables.value)) if variables is not None else {},
        input_keys=listed("input_keys", optional=False),
        output_keys=listed("output_keys", optional=False),
        outcomes=tuple(
            Outcome(name=word.text, span=word.span)
            for word in listed("outcomes", optional=True)
            if re.fullmatch(r"\w+", word.text)  # some have a sentence in place of the names
        ),
        simulation=_text(tree, "simulation") == "True",
        types={
            part: {
                name: type_
                for name, type_ in _types(entry.value)
                if part != "variables" or type_.name in PRINTED_TYPES
            }
            for part in ("variables", "input_keys", "output_keys")
            if (entry := tree.get(part)) is not None
        },
    )


def _kind(word: str, template: Source) -> StateKind:
    """The kind that a meta block names. Some states of SMACHA have the kind `container`, although
    they print no children: their kind is `state`."""
    alone = has_body(template) and re.search(_AROUND, template.text) is None
    return (
        "base" if word == "Base" else "container" if word == "Container" and not alone else "state"
    )


def outcomes_in_code(template: Source) -> tuple[Outcome, ...]:
    """The outcomes of the only class of states in a template, if they are constants and not the
    default value of a parameter."""
    found = list(re.finditer(_OUTCOMES, template.text))
    if found and _DEFAULT.search(template.text, 0, found[0].start()) is not None:
        return ()
    return _quoted_outcomes(template, found[0]) if len(found) == 1 else ()


def class_outcomes(template: Source) -> tuple[Outcome, ...]:
    """The outcomes that the only class of states in a template passes to `smach.State` first, as
    constants; nothing if they are computed or others are registered."""
    found = list(re.finditer(_INIT, template.text))
    if len(found) != 1 or "register_outcomes" in template.text:
        return ()
    return _quoted_outcomes(template, found[0])


def _quoted_outcomes(template: Source, names: re.Match[str]) -> tuple[Outcome, ...]:
    """The outcomes that a list in a template names; nothing if it is not of constants only."""
    if re.sub(_QUOTED, "", names[1]).strip(", \n\t"):
        return ()
    start = names.start(1)
    return tuple(
        Outcome(name=word[2], span=Span(template, start + word.start(2), start + word.end(2)))
        for word in re.finditer(_QUOTED, names[1])
    )


def default_keys(template: Source) -> Mapping[str, tuple[Key, ...]]:
    """The keys that the only constructor in a template has as default values, by parameter.

    A list that the template gives elsewhere too may replace the default, which then does not count.
    """
    makers = list(re.finditer(_MAKER, template.text))
    if len(makers) != 1:
        return {}
    every = [found.group(1) for found in _KEYS.finditer(template.text)]
    keys = {}
    for found in _KEYS.finditer(template.text, *makers[0].span(1)):
        if every.count(found.group(1)) > 1:
            continue
        start = found.start(2)
        keys[f"{found.group(1)}_keys"] = tuple(
            Key(
                name=word.group(2),
                span=Span(template, start + word.start(2), start + word.end(2)),
            )
            for word in re.finditer(_QUOTED, found.group(2))
        )
    return keys


def keys_in_code(template: Source) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The input and output keys that the code of a template lists."""
    found: dict[str, dict[str, None]] = {"input": {}, "output": {}}
    for keys in _KEYS.finditer(template.text):
        for word in re.finditer(_QUOTED, keys.group(2)):
            found[keys.group(1)][word.group(2)] = None
    return tuple(found["input"]), tuple(found["output"])


def body_words(file: str, find: Callable[[str], Source | None]) -> Iterator[str]:
    """The names in quotes in the block `body` of a template and of those that it extends."""
    seen: set[str] = set()
    while file and file not in seen:
        seen.add(file)
        template = find(file)
        if template is None:
            return
        for body in _BODY_TEXT.findall(template.text):
            yield from (word for _, word in re.findall(_QUOTED, body))
        file = extended(template)


def words_used(file: str, find: Callable[[str], Source | None]) -> frozenset[str] | None:
    """The words in the tags of a template and of the templates that it includes; None if one of
    these is not found."""
    words: set[str] = set()
    todo, seen = [file], {file}
    while todo:
        name = todo.pop()
        template = find(name) or find(f"{name}.py")
        if template is None:
            return None
        for start, end in tags(template.text, "%{"):
            tag = template.text[start + 2 : end - 2]
            words.update(re.findall(_WORD, tag))
            brings = (
                re.match(_BRINGS, tag, re.DOTALL) if template.text.startswith("{%", start) else None
            )
            if brings is None:
                continue
            files = re.findall(_FILES, brings.group(1)) if brings.group(1)[:1] in "\"'[(" else []
            if not files:
                return None
            todo += [file for file in files if file not in seen]
            seen.update(files)
    return frozenset(words)


def _text(tree: Map, name: str) -> str:
    """The text under a name of a mapping, or nothing."""
    entry = tree.get(name)
    return str(entry.value.value) if entry and isinstance(entry.value, Scalar) else ""


def _names(tree: Tree, optional: bool) -> list[Word]:
    """The names in a meta list: `- x: {...}` or `- x`; a nested list has optional names, and the
    value of a group's name is the list of its names."""
    if isinstance(tree, Scalar):
        return [Word(str(tree.value), tree.span)] if tree.value is not None else []
    if isinstance(tree, Map):
        return [
            found
            for entry in tree.entries
            for found in (
                _names(entry.value, optional)
                if isinstance(entry.value, Seq)
                else [Word(str(entry.key.value), entry.value.span)]
            )
        ]
    inner = (item for item in tree.items if optional or not isinstance(item, Seq))
    return [found for item in inner for found in _names(item, optional)]


def _defaults(tree: Tree) -> Iterator[tuple[str, Value]]:
    """The defaults of the variables in a meta list, by name."""
    if isinstance(tree, Seq):
        for item in tree.items:
            yield from _defaults(item)
    elif isinstance(tree, Map):
        for entry in tree.entries:
            default = entry.value.get("default") if isinstance(entry.value, Map) else None
            if default is not None:
                yield str(entry.key.value), as_value(default.value)
            elif isinstance(entry.value, Seq):
                yield from _defaults(entry.value)


def _types(tree: Tree) -> Iterator[tuple[str, Type]]:
    """The types of the names in a meta list, without those whose default is `null`."""
    if isinstance(tree, Seq):
        for item in tree.items:
            yield from _types(item)
    elif isinstance(tree, Map):
        for entry in tree.entries:
            if isinstance(entry.value, Seq):
                yield from _types(entry.value)
                continue
            found = entry.value.get("type") if isinstance(entry.value, Map) else None
            if found is None or not isinstance(found.value, Scalar):
                continue
            text = str(found.value.value)
            report: Report = []
            type_ = read_type(text, Word(text, found.value.span), report)
            if type_ is None or report:
                continue
            default = entry.value.get("default") if isinstance(entry.value, Map) else None
            if default is None or as_value(default.value).data is not None:
                yield str(entry.key.value), type_

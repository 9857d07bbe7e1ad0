"""State types: what is known of a state without looking into its code.

An interface is one YAML file `Name.yml`, or the `{% block meta %}` of a template as SMACHA has it.
A template without either makes an open type: anything goes, nothing is known.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from keyword import iskeyword

from smachac.diagnostics.diagnostic import Report, did_you_mean
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend import field_shapes, smacha_meta
from smachac.frontend.errors.script import unknown_variable, wrong_shape
from smachac.frontend.loader import Library
from smachac.frontend.python_source import python_body
from smachac.frontend.type_annotations import read_type
from smachac.frontend.yaml_tree import Map, Scalar, Tree
from smachac.ir.nodes import Body, Key, Outcome
from smachac.ir.types import ANY, Type, optional

Kind = smacha_meta.Kind


@dataclass(frozen=True, slots=True, kw_only=True)
class VariableType:
    """A variable of a state type. Without a default it is required.

    `keys` says that it lists keys of the userdata, "input" or "output" ones.
    """

    name: str
    type: Type = ANY
    required: bool = True
    doc: str = ""
    default: Tree | None = None
    keys: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateType:
    """The interface of a state.

    `given` names what the script itself supplies, beyond what stands here: any of
    "variables", "input_keys", "output_keys", "outcomes" (`"*": {}` in the interface).
    `code` maps a language to a template's file name or to a reference to code, `classes` a language
    to a class of it, in words: `header`, `class`, `with`. `body` is what the template of Python
    does. `open`: there is no interface. `prints_itself`: the template of Python adds the
    state to its container, as those of SMACHA do. `optional` are outcomes that a state has only
    where its container or a transition of it speaks of them. `used` are the words that a template
    uses where any variable may be given; None where that is not known.
    """

    name: str
    kind: Kind = "state"
    doc: str = ""
    variables: Mapping[str, VariableType] = field(default_factory=dict)
    input_keys: tuple[Key, ...] = ()
    output_keys: tuple[Key, ...] = ()
    outcomes: tuple[Outcome, ...] = ()
    writes: tuple[tuple[str, tuple[str, ...]], ...] = ()
    given: frozenset[str] = frozenset()
    claims: tuple[str, ...] = ()
    blocking: bool = False
    code: Mapping[str, str] = field(default_factory=dict)
    classes: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    body: Body | None = None
    open: bool = False
    prints_itself: bool = False
    optional: frozenset[str] = frozenset()
    used: frozenset[str] | None = None


TEMPLATE_FILES = ("{}.tpl.py", "{}.tpl")
"""Names under which the template of a state type may be found, for targets that print Python."""

CLASS_FIELDS = ("header", "class", "with")
"""What is said of code that is a class: where it is, its name, what it is made with."""

_ALL_GIVEN = frozenset(["variables", "input_keys", "output_keys", "outcomes"])

_FIELDS: dict[str, str] = {
    "name": "name",
    "doc": "text",
    "kind": "name",
    "variables": "map",
    "input_keys": "map",
    "output_keys": "map",
    "outcomes": "map",
    "writes": "map",
    "claims": "names",
    "blocking": "flag",
    "code": "map",
}


def find_state_type(name: str, library: Library, report: Report) -> StateType | None:
    """The state type of that name, or None where there is neither interface nor template.

    What the user has of that name, be it a template alone, comes before what we have.
    """
    return _find(name, library, report, frozenset())


def _find(name: str, library: Library, report: Report, below: frozenset[str]) -> StateType | None:
    """`below`: the types whose templates extend this one."""
    if name in below:
        return None
    for find in (library.own_template, library.template):
        interface = find(f"{name}.yml")
        if interface is not None:
            return _read_interface(name, interface, library, report)
        for pattern in TEMPLATE_FILES:
            template = find(pattern.format(name))
            if template is not None:
                file = pattern.format(name)
                return _read_template(name, template, file, library, below | {name})
    return None


def _read_interface(name: str, source: Source, library: Library, report: Report) -> StateType:
    tree = library.parse(source, report)
    if not isinstance(tree, Map):
        span = tree.span if tree is not None else Span(source, 0, 0)
        report.append(wrong_shape(span, f"the interface of `{name}` must be a mapping"))
        return StateType(name=name, open=True)
    fields: dict[str, Tree] = {}
    for entry in field_shapes.as_map(tree, report):
        key = str(entry.key.value)
        if key not in _FIELDS:
            word = Word(key, entry.key.span)
            report.append(unknown_variable(word, "an interface", _FIELDS))
            continue
        field_shapes.READERS[_FIELDS[key]](entry.value, report)
        fields[key] = entry.value
    code = _code(fields.get("code"), report)
    given = frozenset(
        part
        for part in ("variables", "input_keys", "output_keys", "outcomes")
        if isinstance(tree := fields.get(part), Map) and tree.get("*") is not None
    )
    optional = _optional_outcomes(fields.get("outcomes"))
    return StateType(
        name=name,
        kind=_kind(fields.get("kind"), report),
        doc=field_shapes.as_text(fields["doc"], []) if "doc" in fields else "",
        variables={
            key: _variable(key, value, report) for key, value in _declared(fields.get("variables"))
        },
        input_keys=_keys(fields.get("input_keys"), report),
        output_keys=_keys(fields.get("output_keys"), report),
        outcomes=tuple(
            Outcome(name=key, doc=_doc(value), span=value.span)
            for key, value in _declared(fields.get("outcomes"))
        ),
        writes=_writes(fields, report),
        given=given,
        claims=tuple(word.text for word in field_shapes.as_names(fields["claims"], []))
        if "claims" in fields
        else (),
        blocking="blocking" in fields and field_shapes.as_flag(fields["blocking"], []),
        code=code,
        classes=_classes(fields.get("code"), report),
        body=_body(
            name, code.get("python", ""), given | ({"optional"} if optional else set()), library
        ),
        prints_itself=_prints_itself(code.get("python", ""), library),
        optional=optional,
    )


def _optional_outcomes(tree: Tree | None) -> frozenset[str]:
    """Outcomes with `optional: true`."""
    return frozenset(key for key, value in _declared(tree) if _text(value, "optional") == "True")


def _body(name: str, file: str, given: frozenset[str], library: Library) -> Body | None:
    """What the template of Python does, without what hangs on what the script declares."""
    template = library.template(file) if file and ":" not in file else None
    body = python_body(template, name) if template is not None else None
    if body is None:
        return None
    return replace(
        body,
        returns=() if {"outcomes", "optional"} & given else body.returns,
        reads=() if "input_keys" in given else body.reads,
        writes=() if {"input_keys", "output_keys"} & given else body.writes,
    )


def _code(tree: Tree | None, report: Report) -> dict[str, str]:
    """The code by language; what is to be imported has to have a name that can be."""
    found = {}
    for language, value in _declared(tree):
        if isinstance(value, Scalar):
            found[language] = str(value.value)
            names = found[language].replace(":", ".", 1).split(".")
            if language == "python" and ":" in found[language] and not all(map(_is_name, names)):
                message = f"`{value.value}` names no class of a module"
                help = "write it as `my_robot.states:Grasp`, or name the file of a template"
                report.append(wrong_shape(value.span, message, help))
    return found


def _classes(tree: Tree | None, report: Report) -> dict[str, dict[str, str]]:
    """The classes by language, where the code is said by a mapping."""
    found = {}
    for language, value in _declared(tree):
        if not isinstance(value, Map):
            continue
        given: dict[str, str] = {}
        for entry in value.entries:
            name = str(entry.key.value)
            if name not in CLASS_FIELDS:
                word = Word(name, entry.key.span)
                report.append(unknown_variable(word, "the code of a state", CLASS_FIELDS))
            elif isinstance(entry.value, Scalar):
                given[name] = str(entry.value.value)
        missing = [name for name in CLASS_FIELDS[:2] if name not in given]
        if missing:
            message = f"the code for `{language}` names no `{missing[0]}`"
            help = "write it as `{header: my_robot/grasp.hpp, class: my_robot::Grasp}`"
            report.append(wrong_shape(value.span, message, help))
        else:
            found[language] = given
    return found


def _is_name(word: str) -> bool:
    """Whether programs can have such a name."""
    return word.isidentifier() and not iskeyword(word)


def _kind(tree: Tree | None, report: Report) -> Kind:
    word = field_shapes.as_name(tree, []) if tree is not None else None
    match word.text if word is not None else "state":
        case "base":
            return "base"
        case "container":
            return "container"
        case "state":
            return "state"
    assert word is not None
    report.append(wrong_shape(word.span, "the kind is one of `state`, `container`, `base`"))
    return "state"


def _declared(tree: Tree | None) -> list[tuple[str, Tree]]:
    """The named entries of an interface's mapping, without the star."""
    if not isinstance(tree, Map):
        return []
    return [(str(entry.key.value), entry.value) for entry in tree.entries if entry.key.value != "*"]


def _text(tree: Tree, name: str) -> str:
    """The text under a name of a mapping, or nothing."""
    entry = tree.get(name) if isinstance(tree, Map) else None
    return str(entry.value.value) if entry and isinstance(entry.value, Scalar) else ""


def _doc(tree: Tree) -> str:
    return _text(tree, "doc")


def _type(tree: Tree | None, report: Report) -> Type:
    """The type an interface names: `{type: T}` or `T` alone. One it cannot read is `any`."""
    if isinstance(tree, Map):
        entry = tree.get("type")
        tree = entry.value if entry else None
    if not isinstance(tree, Scalar) or not isinstance(tree.value, str):
        return ANY
    return read_type(tree.value, Word(tree.value, tree.span), report) or ANY


def _variable(name: str, tree: Tree, report: Report) -> VariableType:
    type_ = _type(tree, report)
    default = tree.get("default") if isinstance(tree, Map) else None
    if default is not None and isinstance(default.value, Scalar) and default.value.value is None:
        # Whoever may leave it out may also write `null`.
        type_ = optional(type_)
    return VariableType(
        name=name,
        type=type_,
        required=default is None,
        doc=_doc(tree),
        default=default.value if default is not None else None,
        keys=_text(tree, "keys"),
    )


def _keys(tree: Tree | None, report: Report) -> tuple[Key, ...]:
    return tuple(
        Key(name=key, type=_type(value, report), doc=_doc(value), span=value.span)
        for key, value in _declared(tree)
    )


def _writes(fields: Mapping[str, Tree], report: Report) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The outputs by the outcome they come with; what the interface does not declare is told."""
    found = []
    for entry in field_shapes.as_map(fields["writes"], []) if "writes" in fields else ():
        outcome = Word(str(entry.key.value), entry.key.span)
        keys = field_shapes.as_names(entry.value, report)
        _declares(fields, "outcomes", "outcome", outcome, report)
        for word in keys:
            _declares(fields, "output_keys", "output key", word, report)
        if keys:
            found.append((outcome.text, tuple(word.text for word in keys)))
    return tuple(found)


def _declares(fields: Mapping[str, Tree], part: str, what: str, word: Word, report: Report) -> None:
    tree = fields.get(part)
    names = [name for name, _ in _declared(tree)]
    if word.text in names or (isinstance(tree, Map) and tree.get("*") is not None):
        return
    message = f"`{word.text}` is no {what} of the interface"
    report.append(wrong_shape(word.span, message, did_you_mean(word.text, names)))


def _prints_itself(file: str, library: Library) -> bool:
    """Whether a template, or one that it extends, has a block `body`."""
    seen: set[str] = set()
    while file and ":" not in file and file not in seen:
        seen.add(file)
        source = library.template(file) or library.template(f"{file}.py")
        if source is None:
            return False
        if smacha_meta.has_body(source):
            return True
        file = smacha_meta.extended(source)
    return False


def _read_template(
    name: str, template: Source, file: str, library: Library, below: frozenset[str]
) -> StateType:
    """The state type of a template in SMACHA's style: its meta block, else the type it extends,
    else an open one. Outcomes that neither tells may stand in its code."""
    whole = _prints_itself(file, library)
    found = smacha_meta.read_meta(template)
    extended = smacha_meta.extended(template).partition(".")[0]
    known = _find(extended, library, [], below) if extended else None
    outcomes = found.outcomes if found is not None else ()
    outcomes = outcomes or (known.outcomes if known is not None else ())
    outcomes = outcomes or smacha_meta.outcomes_in_code(template)
    if found is None:
        known = known or StateType(name=name, open=True)
        return replace(
            known, name=name, outcomes=outcomes, code={"python": file}, prints_itself=whole,
            body=None, given=known.given if known.open else _ALL_GIVEN,
            used=smacha_meta.words_used(file, library.template),
        )  # fmt: skip
    return StateType(
        name=name,
        kind=found.kind,
        doc=found.doc,
        variables={key: VariableType(name=key, required=False) for key in found.variables},
        input_keys=tuple(Key(name=word.text, span=word.span) for word in found.input_keys),
        output_keys=tuple(Key(name=word.text, span=word.span) for word in found.output_keys),
        outcomes=outcomes,
        given=_ALL_GIVEN,
        code={"python": file},
        prints_itself=whole,
        used=smacha_meta.words_used(file, library.template),
        open=found.kind == "state" and not outcomes,
    )

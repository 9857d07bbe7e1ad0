"""Readers of state types: from an interface or a template to a StateType.

An interface is a YAML file `Name.yml`, or the `{% block meta %}` of a template of SMACHA's kind. A
template without either is an open type: any field is accepted, and nothing is known of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar, get_args

from smachac.diagnostics.diagnostic import Diagnostic, Report, did_you_mean
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser_of
from smachac.frontend.errors.script import Owner, missing_variable, wrong_shape
from smachac.frontend.loader import Library
from smachac.frontend.schema import KEY_FACTS, VARIABLE_FACTS
from smachac.frontend.text.fields import as_flag, as_map, as_name, as_names, as_outcome, as_text
from smachac.frontend.text.unquoted import VARIABLE_SHAPES, check_name
from smachac.frontend.text.values import as_value
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.frontend.types import smacha_meta
from smachac.frontend.types.interface_code import (
    Section,
    class_spans,
    classes_by_language,
    code_by_language,
    declared_in,
    python_code,
)
from smachac.frontend.types.interface_fields import interface_fields
from smachac.frontend.types.type_annotations import as_record, read_type, with_types
from smachac.frontend.types.type_classes import (
    ALL_GIVEN,
    class_facts,
    facts_without_interface,
    prints_itself,
)
from smachac.frontend.types.undeclared_outputs import with_lost_outputs
from smachac.frontend.types.value_facts import (
    check_fields,
    described,
    limits_of,
    named,
)
from smachac.ir.nodes import (
    FunctionResult,
    Key,
    KeyRole,
    Outcome,
    StateKind,
    StateType,
    VariableRole,
    VariableType,
)
from smachac.ir.outcome_names import PREEMPTED, is_failure
from smachac.ir.types import ANY, Type, optional
from smachac.pysource.templates.template_sources import TEMPLATE_FILES
from smachac.records import replace

TYPE_CHECKING = False  # annotations only: most state types have no class
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFacts

_SECTIONS = ("variables", "input_keys", "output_keys", "outcomes", "writes", "code")
"""The fields of an interface that are mappings of names."""

_LISTED = frozenset(["input_keys", "output_keys", "outcomes"])
"""Those that can be lists of names too, as in a script."""

_VARIABLE_ROLES: tuple[VariableRole, ...] = get_args(VariableRole)
_KEY_ROLES: tuple[KeyRole, ...] = get_args(KeyRole)
_RESULTS: tuple[FunctionResult, ...] = get_args(FunctionResult)
_CALLED_WITH_USERDATA = ("callbacks", "conditions", "function", "duration")
"""The roles whose functions a state calls with its userdata alone."""


def find_state_type(name: str, library: Library, report: Report) -> StateType | None:
    """The state type of that name; None if there is neither interface nor template.

    The user's interface or template of that name hides a built-in one.
    """
    return _find(name, library, report, frozenset())


def _find(name: str, library: Library, report: Report, below: frozenset[str]) -> StateType | None:
    """As `find_state_type`; `below` are the types whose templates extend this one."""
    if name in below:
        return None
    for find in (library.own_template, library.template):
        interface = find(f"{name}.yml")
        if interface is not None:
            built_in = find is library.template
            found = _read_interface(name, interface, library, report, built_in=built_in)
            return replace(found, built_in=name if built_in else "")
        for pattern in TEMPLATE_FILES:
            template = find(pattern.format(name))
            if template is not None:
                file = pattern.format(name)
                return _read_template(name, template, file, library, below | {name})
    return None


def _read_interface(
    name: str, source: Source, library: Library, report: Report, *, built_in: bool
) -> StateType:
    """The state type in an interface. The classes of built-in types are not read: their interfaces
    state all that a check needs (tests/pysource/test_class_reader.py compares them)."""
    tree = library.parse(source, report)
    if not isinstance(tree, Map) and any(item.span.source == source for item in report):
        return StateType(name=name, open=True)  # its text is no YAML
    if not isinstance(tree, Map):
        span = tree.span if tree is not None else Span(source, 0, 0)
        message = f"the interface of `{name}` must be a mapping"
        help = "write it with fields such as `outcomes:`"
        report.append(wrong_shape(span, message, help, arguments=("interface", name)))
        return StateType(name=name, open=True)
    fields = interface_fields(tree, report)
    unclear = tree.get("io_keys") is not None  # reported; which keys are inputs is not known
    if "name" in fields:
        _check_own_name(fields["name"], name, report)
    sections = _sections(fields, library, report)
    code = code_by_language(sections["code"], report)
    if "python" not in code and library.template(f"{name}.tpl.py") is not None:
        code["python"] = f"{name}.tpl.py"
    parts = ("variables", "input_keys", "output_keys", "outcomes")
    given = frozenset(part for part in parts if _is_starred(sections[part]))
    optional = _optional_outcomes(sections["outcomes"])
    claims = as_names(fields["claims"], report) if "claims" in fields else ()
    is_state = not built_in and _kind(fields.get("kind"), []) == "state"
    if is_state and not unclear and "outcomes" not in fields:
        unclear = True  # no state can end without an outcome
        sections["outcomes"] = tuple(Entry(e.key, Map((), e.key.span)) for e in sections["writes"])
        if all(item.span.source is not source for item in report):
            report.append(_without_outcomes(name, tree, sections["outcomes"]))
    facts = None
    if not built_in and not unclear:
        all_given = given | ({"optional"} if optional else set())
        facts = class_facts(name, python_code(sections["code"], code, source), all_given, library)
        sections = with_lost_outputs(sections, facts, report)

    def flag(name: str) -> bool:
        return name in fields and as_flag(fields[name], report)

    return StateType(
        name=name,
        open=unclear,
        kind=_kind(fields.get("kind"), report),
        doc=as_text(fields["doc"], report) if "doc" in fields else "",
        variables=_variables(sections["variables"], report),
        input_keys=_keys(sections["input_keys"], report),
        output_keys=_keys(sections["output_keys"], report),
        outcomes=_outcomes(sections["outcomes"], report),
        needs=_needed_variables(sections, report),
        writes=_writes(sections, report),
        given=given,
        claims=tuple(word.text for word in claims),
        blocking=flag("blocking"),
        stand_in=flag("stand_in"),
        simulation=flag("simulation"),
        checks_grasp=flag("checks_grasp"),
        adds_frames=_frame_variables(fields.get("adds_frames"), sections, report),
        other_names=_other_names(fields.get("other_names"), report),
        listed_inputs=_listed_roles(sections["input_keys"], report),
        listed_outputs=_listed_roles(sections["output_keys"], report),
        code=code,
        classes=classes_by_language(sections["code"], report),
        class_spans=class_spans(sections["code"]),
        class_facts=facts,
        prints_itself=prints_itself(code.get("python", ""), library),
        optional=optional,
        secret_keys=_secret_keys(sections, report),
    )


def _sections(fields: Mapping[str, Tree], library: Library, report: Report) -> dict[str, Section]:
    """The fields that are mappings of names, with the types of the project file in place of their
    names."""
    found = {key: _section(key, fields.get(key), report) for key in _SECTIONS}
    for part in ("variables", "input_keys", "output_keys"):
        found[part] = with_types(found[part], library.types)
    return found


def _outcomes(section: Section, report: Report) -> tuple[Outcome, ...]:
    """The outcomes that an interface declares."""
    words = _outcome_words(section, report)
    return tuple(as_outcome(word, value, report, "optional", "needs") for word, value in words)


def _without_outcomes(name: str, tree: Map, used: Section) -> Diagnostic:
    """SM005 for an interface without outcomes. `used` are those in its `writes`."""
    owner = Owner(name, f"the interface `{name}`")
    example = f"[{', '.join(str(entry.key.value) for entry in used)}]" if used else ""
    return missing_variable(tree.entries[0].key.span, "outcomes", owner, example=example)


def _section(name: str, tree: Tree | None, report: Report) -> Section:
    """The entries of a field that is a mapping of names. A list of names, `[picked, lost]`, is the
    mapping `{picked: {}, lost: {}}`: nothing is stated about them."""
    if tree is None:
        return ()
    if name not in _LISTED or not isinstance(tree, Seq):
        return as_map(tree, report, "{}")
    names = [item for item in tree.items if isinstance(item, Scalar)]
    if len(names) < len(tree.items):
        return as_map(tree, report, "{}")
    words = {word.span.start for word in as_names(tree, report)}
    return tuple(Entry(item, Map((), item.span)) for item in names if item.start in words)


def _check_own_name(tree: Tree, name: str, report: Report) -> None:
    """Reports the name in an interface if it is not that of its file, by which scripts use it."""
    word = as_name(tree, report)
    if word is not None and word.text != name:
        message = f"the interface is called `{word.text}`, but its file is `{name}.yml`"
        help = f"write `name: {name}`, or rename the file to `{word.text}.yml`"
        report.append(wrong_shape(word.span, message, help, arguments=("name", word.text, name)))


def _optional_outcomes(section: Section) -> frozenset[str]:
    """Outcomes with `optional: true`."""
    return frozenset(key for key, value in declared_in(section) if _is_set(value, "optional"))


def _needed_variables(
    sections: Mapping[str, Section], report: Report
) -> dict[str, tuple[str, ...]]:
    """The variables of which an outcome needs one, by outcome; only those that are declared."""
    found: dict[str, tuple[str, ...]] = {}
    for outcome, tree in declared_in(sections["outcomes"]):
        needs = tree.get("needs") if isinstance(tree, Map) else None
        if needs is None:
            continue
        one = isinstance(needs.value, Scalar)
        words = [as_name(needs.value, report)] if one else as_names(needs.value, report)
        known = [_check_declared(sections, "variables", word, report) for word in words if word]
        found[outcome] = tuple(name for name in known if name is not None)
    return {outcome: names for outcome, names in found.items() if names}


def _frame_variables(
    tree: Tree | None, sections: Mapping[str, Section], report: Report
) -> tuple[str, ...] | None:
    """The variables that name a frame which the state adds; None if the interface has no list."""
    if tree is None:
        return None
    words = as_names(tree, report)
    for word in words:
        _check_declared(sections, "variables", word, report)
    return tuple(word.text for word in words)


def _other_names(tree: Tree | None, report: Report) -> dict[str, dict[str, str]]:
    """The names of the type in other frameworks, each with the words that have another name."""
    return {
        str(name.key.value): {
            str(word.key.value): as_text(word.value, report)
            for word in as_map(name.value, report, "{wait_time: time}")
        }
        for name in _section("other_names", tree, report)
    }


def _secret_keys(sections: Mapping[str, Section], report: Report) -> frozenset[str]:
    """The keys with `secret: true`. Another value than true or false is reported."""
    return frozenset(
        str(entry.key.value)
        for part in ("input_keys", "output_keys")
        for entry in sections[part]
        if isinstance(entry.value, Map)
        and (flag := entry.value.get("secret")) is not None
        and as_flag(flag.value, report)
    )


def _listed_roles(section: Section, report: Report) -> dict[str, KeyRole]:
    """The roles of the keys that a script adds: optional ones by name, and all others."""
    return {
        str(entry.key.value): _role(entry.value, _KEY_ROLES, report)
        for entry in section
        if entry.key.value == "*" or _is_set(entry.value, "optional")
    }


_Role = TypeVar("_Role", VariableRole, KeyRole)


def _role(tree: Tree, roles: tuple[_Role, ...], report: Report) -> _Role:
    """The role that the entry of a key or variable gives; the empty one by default. `names: frame`
    is `role: frame`."""
    entry = tree.get("role") if isinstance(tree, Map) else None
    what = named(tree, report) if entry is None else ""
    for role in roles:
        if what and role == what:
            return role
    word = as_name(entry.value, report) if entry is not None else None
    for role in roles:
        if role == (word.text if word is not None else ""):
            return role
    assert word is not None
    known = ", ".join(f"`{role}`" for role in roles if role)
    help = did_you_mean(word.text, roles) or f"the roles are {known}"
    message = f"`{word.text}` is not a role here"
    report.append(wrong_shape(word.span, message, help, arguments=("role", word.text)))
    return roles[0]


def _kind(tree: Tree | None, report: Report) -> StateKind:
    word = as_name(tree, report) if tree is not None else None
    match word.text if word is not None else "state":
        case "base":
            return "base"
        case "container":
            return "container"
        case "state":
            return "state"
    assert word is not None
    message = f"`{word.text}` is not a kind of state type"
    help = "use `state`, `container` or `base`"
    report.append(wrong_shape(word.span, message, help, arguments=("kind", word.text)))
    return "state"


def _declared_words(section: Section) -> list[tuple[Word, Tree]]:
    """The same with the places of the names."""
    named = [entry for entry in section if entry.key.value != "*"]
    return [(Word(str(entry.key.value), entry.key.span), entry.value) for entry in named]


def _outcome_words(section: Section, report: Report) -> list[tuple[Word, Tree]]:
    """The names of outcomes with what is written below each. What is written beside them and
    describes an outcome, as in `{lost: {}, failure: true}`, is reported and left out."""
    found: list[tuple[Word, Tree]] = []
    for word, tree in _declared_words(section):
        if word.text not in ("doc", "failure", "optional") or not isinstance(tree, Scalar):
            found.append((word, tree))
            continue
        text = f"{word.text}: {tree.span.text}"
        owner = found[-1][0].text if found else "OUTCOME"
        message = f"`{text}` stands beside the outcomes: it declares an outcome `{word.text}`"
        help = f"write it below the outcome that it describes: `{owner}: {{{text}}}`"
        report.append(wrong_shape(word.span, message, help, arguments=("outcomes", word.text)))
    return found


def _is_starred(section: Section) -> bool:
    """Whether a section has `"*"`: scripts add to it."""
    return any(entry.key.value == "*" for entry in section)


def _text(tree: Tree, name: str) -> str:
    """The text under a name of a mapping, or nothing."""
    entry = tree.get(name) if isinstance(tree, Map) else None
    return str(entry.value.value) if entry and isinstance(entry.value, Scalar) else ""


def _is_set(tree: Tree, name: str) -> bool:
    """Whether a mapping has `name: true`."""
    return _text(tree, name) == "True"


def _doc(tree: Tree) -> str:
    return _text(tree, "doc")


def _type(tree: Tree | None, report: Report) -> Type:
    """The type that an interface gives: `{type: T}` or `T`; `any` if it cannot be read."""
    if isinstance(tree, Map):
        entry = tree.get("type")
        tree = as_record(entry.value) if entry else None
    if isinstance(tree, Scalar) and isinstance(tree.value, bool | int | float):
        name, text = type(tree.value).__name__, tree.span.text
        help = f"write `{name}`; a default value is written `{{type: {name}, default: {text}}}`"
        message = f"`{text}` is a value, not a type"
        report.append(wrong_shape(tree.span, message, help, arguments=("type", text)))
    if not isinstance(tree, Scalar) or not isinstance(tree.value, str):
        return ANY
    word = Word(tree.value, tree.span)
    return read_type(tree.value, word, report, "`[types]` of smachac.toml") or ANY


def _variables(section: Section, report: Report) -> dict[str, VariableType]:
    for entry in section:
        if entry.key.value != "*":
            check_name(str(entry.key.value), entry.key.span, report)
    return {key: _variable(key, value, report) for key, value in declared_in(section)}


def _variable(name: str, tree: Tree, report: Report) -> VariableType:
    whose = f"the variable `{name}`"
    meant = check_fields(tree, whose, VARIABLE_FACTS, report)
    role = _role(tree, _VARIABLE_ROLES, report)
    type_ = described(_type(tree, report), tree, role, report)
    limits = limits_of(tree, type_, role, report)
    default = tree.get("default") if isinstance(tree, Map) else None
    if default is not None and isinstance(default.value, Scalar) and default.value.value is None:
        # A variable that may be left out may also be `null`.
        type_ = optional(type_)
    role = _role(tree, _VARIABLE_ROLES, report)
    return VariableType(
        name=name,
        type=type_,
        role=role,
        required=default is None and "default" not in meant,
        doc=_doc(tree),
        default=as_value(default.value) if default is not None else None,
        keys=_text(tree, "keys"),
        called_first=_is_set(tree, "called_first"),
        unquoted=_unquoted(tree, report),
        arguments=_arguments(tree, role, report),
        returns=_returns(tree, role, report),
        ros=_ros_versions(tree),
        limits=limits,
    )


def _arguments(tree: Tree, role: VariableRole, report: Report) -> tuple[str, ...] | None:
    """The arguments that the interface gives for functions in a variable; those of most roles are
    known."""
    entry = tree.get("arguments") if isinstance(tree, Map) else None
    if entry is not None:
        return tuple(word.text for word in as_names(entry.value, report))
    return ("userdata",) if role in _CALLED_WITH_USERDATA else None


def _returns(tree: Tree, role: VariableRole, report: Report) -> FunctionResult:
    """What the functions in a variable must return."""
    entry = tree.get("returns") if isinstance(tree, Map) else None
    word = as_name(entry.value, report) if entry is not None else None
    if word is None:
        return "value" if role in ("callbacks", "conditions", "duration") else ""
    for result in _RESULTS:
        if result == word.text:
            return result
    message, help = "`returns` is one of `value`, `outcome`", did_you_mean(word.text, _RESULTS)
    report.append(wrong_shape(word.span, message, help, arguments=("returns", word.text)))
    return ""


def _ros_versions(tree: Tree) -> dict[str, int]:
    """The version of ROS that a variable needs, by value; under the empty name, for any value."""
    entry = tree.get("ros") if isinstance(tree, Map) else None
    if entry is None:
        return {}
    pairs = [("", entry.value)]
    if isinstance(entry.value, Map):
        pairs = [(str(item.key.value), item.value) for item in entry.value.entries]
    return {
        value: version.value
        for value, version in pairs
        if isinstance(version, Scalar) and isinstance(version.value, int)
    }


def _unquoted(tree: Tree, report: Report) -> str:
    """The shape that an interface gives for the text of a variable; empty without one."""
    shape = _text(tree, "unquoted")
    if shape in ("", *VARIABLE_SHAPES):
        return shape
    message = "`unquoted` is one of `name`, `type`, `function`, `expression`"
    report.append(wrong_shape(tree.span, message, did_you_mean(shape, VARIABLE_SHAPES)))
    return ""


def _keys(section: Section, report: Report) -> tuple[Key, ...]:
    for entry in section:
        check_fields(entry.value, f"the key `{entry.key.value}`", KEY_FACTS, report)
    declared = _declared_words(section)
    return tuple([_key(*pair, report) for pair in declared if not _is_set(pair[1], "optional")])


def _key(name: Word, tree: Tree, report: Report) -> Key:
    role = _role(tree, _KEY_ROLES, report)
    type_ = described(_type(tree, report), tree, role, report)
    limits = limits_of(tree, type_, role, report)
    return Key(
        name=name.text,
        type=type_,
        doc=_doc(tree),
        role=role,
        limits=limits,
        frame=_text(tree, "frame"),
        secret=_is_set(tree, "secret"),
        span=name.span,
    )


def _writes(
    sections: Mapping[str, Section], report: Report
) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The outputs of each outcome. Names that the interface does not declare are reported, and
    stand for the name that is certainly meant; else the keys of such an outcome are of all."""
    found: dict[str, tuple[str, ...]] = {}
    of_all: set[str] = set()
    turned = _turned_writes(sections)
    if turned:
        report.append(_writes_by_key(sections["writes"], turned))
        return tuple((outcome, tuple(keys)) for outcome, keys in turned.items())
    for entry in sections["writes"]:
        word = Word(str(entry.key.value), entry.key.span)
        outcome = _check_declared(sections, "outcomes", word, report)
        keys = [
            _check_declared(sections, "output_keys", key, report) or key.text
            for key in as_names(entry.value, report)
        ]
        if outcome is None:
            of_all.update(keys)
        elif keys:
            found[outcome] = (*found.get(outcome, ()), *keys)
    kept = ((name, tuple(key for key in keys if key not in of_all)) for name, keys in found.items())
    return tuple((name, keys) for name, keys in kept if keys)


def _turned_writes(sections: Mapping[str, Section]) -> dict[str, list[str]]:
    """The outputs of each outcome, where `writes` has the outcomes of each output; empty if it has
    not."""
    outcomes = [name for name, _ in declared_in(sections["outcomes"])]
    outputs = [name for name, _ in declared_in(sections["output_keys"])]
    found: dict[str, list[str]] = {}
    for entry in sections["writes"]:
        key, named = str(entry.key.value), as_names(entry.value, [])
        names = [word.text for word in named]
        if key in outcomes or key not in outputs or not names or not {*names} <= {*outcomes}:
            return {}
        if not outputs or not {*outputs}.isdisjoint(names):
            return {}
        for name in names:
            found.setdefault(name, []).append(key)
    return found


def _writes_by_key(section: Section, turned: Mapping[str, list[str]]) -> Diagnostic:
    """SM004 at a `writes` that has the outcomes of each output."""
    rows = ", ".join(f"{name}: [{', '.join(keys)}]" for name, keys in turned.items())
    key = Word(str(section[0].key.value), section[0].key.span)
    message = f"`writes` begins with an outcome, but `{key.text}` is an output key"
    help = f"write `writes: {{{rows}}}`"
    return wrong_shape(key.span, message, help, arguments=("writes", key.text))


def _check_declared(
    sections: Mapping[str, Section], part: str, word: Word, report: Report
) -> str | None:
    """Reports a name that a part of the interface does not declare. The declared name that is meant
    for certain; None if there is none."""
    names = [name for name, _ in declared_in(sections[part])]
    if word.text in names or _is_starred(sections[part]):
        return word.text
    message = f"`{word.text}` is not in the `{part}` of the interface"
    left = _unwritten(sections, part)
    help = did_you_mean(word.text, names) or (f"did you mean `{left}`?" if left else None)
    help = help or f"add it to `{part}`, or remove it here"
    effect = f"only names in `{part}` have a meaning here, so no program is generated"
    arguments = (part, word.text)
    report.append(wrong_shape(word.span, message, help, arguments=arguments, effect=effect))
    return guesser_of(tuple(names)).unique_match(word.text)


def _unwritten(sections: Mapping[str, Section], part: str) -> str | None:
    """The only declared name that `writes` lacks: an output key, or an outcome that is no failure
    and does not follow a stop request."""
    writes = sections["writes"]
    names = [name for name, _ in declared_in(sections[part])]
    if part == "outcomes":
        used = {str(entry.key.value) for entry in writes}
        flags = dict(declared_in(sections[part]))
        names = [name for name in names if name != PREEMPTED and not is_failure(name)
                 and not _is_set(flags[name], "failure")]  # fmt: skip
    else:
        used = {word.text for entry in writes for word in as_names(entry.value, [])}
    left = [name for name in names if name not in used]
    return left[0] if len(left) == 1 else None


def _read_template(
    name: str, template: Source, file: str, library: Library, below: frozenset[str]
) -> StateType:
    """The state type of a template of SMACHA's kind: that of its meta block, else that of the type
    it extends, else an open one. Outcomes that are in neither are taken from its code."""
    whole = prints_itself(file, library)
    found = smacha_meta.read_meta(template)
    extended = smacha_meta.extended(template).partition(".")[0]
    known = _find(extended, library, [], below) if extended else None
    outcomes = found.outcomes if found is not None else ()
    declared = smacha_meta.class_outcomes(template)
    if declared and {outcome.name for outcome in declared} != {
        outcome.name for outcome in outcomes
    }:
        outcomes = declared  # a meta block is documentation
    outcomes = outcomes or (known.outcomes if known is not None else ())
    outcomes = outcomes or smacha_meta.outcomes_in_code(template)
    if found is None:
        known = _without_facts(known) if known else StateType(name=name, open=True)
        facts = facts_without_interface(name, file, library)
        if facts is not None and extended:
            facts = replace(facts, parameters=None)
        return replace(
            known, name=name, outcomes=outcomes, code={"python": file}, prints_itself=whole,
            variables=_parameters(facts) or known.variables, class_facts=facts,
            given=known.given if known.open else ALL_GIVEN,
            used=smacha_meta.words_used(file, library.template),
            default_keys=smacha_meta.default_keys(template) or known.default_keys,
        )  # fmt: skip
    return StateType(
        name=name,
        kind=found.kind,
        doc=found.doc,
        variables={
            key: VariableType(
                name=key,
                type=found.type_of("variables", key),
                required=False,
                default=found.defaults.get(key),
            )
            for key in found.variables
        },
        input_keys=tuple(
            Key(name=word.text, type=found.type_of("input_keys", word.text), span=word.span)
            for word in found.input_keys
        ),
        output_keys=tuple(
            Key(name=word.text, type=found.type_of("output_keys", word.text), span=word.span)
            for word in found.output_keys
        ),
        outcomes=outcomes,
        given=ALL_GIVEN,
        code={"python": file},
        prints_itself=whole,
        used=smacha_meta.words_used(file, library.template),
        default_keys=smacha_meta.default_keys(template),
        class_facts=facts_without_interface(name, file, library) if found.kind == "state" else None,
        open=found.kind == "state" and not outcomes,
        simulation=found.simulation or (known is not None and known.simulation),
    )


def _parameters(facts: ClassFacts | None) -> dict[str, VariableType]:
    """The variables of a template without an interface: the parameters of its constructor."""
    known = facts.parameters if facts is not None else None
    if not known:
        return {}
    from smachac.ir.class_facts import STATE_PARAMETERS

    return {
        parameter.word.text: VariableType(name=parameter.word.text, required=parameter.required)
        for parameter in known
        if parameter.word.text not in STATE_PARAMETERS
    }


def _without_facts(type_: StateType) -> StateType:
    """A state type of which only the interface is known, as a template that extends its template
    may do something else. It still uses the simulation."""
    variables = type_.variables.items()
    return replace(
        type_,
        built_in="",
        stand_in=False,
        adds_frames=None,
        variables={name: replace(held, role="", called_first=False) for name, held in variables},
        input_keys=tuple(replace(key, role="") for key in type_.input_keys),
        output_keys=tuple(replace(key, role="") for key in type_.output_keys),
        listed_inputs={},
        listed_outputs={},
    )

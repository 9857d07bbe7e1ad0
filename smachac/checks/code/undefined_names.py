"""Undefined names: names that code in a script uses and its Python program does not define (SM019).

The definitions of templates are approximated by their text: every word in a template of the user
counts as defined, and there are no findings if a template computes names or has `import *`.
"""

from __future__ import annotations

import ast
import builtins
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.analysis.code_slots import accepts, code_slots, parameters
from smachac.analysis.context import Context
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.code_places import attribute_place, node_place
from smachac.ir.code_slips import CONSTANTS
from smachac.ir.expressions import looks_like_expression
from smachac.ir.nodes import Data, Expression, Leaf, Machine, Node, StateType, Struct
from smachac.ir.script_code import USERDATA, script_code
from smachac.ir.traversal import expressions
from smachac.pysource.modules.library_names import (
    MODULES,
    attributes,
    is_shadowed,
    missing_name,
    only_imported,
)
from smachac.pysource.modules.ros_names import importable, message_module
from smachac.pysource.modules.user_code import UserCode
from smachac.pysource.templates.template_sources import template_sources

FUNCTIONS = tuple(name for name in dir(builtins) if name.islower() and name[0] != "_")
"""The built-in functions and types of Python."""

_MAKES_NAMES = re.compile(r"import \*|[\"']\*[\"']|\w\{\{|\}\}\w")
_BLOCK = re.compile(r"\{%[-+]?\s*(?:end)?block\b[^%]*%\}")
_WORDS = re.compile(r"[^\W\d]\w*")
_IMPORTED = re.compile(r"^[ \t]*from \S+ import (.+)$", re.M)
_FROM = re.compile(
    r"^[ \t]*from ([\w.]+) import \w+(?: as \w+)?(?:, *\w+(?: as \w+)?)*(?=[ \t]*$)", re.M
)
_DEFINED = re.compile(r"^[ \t]*(?:def|class|import|from \S+ import)\s+(\w+)|^[ \t]*(\w+) = ", re.M)


class NameFix(NamedTuple):
    """The fix of an undefined name. `why` is the fault, if it is known; `edits` correct it, if
    that is certain."""

    help: str
    why: str = ""
    edits: tuple[Edit, ...] = ()


class _Use(NamedTuple):
    """A name that code uses. `lambda_` is the function around it, if the code is one."""

    node: Node
    code: Expression
    name: ast.Name
    lambda_: ast.Lambda | None

    @property
    def span(self) -> Span:
        return node_place(self.code, self.name)


class _Attribute(NamedTuple):
    """An attribute that a module of Python's library does not have; `meant`: the one that is
    probably meant."""

    code: Expression
    module: str
    node: ast.Attribute
    meant: str


@rule(
    "SM019",
    "undefined-name",
    Severity.ERROR,
    unsuppressible=True,
    effect="Python would stop at this name with a NameError",
)
def undefined_name(context: Context) -> Iterator[Finding]:
    """An expression of the script uses a name that the generated program does not define.

    The program would stop with a NameError when it builds its machine, or at the first visit of
    the state. A text that contains a dot or a call is an expression, as in SMACHA; a text that is
    joined from params can become an expression by accident.

    Exactly: a name is defined if Python or its library has it, if it is a common name of ROS, or if
    a template of the script contains the word. A name that a common module of Python's library
    does not have is found too, as in `time.now()`.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded]
        params: {number: 2}
        userdata: {side: [block_, [params, number], .left]}
        states:
          - LOOK: {template: PrintUserdataState, input_keys: [side]}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        params: {number: 2}
        userdata: {side: ['block_', [params, number], '.left']}
        states:
          - LOOK: {template: PrintUserdataState, input_keys: [side]}
    """
    project = context.project
    if project is None:
        return
    machine, library = context.machine, project.library
    types = machine.state_types
    found = context.at_states(_names_used, types)
    used = [item for item in found if isinstance(item, _Use)]
    classes = [item for item in found if isinstance(item, Word)]
    attributes_used = [item for item in found if isinstance(item, _Attribute)]
    known = _known(machine, library) if used or classes else None
    own = _own_sources(machine, library) if used else []
    for use in used:
        if use.name.id in USERDATA or (known is not None and use.name.id not in known):
            imported = _imported(use.node, types)
            if use.name.id not in imported and not _lacks_parameter(use, types):
                fix = _import_fix(use, own, library) or _fix(use, imported) or _own_fix(use, own)
                yield _fixed(use.span, use.name.id, fix) if fix else _unknown_name(use, machine)
    yield from _missing_attributes(machine, library, attributes_used)
    for word in classes:
        if known is not None and word.text not in known:
            package = _PACKAGES.get(word.text, "my_messages")
            why = f"`{word.text}` is used here but nothing imports it"
            help = f"write its package as well, as in `{package}/{word.text}`"
            if word.text.endswith(_ENDINGS):
                why = f"`{word.text}` is a package, not a type"
                example = _EXAMPLES.get(word.text, "TYPE")
                help = f"write the type as well, as in `{word.text}/{example}`"
            yield _fixed(word.span, word.text, NameFix(help, why))


def _fixed(span: Span, name: str, fix: NameFix, effect: str | None = None) -> Finding:
    """The finding for a name whose meaning is known."""
    return Finding(
        span=span,
        message=fix.why or f"`{name}` is used here but is not defined",
        arguments=(name,),
        help=fix.help,
        edits=fix.edits,
        effect=effect,
    )


def _unknown_name(use: _Use, machine: Machine) -> Finding:
    """The finding for a name whose meaning is not known."""
    span, name, code = use.span, use.name.id, use.code.text
    if not _by_look(use.node, use.code):
        base = machine.base
        line = f"`from MODULE import {name}`"
        help = f"write {line} in the block `imports` of the template `{base}.tpl.py`"
        if base not in machine.state_types or machine.state_types[base].built_in:
            help = (
                "write `template: MyBase` at the top of the script, and in"
                " `templates/MyBase.tpl.py`"
                f' the lines `{{% extends "{base}.tpl.py" %}}`, `{{% block imports %}}`,'
                f" `{{{{ super() }}}}`, {line} and `{{% endblock %}}`"
            )
        message = f"`{name}` is used here but is not defined"
        return Finding(span=span, message=message, arguments=(name,), help=help)
    why = "a call" if code.endswith(")") else "a dot"
    message = f"`{name}` is not defined: `{code}` is an expression because it contains {why}"
    if span.text.startswith("[") and code.endswith(")"):
        help = f"import or define `{name}` in a template of the script, such as that of the base"
    elif span.text.startswith("["):
        help = "if it is text, quote a part of it: `['block_', [params, number], '.left']`"
    else:
        help = f'if it is text, write `"{code}"`; if not, define `{name}` in the base template'
    return Finding(span=span, message=message, arguments=(name, code), help=help)


def _missing_attributes(
    machine: Machine, library: UserCode, found: Sequence[_Attribute]
) -> Iterator[Finding]:
    """The attributes of modules of Python's library that these do not have."""
    if not found:
        return
    texts = [source.text for source in _own_sources(machine, library)]
    for code, module, node, meant in found:
        if only_imported(module, texts) and not is_shadowed(module, library):
            help = "correct the name"
            if meant:
                help = f"write `{meant}`" if meant.endswith(")") else f"did you mean `{meant}`?"
            why = f"the module `{module}` of Python has no `{node.attr}`"
            effect = "Python would stop at this name with an AttributeError"
            place = attribute_place(code, node)
            fix = NameFix(help, why)
            yield _fixed(place, node.attr, fix, effect)


def _names_used(
    _: str, node: Node, types: Mapping[str, StateType]
) -> Iterator[_Use | _Attribute | Word]:
    """The names that the code of a state uses from its module, the attributes that modules of the
    library do not have, and the names of types of messages."""
    for word in _message_types(node, types):
        if word.text.isidentifier() and not hasattr(builtins, word.text):
            yield word
    if isinstance(node, Leaf) and not node.type:
        return  # SM005: it is not known what its fields are
    for code in _codes(node, types):
        yield from _uses(node, code)
        if any(f"{name}." in code.text for name in MODULES):
            yield from _attributes_used(node, code)


def _attributes_used(node: Node, code: Expression) -> Iterator[_Attribute]:
    """The attributes that modules of the library do not have, with what is probably meant."""
    tree = script_code(code.text).tree
    used = [*attributes(tree)] if tree is not None else []
    keys = {key.name for key in node.inputs}
    free = {name.id for name in script_code(code.text).free_names} - keys if used else set()
    for module, attribute in used:
        meant = missing_name(module, attribute.attr) if module.partition(".")[0] in free else None
        if meant is not None:
            yield _Attribute(code, module, attribute, meant)


_PACKAGES: Mapping[str, str] = {
    **dict.fromkeys(("Empty", "SetBool", "Trigger"), "std_srvs"),
    **dict.fromkeys(("TestAction", "TwoIntsAction", "TestRequestAction"), "actionlib"),
}
"""The packages of common types of services and actions."""

_ENDINGS = ("_msgs", "_srvs", "_interfaces")
"""The ends of the names of packages with types."""

_EXAMPLES: Mapping[str, str] = {
    "std_msgs": "String",
    "std_srvs": "Trigger",
    "geometry_msgs": "PoseStamped",
    "sensor_msgs": "JointState",
}
"""A type of common packages."""


def _message_types(node: Node, types: Mapping[str, StateType]) -> Iterator[Word]:
    """The types of messages, services and actions that a built-in state type imports, if the script
    gives their package."""
    known = types.get(node.type)
    if known is None or not known.built_in or not isinstance(node, Leaf):
        return
    for held in node.variables:
        fact, data = known.variables.get(held.name), held.value.data
        if fact is not None and fact.unquoted == "type":
            text = data.text if isinstance(data, Expression) else data
            if isinstance(text, str):
                yield Word(text, held.value.span)


def _imported(node: Node, types: Mapping[str, StateType]) -> list[str]:
    """The classes that a program imports for a state."""
    found: list[str] = []
    for word in _message_types(node, types):
        *package, name = re.split(r"[/.]", word.text)
        found += [name] if package else []  # without it, the class itself is reported
        found += [f"{name.removesuffix('Action')}Goal", f"{name}Request"]
    return found


def _codes(node: Node, types: Mapping[str, StateType]) -> Iterator[Expression]:
    """The code of a state that a program contains as it is written."""
    if isinstance(node, Leaf) and node.written and not node.built_in:
        return  # its template decides how it is printed
    classes = {word.span for word in _message_types(node, types)}
    found = {code.span: code for code in expressions(node) if code.span not in classes}
    for slot in code_slots(node, types):
        if not slot.quoted:
            found.setdefault(slot.code.span, slot.code)
    yield from found.values()


def _uses(node: Node, code: Expression) -> Iterator[_Use]:
    """The names that code uses from its module, except names that every module has."""
    tree = script_code(code.text).tree  # SM016 if there is none
    function = tree if isinstance(tree, ast.Lambda) else None
    packages = _packages(tree)
    keys = {key.name for key in (*node.inputs, *node.outputs)}
    found: set[str] = set()
    for name in script_code(code.text).free_names:
        word = name.id
        known = word in packages or hasattr(builtins, word) or word in sys.stdlib_module_names
        if word in found or known:
            continue
        if function is None and (word in USERDATA or (word in keys and _is_operation(tree))):
            continue  # SM316
        if word in USERDATA and function is not None and not parameters(function):
            continue  # SM317
        found.add(word)
        yield _Use(node, code, name, function)


def _lacks_parameter(use: _Use, types: Mapping[str, StateType]) -> bool:
    """Whether the lambda around a name lacks the parameter of this name (SM317)."""
    if use.lambda_ is None or not isinstance(use.node, Leaf):
        return False
    for slot in code_slots(use.node, types):
        if slot.code.span == use.code.span and use.name.id in (slot.arguments or ()):
            return not accepts(use.lambda_, len(slot.arguments or ()))
    return False


def _packages(tree: ast.expr | None) -> set[str]:
    """The packages of messages in code, which a program imports: `std_msgs.msg.Bool()`."""
    attributes = (
        node for node in (ast.walk(tree) if tree else ()) if isinstance(node, ast.Attribute)
    )
    return {found.partition(".")[0] for found in map(message_module, attributes) if found}


def _is_operation(tree: ast.expr | None) -> bool:
    return not isinstance(tree, ast.Name | ast.Attribute | ast.Call | ast.Subscript)


def _fix(use: _Use, imported: list[str]) -> NameFix | None:
    """The cure of an undefined name, if what it means is known. `imported` are the classes that a
    program imports for the state."""
    word = use.name.id
    own = (
        [parameter.arg for parameter in parameters(use.lambda_)] if use.lambda_ is not None else []
    )
    if word in USERDATA and own:
        why = f"`{word}` is not this function's argument (`{own[0]}`)"
        return NameFix(f"write `{own[0]}`", why, _edits(use, own[0]))
    if word == "params":
        return _param_fix(use)
    if word in CONSTANTS:
        return NameFix(f"write `{CONSTANTS[word]}`", edits=_edits(use, CONSTANTS[word]))
    keys = [key.name for key in (*use.node.inputs, *use.node.outputs)]
    if own and word in keys:
        meant = f"{own[0]}.{word}"
        return NameFix(f"did you mean `{meant}`?", edits=_edits(use, meant))
    if word in keys:
        return NameFix(f"`{word}` is a key: read it as `ud.{word}` in a function, `lambda ud: ...`")
    ending = re.search("Goal$|Request$", word)
    near = next((text for text in imported if ending and text.endswith(ending[0])), None)
    if near is not None:
        return NameFix(f"did you mean `{near}`?")
    near = guesser([*own, *keys])(word) if own and not _is_called(use) else None
    if near is not None:
        return NameFix(f"did you mean `{near if near in own else f'{own[0]}.{near}'}`?")
    near = guesser(FUNCTIONS)(word)
    return NameFix(f"did you mean `{near}`?") if near is not None else None


def _own_sources(machine: Machine, library: UserCode) -> list[Source]:
    """The templates of the user that a machine needs."""
    sources = template_sources(machine, library)
    return [source for file, source in sources if library.own_template(file) is not None]


def _import_fix(use: _Use, own: Sequence[Source], library: UserCode) -> NameFix | None:
    """The cure of a name that a module of the project defines from which a template of the user
    imports other names."""
    name = use.name.id
    if name in (*USERDATA, "params") or name in {key.name for key in use.node.inputs}:
        return None
    from smachac.pysource.modules.modules import Module, load_module

    for source in own:
        for line in _FROM.finditer(source.text):
            module = load_module(line[1], library)
            if isinstance(module, Module) and not module.dynamic and name in module.names:
                return NameFix(f"write `{line[0].strip()}, {name}` in `{source.name}`")
    return None


def _own_fix(use: _Use, own: Sequence[Source]) -> NameFix | None:
    """The cure of a name that is one slip away from one that the user's templates define or
    import."""
    names: set[str] = set()
    for source in own:
        names.update(word for pair in _DEFINED.findall(source.text) for word in pair if word)
        names.update(word for line in _IMPORTED.findall(source.text)
                     for word in _WORDS.findall(line))  # fmt: skip
    near = guesser(sorted(names)).unique_match(use.name.id)
    if near is None:
        return None
    return NameFix(f"did you mean `{near}`?", edits=_edits(use, near))


def _param_fix(use: _Use) -> NameFix:
    """The cure of `params.speed` in code: a look-up."""
    tree = script_code(use.code.text).tree
    for node in ast.walk(tree) if tree is not None else ():
        match node:
            case ast.Attribute(value=ast.Name(id="params"), attr=param):
                pass
            case ast.Subscript(value=ast.Name(id="params"), slice=ast.Constant(str() as param)):
                pass
            case _:
                continue
        before, found, after = use.code.text.partition(ast.unparse(node))
        if found:
            parts = [f"'{part}'" for part in (before, after) if part]
            look_up = f"[params, {param}]"
            parts.insert(1 if before else 0, look_up)
            written = f"[{', '.join(parts)}]" if len(parts) > 1 else look_up
            return NameFix(
                f"a param is looked up outside of code: write `{written}`",
                f"`params.{param}` is used in code, which has no name `params`",
            )
    return NameFix("a param is looked up outside of code: `[params, NAME]`")


def _is_called(use: _Use) -> bool:
    tree = use.lambda_
    calls = ast.walk(tree) if tree is not None else ()
    return any(isinstance(call, ast.Call) and call.func is use.name for call in calls)


def _edits(use: _Use, text: str) -> tuple[Edit, ...]:
    """The edit that replaces all uses of a name in its code."""
    names = [name for name in script_code(use.code.text).free_names if name.id == use.name.id]
    spans = [node_place(use.code, name) for name in names]
    if any(span.text != use.name.id for span in spans):
        return ()
    return tuple(Edit(span=span, text=text) for span in spans)


def _by_look(node: Node, expression: Expression) -> bool:
    """Whether a string of the script counts as code only because of its form."""
    if isinstance(node, Leaf) and expression in _functions(node):
        return False
    written = expression.span.text
    made = written.startswith("[") and "`" not in written  # a string construct
    return made or (written == expression.text and looks_like_expression(written))


def _functions(leaf: Leaf) -> Iterator[Data]:
    """The values in the mappings of a leaf whose strings are all code."""
    for held in leaf.variables:
        if held.name == "callbacks" or held.role in ("callbacks", "conditions"):
            entries = held.value.data.entries if isinstance(held.value.data, Struct) else ()
            yield from (value for _, value in entries)


def _known(machine: Machine, library: UserCode) -> set[str] | None:
    """The defined names: the words of all templates and the names that are imported for them; None
    if a template computes names."""
    known = importable(library.ros)
    for file, source in template_sources(machine, library):
        if library.own_template(file) is None:
            known.update(word for pair in _DEFINED.findall(source.text) for word in pair if word)
        elif _MAKES_NAMES.search(source.text):
            return None
        else:
            known.update(_WORDS.findall(_BLOCK.sub("", source.text)))
    return known

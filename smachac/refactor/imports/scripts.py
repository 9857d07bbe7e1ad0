"""The scripts of machines in Python: one main script for each machine, a sub-script for each
container class, an interface for each state type."""

from __future__ import annotations

import itertools
import re
from collections import Counter
from collections.abc import Hashable, Iterable, Mapping, Sequence
from pathlib import Path

from smachac.analysis.outcome_rules import rules_of, without_end
from smachac.diagnostics.source import Span
from smachac.frontend import schema
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Iterator,
    Key,
    Leaf,
    Node,
    OutcomeRule,
    StateMachine,
)
from smachac.ir.nodes import Sequence as SequenceNode
from smachac.ir.traversal import outcome_names, outer_inputs, outer_outputs, written_children
from smachac.pysource.machines.constructions import (
    Argument,
    Callbacks,
    Construction,
    Constructions,
    Names,
    Outcomes,
)
from smachac.pysource.machines.flexbe_library import AUTONOMY, PRIORITY
from smachac.pysource.machines.yasmin_library import BLACKBOARD
from smachac.records import dataclass, field
from smachac.refactor.imports.state_types import (
    OWN_MODULE,
    StateTypes,
    in_comment,
    keys_text,
)
from smachac.refactor.imports.yaml_text import (
    data_text,
    mapping_text,
    name_text,
    names_text,
    quoted,
)

BASE = "ImportedBase"
"""The base of programs whose code names what the modules of the user contain."""


_NOTED = {
    "set_parameter": ("the call of `set_parameter`", "call it in the constructor of the class"),
    "declare_parameter": (
        "the call of `declare_parameter`", "call it in the constructor of the class"
    ),
    "set_parameter_mappings": (
        "the call of `set_parameter_mappings`", "pass the values to the constructors of the states"
    ),
    "add_input_key": (
        "the default value of a key", "write it in `userdata`, or in the constructor of the class"
    ),
    AUTONOMY: ("levels of autonomy that are not known", "write `autonomy` in the script"),
    "set_rate": ("the call of `set_rate`", "call it in the constructor of the class"),
    PRIORITY: ("the priority of the container", "pause the other states in their code"),
    BLACKBOARD: ("the values of the blackboard", "write them in `userdata` of the script"),
}  # fmt: skip
"""What is not taken over of calls that do not register functions, and what to do, by name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lost:
    """Something that was not taken over, its place, and what to do."""

    span: Span
    text: str
    help: str


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonMachine:
    """A machine to import: its name in the script, that for `--machine`, and how its states are
    made."""

    name: str
    label: str
    root: StateMachine
    constructions: Constructions


@dataclass(slots=True, kw_only=True)
class ScriptFiles:
    """The texts of a project by path, those of the main scripts, and what was not taken over.
    `modules` are those that programs import, each with its folder."""

    texts: dict[str, str] = field(default_factory=dict)
    main: dict[str, PythonMachine] = field(default_factory=dict)
    lost: list[Lost] = field(default_factory=list)
    modules: dict[str, str] = field(default_factory=dict)


def script_files(
    machines: Sequence[PythonMachine], path: Path, folder: Path, ros: int, taken: Iterable[str]
) -> ScriptFiles:
    """The project with the scripts of some machines of the file `path`. `folder` is that of the
    project, `ros` the version of ROS that the code uses, 0 for none, `taken` the names of the
    built-in state types."""
    writer = _Writer(path, folder, ros, taken)
    stems = ["main"] if len(machines) == 1 else [machine.name for machine in machines]
    writer.script_names.update(stem.casefold() for stem in stems)
    for machine, stem in zip(machines, stems, strict=True):
        writer.add(machine, stem)
    return writer.files()


class _Scope:
    """The params that a script can look up: the arguments of the container class that it is made
    of, and values that are not known. `used` are those it uses, each with its YAML in the script
    that calls it."""

    def __init__(self, around: _Scope | None, given: Mapping[str, Argument]) -> None:
        self.around = around
        self.given = given
        self.used: dict[str, str] = {}
        self.unknown: dict[Hashable, str] = {}

    def value(self, argument: Argument, writer: _Writer) -> str:
        """The YAML of an argument."""
        name = argument.parameter
        if name in self.given:
            if name not in self.used:
                self.used[name] = self._outer(self.given[name], name, writer)
            return f"[params, {name}]"
        if argument.is_known:
            return writer.data(argument)
        return f"[params, {self.param(argument, writer)}]"

    def param(self, argument: Argument, writer: _Writer) -> str:
        """The param for a value that is not known; arguments with one source have one param."""
        if argument.source not in self.unknown:
            base = re.sub(r"\W+", "_", argument.word) or "value"
            name, number = base, 2
            while name in self.given or name in self.used:
                name, number = f"{base}_{number}", number + 1
            self.unknown[argument.source] = name
            self.used[name] = self._outer(argument, name, writer)
        return self.unknown[argument.source]

    def _outer(self, argument: Argument, name: str, writer: _Writer) -> str:
        """The value of a param in the script that calls this one, or in the main script."""
        if self.around is not None:
            return self.around.value(argument, writer)
        if not (argument.is_known or argument.has_default):
            writer.lose(argument.span, f"`{argument.text}` is not known",
                        f"give the param `{name}` of the script a value")  # fmt: skip
        return writer.data(argument)


class _Writer:
    def __init__(self, path: Path, folder: Path, ros: int, taken: Iterable[str]) -> None:
        self.path, self.folder = path, folder
        self.ros = ros
        containers = (*schema.CONTAINERS, BASE)
        self.types = StateTypes(self.place, [*taken, *containers])
        self.made = ScriptFiles()
        self.sub_scripts: dict[str, str] = {}
        self.script_names: set[str] = set()
        self.used: set[str] = set()
        self.noted: set[tuple[Span, str, str]] = set()
        self.machine: PythonMachine

    def place(self, span: Span) -> str:
        """A place as text: `parcels.py:38`, from the folder of the project."""
        return f"{in_comment(span.source.name, self.folder)}:{span.line}"

    def state_place(self, span: Span) -> str:
        """The place of a state. The imported file has no folder: each file begins with its path."""
        if span.source.name != str(self.path):
            return self.place(span)
        return f"{in_comment(self.path.name, Path())}:{span.line}"

    def files(self) -> ScriptFiles:
        made = self.made
        made.texts.update(self.types.files())
        for found in self.types.known.values():
            obstacle = found.construction.obstacle
            if obstacle:
                self.lose(found.construction.span, f"the code of the state: {obstacle}",
                          f"write `execute` of `{found.name}` in {OWN_MODULE}.py")  # fmt: skip
        if self.used:
            names = sorted(self.used)
            imports = "\n".join(f"import {name}" for name in names)
            program = "ROSProgram.tpl.py" if self.ros else "Program.tpl.py"
            made.texts[f"templates/{BASE}.yml"] = (
                f"name: {BASE}\nkind: base\ncode: {{python: {BASE}.tpl.py}}\n"
            )
            made.texts[f"templates/{BASE}.tpl.py"] = (
                f'{{% extends "{program}" %}}\n{{%- block imports %}}{{{{ super() }}}}\n'
                f"{imports}\n{{%- endblock %}}\n"
            )
        return made

    def lose(self, span: Span, text: str, help: str) -> None:
        if (span, text, help) not in self.noted:
            self.noted.add((span, text, help))
            self.made.lost.append(Lost(span=span, text=text, help=help))

    def data(self, argument: Argument) -> str:
        """The YAML of a known value."""
        self.used.update(argument.modules)
        return data_text(argument.data)

    # --- scripts

    def add(self, machine: PythonMachine, stem: str) -> None:
        self.machine = machine
        self.made.modules |= machine.constructions.modules
        for name, span in machine.constructions.noted:
            self.lose(span, *_NOTED.get(name, (f"the function of `{name}`", "call it in a state")))
        for first, second, span in machine.constructions.shared:
            text = f"`{second[-1]}` and `{first[-1]}` are one object, and two in a program"
            self.lose(span, text, "keep what they share in userdata")
        root = machine.root
        names = (root.name,)
        construction = machine.constructions.states.get(names)
        scope = _Scope(None, _given(construction))
        fields = self.container_fields(names, root, scope)
        fields.pop("template")
        head = {"name": name_text(machine.name)}
        states = self.states(names, root, scope, "")
        if self.used:
            head["template"] = BASE
        elif self.ros:
            head["template"] = "ROSBase"
        if scope.used:
            fields = {"params": mapping_text(scope.used), **fields}
        lines = [f"# {self.place(root.span)}"]
        lines += [f"{key}: {text}" for key, text in {**head, **fields}.items()]
        lines += ["states:", *states]
        self.made.texts[f"{stem}.yml"] = "\n".join(lines) + "\n"
        self.made.main[f"{stem}.yml"] = machine

    def states(self, names: Names, node: Container, scope: _Scope, indent: str) -> list[str]:
        """The lines of the states of a container."""
        lines: list[str] = []
        for child in written_children(node):
            lines += self.state((*names, child.name), child, node, scope, indent)
        return lines

    def state(
        self, names: Names, node: Node, parent: Container, scope: _Scope, indent: str
    ) -> list[str]:
        inside = f"{indent}    "
        if not self.machine.constructions.same_name_exits and isinstance(parent, StateMachine):
            self.lose_exits(node, parent)
        connections = _connections(node, parent)
        states: list[str] = []
        if isinstance(node, Leaf):
            fields = self.leaf_fields(names, node, scope)
        elif names in self.machine.constructions.states:
            fields = self.call_fields(names, node, scope)
        else:
            fields = self.container_fields(names, node, scope)
            states = [f"{inside}states:", *self.states(names, node, scope, inside)]
        fields |= connections
        return [
            f"{indent}- {name_text(node.name)}:  # {self.state_place(node.span)}",
            *(f"{inside}{key}: {text}" for key, text in fields.items()),
            *states,
        ]

    def lose_exits(self, node: Node, parent: Container) -> None:
        """Outcomes without a transition that end a container in a script only."""
        led = {step.outcome for step in node.transitions}
        for outcome in outcome_names(node):
            if outcome not in led and outcome in outcome_names(parent):
                self.lose(node.span, f"after `{outcome}` of `{node.name}` FlexBE logs an error, and"
                          f" a script ends `{parent.name}`", "add a transition")  # fmt: skip

    def leaf_fields(self, names: Names, leaf: Leaf, scope: _Scope) -> dict[str, str]:
        construction = self.machine.constructions.states[names]
        found = self.types.built_in(leaf, construction)
        if found is not None:
            type_, given = found
            fields = {"template": type_}
            fields |= {name: scope.value(argument, self) for name, argument in given.items()}
            if leaf.inputs:
                fields["input_keys"] = keys_text(leaf.inputs)
            if leaf.outputs:
                fields["output_keys"] = keys_text(leaf.outputs)
            return fields
        type_, variables = self.types.of(leaf, construction)
        values = {name_text(name): scope.value(part, self) for name, part in variables.items()}
        return {"template": type_, **values}

    def call_fields(self, names: Names, node: Container, scope: _Scope) -> dict[str, str]:
        """The call of the sub-script for a container of a class of the user."""
        construction = self.machine.constructions.states[names]
        inner = _Scope(scope, _given(construction))
        fields = self.container_fields(names, node, inner)
        body = self.states(names, node, inner, "    ")
        lines = [f"    {key}: {text}" for key, text in fields.items()]
        text = "\n".join([*lines, "    states:", *body]) + "\n"
        which = f"{construction.short}\n{text}"
        if which not in self.sub_scripts:
            stem = self._script_name(construction.short)
            self.sub_scripts[which] = stem
            self.made.texts[f"{stem}.yml"] = f"- {name_text(stem)}:\n{text}"
        call = {"script": name_text(self.sub_scripts[which])}
        if inner.used:
            call["params"] = mapping_text(inner.used)
        return call

    def _script_name(self, word: str) -> str:
        base = re.sub(r"\W+", "_", word).strip("_") or "machine"
        name, number = base, 2
        while name.casefold() in self.script_names:
            name, number = f"{base}_{number}", number + 1
        self.script_names.add(name.casefold())
        return name

    # --- containers

    def container_fields(self, names: Names, node: Container, scope: _Scope) -> dict[str, str]:
        constructions = self.machine.constructions
        fields = {"template": type(node).__name__, "outcomes": names_text(outcome_names(node))}
        for word, keys in (("input_keys", node.inputs), ("output_keys", node.outputs)):
            if keys:
                fields[word] = keys_text(_unlike(keys))
        presets = constructions.userdata.get(names, ())
        if constructions.write_through and len(names) > 1:
            self.lose_userdata(names, node, presets)
        if presets:
            values = {preset.name: self.preset(preset, scope) for preset in presets}
            fields["userdata"] = mapping_text(values)
        first = next((child.name for child in written_children(node)), "")
        match node:
            case StateMachine() | SequenceNode():
                if node.initial and node.initial != first:
                    fields["initial"] = name_text(node.initial)
                if isinstance(node, SequenceNode):
                    fields["connector_outcome"] = name_text(node.connector_outcome)
            case Concurrence():
                fields |= self.concurrence_fields(names, node)
            case Iterator():
                fields |= self.iterator_fields(names, node, scope)
        return fields

    def lose_userdata(self, names: Names, node: Container, presets: Sequence[Argument]) -> None:
        """What differs where the userdata of a container is that of FlexBE."""
        inputs = {key.name for key in node.inputs}
        written = {key for child in node.children for key in outer_outputs(child)}
        if presets and not _is_entered_again(self.machine.root, names):
            written = set()
        for preset in presets:
            key = preset.name
            if key in written:
                self.lose(preset.span, f"`{key}` of `{node.name}` has this value again at each"
                          " entry", "set it in a state of the container")  # fmt: skip
            elif key in inputs:
                self.lose(preset.span, f"`{key}` of `{node.name}` keeps this value, although it is"
                          " an input", "remove the value or the input")  # fmt: skip
        if not isinstance(node, Concurrence):
            return
        uses = Counter(key for child in node.children
                       for key in {*outer_inputs(child), *outer_outputs(child)})  # fmt: skip
        for child in written_children(node):
            shared = [key for key in outer_outputs(child) if uses[key] > 1]
            if not isinstance(child, Leaf) and shared:
                keys = ", ".join(f"`{key}`" for key in shared)
                self.lose(child.span, f"the other states of `{node.name}` get {keys} of"
                          f" `{child.name}` at once, in a script at its end",
                          "set the key in a state of its own")  # fmt: skip

    def preset(self, argument: Argument, scope: _Scope) -> str:
        """A value of userdata. A mapping is written in the long form, because its own keys could
        be taken for those of that form."""
        text = scope.value(argument, self)
        return f"{{value: {text}}}" if text.startswith("{") else text

    def concurrence_fields(self, names: Names, node: Concurrence) -> dict[str, str]:
        constructions = self.machine.constructions
        callbacks = constructions.callbacks.get(names, Callbacks())
        for name, span in callbacks.lost:
            self.lose(span, f"`{name}` of `{node.name}`: its results are not known",
                      "write its rules in `outcome_map`, or `join`")  # fmt: skip
        if constructions.one_rule and (pair := _both_hold(node)) is not None:
            names_ = " and ".join(f"`{rule.outcome}`" for rule in pair)
            self.lose(pair[0].span, f"the rules of {names_} of `{node.name}` can both hold: then"
                      " YASMIN stops with an exception, and a script selects one of them",
                      "write rules of which one holds")  # fmt: skip
        fields = {}
        default = node.default_outcome
        rules = [(rule.outcome, [(part.child, part.outcome) for part in rule.when])
                 for rule in node.rules]  # fmt: skip
        made = {child.name for child in node.children} - {
            child.name for child in written_children(node)
        }
        rules = [rule for rule in rules if made.isdisjoint(child for child, _ in rule[1])]
        if callbacks.decided is not None:
            found = decided_rules(callbacks.decided, default)
            if found is not None:
                default, rules = found
            else:
                self.lose(node.span, f"`outcome_cb` of `{node.name}`: no rules select its outcomes",
                          "write a state that selects the outcome")  # fmt: skip
        if default:
            fields["default_outcome"] = name_text(default)
        if rules:
            fields["outcome_map"] = _rules_text(rules, listed=node.join == "rule")
        if node.join != "all":
            fields["join"] = node.join
        if node.join == "rule" and (ended := without_end(node, rules_of(node))) is not None:
            states = ", ".join(f"`{child}` {outcome}" for child, outcome in ended.items())
            self.lose(node.span, f"after {states} no condition of `{node.name}` holds: FlexBE does"
                      " not end it", "add a rule, or a `default_outcome`")  # fmt: skip
        return fields

    def iterator_fields(self, names: Names, node: Iterator, scope: _Scope) -> dict[str, str]:
        fields = {}
        items = self.machine.constructions.items.get(names)
        if items is not None:
            fields["it"] = scope.value(items, self)
        fields["it_label"] = name_text(node.item_key)
        fields["exhausted_outcome"] = name_text(node.exhausted_outcome)
        fields["loop_outcomes"] = names_text(node.loop_outcomes)
        if node.final_map:
            entries = {name: name_text(target) for name, target in node.final_map}
            fields["final_outcome_map"] = mapping_text(entries)
        return fields


def _given(construction: Construction | None) -> dict[str, Argument]:
    """The arguments of a constructor that have a name."""
    arguments = construction.arguments if construction is not None else ()
    return {argument.name: argument for argument in arguments if argument.name}


def _unlike(keys: Iterable[Key]) -> list[Key]:
    """Keys without two of one name."""
    return [*{key.name: key for key in keys}.values()]


def _connections(node: Node, parent: Container) -> dict[str, str]:
    """The remapping and the transitions of a state. An outcome that ends the container under its
    own name needs no transition, and neither has one that leads to the next state of a Sequence."""
    fields = {}
    remaps = {remap.key: name_text(remap.to) for remap in node.remaps if remap.key != remap.to}
    if remaps:
        fields["remapping"] = mapping_text(remaps)
    in_sequence = isinstance(parent, SequenceNode)
    steps = {
        step.outcome: name_text(step.target)
        for step in node.transitions
        if step.origin == "written" or (step.origin == "connector" and not in_sequence)
    }
    if steps:
        fields["transitions"] = mapping_text(steps)
    if node.autonomy:
        fields["autonomy"] = mapping_text({one.outcome: one.level for one in node.autonomy})
    return fields


def _is_entered_again(root: Container, names: Names) -> bool:
    """Whether a container, or one around it, can be entered more than once."""
    around = root
    for name in names[1:]:
        children = {child.name: child for child in around.children}
        seen: set[str] = set()
        todo = [step.target for step in children[name].transitions]
        while todo:
            target = todo.pop()
            if target in children and target not in seen:
                seen.add(target)
                todo += [step.target for step in children[target].transitions]
        if name in seen:
            return True
        inner = children[name]
        assert not isinstance(inner, Leaf)
        around = inner
    return False


MOST_RULES = 100
"""The most rules of a concurrence that are compared with each other."""


def _both_hold(node: Concurrence) -> tuple[OutcomeRule, OutcomeRule] | None:
    """Two rules with different outcomes of a concurrence that can hold at once."""
    for one, other in itertools.combinations(node.rules[:MOST_RULES], 2):
        ended = {part.child: part.outcome for part in one.when}
        agree = all(ended.get(part.child, part.outcome) == part.outcome for part in other.when)
        if one.outcome != other.outcome and agree:
            return one, other
    return None


Rules = list[tuple[str, list[tuple[str, str]]]]
"""Rules of a concurrence: an outcome, and the states with theirs."""


def decided_rules(decided: Mapping[Outcomes, str], default: str) -> tuple[str, Rules] | None:
    """A default outcome and rules that select what a function selects; None if there are none with
    one rule for each outcome. The declared default is preferred."""
    for other in dict.fromkeys([default, *decided.values()]):
        wanted = [outcome for outcome in dict.fromkeys(decided.values()) if outcome != other]
        rules = [(outcome, _common(decided, outcome)) for outcome in wanted]
        if all(selected(rules, other, pairs) == outcome for pairs, outcome in decided.items()):
            return other, rules
    return None


def _common(decided: Mapping[Outcomes, str], outcome: str) -> list[tuple[str, str]]:
    """What all cases with an outcome have in common."""
    cases = [set(pairs) for pairs, selected in decided.items() if selected == outcome]
    common = set.intersection(*cases)
    return sorted(common)


def selected(rules: Rules, default: str, pairs: Outcomes) -> str | None:
    """What rules select: the outcome of the one with most conditions of those that match; None if
    two of them have as many."""
    ended = set(pairs)
    matching = [(len(when), outcome) for outcome, when in rules if ended.issuperset(when)]
    most = max((count for count, _ in matching), default=0)
    best = [outcome for count, outcome in matching if count == most]
    return default if not best else best[0] if len(best) == 1 else None


def _rules_text(rules: Rules, *, listed: bool) -> str:
    """The outcome map; `listed`: as a list, as several rules can have one outcome."""
    texts = [(outcome, mapping_text({child: name_text(name) for child, name in when}))
             for outcome, when in rules]  # fmt: skip
    if not listed:
        return mapping_text(dict(texts))
    return f"[{', '.join(mapping_text({outcome: text}) for outcome, text in texts)}]"


def settings(folders: Iterable[str], ros: int) -> str:
    """The project file."""
    lines = []
    named = sorted(set(folders))
    if named:
        lines.append(f"code = [{', '.join(map(quoted, named))}]")
    if ros:
        lines.append(f"ros = {ros}")
    return "\n".join(lines) + "\n"


def state_count(root: Container) -> tuple[int, int]:
    """The numbers of states and transitions of a machine; a transition that is implied counts."""
    states = transitions = 0
    stack: list[Node] = [root]
    while stack:
        node = stack.pop()
        if isinstance(node, Leaf):
            continue
        for child in written_children(node):
            states += 1
            transitions += len(child.transitions)
            stack.append(child)
    return states, transitions

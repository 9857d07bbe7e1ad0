"""The findings of targets: unsupported parts of a script, missing code, faults in the templates and
classes of the user."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Finding, Problem, Related, Severity, problem
from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import ClassFault


@problem(
    "SM601",
    "unsupported-by-target",
    Severity.ERROR,
    effect="no program is generated for this target; other targets are not affected",
)
def unsupported_by_target(
    span: Span, target: str, message: str, help: str | None = None, names: tuple[str, ...] = ()
) -> Finding:
    """The target cannot express a part of the script.

    Python accepts any code and any type. Other languages accept portable expressions only, and
    need the type of a value before they can store it.

    Exactly: `check` reports, as a warning, what Python for the project's version of ROS (`ros` in
    the project file, 2 where it has none) does not support: variables, values, and code of the
    script and of templates that uses modules of the other version. All else, only a build reports.

    Wrong:
        name: sm
        outcomes: [succeeded]
        states:
          - COUNT:
              template: CallbacksState
              output_keys: [total]
              callbacks: {total: 'lambda ud: [x for x in range(3)]'}

    Right:
        name: sm
        outcomes: [succeeded]
        states:
          - COUNT:
              template: CallbacksState
              output_keys: [total]
              callbacks: {total: 'lambda ud: sum([0, 1, 2])'}
    """
    message = f"not supported in {target}: {message}"
    return Finding(span=span, message=message, arguments=(target, *names), help=help)


@problem(
    "SM602",
    "no-code-for-target",
    Severity.ERROR,
    effect="a program for this target could not run the state, so none is generated",
)
def no_code_for_target(
    span: Span, target: str, option: str, state_type: str, states: int
) -> Finding:
    """A state type has no code in the language of the target.

    A program could not run the state, so the build fails. The interface of a state type names its
    code for each language under `code`.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: ScriptedState, outcomes: [done]}
    """
    number = f" ({states} states use it)" if states > 1 else ""
    message = f"the state type `{state_type}` has no code for {target}{number}"
    help = f"run `smachac new state {state_type} --target {option}`: it creates a class, and prints"
    help += f" the `code` to write in `{state_type}.yml`"
    return Finding(span=span, message=message, arguments=(target, state_type), help=help)


class Difference(NamedTuple):
    """A difference between a class and its interface, at its place, and what to do; `change` is
    what to do where the interface is right."""

    word: Word
    help: str
    effect: str | None = None
    change: str = ""


@problem(
    "SM603",
    "interfaces-differ",
    Severity.ERROR,
    effect="the robot runs the class, not the interface: SMACH can stop the machine with an error",
)
def interfaces_differ(
    used: Sequence[Related],
    target: str,
    state_type: str,
    name: str,
    differences: Sequence[Difference],
) -> Finding:
    """The class of a state type and its interface have different outcomes or keys.

    The rules check the interface, but the robot runs the class: an outcome that only the class has
    leads nowhere.

    Exactly: a class is read and never run: in Python the lists that `__init__` passes to
    `smach.State`, itself or through the constructor of a base class of the project, in C++ the
    names in `Outcome`, `In` and `Out`. A part that cannot be read does not count. `check` reports a
    warning; a build for the language of the class fails.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {python: "robot_states.grasp:Grasp"}
        == robot_states/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done", "missed"])

            def execute(self, userdata):
                return "done"

    Right:
        name: sm
        outcomes: [done, lost]
        states:
          - GRASP: {template: Grasp, transitions: {missed: lost}}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}, missed: {}}
        code: {python: "robot_states.grasp:Grasp"}
        == robot_states/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done", "missed"])

            def execute(self, userdata):
                return "done"
    """
    others = f" (and {len(differences) - 1} more)" if differences[1:] else ""
    first = differences[0].word
    return Finding(
        span=first.span,
        message=f"the class `{name}` does not match `{state_type}.yml`: {first.text}{others}",
        arguments=(target, state_type, name),
        related=(*_places(differences[1:]), *used),
        help=differences[0].help,
        effect="the program does not compile"
        if target in ("cpp", "C++")
        else differences[0].effect,
    )


@problem(
    "SM604",
    "stale-code",
    Severity.ERROR,
    effect="a C++ compiler refuses the class: it has the number of another interface",
)
def stale_code(
    span: Span, state_type: str, name: str, number: Word, differences: Sequence[Difference]
) -> Finding:
    """A C++ class was written for another version of its interface.

    The class may lack an outcome or a key that the interface now has.

    Exactly: `smachac_interface` in the class is the number of the interface that it was written
    for, and the interface now has another number. `check` reports a warning; `build --target cpp`
    fails, as the compiler would.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {cpp: {header: robot_states/grasp.hpp, class: "robot_states::Grasp"}}
        == include/robot_states/grasp.hpp ==
        #include "smachac/smachac.hpp"
        namespace robot_states {
        class Grasp {
        public:
          enum class Outcome { done };
          static constexpr std::uint32_t smachac_interface = 0x12345678U;
          Outcome execute() { return Outcome::done; }
        };
        }

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {cpp: {header: robot_states/grasp.hpp, class: "robot_states::Grasp"}}
        == include/robot_states/grasp.hpp ==
        #include "smachac/smachac.hpp"
        namespace robot_states {
        class Grasp {
        public:
          enum class Outcome { done };
          static constexpr std::uint32_t smachac_interface = 0xfad787a6U;
          Outcome execute() { return Outcome::done; }
        };
        }
    """
    used = Related(span=span, message=f"this state is of the type `{state_type}`")
    cause = differences[0].word if differences else None
    known = Related(span=number.span, message=f"the number of this version is {number.text}")
    return Finding(
        span=cause.span if cause is not None else number.span,
        message=f"the class `{name}` was written for another version of `{state_type}.yml`"
        + (f": {cause.text}" if cause is not None else ""),
        arguments=(state_type, name),
        related=(*_places(differences[1:]), *([known] if cause is not None else []), used),
        help=f"{_changes(differences)}, then set `smachac_interface` to {number.text}",
    )


def _changes(differences: Sequence[Difference]) -> str:
    """What to change in a class that was written for another version of its interface."""
    changes = dict.fromkeys(each.change for each in differences[:3] if each.change)
    return "; ".join(changes) or "adapt the class to the interface"


def _places(differences: Sequence[Difference]) -> tuple[Related, ...]:
    return tuple(Related(span=each.word.span, message=each.word.text) for each in differences)


@problem("SM606", "old-python", Severity.WARNING)
def python_2_code(span: Span, old: str, new: str) -> Finding:
    """A template contains Python 2; it is printed as Python 3.

    SMACHA's templates were written when ROS used Python 2. Lines that are certainly Python 2
    (`except E, e:`, `print x`, `raise E, x`, `<>`) are translated; for other code see SM605.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded, aborted]
        states:
          - OPEN: {template: Open, transitions: {succeeded: succeeded, aborted: aborted}}
        == templates/Open.tpl.py ==
        {% extends "State.tpl.py" %}
        {% block class_defs %}
        class Open(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=['succeeded', 'aborted'])

            def execute(self, userdata):
                try:
                    return 'succeeded'
                except ValueError, error:
                    return 'aborted'
        {% endblock %}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded, aborted]
        states:
          - OPEN: {template: Open, transitions: {succeeded: succeeded, aborted: aborted}}
        == templates/Open.tpl.py ==
        {% extends "State.tpl.py" %}
        {% block class_defs %}
        class Open(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=['succeeded', 'aborted'])

            def execute(self, userdata):
                try:
                    return 'succeeded'
                except ValueError as error:
                    return 'aborted'
        {% endblock %}
    """
    return Finding(
        span=span,
        message=f"`{old}` is Python 2; the generated program has `{new}` in its place",
        arguments=(old,),
        help=f"write `{new}` in the template",
    )


@problem(
    "SM607",
    "defined-twice",
    Severity.WARNING,
    effect="Python keeps the last definition: a state that needs the other one runs wrong code",
)
def defined_twice(
    span: Span, what: str, name: str, states: tuple[tuple[str, Span], tuple[str, Span]]
) -> Finding:
    """Templates define a class or a function twice, with different code.

    All states share one module, and its last definition counts: the first state runs the code that
    was meant for the last one.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - FIRST: {template: Say, word: one, transitions: {done: SECOND}}
          - SECOND: {template: Say, word: two, transitions: {done: done}}
        == templates/Say.tpl.py ==
        {% extends "State.tpl.py" %}
        {% block class_defs %}
        class Say(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=['done'])

            def execute(self, userdata):
                print('{{ word }}')
                return 'done'
        {% endblock %}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - FIRST: {template: Say, word: one, transitions: {done: SECOND}}
          - SECOND: {template: Say, word: two, transitions: {done: done}}
        == templates/Say.tpl.py ==
        {% extends "State.tpl.py" %}
        {% block class_defs %}
        {% if 'class_Say' not in defined_headers %}
        class Say(smach.State):
            def __init__(self, word):
                smach.State.__init__(self, outcomes=['done'])
                self.word = word

            def execute(self, userdata):
                print(self.word)
                return 'done'
        {% do defined_headers.append('class_Say') %}
        {% endif %}
        {% endblock %}
        {% block body %}{{ add("Say", word) }}{% endblock %}
    """
    (first, place), (second, other) = states
    help = "write one definition for all states, with a parameter for each value that differs"
    if what == "class":
        help = (
            "write one definition for all states: give `__init__` a parameter for each value that"
            " differs, and pass the variables of the state in the template:"
            f' `{{% block body %}}{{{{ add("{name}", VARIABLE) }}}}{{% endblock %}}`'
        )
    return Finding(
        span=span,
        message=f"the {what} `{name}` is defined twice, with other code for `{second}` than for"
        f" `{first}`",
        arguments=(name, first, second),
        help=help,
        related=(
            Related(span=place, message=f"`{first}` runs the code for `{second}`"),
            Related(span=other, message=f"`{second}` defines it last"),
        ),
    )


@problem(
    "SM608",
    "code-not-found",
    Severity.ERROR,
    effect="Python raises ImportError: the program stops when it starts",
)
def code_not_found(
    fault: ClassFault, target: str, state_type: str, name: str, used: tuple[Related, ...]
) -> Finding:
    """The class that an interface names as the code of a state type does not exist, its file cannot
    be parsed, or an import in it or in a template fails, also because it is circular.

    The generated program stops when it starts.

    Exactly: of a class, its module and those of its base classes are read, of a template the block
    `imports`; there, imports of modules of the project are checked. A module is missing if the
    folder of its package has other modules, or if a module with nearly the same name exists. Other
    modules can be installed packages, which are not searched. In a circular import, a name is
    imported from a module that has begun to load and has not defined it yet. A build for another
    language than that of the class reports a warning.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grip"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done"])

            def execute(self, userdata):
                return "done"

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grasp"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done"])

            def execute(self, userdata):
                return "done"
    """
    return _class_finding(fault, target, state_type, name, used)


def class_fault(
    fault: ClassFault,
    target: str,
    state_type: str,
    name: str,
    used: tuple[Related, ...],
    lists: str = "outcomes=[...]",
) -> Diagnostic:
    """The finding for a fault of a class: SM608 for missing code, otherwise SM609."""
    if fault.kind.missing:
        return code_not_found(fault, target, state_type, name, used)
    return bad_class(fault, target, state_type, name, used, lists)


def _class_finding(
    fault: ClassFault,
    target: str,
    state_type: str,
    name: str,
    used: tuple[Related, ...],
    lists: str = "",
) -> Finding:
    """The finding for a fault of a class, in the words of its kind."""
    kind, word, near = fault.kind, fault.name.text, fault.near
    fields = {
        "word": word,
        "name": name,
        "type": state_type,
        "lists": lists,
        "near": near,
        "file": fault.file,
        "more": fault.more,
        "owner": fault.owner,
        "place": f"`{fault.file}`" if fault.file else kind.unnamed.format(type=state_type),
        "suggestion": _suggestion(word, near) if near is not None else "",
    }
    help = kind.near_help if near is not None and kind.near_help else kind.help
    return Finding(
        span=fault.name.span,
        message=kind.message.format_map(fields),
        arguments=(target, state_type, kind.name, word),
        help=fault.help or help.format_map(fields),
        effect=kind.effect.format_map(fields) if kind.effect is not None else None,
        related=used,
        severity=None if kind.missing or kind.stops else Severity.WARNING,
    )


def _suggestion(word: str, near: str) -> str:
    """The help that proposes a name, or other code, for a word."""
    if near in ("None", "True", "False"):
        return f"write `{near}`: Python has no `{word}`"
    is_code = near.startswith('"') or "." in near
    return f"write `{near}`" if is_code else f"did you mean `{near}`?"


@problem(
    "SM609",
    "unusable-class",
    Severity.ERROR,
    effect="the generated program stops with an error when it makes the state or runs it",
)
def bad_class(
    fault: ClassFault,
    target: str,
    state_type: str,
    name: str,
    used: tuple[Related, ...],
    lists: str,
) -> Finding:
    """The class of a state type does not work as a state: a method is missing or hidden, or the
    constructor does not fit the interface.

    The generated program stops with an error when it makes the state or runs it.

    Exactly: the class is read, never run. A program makes the state with the variables that a
    script sets, passed by their names. `check` reports an error if the program cannot make the
    state, or stops each time that the state runs; other faults are warnings. A build for the
    language of the class fails with all of them, a build for another language with none. Found are
    also misspelt names, names that only another function defines, usual
    modules that are not imported, methods of `self` that no class defines, methods without `()`,
    `is` with a text or a number, `==` in place of `=`, and keys that are not in a list; outcomes
    that `execute` makes and does not return, names without a value after an `except`, attributes
    that nothing sets, methods that a plain class of the project lacks, and calls with too few
    or too many arguments, also through an object or in a template. Where a name can be defined
    elsewhere, nothing is reported.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp, force: 5.0}
        == templates/Grasp.yml ==
        name: Grasp
        variables: {force: {type: float}}
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grasp"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done"])

            def execute(self, userdata):
                return "done"

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp, force: 5.0}
        == templates/Grasp.yml ==
        name: Grasp
        variables: {force: {type: float}}
        outcomes: {done: {}}
        code: {python: "cell.grasp:Grasp"}
        == cell/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self, force):
                super().__init__(outcomes=["done"])
                self.force = force

            def execute(self, userdata):
                return "done"
    """
    return _class_finding(fault, target, state_type, name, used, lists)


@problem("SM610", "param-fixed-at-build", Severity.WARNING)
def fixed_param(span: Span, field: str, param: str, value: Span) -> Finding:
    """A param is a parameter of the ROS 2 node, but one value of the program does not follow it.

    A launch file that sets the parameter changes only a part of what the script means by it.

    Exactly: params are parameters of a node where variables of states and userdata use them, also
    in lists, mappings and texts. Fixed are the fields `timeout` and `retry`, code, names of types,
    and texts, lists and mappings with a whole number that is a float elsewhere. A param that is
    fixed in all places is no parameter: a note.

    Wrong:
        name: sm
        template: ROSBase
        outcomes: [succeeded, aborted, preempted]
        params: {patience: 5.0}
        states:
          - WAIT:
              template: WaitForMsgState
              topic: battery
              msg_type: std_msgs/Float32
              timeout: [params, patience]
              transitions: {succeeded: CALL, aborted: aborted}
          - CALL:
              template: ServiceState
              service_namespace: dock
              service: std_srvs/Trigger
              timeout: [params, patience]
              transitions: {succeeded: succeeded, aborted: aborted, timeout: aborted}

    Right:
        name: sm
        template: ROSBase
        outcomes: [succeeded, aborted, preempted]
        params: {patience: 5.0}
        states:
          - WAIT:
              template: WaitForMsgState
              topic: battery
              msg_type: std_msgs/Float32
              timeout: [params, patience]
              transitions: {succeeded: CALL, aborted: aborted}
          - CALL:
              template: ServiceState
              service_namespace: dock
              service: std_srvs/Trigger
              timeout: 20s
              transitions: {succeeded: succeeded, aborted: aborted, timeout: aborted}
    """
    return Finding(
        span=span,
        message=f"the ROS parameter `{param}` does not change `{field}`: the program contains the"
        " value that `params` has when it is generated",
        arguments=(field, param),
        related=(Related(span=value, message="the value in the program"),),
        help=f"write the value itself at `{field}`, as a constant that no launch file changes",
    )


@problem(
    "SM611",
    "file-hides-module",
    Severity.ERROR,
    effect="the program imports its own file in place of that one, so none is generated",
)
def hiding_file(span: Span, file: str, hidden: str, name: str) -> Finding:
    """A generated file has the name of a module that programs import.

    Python searches the folder of a program first. A program `threading.py` ends when it starts, and
    so does each other program in its folder.

    Exactly: the names of all modules of the standard library but `wave`, `turtle`, `pipes` and
    `chunk`, of SMACH and ROS, and of the modules that the program imports, also of your classes.
    Upper and lower case do not differ: some file systems treat them as equal. Files of other
    targets may have these names; in C++, SM601 reports a header of a class that has the name of the
    generated one.

    Wrong:
        name: threading
        template: Base
        outcomes: [done]
        states:
          - WAIT: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}

    Right:
        name: threading_task
        template: Base
        outcomes: [done]
        states:
          - WAIT: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
    """
    return Finding(
        span=span,
        message=f"the file `{file}` of this machine hides the module `{hidden}`",
        arguments=(file, name),
        help=f"write another `name`, such as `{name}_task`",
    )


PROBLEMS: tuple[Problem[...], ...] = (
    unsupported_by_target,
    no_code_for_target,
    interfaces_differ,
    stale_code,
    python_2_code,
    defined_twice,
    code_not_found,
    bad_class,
    fixed_param,
    hiding_file,
)
"""The problems of this module, in the order of their codes."""

"""The findings of targets: unsupported parts of a script, missing code, and faults that only a
generated program shows."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Finding, Problem, Related, Severity, problem
from smachac.diagnostics.source import Span


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
    python_2_code,
    defined_twice,
    fixed_param,
    hiding_file,
)
"""The problems of this module, in the order of their codes."""

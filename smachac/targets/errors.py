"""The findings of targets: what a language cannot express, missing code, faults of templates and
classes of the user."""

from __future__ import annotations

from collections.abc import Sequence

from smachac.diagnostics.diagnostic import Finding, Problem, Related, Severity, problem
from smachac.diagnostics.source import Span, Word


@problem("SM601", "unsupported-by-target", Severity.ERROR)
def unsupported_by_target(
    span: Span, target: str, message: str, help: str | None = None
) -> Finding:
    """The target has no way to say what the script says.

    Python takes any code and any type. Other languages take portable expressions, and have to know
    the type of a value before they can hold it.

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
    return Finding(span=span, message=f"not for {target}: {message}", help=help)


@problem("SM602", "no-code-for-target", Severity.ERROR)
def no_code_for_target(
    span: Span, target: str, option: str, state_type: str, states: int
) -> Finding:
    """A state has code, but none in the language of the target.

    The interface of the state type tells, under `code`, where its code is for each language.

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
    number = f" ({states} states)" if states > 1 else ""
    message = f"not for {target}: the state type `{state_type}` has no code in it{number}"
    help = f"name its class under `code` in `{state_type}.yml`;"
    help += f" `smachac new state {state_type} --target {option}` begins one"
    return Finding(span=span, message=message, help=help)


@problem("SM603", "interfaces-differ", Severity.ERROR)
def interfaces_differ(
    span: Span, state_type: str, name: str, differences: Sequence[Word]
) -> Finding:
    """A class of a state type declares other outcomes or keys than the interface.

    The checker judges by the interface, the robot runs the class. Classes are read, never run: of
    Python what `__init__` hands to `smach.State`, of C++ the names in `Outcome`, `In` and `Out`;
    what cannot be read is not judged. `check` warns; a build for the language of the class fails.

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
    return Finding(
        span=span,
        message=f"`{name}` is not what `{state_type}.yml` says: {differences[0].text}{others}",
        related=_places(differences),
        help=f"change the class, or the interface in `{state_type}.yml`",
    )


@problem("SM604", "stale-code", Severity.ERROR)
def stale_code(
    span: Span, state_type: str, name: str, number: Word, differences: Sequence[Word]
) -> Finding:
    """A class of C++ was written for an interface that has changed since.

    `smachac_interface` in the class is the number of the interface it was written for. Another
    number says that somebody has to compare the two. `check` warns; `build --target cpp` fails, as
    the compiler would.

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
    told = "".join(f"{word.text}; " for word in differences) or "compare the two, "
    return Finding(
        span=span,
        message=f"`{name}` was written for another `{state_type}.yml`",
        related=(Related(span=number.span, message="the number of that"), *_places(differences)),
        help=f"{told}then set `smachac_interface` to {number.text}",
    )


def _places(differences: Sequence[Word]) -> tuple[Related, ...]:
    return tuple(Related(span=word.span, message=word.text) for word in differences)


@problem("SM606", "old-python", Severity.WARNING)
def python_2_code(span: Span, message: str) -> Finding:
    """A template holds Python 2; it is printed as Python 3.

    SMACHA's templates were written when ROS ran on Python 2. What can be told from the line alone
    (`except E, e:`, `print x`, `raise E, x`, `<>`) is translated; all else is SM605.

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
    return Finding(span=span, message=message, help="write it so in the template as well")


@problem("SM607", "defined-twice", Severity.WARNING)
def defined_twice(
    span: Span, what: str, name: str, states: tuple[tuple[str, Span], tuple[str, Span]]
) -> Finding:
    """Templates define a class or function twice, and not alike.

    All states share one module: those printed first run the code that was meant for the last.

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
        {% block body %}
        smach.{{ parent_type }}.add('{{ name }}', Say('{{ word }}'), transitions={{ transitions }})
        {% endblock %}
    """
    (first, place), (second, other) = states
    return Finding(
        span=span,
        message=f"{what} `{name}` is defined for `{first}` and otherwise for `{second}`",
        help="define it once, and give what differs to it as an argument",
        related=(
            Related(span=place, message="runs the other's code"),
            Related(span=other, message="defines it last"),
        ),
    )


PROBLEMS: tuple[Problem[...], ...] = (
    unsupported_by_target,
    no_code_for_target,
    interfaces_differ,
    stale_code,
    python_2_code,
    defined_twice,
)
"""The problems of this module, in the order of their codes."""

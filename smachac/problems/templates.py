"""The faults of the code in templates."""

from __future__ import annotations

from smachac.diagnostics import Finding, Related, Severity, problem
from smachac.source import Span


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

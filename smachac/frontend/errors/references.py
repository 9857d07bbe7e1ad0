"""The faults of names that lead to other files: sub-scripts, params, templates."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from smachac.diagnostics.diagnostic import (
    Finding,
    PathStep,
    Problem,
    Related,
    Severity,
    did_you_mean,
    problem,
)
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser_of, respelt
from smachac.diagnostics.wording import listed


def _searched(word: Word, searched: Sequence[str], known: Sequence[str]) -> str:
    # Not every place is a folder of the user: "the built-in ones" is none to be quoted.
    once = dict.fromkeys(searched)
    folders = ", ".join(at if at.startswith("the ") else f"`{at}`" for at in once)
    where = f"searched in {folders}" if folders else "there was no folder to search in"
    guess = did_you_mean(word.text, known)
    return f"{where}; {guess}" if guess else where


@problem("SM011", "script-not-found", Severity.ERROR)
def script_not_found(word: Word, searched: Sequence[str], known: Iterable[str]) -> Finding:
    """A state calls a sub-script that is in none of the folders.

    A part of the task is missing; nothing may run in its place.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {script: pick_blok, transitions: {done: done}}
        == pick_block.yml ==
        - PICK_BLOCK: {template: ScriptedState, outcomes: [done]}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {script: pick_block, transitions: {done: done}}
        == pick_block.yml ==
        - PICK_BLOCK: {template: ScriptedState, outcomes: [done]}
    """
    names = sorted(known)
    return Finding(
        span=word.span,
        message=f"there is no script `{word.text}`",
        help=_searched(word, searched, names),
        edits=respelt(word, guesser_of(tuple(names)).sure(word.text)),
    )


@problem("SM012", "recursive-include", Severity.ERROR)
def recursive_include(chain: Sequence[tuple[str, Span]]) -> Finding:
    """A sub-script calls itself, directly or through others.

    A call is replaced by what it calls, so the machine would have no end; what is to be done
    again needs a transition back.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {script: pick_block, transitions: {done: done}}
        == pick_block.yml ==
        - PICK_BLOCK:
            template: StateMachine
            outcomes: [done]
            states:
              - GRASP: {script: pick_block, transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {script: pick_block, transitions: {done: done}}
        == pick_block.yml ==
        - PICK_BLOCK:
            template: StateMachine
            outcomes: [done]
            states:
              - GRASP: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    *before, (name, place) = chain
    names = [other for other, _ in before]
    # The script that is checked is called by none: it opens the circle, but is not in the chain.
    circle = [*(names[names.index(name) :] if name in names else [name, *names]), name]
    way = " > ".join(f"`{other}`" for other in circle)
    return Finding(
        span=place,
        message=f"the script `{name}` calls itself" + (f": {way}" if circle[2:] else ""),
        help="to do a part again, lead a transition back to it",
        related=tuple(
            Related(span=at, message=f"`{other}` is called here") for other, at in before
        ),
        path=tuple(PathStep(other) for other in circle),
    )


@problem("SM013", "template-not-found", Severity.ERROR)
def template_not_found(word: Word, searched: Sequence[str], known: Iterable[str]) -> Finding:
    """A state is of a type that has neither an interface nor a template in any folder.

    There is no code for this skill: the robot could not do it.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedStat, outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    names = sorted(known)
    return Finding(
        span=word.span,
        message=f"there is no template `{word.text}`",
        help=_searched(word, searched, names),
        edits=respelt(word, guesser_of(tuple(names)).sure(word.text)),
    )


@problem("SM014", "bad-sub-script", Severity.ERROR)
def bad_sub_script(span: Span, message: str, call: Span | None = None) -> Finding:
    """What is called is not a sub-script: a list that holds one state.

    The call stands for exactly one state; of two, one would be lost.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {script: pick_block, transitions: {done: done}}
        == pick_block.yml ==
        - OPEN: {template: ScriptedState, outcomes: [done], transitions: {done: CLOSE}}
        - CLOSE: {template: ScriptedState, outcomes: [done]}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {script: pick_block, transitions: {done: done}}
        == pick_block.yml ==
        - PICK_BLOCK:
            template: StateMachine
            outcomes: [done]
            states:
              - OPEN: {template: ScriptedState, outcomes: [done], transitions: {done: CLOSE}}
              - CLOSE: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    return Finding(
        span=span,
        message=message,
        help="put states that belong together into one: `- NAME: {template: StateMachine, ...}`",
        related=(Related(span=call, message="called here"),) if call else (),
    )


@problem("SM015", "unresolved-look-up", Severity.ERROR)
def unresolved_look_up(word: Word, scope: Iterable[str]) -> Finding:
    """A look-up names a parameter that neither the state nor anything around it has.

    The value is unknown; printed as it stands it would become broken code or a wrong constant.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: ScriptedState
              doc: ['Close the ', [params, arm], ' gripper.']
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: ScriptedState
              params: {arm: left}
              doc: ['Close the ', [params, arm], ' gripper.']
              outcomes: [done]
              transitions: {done: done}
    """
    names = sorted(scope)
    params = f"in scope are the params {listed(names)}" if names else "no params are in scope here"
    return Finding(
        span=word.span,
        message=f"the look-up of `{word.text}` finds nothing",
        help=did_you_mean(word.text, names) or params,
    )


@problem("SM018", "bad-robot", Severity.ERROR)
def bad_robot(
    word: Word, message: str, help: str | None = None, related: tuple[Related, ...] = ()
) -> Finding:
    """The robot that a script names is not known, or its description cannot be read.

    Nothing that reaches the robot could be held against it: joint limits, lengths, frames. A
    description is a URDF file below the script's folder, without macros and without a document
    type.

    Wrong:
        name: sm
        template: Base
        robot: arm.urdf
        outcomes: [done]
        states:
          - MOVE: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
        == arm.urdf ==
        <robot name="arm">
          <link name="base"/><link name="hand"/>
          <joint name="elbow" type="revolute">
            <parent link="base"/><child link="hand"/>
          </joint>
        </robot>

    Right:
        name: sm
        template: Base
        robot: arm.urdf
        outcomes: [done]
        states:
          - MOVE: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
        == arm.urdf ==
        <robot name="arm">
          <link name="base"/><link name="hand"/>
          <joint name="elbow" type="revolute">
            <parent link="base"/><child link="hand"/>
            <limit lower="-1.5" upper="1.5" effort="10" velocity="1"/>
          </joint>
        </robot>
    """
    return Finding(span=word.span, message=message, help=help, related=related)


@problem("SM605", "template-error", Severity.ERROR)
def template_error(
    span: Span, message: str, help: str | None = None, names: tuple[str, ...] = ()
) -> Finding:
    """A template does not parse or render.

    A state whose template fails would be missing in the generated program.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - GREET: {template: Greet, transitions: {done: done}}
        == templates/Greet.yml ==
        name: Greet
        outcomes: {done: {}}
        == templates/Greet.tpl.py ==
        {% block class_defs %}
        class Greet(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=['done'])

            def execute(self, userdata):
                return 'done'

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - GREET: {template: Greet, transitions: {done: done}}
        == templates/Greet.yml ==
        name: Greet
        outcomes: {done: {}}
        == templates/Greet.tpl.py ==
        {% block class_defs %}
        class Greet(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=['done'])

            def execute(self, userdata):
                return 'done'
        {% endblock %}
    """
    return Finding(
        span=span,
        message=message,
        arguments=names,
        help=help or "look at this line of the template, and at the block it stands in",
    )


PROBLEMS: tuple[Problem[...], ...] = (
    script_not_found,
    recursive_include,
    template_not_found,
    bad_sub_script,
    unresolved_look_up,
    bad_robot,
    template_error,
)
"""The problems of this module, in the order of their codes."""

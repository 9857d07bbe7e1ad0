"""The faults that phases before the rules find: in the text, its shape, its calls, templates."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from smachac.diagnostics import Finding, Related, Severity, did_you_mean, problem
from smachac.source import Span, Word

MOST_LISTED = 12
"""So many names a message lists; the rest is counted."""


def listed(names: Iterable[str]) -> str:
    """Names in backticks, in the order of the alphabet, at most MOST_LISTED of them."""
    every = sorted(set(names))
    text = ", ".join(f"`{name}`" for name in every[:MOST_LISTED])
    more = len(every) - MOST_LISTED
    return f"{text} and {more} more" if more > 0 else text


def _searched(word: Word, searched: Sequence[str], known: Iterable[str]) -> str:
    folders = ", ".join(f"`{folder}`" for folder in searched)
    where = f"searched in {folders}" if folders else "there was no folder to search in"
    guess = did_you_mean(word.text, sorted(known))
    return f"{where}; {guess}" if guess else where


@problem("SM001", "yaml-syntax", Severity.ERROR)
def yaml_syntax(span: Span, message: str, help: str | None = None) -> Finding:
    """The text is not YAML.

    Nothing can be said of a script that cannot be read, and a parser that guesses would move
    a robot by a guess.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
    """
    return Finding(span=span, message=message, help=help)


@problem("SM002", "duplicate-key", Severity.ERROR)
def duplicate_key(key: Word, first: Span) -> Finding:
    """One mapping holds the same key twice.

    Most YAML readers keep the last entry and drop the first in silence: a recovery that stands
    in the script is then never run.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, empty]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, nothing]
              transitions: {done: picked, nothing: LOOK}
              transitions: {done: LOOK, nothing: empty}
          - LOOK: {template: ScriptedState, outcomes: [y, n], transitions: {y: picked, n: empty}}

    Right:
        name: sm
        template: Base
        outcomes: [picked, empty]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, nothing]
              transitions: {done: picked, nothing: LOOK}
          - LOOK: {template: ScriptedState, outcomes: [y, n], transitions: {y: picked, n: empty}}
    """
    return Finding(
        span=key.span,
        message=f"the key `{key.text}` stands here for the second time",
        help="keep one of the two, or merge them",
        related=(Related(span=first, message="first given here"),),
    )


@problem("SM003", "unknown-variable", Severity.ERROR)
def unknown_variable(word: Word, owner: str, known: Iterable[str]) -> Finding:
    """A variable is set that neither the language nor the state type has.

    It would be ignored: the speed, the limit or the transition that was meant never reaches
    the robot.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transition: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    names = sorted(known)
    variables = f"its variables are {listed(names)}" if names else "it has no variables"
    return Finding(
        span=word.span,
        message=f"`{word.text}` is not a variable of {owner}",
        help=did_you_mean(word.text, names) or variables,
    )


@problem("SM004", "wrong-shape", Severity.ERROR)
def wrong_shape(
    span: Span, message: str, help: str | None = None, related: tuple[Related, ...] = ()
) -> Finding:
    """A value has another shape than the language asks for at this place.

    A block that was left empty, or a list where a mapping is due, says nothing; read as if it
    said something, the state would end where nobody sent it.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done]
              transitions:

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: done}
    """
    return Finding(span=span, message=message, help=help, related=related)


@problem("SM005", "missing-variable", Severity.ERROR)
def missing_variable(span: Span, name: str, owner: str) -> Finding:
    """A variable is missing that the language or the state type cannot do without.

    Without it the state has no meaning, or a skill would start without the value it needs.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    return Finding(
        span=span, message=f"{owner} lacks the variable `{name}`", help=f"add `{name}:` here"
    )


@problem("SM006", "too-big", Severity.ERROR)
def too_big(span: Span, message: str, help: str | None = None) -> Finding:
    """The text is larger, deeper, or grows further by its aliases than any real script.

    A check must end on every text, also on one that somebody else sent.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata:
          a: &a [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
          b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]
          c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]
          d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]
          e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]
          f: &f [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]
          g: &g [*f, *f, *f, *f, *f, *f, *f, *f, *f, *f]
          h: &h [*g, *g, *g, *g, *g, *g, *g, *g, *g, *g]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    return Finding(span=span, message=message, help=help)


@problem("SM007", "unreadable-file", Severity.ERROR)
def unreadable_file(span: Span, message: str, help: str | None = None) -> Finding:
    """A file is missing, is a folder, is not text, or may not be read.

    A robot must not start on half of its script, so nothing is compiled.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
        == smachac.toml ==
        scripts: [no, toml]

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
        == smachac.toml ==
        scripts = ["sub_scripts"]
    """
    return Finding(span=span, message=message, help=help)


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
    return Finding(
        span=word.span,
        message=f"there is no script `{word.text}`",
        help=_searched(word, searched, known),
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
    names = [name for name, _ in chain]
    circle = names[names.index(names[-1]) :]
    way = " > ".join(f"`{name}`" for name in circle)
    calls = chain[:-1]
    return Finding(
        span=chain[-1][1],
        message=f"the script `{names[-1]}` calls itself" + (f": {way}" if circle[1:] else ""),
        help="to do a part again, lead a transition back to it",
        related=tuple(Related(span=at, message=f"`{name}` is called here") for name, at in calls),
        path=tuple(circle),
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
    return Finding(
        span=word.span,
        message=f"there is no template `{word.text}`",
        help=_searched(word, searched, known),
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
        help="a sub-script is a list with one state: `- NAME: {template: StateMachine, ...}`",
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


@problem("SM605", "template-error", Severity.ERROR)
def template_error(span: Span, message: str, help: str | None = None) -> Finding:
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
    return Finding(span=span, message=message, help=help)

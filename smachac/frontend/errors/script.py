"""The faults of texts and shapes: what is no YAML, and what stands where it cannot."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.diagnostics.diagnostic import (
    Finding,
    Problem,
    Related,
    Severity,
    did_you_mean,
    problem,
)
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import Guesser, respelt
from smachac.diagnostics.wording import listed


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
    return Finding(
        span=span,
        message=message,
        help=help or "look at the brackets, quotes and indentation just before this place",
    )


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
          - LOOK:
              template: ScriptedState
              outcomes: [seen, nothing]
              transitions: {seen: picked, nothing: empty}

    Right:
        name: sm
        template: Base
        outcomes: [picked, empty]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, nothing]
              transitions: {done: picked, nothing: LOOK}
          - LOOK:
              template: ScriptedState
              outcomes: [seen, nothing]
              transitions: {seen: picked, nothing: empty}
    """
    return Finding(
        span=key.span,
        message=f"the key `{key.text}` stands here for the second time",
        help="keep one of the two, or merge them",
        related=(Related(span=first, message="first given here"),),
    )


@problem("SM003", "unknown-variable", Severity.ERROR)
def unknown_variable(
    word: Word, owner: str, known: Iterable[str], *, anything: bool = False
) -> Finding:
    """A variable is set that neither the language nor the state type has.

    It would be ignored: the speed, the limit or the transition that was meant never reaches
    the robot. A template of SMACHA's kind takes any variable; one that it does not use is a
    warning.

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
    sure = Guesser(names).sure(word.text)
    if anything:
        return Finding(
            span=word.span,
            message=f"the template of {owner} does not use the variable `{word.text}`",
            help=f"did you mean `{sure}`?" if sure else "take it out, or use it in the template",
            severity=Severity.WARNING,
        )
    return Finding(
        span=word.span,
        message=f"`{word.text}` is not a variable of {owner}",
        help=did_you_mean(word.text, [sure] if sure else names) or variables,
        edits=respelt(word, sure),
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
def missing_variable(
    span: Span, name: str, owner: str, related: tuple[Related, ...] = ()
) -> Finding:
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
    message = f"{owner} lacks the variable `{name}`"
    return Finding(span=span, message=message, help=f"add `{name}:` here", related=related)


OTHER_NAMES = {
    "array": "list",
    "bytes": "str",
    "char": "str",
    "callable": "any",
    "dictionary": "dict",
    "double": "float",
    "enum": "one_of[a, b]",
    "function": "any",
    "map": "dict",
    "nothing": "none",
    "null": "none",
    "number": "float",
    "object": "any",
    "real": "float",
    "string": "str",
    "text": "str",
    "tuple": "list",
}
"""What other languages call these types."""


@problem("SM017", "bad-type", Severity.ERROR)
def bad_type(place: Word, known: Iterable[str], unknown: str = "") -> Finding:
    """A type cannot be read, or a word in it names no type.

    What nobody can read checks nothing, and a wrong value travels on to the robot. A word that
    only names no known type is a warning: it counts as `any`.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {width: {type: "float<m", value: 0.05}}
        states:
          - PICK:
              template: ScriptedState
              input_keys: [width]
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {width: {type: "float<m>", value: 0.05}}
        states:
          - PICK:
              template: ScriptedState
              input_keys: [width]
              outcomes: [done]
              transitions: {done: done}
    """
    word = unknown or place.text
    meant = OTHER_NAMES.get(word.casefold())
    help = f"write `{meant}`" if meant else None
    if word.isidentifier():
        help = help or did_you_mean(word, known)
    if unknown:
        return Finding(
            span=place.span,
            message=f"`{unknown}` names no type: nothing is checked of it",
            help=help or "give it under `types:`; a type of ROS is `pkg/Name`, with its package",
            severity=Severity.WARNING,
        )
    return Finding(
        span=place.span,
        message=f"`{place.text}` is not a type",
        help=help or "types read like float, float<rad>[7], list[Pose], one_of[open, close]",
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
    return Finding(
        span=span,
        message=message,
        help=help or "check the path, and that it is a text file in UTF-8",
    )


@problem("SM019", "undefined-name", Severity.ERROR)
def undefined_name(span: Span, name: str, code: str, by_look: bool) -> Finding:
    """Code of the script uses a name that nothing in its program defines.

    Text with a dot or a call in it is code, as it was for SMACHA; made from params it may become
    some by accident. The program would fail with a NameError when it builds its machine, or at the
    first visit of the state. Names are defined by the templates of a script, which are searched for
    the word, by Python and its library; the common names of ROS are imported.

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
    if not by_look:
        help = "import or define it in a template of the script, such as that of the base"
        return Finding(
            span=span, message=f"nothing defines `{name}`, which is used here", help=help
        )
    why = "a call" if code.endswith(")") else "a dot"
    message = f"nothing defines `{name}`: `{code}` is code, for it has {why} in it"
    if span.text.startswith("[") and code.endswith(")"):
        help = f"import or define `{name}` in a template of the script, such as that of the base"
    elif span.text.startswith("["):
        help = "quote a part of it, as in `['block_', [params, number], '.left']`, if it is text"
    else:
        help = f'write `"{code}"` if it is text, or define `{name}` in the template of the base'
    return Finding(span=span, message=message, help=help)


PROBLEMS: tuple[Problem[...], ...] = (
    yaml_syntax,
    duplicate_key,
    unknown_variable,
    wrong_shape,
    missing_variable,
    too_big,
    unreadable_file,
    bad_type,
    undefined_name,
)
"""The problems of this module, in the order of their codes."""

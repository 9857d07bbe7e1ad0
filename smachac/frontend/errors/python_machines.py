"""Findings about machines that are written in Python, beside those of the rules."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from smachac.diagnostics.diagnostic import (
    MOST_RELATED,
    Finding,
    Problem,
    Related,
    Severity,
    did_you_mean,
    problem,
)
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.wording import both, listed


@problem(
    "SM801",
    "text-as-list",
    Severity.ERROR,
    unsuppressible=False,
    effect="the machine stops with an error, or a state has outcomes of one letter",
)
def text_as_list(word: Word) -> Finding:
    """A text is passed where SMACH expects a list of names: each letter becomes a name.

    SMACH makes a set of what it gets, and a text is a sequence of letters. The outcome that
    `execute` returns is then not declared.

    Wrong:
        import smach

        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("STOP", smach.State(outcomes="d"), {"d": "done"})

    Right:
        import smach

        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("STOP", smach.State(outcomes=["d"]), {"d": "done"})
    """
    return Finding(
        span=word.span,
        message=f"`{word.text}` is a text, so that each letter counts as a name",
        arguments=(word.text,),
        help=f"write `[{word.span.text}]`",
    )


@problem(
    "SM802",
    "shared-transitions",
    Severity.ERROR,
    unsuppressible=False,
    effect="SMACH raises InvalidTransitionError: the program stops when it adds the second state",
)
def shared_transitions(span: Span, outcome: str, first: Span | None) -> Finding:
    """Two states get the same dictionary of transitions, and the second lacks an outcome of the
    first.

    SMACH writes the outcomes of the first state that have no transition into the dictionary it
    got. They are then transitions of the second state, which does not have these outcomes.

    Wrong:
        import smach

        table = {"ok": "done"}
        sm = smach.StateMachine(outcomes=["done", "failed"])
        with sm:
            smach.StateMachine.add(
                "CHECK", smach.State(outcomes=["far", "near"]), {"far": "GRIP", "near": "LIFT"}
            )
            smach.StateMachine.add("GRIP", smach.State(outcomes=["ok", "failed"]), table)
            smach.StateMachine.add("LIFT", smach.State(outcomes=["ok"]), table)

    Right:
        import smach

        table = {"ok": "done"}
        sm = smach.StateMachine(outcomes=["done", "failed"])
        with sm:
            smach.StateMachine.add(
                "CHECK", smach.State(outcomes=["far", "near"]), {"far": "GRIP", "near": "LIFT"}
            )
            smach.StateMachine.add("GRIP", smach.State(outcomes=["ok", "failed"]), dict(table))
            smach.StateMachine.add("LIFT", smach.State(outcomes=["ok"]), dict(table))
    """
    related = (Related(span=first, message="SMACH adds the outcome here"),) if first else ()
    return Finding(
        span=span,
        message=f"this state gets a dictionary to which SMACH has added `{outcome}`, an outcome of"
        " another state",
        arguments=(outcome,),
        help="pass a copy to each state: `transitions=dict(...)`",
        related=related,
    )


@problem(
    "SM803",
    "missing-member",
    Severity.ERROR,
    unsuppressible=False,
    effect="Python raises NameError, AttributeError or ImportError: the program stops",
)
def missing_member(module: str, words: Sequence[Word], home: str = "") -> Finding:
    """A module of the repository, or the file itself, has no such name.

    The module was read as a whole, and nothing in it can bind another name. Names of `smach` that
    are used from `smach_ros`, or the reverse, are such names too.

    Wrong:
        import smach
        import skills

        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("GRIP", skills.Grasp(), {"ok": "done"})
        == skills.py ==
        import smach


        class Grip(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=["ok"])

            def execute(self, userdata):
                return "ok"

    Right:
        import smach
        import skills

        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("GRIP", skills.Grip(), {"ok": "done"})
        == skills.py ==
        import smach


        class Grip(smach.State):
            def __init__(self):
                smach.State.__init__(self, outcomes=["ok"])

            def execute(self, userdata):
                return "ok"
    """
    first, *others = sorted(words, key=lambda word: word.span.start)
    more = sorted({word.text for word in others} - {first.text})
    names = listed([first.text, *more])
    own = module == first.span.source.name
    what, it = ("the names", "them") if more else ("the name", "it")
    help = f"correct {what}, or define {it} in the module"
    if home:
        help = f"import {it} from `{home}`"
    elif own:
        help = f"correct {what}, or import {it}"
    return Finding(
        span=first.span,
        message=f"this file has no {names}" if own else f"`{module}` has no {names}",
        arguments=(module, first.text),
        help=help,
        related=tuple(
            Related(span=word.span, message="the same here") for word in others[:MOST_RELATED]
        ),
    )


@problem("SM804", "repeated-key", Severity.ERROR, unsuppressible=False)
def repeated_key(word: Word, first: Span | None) -> Finding:
    """A dictionary of transitions or remappings has a key twice: Python keeps the last value.

    The first target is never used.

    Wrong:
        import smach

        sm = smach.StateMachine(outcomes=["done", "failed"])
        with sm:
            sm.add("GRIP", smach.State(outcomes=["ok"]), {"ok": "failed", "ok": "done"})

    Right:
        import smach

        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            sm.add("GRIP", smach.State(outcomes=["ok"]), {"ok": "done"})
    """
    related = (Related(span=first, message="the first one, which is not used"),) if first else ()
    return Finding(
        span=word.span,
        message=f"`{word.text}` is twice in this dictionary: only the last value counts",
        arguments=(word.text,),
        help="remove one of the two",
        effect="",
        related=related,
    )


@problem("SM805", "unreadable-module", Severity.WARNING)
def unreadable_module(span: Span, message: str, help: str) -> Finding:
    """A Python file with machines cannot be read, so that nothing in it is checked.

    Python 3 would refuse the file with a SyntaxError, or the file is too long or nested too deeply.

    Wrong:
        import smach

        sm = smach.StateMachine(outcomes=["done"]
        with sm:
            pass

    Right:
        import smach

        sm = smach.StateMachine(outcomes=["done"])
    """
    return Finding(span=span, message=message, arguments=(message,), help=help,
                   effect="nothing in this file is checked")  # fmt: skip


@problem(
    "SM806",
    "state-named-as-outcome",
    Severity.ERROR,
    unsuppressible=False,
    effect="the call that adds it raises an exception: the program stops",
)
def state_named_as_outcome(word: Word) -> Finding:
    """A state of a machine for YASMIN or FlexBE has the name of an outcome of the machine.

    Both refuse such a state, because a transition to this name would have two meanings.

    Wrong:
        import yasmin

        sm = yasmin.StateMachine(outcomes=["done"])
        sm.add_state("done", yasmin.CbState(["ok"], lambda blackboard: "ok"), {"ok": "done"})

    Right:
        import yasmin

        sm = yasmin.StateMachine(outcomes=["done"])
        sm.add_state("STOP", yasmin.CbState(["ok"], lambda blackboard: "ok"), {"ok": "done"})
    """
    return Finding(
        span=word.span,
        message=f"`{word.text}` is also an outcome of this machine",
        arguments=(word.text,),
        help="give the state another name, also in the transitions that lead to it",
    )


@problem(
    "SM807",
    "no-start-state",
    Severity.ERROR,
    unsuppressible=False,
    effect="`set_start_state` raises an exception: the program stops",
)
def no_start_state(word: Word) -> Finding:
    """The start state of a machine for YASMIN is not one of the states added before.

    Exactly: also a state that is added later. Without `set_start_state` the machine starts with
    the state that is added first.

    Wrong:
        import yasmin

        sm = yasmin.StateMachine(outcomes=["done"])
        sm.add_state("STOP", yasmin.CbState(["ok"], lambda blackboard: "ok"), {"ok": "done"})
        sm.set_start_state("STOPP")

    Right:
        import yasmin

        sm = yasmin.StateMachine(outcomes=["done"])
        sm.add_state("STOP", yasmin.CbState(["ok"], lambda blackboard: "ok"), {"ok": "done"})
        sm.set_start_state("STOP")
    """
    return Finding(
        span=word.span,
        message=f"the machine has no state `{word.text}` yet",
        arguments=(word.text,),
        help="correct the name, or add the state before this line",
    )


@problem(
    "SM808",
    "wrong-call",
    Severity.ERROR,
    unsuppressible=False,
    effect="the call raises an exception: the program stops",
)
def wrong_call(span: Span, kind: CallFault, names: Sequence[str]) -> Finding:
    """A call that builds a machine has arguments that the function does not accept.

    An argument is missing, there is no parameter for one, a class is passed in place of a state, a
    list in place of a dictionary, or a state is added by the method of another container or without
    an open one.

    Exactly: calls that are always made, not under an unknown condition and not in a `try`
    statement, of functions and classes that were read and of methods of the frameworks.

    Wrong:
        import smach


        class Grip(smach.State):
            def __init__(self, force):
                smach.State.__init__(self, outcomes=["ok"])

            def execute(self, userdata):
                return "ok"


        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("GRIP", Grip(), {"ok": "done"})

    Right:
        import smach


        class Grip(smach.State):
            def __init__(self, force):
                smach.State.__init__(self, outcomes=["ok"])

            def execute(self, userdata):
                return "ok"


        sm = smach.StateMachine(outcomes=["done"])
        with sm:
            smach.StateMachine.add("GRIP", Grip(5.0), {"ok": "done"})
    """
    message, help = _words_of_call(kind, names)
    return Finding(span=span, message=message, arguments=(kind, *names), help=help)


CallFault = Literal[
    "unknown argument", "too many arguments", "missing argument", "class as state",
    "no dictionary", "other container", "no container",
]  # fmt: skip
"""Why a call fails."""


def _words_of_call(kind: CallFault, names: Sequence[str]) -> tuple[str, str]:
    """The message and the help for a call that fails. `names` are the function and the argument
    with the parameters, the missing arguments, or how many it takes and gets; the class; the
    argument; or the method with its container and the one that is open."""
    first, *others = names or ("",)
    match kind:
        case "unknown argument":
            word, *known = others
            known = [name for name in known if name != "self"]
            uses = f"use one of its parameters: {listed(known)}" if known else "remove the argument"
            return f"`{first}` has no parameter `{word}`", did_you_mean(word, known) or uses
        case "too many arguments":
            most, given = others
            count = f"{given} argument{'s' * (given != '1')} without a name"
            message = f"`{first}` gets {count}, and takes at most {most}"
            return message, "remove what is too much, or pass it by its name"
        case "missing argument":
            message = f"`{first}` requires {both(others)}"
            return (
                message,
                f"pass a value, as in `{first}({others[0]}=...)`, or add a default value",
            )
        case "class as state":
            return f"`{first}` is a class, not a state", f"write `{first}()`"
        case "no dictionary":
            return f"`{first}` is a list, not a dictionary", f"write `{first}={{'...': '...'}}`"
        case "no container":
            return "no container is open here", "move the call into the `with` of its container"
        case "other container":
            (found,) = others
            message = f"the container that is open here is a {found}, not a {first}"
            method = "set_contained_state" if found == "Iterator" else "add"
            return message, f"use `smach.{found}.{method}`, or add the state in another `with`"


PROBLEMS: tuple[Problem[...], ...] = (
    text_as_list,
    shared_transitions,
    missing_member,
    repeated_key,
    unreadable_module,
    state_named_as_outcome,
    no_start_state,
    wrong_call,
)
"""The problems of this module, in the order of their codes."""

"""Errors of names that refer to other files or to params: sub-scripts, templates, robots."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import PurePath

from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    PathStep,
    Problem,
    Related,
    Severity,
    did_you_mean,
    did_you_mean_file,
    problem,
)
from smachac.diagnostics.repair import Certainty, Repair
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser, guesser_of, respelt
from smachac.diagnostics.wording import listed
from smachac.records import replace

_PACKAGE = r"package://|file://|\$\(find|\$\{|\$\("
"""The beginnings of paths that ROS replaces when a program is launched."""


def package_help(path: str) -> str | None:
    """The help for a path with a part that ROS replaces."""
    found = re.search(_PACKAGE, path)
    if found is None:
        return None
    last = path.rpartition("/")[2]
    return f"`{found[0]}` is not replaced here: write the path from this file, such as `{last}`"


def _where(
    word: Word, file: str, searched: Sequence[str], known: Sequence[str], setting: str, other: str
) -> str:
    """The help for a file that was not found: `other`, a folder that has it but was not searched,
    with the setting that would add it; or the folders that were searched, and a near name."""
    if other:
        return (
            f"`{other}` has `{word.text}`, but is not searched: write `--{setting} {other}`, or add"
            f" the folder to `{setting} = [...]` in `smachac.toml`"
        )
    folders = ", ".join(f"`{folder}`" for folder in dict.fromkeys(searched))
    what = "it" if "/" in file else f"`{file}`"
    where = f"put {what} in one of the folders that were searched: {folders}"
    where = where if folders else "add a folder for it to the project file"
    guess = did_you_mean_file(word.text, known)
    return f"{guess} (searched in {folders})" if guess and folders else guess or where


@problem(
    "SM011",
    "script-not-found",
    Severity.ERROR,
    effect="a part of the task is missing without the sub-script, so no program is generated",
)
def script_not_found(
    word: Word,
    searched: Sequence[str],
    known: Iterable[str],
    other: str = "",
    *,
    template: bool = False,
) -> Finding:
    """A state calls a sub-script that is in none of the searched folders.

    A part of the task is missing, and nothing else may run in its place.

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
    help = f"`{word.text}` is a state type: write `template: {word.text}`" if template else None
    return Finding(
        span=word.span,
        message=f"the sub-script `{word.text}` was not found",
        arguments=(word.text,),
        help=help
        or _package_of(word)
        or _where(word, f"{word.text}.yml", searched, names, "scripts", other),
        edits=respelt(word, guesser_of(tuple(names)).unique_match(word.text)),
    )


def _package_of(word: Word) -> str | None:
    """The help for the call of a sub-script by a path with a part that ROS replaces."""
    if package_help(word.text) is None:
        return None
    name = PurePath(word.text).stem
    return f"write `script: {name}`, and add its folder to `scripts = [...]` in `smachac.toml`"


@problem(
    "SM012",
    "recursive-include",
    Severity.ERROR,
    effect="each call is replaced by its sub-script, so the machine would be infinitely large",
)
def recursive_include(chain: Sequence[tuple[str, Span]]) -> Finding:
    """A script calls itself, directly or through other sub-scripts.

    A call is replaced by the state that it calls, so the machine would be infinitely large. To
    repeat a part of the task, a script needs a transition back.

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
    # The chain has no call of the main script; a circle through that script begins with it.
    circle = [*(names[names.index(name) :] if name in names else [name, *names]), name]
    way = " > ".join(f"`{other}`" for other in circle)
    return Finding(
        span=place,
        message=f"the script `{name}` calls itself" + (f": {way}" if circle[2:] else ""),
        arguments=tuple(PurePath(other).name for other in circle),
        help="remove this call; to repeat a part of the task, add a transition back to it",
        related=tuple(
            Related(span=at, message=f"`{other}` is called here") for other, at in before
        ),
        path=tuple(PathStep(other) for other in circle),
    )


@problem(
    "SM013",
    "template-not-found",
    Severity.ERROR,
    effect="there is no code for this state, so no program is generated",
)
def template_not_found(
    word: Word, searched: Sequence[str], known: Iterable[str], other: str = "", help: str = ""
) -> Finding:
    """The type of a state has neither an interface nor a template in any folder.

    There is no code for this skill, so the robot could not execute it.

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
        message=f"the template `{word.text}` was not found",
        arguments=(word.text,),
        help=help or _where(word, f"{word.text}.yml", searched, names, "templates", other),
        edits=() if help else respelt(word, guesser_of(tuple(names)).unique_match(word.text)),
    )


@problem(
    "SM014",
    "bad-sub-script",
    Severity.ERROR,
    effect="smachac replaces a call by exactly one state, so no program is generated",
)
def bad_sub_script(
    span: Span, message: str, call: Span, help: str, *, arguments: tuple[str, ...]
) -> Finding:
    """A called file is not a sub-script, that is, a list with one state.

    A call stands for exactly one state. If the file had two states, one of them would be lost.

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
        arguments=arguments,
        help=help,
        related=(Related(span=call, message="called here"),),
    )


@problem(
    "SM015",
    "unresolved-look-up",
    Severity.ERROR,
    effect="the value is unknown, so no program is generated",
)
def unresolved_look_up(word: Word, scope: Iterable[str], inverted: str | None = None) -> Finding:
    """A look-up names a param that is not in scope.

    The value is unknown. In the generated program the look-up would be a wrong constant or invalid
    code. In scope are the params of the state, of its containers, and of the calls around it.

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
    help = f"add `{word.text}: ...` to the `params` of the script"
    if names:
        others = f"{help}; in scope are {listed(names)}"
        help = did_you_mean(word.text, names) or others
    if inverted:
        help = f"write `{word.text}: {inverted}` in `params`: the name of the param comes first"
    return Finding(
        span=word.span,
        message=f"the param `{word.text}` is not in scope here",
        arguments=(word.text,),
        help=help,
    )


def param_before_definition(word: Word, defined: Span) -> Diagnostic:
    """SM015 for a look-up in a param that names a later param of the same mapping."""
    help = f"move `{word.text}` before this param: a param can use only those above it"
    if defined.source is not word.span.source:  # a call of the sub-script defines it
        help = f"add `{word.text}: ...` above this param, as the default value that a call replaces"
    item = unresolved_look_up(word, ())
    changed = replace(
        item.finding,
        message=f"the param `{word.text}` is used before it is defined",
        help=help,
        related=(Related(span=defined, message="defined here"),),
    )
    return replace(item, finding=changed)


def look_up_of_call(
    word: Word,
    script: Word,
    state: str,
    idle: Sequence[Word],
    inverted: str | None,
    places: Sequence[Word],
) -> Diagnostic:
    """SM015 for a look-up in a sub-script, at its call: `script` is its name and the place of the
    call by `state`, `idle` are the params of the call that the sub-script does not read, `inverted`
    is the one that has the name of the param as its value, `places` are its look-ups."""
    name = word.text
    near = inverted or guesser(word.text for word in idle)(name)
    wrong = next((word for word in idle if word.text == near), idle[0] if len(idle) == 1 else None)
    help = f"add `{name}: ...` to the `params` of `{state}`, of a container around it,"
    help += " or of the script"
    if wrong is not None and inverted:
        help = f"write `{name}: {inverted}`: the name of the param comes first"
    elif wrong is not None:
        other = f"write `{name}:` in place of `{wrong.text}:`, or add it"
        help = f"did you mean `{name}`?" if near else other
    renamed = [
        (respelt(word, name), [edit for one in places for edit in respelt(one, word.text)])
        for word in idle[:MOST_GIVEN]
    ]
    item = unresolved_look_up(word, ())
    finding = Finding(
        span=script.span if wrong is None else wrong.span,
        message=f"the sub-script `{script.text}` reads the param `{name}`, which `{state}` does not"
        " give",
        arguments=(name, script.text),
        help=help,
        effect=f"`{name}` has no value in `{script.text}`, so no program is generated",
        related=(Related(span=word.span, message=f"it reads `{name}` here"),),
        edits=respelt(wrong, name) if wrong is not None and near and not inverted else (),
        repairs=tuple(
            Repair(edits=(*edits,), certainty=Certainty.LIKELY, operator="write another name")
            for pair in renamed
            for edits in pair
            if edits
        ),
    )
    return replace(item, finding=finding)


MOST_GIVEN = 3
"""The most params of a call for which repairs are proposed."""


@problem(
    "SM018",
    "bad-robot",
    Severity.ERROR,
    effect="the robot is not known: no motion is checked, and no program is generated",
)
def bad_robot(
    word: Word,
    message: str,
    help: str | None = None,
    related: tuple[Related, ...] = (),
    *,
    arguments: tuple[str, ...],
    effect: str | None = None,
) -> Finding:
    """The robot of a script is not known, or its description cannot be read.

    Without a description, values for the robot are not compared with its joint limits, lengths and
    frames.

    Exactly: a description, a URDF file or a xacro file is in or below the script's folder. A URDF
    file is a tree of links in the format of URDF 1.0 to 1.2, without a document type; with a
    description, the simulation can load it, with all its meshes.

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
    return Finding(
        span=word.span,
        message=message,
        arguments=arguments,
        help=help,
        related=related,
        effect=effect,
    )


@problem(
    "SM605",
    "template-error",
    Severity.ERROR,
    effect="the code of the state is missing, so no program is generated",
)
def template_error(
    span: Span, message: str, help: str | None = None, names: tuple[str, ...] = ()
) -> Finding:
    """A template does not parse or render.

    A state whose template fails would be missing in the generated program.

    Exactly: a warning for a misspelt block, whose text no program contains, and for a misspelt
    variable in a test `is defined`, whose part no program contains; also for a template that does
    not print the remapping or the transitions of a state.

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

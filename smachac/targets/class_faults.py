"""The words for faults of classes (SM609): what is wrong, and what to write."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.ir.class_facts import ClassFault, FaultKind

WORDS: Mapping[FaultKind, tuple[str, str]] = {
    "no state": (
        "the class `{name}` is not derived from `smach.State`",
        "write `class {word}(smach.State):`",
    ),
    "no execute": (
        "the class `{name}` has no method `execute`",
        "add the method `execute`, which returns an outcome",
    ),
    "no method": (
        "`execute` of `{name}` returns a generator, not an outcome",
        "write `return` in place of `yield`",
    ),
    "coroutine": (
        "`execute` of `{name}` returns a coroutine, not an outcome",
        "write `def execute(self, userdata):`, and `asyncio.run(...)` for what it awaits",
    ),
    "arguments": (
        "`execute` of `{name}` must accept exactly one argument: the userdata",
        "write `def execute(self, userdata):`",
    ),
    "no constructor call": (
        "`__init__` of `{name}` does not call `__init__` of `smach.State`",
        "write `super().__init__({lists})` as the first line of `__init__`",
    ),
    "no base constructor call": (
        "`__init__` of `{name}` does not call `__init__` of its base class",
        "write `{near}` as the first line of `__init__`",
    ),
    "no outcomes": (
        "the class `{name}` has no `__init__`, so the state has no outcomes",
        "add `def __init__(self):` with the line `super().__init__({lists})`",
    ),
    "data class": (
        "the `__init__` that `@dataclass` makes for `{name}` does not call that of `smach.State`",
        "add `def __post_init__(self):` with the line `super().__init__({lists})`",
    ),
    "self twice": (
        "`super()` passes `{word}` already: here it is passed twice",
        "remove `{word}`: write `super().__init__({lists})`",
    ),
    "no self": (
        "`smach.State.__init__` is called without `{word}`",
        "write `super().__init__({lists})`",
    ),
    "other class": (
        "`super({word}, ...)` is in the class `{near}`, which is not derived from `{word}`",
        "write `super().__init__({lists})`",
    ),
    "hidden method": (
        "`self.{word}` hides the method `{word}` of `smach.State`, which SMACH calls",
        "give the attribute another name, such as `self.own_{word}`",
    ),
    "undefined name": (
        "`{word}` is used in `{name}`, but nothing defines it",
        "define it in the module, or import it",
    ),
    "other scope": (
        "`{word}` is not visible here: only another function of the file defines it",
        "write `self.{word}` in both places, or define `{word}` in this method",
    ),
    "other userdata": (
        "the parameter of `execute` is `{word}`, but its code uses `{near}`",
        "write `def execute(self, {near}):`",
    ),
    "lost argument": (
        "`{word}` is a parameter of `__init__`, which this method cannot use",
        "write `self.{word} = {word}` in `__init__`, and `self.{word}` here",
    ),
    "lost userdata": (
        "`{word}` is a parameter of `execute`, which this method cannot use",
        "write `{near}`, and pass `{word}` in `execute`",
    ),
    "early userdata": (
        "`{word}` is a parameter of `execute`, but `{more}` runs when the program makes the state",
        "a state has no userdata before it runs: write `{near}` in `execute`",
    ),
    "super not called": (
        "`super` without `()` is not the base class of `{name}`",
        "write `super()`",
    ),
    "no self parameter": (
        "the method `{word}` uses `self`, but has no parameter `self`",
        "write `{near}`",
    ),
    "no import": (
        "`{word}` is used in this file, but not imported",
        "write `import {word}` at the top of the file",
    ),
    "no rospy import": (
        "`{word}` is used in this file, but not imported",
        "in ROS 1 write `import rospy` at the top of the file; ROS 2 has no `rospy`: there write"
        " `time.sleep(...)` for `rospy.sleep(...)`",
    ),
    "wrong import": (
        "the file imports `{word}`, but uses `{near}`",
        "write `import {near}`",
    ),
    "undefined method": (
        "neither `{name}` nor `smach.State` defines `{word}`",
        "define `{word}` in the class, or correct the name",
    ),
    "no attribute": (
        "the module `{file}` of Python has no `{word}`",
        "correct the name",
    ),
    "unset attribute": (
        "`self.{word}` of `{name}` is never set",
        "write `self.{word} = {word}` in `__init__`",
    ),
    "never set": (
        "`self.{word}` of `{name}` is never set",
        "write `self.{word} = {near}` in `__init__`",
    ),
    "no list": (
        "`{word}` of `{name}` must be a list: SMACH cannot use another collection",
        "write `{word}=[...]`",
    ),
    "no comma": (
        "a comma is missing: Python joins the two texts to `{word}`",
        "write `{near}`",
    ),
    "no tuple": (
        "`{word}` is a text, but `{name}` uses it as a list of names: only a comma makes a tuple",
        "write `{near}`",
    ),
    "no result": (
        "`{word}` changes a collection and returns None: `{owner}` becomes None",
        "write `{near}`",
    ),
    "no return": (
        "`{word}` never returns a value, but `{name}` uses the result of `{more}`",
        "end `{word}` with `return ...`",
    ),
    "no argument": (
        "`smach.State.__init__` has no argument `{word}`",
        "its arguments are `outcomes`, `input_keys`, `output_keys` and `io_keys`",
    ),
    "no base argument": (
        "`__init__` of `{owner}` has no parameter `{word}`",
        "its parameters are {more}",
    ),
    "argument twice": (
        "`__init__` of `{owner}` gets `{word}` twice: by its place, and by its name",
        "remove one of the two arguments",
    ),
    "too many arguments": (
        "`__init__` of `{owner}` has no parameter for `{word}`",
        "its parameters are {more}",
    ),
    "missing base argument": (
        "`__init__` of `{owner}` requires {more}, which this call does not pass",
        "its parameters are {near}",
    ),
    "other lists": (
        "the outcomes `{word}` are passed as `{more}` of `__init__` of `{owner}`, and `{file}` as"
        " `outcomes`",
        "pass them in the order of its parameters: {near}",
    ),
    "no state class": (
        "`{word}` is not a class of SMACH",
        "write `{near}`",
    ),
    "not called": (
        "`{word}` without `()` does not call the method",
        "write `{near}`",
    ),
    "function not called": (
        "`{word}` without `()` does not call the function",
        "write `{near}`",
    ),
    "no effect": (
        "the line `{word}` does nothing: without `()` a method is not called",
        "write `{near}`, or remove the line",
    ),
    "no answer": (
        "the line `{word}` does nothing: without `()` a method is not called",
        "write `{near}`",
    ),
    "identity": (
        "`is` compares objects, not values: two equal values can be two objects",
        "write `{near}`",
    ),
    "comparison": (
        "`==` compares, and nothing uses the result: `{word}` is not set",
        "write `{near}`",
    ),
    "lost outcome": (
        "the result of `{word}` ({more}) is not used",
        "write `{near}`",
    ),
    "lost text": (
        "the line `{word}` does nothing: `execute` goes on",
        "write `return {word}`",
    ),
    "no value": (
        "`{word}` has no value here if `{more}` was taken",
        "end the `{more}` with `{near}`, or set `{word}` in it",
    ),
    "no member": (
        "`{owner}`{file} has no `{word}`",
        "{more}",
    ),
    "called early": (
        "`{word}` is called here: `{more}` gets its result, None, in place of the function",
        "write `{near}`",
    ),
    "extra argument": (
        "`{owner}` has no parameter for `{word}`",
        "its parameters are those of `{near}`",
    ),
    "unknown keyword": (
        "`{owner}` has no parameter `{word}`",
        "remove it, or add it to the parameters",
    ),
    "lacking argument": (
        "this call of `{word}` does not pass `{more}`",
        "its parameters are those of `{near}`",
    ),
    "number of values": (
        "the text has {more}, but gets {file}",
        "write one value for each place",
    ),
    "no module here": (
        "`{word}` is a {owner} here, not the module `{word}`: it has no `{more}`",
        "write `{near}`",
    ),
    "defined twice": (
        "`{word}` is defined twice: only the last definition counts",
        "remove one of them, or give it another name",
    ),
    "no outcome": (
        "`Outcome` of `{name}` has no `{word}`",
        "write one of {file}, or add it to `Outcome` and to the interface",
    ),
    "no key member": (
        "`{more}` of `{name}` has no `{word}`",
        "write one of {file}, or add it to `{more}` and to the interface",
    ),
    "wrong result": (
        "`execute` of `{name}` returns `{word}`, not an outcome",
        "write `{near}`",
    ),
    "wrong parameters": (
        "`execute` of `{name}` {more}",
        "write `{near}`",
    ),
    "wrong constructor": (
        "the constructor of `{name}` has other parameters than the variables of its interface",
        "write `{near}`",
    ),
    "no first argument": (
        "the constructor of `{name}` takes {word} first, which the interface `{type}` does not"
        " provide",
        'add `with: "{near}"` to `cpp` in the `code` of `{type}.yml`',
    ),
    "not in with": (
        "the constructor of `{name}` takes {word}, which is neither in `with` nor a variable of"
        " `{type}.yml`",
        'write `with: "{near}"` in `{type}.yml`, or remove the parameter from the class',
    ),
    "no constructor parameter": (
        "the constructor of `{name}` lacks {word} {more}",
        "write `{near}`",
    ),
    "extra parameter": (
        "the constructor of `{name}` takes `{word}`, which is not a variable of `{type}.yml`",
        "write `{near}`, or add `{more}` to the `variables` of `{type}.yml`",
    ),
    "parameter type": (
        "the constructor of `{name}` takes `{word}`, but the program passes a `{more}`",
        "write `{near}`",
    ),
    "parameter order": (
        "the constructor of `{name}` takes its parameters in another order than {owner}",
        "write `{near}`",
    ),
    "refused order": (
        "the constructor of `{name}` takes its parameters in another order than {owner}",
        "write `{near}`",
    ),
    "no number": (
        "the class `{name}` does not contain the number of its interface, `smachac_interface`",
        "write in the class: `static constexpr std::uint32_t smachac_interface = {near};`",
    ),
    "wrong number": (
        "`{word}` is no number of C++",
        "write `{near}`, the number of the interface",
    ),
    "unused outcome": (
        "`execute` of `{name}` never returns `Outcome::{word}`",
        "return it where it is meant, or remove it from `Outcome`, from the interface, and from the"
        " transitions of the script",
    ),
    "unused call": (
        "`execute` of `{name}` never returns `Outcome::{more}`: the result of `{word}` is not used",
        "write `{near}`",
    ),
    "no answer to stops": (
        "`execute` of `{name}` never returns `Outcome::{word}`: a time limit or a stop cannot end"
        " it",
        "add where it waits: `if (stop.requested()) {{ stop.service(); return Outcome::{word}; }}`",
    ),
    "other answer": (
        "`execute` of `{name}` returns `Outcome::{word}` after a stop request",
        "write `return Outcome::{near};`",
    ),
    "unset output": (
        "`execute` of `{name}` never sets its output key `{word}`",
        "write `out.{word} = ...` before a `return`, or remove the key from the interface and from"
        " `Out`",
    ),
    "skipped output": (
        "`execute` of `{name}` can return `Outcome::{near}` without setting its output key"
        " `{word}`",
        "write `out.{word} = ...` before this `return`, or remove `{word}` from `{near}` in the"
        " `writes:` of `{type}.yml`",
    ),
    "early return": (
        "`execute` of `{name}` returns `Outcome::{near}` here before its output key `{word}` is"
        " set",
        "write `out.{word} = ...` before this `return`, or lead `{near}` to a state that does not"
        " read `{word}`",
    ),
    "no parameter": (
        "`__init__` of `{name}` does not accept `{word}`, a variable of the interface `{type}`",
        "add the parameter `{word}` to `__init__`",
    ),
    "required parameter": (
        "`__init__` of `{name}` requires `{word}`, which is not a variable of the interface"
        " `{type}`",
        "give `{word}` a default value, or add it to the `variables` of `{type}.yml` and set it at"
        " the state",
    ),
    "other parameter": (
        "`__init__` of `{name}` requires `{word}`, but the variable of the interface `{type}` is"
        " `{near}`",
        "rename the parameter `{word}` to `{near}`{more}, or the variable to `{word}`",
    ),
    "renamed parameter": (
        "`__init__` of `{name}` has the parameter `{word}`, but the variable of the interface"
        " `{type}` is `{near}`",
        "rename the parameter `{word}` to `{near}`{more}, or the variable to `{word}`",
    ),
    "no such parameter": (
        "`__init__` of `{name}` does not accept `{word}`, which is set here",
        "add the parameter `{word}` to `__init__`, or remove it here",
    ),
    "missing argument": (
        "`__init__` of `{name}` requires `{word}`, which this state does not set",
        "add `{word}: ...` to the state, or give `{word}` a default value in `__init__`",
    ),
    "not passed": (
        "`State.tpl.py` does not pass `{word}`, which `__init__` of `{name}` requires",
        "remove the line `{{% extends ... %}}`: the program then passes the variables of the state;"
        " or write a block `body`",
    ),
    "other guard": (
        "the program does not contain the class `{name}`: its template uses the name `{word}` of"
        " another class",
        "write `{near}` here, and where the template adds the name to `defined_headers`",
    ),
    "argument order": (
        "the template passes its arguments in another order than `__init__` of `{name}` has its"
        " parameters",
        "write `{near}`",
    ),
    "no keyword": (
        "the template passes `{word}`, but `__init__` of `{name}` has no parameter `{word}`",
        "its parameters are {more}",
    ),
    "no argument here": (
        "the template does not pass `{word}`, which `__init__` of `{name}` requires",
        "add `{word}={{{{ {word} }}}}` to the call, or give `{word}` a default value in `__init__`",
    ),
    "no quotes": (
        "the template prints the text of `{word}` without quotes: here the name `{more}`, which"
        " nothing defines",
        "write `{near}`",
    ),
    "not accepted": (
        "`State.tpl.py` passes `{word}`, which `__init__` of `{name}` does not accept",
        "remove the line `{{% extends ... %}}`, or add the parameter `{word}=None` to `__init__`",
    ),
}
"""The message and the help for each kind of fault."""

CHECKED_ONLY = frozenset[FaultKind](
    [
        "unused outcome",
        "unused call",
        "no answer to stops",
        "other answer",
        "unset output",
        "skipped output",
        "early return",
        "parameter order",
        "not called",
        "function not called",
        "no effect",
        "no answer",
        "identity",
        "comparison",
        "no result",
        "lost outcome",
        "lost text",
        "no value",
        "no return",
        "called early",
    ]
)
"""Faults of a class that a compiler or Python accepts: a build does not fail."""

EFFECTS: Mapping[FaultKind, str] = {
    **dict.fromkeys(["defined twice", "no result", "no effect", "lost text"], ""),
    **dict.fromkeys(
        [
            "undefined name",
            "no rospy import",
            "no import",
            "other scope",
            "other userdata",
            "lost argument",
            "lost userdata",
            "wrong import",
        ],
        "the code raises NameError when it runs: the machine stops",
    ),
    **dict.fromkeys(
        [
            "undefined method",
            "no attribute",
            "unset attribute",
            "never set",
            "no module here",
            "no member",
        ],
        "the code raises AttributeError when it runs: the machine stops",
    ),
    **dict.fromkeys(
        ["no self parameter", "extra argument", "unknown keyword", "lacking argument"],
        "the call raises TypeError when it runs: the machine stops",
    ),
    **dict.fromkeys(
        ["early return", "skipped output", "unset output"],
        "a state that reads the key afterwards gets an old value, or fails",
    ),
    "no return": "the result is None: code that uses it as a value fails, or goes on without it",
    "no tuple": "each letter of the text counts as a name",
    "early userdata": "the code raises NameError when the program makes the state",
    "super not called": "the call raises an error when it runs: the program stops",
    "not called": "the value is the method itself, which is true in every condition",
    "function not called": "the value is the function itself: it is no number, and true in every"
    " condition",
    "no answer": "the request stays set: when the state runs again, it is stopped at once",
    "identity": "the comparison can be false for equal values",
    "comparison": "the line has no effect: the old value stays, or there is none",
    "lost outcome": "`execute` goes on, and the outcome is lost",
    "other answer": "a stop or a time limit counts as `{word}`: a transition for `{near}` is never"
    " taken",
    "no comma": "SMACH knows the joined name only: the machine stops with an error",
    "other lists": "the state does not have the outcomes that it returns: the machine stops with an"
    " error",
    "no value": "the code raises UnboundLocalError when it runs: the machine stops",
    "called early": "the function runs at once, and not later",
    "number of values": "the code raises {word} when it runs: the machine stops",
    "unused call": "the state ends with the same outcome whatever the call returns",
    "unused outcome": "a transition for this outcome is never taken",
    "no answer to stops": "a transition for this outcome is never taken",
}
"""What happens, where it differs from most faults; empty if the message contains it."""

_PASSED = "the program passes each variable by its name: the call raises a TypeError"
_CALLED = "the program makes the state without this argument: the call raises a TypeError"

_RAISED = "the call raises a TypeError when the program makes the state"

_INCOMPLETE = "the outcomes and keys of the state are missing: the program stops"

PYTHON_EFFECTS: Mapping[FaultKind, str] = {
    "no state": "SMACH uses attributes of `smach.State` that the object does not have",
    "no execute": "`execute` of `smach.State` raises a NotImplementedError when the state runs",
    "arguments": "SMACH calls `execute` with the userdata alone: the call raises a TypeError",
    "no method": "SMACH needs the name of an outcome: the machine stops with an error",
    "coroutine": "SMACH needs the name of an outcome: the machine stops with an error",
    "no constructor call": _INCOMPLETE,
    "data class": _INCOMPLETE,
    "no base constructor call": "what the base class sets is missing, also the outcomes and keys:"
    " the program stops",
    "no argument": _RAISED,
    "no keyword": _RAISED,
    "no argument here": _RAISED,
    "no base argument": _RAISED,
    "argument twice": _RAISED,
    "too many arguments": _RAISED,
    "missing base argument": _RAISED,
    "no state class": "the definition of the class raises an error when the program starts",
    "no outcomes": "SMACH raises InvalidTransitionError for an undeclared outcome: the machine"
    " stops",
    "no parameter": _PASSED,
    "no such parameter": _PASSED,
    "other parameter": _PASSED,
    "renamed parameter": _PASSED,
    "required parameter": _CALLED,
    "missing argument": _CALLED,
    "not passed": _CALLED,
    "other guard": "the program stops with a NameError when it makes the state",
    "no quotes": "the program stops with a NameError when it makes the state",
    "not accepted": _RAISED,
}
"""What happens in a program in Python, where it is certain."""

STOPS_PROGRAM = PYTHON_EFFECTS.keys()
"""The faults with which the program certainly stops when it makes the state, or the first time that
the state runs: errors of a check."""


SET_IN_SCRIPT = ("no parameter", "other parameter", "renamed parameter")
"""Faults of a parameter that has another name than a variable; `owner` is that variable where the
script sets it."""


def about_class(fault: ClassFault, state_type: str, name: str, lists: str) -> tuple[str, str]:
    """The message and the help for a fault of a class. `lists` are the arguments of the constructor
    of `smach.State` that fit the interface."""
    message, help = (
        text.format(
            word=fault.name.text,
            name=name,
            type=state_type,
            lists=lists,
            near=fault.near,
            file=fault.file,
            more=fault.more,
            owner=fault.owner,
        )
        for text in WORDS[fault.kind]
    )
    near = fault.near
    if fault.kind in SET_IN_SCRIPT and fault.owner and near is not None:
        one = near if fault.kind == "no parameter" else fault.name.text
        renamed = f"rename the parameter `{one}` to `{fault.owner}`, which the script sets"
        return message, renamed + fault.more
    if fault.kind in ("skipped output", "early return") and fault.more:
        too = " too" if fault.also is not None else ""
        return message, f"write `{fault.more}` before this `return`{too}"
    if fault.kind == "unset output" and fault.more:
        return message, f"write `{fault.more}` before the `return`"
    if near is None or any("{near}" in text for text in WORDS[fault.kind]):
        return message, help
    if fault.kind == "no execute":
        return message, f"rename `{near}` to `execute`"
    if fault.kind == "no parameter":
        what = f"rename the parameter `{near}` to `{fault.name.text}`"
        return message, f"{what}, or correct the name in the interface"
    written = fault.kind in ("no list", "no return") or near.startswith('"') or "." in near
    if fault.kind == "no attribute":
        written = near.endswith(")")
    if near in ("None", "True", "False"):
        return message, f"write `{near}`: Python has no `{fault.name.text}`"
    return message, f"write `{near}`" if written else f"did you mean `{near}`?"


def class_effect(fault: ClassFault, target: str) -> str | None:
    """The effect of a fault of a class; empty if its message contains it."""
    if fault.kind == "parameter order":
        return fault.more
    if fault.kind == "argument order" and target == "python":
        return fault.more
    if fault.kind in EFFECTS:
        return EFFECTS[fault.kind].format(word=fault.name.text, near=fault.near, more=fault.more)
    if target == "cpp":
        return "the C++ compiler refuses the class"
    return PYTHON_EFFECTS.get(fault.kind)

"""The files that the command `new` creates: a project, or a state type with a stub of its code."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from keyword import iskeyword

from smachac.checks.findings.type_words import named
from smachac.diagnostics.diagnostic import did_you_mean
from smachac.frontend.loader import Library
from smachac.frontend.text.type_names import Aliases, filled
from smachac.ir.nodes import StateType
from smachac.ir.types import WORDS, Type, parse_type, unknown_words
from smachac.records import dataclass
from smachac.report.terminal import on_one_line

LANGUAGES = ("python", "cpp")

Files = dict[str, str]
"""File texts by their path in a folder."""


class BadNameError(ValueError):
    """A name is not valid; the message gives the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewStateType:
    """A state type to create: its name, its keys with their types, its outcomes."""

    name: str
    inputs: Sequence[tuple[str, str]] = ()
    outputs: Sequence[tuple[str, str]] = ()
    outcomes: Sequence[str] = ("succeeded", "aborted")


def key_and_type(text: str, names: Aliases) -> tuple[str, str]:
    """`target` or `target=Pose`; `names` are the types that the project file names. Raises
    BadNameError."""
    key, _, named = text.partition("=")
    if not key.isidentifier():
        raise BadNameError(f"`{key}` is not a name for a key")
    type_ = parse_type(filled(named or "any", names))
    if type_ is None:
        raise BadNameError(f"`{named}` is not a type")
    for word in unknown_words(type_):
        ros = "types of ROS have the form `geometry_msgs/Twist`"
        near = did_you_mean(word, [*names, *WORDS])
        near = near or f"{ros}; `[types]` of smachac.toml names others"
        raise BadNameError(f"there is no type `{word}`\n{near}")
    return key, named or "any"


def file_stem(name: str) -> str:
    """The file name for a state type: `grasp_part` for `GraspPart`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


INTERFACE_SCHEMA = "schemas/interface.json"
"""The schema of interfaces in a project."""


def interface(wanted: NewStateType, language: str, *, with_schema: bool = False) -> str:
    """The interface of a new state type. `with_schema`: the project has the schema of
    interfaces."""
    name = wanted.name
    lines = [
        *([f"# yaml-language-server: $schema=../{INTERFACE_SCHEMA}"] if with_schema else []),
        f"# The interface of {name}: its keys, outcomes and variables (`smachac docs language`).",
        f"name: {name}",
        "doc: Describe in one sentence what it does.",
    ]
    for part, keys in (("input_keys", wanted.inputs), ("output_keys", wanted.outputs)):
        lines += [f"{part}:"] if keys else []
        lines += [f"  {key}: {_quoted(type_)}" for key, type_ in keys]
    lines += ["outcomes:", *(f"  {outcome}: {{}}" for outcome in wanted.outcomes)]
    return "\n".join([*lines, f"code: {{{code_line(name, language)}}}"]) + "\n"


def _quoted(text: str) -> str:
    return f'"{text}"' if re.search(r"[\[\]{},?#]|: ", text) else text


def code_line(name: str, language: str) -> str:
    """The reference of an interface to the code in a language."""
    if language == "cpp":
        return f'cpp: {{header: {HEADERS}/{file_stem(name)}.hpp, class: "{HEADERS}::{name}"}}'
    return f'python: "{MODULES}.{file_stem(name)}:{name}"'


MODULES, HEADERS = "robot_states", "robot_states"
"""The Python package, and the folder and namespace of C++, of stubs."""


def code_file(name: str, language: str) -> str:
    """The path of the stub of a state type."""
    if language == "cpp":
        return f"include/{HEADERS}/{file_stem(name)}.hpp"
    return f"{MODULES}/{file_stem(name)}.py"


def stub(type_: StateType, language: str, library: Library, *, stepped: bool = False) -> str:
    """Code that fits an interface and does nothing yet; in C++ for a stepped machine if `stepped`.
    Raises UnportableError."""
    if language == "cpp":
        from smachac.targets.cpp.class_stub import class_stub

        return class_stub(
            type_,
            _outcomes(type_),
            library,
            namespace=HEADERS,
            comment=_summary(type_),
            stepped=stepped,
        )
    return _python_stub(type_, library.types)


def _summary(type_: StateType) -> str:
    """The first line of the doc of a type, as a comment can have it in every language."""
    line = on_one_line((type_.doc or "what it does.").splitlines()[0]).replace("\\", "/")
    return f"{type_.name}: {line}"


def _outcomes(type_: StateType) -> list[str]:
    """The outcomes of a type: at least the one that a stub returns."""
    return [outcome.name for outcome in type_.outcomes] or ["succeeded"]


def _python_stub(type_: StateType, names: Aliases) -> str:
    def written(type_: Type) -> str:
        """A type with its names, and the records that these are."""
        text = named(type_, names)
        return text if text == str(type_) else f"{text}, which is {type_}"

    outcomes = _outcomes(type_)
    quoted = _summary(type_).replace('"', "'")
    arguments = [f"outcomes={outcomes!r}"]
    for part, keys in (("input_keys", type_.input_keys), ("output_keys", type_.output_keys)):
        arguments += [f"{part}={[key.name for key in keys]!r}"] if keys else []
    variables = "".join(f", {name}" for name in type_.variables)
    lines = [
        f'"""{quoted}"""',
        "",
        "try:",
        "    import smach",
        "except ImportError:  # a machine without ROS",
        "    from smachac.runtime import smach",
        "",
        "",
        f"class {type_.name}(smach.State):",
        f"    def __init__(self{variables}):",
        "        super().__init__(",
        *(f"            {argument}," for argument in arguments),
        "        )",
        *(f"        self.{name} = {name}" for name in type_.variables),
        "",
        "    def execute(self, userdata):",
        *(_PREEMPTED if "preempted" in outcomes[1:] else ()),
        *(f"        # {_access(key.name)}: {written(key.type)}" for key in type_.input_keys),
        *(
            f"        {_access(key.name)} = None  # {written(key.type)}"
            for key in type_.output_keys
        ),
        f"        return {outcomes[0]!r}",
    ]
    return "\n".join(lines) + "\n"


_PREEMPTED = (
    "        if self.preempt_requested():  # look for it in every loop and wait",
    "            self.service_preempt()",
    "            return 'preempted'",
)
"""The lines of a stub that answer a request to stop."""


def _access(key: str) -> str:
    """A key of the userdata in Python."""
    named = key.isidentifier() and not iskeyword(key)
    return f"userdata.{key}" if named else f"userdata[{key!r}]"


# --- a project

MAIN = """\
# yaml-language-server: $schema=schemas/script.json
# A first machine: it greets, acts, and ends with success or failure.
name: {name}
template: Base
doc: Describe in one sentence what the robot does.
outcomes: [succeeded, aborted]
userdata:
  goal: {{type: str, value: door}}

states:
  - GREET:
      template: Greet
      transitions: {{succeeded: ACT}}

  - ACT:
      template: ScriptedState           # replaces a state that is not written yet
      outcomes: [there, lost]
      transitions: {{there: succeeded, lost: aborted}}
"""

SETTINGS = """\
#:schema schemas/project.json
# Folders with sub-scripts and state types (`smachac docs ci` describes all settings).
templates = ["templates"]
# Generated nodes are for ROS 2; 1 is for a ROS 1 distribution such as Noetic (`smachac docs ros`).
ros = 2
"""

HOOKS = """\
# pre-commit install    (https://pre-commit.com)
repos:
  - repo: local
    hooks:
      - id: smachac-fmt
        name: smachac fmt
        language: system
        entry: smachac fmt .
        files: '\\.ya?ml$'
        pass_filenames: false
      - id: smachac-check
        name: smachac check
        language: system
        entry: smachac check . --strict
        files: '(\\.ya?ml|\\.py|\\.hpp|(^|/)smachac\\.toml)$'
        pass_filenames: false
"""

READ_ME = """\
# {name}

- `main.yml` is the machine, `templates/` has the interfaces of its state types, `{modules}/` their
  code.
- `smachac check` finds errors, `smachac run main.yml` runs it,
  `smachac build main.yml --target python` generates a program.
- `smachac new state Grasp` creates another state type.
- `schemas/` is for editors: the first line of a file names its schema. After an update of smachac,
  `smachac schema script > schemas/script.json` writes the new one.

The command for CI: `smachac fmt . --check && smachac check . --strict`
"""

GREET = """\
# yaml-language-server: $schema=../schemas/interface.json
# The interface of Greet: its keys, outcomes and variables (`smachac docs language`).
name: Greet
doc: Prints the goal.
input_keys: {{goal: str}}
outcomes: {{succeeded: {{}}}}
code: {{{code}}}
"""

GREET_CODE = """\
\"\"\"Greet: prints the goal.\"\"\"

try:
    import smach
except ImportError:  # a machine without ROS
    from smachac.runtime import smach


class Greet(smach.State):
    def __init__(self):
        super().__init__(outcomes=['succeeded'], input_keys=['goal'])

    def execute(self, userdata):
        print(f"off to the {userdata.goal}")
        return 'succeeded'
"""


def project(name: str, schemas: Mapping[str, str]) -> Files:
    """A project without findings, which can be built and run. `schemas`: the texts of the schemas
    of its files, by name."""
    machine = re.sub(r"\W+", "_", name).strip("_").lower() or "robot"
    machine = f"robot_{machine}" if not machine.isidentifier() else machine
    return {
        "main.yml": MAIN.format(name=machine),
        "smachac.toml": SETTINGS,
        "templates/Greet.yml": GREET.format(code=code_line("Greet", "python")),
        f"{MODULES}/__init__.py": '"""The code of the state types in `templates/`."""\n',
        f"{MODULES}/greet.py": GREET_CODE,
        ".pre-commit-config.yaml": HOOKS,
        "README.md": READ_ME.format(name=name, modules=MODULES),
        **{f"schemas/{name}.json": text for name, text in schemas.items()},
    }


def is_type_name(name: str) -> bool:
    """Whether a name is valid for a state type: for a class in Python and C++, and for a file."""
    return name.isascii() and name.isidentifier() and name[:1].isupper() and not name.endswith("_")

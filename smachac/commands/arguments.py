"""The arguments of the commands that rewrite scripts, and what they share with the others."""

from __future__ import annotations

import argparse

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path

NEW_EXAMPLES = """\
examples:
  smachac new my_robot                                 a folder with a machine that runs
  smachac new state Grasp                              templates/Grasp.yml and robot_states/grasp.py
  smachac new state Grasp --input target=Pose --output "width=float<m>" --outcome held
  smachac new state Grasp --target cpp                 include/robot_states/grasp.hpp

Nothing that is there is ever written over.
exit codes: 0 made, 1 something is in the way, 2 wrong usage, 70 a bug in smachac
"""

STATES_EXAMPLES = """\
examples:
  smachac states                                 all that a script in this folder may use
  smachac states MoveToJointPositionsState       its variables, keys, outcomes
  smachac states --format md > states.md         all of them, as a document

exit codes: 0 told, 2 wrong usage or no such state type, 70 a bug in smachac
"""

FMT_EXAMPLES = """\
examples:
  smachac fmt                        lay out every script below this folder
  smachac fmt main.yml --diff        what it would change, as a patch
  smachac fmt --check                fail if a script is not laid out (CI)
  smachac fmt main.yml --shorthand   T, o, t, [[x]] instead of template, outcomes, transitions, ...

exit codes: 0 done, 1 something to lay out (--check, --diff) or unreadable, 2 wrong usage, 70 a bug
"""

CONTAIN_EXAMPLES = """\
examples:
  smachac contain main.yml LOAD StateMachine LOAD_TABLE LOAD_BLOCK   two states in a row
  smachac contain main.yml LOOK Concurrence FIND WARM_UP             at once instead of in a row
  smachac contain main.yml LOAD StateMachine LOAD_TABLE LOAD_BLOCK --diff   as a patch

exit codes: 0 done, 1 refused, or something to do (--check, --diff), 2 wrong usage, 70 a bug
"""

EXTRACT_EXAMPLES = """\
examples:
  smachac extract main.yml PICK_BLOCK              into pick_block.yml beside main.yml
  smachac extract main.yml sm/PICK --to grasp.yml  another name
  smachac extract main.yml PICK_BLOCK --diff       what it would do, as a patch

exit codes: 0 done, 1 refused, or something to do (--check, --diff), 2 wrong usage, 70 a bug
"""

INLINE_EXAMPLES = """\
examples:
  smachac inline main.yml PICK_BLOCK         what pick_block.yml holds, in the place of its call
  smachac inline main.yml PICK_BLOCK --diff  what it would do, as a patch

exit codes: 0 done, 1 refused, or something to do (--check, --diff), 2 wrong usage, 70 a bug
"""

MIGRATE_EXAMPLES = """\
examples:
  smachac migrate .                          every script and template below this folder
  smachac migrate scripts templates          of two folders
  smachac migrate . --format json > left.json   for other programs; md for a page

what it says of each place:
  edit      smachac cannot make a program of it as it is; SMACHA passed over it
  changed   SMACHA made something else of it, or no program
  told      it works as before, and `smachac check` has something to say about it

exit codes: 0 nothing has to be edited, 1 something has, 2 wrong usage, 70 a bug in smachac
"""

RENAME_EXAMPLES = """\
examples:
  smachac rename main.yml PICK_BLOCK GRASP        a state, and what leads to it
  smachac rename main.yml PICK_BLOCK/aborted lost an outcome of a state, inside it and around it
  smachac rename main.yml block_pose part_pose    a key of the machine
  smachac rename main.yml PICK_BLOCK/pose goal    a key of a container
  smachac rename main.yml done ready --kind key   where a name means several things

exit codes: 0 done, 1 refused, or something to do (--check, --diff), 2 wrong usage, 70 a bug
"""


def path(text: str) -> Path:
    from pathlib import Path

    return Path(text)


def search_folders(parser: argparse.ArgumentParser) -> None:
    for name, what in (("scripts", "sub-scripts"), ("templates", "templates and interfaces")):
        parser.add_argument(f"--{name}", type=path, action="append", default=[], metavar="DIR",
                            help=f"another folder with {what} (repeatable)")  # fmt: skip


def colour(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--colour", "--color", choices=["auto", "always", "never"], default="auto")


def new(verb: argparse.ArgumentParser) -> None:
    verb.epilog = NEW_EXAMPLES
    verb.add_argument("words", nargs="+", metavar="FOLDER | state NAME", help="what to begin")
    verb.add_argument("--target", choices=("python", "cpp"), default="python", help="of the stub")
    for name in ("input", "output"):
        verb.add_argument(f"--{name}", action="append", default=[], metavar="KEY[=TYPE]",
                          help=f"a key of the state type's {name}s (repeatable)")  # fmt: skip
    verb.add_argument("--outcome", action="append", default=[], metavar="NAME",
                      help="an outcome of the state type (repeatable)")  # fmt: skip


def states(verb: argparse.ArgumentParser) -> None:
    verb.epilog = STATES_EXAMPLES
    verb.add_argument("name", nargs="?", metavar="NAME", help="a state type")
    verb.add_argument("--format", choices=("text", "json", "md"), default="text")
    verb.add_argument("--templates", type=path, action="append", default=[], metavar="DIR",
                      help="another folder with templates and interfaces (repeatable)")  # fmt: skip


def fmt(verb: argparse.ArgumentParser) -> None:
    verb.epilog = FMT_EXAMPLES
    verb.add_argument("script", nargs="*", type=path, default=None,
                      help="scripts, folders, patterns (default: this folder)")  # fmt: skip
    _dry_run(verb)
    spelling = verb.add_mutually_exclusive_group()
    for name in ("short", "long"):
        spelling.add_argument(f"--{name}hand", dest="spelling", action="store_const", const=name,
                              default="kept", help=f"{name} names of variables")  # fmt: skip
    colour(verb)


def contain(verb: argparse.ArgumentParser) -> None:
    verb.epilog = CONTAIN_EXAMPLES
    verb.add_argument("script", type=path, help="a script (.yml, .yaml)")
    verb.add_argument("name", metavar="NAME", help="what the container is to be called")
    verb.add_argument("type", metavar="TYPE", choices=("StateMachine", "Concurrence"),
                      help="StateMachine or Concurrence")  # fmt: skip
    verb.add_argument("states", metavar="STATE", nargs="+", help="states of one container")
    _dry_run(verb)
    search_folders(verb)
    colour(verb)


def extract(verb: argparse.ArgumentParser) -> None:
    verb.epilog = EXTRACT_EXAMPLES
    _one_state(verb, "a container, by its path or the end of it")
    verb.add_argument("--to", type=path, metavar="FILE",
                      help="the new file (default: the state's name)")  # fmt: skip


def inline(verb: argparse.ArgumentParser) -> None:
    verb.epilog = INLINE_EXAMPLES
    _one_state(verb, "a call of a sub-script, by its path or the end of it")


def rename(verb: argparse.ArgumentParser) -> None:
    verb.epilog = RENAME_EXAMPLES
    verb.add_argument("script", type=path, help="a script (.yml, .yaml)")
    verb.add_argument("path", metavar="PATH",
                      help="a state's path, or its end; behind it an outcome or key")  # fmt: skip
    verb.add_argument("new", metavar="NEW", help="the new name")
    verb.add_argument("--kind", choices=("state", "outcome", "key"), help="where PATH is unclear")
    _dry_run(verb)
    search_folders(verb)
    colour(verb)


def _one_state(verb: argparse.ArgumentParser, what: str) -> None:
    verb.add_argument("script", type=path, help="a script (.yml, .yaml)")
    verb.add_argument("state", metavar="STATE", help=what)
    _dry_run(verb)
    search_folders(verb)
    colour(verb)


def _dry_run(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--check", action="store_true", help="write nothing; 1 if it would")
    verb.add_argument("--diff", action="store_true", help="write nothing; print it as a patch")


def migrate(verb: argparse.ArgumentParser) -> None:
    verb.epilog = MIGRATE_EXAMPLES
    verb.add_argument("folder", nargs="*", type=path, help="folders (default: this one)")
    search_folders(verb)
    verb.add_argument(
        "--format", choices=("text", "json", "md"), default="text", help="of the report"
    )

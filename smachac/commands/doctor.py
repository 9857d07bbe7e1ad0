"""The command `doctor`: what is installed, what is missing, and how to get it."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import FORMAT
from smachac.commands.output import FINDINGS, OK

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterator

EXAMPLES = """\
examples:
  smachac doctor                 what is installed, and what is missing for which use
  smachac doctor --format json   for programs

exit codes: 0 everything that smachac requires is installed, 1 a required package is missing,
2 wrong usage, 70 a bug in smachac
"""

MODULES = (
    ("ruamel.yaml", "ruamel.yaml", "reading scripts", "pip install smachac", True),
    ("networkx", "networkx", "graphs", "pip install smachac", True),
    ("lark", "lark", "expressions and types", "pip install smachac", True),
    ("jinja2", "Jinja2", "templates", "pip install smachac", True),
    ("pyflakes", "pyflakes", "names in classes of states", "pip install smachac", True),
    ("shtab", "shtab", "completion for shells", "pip install smachac", True),
    ("_ruamel_yaml_clibz", "ruamel.yaml.clibz", "fast reading of large scripts",
     "pip install 'smachac[fast]'", False),
    ("pybullet", "pybullet", "the simulated arm", "pip install 'smachac[sim]'", False),
    ("numpy", "numpy", "the simulated arm", "pip install 'smachac[sim]'", False),
    ("PIL", "Pillow", "films of the arm (.gif)", "pip install 'smachac[sim]'", False),
    ("imageio_ffmpeg", "imageio-ffmpeg", "films of the arm (.mp4)", "pip install 'smachac[sim]'",
     False),
    ("pygls", "pygls", "the language server, `smachac lsp`", "pip install 'smachac[lsp]'", False),
    ("rosbags", "rosbags", "bags of ROS 2 in `trace check`", "pip install 'smachac[bags]'", False),
    ("smach", "smach", "SMACH itself; without it programs use the bundled runtime",
     "install ROS", False),
    ("rospy", "rospy", "programs for ROS 1", "install ROS 1", False),
    ("rclpy", "rclpy", "programs for ROS 2", "install ROS 2", False),
)  # fmt: skip
"""Python modules: name, distribution, use, how to install it, and whether smachac requires it."""

PROGRAMS = (
    (("g++", "clang++", "c++"), "the C++ target: `verify --targets cpp`", "apt install g++"),
    (("dot",), "pictures from the dot target", "apt install graphviz"),
    (("git",), "the project folder ends at the root of its repository", "apt install git"),
)
"""Programs of which one is enough, their use, and how to install the first one."""


def doctor_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("--format", choices=("text", "json"), default="text", help=FORMAT)


def doctor_command(arguments: Namespace) -> int:
    """Print what is installed; the exit code."""
    from smachac.version import __version__

    python = ".".join(map(str, sys.version_info[:3]))
    rows = [*_modules(), *_programs()]
    missing = [row for row in rows if row["required"] and row["found"] is None]
    if arguments.format == "json":
        from smachac.report.json import json_text

        found = {"smachac": __version__, "python": python, "platform": sys.platform}
        sys.stdout.write(json_text({**found, "parts": rows}))
        return FINDINGS if missing else OK
    print(f"smachac {__version__}, Python {python} ({sys.executable})\n")
    width = max(len(str(row["name"])) for row in rows)
    for row in rows:
        name, use = str(row["name"]).ljust(width), row["use"]
        if row["found"] is not None:
            print(f"  {name}  {row['found']:<12}  {use}")
        else:
            print(f"  {name}  {'missing':<12}  {use}: {row['install']}")
    if missing:
        names = ", ".join(str(row["name"]) for row in missing)
        print(f"\nsmachac cannot work without {names}", file=sys.stderr)
        return FINDINGS
    return OK


def _modules() -> Iterator[dict[str, object]]:
    """A row for each Python module; none of them is imported."""
    from importlib.metadata import PackageNotFoundError, version
    from importlib.util import find_spec

    for module, distribution, use, install, required in MODULES:
        found: str | None = None
        if find_spec(module.partition(".")[0]) is not None:
            try:
                found = version(distribution)
            except PackageNotFoundError:  # packages of ROS have no metadata of Python
                found = "installed"
        yield {"name": distribution, "found": found, "use": use, "install": install,
               "required": required}  # fmt: skip


def _programs() -> Iterator[dict[str, object]]:
    """A row for each kind of program."""
    from shutil import which

    for names, use, install in PROGRAMS:
        found = next((name for name in names if which(name)), None)
        yield {"name": names[0], "found": found, "use": use, "install": install, "required": False}

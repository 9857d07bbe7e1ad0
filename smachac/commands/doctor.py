"""The command `doctor`: what is installed, what is missing, and how to get it."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import report_output
from smachac.commands.output import FINDINGS, OK

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any, TypeAlias

EXAMPLES = """\
examples:
  smachac doctor                 what is installed, and what is missing for which use
  smachac doctor --format json   for programs

exit codes: 0 everything that smachac requires is installed, 1 a required package is missing or
mixed with another one, or packages of two distributions of ROS 2 are installed, 2 wrong usage,
70 a bug in smachac
"""

MODULES = (
    ("yaml._yaml", "PyYAML", "reading scripts, with its C parser",
     "pip install --force-reinstall PyYAML", True),
    ("networkx", "networkx", "graphs", "pip install smachac", True),
    ("jinja2", "Jinja2", "templates", "pip install smachac", True),
    ("pyflakes", "pyflakes", "names in classes of states", "pip install smachac", True),
    ("shtab", "shtab", "completion for shells", "pip install smachac", True),
    ("pybullet", "pybullet", "the simulated arm", "pip install 'smachac[sim]'", False),
    ("numpy", "numpy", "the simulated arm", "pip install 'smachac[sim]'", False),
    ("PIL", "Pillow", "films of the arm (.gif)", "pip install 'smachac[sim]'", False),
    ("imageio_ffmpeg", "imageio-ffmpeg", "films of the arm (.mp4)", "pip install 'smachac[sim]'",
     False),
    ("xacro", "xacro", "robots, `.urdf.xacro`", "pip install 'smachac[xacro]'", False),
    ("pygls", "pygls", "the language server, `smachac lsp`", "pip install 'smachac[lsp]'", False),
    ("rosbags", "rosbags", "bags of ROS 2 in `trace check`", "pip install 'smachac[bags]'", False),
    ("smach", "smach", "SMACH itself; without it programs use the bundled runtime",
     "install ROS", False),
    ("rospy", "rospy", "programs for ROS 1", "install ROS 1", False),
    ("rclpy", "rclpy", "programs for ROS 2", "install ROS 2", False),
)  # fmt: skip
"""Python modules: name, distribution, use, how to install it, and whether smachac requires it. Of
PyYAML it is the module in C, which a build of it from its source can lack."""

PROGRAMS = (
    (("g++", "clang++", "c++"), "the C++ target: `verify --targets cpp`", "apt install g++"),
    (("dot",), "pictures from the dot target", "apt install graphviz"),
    (("git",), "the project folder ends at the root of its repository", "apt install git"),
)
"""Programs of which one is enough, their use, and how to install the first one."""


def doctor_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    report_output(parser, "text", "json")


def doctor_command(arguments: Namespace) -> int:
    """Print what is installed; the exit code."""
    from smachac.commands.ros2_distributions import installed_distributions
    from smachac.version import __version__

    python = ".".join(map(str, sys.version_info[:3]))
    rows = [*_modules(), *_programs()]
    missing = [row for row in rows if row["required"] and row["found"] is None]
    ros2 = installed_distributions()
    mixed = [row for row in rows if row["mixed"]]
    unfit = missing or len(ros2) > 1 or any(row["required"] for row in mixed)
    code = FINDINGS if unfit else OK
    if arguments.format == "json":
        from smachac.report.json import json_text

        found = {"smachac": __version__, "python": python, "platform": sys.platform}
        sys.stdout.write(json_text({**found, "parts": rows, "ros2_distributions": ros2}))
        return code
    print(f"smachac {__version__}, Python {python} ({sys.executable})\n")
    width = max(len(str(row["name"])) for row in rows)
    for row in rows:
        name, use = str(row["name"]).ljust(width), row["use"]
        if row["found"] is not None:
            print(f"  {name}  {row['found']:<12}  {use}")
        else:
            print(f"  {name}  {'missing':<12}  {use}: {row['install']}")
    for row in mixed:
        used, *others = row["mixed"]
        print(f"\n{row['file']} is of {used}, and also written by {', '.join(others)}:"
              " uninstall all of them, then install the one that you need",
              file=sys.stderr)  # fmt: skip
    if missing:
        names = ", ".join(str(row["name"]) for row in missing)
        print(f"\nsmachac cannot work without {names}", file=sys.stderr)
    if len(ros2) > 1:
        print(f"\n{mixture(ros2)}", file=sys.stderr)
    return code


def mixture(ros2: dict[str, list[str]]) -> str:
    """The sentences on packages of several distributions of ROS 2."""
    parts = [f"{name} ({', '.join(packages)})" for name, packages in ros2.items()]
    last = parts.pop()
    return (
        f"packages of {', '.join(parts)} and {last} are installed, and nodes of ROS 2 cannot start "
        "with both; install all of one distribution in a new environment, for example with "
        "`pip install ros-kilted-rclpy ros-kilted-rmw-fastrtps-cpp ros-kilted-std-msgs`"
    )


def _modules() -> Iterator[dict[str, Any]]:
    """A row for each Python module; none of them is imported. The version is that of the
    distribution whose file an import reads; `mixed` names it with others that write the file."""
    from importlib.metadata import PackageNotFoundError, version
    from importlib.util import find_spec

    writers = _writers({module.partition(".")[0] for module, *_ in MODULES})
    for module, distribution, use, install, required in MODULES:
        try:
            spec = find_spec(module)
        except ModuleNotFoundError:  # the package around it is missing
            spec = None
        found: str | None = None
        names: list[str] = []
        file = spec.origin if spec is not None else None
        if file is not None and file in writers:
            ordered = _writer_first(file, writers[file])
            found = ordered[0][1]
            names = [" ".join(writer) for writer in ordered]
        elif spec is not None:
            try:
                found = version(distribution)
            except PackageNotFoundError:  # packages of ROS have no metadata of Python
                found = "installed"
        yield {"name": distribution, "found": found, "use": use, "install": install,
               "required": required, "file": file,
               "mixed": names if len(names) > 1 else []}  # fmt: skip


_Writer: TypeAlias = "tuple[str, str, str]"
"""A distribution that writes a file: its name, its version, the digest of the file."""


def _writers(packages: set[str]) -> dict[str, list[_Writer]]:
    """The distributions that write a file of one of the packages, by the path of the file."""
    from importlib.metadata import distributions

    found: dict[str, list[_Writer]] = {}
    for distribution in distributions():
        own = [file for file in distribution.files or () if file.parts[0] in packages]
        if not own:
            continue
        name, version = distribution.metadata["Name"], distribution.version
        for file in own:
            digest = file.hash.value if file.hash is not None else ""
            found.setdefault(str(file.locate()), []).append((name, version, digest))
    return found


def _writer_first(file: str, writers: list[_Writer]) -> list[tuple[str, str]]:
    """The names and versions of the writers of a file, first of the one whose text it has."""
    from base64 import urlsafe_b64encode
    from hashlib import sha256
    from pathlib import Path

    digest = urlsafe_b64encode(sha256(Path(file).read_bytes()).digest()).decode().rstrip("=")
    ordered = sorted(writers, key=lambda writer: writer[2] != digest)
    return [(name, version) for name, version, _ in ordered]


def _programs() -> Iterator[dict[str, Any]]:
    """A row for each kind of program."""
    from shutil import which

    for names, use, install in PROGRAMS:
        found = next((name for name in names if which(name)), None)
        yield {"name": names[0], "found": found, "use": use, "install": install, "required": False,
               "mixed": []}  # fmt: skip

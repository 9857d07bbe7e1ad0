"""The files of the options beside a header: main.cpp, a CMake project, a package of ROS 2."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import walk
from smachac.ir.types import MOST_BOUND, Bounds
from smachac.records import dataclass
from smachac.targets import BuildContext, Files, OptionError, made_by, stem
from smachac.targets.cpp.header import Header
from smachac.targets.cpp.plan import scope_name
from smachac.targets.cpp.user_classes import class_code
from smachac.targets.package_xml import package_xml

OPTIONS = {
    "main": "true: also main.cpp, a program that runs the machine once",
    "cmake": "true: also CMakeLists.txt, a library that find_package finds",
    "package": "NAME: a package for colcon (ament_cmake), the header in include/NAME",
    "mode": "step: a machine that is stepped, without heap, threads and exceptions",
    "text": "BYTES: the bound of texts without one, with mode=step",
    "list": "ITEMS: the bound of lists without one, with mode=step",
}

PROGRAM = "smachac/program.hpp"
ARM = "smachac/arm.hpp"

HEADERS = (
    "smachac/operations.hpp",
    "smachac/values.hpp",
    "smachac/class_checks.hpp",
    "smachac/smachac.hpp",
)
"""The headers of smachac that every machine includes."""

STEP_HEADERS = (
    "smachac/operations.hpp",
    "smachac/step_values.hpp",
    "smachac/class_checks.hpp",
    "smachac/step.hpp",
    "smachac/step_trace.hpp",
)
"""The headers of smachac that every stepped machine includes."""

OTHER_HEADERS = (ARM, PROGRAM)
"""The headers of smachac that some machines include; each includes only HEADERS."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """The files to make beside a header; `package` is the name of an ament package, or empty.
    `bounds` are those of a stepped machine; None for a blocking one."""

    main: bool = False
    cmake: bool = False
    package: str = ""
    bounds: Bounds | None = None

    def path(self, file: str) -> str:
        """The path of the header."""
        return f"include/{self.package}/{file}" if self.package else file


NO_BOUNDS = Bounds()


def project(options: Mapping[str, str], defaults: Bounds = NO_BOUNDS) -> Project:
    """The project of the options; `defaults` are the bounds of the project file. Raises
    OptionError."""
    package = options.get("package", "")
    if package and not re.fullmatch(r"[a-z][a-z0-9_]*", package):
        raise OptionError(f"`package` must match `[a-z][a-z0-9_]*`, not `{package}`")
    mode = options.get("mode", "blocking")
    if mode not in ("blocking", "step"):
        raise OptionError(f"`mode` must be `blocking` or `step`, not `{mode}`")
    main = _truth(options, "main")
    if main and mode == "step":
        raise OptionError("`main` is not possible with `mode=step`: the caller has the loop")
    bounds = Bounds(
        text=_bound(options, "text") or defaults.text, list=_bound(options, "list") or defaults.list
    )
    return Project(
        main=main,
        cmake=_truth(options, "cmake"),
        package=package,
        bounds=bounds if mode == "step" else None,
    )


def _bound(options: Mapping[str, str], name: str) -> int:
    """The bound of texts or lists without one; 0 without the option."""
    value = options.get(name, "0")
    if not (value.isascii() and value.isdecimal() and len(value) < 6 and int(value) <= MOST_BOUND):
        raise OptionError(f"`{name}` must be a number from 1 to {MOST_BOUND}, not `{value}`")
    return int(value)


def _truth(options: Mapping[str, str], name: str) -> bool:
    value = options.get(name, "false")
    if value not in ("true", "false"):
        raise OptionError(f"`{name}` must be `true` or `false`, not `{value}`")
    return value == "true"


def runtime(machine: Machine, context: BuildContext) -> dict[str, str]:
    """The headers of smachac that the files of a machine include: file names beside these, with
    their paths under smachac/runtime."""
    wanted = project(context.options)
    types = {node.type: None for _, node in walk(machine.root) if isinstance(node, Leaf)}
    included = {PROGRAM} if wanted.main else set()
    if machine.robot is not None and machine.robot.arms:
        included.add(ARM)
    for name in types:
        type_ = machine.state_types.get(name)
        code = class_code(type_) if type_ is not None else None
        if code is not None:
            included.add(code.header)
    root = "include/" if wanted.package else ""
    if wanted.bounds is not None:
        return {f"{root}{header}": f"cpp/{header}" for header in STEP_HEADERS}
    headers = [*HEADERS, *(header for header in OTHER_HEADERS if header in included)]
    return {f"{root}{header}": f"cpp/{header}" for header in headers}


def project_files(machine: Machine, wanted: Project, header: Header) -> Files:
    """The files beside the header.

    Raises OptionError if `main` is set and the states need arguments.
    """
    files: Files = {}
    name = stem(machine)
    if wanted.main:
        if header.parameters:
            needed = " and ".join(f"`{parameter}`" for parameter in header.parameters)
            raise OptionError(f"`main` is not possible: the states need {needed}; write main.cpp")
        folder = "src/" if wanted.package else ""
        files[f"{folder}main.cpp"] = _main(machine, f"{wanted.package}/" if wanted.package else "")
    if wanted.package:
        files["CMakeLists.txt"] = _ament(machine, wanted)
        files["package.xml"] = package_xml(
            machine,
            wanted.package,
            "  <buildtool_depend>ament_cmake</buildtool_depend>\n",
            "ament_cmake",
        )
    elif wanted.cmake:
        files["CMakeLists.txt"] = _cmake(machine, name, wanted, header)
    return files


def _main(machine: Machine, folder: str) -> str:
    scope = scope_name(machine.root.name)
    return f"""\
// {made_by(machine)}
#include "{folder}{stem(machine)}.hpp"
#include "{PROGRAM}"

int main(int count, char **arguments) {{
  smachac::Program program(count, arguments);
  {scope}::States states;
  {scope}::Userdata userdata;
  return program.run([&](smachac::Observer *observer, smachac::Stop &stop) {{
    return {scope}::name({scope}::run(states, userdata, observer, stop));
  }});
}}
"""


def _cmake(machine: Machine, name: str, wanted: Project, header: Header) -> str:
    program = (
        f"\nadd_executable({name}_main main.cpp)\n"
        f"set_target_properties({name}_main PROPERTIES OUTPUT_NAME {name})\n"
        f"target_link_libraries({name}_main PRIVATE {name})\n"
        f"install(TARGETS {name}_main)\n"
        if wanted.main
        else ""
    )
    robots = " robots" if machine.robot is not None and machine.robot.arms else ""
    return f"""\
# {made_by(machine)}
cmake_minimum_required(VERSION 3.14)
project({name} LANGUAGES CXX)

include(GNUInstallDirs)
find_package(Threads REQUIRED)

# find_package({name}) and target_link_libraries(... {name}::{name}) bring the header.
add_library({name} INTERFACE)
add_library({name}::{name} ALIAS {name})
target_compile_features({name} INTERFACE cxx_std_17)
target_link_libraries({name} INTERFACE Threads::Threads)
target_include_directories({name} INTERFACE
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}>
  $<INSTALL_INTERFACE:${{CMAKE_INSTALL_INCLUDEDIR}}/{name}>)
{_classes(name, header.classes)}{program}
install(FILES {name}.hpp DESTINATION ${{CMAKE_INSTALL_INCLUDEDIR}}/{name})
install(DIRECTORY smachac{robots} DESTINATION ${{CMAKE_INSTALL_INCLUDEDIR}}/{name})
install(TARGETS {name} EXPORT {name}Targets)
install(EXPORT {name}Targets NAMESPACE {name}::
  DESTINATION ${{CMAKE_INSTALL_LIBDIR}}/cmake/{name})
file(WRITE ${{CMAKE_CURRENT_BINARY_DIR}}/{name}Config.cmake
"include(CMakeFindDependencyMacro)
find_dependency(Threads)
include(\\${{CMAKE_CURRENT_LIST_DIR}}/{name}Targets.cmake)
")
install(FILES ${{CMAKE_CURRENT_BINARY_DIR}}/{name}Config.cmake
  DESTINATION ${{CMAKE_INSTALL_LIBDIR}}/cmake/{name})
"""


def _classes(name: str, headers: Sequence[str]) -> str:
    """The CMake code that finds the classes of the user. They are not installed: a user of the
    installed header has them."""
    if not headers:
        return ""
    listed = "".join(f"\n    {header}" for header in headers)
    return f"""
# The headers of your state types; -D {name}_INCLUDE=FOLDER says where they are.
set({name}_INCLUDE ${{CMAKE_CURRENT_SOURCE_DIR}}/../include ${{CMAKE_CURRENT_SOURCE_DIR}}/include
    CACHE PATH "the folders with the headers of the state types of {name}")
foreach(header{listed})
  find_path(folder ${{header}} HINTS ${{{name}_INCLUDE}})
  if(NOT folder)
    message(FATAL_ERROR
      "no ${{header}} in ${{{name}_INCLUDE}}: -D {name}_INCLUDE=FOLDER says where")
  endif()
  target_include_directories({name} INTERFACE $<BUILD_INTERFACE:${{folder}}>)
  unset(folder CACHE)
endforeach()
"""


def _ament(machine: Machine, wanted: Project) -> str:
    name, program = wanted.package, ""
    if wanted.main:
        program = (
            f"\nadd_executable({name}_main src/main.cpp)\n"
            f"set_target_properties({name}_main PROPERTIES OUTPUT_NAME {stem(machine)})\n"
            f"target_link_libraries({name}_main PRIVATE {name})\n"
            f"install(TARGETS {name}_main DESTINATION lib/{name})\n"
        )
    return f"""\
# {made_by(machine)}
cmake_minimum_required(VERSION 3.14)
project({name} LANGUAGES CXX)

find_package(ament_cmake REQUIRED)
find_package(Threads REQUIRED)

add_library({name} INTERFACE)
target_compile_features({name} INTERFACE cxx_std_17)
target_link_libraries({name} INTERFACE Threads::Threads)
target_include_directories({name} INTERFACE
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include/{name}>)
{program}
install(DIRECTORY include/ DESTINATION include/{name})
install(TARGETS {name} EXPORT export_{name})
ament_export_targets(export_{name})
ament_export_dependencies(Threads)
ament_package()
"""

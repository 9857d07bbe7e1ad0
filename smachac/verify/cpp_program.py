"""The C++ program that plays scenes.

The containers are printed as the target prints them. Each leaf is a class of its own, which has
all that it ever does as the cases of a switch; a scene says which one at which visit. On live
paths some leaves are as the target prints them: there is a second machine for those.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from importlib import resources

from smachac.diagnostics import Report, in_order
from smachac.driver import memory_library
from smachac.ir.nodes import Leaf, Node, StateMachine
from smachac.ir.walk import containers, walk
from smachac.states import Library
from smachac.targets.cpp.header import header_of
from smachac.targets.cpp.plan import Plan, scope_name
from smachac.targets.cpp.types import cpp_value, script_data
from smachac.targets.cpp.words import identifier
from smachac.verify.cpp_leaf import CppLeaf
from smachac.verify.scenes import Scene
from smachac.verify.walks import LIVE_TYPES


class Program:
    """A machine as a program for some scenes.

    What it reads is for each scene the number of the machine that plays it, then the scene
    (play.hpp).
    """

    def __init__(self, planned: Plan, library: Library, scenes: Sequence[Scene]) -> None:
        self._plan = planned
        self._library = library
        self._scenes = scenes
        self._stages = sorted({scene.live for scene in scenes}, key=sorted)
        self._leaves: dict[str, CppLeaf] = {}
        for number, (path, node) in enumerate(walk(planned.machine.root)):
            if isinstance(node, Leaf):
                scope = planned.scopes[path.rpartition("/")[0]]
                self._leaves[path] = CppLeaf(number=number, path=path, leaf=node, scope=scope)
        for scene in scenes:
            for path, row in scene.rows.items():
                for step in row:
                    self._leaves[path].case_of(step)

    def script(self) -> str:
        """What the program reads."""
        lines = []
        for scene in self._scenes:
            rows = {path: row for path, row in scene.rows.items() if row}
            lines.append(f"{self._stages.index(scene.live)} {scene.most} {len(rows)}")
            for path, row in rows.items():
                leaf = self._leaves[path]
                cases = " ".join(str(leaf.case_of(step)) for step in row)
                lines.append(f"{leaf.number} {len(row)} {cases}")
        return "\n".join(lines) + "\n"

    def text(self) -> str:
        """What is to be compiled."""
        library = self._all()
        play = resources.files("smachac.verify").joinpath("play.hpp").read_text("utf-8")
        leaves = [leaf.text(library, self._reads) for leaf in self._leaves.values()]
        machines = [
            f"namespace stage{number} {{\n{self._machine(live, library)[0]}\n}}"
            for number, live in enumerate(self._stages)
        ]
        spaces = ["namespace verify {", *leaves, "} // namespace verify"]
        return "\n".join([play, *spaces, *machines, *self._main()])

    def refused(self) -> Report:
        """What C++ cannot say of the machine; the code of its states does not matter but where
        scenes may leave it to them."""
        live = frozenset(
            path for path, leaf in self._leaves.items() if leaf.leaf.type in LIVE_TYPES
        )
        return self._machine(live, self._all())[1]

    def _all(self) -> Library:
        """The library with the interfaces of the leaves."""
        made = self._leaves.values()
        interfaces = {f"templates/{leaf.type}.yml": leaf.interface() for leaf in made}
        return memory_library(interfaces, self._library)

    @property
    def _reads(self) -> Mapping[str, Sequence[str]]:
        return {path: keys for scene in self._scenes for path, keys in scene.reads.items()}

    def _machine(self, live: frozenset[str], library: Library) -> tuple[str, Report]:
        """What the target prints of the machine with scripted leaves but for live ones, and what
        it refuses."""
        made: dict[str, Node] = {}
        for path, node in reversed(list(walk(self._plan.machine.root))):
            if isinstance(node, Leaf):
                made[path] = node if path in live else self._leaves[path].scripted()
            else:
                children = tuple(made[f"{path}/{child.name}"] for child in node.children)
                made[path] = replace(node, children=children)
        root = made[self._plan.machine.root.name]
        assert isinstance(root, StateMachine)
        machine = replace(self._plan.machine, root=root)
        scopes = {
            path: replace(self._plan.scopes[path], node=node) for path, node in containers(root)
        }
        planned = Plan(machine=machine, scopes=scopes, report=list(self._plan.report))
        lines = header_of(planned, library).text.splitlines()
        text = "\n".join(line for line in lines if not line.startswith("#"))
        return text, in_order(planned.report)

    def _main(self) -> Iterator[str]:
        scope = self._plan.scopes[self._plan.machine.root.name]
        name = scope_name(scope.path)
        given = {key: value for scene in self._scenes for key, value in scene.userdata.items()}
        yield "int main() {"
        yield "  for (std::size_t stage = 0; std::cin >> stage;) {"
        for number in range(len(self._stages)):
            here = f"stage{number}::{name}"
            yield f"    if (stage == {number}) {{"
            yield f"      verify::play<{here}::States, {here}::Userdata>([](auto &ud) {{"
            yield "        static_cast<void>(ud);"
            for key, value in given.items():
                if key in scope.keys:
                    text = cpp_value(script_data(value), scope.keys[key])
                    yield f"        ud.{identifier(key)}.hold({text});"
            yield f"      }}, {here}::run);"
            yield "    }"
        yield "  }"
        yield "}"

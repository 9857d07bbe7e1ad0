"""Per-machine analysis results, each computed at its first use and kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias, TypeVar, cast

from smachac.analysis.code_slots import CodeSlot, code_slots
from smachac.analysis.control_flow import (
    Linear,
    Trap,
    absorbed,
    endless_states,
    outline,
    stuck_states,
)
from smachac.analysis.incremental_facts import Fact, IncrementalResult, Preorder, found_at
from smachac.ir import nodes, traversal
from smachac.ir.nodes import Container, Leaf, Machine, Node, StateMachine, StateType
from smachac.pysource.modules.user_code import CodeFacts, ProjectCode

if TYPE_CHECKING:
    from smachac.analysis.accesses import Accesses
    from smachac.analysis.definite_assignment import DataFlow
    from smachac.analysis.expression_errors import Fault
    from smachac.analysis.expression_sites import ExpressionSite
    from smachac.analysis.failure_paths import Failure
    from smachac.analysis.item_reads import ItemRead
    from smachac.analysis.loaded_bodies import LoadingOrder
    from smachac.analysis.lost_outputs import Lost
    from smachac.analysis.possible_outcomes import Endings, Judged
    from smachac.analysis.properties import Judgement
    from smachac.analysis.resource_claims import Held
    from smachac.analysis.stop_paths import StopPaths
    from smachac.analysis.successors import Routes
    from smachac.analysis.type_inference import Clash, Types
    from smachac.analysis.type_lattice import MisfitKind
    from smachac.analysis.unset_reads import Cause, Missing
    from smachac.diagnostics.source import Span
    from smachac.ir.class_facts import ClassFacts
    from smachac.ir.script_paths import PlainPaths
    from smachac.ir.secret_keys import SecretKeys
    from smachac.ir.written import Written

C = TypeVar("C")
T = TypeVar("T")

Facts: TypeAlias = "dict[tuple[Callable[..., object], str], tuple[object, object]]"
"""Facts about containers with the containers, by the function that computes them and the path."""


class Context:
    """The analysis results of one machine.

    Rules and explanations receive a context. The analyses are plain functions in the other modules
    of this package: they take what they need, and none of them imports this module. They are
    imported where they are needed first: no machine needs all. Results are shared, so nobody may
    change them.
    """

    def __init__(
        self,
        machine: Machine,
        previous: Context | None = None,
        project: ProjectCode | None = None,
    ) -> None:
        """`previous` is the context of the machine before a change. Its facts about a container
        are used for this machine if the container is the same object. `project` is the code of the
        user around the machine; without it, the rules about that code find nothing."""
        self.machine = machine
        self.project = project
        self._scopes = previous.absorbed_flow.scopes if previous is not None else {}
        self._known = previous._facts if previous is not None else {}
        self._facts: Facts = {}
        self._found_before = previous._found if previous is not None else {}
        self._found: dict[Fact, IncrementalResult] = {}
        self._of_machine: dict[Callable[[Context], object], object] = {}

    def of_container(self, fact: Callable[[C], T], path: str, container: C) -> T:
        """A fact about one container or its userdata scope, which is a function of nothing else;
        computed once."""
        which = fact, path
        found = self._facts.get(which)
        if found is None or found[0] is not container:
            found = self._known.get(which)
            if found is None or found[0] is not container:
                found = container, fact(container)
            self._facts[which] = found
        return cast(T, found[1])

    def of_machine(self, fact: Callable[[Context], T]) -> T:
        """A fact about the whole machine, which is a function of this context; computed once."""
        if fact not in self._of_machine:
            self._of_machine[fact] = fact(self)
        return cast(T, self._of_machine[fact])

    def at_states(self, fact: Callable[..., Iterable[T]], *given: object) -> tuple[T, ...]:
        """What a function finds at each state that can have values, in the order of `states`: at
        containers, and leaves with variables.

        It is a function of the path and the node. `given` are more arguments for it: of these it
        uses only what belongs to the state types below the node. So the result for a container and
        all below it holds for the next machine too, if the container is the same object.
        """
        return self._found_at(self._with_values, fact, given)

    def at_containers(self, fact: Callable[..., Iterable[T]], *given: object) -> tuple[T, ...]:
        """What a function finds at each container, in the order of `containers`: see `at_states`.
        It may use the children as well."""
        return self._found_at(self._containers, fact, given)

    def _found_at(
        self, states: Preorder, fact: Callable[..., Iterable[T]], given: tuple[object, ...]
    ) -> tuple[T, ...]:
        if fact not in self._found:
            self._found[fact] = found_at(states, fact, given, self._found_before.get(fact))
        return cast("tuple[T, ...]", self._found[fact].things)

    @cached_property
    def states(self) -> tuple[tuple[str, Node], ...]:
        """All nodes with their paths, parents before children."""
        return tuple(traversal.walk(self.machine.root))

    @cached_property
    def containers(self) -> tuple[tuple[str, Container], ...]:
        """The containers with their paths, parents before children."""
        return tuple((path, node) for path, node in self.states if not isinstance(node, Leaf))

    @cached_property
    def around_any_key(self) -> frozenset[str]:
        """The paths of the containers around states of YASMIN that can use any key: their remapping
        is for these states."""
        found: set[str] = set()
        for path, node in self.states:
            outer = path.rpartition("/")[0] if isinstance(node, Leaf) and node.any_key else ""
            while outer and outer not in found:
                found.add(outer)
                outer = outer.rpartition("/")[0]
        return frozenset(found)

    @cached_property
    def leaves_with_variables(self) -> tuple[tuple[str, Leaf], ...]:
        """The leaves that have variables or input keys, with their paths."""
        return tuple(
            (path, node)
            for path, node in self.states
            if isinstance(node, Leaf) and (node.variables or node.inputs)
        )

    @cached_property
    def code_slots(self) -> tuple[tuple[str, Node, CodeSlot], ...]:
        """The code slots with code in them, each with the path and its state."""
        return self.at_states(_slots_of, self.machine.state_types)

    @cached_property
    def leaves_with_class(self) -> tuple[tuple[str, Leaf, ClassFacts, Container], ...]:
        """The leaves whose class was read, each with its path, the facts of the class, and its
        container."""
        return tuple(
            (f"{path}/{child.name}", child, child.class_facts, container)
            for path, container in self.containers
            for child in container.children
            if isinstance(child, Leaf) and child.class_facts is not None
        )

    @cached_property
    def _with_values(self) -> Preorder:
        return Preorder([state for state in self.states if _has_values(state[1])], _has_values)

    @cached_property
    def _containers(self) -> Preorder:
        return Preorder(self.containers, _is_container)

    @cached_property
    def linear(self) -> tuple[tuple[str, Linear], ...]:
        """The containers whose states follow one another along transitions."""
        return tuple(
            (path, container)
            for path, container in self.containers
            if isinstance(container, StateMachine | nodes.Sequence)
        )

    @cached_property
    def absorbed(self) -> tuple[Linear, ...]:
        """The containers of `linear`, with unknown names absorbed."""
        return tuple(
            self.of_container(absorbed, path, container) for path, container in self.linear
        )

    @cached_property
    def misnamed(self) -> tuple[tuple[str, Linear], ...]:
        """The containers of `linear` with a transition for an unknown outcome, or to an unknown
        target."""
        pairs = zip(self.linear, self.absorbed, strict=True)
        return tuple(pair for pair, whole in pairs if whole is not pair[1])

    @cached_property
    def spans(self) -> dict[str, Span]:
        """The span of each state by path; of two states with one path, that of the first."""
        return {path: node.span for path, node in reversed(self.states)}

    @cached_property
    def script_paths(self) -> dict[str, str]:
        """The paths of the script by full path; only those that differ."""
        from smachac.ir.script_paths import script_paths

        return script_paths(self.machine.root)

    @cached_property
    def written(self) -> Written:
        """The states as they were written."""
        from smachac.ir.written import written

        return written(self.machine)

    @cached_property
    def plain_paths(self) -> PlainPaths:
        """The paths of the script without roles, by full path; only those that differ."""
        from smachac.ir.script_paths import plain_paths

        return plain_paths(self.machine.root)

    @cached_property
    def secret_keys(self) -> SecretKeys:
        """The secret keys of each state, by path."""
        from smachac.ir.secret_keys import secret_keys

        return secret_keys(self.machine)

    @cached_property
    def types(self) -> Types:
        """The types of userdata."""
        from smachac.analysis.type_inference import infer

        return infer(self.machine)

    @cached_property
    def _reaching(self) -> dict[MisfitKind, list[Clash]]:
        from smachac.analysis.reaching_values import reaching_clashes

        return reaching_clashes(self.types.clashes)

    @cached_property
    def item_reads(self) -> tuple[ItemRead, ...]:
        """The reads of the list of a loop that mean its item."""
        found = [clash for some in self._reaching.values() for clash in some]
        if not found:
            return ()
        from smachac.analysis.item_reads import item_reads

        return tuple(item_reads(found, dict(self.containers)))

    @cached_property
    def clashes(self) -> dict[MisfitKind, list[Clash]]:
        """The type clashes whose value reaches its reader, by kind; not those of `item_reads`."""
        taken = {id(read.clash) for read in self.item_reads}
        return {
            kind: [clash for clash in found if id(clash) not in taken]
            for kind, found in self._reaching.items()
        }

    @cached_property
    def expression_faults(self) -> list[tuple[ExpressionSite, Fault]]:
        """The type errors in the code of the script."""
        if not self.code_slots and not any(
            True for _, state in self.states for _ in traversal.expressions(state)
        ):
            return []
        from smachac.analysis.expression_sites import faulty_sites

        return [*faulty_sites(self._with_values.nodes, self.types, self.machine.state_types)]

    @cached_property
    def _filled_loops(self) -> frozenset[str]:
        from smachac.analysis.filled_lists import filled_loops

        return filled_loops(self.containers, lambda: self.accesses)

    @cached_property
    def flow(self) -> DataFlow:
        """The data flow of the machine as written."""
        from smachac.analysis.definite_assignment import data_flow

        return data_flow(self.machine, self._scopes, self._filled_loops)

    @cached_property
    def absorbed_flow(self) -> DataFlow:
        """The data flow of the machine with unknown names absorbed."""
        from smachac.analysis.definite_assignment import data_flow
        from smachac.analysis.error_recovery import absorbed_machine

        machine = absorbed_machine(self.machine, self.containers, self._absorbed_container)
        return (
            self.flow
            if machine is self.machine
            else data_flow(machine, self._scopes, self._filled_loops)
        )

    def _absorbed_container(self, path: str, container: Container) -> Container:
        from smachac.analysis.error_recovery import absorbed_keys

        whole = self.of_container(absorbed_keys, path, container)
        if isinstance(whole, StateMachine | nodes.Sequence):
            return self.of_container(absorbed, path, whole)
        return whole

    @cached_property
    def _missing_keys(self) -> tuple[Missing, ...]:
        from smachac.analysis.unset_reads import missing_keys

        return missing_keys(self.absorbed_flow)

    def missing_keys(self, *causes: Cause) -> list[Missing]:
        """The keys that are missing for one of these causes, in the order of the script."""
        return [key for key in self._missing_keys if key.cause in causes]

    @cached_property
    def lost_outputs(self) -> tuple[Lost, ...]:
        """The keys that are written in a container, needed outside, and not handed out."""
        from smachac.analysis.lost_outputs import lost_outputs

        return lost_outputs(self.absorbed_flow, self.missing_keys("lost"), self.of_container)

    @cached_property
    def accesses(self) -> dict[str, Accesses]:
        """What each state reads and writes of the userdata around it."""
        from smachac.analysis.accesses import accesses

        return accesses(self.states)

    @cached_property
    def claims(self) -> Held:
        """The resources that each state holds while it runs."""
        from smachac.analysis.resource_claims import claims

        return claims(self.states, self.containers, lambda: self.accesses)

    @cached_property
    def endless(self) -> frozenset[str]:
        """The paths of the states that never end."""
        return endless_states(self.states)

    @cached_property
    def traps(self) -> dict[str, Trap]:
        """The containers with states from which no outcome can be reached, by path."""
        found = {}
        for (path, container), whole in zip(self.linear, self.absorbed, strict=True):
            if isinstance(container, StateMachine) and container.forever:
                continue
            flow = outline(path, container, self.endless, whole)
            if stuck := self.of_container(stuck_states, path, flow):
                found[path] = Trap(container, flow, stuck)
        return found

    @cached_property
    def endings(self) -> Endings:
        """The outcomes that states in concurrences can end with."""
        from smachac.analysis.possible_outcomes import endings

        return endings(self.states)

    @cached_property
    def judged(self) -> list[Judged]:
        """The concurrences whose rules can be judged."""
        from smachac.analysis.possible_outcomes import judged

        return judged(self.containers, self.endings)

    @cached_property
    def stop_paths(self) -> StopPaths:
        """Where the machine continues after a stop."""
        from smachac.analysis.stop_paths import stop_paths

        judged = {other.path: other for other in self.judged}

        def holds(path: str) -> bool:
            return bool(self.claims.get(path))

        return stop_paths(self.containers, judged, self.endless, holds)

    @cached_property
    def routes(self) -> Routes:
        """The control flow of the whole machine."""
        from smachac.analysis.successors import Routes

        return Routes(self.states, self.endings)

    @cached_property
    def bodies_loaded(self) -> Mapping[str, str] | None:
        """The states that load a body into the simulated world, each with the name of the body;
        None where they are not known."""
        from smachac.analysis.loaded_bodies import bodies_loaded

        return bodies_loaded(self.states)

    @cached_property
    def loading_order(self) -> LoadingOrder:
        """The states that can run before the bodies of the simulated world are loaded."""
        from smachac.analysis.loaded_bodies import LoadingOrder

        return LoadingOrder(self.routes, self.bodies_loaded or {})

    @cached_property
    def judgements(self) -> tuple[Judgement, ...]:
        """The properties of the script with their verdicts; none where two states have one name
        (SM106), because it is not known which of them a property means."""
        if not self.machine.properties or len(dict(self.states)) < len(self.states):
            return ()
        from smachac.analysis.properties import judge

        return tuple(judge(self.machine.properties, self.machine.root, self.claims))

    @cached_property
    def code_facts(self) -> CodeFacts:
        """The facts about the classes and templates of the user; none without such code."""
        if self.project is None:
            return CodeFacts()
        own = self.project.library.own_template
        if not any(
            type_.class_facts is not None or own(file) is not None
            for name, type_ in self.machine.state_types.items()
            for file in (f"{name}.yml", type_.code.get("python", name))
        ):
            return CodeFacts()
        from smachac.analysis.state_code import code_facts

        return code_facts(self.machine, self.project)

    @cached_property
    def failures(self) -> tuple[Failure, ...]:
        """Every failure that can begin, with where it leads."""
        from smachac.analysis.failure_paths import failures

        return tuple(failures(self.states, self.routes, self.plain_paths))


def _slots_of(
    path: str, node: Node, types: Mapping[str, StateType]
) -> Iterator[tuple[str, Node, CodeSlot]]:
    yield from ((path, node, slot) for slot in code_slots(node, types))


def _has_values(node: Node) -> bool:
    return not isinstance(node, Leaf) or bool(node.variables)


def _is_container(node: Node) -> bool:
    return not isinstance(node, Leaf)

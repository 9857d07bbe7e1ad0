"""Iterator: a container that runs one state for each item of an iterable."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from smachac.runtime.smach import settings
from smachac.runtime.smach.container import Container, needs_request, open_container, withdraw
from smachac.runtime.smach.exceptions import InvalidUserCodeError
from smachac.runtime.smach.failures import child_error
from smachac.runtime.smach.log import quiet
from smachac.runtime.smach.state import State
from smachac.runtime.smach.user_data import UserData

_NO_MORE = object()


class Iterator(Container):
    """A container that runs its only child for each item in turn.

    The child gets the iterator's own userdata, with the item in the key `it_label`.
    `it` is an iterable, or a function without arguments that returns one at each start.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        input_keys: list[str] | None,
        output_keys: list[str] | None,
        it: Iterable[Any] | Callable[[], Iterable[Any]] = (),
        it_label: str = "it_data",
        exhausted_outcome: str = "exhausted",
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self.register_outcomes([exhausted_outcome])
        self._exhausted = exhausted_outcome
        self._items = it
        self._item_key = it_label
        self._label = ""
        self._state: State | None = None
        self._looping: tuple[str, ...] = ()
        self._breaking: tuple[str, ...] = ()
        self._final: dict[Any, str] = {}
        self._active: State | None = None
        self._last_outcome: str | None = None
        self._left_flagged = False

    # Construction

    @staticmethod
    def set_contained_state(
        label: str,
        state: State,
        loop_outcomes: Iterable[str] = (),
        break_outcomes: Iterable[str] = (),
        final_outcome_map: Mapping[str, str] | None = None,
    ) -> None:
        """Set the child of the innermost open iterator.

        With `break_outcomes`, all other outcomes of the child continue with the next item; without,
        only `loop_outcomes` do. With neither, every registered outcome ends the iterator.
        `final_outcome_map` renames the outcome with which the iterator ends.
        """
        iterator = open_container(Iterator)
        breaking, looping = tuple(break_outcomes), tuple(loop_outcomes)
        if breaking:
            if looping:
                settings.logwarn(f"'{label}': loop_outcomes are ignored beside break_outcomes")
            looping = tuple(o for o in state.get_registered_outcomes() if o not in breaking)
        elif not looping:
            breaking = tuple(state.get_registered_outcomes())
        iterator._label, iterator._state = label, state
        iterator._looping, iterator._breaking = looping, breaking
        iterator._final = dict(final_outcome_map or {})

    @staticmethod
    def set_iteritems(
        it: Iterable[Any] | Callable[[], Iterable[Any]], it_label: str = "it_data"
    ) -> None:
        """Set the items of the innermost open iterator, and their userdata key."""
        iterator = open_container(Iterator)
        iterator._items, iterator._item_key = it, it_label

    def check_consistency(self) -> None:
        """Check nothing: an iterator is not checked before it runs."""

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData | None) -> None:
        """Merge `userdata`; KeyError for a label other than the child's."""
        for label in initial_states:
            if label != self._label:
                raise KeyError(label)
        if userdata is not None:
            self.userdata.update(userdata)

    # Introspection

    def get_children(self) -> dict[str, State]:
        """The one child by its label."""
        return {} if self._state is None else {self._label: self._state}

    def get_initial_states(self) -> list[str]:
        """The child's label."""
        return [self._label]

    def get_active_states(self) -> list[str]:
        """The child's label while the iterator runs."""
        return [self._label] if self._running.locked() else []

    def get_child_outcomes(self) -> dict[str, str | None]:
        """The child's label, and the outcome with which it ended last in this run."""
        return {} if self._last_outcome is None else {self._label: self._last_outcome}

    def get_internal_edges(self) -> list[Sequence[str | None]]:
        """[outcome, label, label] for looping outcomes, else (outcome, label, renamed or None)."""
        if self._state is None:
            return []
        edges: list[Sequence[str | None]] = []
        for outcome in self._state.get_registered_outcomes():
            if self._loops(outcome):
                edges.append([outcome, self._label, self._label])
            else:
                edges.append((outcome, self._label, self._final.get(outcome)))
        return edges

    # Execution

    def execute(self, parent_ud: Any = None) -> str | None:
        """Run the child for each item, up to a breaking outcome or the last item.

        Raises InvalidUserCodeError if the child raises; exceptions of the items are not changed.
        """
        self._claim()
        try:
            if self._left_flagged and self._state is not None and not settings.compat:
                withdraw(self._state)
            self._left_flagged = False
            self._last_outcome = None
            self.copy_input_keys(parent_ud)
            self.call_start_cbs()
            outcome = self._loop(iter(self._items() if callable(self._items) else self._items))
            self.copy_output_keys(parent_ud)
            self.call_termination_cbs(self._label, outcome)
            return outcome
        finally:
            self._active = None
            self._running.release()

    def _loop(self, items: Any) -> str | None:
        """Run the child for each item; the outcome, renamed by the final outcome map."""
        state: Any = self._state
        self._active = state
        outcome: str | None = self._exhausted
        while not settings.is_shutdown():
            try:
                item = next(items, _NO_MORE)
            except Exception:
                if not settings.compat:
                    raise
                item = _NO_MORE
            if item is _NO_MORE:
                outcome = self._exhausted
                break
            self.userdata[self._item_key] = item
            if self._preempt_requested and not settings.compat:
                self._pass_on(state)
            if settings.loginfo is not quiet:
                settings.loginfo(f"iterator running '{self._label}' for {item!r}")
            outcome = self._last_outcome = self._run_child(state)
            if self._preempt_requested:
                with self._preempting:
                    self._active = None
                    self.service_preempt()
                break
            if not self._loops(outcome):
                break
            self.call_transition_cbs()
        return self._final.get(outcome, outcome)

    def _run_child(self, state: Any) -> str | None:
        try:
            outcome: str | None = state.execute(self.userdata)
        except BaseException as error:
            failed = child_error(InvalidUserCodeError, self._label, state, error)
            if failed is error:
                raise
            raise failed from failed.__cause__
        return outcome

    def _loops(self, outcome: str | None) -> bool:
        if self._looping:
            return outcome in self._looping
        return outcome not in self._breaking

    # Preemption

    def request_preempt(self) -> None:
        """Request that the iterator ends after the current item, and that its child ends early;
        if it does not run, after the first item of the next run."""
        with self._preempting:
            super().request_preempt()
            if self._active is not None:
                self._pass_on(self._active)

    def _pass_on(self, state: State) -> None:
        self._left_flagged = True
        try:
            if needs_request(state):
                state.request_preempt()
        except Exception:
            settings.logerr(f"request_preempt failed:\n{traceback.format_exc()}")

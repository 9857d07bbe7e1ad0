"""The faults of building for a language: what it cannot express, what has no code in it."""

from __future__ import annotations

from smachac.diagnostics import Finding, Severity, problem
from smachac.source import Span


@problem("SM601", "unsupported-by-target", Severity.ERROR)
def unsupported_by_target(
    span: Span, target: str, message: str, help: str | None = None
) -> Finding:
    """The target has no way to say what the script says.

    Python takes any code and any type. Other languages take portable expressions, and have to know
    the type of a value before they can hold it.

    Wrong:
        name: sm
        outcomes: [succeeded]
        states:
          - COUNT:
              template: CallbacksState
              output_keys: [total]
              callbacks: {total: 'lambda ud: [x for x in range(3)]'}

    Right:
        name: sm
        outcomes: [succeeded]
        states:
          - COUNT:
              template: CallbacksState
              output_keys: [total]
              callbacks: {total: 'lambda ud: sum([0, 1, 2])'}
    """
    return Finding(span=span, message=f"not for {target}: {message}", help=help)


@problem("SM602", "no-code-for-target", Severity.ERROR)
def no_code_for_target(span: Span, target: str, state_type: str, states: int) -> Finding:
    """A state has code, but none in the language of the target.

    The interface of the state type tells, under `code`, where its code is for each language.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: ScriptedState, outcomes: [done]}
    """
    number = f" ({states} states)" if states > 1 else ""
    message = f"not for {target}: the state type `{state_type}` has no code in it{number}"
    help = f"name its class under `code` in `{state_type}.yml`"
    return Finding(span=span, message=message, help=help)

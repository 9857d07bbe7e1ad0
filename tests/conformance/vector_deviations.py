"""Recorded machines for which the bundled runtime deviates from SMACH (branch ros2) on purpose."""

from __future__ import annotations

from typing import Any

Json = Any
NOETIC = "what branch noetic did"


def _run(events: Json, **rest: Json) -> Json:
    return {"runs": [{"events": events, "userdata": {}, **rest}]}


def _entered(path: str, outcome: str | None, *marks: Json) -> Json:
    return [["+", path, *marks], ["-", path, outcome]]


DEVIATIONS: dict[str, tuple[str, Json]] = {
    "h030-keyboard-interrupt-is-wrapped": (
        "Ctrl-C must stop a machine: KeyboardInterrupt passes unchanged",
        _run(
            [["<", "/", ["A"]], ["+", "/A"], ["!", "/A", "user_exception"]],
            error="KeyboardInterrupt",
            category="user_exception",
        ),
    ),
    "h035-constants": (
        "the argument of branch noetic is accepted",
        NOETIC,
    ),
    "h036-constants-before-remap-every-entry": (
        "the argument of branch noetic is accepted",
        NOETIC,
    ),
    "h060-keys-under-remap": (
        "keys() lists the declared inputs that are present, under the child's names",
        {
            "runs": [
                {
                    "outcome": "done",
                    "events": [
                        ["<", "/", ["A"]],
                        *_entered("/A", "done", {"a": 1, "b": 3}),
                        [">", "/", ["A"], "done"],
                    ],
                    "userdata": {"a": 2, "b": 3, "r": ["a", "b"], "x": 1},
                }
            ]
        },
    ),
    "h089-concurrence-empty": (
        "no hang: an empty concurrence raises, as on branch noetic",
        NOETIC,
    ),
    "h097-concurrence-child-none": (
        "no hang: a child without an outcome has failed",
        _run(
            [["<", "/", ["A"]], ["|", "/", {"A": _entered("/A", None)}]],
            error="InvalidStateError",
            category="other",
        ),
    ),
    "h098-concurrence-inconsistent-child": (
        "no hang: a child without an outcome has failed",
        {
            "inconsistent": ["/A"],
            **_run(
                [["<", "/", ["A"]], ["|", "/", {}]],
                error="InvalidStateError",
                category="other",
                scopes={"/A": {}},
            ),
        },
    ),
    "h099-concurrence-term-cb-raises": (
        "no hang: the branch whose callback raised has failed",
        _run(
            [["<", "/", ["A"]], ["|", "/", {"A": _entered("/A", "done")}]],
            error="InvalidStateError",
            category="user_callback",
        ),
    ),
    "h104-concurrence-sibling-flag-stays": (
        "no stale request: a concurrence takes back what its children did not answer",
        _run(
            [
                ["<", "/", ["C"]],
                ["<", "/C", ["A", "B"]],
                [
                    "|",
                    "/C",
                    {
                        "A": _entered("/C/A", "done"),
                        "B": [
                            ["+", "/C/B"],
                            ["P", "/C/B"],
                            ["-", "/C/B", "done"],
                            ["R", "/C/B"],
                        ],
                    },
                ],
                [">", "/C", ["A", "B"], "ok"],
                ["~", "/", ["T"]],
                *_entered("/T", "again"),
                ["~", "/", ["C"]],
                ["<", "/C", ["A", "B"]],
                [
                    "|",
                    "/C",
                    {"A": _entered("/C/A", "quiet"), "B": _entered("/C/B", "done")},
                ],
                [">", "/C", ["A", "B"], "ok"],
                ["~", "/", ["T"]],
                *_entered("/T", "end"),
                [">", "/", ["T"], "end"],
            ],
            outcome="end",
            scopes={"/C": {}},
        ),
    ),
    "h134-preempt-iterator-before": (
        "no lost request: the first item gets it",
        {
            "runs": [
                {
                    "outcome": "preempted",
                    "events": [
                        ["<", "/", ["X"]],
                        ["P", "/X"],
                        *_entered("/X", "preempted", {}, "P"),
                        [">", "/", "X", "preempted"],
                    ],
                    "userdata": {"it_data": 1},
                },
                {
                    "outcome": "exhausted",
                    "events": [
                        ["<", "/", ["X"]],
                        *([*_entered("/X", "done"), ["~", "/", ["X"]]] * 3),
                        [">", "/", "X", "exhausted"],
                    ],
                    "userdata": {"it_data": 3},
                },
            ]
        },
    ),
    "h137-preempt-concurrence-before": (
        "no lost request: children are told before they start",
        _run(
            [
                ["<", "/", ["A"]],
                ["|", "/", {"A": [["P", "/A"], *_entered("/A", "preempted", {}, "P")]}],
                [">", "/", ["A"], "no"],
            ],
            outcome="no",
        ),
    ),
    "h138-preempt-concurrence-in-machine": (
        "no lost request: children are told before they start",
        _run(
            [
                ["<", "/", ["C"]],
                ["<", "/C", ["A"]],
                ["|", "/C", {"A": [["P", "/C/A"], *_entered("/C/A", "preempted", {}, "P")]}],
                [">", "/C", ["A"], "no"],
                [">", "/", ["C"], "no"],
            ],
            outcome="no",
            scopes={"/C": {}},
        ),
    ),
}
"""Case -> (why the runtime does something else than SMACH, what it does instead)."""

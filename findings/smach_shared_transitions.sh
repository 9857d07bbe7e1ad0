#!/usr/bin/env bash
# One dictionary of transitions for two states: SMACH (standalone-smach 0.0.9 of PyPI, whose
# StateMachine.add is that of executive_smach) keeps the dictionary that it gets, and writes into it.
#
# Guess before the run: `add` reads its argument, so that one dictionary can serve several states that
# have all its outcomes, as the transitions of a machine that is written as data often do.
# Seen: the guess fails. `add` writes the outcomes of the state that have no transition into the
# dictionary, with None. If the next state lacks one of these outcomes, its `add` raises
# InvalidTransitionError about an outcome that nobody wrote for it. In the other order, the state with
# fewer outcomes first, the same program works.
# Output of the run:
#   fewer outcomes first: no error
#   more outcomes first: {'ok': 'done', 'failed': None}, then InvalidTransitionError
# The exit code is 1 if SMACH behaves in another way.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip -q install standalone-smach==0.0.9
cat >"$folder/shared.py" <<'PY'
import smach

smach.set_loggers(*[lambda text: None] * 4)


class Work(smach.State):
    def execute(self, userdata):
        return "ok"


def build(*lists):
    """The dictionary after the first state, and the error of the second, if there is one."""
    table = {"ok": "done"}
    machine = smach.StateMachine(outcomes=["done", "failed"])
    with machine:
        smach.StateMachine.add("FIRST", Work(outcomes=lists[0]), table)
        after = dict(table)
        try:
            smach.StateMachine.add("SECOND", Work(outcomes=lists[1]), table)
        except smach.InvalidTransitionError as error:
            return after, type(error).__name__
    return after, "no error"


few, many = ["ok"], ["ok", "failed"]
first, second = build(few, many), build(many, few)
print("fewer outcomes first:", first[1])
print(f"more outcomes first: {second[0]}, then {second[1]}")
expected = ({"ok": "done", "failed": None}, "InvalidTransitionError")
raise SystemExit(0 if first[1] == "no error" and second == expected else 1)
PY
"$folder/venv/bin/python" "$folder/shared.py"

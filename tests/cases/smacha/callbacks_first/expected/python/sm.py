# Made by smachac 0.1.0 from main.yml (sha256 7cbba04338abf83a).
"""The state machine `sm`."""

import csv
import glob
import os
import random

from smachac.runtime import signals
from smachac.runtime.additions import with_callbacks

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


def columns(name, value, ignored):
    """Pairs of column name and value; each field of a message is one column."""
    fields = getattr(value, "__slots__", None)
    if fields is None or isinstance(value, (str, int, float)):
        return [(name, value)]
    found = []
    for field in fields:
        if field not in ignored:
            found += columns(f"{name}_{field}", getattr(value, field), ignored)
    return found


class RandomOutcomeState(smach.State):
    """Ends with a random outcome; a seed makes the sequence the same in each run."""

    def __init__(self, outcomes, seed=None, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.writes_outcome = "outcome" in output_keys
        self.choices = list(outcomes)
        # Without a seed, each state has its own generator with a seed from `random`.
        self.random = random.Random(random.getrandbits(64) if seed is None else seed)

    def execute(self, userdata):
        outcome = self.random.choice(self.choices)
        if self.writes_outcome:
            userdata["outcome"] = outcome
        return outcome


class WriteCSVFileState(smach.State):
    """Writes values of userdata keys to one row of a CSV file.

    If the only value is a list, each item of the list is one row.
    """

    def __init__(self, delimiter=",", input_keys=("file", "data_keys"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.delimiter = delimiter

    def execute(self, userdata):
        try:
            rows = self.rows(userdata)
            names = [name for name, _ in rows[0]] if rows else []
            header = userdata["header"] if "header" in userdata else names
            with open(userdata["file"], "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, delimiter=self.delimiter)
                writer.writerow(header)
                writer.writerows([value for _, value in row] for row in rows)
        except (KeyError, OSError) as error:
            smach.logwarn(f"the CSV file cannot be written: {error}")
            return "aborted"
        if "header" in self.get_registered_output_keys():
            userdata["header"] = header
        return "succeeded"

    def rows(self, userdata):
        """The rows as lists of pairs of column name and value."""
        ignored = userdata["ignore"] if "ignore" in userdata else ["header"]
        keys = userdata["data_keys"]
        values = [(key, userdata[key]) for key in keys]
        if len(values) == 1 and isinstance(values[0][1], (list, tuple)):
            key, items = values[0]
            return [columns(key, item, ignored) for item in items]
        return [[pair for key, value in values for pair in columns(key, value, ignored)]]


class DeleteFileState(smach.State):
    """Deletes the files that match a path pattern."""

    def __init__(self, input_keys=("file",), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )

    def execute(self, userdata):
        paths = glob.glob(userdata["file"])
        if not paths:
            smach.logwarn(f"no file matches {userdata['file']}")
            return "aborted"
        try:
            for path in sorted(paths):
                os.remove(path)
        except OSError as error:
            smach.logwarn(f"a file cannot be deleted: {error}")
            return "aborted"
        return "succeeded"


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    sm.userdata.folder = "logs"
    sm.userdata.word = "a"
    sm.userdata.tries = 0
    with sm:
        smach.StateMachine.add(  # main.yml:7
            "DRAW",
            with_callbacks(
                RandomOutcomeState(
                    outcomes=["again", "enough"],
                    seed=0,
                    input_keys=["tries"],
                    output_keys=["tries"],
                ),
                {"tries": lambda ud: ud.tries + 1},
            ),
            transitions={"again": "DRAW", "enough": "WRITE"},
        )

        smach.StateMachine.add(  # main.yml:15
            "WRITE",
            with_callbacks(
                WriteCSVFileState(
                    input_keys=["file", "data_keys", "folder", "word", "tries"],
                    output_keys=["file", "data_keys", "word"],
                ),
                {
                    "file": lambda ud: ud.folder + ".csv",
                    "data_keys": lambda ud: ["word", "tries"],
                    "word": lambda ud: ud.word + ud.word,
                },
            ),
            transitions={"succeeded": "DELETE", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:24
            "DELETE",
            with_callbacks(
                DeleteFileState(input_keys=["file", "folder"], output_keys=["file"]),
                {"file": lambda ud: ud.folder + ".*"},
            ),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return sm


def main():
    """Run the state machine once and return its outcome."""
    sm = build()
    if __name__ == "__main__":
        signals.stop_at_signals(sm)
    return sm.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))

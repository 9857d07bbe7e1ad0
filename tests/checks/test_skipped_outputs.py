"""Output keys that a class sets only on some paths to the outcome that promises them."""

from __future__ import annotations

import textwrap

import pytest

from tests.checks.test_class_code import BODY, CLASS, findings

START = CLASS[: CLASS.index(BODY)]


def reported(body: str) -> list[str]:
    """Code, marked text and related places of each finding on SM314 for a class with this code
    after its constructor."""
    text = START + textwrap.indent(textwrap.dedent(body), "    ")
    return [
        f"{item.span.line} {item.message}: {item.related[0].span.text}: {item.related[0].message}"
        for item in findings(text)
        if item.code == "SM314"
    ]


FAULTS = {
    "a condition": (
        """
        def execute(self, userdata):
            pose = camera.look()
            if pose.ok:
                userdata.pose = pose
            return "found"
        """,
        "if pose.ok:: if this is false, `pose` is not set",
    ),
    "the other branch": (
        """
        def execute(self, userdata):
            if self.preempt_requested():
                print("stopped")
            else:
                userdata.pose = camera.look()
            return "found"
        """,
        "if self.preempt_requested():: if this is true, `pose` is not set",
    ),
    "a branch of three": (
        """
        def execute(self, userdata):
            if userdata.tries == 0:
                userdata.pose = camera.look()
            elif userdata.tries == 1:
                print("again")
            else:
                userdata.pose = camera.look(self.speed)
            return "found"
        """,
        "elif userdata.tries == 1:: if this is true, `pose` is not set",
    ),
    "an exception": (
        """
        def execute(self, userdata):
            try:
                userdata.pose = camera.look()
            except TimeoutError:
                print("late")
            return "found"
        """,
        "except TimeoutError:: after this exception, `pose` is not set",
    ),
    "a loop that finds nothing": (
        """
        def execute(self, userdata):
            for pose in camera.look():
                if pose.ok:
                    userdata.pose = pose
                    break
            return "found"
        """,
        "for pose in camera.look():: this loop can end without setting `pose`",
    ),
    "a case": (
        """
        def execute(self, userdata):
            match camera.look():
                case [pose]:
                    userdata.pose = pose
                case _:
                    print("none")
            return "found"
        """,
        "match camera.look():: not every `case` sets `pose`",
    ),
    "a helper": (
        """
        def execute(self, userdata):
            self.keep(userdata, camera.look())
            return "found"

        def keep(self, data, pose):
            if pose.ok:
                data.pose = pose
        """,
        "if pose.ok:: if this is false, `pose` is not set",
    ),
    "a helper with a return": (
        """
        def execute(self, userdata):
            self.keep(userdata, camera.look())
            return "found"

        def keep(self, data, pose):
            if not pose.ok:
                return
            data.pose = pose
        """,
        "return: this `return` comes before `pose` is set",
    ),
    "a helper that returns the outcome": (
        """
        def execute(self, userdata):
            return self.keep(userdata, camera.look())

        def keep(self, data, pose):
            if pose.ok:
                data.pose = pose
            return "found"
        """,
        "if pose.ok:: if this is false, `pose` is not set",
    ),
    "another condition before": (
        """
        def execute(self, userdata):
            poses = camera.look()
            if not poses:
                return "lost"
            if len(poses) == 1:
                userdata.pose = poses[0]
            return "found"
        """,
        "if len(poses) == 1:: if this is false, `pose` is not set",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_path_past_the_assignment(name: str) -> None:
    body, place = FAULTS[name]
    (found,) = reported(body)
    message = "`FindPart` can return `found` without setting its output key `pose`"
    assert found.partition(" ")[2] == f"{message}: {place}"


CORRECT = {
    "every branch": """
        def execute(self, userdata):
            if self.speed > 1:
                userdata.pose = camera.look()
            else:
                userdata.pose = None
            return "found"
        """,
    "a value before": """
        def execute(self, userdata):
            userdata.pose = None
            if self.speed > 1:
                userdata.pose = camera.look()
            return "found"
        """,
    "the branches of every mode": """
        def execute(self, userdata):
            if self.speed == 1:
                userdata.pose = camera.look()
            elif self.speed == 2:
                userdata.pose = camera.look(2)
            return "found"
        """,
    "the same condition again": """
        def execute(self, userdata):
            pose = camera.look()
            if pose is not None:
                userdata.pose = pose
            if pose is None:
                return "lost"
            return "found"
        """,
    "the opposite condition before": """
        def execute(self, userdata):
            poses = camera.look()
            if len(poses) == 0:
                return "lost"
            if poses:
                userdata.pose = poses[0]
            return "found"
        """,
    "a flag": """
        def execute(self, userdata):
            seen = False
            for pose in camera.look():
                if pose.ok:
                    userdata.pose = pose
                    seen = True
            if not seen:
                return "lost"
            return "found"
        """,
    "a condition in the return": """
        def execute(self, userdata):
            pose = camera.look()
            if pose:
                userdata.pose = pose
            return "found" if pose else "lost"
        """,
    "an outcome in a variable": """
        def execute(self, userdata):
            result = "lost"
            pose = camera.look()
            if pose:
                userdata.pose = pose
                result = "found"
            return result
        """,
    "an outcome of a table": """
        def execute(self, userdata):
            pose = camera.look()
            if pose:
                userdata.pose = pose
            return {True: "found", False: "lost"}[bool(pose)]
        """,
    "a helper that says whether": """
        def execute(self, userdata):
            if not self.look(userdata):
                return "lost"
            return "found"

        def look(self, data):
            pose = camera.look()
            if pose is None:
                return False
            data.pose = pose
            return True
        """,
    "a helper that judges": """
        def execute(self, userdata):
            pose = camera.look()
            if pose:
                userdata.pose = pose
            return self.verdict(pose)

        def verdict(self, pose):
            if pose:
                return "found"
            return "lost"
        """,
    "for and else": """
        def execute(self, userdata):
            for pose in camera.look():
                if pose.ok:
                    userdata.pose = pose
                    break
            else:
                return "lost"
            return "found"
        """,
    "a loop with a round": """
        def execute(self, userdata):
            for _ in range(3):
                userdata.pose = camera.look()
            return "found"
        """,
    "a loop until it is seen": """
        def execute(self, userdata):
            while True:
                pose = camera.look()
                if pose:
                    userdata.pose = pose
                    break
            return "found"
        """,
    "an exception that ends": """
        def execute(self, userdata):
            try:
                userdata.pose = camera.look()
            except TimeoutError:
                return "lost"
            return "found"
        """,
    "an exception after it": """
        def execute(self, userdata):
            pose = camera.look()
            try:
                userdata.pose = pose
                camera.stop()
            except TimeoutError:
                print("late")
            return "found"
        """,
    "a handler that sets it": """
        def execute(self, userdata):
            try:
                userdata.pose = camera.look()
            except TimeoutError:
                userdata.pose = None
            finally:
                camera.stop()
            return "found"
        """,
    "a key that is examined": """
        def execute(self, userdata):
            if "pose" not in userdata:
                userdata.pose = camera.look()
            return "found"
        """,
    "an assertion": """
        def execute(self, userdata):
            pose = camera.look()
            if pose:
                userdata.pose = pose
            assert pose
            return "found"
        """,
}


@pytest.mark.parametrize("name", CORRECT)
def test_no_path_past_the_assignment(name: str) -> None:
    assert reported(CORRECT[name]) == []


def test_a_round_that_ends_the_state_sets_nothing_for_the_next() -> None:
    body = """
        def execute(self, userdata):
            for poses in camera.look():
                if not poses:
                    continue
                if len(poses) > 1:
                    return "found"
                userdata.pose = poses[0]
                return "found"
            return "lost"
        """
    (found,) = reported(body)
    assert found.startswith("17 `FindPart` returns `found` without setting its output key `pose`:")

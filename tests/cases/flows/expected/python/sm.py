# Made by smachac 0.1.0 from main.yml (sha256 077db97046fb669f).
"""The state machine `sm`."""

from smachac import sim
from smachac.runtime.additions import pass_on_stop_requests

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach
from smachac.runtime import signals


def outcome_of(state, result):
    """The outcome of a skill; unless it is `succeeded`, the reason is logged."""
    if result.outcome == "preempted":
        state.service_preempt()
    if result.outcome != "succeeded":
        smach.logwarn(f"{type(state).__name__}: {result.reason}")
    return result.outcome


def optional(userdata, key):
    """The value of a userdata key, or None if the key is absent."""
    if key in userdata:
        return userdata[key]
    return None


class PoseToJointPositionsState(smach.State):
    """Computes the joint positions for a tool pose (inverse kinematics)."""

    def __init__(self, limb=None, grasp=False):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=["pose", "offset"],
            output_keys=["joints"],
        )
        self.limb = limb
        self.grasp = grasp

    def execute(self, userdata):
        arm = sim.world().arm(self.limb)
        pose = userdata["pose"]
        if self.grasp:
            pose = arm.grasp_pose(pose)
        joints = arm.solve_ik(pose, optional(userdata, "offset"))
        if joints is None:
            place = [round(part, 3) for part in sim.as_pose(pose)[0]]
            smach.logwarn(f"PoseToJointPositionsState: {place} is out of reach")
            return "aborted"
        userdata["joints"] = joints
        return "succeeded"


class MoveToJointPositionsState(smach.State):
    """Moves one arm to joint positions along a straight line in joint space."""

    def __init__(self, limb=None, speed=1.0):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            input_keys=["positions"],
        )
        self.limb = limb
        self.speed = speed

    def execute(self, userdata):
        arm = sim.world().arm(self.limb)
        positions = userdata["positions"]
        result = arm.move_to_joints(positions, self.speed, self.preempt_requested)
        return outcome_of(self, result)


class CallbacksState(smach.State):
    """Calls functions of the userdata and writes each result to an output key."""

    def __init__(self, callbacks=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=["succeeded"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.callbacks = callbacks

    def execute(self, userdata):
        for key in sorted(self.callbacks):
            function = self.callbacks[key]
            if not smach.has_smach_interface(function):
                userdata[key] = function(userdata)
            else:  # the function writes its output keys
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return "succeeded"


class ScriptedState(smach.State):
    """Ends with scripted outcomes: visit n performs step n; the last step repeats.

    After a preempt request, the outcome is `preempted` if the state has that outcome.
    """

    def __init__(self, outcomes, steps=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.steps = list(steps) or [{"outcome": outcomes[0]}]
        self.visits = 0

    def execute(self, userdata):
        step = self.steps[min(self.visits, len(self.steps) - 1)]
        self.visits += 1
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        for key, value in step.get("set", {}).items():
            userdata[key] = value
        return step["outcome"]


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["done", "failed"])  # main.yml:2
    sm.userdata.home = [0, -0.785, 0, -2.356, 0, 1.571, 0.785]
    sm.userdata.poses = [
        [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]],
        [[0.4, 0.1, 0.1], [0.0, 1.0, 0.0, 0.0]],
    ]
    sm.userdata.tries = 0
    sm.userdata.best = None
    sm.userdata.word = "open"
    sm.userdata.word_2 = 5
    sm.userdata.depth = 1
    with sm:
        sm_each = smach.Iterator(  # main.yml:14
            outcomes=["done", "failed"],
            it=lambda: sm_each.userdata["poses"],
            it_label="pose",
            exhausted_outcome="done",
            input_keys=["poses"],
            output_keys=[],
        )
        with sm_each:
            sm_go = smach.StateMachine(  # main.yml:23
                outcomes=["reached", "failed"], input_keys=["pose"]
            )
            with sm_go:
                smach.StateMachine.add(  # main.yml:28
                    "PLAN",
                    PoseToJointPositionsState(),
                    transitions={"succeeded": "MOVE", "aborted": "failed"},
                    remapping={"joints": "goal"},
                )

                smach.StateMachine.add(  # main.yml:32
                    "MOVE",
                    MoveToJointPositionsState(),
                    transitions={
                        "succeeded": "reached",
                        "aborted": "failed",
                        "preempted": "failed",
                    },
                    remapping={"positions": "goal"},
                )

            smach.Iterator.set_contained_state("GO", sm_go, loop_outcomes=["reached"])

        smach.StateMachine.add("EACH", sm_each, transitions={"done": "COUNT", "failed": "failed"})

        smach.StateMachine.add(  # main.yml:37
            "COUNT",
            CallbacksState(
                callbacks={
                    "tries": lambda ud: ud.tries + 1,
                    "best": lambda ud: max(ud.tries / 2, 1),
                    "choice": lambda ud: "open" if ud.tries > 2 else "close",
                    "first": lambda ud: ud.poses[0],
                    "deeper": lambda ud: ud.depth + 0.1,
                    "near": lambda ud: [ud.depth, 0, 1.5],
                },
                input_keys=["tries", "depth", "poses"],
                output_keys=["tries", "best", "choice", "first", "deeper", "near"],
            ),
            transitions={"succeeded": "USE"},
        )

        smach.StateMachine.add(  # main.yml:49
            "USE",
            ScriptedState(
                outcomes=["done"],
                steps=[{"set": {"word_2": "five"}}],
                input_keys=[
                    "tries",
                    "best",
                    "choice",
                    "first",
                    "deeper",
                    "near",
                    "word",
                    "word_2",
                    "home",
                ],
                output_keys=["word_2"],
            ),
            transitions={"done": "AGAIN"},
        )

        smach.StateMachine.add(  # main.yml:65
            "AGAIN",
            ScriptedState(outcomes=["done"], input_keys=["word", "word_2", "tries"]),
            transitions={"done": "HOME"},
        )

        smach.StateMachine.add(  # main.yml:70
            "HOME",
            MoveToJointPositionsState(speed=1, limb=None),
            transitions={"succeeded": "done", "aborted": "failed", "preempted": "failed"},
            remapping={"positions": "home"},
        )
    pass_on_stop_requests(sm)
    return sm


def main():
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot="panda") as world:
        sm = build()
        world.attach(sm, "sm")
        if __name__ == "__main__":
            signals.stop_at_signals(sm)
        outcome = sm.execute()
        print(f"simulated time: {world.time:.2f} s")
        for name in world.bodies:
            x, y, z = world.pose(name)[0]
            rest = "at rest" if world.at_rest(name) else "moving"
            print(f"{name}: x {x:.4f} m, y {y:.4f} m, z {z:.4f} m, {rest}")
    return outcome


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))

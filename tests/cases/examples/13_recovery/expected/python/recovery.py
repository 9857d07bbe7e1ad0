# Made by smachac 0.1.0 from main.yml (sha256 429970c082ff5f57).
"""Pick and place a block in spite of faults."""

import threading

from smachac import sim

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


def withdraw(state):
    """Take back the unanswered stop requests of a state and of the states inside."""
    if state.preempt_requested():
        state.recall_preempt()
        for child in getattr(state, "get_children", dict)().values():
            withdraw(child)


def stoppable(container):
    """Let a container pass on every stop request, also an early one and a second one."""
    if not getattr(smach, "compat", True):  # the bundled runtime does so itself
        return container
    run, request = container.execute, container.request_preempt
    children = container.get_children
    concurrent = isinstance(container, smach.Concurrence)
    container.busy = container.asked = False

    def pass_on():
        for label in container.get_active_states() or list(children()):
            child = children().get(label)
            again = hasattr(child, "get_children")
            if child and (again or not child.preempt_requested()):
                child.request_preempt()

    def request_preempt():
        if not container.busy:
            return request()
        container.asked = True
        if not concurrent:
            smach.State.request_preempt(container)
        pass_on()

    def execute(*userdata):
        container.busy, container.asked = True, container.preempt_requested()
        if container.asked:
            pass_on()
        if concurrent:  # with its own request, SMACH for ROS 1 ends as preempted
            container.service_preempt()
        unanswered = True
        try:
            outcome = run(*userdata)
            unanswered = any(child.preempt_requested() for child in children().values())
            return outcome
        finally:
            container.busy = False
            for child in children().values():
                withdraw(child)
            if concurrent and container.asked and unanswered:
                request()

    if concurrent and container._child_termination_cb:
        ends = container._child_termination_cb

        def ends_others(outcomes):
            return not container.asked and ends(outcomes)

        container._child_termination_cb = ends_others
    container.execute, container.request_preempt = execute, request_preempt
    return container


def stoppable_again(machine):
    """Let a machine pass on a second stop request while the same container in it runs."""
    request, children = machine.request_preempt, machine.get_children

    def request_preempt():
        again = machine.preempt_requested() and getattr(smach, "compat", True)
        request()
        for label in machine.get_active_states() if again else ():
            if hasattr(children().get(label), "get_children"):
                children()[label].request_preempt()

    machine.request_preempt = request_preempt
    return machine


def ends_preempted(container):
    """Let a time limit or loop end as preempted after a request to stop."""
    run, request = container.execute, container.request_preempt
    recall = container.recall_preempt

    def request_preempt():
        container.stopped = True
        request()

    def recall_preempt():
        container.stopped = False
        recall()

    def execute(*userdata):
        container.stopped = container.stopped or container.preempt_requested()
        try:
            outcome = run(*userdata)
            if container.stopped:
                container.service_preempt()
                outcome = "preempted"
            return outcome
        finally:
            container.stopped = False

    container.execute, container.stopped = execute, False
    container.request_preempt = request_preempt
    container.recall_preempt = recall_preempt
    return container


class ReadBodyPoseState(smach.State):
    """Reads the present pose of a body of the simulated world."""

    def __init__(self, body):
        super().__init__(outcomes=["succeeded", "aborted"], output_keys=["pose"])
        self.body = body

    def execute(self, userdata):
        world = sim.world()
        if self.body not in world.bodies:
            smach.logwarn(f"ReadBodyPoseState: there is no body `{self.body}`")
            return "aborted"
        userdata["pose"] = world.measured_pose(self.body)
        return "succeeded"


class GripperState(smach.State):
    """Opens or closes a gripper."""

    def __init__(self, command, limb=None):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            output_keys=["width"],
        )
        self.command = command
        self.limb = limb

    def execute(self, userdata):
        result = sim.world().arm(self.limb).grip(self.command, self.preempt_requested)
        userdata["width"] = result.value
        return outcome_of(self, result)


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


class MoveAlongState(smach.State):
    """Moves the tool along a straight line to a pose."""

    def __init__(self, limb=None, grasp=False, speed=1.0):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            input_keys=["pose", "offset"],
        )
        self.limb = limb
        self.grasp = grasp
        self.speed = speed

    def execute(self, userdata):
        arm = sim.world().arm(self.limb)
        pose = userdata["pose"]
        if self.grasp:
            pose = arm.grasp_pose(pose)
        offset = optional(userdata, "offset")
        result = arm.move_along(pose, offset, self.speed, self.preempt_requested)
        return outcome_of(self, result)


class CheckGraspState(smach.State):
    """Checks that the gripper holds a body."""

    def __init__(self, limb=None, body=None):
        super().__init__(outcomes=["succeeded", "aborted"])
        self.limb = limb
        self.body = body

    def execute(self, userdata):
        return outcome_of(self, sim.world().arm(self.limb).check_grasp(self.body))


class CheckPlacedState(smach.State):
    """Checks that a body lies upright and at rest at its goal pose."""

    def __init__(self, body, tolerance=0.002):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=["pose"],
            output_keys=["error"],
        )
        self.body = body
        self.tolerance = tolerance

    def execute(self, userdata):
        world = sim.world()
        result = sim.check_placed(world, self.body, userdata["pose"], self.tolerance)
        userdata["error"] = result.value
        if result.value is not None:
            print(f"placing error of {self.body}: {1000 * result.value:.2f} mm")
        return outcome_of(self, result)


class SleepState(smach.State):
    """Waits for `time` seconds: a number, or a function of the userdata.

    A preempt request ends the wait.
    """

    def __init__(self, time, input_keys=(), outcomes=("succeeded", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
        )
        self.time = time
        self.end_of_wait = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.end_of_wait.set()

    def execute(self, userdata):
        self.end_of_wait.wait(self.time(userdata) if callable(self.time) else self.time)
        self.end_of_wait.clear()
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        return "succeeded"


def build():
    """Build the state machine `recovery`."""
    # main.yml:2
    recovery = stoppable_again(
        smach.StateMachine(outcomes=["succeeded", "aborted", "preempted"]),
    )
    recovery.userdata.left_home = [
        -0.08,
        -0.99998,
        -1.18997,
        1.94002,
        0.67,
        1.03001,
        -0.5,
    ]
    recovery.userdata.right_home = [
        0.08,
        -0.99998,
        1.18997,
        1.94002,
        -0.67,
        1.03001,
        0.5,
    ]
    recovery.userdata.hover_offset = [[0.0, 0.0, 0.12], [0.0, 0.0, 0.0, 1.0]]
    with recovery:
        # main.yml:14
        smach.StateMachine.add(
            "FIND_MARK",
            ReadBodyPoseState(body="mark"),
            transitions={"succeeded": "LEFT", "aborted": "aborted"},
            remapping={"pose": "goal_pose"},
        )

        # main.yml:20
        smach.StateMachine.add(
            "LEFT",
            build_try_arm(limb="left"),
            transitions={
                "succeeded": "succeeded",
                "exhausted": "RIGHT",
                "preempted": "preempted",
            },
            remapping={
                "goal_pose": "goal_pose",
                "hover_offset": "hover_offset",
                "home": "left_home",
            },
        )

        # main.yml:26
        smach.StateMachine.add(
            "RIGHT",
            build_try_arm(limb="right"),
            transitions={
                "succeeded": "succeeded",
                "exhausted": "aborted",
                "preempted": "preempted",
            },
            remapping={
                "goal_pose": "goal_pose",
                "hover_offset": "hover_offset",
                "home": "right_home",
            },
        )
    return recovery


def build_try_arm(limb):
    """Build the state machine of `try_arm.yml`.

    Pick and place the block with one arm, in at most three tries.
    """
    sm_try_arm = stoppable_again(
        smach.StateMachine(
            outcomes=["succeeded", "exhausted", "preempted"],
            input_keys=["goal_pose", "hover_offset", "home"],
        ),
    )
    with sm_try_arm:
        # try_arm.yml:10
        smach.StateMachine.add(
            "TRY",
            ends_preempted(build_try(limb=limb)),
            transitions={
                "succeeded": "HOME",
                "exhausted": "exhausted",
                "preempted": "preempted",
            },
        )

        # try_arm.yml:45
        smach.StateMachine.add(
            "HOME",
            MoveToJointPositionsState(limb=limb),
            transitions={
                "succeeded": "succeeded",
                "aborted": "exhausted",
                "preempted": "preempted",
            },
            remapping={"positions": "home"},
        )
    return sm_try_arm


def build_try(limb):
    """Build the iterator `TRY`."""
    sm_try = stoppable(
        smach.Iterator(
            outcomes=["succeeded", "preempted", "exhausted"],
            it=[1, 2, 3],
            it_label="attempt",
            exhausted_outcome="exhausted",
            input_keys=["goal_pose", "hover_offset", "home"],
            output_keys=[],
        ),
    )
    with sm_try:
        # try_arm.yml:10
        sm_try_2 = stoppable_again(
            smach.StateMachine(
                outcomes=["succeeded", "aborted", "preempted"],
                input_keys=["goal_pose", "hover_offset", "home"],
            ),
        )
        with sm_try_2:
            # try_arm.yml:17
            smach.StateMachine.add(
                "FIND_BLOCK",
                ReadBodyPoseState(body="block"),
                transitions={"succeeded": "CARRY", "aborted": "LET_GO"},
                remapping={"pose": "block_pose"},
            )

            # try_arm.yml:23
            # Pick a block up and place it.
            sm_carry = stoppable(
                smach.Concurrence(
                    outcomes=["succeeded", "aborted", "preempted", "timeout"],
                    default_outcome="timeout",
                    input_keys=["pick_pose", "place_pose", "hover_offset"],
                    outcome_map={
                        "succeeded": {"CARRY": "succeeded", "TIMER": "preempted"},
                        "aborted": {"CARRY": "aborted", "TIMER": "preempted"},
                        "preempted": {"CARRY": "preempted", "TIMER": "preempted"},
                    },
                    child_termination_cb=lambda outcomes: True,
                ),
            )
            with sm_carry:
                # try_arm.yml:23
                smach.Concurrence.add("CARRY", build_pick_and_place(limb=limb))

                # try_arm.yml:23
                smach.Concurrence.add("TIMER", SleepState(time=20.0))

            smach.StateMachine.add(
                "CARRY",
                ends_preempted(sm_carry),
                transitions={
                    "succeeded": "succeeded",
                    "aborted": "LET_GO",
                    "preempted": "preempted",
                    "timeout": "LET_GO",
                },
                remapping={
                    "pick_pose": "block_pose",
                    "place_pose": "goal_pose",
                    "hover_offset": "hover_offset",
                },
            )

            # try_arm.yml:32
            smach.StateMachine.add(
                "LET_GO",
                GripperState(limb=limb, command="open"),
                transitions={
                    "succeeded": "RETREAT",
                    "aborted": "RETREAT",
                    "preempted": "preempted",
                },
                remapping={"width": "gripper_width"},
            )

            # try_arm.yml:39
            smach.StateMachine.add(
                "RETREAT",
                MoveToJointPositionsState(limb=limb),
                transitions={
                    "succeeded": "aborted",
                    "aborted": "aborted",
                    "preempted": "preempted",
                },
                remapping={"positions": "home"},
            )

        smach.Iterator.set_contained_state(
            "TRY",
            sm_try_2,
            loop_outcomes=["aborted"],
            final_outcome_map={"aborted": "preempted"},
        )
    return sm_try


def build_pick_and_place(limb):
    """Build the state machine of `pick_and_place.yml`."""
    sm_pick_and_place = stoppable_again(
        smach.StateMachine(
            outcomes=["succeeded", "aborted", "preempted"],
            input_keys=["pick_pose", "place_pose", "hover_offset"],
        ),
    )
    with sm_pick_and_place:
        # pick_and_place.yml:8
        smach.StateMachine.add(
            "PICK_BLOCK",
            build_pick_block(limb=limb),
            transitions={
                "succeeded": "PLACE_BLOCK",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        # pick_and_place.yml:12
        smach.StateMachine.add(
            "PLACE_BLOCK",
            build_place_block(limb=limb),
            transitions={
                "succeeded": "succeeded",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )
    return sm_pick_and_place


def build_pick_block(limb):
    """Build the state machine of `pick_block.yml`.

    Grasp a block from above and lift it.
    """
    sm_pick_block = smach.StateMachine(
        outcomes=["succeeded", "aborted", "preempted"],
        input_keys=["pick_pose", "hover_offset"],
    )
    with sm_pick_block:
        # pick_block.yml:8
        smach.StateMachine.add(
            "OPEN_GRIPPER",
            GripperState(limb=limb, command="open"),
            transitions={
                "succeeded": "PLAN_HOVER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        # pick_block.yml:14
        smach.StateMachine.add(
            "PLAN_HOVER",
            PoseToJointPositionsState(limb=limb, grasp=True),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={
                "pose": "pick_pose",
                "offset": "hover_offset",
                "joints": "hover_joints",
            },
        )

        # pick_block.yml:21
        smach.StateMachine.add(
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(limb=limb),
            transitions={
                "succeeded": "MOVE_DOWN",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "hover_joints"},
        )

        # pick_block.yml:27
        smach.StateMachine.add(
            "MOVE_DOWN",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "CLOSE_GRIPPER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "pick_pose"},
        )

        # pick_block.yml:34
        smach.StateMachine.add(
            "CLOSE_GRIPPER",
            GripperState(limb=limb, command="close"),
            transitions={
                "succeeded": "LIFT",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        # pick_block.yml:40
        smach.StateMachine.add(
            "LIFT",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "CHECK_GRASP",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "pick_pose", "offset": "hover_offset"},
        )

        # pick_block.yml:47
        smach.StateMachine.add(
            "CHECK_GRASP",
            CheckGraspState(limb=limb, body="block"),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return sm_pick_block


def build_place_block(limb):
    """Build the state machine of `place_block.yml`.

    Place the block in the gripper and check where it lies.
    """
    sm_place_block = smach.StateMachine(
        outcomes=["succeeded", "aborted", "preempted"],
        input_keys=["place_pose", "hover_offset"],
    )
    with sm_place_block:
        # place_block.yml:9
        smach.StateMachine.add(
            "PLAN_HOVER",
            PoseToJointPositionsState(limb=limb, grasp=True),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={
                "pose": "place_pose",
                "offset": "hover_offset",
                "joints": "hover_joints",
            },
        )

        # place_block.yml:16
        smach.StateMachine.add(
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(limb=limb),
            transitions={
                "succeeded": "MOVE_DOWN",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "hover_joints"},
        )

        # place_block.yml:22
        smach.StateMachine.add(
            "MOVE_DOWN",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "OPEN_GRIPPER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "place_pose"},
        )

        # place_block.yml:29
        smach.StateMachine.add(
            "OPEN_GRIPPER",
            GripperState(limb=limb, command="open"),
            transitions={
                "succeeded": "MOVE_UP",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        # place_block.yml:35
        smach.StateMachine.add(
            "MOVE_UP",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "CHECK_PLACED",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "place_pose", "offset": "hover_offset"},
        )

        # place_block.yml:42
        smach.StateMachine.add(
            "CHECK_PLACED",
            CheckPlacedState(body="block", tolerance=0.001),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
            remapping={"pose": "place_pose", "error": "placing_error"},
        )
    return sm_place_block


def main():
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot="baxter", scene="table.yml") as world:
        recovery = build()
        world.attach(recovery, "recovery")
        if __name__ == "__main__":
            signals.stop_at_signals(recovery)
        outcome = recovery.execute()
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

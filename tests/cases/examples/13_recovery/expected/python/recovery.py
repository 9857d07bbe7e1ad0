# Made by smachac 0.1.0 from main.yml (sha256 429970c082ff5f57).
"""Pick and place a block in spite of faults."""

from smachac import sim
from smachac.runtime.additions import pass_on_stop_requests, with_retries, with_timeout

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


def build():
    """Build the state machine `recovery`."""
    recovery = smach.StateMachine(outcomes=["succeeded", "aborted", "preempted"])  # main.yml:2
    recovery.userdata.left_home = [-0.08, -0.99998, -1.18997, 1.94002, 0.67, 1.03001, -0.5]
    recovery.userdata.right_home = [0.08, -0.99998, 1.18997, 1.94002, -0.67, 1.03001, 0.5]
    recovery.userdata.hover_offset = [[0.0, 0.0, 0.12], [0.0, 0.0, 0.0, 1.0]]
    with recovery:
        smach.StateMachine.add(  # main.yml:14
            "FIND_MARK",
            ReadBodyPoseState(body="mark"),
            transitions={"succeeded": "LEFT", "aborted": "aborted"},
            remapping={"pose": "goal_pose"},
        )

        smach.StateMachine.add(  # main.yml:20
            "LEFT",
            build_try_arm(limb="left"),
            transitions={"succeeded": "succeeded", "exhausted": "RIGHT", "preempted": "preempted"},
            remapping={
                "goal_pose": "goal_pose",
                "hover_offset": "hover_offset",
                "home": "left_home",
            },
        )

        smach.StateMachine.add(  # main.yml:26
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
    pass_on_stop_requests(recovery)
    return recovery


def build_try_arm(limb):
    """Build the state machine of `try_arm.yml`.

    Pick and place the block with one arm, in at most three tries.
    """
    sm_try_arm = smach.StateMachine(
        outcomes=["succeeded", "exhausted", "preempted"],
        input_keys=["goal_pose", "hover_offset", "home"],
    )
    with sm_try_arm:
        sm_try = smach.StateMachine(  # try_arm.yml:10
            outcomes=["succeeded", "aborted", "preempted"],
            input_keys=["goal_pose", "hover_offset", "home"],
        )
        with sm_try:
            smach.StateMachine.add(  # try_arm.yml:17
                "FIND_BLOCK",
                ReadBodyPoseState(body="block"),
                transitions={"succeeded": "CARRY", "aborted": "LET_GO"},
                remapping={"pose": "block_pose"},
            )

            # Pick a block up and place it.
            smach.StateMachine.add(  # try_arm.yml:23
                "CARRY",
                with_timeout(build_pick_and_place(limb=limb), 20.0, "CARRY"),
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

            smach.StateMachine.add(  # try_arm.yml:32
                "LET_GO",
                GripperState(limb=limb, command="open"),
                transitions={
                    "succeeded": "RETREAT",
                    "aborted": "RETREAT",
                    "preempted": "preempted",
                },
                remapping={"width": "gripper_width"},
            )

            smach.StateMachine.add(  # try_arm.yml:39
                "RETREAT",
                MoveToJointPositionsState(limb=limb),
                transitions={
                    "succeeded": "aborted",
                    "aborted": "aborted",
                    "preempted": "preempted",
                },
                remapping={"positions": "home"},
            )

        smach.StateMachine.add(
            "TRY",
            with_retries(sm_try, 3, on=["aborted"], label="TRY"),
            transitions={"succeeded": "HOME", "exhausted": "exhausted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # try_arm.yml:45
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


def build_pick_and_place(limb):
    """Build the state machine of `pick_and_place.yml`."""
    sm_pick_and_place = smach.StateMachine(
        outcomes=["succeeded", "aborted", "preempted"],
        input_keys=["pick_pose", "place_pose", "hover_offset"],
    )
    with sm_pick_and_place:
        smach.StateMachine.add(  # pick_and_place.yml:8
            "PICK_BLOCK",
            build_pick_block(limb=limb),
            transitions={
                "succeeded": "PLACE_BLOCK",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # pick_and_place.yml:12
            "PLACE_BLOCK",
            build_place_block(limb=limb),
            transitions={"succeeded": "succeeded", "aborted": "aborted", "preempted": "preempted"},
        )
    return sm_pick_and_place


def build_pick_block(limb):
    """Build the state machine of `pick_block.yml`.

    Grasp a block from above and lift it.
    """
    sm_pick_block = smach.StateMachine(
        outcomes=["succeeded", "aborted", "preempted"], input_keys=["pick_pose", "hover_offset"]
    )
    with sm_pick_block:
        smach.StateMachine.add(  # pick_block.yml:8
            "OPEN_GRIPPER",
            GripperState(limb=limb, command="open"),
            transitions={
                "succeeded": "PLAN_HOVER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # pick_block.yml:14
            "PLAN_HOVER",
            PoseToJointPositionsState(limb=limb, grasp=True),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={"pose": "pick_pose", "offset": "hover_offset", "joints": "hover_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:21
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(limb=limb),
            transitions={"succeeded": "MOVE_DOWN", "aborted": "aborted", "preempted": "preempted"},
            remapping={"positions": "hover_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:27
            "MOVE_DOWN",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "CLOSE_GRIPPER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "pick_pose"},
        )

        smach.StateMachine.add(  # pick_block.yml:34
            "CLOSE_GRIPPER",
            GripperState(limb=limb, command="close"),
            transitions={"succeeded": "LIFT", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # pick_block.yml:40
            "LIFT",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "CHECK_GRASP",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "pick_pose", "offset": "hover_offset"},
        )

        smach.StateMachine.add(  # pick_block.yml:47
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
        outcomes=["succeeded", "aborted", "preempted"], input_keys=["place_pose", "hover_offset"]
    )
    with sm_place_block:
        smach.StateMachine.add(  # place_block.yml:9
            "PLAN_HOVER",
            PoseToJointPositionsState(limb=limb, grasp=True),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={"pose": "place_pose", "offset": "hover_offset", "joints": "hover_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:16
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(limb=limb),
            transitions={"succeeded": "MOVE_DOWN", "aborted": "aborted", "preempted": "preempted"},
            remapping={"positions": "hover_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:22
            "MOVE_DOWN",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "OPEN_GRIPPER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "place_pose"},
        )

        smach.StateMachine.add(  # place_block.yml:29
            "OPEN_GRIPPER",
            GripperState(limb=limb, command="open"),
            transitions={"succeeded": "MOVE_UP", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # place_block.yml:35
            "MOVE_UP",
            MoveAlongState(limb=limb, grasp=True),
            transitions={
                "succeeded": "CHECK_PLACED",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pose": "place_pose", "offset": "hover_offset"},
        )

        smach.StateMachine.add(  # place_block.yml:42
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

# Made by smachac 0.1.0 from main.yml (sha256 a04773f8ab211e87).
"""Pick two blocks with both arms at once and stack them on the mark."""

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
    """Build the state machine `dual_arm_stacking`."""
    dual_arm_stacking = smach.StateMachine(  # main.yml:2
        outcomes=["succeeded", "aborted", "preempted"]
    )
    dual_arm_stacking.userdata.left_home = [
        -0.08,
        -0.99998,
        -1.18997,
        1.94002,
        0.67,
        1.03001,
        -0.5,
    ]
    dual_arm_stacking.userdata.right_home = [0.08, -0.99998, 1.18997, 1.94002, -0.67, 1.03001, 0.5]
    dual_arm_stacking.userdata.hover_offset = [[0.0, 0.0, 0.12], [0.0, 0.0, 0.0, 1.0]]
    with dual_arm_stacking:
        smach.StateMachine.add(  # main.yml:14
            "FIND_FIRST",
            ReadBodyPoseState(body="first"),
            transitions={"succeeded": "FIND_SECOND", "aborted": "aborted"},
            remapping={"pose": "first_pose"},
        )

        smach.StateMachine.add(  # main.yml:20
            "FIND_SECOND",
            ReadBodyPoseState(body="second"),
            transitions={"succeeded": "FIND_MARK", "aborted": "aborted"},
            remapping={"pose": "second_pose"},
        )

        smach.StateMachine.add(  # main.yml:26
            "FIND_MARK",
            ReadBodyPoseState(body="mark"),
            transitions={"succeeded": "PLAN_STACK", "aborted": "aborted"},
            remapping={"pose": "goal_pose"},
        )

        # The second block goes on top of the first, one edge length (0.05 m) higher.
        smach.StateMachine.add(  # main.yml:32
            "PLAN_STACK",
            CallbacksState(
                callbacks={
                    "top_pose": lambda ud: [
                        [ud.goal_pose[0][0], ud.goal_pose[0][1], ud.goal_pose[0][2] + 0.05],
                        ud.goal_pose[1],
                    ],
                },
                input_keys=["goal_pose"],
                output_keys=["top_pose"],
            ),
            transitions={"succeeded": "PICK_BLOCKS"},
        )

        # Both arms move at the same time in one world.
        sm_pick_blocks = smach.Concurrence(  # main.yml:41
            outcomes=["succeeded", "aborted"],
            default_outcome="aborted",
            input_keys=["first_pose", "second_pose", "hover_offset"],
            outcome_map={"succeeded": {"PICK_FIRST": "succeeded", "PICK_SECOND": "succeeded"}},
        )
        with sm_pick_blocks:
            smach.Concurrence.add(  # main.yml:50
                "PICK_FIRST",
                build_pick_block(limb="left", body="first"),
                remapping={"pick_pose": "first_pose", "hover_offset": "hover_offset"},
            )

            smach.Concurrence.add(  # main.yml:55
                "PICK_SECOND",
                build_pick_block(limb="right", body="second"),
                remapping={"pick_pose": "second_pose", "hover_offset": "hover_offset"},
            )

        smach.StateMachine.add(
            "PICK_BLOCKS",
            sm_pick_blocks,
            transitions={"succeeded": "PLACE_FIRST", "aborted": "LET_GO_LEFT"},
        )

        smach.StateMachine.add(  # main.yml:60
            "PLACE_FIRST",
            build_place_block(limb="left", body="first"),
            transitions={
                "succeeded": "LEFT_HOME",
                "aborted": "LET_GO_LEFT",
                "preempted": "preempted",
            },
            remapping={"place_pose": "goal_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:66
            "LEFT_HOME",
            MoveToJointPositionsState(limb="left"),
            transitions={
                "succeeded": "PLACE_SECOND",
                "aborted": "LET_GO_LEFT",
                "preempted": "preempted",
            },
            remapping={"positions": "left_home"},
        )

        smach.StateMachine.add(  # main.yml:72
            "PLACE_SECOND",
            build_place_block(limb="right", body="second"),
            transitions={
                "succeeded": "RIGHT_HOME",
                "aborted": "LET_GO_LEFT",
                "preempted": "preempted",
            },
            remapping={"place_pose": "top_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:78
            "RIGHT_HOME",
            MoveToJointPositionsState(limb="right"),
            transitions={
                "succeeded": "CHECK_FIRST",
                "aborted": "LET_GO_LEFT",
                "preempted": "preempted",
            },
            remapping={"positions": "right_home"},
        )

        # The second block must not have moved the first.
        smach.StateMachine.add(  # main.yml:84
            "CHECK_FIRST",
            CheckPlacedState(body="first", tolerance=0.001),
            transitions={"succeeded": "succeeded", "aborted": "LET_GO_LEFT"},
            remapping={"pose": "goal_pose", "error": "first_error"},
        )

        smach.StateMachine.add(  # main.yml:93
            "LET_GO_LEFT",
            GripperState(limb="left", command="open"),
            transitions={
                "succeeded": "LET_GO_RIGHT",
                "aborted": "LET_GO_RIGHT",
                "preempted": "preempted",
            },
            remapping={"width": "left_width"},
        )

        smach.StateMachine.add(  # main.yml:100
            "LET_GO_RIGHT",
            GripperState(limb="right", command="open"),
            transitions={"succeeded": "aborted", "aborted": "aborted", "preempted": "preempted"},
            remapping={"width": "right_width"},
        )
    pass_on_stop_requests(dual_arm_stacking)
    return dual_arm_stacking


def build_pick_block(limb, body):
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
            CheckGraspState(limb=limb, body=body),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return sm_pick_block


def build_place_block(limb, body):
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
            CheckPlacedState(body=body, tolerance=0.001),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
            remapping={"pose": "place_pose", "error": "placing_error"},
        )
    return sm_place_block


def main():
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot="baxter", scene="table.yml") as world:
        dual_arm_stacking = build()
        world.attach(dual_arm_stacking, "dual_arm_stacking")
        if __name__ == "__main__":
            signals.stop_at_signals(dual_arm_stacking)
        outcome = dual_arm_stacking.execute()
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

# Made by smachac 0.1.0 from main.yml (sha256 67ca23235b32e45d).
"""Stack two blocks on the mark."""

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


class LoadModelState(smach.State):
    """Adds a model to the simulated world."""

    def __init__(self, model_name, model_path=None, body=None, spread=(0, 0, 0), apart=None):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=["pose", "reference_frame"],
            output_keys=["pose"],
        )
        self.model_name = model_name
        self.model_path = model_path
        self.body = body or model_name
        self.spread = spread
        self.apart = apart

    def execute(self, userdata):
        world = sim.world()
        frame = optional(userdata, "reference_frame") or "base"
        pose = sim.scattered(world, userdata["pose"], self.spread, self.apart)
        result = world.load(self.model_name, pose, self.body, self.model_path, frame)
        userdata["pose"] = pose
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
    """Build the state machine `stacking`."""
    stacking = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    stacking.userdata.home = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]
    stacking.userdata.hover_offset = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]
    stacking.userdata.table_pose = [[0.55, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    stacking.userdata.table_frame = "world"
    stacking.userdata.first_pose = [[0.5, 0.0, 0.025], [0.0, 0.0, 0.0, 1.0]]
    stacking.userdata.second_pose = [[0.5, 0.0, 0.025], [0.0, 0.0, 0.0, 1.0]]
    stacking.userdata.goal_pose = [[0.5, 0.0, 0.025], [0.0, 0.0, 0.0, 1.0]]
    with stacking:
        smach.StateMachine.add(  # main.yml:11
            "LOAD_TABLE",
            LoadModelState(model_name="table"),
            transitions={"succeeded": "LOAD_FIRST", "aborted": "aborted"},
            remapping={"pose": "table_pose", "reference_frame": "table_frame"},
        )

        smach.StateMachine.add(  # main.yml:20
            "LOAD_FIRST",
            LoadModelState(model_name="block", body="first", spread=[0.14, 0.28, 3.1416]),
            transitions={"succeeded": "LOAD_SECOND", "aborted": "aborted"},
            remapping={"pose": "first_pose"},
        )

        smach.StateMachine.add(  # main.yml:30
            "LOAD_SECOND",
            LoadModelState(
                model_name="block",
                body="second",
                spread=[0.14, 0.28, 3.1416],
                apart={"first": 0.15},
            ),
            transitions={"succeeded": "LOAD_MARK", "aborted": "aborted"},
            remapping={"pose": "second_pose"},
        )

        smach.StateMachine.add(  # main.yml:41
            "LOAD_MARK",
            LoadModelState(
                model_name="goal", spread=[0.14, 0.28, 0.0], apart={"first": 0.15, "second": 0.15}
            ),
            transitions={"succeeded": "PLAN_STACK", "aborted": "aborted"},
            remapping={"pose": "goal_pose"},
        )

        # The second block goes on top of the first, one edge length (0.05 m) higher.
        smach.StateMachine.add(  # main.yml:51
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
            transitions={"succeeded": "MOVE_TO_START"},
        )

        smach.StateMachine.add(  # main.yml:60
            "MOVE_TO_START",
            MoveToJointPositionsState(),
            transitions={"succeeded": "PICK_FIRST", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "home"},
        )

        smach.StateMachine.add(  # main.yml:65
            "PICK_FIRST",
            build_pick_block(body="first"),
            transitions={"succeeded": "PLACE_FIRST", "aborted": "LET_GO"},
            remapping={"pick_pose": "first_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:71
            "PLACE_FIRST",
            build_place_block(body="first"),
            transitions={"succeeded": "PICK_SECOND", "aborted": "LET_GO"},
            remapping={"place_pose": "goal_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:77
            "PICK_SECOND",
            build_pick_block(body="second"),
            transitions={"succeeded": "PLACE_SECOND", "aborted": "LET_GO"},
            remapping={"pick_pose": "second_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:83
            "PLACE_SECOND",
            build_place_block(body="second"),
            transitions={"succeeded": "CHECK_FIRST", "aborted": "LET_GO"},
            remapping={"place_pose": "top_pose", "hover_offset": "hover_offset"},
        )

        # The second block must not have moved the first.
        smach.StateMachine.add(  # main.yml:89
            "CHECK_FIRST",
            CheckPlacedState(body="first"),
            transitions={"succeeded": "GO_HOME", "aborted": "LET_GO"},
            remapping={"pose": "goal_pose", "error": "first_error"},
        )

        smach.StateMachine.add(  # main.yml:96
            "GO_HOME",
            MoveToJointPositionsState(),
            transitions={"succeeded": "succeeded", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "home"},
        )

        smach.StateMachine.add(  # main.yml:102
            "LET_GO",
            GripperState(command="open"),
            transitions={"succeeded": "RETREAT", "aborted": "RETREAT", "preempted": "aborted"},
            remapping={"width": "gripper_width"},
        )

        smach.StateMachine.add(  # main.yml:108
            "RETREAT",
            MoveToJointPositionsState(),
            transitions={"succeeded": "aborted", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "home"},
        )
    pass_on_stop_requests(stacking)
    return stacking


def build_pick_block(body):
    """Build the state machine of `pick_block.yml`.

    Grasp a block from above and lift it.
    """
    sm_pick_block = smach.StateMachine(
        outcomes=["succeeded", "aborted"], input_keys=["pick_pose", "hover_offset"]
    )
    with sm_pick_block:
        smach.StateMachine.add(  # pick_block.yml:8
            "OPEN_GRIPPER",
            GripperState(command="open"),
            transitions={"succeeded": "PLAN_HOVER", "aborted": "aborted", "preempted": "aborted"},
        )

        smach.StateMachine.add(  # pick_block.yml:13
            "PLAN_HOVER",
            PoseToJointPositionsState(grasp=True),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={"pose": "pick_pose", "offset": "hover_offset", "joints": "hover_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:19
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(),
            transitions={"succeeded": "MOVE_DOWN", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "hover_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:24
            "MOVE_DOWN",
            MoveAlongState(grasp=True),
            transitions={
                "succeeded": "CLOSE_GRIPPER",
                "aborted": "aborted",
                "preempted": "aborted",
            },
            remapping={"pose": "pick_pose"},
        )

        smach.StateMachine.add(  # pick_block.yml:30
            "CLOSE_GRIPPER",
            GripperState(command="close"),
            transitions={"succeeded": "LIFT", "aborted": "aborted", "preempted": "aborted"},
        )

        smach.StateMachine.add(  # pick_block.yml:35
            "LIFT",
            MoveAlongState(grasp=True),
            transitions={"succeeded": "CHECK_GRASP", "aborted": "aborted", "preempted": "aborted"},
            remapping={"pose": "pick_pose", "offset": "hover_offset"},
        )

        smach.StateMachine.add(  # pick_block.yml:41
            "CHECK_GRASP",
            CheckGraspState(body=body),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return sm_pick_block


def build_place_block(body):
    """Build the state machine of `place_block.yml`.

    Place the block in the gripper and look whether it lies there.
    """
    sm_place_block = smach.StateMachine(
        outcomes=["succeeded", "aborted"], input_keys=["place_pose", "hover_offset"]
    )
    with sm_place_block:
        smach.StateMachine.add(  # place_block.yml:9
            "PLAN_HOVER",
            PoseToJointPositionsState(grasp=True),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={"pose": "place_pose", "offset": "hover_offset", "joints": "hover_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:15
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(),
            transitions={"succeeded": "CHECK_GRASP", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "hover_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:20
            "CHECK_GRASP",
            CheckGraspState(body=body),
            transitions={"succeeded": "MOVE_DOWN", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # place_block.yml:25
            "MOVE_DOWN",
            MoveAlongState(grasp=True),
            transitions={
                "succeeded": "OPEN_GRIPPER",
                "aborted": "aborted",
                "preempted": "aborted",
            },
            remapping={"pose": "place_pose"},
        )

        smach.StateMachine.add(  # place_block.yml:31
            "OPEN_GRIPPER",
            GripperState(command="open"),
            transitions={"succeeded": "MOVE_UP", "aborted": "aborted", "preempted": "aborted"},
        )

        smach.StateMachine.add(  # place_block.yml:36
            "MOVE_UP",
            MoveAlongState(grasp=True),
            transitions={
                "succeeded": "CHECK_PLACED",
                "aborted": "aborted",
                "preempted": "aborted",
            },
            remapping={"pose": "place_pose", "offset": "hover_offset"},
        )

        smach.StateMachine.add(  # place_block.yml:42
            "CHECK_PLACED",
            CheckPlacedState(body=body),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
            remapping={"pose": "place_pose", "error": "placing_error"},
        )
    return sm_place_block


def main():
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot="panda") as world:
        stacking = build()
        world.attach(stacking, "stacking")
        if __name__ == "__main__":
            signals.stop_at_signals(stacking)
        outcome = stacking.execute()
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

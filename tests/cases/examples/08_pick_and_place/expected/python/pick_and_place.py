# Made by smachac 0.1.0 from main.yml (sha256 745b9b82fa27dae4).
"""Pick the block and place it on the mark."""

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
    """Build the state machine `pick_and_place`."""
    pick_and_place = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    pick_and_place.userdata.home = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]
    pick_and_place.userdata.hover_offset = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]
    pick_and_place.userdata.table_pose = [[0.55, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    pick_and_place.userdata.table_frame = "world"
    pick_and_place.userdata.block_pose = [[0.5, 0.0, 0.025], [0.0, 0.0, 0.0, 1.0]]
    pick_and_place.userdata.goal_pose = [[0.5, 0.0, 0.025], [0.0, 0.0, 0.0, 1.0]]
    with pick_and_place:
        smach.StateMachine.add(  # main.yml:11
            "LOAD_TABLE",
            LoadModelState(model_name="table"),
            transitions={"succeeded": "LOAD_BLOCK", "aborted": "aborted"},
            remapping={"pose": "table_pose", "reference_frame": "table_frame"},
        )

        smach.StateMachine.add(  # main.yml:20
            "LOAD_BLOCK",
            LoadModelState(model_name="block", spread=[0.14, 0.28, 3.1416]),
            transitions={"succeeded": "LOAD_MARK", "aborted": "aborted"},
            remapping={"pose": "block_pose"},
        )

        smach.StateMachine.add(  # main.yml:29
            "LOAD_MARK",
            LoadModelState(model_name="goal", spread=[0.14, 0.28, 0.0], apart={"block": 0.15}),
            transitions={"succeeded": "MOVE_TO_START", "aborted": "aborted"},
            remapping={"pose": "goal_pose"},
        )

        smach.StateMachine.add(  # main.yml:39
            "MOVE_TO_START",
            MoveToJointPositionsState(),
            transitions={"succeeded": "PICK_BLOCK", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "home"},
        )

        smach.StateMachine.add(  # main.yml:44
            "PICK_BLOCK",
            build_pick_block(),
            transitions={"succeeded": "PLACE_BLOCK", "aborted": "LET_GO"},
            remapping={"pick_pose": "block_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:50
            "PLACE_BLOCK",
            build_place_block(),
            transitions={"succeeded": "GO_HOME", "aborted": "LET_GO"},
            remapping={"place_pose": "goal_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:56
            "GO_HOME",
            MoveToJointPositionsState(),
            transitions={"succeeded": "succeeded", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "home"},
        )

        smach.StateMachine.add(  # main.yml:62
            "LET_GO",
            GripperState(command="open"),
            transitions={"succeeded": "RETREAT", "aborted": "RETREAT", "preempted": "aborted"},
            remapping={"width": "gripper_width"},
        )

        smach.StateMachine.add(  # main.yml:68
            "RETREAT",
            MoveToJointPositionsState(),
            transitions={"succeeded": "aborted", "aborted": "aborted", "preempted": "aborted"},
            remapping={"positions": "home"},
        )
    pass_on_stop_requests(pick_and_place)
    return pick_and_place


def build_pick_block():
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
            CheckGraspState(body="block"),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return sm_pick_block


def build_place_block():
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
            CheckGraspState(body="block"),
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
            CheckPlacedState(body="block"),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
            remapping={"pose": "place_pose", "error": "placing_error"},
        )
    return sm_place_block


def main():
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot="panda") as world:
        pick_and_place = build()
        world.attach(pick_and_place, "pick_and_place")
        if __name__ == "__main__":
            signals.stop_at_signals(pick_and_place)
        outcome = pick_and_place.execute()
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

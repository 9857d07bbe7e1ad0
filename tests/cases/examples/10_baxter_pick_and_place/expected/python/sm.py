# Made by smachac 0.1.0 from main.yml (sha256 376e85ed39c91b28).
"""The state machine `sm`."""

from smachac import sim
from smachac.runtime.additions import pass_on_stop_requests
from smachac.sim.gazebo import model_of

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach
from smachac.runtime import signals
from smachac.sim.gazebo import Point, Pose, Quaternion, rospkg  # noqa: F401


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


class LoadGazeboModelState(smach.State):
    """Adds a model of Gazebo to the simulated world."""

    def __init__(self, model_name, model_path):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=["pose", "reference_frame"],
        )
        self.model_name = model_name
        self.model_path = model_path

    def execute(self, userdata):
        frame = optional(userdata, "reference_frame") or "base"
        model, path = model_of(self.model_path)
        world = sim.world()
        result = world.load(model, userdata["pose"], self.model_name, path, frame)
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


class GripperInterfaceState(smach.State):
    """Opens or closes a gripper."""

    def __init__(self, command, limb=None):
        super().__init__(outcomes=["succeeded", "aborted", "preempted"])
        self.command = command
        self.limb = limb

    def execute(self, userdata):
        result = sim.world().arm(self.limb).grip(self.command, self.preempt_requested)
        return outcome_of(self, result)


class PoseToJointTrajServiceState(smach.State):
    """Computes the joint positions for a tool pose (inverse kinematics)."""

    def __init__(self, limb=None):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=["poses", "offsets"],
            output_keys=["joints"],
        )
        self.limb = limb

    def execute(self, userdata):
        arm = sim.world().arm(self.limb)
        joints = arm.solve_ik(userdata["poses"], optional(userdata, "offsets"))
        if joints is None:
            smach.logwarn("PoseToJointTrajServiceState: the pose is out of reach")
            return "aborted"
        userdata["joints"] = joints
        return "succeeded"


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded", "aborted", "preempted"])  # main.yml:2
    sm.userdata.hover_offset = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]
    sm.userdata.table_model_pose_world = Pose(position=Point(x=1.0, y=0.0, z=0.0))
    sm.userdata.table_model_ref_frame = "world"
    sm.userdata.block_model_pick_pose_world = [[0.6725, 0.1265, 0.7825], [0.0, 0.0, 0.0, 1.0]]
    sm.userdata.block_model_pick_ref_frame = "world"
    sm.userdata.block_model_pick_pose = [
        [0.7, 0.15, -0.129],
        [-0.02496, 0.99965, 0.00738, 0.00486],
    ]
    sm.userdata.block_model_place_pose = [
        [0.75, 0.0, -0.129],
        [-0.02496, 0.99965, 0.00738, 0.00486],
    ]
    sm.userdata.joint_start_positions = [-0.08, -0.99998, -1.18997, 1.94002, 0.67, 1.03001, -0.5]
    with sm:
        smach.StateMachine.add(  # main.yml:9
            "LOAD_TABLE_MODEL",
            LoadGazeboModelState(
                model_name="cafe_table",
                model_path="rospkg.RosPack().get_path('baxter_sim_examples') + '/models/cafe_table/model.sdf'",
            ),
            transitions={"succeeded": "LOAD_BLOCK_MODEL", "aborted": "aborted"},
            remapping={
                "pose": "table_model_pose_world",
                "reference_frame": "table_model_ref_frame",
            },
        )

        smach.StateMachine.add(  # main.yml:21
            "LOAD_BLOCK_MODEL",
            LoadGazeboModelState(
                model_name="block",
                model_path="rospkg.RosPack().get_path('baxter_sim_examples') + '/models/block/model.urdf'",
            ),
            transitions={"succeeded": "MOVE_TO_START_POSITION", "aborted": "aborted"},
            remapping={
                "pose": "block_model_pick_pose_world",
                "reference_frame": "block_model_pick_ref_frame",
            },
        )

        smach.StateMachine.add(  # main.yml:38
            "MOVE_TO_START_POSITION",
            MoveToJointPositionsState(limb="left"),
            transitions={
                "succeeded": "PICK_BLOCK",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "joint_start_positions"},
        )

        smach.StateMachine.add(  # main.yml:46
            "PICK_BLOCK",
            build_pick_block(),
            transitions={
                "succeeded": "PLACE_BLOCK",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"pick_pose": "block_model_pick_pose", "hover_offset": "hover_offset"},
        )

        smach.StateMachine.add(  # main.yml:52
            "PLACE_BLOCK",
            build_place_block(),
            transitions={"succeeded": "succeeded", "aborted": "aborted", "preempted": "preempted"},
            remapping={"place_pose": "block_model_place_pose", "hover_offset": "hover_offset"},
        )
    pass_on_stop_requests(sm)
    return sm


def build_pick_block():
    """Build the state machine of `pick_block.yml`."""
    sm_pick_block = smach.StateMachine(
        outcomes=["succeeded", "aborted", "preempted"], input_keys=["pick_pose", "hover_offset"]
    )
    with sm_pick_block:
        smach.StateMachine.add(  # pick_block.yml:7
            "OPEN_GRIPPER",
            GripperInterfaceState(limb="left", command="open"),
            transitions={
                "succeeded": "PLAN_HOVER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # pick_block.yml:13
            "PLAN_HOVER",
            PoseToJointTrajServiceState(limb="left"),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={"poses": "pick_pose", "offsets": "hover_offset", "joints": "hover_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:19
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(limb="left"),
            transitions={
                "succeeded": "PLAN_GRASP",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "hover_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:25
            "PLAN_GRASP",
            PoseToJointTrajServiceState(limb="left"),
            transitions={"succeeded": "MOVE_TO_GRASP", "aborted": "aborted"},
            remapping={"poses": "pick_pose", "joints": "grasp_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:31
            "MOVE_TO_GRASP",
            MoveToJointPositionsState(limb="left"),
            transitions={
                "succeeded": "CLOSE_GRIPPER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "grasp_joints"},
        )

        smach.StateMachine.add(  # pick_block.yml:37
            "CLOSE_GRIPPER",
            GripperInterfaceState(limb="left", command="close"),
            transitions={"succeeded": "LIFT", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # pick_block.yml:43
            "LIFT",
            MoveToJointPositionsState(limb="left"),
            transitions={"succeeded": "succeeded", "aborted": "aborted", "preempted": "preempted"},
            remapping={"positions": "hover_joints"},
        )
    return sm_pick_block


def build_place_block():
    """Build the state machine of `place_block.yml`."""
    sm_place_block = smach.StateMachine(
        outcomes=["succeeded", "aborted", "preempted"], input_keys=["place_pose", "hover_offset"]
    )
    with sm_place_block:
        smach.StateMachine.add(  # place_block.yml:7
            "PLAN_HOVER",
            PoseToJointTrajServiceState(limb="left"),
            transitions={"succeeded": "MOVE_TO_HOVER", "aborted": "aborted"},
            remapping={"poses": "place_pose", "offsets": "hover_offset", "joints": "hover_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:13
            "MOVE_TO_HOVER",
            MoveToJointPositionsState(limb="left"),
            transitions={
                "succeeded": "PLAN_PLACE",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "hover_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:19
            "PLAN_PLACE",
            PoseToJointTrajServiceState(limb="left"),
            transitions={"succeeded": "MOVE_TO_PLACE", "aborted": "aborted"},
            remapping={"poses": "place_pose", "joints": "place_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:25
            "MOVE_TO_PLACE",
            MoveToJointPositionsState(limb="left"),
            transitions={
                "succeeded": "OPEN_GRIPPER",
                "aborted": "aborted",
                "preempted": "preempted",
            },
            remapping={"positions": "place_joints"},
        )

        smach.StateMachine.add(  # place_block.yml:31
            "OPEN_GRIPPER",
            GripperInterfaceState(limb="left", command="open"),
            transitions={"succeeded": "MOVE_UP", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # place_block.yml:37
            "MOVE_UP",
            MoveToJointPositionsState(limb="left"),
            transitions={"succeeded": "succeeded", "aborted": "aborted", "preempted": "preempted"},
            remapping={"positions": "hover_joints"},
        )
    return sm_place_block


def main():
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot="baxter") as world:
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

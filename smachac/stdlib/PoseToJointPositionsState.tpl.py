{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
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
{% endblock %}

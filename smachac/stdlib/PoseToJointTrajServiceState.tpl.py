{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
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
{% endblock %}

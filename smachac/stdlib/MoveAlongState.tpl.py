{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
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
{% endblock %}

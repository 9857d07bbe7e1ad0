{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
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
{% endblock %}

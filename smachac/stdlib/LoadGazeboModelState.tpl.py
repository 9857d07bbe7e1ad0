{% extends "SimSkill.tpl.py" %}
{% block imports %}
from smachac import sim
from smachac.sim.gazebo import model_of
{% endblock %}
{% block class_defs %}
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
{% endblock %}

{% include "ROSHelp.tpl.py" %}
{% include "TF2ListenerSingleton.tpl.py" %}
{% block class_defs %}
class TF2ListenerState(smach.State):
    """Waits for a tf2 transform; a preempt request or a shutdown ends the wait."""

    def __init__(self, timeout=10.0, outcomes=("succeeded", "aborted", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=["target", "source"],
            output_keys=["output"],
        )
        self.timeout = timeout

    def execute(self, userdata):
        target, source = userdata["target"], userdata["source"]
        transform = TF2ListenerSingleton.look_up(self, target, source, self.timeout)
        if transform is None:
            return preempted_or_aborted(self)
        userdata["output"] = transform
        return "succeeded"
{% endblock %}

{% extends "State.tpl.py" %}
{% include "ROSHelp.tpl.py" %}
{% set recorder = recorder | default("ROSBagCLIProcessRecorder") %}
{% include recorder ~ ".tpl.py" %}
{% block cb_defs %}{% endblock cb_defs %}
{% block class_defs %}
{% if "class_RecordROSBagState" not in defined_headers %}
class RecordROSBagState(smach.State):
    """Starts or stops the recording of topics to a ROS bag."""

    recorders = {}

    def __init__(self, recorder, action, input_keys=("file", "topics"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.recorder = self.recorders.setdefault(recorder, recorder())
        self.action = action

    def execute(self, userdata):
        if self.action == "stop_all":
            return self.recorder.stop_all()
        file = optional(userdata, "file")
        topics = optional(userdata, "topics", [])
        if not isinstance(file, str) or not all(isinstance(each, str) for each in topics):
            smach.logerr("`file` must be a string and `topics` a list of strings")
            return "aborted"
        if self.action == "stop":
            return self.recorder.stop(file)
        return self.recorder.start(file, topics)
{% do defined_headers.append("class_RecordROSBagState") %}
{% endif %}
{% endblock class_defs %}
{% block body %}
{{ add("RecordROSBagState", recorder | code, action, input_keys=inputs if input_keys is defined, output_keys=output_keys) }}
{% endblock body %}

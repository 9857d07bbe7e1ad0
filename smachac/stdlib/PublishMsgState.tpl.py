{% extends "State.tpl.py" %}
{% include "ROSHelp.tpl.py" %}
{% include "ParseMessages.tpl.py" %}
{% include "MsgPublisher.tpl.py" %}
{% block imports %}
import struct
{% endblock %}
{% block defs %}
{% endblock %}
{% block cb_defs %}{% endblock cb_defs %}
{% block class_defs %}
{% if "class_PublishMsgState" not in defined_headers %}
class PublishMsgState(smach.State):
    """Starts or stops the periodic publication of a message on a topic."""

    publisher = MsgPublisher()

    def __init__(self, action, topic, input_keys=("msg", "topic", "rate"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.action = action
        self.topic = topic

    def execute(self, userdata):
        if self.action == "stop_all":
            return self.publisher.stop_all()
        topic = optional(userdata, "topic", self.topic)
        if self.action == "stop":
            return self.publisher.stop(topic)
        try:
            message = checked(parse_message(userdata["msg"], optional(userdata, "msg_type")))
        except (TypeError, ValueError) as error:
            smach.logerr(f"the message is invalid: {error}")
            return "aborted"
        frame = optional(userdata, "frame_id", "")
        rate = optional(userdata, "rate", 100.0)
        callback = optional(userdata, "callback")
        outcome = self.publisher.start(message, topic, rate, frame, callback)
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["msg", "output_msg", "msg_output"], message)
        write_keys(userdata, outputs, ["topic", "output_topic", "topic_output"], topic)
        return outcome
{% do defined_headers.append("class_PublishMsgState") %}
{% endif %}
{% endblock class_defs %}
{% block body %}
{{ add("PublishMsgState", action, "smacha/" ~ name | lower, input_keys=inputs if input_keys is defined, output_keys=output_keys) }}
{% endblock body %}

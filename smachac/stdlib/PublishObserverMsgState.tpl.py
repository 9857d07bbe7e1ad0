{% extends "State.tpl.py" %}
{% include "ROSHelp.tpl.py" %}
{% include "ParseMessages.tpl.py" %}
{% include "MsgPublisherObserver.tpl.py" %}
{% block imports %}
import struct
{% endblock %}
{% block cb_defs %}{% endblock cb_defs %}
{% block class_defs %}
{% if "class_PublishObserverMsgState" not in defined_headers %}
class PublishObserverMsgState(smach.State):
    """Publishes a message whenever a message arrives on another topic."""

    observers = {}

    def __init__(self, action, topic, sub_topic="tf", input_keys=("msg", "topic"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.action = action
        self.topic = topic
        self.observer = self.observers.setdefault(sub_topic, MsgPublisherObserver(sub_topic))

    def execute(self, userdata):
        if self.action == "remove_all":
            return self.observer.remove_all()
        topic = optional(userdata, "topic", self.topic)
        if self.action == "remove":
            return self.observer.remove(topic)
        try:
            message = checked(parse_message(userdata["msg"], optional(userdata, "msg_type")))
        except (TypeError, ValueError) as error:
            smach.logerr(f"the message is invalid: {error}")
            return "aborted"
        outcome = self.observer.add(message, topic, optional(userdata, "frame_id", ""))
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["msg", "output_msg", "msg_output"], message)
        write_keys(userdata, outputs, ["topic", "output_topic", "topic_output"], topic)
        return outcome
{% do defined_headers.append("class_PublishObserverMsgState") %}
{% endif %}
{% endblock class_defs %}
{% block body %}
{{ add("PublishObserverMsgState", action, "smacha/" ~ name | lower, sub_topic=sub_topic, input_keys=inputs if input_keys is defined, output_keys=output_keys) }}
{% endblock body %}

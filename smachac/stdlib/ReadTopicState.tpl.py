{% include "WaitForMsg.tpl.py" %}
{% block imports %}
import roslib.message
import rospy
import sys
{% endblock %}
{% block class_defs %}
class ReadTopicState(smach.State):
    """Reads one message from the topic whose name is the input `topic`."""

    def __init__(self, timeout=None, input_keys=("topic",), output_keys=("output",), outcomes=("succeeded", "aborted", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.timeout = timeout

    def execute(self, userdata):
        topic = userdata["topic"]
        kind = optional(userdata, "msg_type")
        raw = self.read(topic, rospy.AnyMsg)
        if raw is None:
            return preempted_or_aborted(self)
        if kind:
            message_class = roslib.message.get_message_class(kind)
        else:  # security: only a module that the program imports is used
            kind = raw._connection_header["type"]
            package, _, name = kind.partition("/")
            message_class = getattr(sys.modules.get(f"{package}.msg"), name, None)
        if message_class is None:
            smach.logerr(
                f"{topic}: type {kind} is not available; import it or set msg_type"
            )
            return "aborted"
        message = message_class()
        message.deserialize(raw._buff)
        outputs = self.get_registered_output_keys()
        names = ["output", "msg", "output_msg", "msg_output"]
        write_keys(userdata, outputs, names, message)
        return "succeeded"

    def read(self, topic, kind):
        """The next message on a topic, or None after a timeout or a preempt request."""
        with WaitForMsgState(topic, kind, latch=True, timeout=self.timeout) as reader:
            return reader.wait_for_message(self)
{% endblock %}

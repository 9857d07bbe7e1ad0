{% include "WaitForMsg.tpl.py" %}
{% include "MessageClass.tpl.py" %}
{% block imports %}
import rospy
import sys
{% endblock %}
{% block defs %}
def imported_class(raw):
    """The class of a received message, if the program imports its package (security).

    Raises ValueError if it does not.
    """
    kind = raw._connection_header["type"]
    package, _, name = kind.partition("/")
    found = getattr(sys.modules.get(f"{package}.msg"), name, None)
    if found is None:
        raise ValueError(f"type {kind} is not available; import it or set msg_type")
    return found
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
        try:
            message = (message_class(kind) if kind else imported_class(raw))()
        except ValueError as error:
            smach.logerr(f"{topic}: {error}")
            return "aborted"
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

{% include "ROSHelp.tpl.py" %}
{% block imports %}
import threading
import rospy
{% endblock %}
{% block class_defs %}
class WaitForMsgState(smach.State):
    """Waits for a message; a preempt request or a shutdown ends the wait."""

    def __init__(self, topic, msg_type, msg_cb=None, output_keys=(), latch=False, timeout=None):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            output_keys=list(output_keys),
        )
        self.latch = latch
        self.timeout = timeout
        self.msg_cb = msg_cb
        self.message = None
        self.arrived = threading.Condition()
        self.subscriber = rospy.Subscriber(topic, msg_type, self._store, queue_size=1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.subscriber.unregister()

    def _store(self, message):
        with self.arrived:
            self.message = message
            self.arrived.notify_all()

    def wait_for_message(self, state=None):
        """The next message, or None after a timeout or a preempt request to `state`."""
        end = None if self.timeout is None else rospy.Time.now() + rospy.Duration(self.timeout)
        with self.arrived:
            while self.message is None:
                timed_out = end is not None and rospy.Time.now() > end
                if timed_out or must_stop(state or self):
                    return None
                self.arrived.wait(0.1)
            message = self.message
            if not self.latch:
                self.message = None
            return message

    waitForMsg = wait_for_message

    def execute(self, userdata):
        if not self.latch:
            self.message = None
        message = self.wait_for_message()
        if message is None:
            return preempted_or_aborted(self)
        result = None if self.msg_cb is None else self.msg_cb(message, userdata)
        return "succeeded" if result is None or result else "aborted"
{% endblock %}

{% block imports %}
import threading
import rospy
{% endblock %}
{% block class_defs %}
class MsgPublisherObserver:
    """Publishes messages whenever a message arrives on the observed topic."""

    def __init__(self, sub_topic="tf"):
        self._lock = threading.Lock()
        self._messages = {}
        self._sub_topic = sub_topic
        self._subscriber = None

    def add(self, msg, topic, frame_id=""):
        """Add a publication on a topic."""
        if frame_id and hasattr(msg, "header"):
            msg.header.frame_id = frame_id
        publisher = rospy.Publisher(topic, type(msg), queue_size=1)
        with self._lock:
            self._messages[topic] = (publisher, msg)
        if self._subscriber is None:
            self._subscriber = rospy.Subscriber(
                self._sub_topic, rospy.AnyMsg, self._publish, queue_size=1
            )
        return "succeeded"

    def remove(self, topic):
        """Remove the publication on a topic; `aborted` if there is none."""
        with self._lock:
            publisher, _ = self._messages.pop(topic, (None, None))
        if publisher is None:
            return "aborted"
        publisher.unregister()
        return "succeeded"

    def remove_all(self):
        """Remove all publications."""
        with self._lock:
            topics = list(self._messages)
        for topic in topics:
            self.remove(topic)
        return "succeeded"

    def _publish(self, _):
        with self._lock:
            messages = list(self._messages.values())
        for publisher, msg in messages:
            if hasattr(msg, "header"):
                msg.header.stamp = rospy.Time.now()
            publisher.publish(msg)
{% endblock %}

{% block imports %}
import threading
import rospy
{% endblock %}
{% block class_defs %}
class MsgPublisher:
    """Publishes messages periodically. Each topic has a daemon thread."""

    def __init__(self):
        self._lock = threading.Lock()
        self._stops = {}

    def start(self, msg, topic, rate, frame_id="", callback=None):
        """Publish a message at a rate in Hz; replace the publication on the topic."""
        if frame_id and hasattr(msg, "header"):
            msg.header.frame_id = frame_id
        self.stop(topic)
        stop = threading.Event()
        publisher = rospy.Publisher(topic, type(msg), queue_size=1)
        work = (publisher, msg, 1.0 / rate, callback, stop)
        with self._lock:
            self._stops[topic] = stop
        threading.Thread(target=self._run, args=work, daemon=True).start()
        return "succeeded"

    def stop(self, topic):
        """Stop the publication on a topic; `aborted` if there is none."""
        with self._lock:
            stop = self._stops.pop(topic, None)
        if stop is None:
            return "aborted"
        stop.set()
        return "succeeded"

    def stop_all(self):
        """Stop all publications."""
        with self._lock:
            topics = list(self._stops)
        for topic in topics:
            self.stop(topic)
        return "succeeded"

    def _run(self, publisher, msg, period, callback, stop):
        try:
            while not rospy.is_shutdown() and not stop.wait(period):
                if callback:
                    msg = callback(msg)
                if hasattr(msg, "header"):
                    msg.header.stamp = rospy.Time.now()
                publisher.publish(msg)
        finally:
            publisher.unregister()
{% endblock %}

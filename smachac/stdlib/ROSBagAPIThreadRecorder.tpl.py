{% block imports %}
import threading
import rosbag
import roslib.message
import rospy
import rostopic
{% endblock %}
{% block class_defs %}
class ROSBagAPIThreadRecorder:
    """Records topics to bags in the process of the program."""

    def __init__(self):
        self._recordings = {}

    def start(self, file, topics):
        """Start a recording; it ends with `stop` or with the shutdown of the node."""
        if file in self._recordings:
            return "aborted"
        if not self._recordings:
            rospy.on_shutdown(self.stop_all)
        lock = threading.Lock()
        bag = rosbag.Bag(file, "w")

        def write(message, topic):
            with lock:
                bag.write(topic, message)

        subscribers = []
        for topic in topics:
            topic = rospy.resolve_name(topic)
            kind, name, _ = rostopic.get_topic_class(topic, blocking=False)
            if kind is None:
                smach.logwarn(f"topic {topic} has no publisher and is not recorded")
                continue
            subscribers.append(rospy.Subscriber(name, kind, write, callback_args=name))
        self._recordings[file] = (bag, lock, subscribers)
        return "succeeded"

    def stop(self, file):
        """Stop a recording and close its bag."""
        if file not in self._recordings:
            return "aborted"
        bag, lock, subscribers = self._recordings.pop(file)
        for subscriber in subscribers:
            subscriber.unregister()
        with lock:
            bag.close()
        return "succeeded"

    def stop_all(self):
        """Stop all recordings."""
        for file in list(self._recordings):
            self.stop(file)
        return "succeeded"
{% endblock %}

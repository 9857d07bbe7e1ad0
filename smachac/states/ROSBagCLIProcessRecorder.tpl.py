{% block imports %}
import signal
import subprocess
import rospy
{% endblock %}
{% block class_defs %}
class ROSBagCLIProcessRecorder:
    """Records topics to bags with `rosbag record`, each bag by a process of its own."""

    def __init__(self):
        self._processes = {}

    def start(self, file, topics):
        """Record topics to a file until it is stopped, or the node shuts down."""
        if file in self._processes:
            return "aborted"
        if not self._processes:
            rospy.on_shutdown(self.stop_all)
        command = ["rosbag", "record", "--output-name", file, *topics]
        try:
            self._processes[file] = subprocess.Popen(command)
        except OSError as error:
            smach.logerr(f"rosbag does not start: {error}")
            return "aborted"
        return "succeeded"

    def stop(self, file):
        """Stop a recording; its bag is whole when this returns."""
        process = self._processes.pop(file, None)
        if process is None:
            return "aborted"
        process.send_signal(signal.SIGINT)
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return "aborted"
        return "succeeded"

    def stop_all(self):
        """Stop all recordings."""
        ended = [self.stop(file) for file in list(self._processes)]
        return "aborted" if "aborted" in ended else "succeeded"
{% endblock %}

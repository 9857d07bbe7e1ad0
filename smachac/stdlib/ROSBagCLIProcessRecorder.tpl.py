{% block imports %}
import os
import signal
import subprocess
import time
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
            process = self._processes[file] = subprocess.Popen(command)
        except OSError as error:
            smach.logerr(f"rosbag does not start: {error}")
            return "aborted"
        if self._comes_to(file, recording=True, process=process):
            return "succeeded"
        smach.logerr(f"rosbag does not record to {file}")
        self.stop(file)
        return "aborted"

    def _comes_to(self, file, recording, process=None):
        """Whether the recording begins, or ends; till then `.active` is added to its name."""
        active = file if file.endswith(".bag") else f"{file}.bag"
        end = time.monotonic() + 30.0
        while process is None or process.poll() is None:
            if os.path.exists(f"{active}.active") == recording:
                return True
            if time.monotonic() > end:
                break
            time.sleep(0.02)
        return False

    def stop(self, file):
        """Stop a recording; its bag is whole when this returns."""
        process = self._processes.pop(file, None)
        if process is None:
            return "aborted"
        process.send_signal(signal.SIGINT)
        try:
            process.wait(30)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return "aborted"
        # `rosbag` ends before the recorder that it started.
        return "succeeded" if self._comes_to(file, recording=False) else "aborted"

    def stop_all(self):
        """Stop all recordings."""
        ended = [self.stop(file) for file in list(self._processes)]
        return "aborted" if "aborted" in ended else "succeeded"
{% endblock %}

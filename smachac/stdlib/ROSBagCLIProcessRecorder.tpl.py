{% block imports %}
import os
import signal
import subprocess
import time
import rospy
{% endblock %}
{% block class_defs %}
class ROSBagCLIProcessRecorder:
    """Records topics to bags; each bag has a `rosbag record` process."""

    def __init__(self):
        self._processes = {}

    def start(self, file, topics):
        """Start a recording; it ends with `stop` or with the shutdown of the node."""
        if file in self._processes:
            return "aborted"
        if not self._processes:
            rospy.on_shutdown(self.stop_all)
        command = ["rosbag", "record", "--output-name", file, *topics]
        try:
            process = self._processes[file] = subprocess.Popen(command)
        except OSError as error:
            smach.logerr(f"rosbag cannot start: {error}")
            return "aborted"
        if self._wait_until(file, recording=True, process=process):
            return "succeeded"
        smach.logerr(f"rosbag does not record to {file}")
        self.stop(file)
        return "aborted"

    def _wait_until(self, file, recording, process=None):
        """Wait up to 30 s for the start (`recording`) or the end of a recording.

        During a recording, the name of the bag ends with `.active`.
        """
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
        """Stop a recording and wait until its bag is complete."""
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
        # The process `rosbag` ends before its child process, which writes the bag.
        return "succeeded" if self._wait_until(file, recording=False) else "aborted"

    def stop_all(self):
        """Stop all recordings."""
        ended = [self.stop(file) for file in list(self._processes)]
        return "aborted" if "aborted" in ended else "succeeded"
{% endblock %}

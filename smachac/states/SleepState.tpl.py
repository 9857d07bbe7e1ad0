{% block imports %}
import threading
{% endblock %}
{% block class_defs %}
class SleepState(smach.State):
    """Waits for `time` seconds; a preempt request ends the wait."""

    def __init__(self, time):
        super().__init__(outcomes=["succeeded", "preempted"])
        self.time = time
        self.woken = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.woken.set()

    def execute(self, userdata):
        self.woken.wait(self.time)
        self.woken.clear()
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "succeeded"
{% endblock %}

{% block imports %}
import threading
{% endblock %}
{% block class_defs %}
class SleepState(smach.State):
    """Waits for `time` seconds: a number, or a function of the userdata.

    A preempt request ends the wait.
    """

    def __init__(self, time, input_keys=(), outcomes=("succeeded", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
        )
        self.time = time
        self.end_of_wait = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.end_of_wait.set()

    def execute(self, userdata):
        self.end_of_wait.wait(self.time(userdata) if callable(self.time) else self.time)
        self.end_of_wait.clear()
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        return "succeeded"
{% endblock %}

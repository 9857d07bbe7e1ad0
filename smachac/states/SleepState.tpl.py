{% block imports %}
import threading
{% endblock %}
{% block class_defs %}
class SleepState(smach.State):
    """Waits for `time` seconds, a number or a function of userdata; a preempt request ends it."""

    def __init__(self, time, input_keys=()):
        super().__init__(
            outcomes=["succeeded", "preempted"],
            input_keys=list(input_keys),
        )
        self.time = time
        self.woken = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.woken.set()

    def execute(self, userdata):
        self.woken.wait(self.time(userdata) if callable(self.time) else self.time)
        self.woken.clear()
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "succeeded"
{% endblock %}

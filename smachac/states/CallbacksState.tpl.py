{% block class_defs %}
class CallbacksState(smach.State):
    """Calls functions of the userdata, keeps what each returns under its own name."""

    def __init__(self, callbacks, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=["succeeded"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.callbacks = callbacks

    def execute(self, userdata):
        for key in sorted(self.callbacks):
            userdata[key] = self.callbacks[key](userdata)
        return "succeeded"
{% endblock %}

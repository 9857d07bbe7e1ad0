{% block class_defs %}
class Look(smach.State):
    """Looks for a part."""

    def __init__(self):
        super().__init__(
            outcomes=["found", "nothing"], input_keys=["tries"], output_keys=["pose"]
        )

    def execute(self, userdata):
        userdata.tries += 1
        userdata.psoe = camera.look(userdata.limb)
        if userdata["tries"] > 3:
            return "noting"
        if camera.sees_part():
            return "found"
{% endblock %}

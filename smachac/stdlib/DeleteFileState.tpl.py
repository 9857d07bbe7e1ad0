{% block imports %}
import glob
import os
{% endblock %}
{% block class_defs %}
class DeleteFileState(smach.State):
    """Deletes the files that match a path pattern."""

    def __init__(self, input_keys=("file",), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )

    def execute(self, userdata):
        paths = glob.glob(userdata["file"])
        if not paths:
            smach.logwarn(f"no file matches {userdata['file']}")
            return "aborted"
        try:
            for path in sorted(paths):
                os.remove(path)
        except OSError as error:
            smach.logwarn(f"a file cannot be deleted: {error}")
            return "aborted"
        return "succeeded"
{% endblock %}

{% include "ROSHelp.tpl.py" %}
{% include "ParseMessages.tpl.py" %}
{% include "TF2ListenerSingleton.tpl.py" %}
{% block imports %}
import copy
import struct
import tf2_geometry_msgs
from geometry_msgs.msg import Quaternion, Vector3
{% endblock %}
{% block defs %}
def transformed(message, transform):
    """Transform a message to another frame. Raises TypeError for unsupported types."""
    if isinstance(message, PointStamped):
        return tf2_geometry_msgs.do_transform_point(message, transform)
    if isinstance(message, PoseStamped):
        return tf2_geometry_msgs.do_transform_pose(message, transform)
    if isinstance(message, (PointCloud, PointCloud2)):
        from tf2_sensor_msgs.tf2_sensor_msgs import do_transform_cloud

        return do_transform_cloud(message, transform)
    if isinstance(message, (Point, Pose)):
        part = "point" if isinstance(message, Point) else "pose"
        kind = PointStamped if part == "point" else PoseStamped
        return getattr(transformed(kind(**{part: message}), transform), part)
    raise TypeError(f"the type {type(message).__name__} is not supported")
{% endblock %}
{% block class_defs %}
class TransformMsgState(smach.State):
    """Transforms a message to another frame."""

    def __init__(self, transform_type="transform", timeout=10.0, input_keys=("msg", "frame_id"), output_keys=("output_msg",), outcomes=("succeeded", "aborted", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.transform_type = transform_type
        self.timeout = timeout

    def execute(self, userdata):
        try:
            message = parse_message(userdata["msg"], optional(userdata, "msg_type"))
            transform = self.transform(userdata, message)
            if transform is None:
                return preempted_or_aborted(self)
            result = transformed(message, transform)
        except (TypeError, ValueError) as error:
            smach.logerr(f"the message cannot be transformed: {error}")
            return "aborted"
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["output_msg", "msg", "msg_output"], result)
        names = ["transform", "output_transform", "transform_output"]
        write_keys(userdata, outputs, names, transform)
        return "succeeded"

    def transform(self, userdata, message):
        """The applied part of the transform; None if tf2 does not provide it."""
        if "transform" in userdata:
            found = parse_transformstamped(userdata["transform"])
        else:
            target = optional(userdata, "target") or optional(userdata, "frame_id")
            header = getattr(message, "header", None)
            source = optional(userdata, "source") or getattr(header, "frame_id", "")
            if not target or not source:
                raise ValueError("the source frame or the target frame is missing")
            found = TF2ListenerSingleton.look_up(self, target, source, self.timeout)
        if found is not None:
            found = copy.deepcopy(found)
            if self.transform_type == "translation":
                found.transform.rotation = Quaternion(0.0, 0.0, 0.0, 1.0)
            elif self.transform_type == "rotation":
                found.transform.translation = Vector3(0.0, 0.0, 0.0)
        return found
{% endblock %}

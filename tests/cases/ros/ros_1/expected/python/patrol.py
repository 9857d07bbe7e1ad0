# Made by smachac 0.1.0 from main.yml (sha256 b60880ba9ee335fa).
"""The state machine `patrol`."""

import copy
import io
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

import genpy
import rospy
import tf2_geometry_msgs
import tf2_ros
from geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    Pose,
    PoseArray,
    PoseStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from sensor_msgs.msg import PointCloud, PointCloud2, PointField
from std_msgs.msg import Float32
from std_srvs.srv import SetBool, SetBoolRequest, Trigger, TriggerRequest
from test_msgs.msg import FibonacciAction, FibonacciGoal

try:
    import smach
    import smach_ros
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach
    from smachac.runtime import smach_ros


def optional(userdata, key, default=None):
    """The value of a userdata key, or the default if the key is absent."""
    return userdata[key] if key in userdata else default


def write_keys(userdata, outputs, names, value):
    """Write a value to each of the names that is an output key."""
    for name in names:
        if name in outputs:
            userdata[name] = value


def must_stop(state):
    """True after a preempt request and during the shutdown of the node."""
    return state.preempt_requested() or rospy.is_shutdown()


def preempted_or_aborted(state):
    """The outcome `preempted` after a preempt request, otherwise `aborted`."""
    if state.preempt_requested() and "preempted" in state.get_registered_outcomes():
        state.service_preempt()
        return "preempted"
    return "aborted"


def message_class(kind):
    """The class of a message type such as `std_msgs/Bool`. Raises ValueError without one."""
    if isinstance(kind, type):
        return kind
    from roslib.message import get_message_class

    package, *_, name = kind.replace(".", "/").split("/")
    found = get_message_class(f"{package}/{name}")
    if found is None:
        raise ValueError(f"the message type {kind} is not available")
    return found


def filled(message, values):
    """Set the fields of a message from a mapping, or from a list in their order.

    A number of seconds makes a time or a duration. Raises TypeError or ValueError if the values
    do not fit.
    """
    from genpy import SerializationError

    if isinstance(values, type(message)):
        return values
    types = dict(zip(message.__slots__, message._slot_types))
    if not isinstance(values, dict):
        if len(values) != len(types):
            raise ValueError(f"{message._type} has the fields {', '.join(types)}")
        values = dict(zip(types, values))
    for name, value in values.items():
        if name not in types:
            raise ValueError(f"{message._type} has no field {name}: it has {', '.join(types)}")
        item, is_list, _ = types[name].partition("[")
        field = getattr(message, name)
        if "/" in item and is_list:
            value = [filled(message_class(item)(), each) for each in value]
        elif "/" in item:
            value = filled(field, value)
        elif item in ("time", "duration") and isinstance(value, (int, float)):
            value = type(field).from_sec(value)
        setattr(message, name, value)
    try:
        message._check_types()
    except SerializationError as error:
        raise ValueError(f"{message._type}: {error}") from None
    return message


def imported_class(raw):
    """The class of a received message, if the program imports its package (security).

    Raises ValueError if it does not.
    """
    kind = raw._connection_header["type"]
    package, _, name = kind.partition("/")
    found = getattr(sys.modules.get(f"{package}.msg"), name, None)
    if found is None:
        raise ValueError(f"type {kind} is not available; import it or set msg_type")
    return found


def parse_point(data):
    """Convert `[x, y, z]`, a Point, a Point32 or a PointStamped to a Point."""
    if isinstance(data, PointStamped):
        return data.point
    if isinstance(data, Point):
        return data
    if isinstance(data, Point32):
        return Point(data.x, data.y, data.z)
    x, y, z = map(float, data)
    return Point(x, y, z)


def parse_pose(data):
    """Convert `[[x, y, z], [qx, qy, qz, qw]]`, a Pose or a PoseStamped to a Pose."""
    if isinstance(data, PoseStamped):
        return data.pose
    if isinstance(data, Pose):
        return data
    position, orientation = data
    return Pose(parse_point(position), Quaternion(*map(float, orientation)))


def stamped(kind, part, data, value):
    """`data` if its type is `kind`, else a message with the value and a time stamp."""
    if isinstance(data, kind):
        return data
    message = kind(**{part: value})
    message.header.stamp = rospy.Time.now()
    return message


def parse_pointstamped(data):
    """Convert a PointStamped, or an argument of `parse_point`, to a PointStamped."""
    return stamped(PointStamped, "point", data, parse_point(data))


def parse_posestamped(data):
    """Convert a PoseStamped, or an argument of `parse_pose`, to a PoseStamped."""
    return stamped(PoseStamped, "pose", data, parse_pose(data))


def parse_posearray(data):
    """Convert a list of poses or a PoseArray to a PoseArray."""
    if isinstance(data, PoseArray):
        return data
    return stamped(PoseArray, "poses", data, [parse_pose(each) for each in data])


def parse_pointcloud(data):
    """Convert a list of points or a PointCloud to a PointCloud."""
    if isinstance(data, PointCloud):
        return data
    points = [Point32(*map(float, each)) for each in data]
    return stamped(PointCloud, "points", data, points)


def parse_pointcloud2(data):
    """Convert a list of points or a PointCloud2 to a PointCloud2."""
    if isinstance(data, PointCloud2):
        return data
    points = [tuple(map(float, each)) for each in data]
    fields = [
        PointField(name, 4 * place, PointField.FLOAT32, 1)
        for place, name in enumerate("xyz")
    ]
    message = PointCloud2(
        height=1,
        width=len(points),
        fields=fields,
        is_bigendian=False,
        point_step=12,
        row_step=12 * len(points),
        data=b"".join(struct.pack("<fff", *point) for point in points),
        is_dense=True,
    )
    message.header.stamp = rospy.Time.now()
    return message


def parse_transformstamped(data):
    """Convert a transform to a TransformStamped.

    `data`: `[[x, y, z], [qx, qy, qz, qw]]`, a Transform or a TransformStamped.
    """
    if isinstance(data, TransformStamped):
        return data
    if not isinstance(data, Transform):
        translation, rotation = data
        data = Transform(
            Vector3(*map(float, translation)), Quaternion(*map(float, rotation))
        )
    return TransformStamped(transform=data)


def checked(message):
    """Return a message. Raises ValueError, with the path, if a value does not fit its field."""
    try:
        message.serialize(io.BytesIO())
    except (genpy.SerializationError, OverflowError) as error:
        raise ValueError(f"{message._type}: {error}") from None
    return message


PARSERS = {
    "geometry_msgs/Point": parse_point,
    "geometry_msgs/PointStamped": parse_pointstamped,
    "geometry_msgs/Pose": parse_pose,
    "geometry_msgs/PoseStamped": parse_posestamped,
    "geometry_msgs/PoseArray": parse_posearray,
    "sensor_msgs/PointCloud": parse_pointcloud,
    "sensor_msgs/PointCloud2": parse_pointcloud2,
}


def parse_message(data, kind=None):
    """Convert lists of numbers, or a mapping of fields, to a message of type `kind`.

    A message of this type stays as it is. Without `kind`, the shape of the lists determines the
    message type, and a Point or a Pose becomes a stamped message. Raises TypeError or ValueError
    if the values do not fit.
    """
    if kind is None and isinstance(data, (Point, Point32)):
        return parse_pointstamped(data)
    if kind is None and isinstance(data, Pose):
        return parse_posestamped(data)
    if kind is None and hasattr(data, "_type"):
        return data
    if kind is not None:
        wanted = message_class(kind)
        if isinstance(data, wanted):
            return data
        if isinstance(data, dict) or wanted._type not in PARSERS:
            return filled(wanted(), data)
        return PARSERS[wanted._type](data)
    if isinstance(data, dict):
        raise TypeError("a mapping needs the key msg_type")
    if len(data) == 2 and len(data[0]) == 3 and len(data[1]) == 4:
        return parse_posestamped(data)
    if len(data) == 3 and all(isinstance(each, (int, float)) for each in data):
        return parse_pointstamped(data)
    if all(len(each) == 3 for each in data):
        return parse_pointcloud2(data)
    return parse_posearray(data)


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


class RecordROSBagState(smach.State):
    """Starts or stops the recording of topics to a ROS bag."""

    recorders = {}

    def __init__(self, recorder, action, input_keys=("file", "topics"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.recorder = self.recorders.setdefault(recorder, recorder())
        self.action = action

    def execute(self, userdata):
        if self.action == "stop_all":
            return self.recorder.stop_all()
        file = optional(userdata, "file")
        topics = optional(userdata, "topics", [])
        if not isinstance(file, str) or not all(isinstance(each, str) for each in topics):
            smach.logerr("`file` must be a string and `topics` a list of strings")
            return "aborted"
        if self.action == "stop":
            return self.recorder.stop(file)
        return self.recorder.start(file, topics)


class WaitForMsgState(smach.State):
    """Waits for a message; a preempt request or a shutdown ends the wait."""

    def __init__(self, topic, msg_type, msg_cb=None, output_keys=(), latch=False, timeout=None):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            output_keys=list(output_keys),
        )
        self.latch = latch
        self.timeout = timeout
        self.msg_cb = msg_cb
        self.message = None
        self.arrived = threading.Condition()
        self.subscriber = rospy.Subscriber(topic, msg_type, self._store, queue_size=1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.subscriber.unregister()

    def _store(self, message):
        with self.arrived:
            self.message = message
            self.arrived.notify_all()

    def wait_for_message(self, state=None):
        """The next message, or None after a timeout or a preempt request to `state`."""
        end = None if self.timeout is None else rospy.Time.now() + rospy.Duration(self.timeout)
        with self.arrived:
            while self.message is None:
                timed_out = end is not None and rospy.Time.now() > end
                if timed_out or must_stop(state or self):
                    return None
                self.arrived.wait(0.1)
            message = self.message
            if not self.latch:
                self.message = None
            return message

    waitForMsg = wait_for_message

    def execute(self, userdata):
        if not self.latch:
            self.message = None
        message = self.wait_for_message()
        if message is None:
            return preempted_or_aborted(self)
        result = None if self.msg_cb is None else self.msg_cb(message, userdata)
        return "succeeded" if result is None or result else "aborted"


class ReadTopicState(smach.State):
    """Reads one message from the topic whose name is the input `topic`."""

    def __init__(self, timeout=None, input_keys=("topic",), output_keys=("output",), outcomes=("succeeded", "aborted", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.timeout = timeout

    def execute(self, userdata):
        topic = userdata["topic"]
        kind = optional(userdata, "msg_type")
        raw = self.read(topic, rospy.AnyMsg)
        if raw is None:
            return preempted_or_aborted(self)
        try:
            message = (message_class(kind) if kind else imported_class(raw))()
        except ValueError as error:
            smach.logerr(f"{topic}: {error}")
            return "aborted"
        message.deserialize(raw._buff)
        outputs = self.get_registered_output_keys()
        names = ["output", "msg", "output_msg", "msg_output"]
        write_keys(userdata, outputs, names, message)
        return "succeeded"

    def read(self, topic, kind):
        """The next message on a topic, or None after a timeout or a preempt request."""
        with WaitForMsgState(topic, kind, latch=True, timeout=self.timeout) as reader:
            return reader.wait_for_message(self)


class TF2ListenerSingleton:
    """The tf2 listener of the program; the first call of `get` creates it."""

    _instance = None

    @classmethod
    def get(cls):
        """The tf2 buffer and the listener that fills it."""
        if cls._instance is None:
            buffer = tf2_ros.Buffer()
            cls._instance = (buffer, tf2_ros.TransformListener(buffer))
        return cls._instance

    @classmethod
    def look_up(cls, state, target, source, timeout):
        """The newest transform; None after `timeout` seconds or a preempt request."""
        buffer, _ = cls.get()
        end = rospy.Time.now() + rospy.Duration(timeout)
        while not must_stop(state):
            # Short waits, because a preempt request does not end a wait of tf2.
            if buffer.can_transform(target, source, rospy.Time(0), rospy.Duration(0.1)):
                return buffer.lookup_transform(target, source, rospy.Time(0))
            if rospy.Time.now() > end:
                smach.logwarn(f"no transform from {source} to {target} in {timeout} s")
                return None
        return None


class TF2ListenerState(smach.State):
    """Waits for a tf2 transform; a preempt request or a shutdown ends the wait."""

    def __init__(self, timeout=10.0, outcomes=("succeeded", "aborted", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=["target", "source"],
            output_keys=["output"],
        )
        self.timeout = timeout

    def execute(self, userdata):
        target, source = userdata["target"], userdata["source"]
        transform = TF2ListenerSingleton.look_up(self, target, source, self.timeout)
        if transform is None:
            return preempted_or_aborted(self)
        userdata["output"] = transform
        return "succeeded"


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


class MsgPublisher:
    """Publishes messages periodically. Each topic has a daemon thread."""

    def __init__(self):
        self._lock = threading.Lock()
        self._stops = {}

    def start(self, msg, topic, rate, frame_id="", callback=None):
        """Publish a message at a rate in Hz; replace the publication on the topic."""
        if frame_id and hasattr(msg, "header"):
            msg.header.frame_id = frame_id
        self.stop(topic)
        stop = threading.Event()
        publisher = rospy.Publisher(topic, type(msg), queue_size=1)
        work = (publisher, msg, 1.0 / rate, callback, stop)
        with self._lock:
            self._stops[topic] = stop
        threading.Thread(target=self._run, args=work, daemon=True).start()
        return "succeeded"

    def stop(self, topic):
        """Stop the publication on a topic; `aborted` if there is none."""
        with self._lock:
            stop = self._stops.pop(topic, None)
        if stop is None:
            return "aborted"
        stop.set()
        return "succeeded"

    def stop_all(self):
        """Stop all publications."""
        with self._lock:
            topics = list(self._stops)
        for topic in topics:
            self.stop(topic)
        return "succeeded"

    def _run(self, publisher, msg, period, callback, stop):
        try:
            while not rospy.is_shutdown() and not stop.wait(period):
                if callback:
                    msg = callback(msg)
                if hasattr(msg, "header"):
                    msg.header.stamp = rospy.Time.now()
                publisher.publish(msg)
        finally:
            publisher.unregister()


class PublishMsgState(smach.State):
    """Starts or stops the periodic publication of a message on a topic."""

    publisher = MsgPublisher()

    def __init__(self, action, topic, input_keys=("msg", "topic", "rate"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.action = action
        self.topic = topic

    def execute(self, userdata):
        if self.action == "stop_all":
            return self.publisher.stop_all()
        topic = optional(userdata, "topic", self.topic)
        if self.action == "stop":
            return self.publisher.stop(topic)
        try:
            message = checked(parse_message(userdata["msg"], optional(userdata, "msg_type")))
        except (TypeError, ValueError) as error:
            smach.logerr(f"the message is invalid: {error}")
            return "aborted"
        frame = optional(userdata, "frame_id", "")
        rate = optional(userdata, "rate", 100.0)
        callback = optional(userdata, "callback")
        outcome = self.publisher.start(message, topic, rate, frame, callback)
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["msg", "output_msg", "msg_output"], message)
        write_keys(userdata, outputs, ["topic", "output_topic", "topic_output"], topic)
        return outcome


class MsgPublisherObserver:
    """Publishes messages whenever a message arrives on the observed topic."""

    def __init__(self, sub_topic="tf"):
        self._lock = threading.Lock()
        self._messages = {}
        self._sub_topic = sub_topic
        self._subscriber = None

    def add(self, msg, topic, frame_id=""):
        """Add a publication on a topic."""
        if frame_id and hasattr(msg, "header"):
            msg.header.frame_id = frame_id
        publisher = rospy.Publisher(topic, type(msg), queue_size=1)
        with self._lock:
            self._messages[topic] = (publisher, msg)
        if self._subscriber is None:
            self._subscriber = rospy.Subscriber(
                self._sub_topic, rospy.AnyMsg, self._publish, queue_size=1
            )
        return "succeeded"

    def remove(self, topic):
        """Remove the publication on a topic; `aborted` if there is none."""
        with self._lock:
            publisher, _ = self._messages.pop(topic, (None, None))
        if publisher is None:
            return "aborted"
        publisher.unregister()
        return "succeeded"

    def remove_all(self):
        """Remove all publications."""
        with self._lock:
            topics = list(self._messages)
        for topic in topics:
            self.remove(topic)
        return "succeeded"

    def _publish(self, _):
        with self._lock:
            messages = list(self._messages.values())
        for publisher, msg in messages:
            if hasattr(msg, "header"):
                msg.header.stamp = rospy.Time.now()
            publisher.publish(msg)


class PublishObserverMsgState(smach.State):
    """Publishes a message whenever a message arrives on another topic."""

    observers = {}

    def __init__(self, action, topic, sub_topic="tf", input_keys=("msg", "topic"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.action = action
        self.topic = topic
        self.observer = self.observers.setdefault(sub_topic, MsgPublisherObserver(sub_topic))

    def execute(self, userdata):
        if self.action == "remove_all":
            return self.observer.remove_all()
        topic = optional(userdata, "topic", self.topic)
        if self.action == "remove":
            return self.observer.remove(topic)
        try:
            message = checked(parse_message(userdata["msg"], optional(userdata, "msg_type")))
        except (TypeError, ValueError) as error:
            smach.logerr(f"the message is invalid: {error}")
            return "aborted"
        outcome = self.observer.add(message, topic, optional(userdata, "frame_id", ""))
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["msg", "output_msg", "msg_output"], message)
        write_keys(userdata, outputs, ["topic", "output_topic", "topic_output"], topic)
        return outcome


def build():
    """Build the state machine `patrol`."""
    patrol = smach.StateMachine(outcomes=["succeeded", "aborted", "preempted"])  # main.yml:2
    patrol.userdata.order = 3
    patrol.userdata.file = "run.bag"
    patrol.userdata.topics = ["/battery"]
    patrol.userdata.msg = [1.0, 2.0, 0.0]
    patrol.userdata.topic = "goal"
    patrol.userdata.frame_id = "map"
    patrol.userdata.target = "map"
    patrol.userdata.source = "base"
    with patrol:
        smach.StateMachine.add(  # main.yml:19
            "RECORD",
            RecordROSBagState(ROSBagCLIProcessRecorder, "start"),
            transitions={"succeeded": "COUNT", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:23
            "COUNT",
            smach_ros.SimpleActionState(
                "count",
                FibonacciAction,
                goal_slots=["order"],
                result_slots=["sequence"],
                exec_timeout=rospy.Duration(60),
                server_wait_timeout=rospy.Duration(5.0),
            ),
            transitions={
                "succeeded": "COUNT_AGAIN",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:32
            "COUNT_AGAIN",
            smach_ros.SimpleActionState(
                "count", FibonacciAction, goal=filled(FibonacciGoal(), {"order": 5})
            ),
            transitions={"succeeded": "ENABLE", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:38
            "ENABLE",
            smach_ros.ServiceState(
                "enable",
                SetBool,
                request=filled(SetBoolRequest(), {"data": True}),
                response_slots=["message"],
            ),
            transitions={"succeeded": "DOCK", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:45
            "DOCK",
            smach_ros.ServiceState("dock", Trigger, request=TriggerRequest()),
            transitions={"succeeded": "BATTERY", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:51
            "BATTERY",
            WaitForMsgState(
                "/battery",
                Float32,
                msg_cb=lambda message, userdata: message.data > 0.2,
                timeout=60,
            ),
            transitions={"succeeded": "READ", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:58
            "READ",
            ReadTopicState(input_keys=["topic"], output_keys=["output"]),
            transitions={"succeeded": "WATCH", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:63
            "WATCH",
            smach_ros.MonitorState(
                "/battery", Float32, lambda userdata, message: message.data > 0.2, max_checks=3
            ),
            transitions={"valid": "CHECK", "invalid": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:70
            "CHECK",
            smach_ros.ConditionState(
                lambda userdata: True,
                poll_rate=rospy.Duration(0.1),
                timeout=rospy.Duration(10.0),
                max_checks=-1,
            ),
            transitions={"true": "FRAME", "false": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:77
            "FRAME",
            TF2ListenerState(),
            transitions={
                "succeeded": "MOVE_POINT",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:80
            "MOVE_POINT",
            TransformMsgState(
                transform_type="rotation",
                input_keys=["msg", "frame_id"],
                output_keys=["output_msg"],
            ),
            transitions={"succeeded": "PUBLISH", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:86
            "PUBLISH",
            PublishMsgState("start", "smacha/publish", input_keys=["msg", "topic", "rate"]),
            transitions={"succeeded": "ECHO", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:91
            "ECHO",
            PublishObserverMsgState(
                "add", "smacha/echo", sub_topic="/battery", input_keys=["msg", "topic"]
            ),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return patrol


stop_signals: list[int] = []


def stop_at_signals(stop):
    """Call `stop` at the first SIGINT, SIGTERM or SIGHUP; the second one ends the program.

    A thread reads the signals from a socket: Python runs no signal handler while the main
    thread is blocked.
    """
    read, write = socket.socketpair()
    write.setblocking(False)
    signal.set_wakeup_fd(write.detach())
    known = {signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)}
    handled = [number for number in known if signal.getsignal(number) != signal.SIG_IGN]
    for number in handled:
        signal.signal(number, lambda number, frame: stop_signals.append(number))

    terminals = [stream for stream in range(3) if os.isatty(stream)]

    def wait():
        is_stopping = False
        while True:
            number = read.recv(1)[0]
            if number in handled and is_stopping:
                os._exit(128 + number)
            if number in handled:
                is_stopping = True
                for stream in terminals:
                    if not os.isatty(stream):  # it was closed: output to it is an error
                        os.dup2(os.open(os.devnull, os.O_RDWR), stream)
                threading.Thread(target=stop, daemon=False).start()

    threading.Thread(target=wait, daemon=True).start()


def start_node(name):
    """Start a ROS node, which the first signal shuts down."""
    rospy.init_node(name, disable_signals=True)
    stop_at_signals(lambda: rospy.signal_shutdown("signal"))


def preempt_at_shutdown(machine):
    """Preempt a state machine before the node shuts down and wait up to 5 s."""

    def preempt():
        end = time.monotonic() + 5.0
        machine.request_preempt()
        while machine.is_running():
            if time.monotonic() > end:
                smach.logwarn(
                    "the state machine did not end within 5 s: the node shuts down"
                )
                break
            time.sleep(0.02)

    rospy.on_shutdown(preempt)


def main():
    """Run the state machine once as a ROS node and return its outcome."""
    start_node("patrol")
    patrol = build()
    preempt_at_shutdown(patrol)
    return patrol.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)

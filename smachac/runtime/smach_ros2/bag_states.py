"""The state type that records topics to bags, with a `ros2 bag record` process for each bag."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar
from weakref import WeakKeyDictionary

from smachac.runtime import smach
from smachac.runtime.smach_ros2.bags import Recordings
from smachac.runtime.smach_ros2.publish_states import optional


class RecordROSBagState(smach.State):
    """Starts or stops the recording of topics to a ROS bag."""

    recordings: ClassVar[WeakKeyDictionary[Any, Recordings]] = WeakKeyDictionary()

    def __init__(
        self,
        node: Any,
        action: str,
        input_keys: Sequence[str] = ("file", "topics"),
        output_keys: Sequence[str] = (),
    ) -> None:
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.node = node
        self.action = action

    def execute(self, userdata: Any) -> str:
        running = self.recordings.setdefault(self.node, Recordings())
        if self.action == "stop_all":
            running.stop_all()
            return "succeeded"
        file = optional(userdata, "file")
        topics = optional(userdata, "topics", [])
        if not isinstance(file, str) or not all(isinstance(item, str) for item in topics):
            self.node.get_logger().error("`file` must be a string and `topics` a list of strings")
            return "aborted"
        if self.action == "stop":
            return "succeeded" if running.stop(file) else "aborted"
        return "succeeded" if running.start(file, topics) else "aborted"

"""Tells tf where the frame `tool` is: 1 m in front of `base`."""

from __future__ import annotations

import rospy
import tf2_ros
from client import say
from geometry_msgs.msg import TransformStamped

rospy.init_node("frames")
frames = tf2_ros.StaticTransformBroadcaster()
transform = TransformStamped()
transform.header.frame_id, transform.child_frame_id = "base", "tool"
transform.transform.translation.x = 1.0
transform.transform.rotation.w = 1.0
frames.sendTransform(transform)
say("ready")
rospy.spin()

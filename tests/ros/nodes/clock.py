"""A simulation whose time runs by 100 s every few milliseconds."""

from __future__ import annotations

import rospy
from client import say
from rosgraph_msgs.msg import Clock

rospy.init_node("clock")
clock = rospy.Publisher("/clock", Clock, queue_size=1)
say("ready")
now = 0
while not rospy.is_shutdown():
    now += 100
    clock.publish(Clock(clock=rospy.Time(now)))
    rospy.rostime.wallsleep(0.01)

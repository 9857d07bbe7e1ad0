"""Publishes the numbers given as arguments, one after the other, to its first subscriber."""

from __future__ import annotations

import sys

import rospy
from client import say
from std_msgs.msg import Int32

rospy.init_node("topics")
number = rospy.Publisher("number", Int32, queue_size=10)
say("ready")
while not number.get_num_connections() and not rospy.is_shutdown():
    rospy.rostime.wallsleep(0.01)
for argument in sys.argv[1:]:
    number.publish(int(argument))
rospy.spin()

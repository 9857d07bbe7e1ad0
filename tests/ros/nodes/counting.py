"""Counts from 0 to 9 on a topic, again and again, as long as that many listen."""

from __future__ import annotations

import itertools
import sys

import rospy
from client import say
from std_msgs.msg import Int32

rospy.init_node("counting")
number = rospy.Publisher("number", Int32, queue_size=100)
say("ready")
numbers = itertools.cycle(range(10))
while not rospy.is_shutdown():
    rospy.rostime.wallsleep(0.02)
    if number.get_num_connections() >= int(sys.argv[1]):
        number.publish(next(numbers))

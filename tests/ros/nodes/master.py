"""The ROS master, on a port that the system chooses: no other program can take it meanwhile."""

from __future__ import annotations

import threading

from rosmaster.master import Master

master = Master(port=0)
master.start()
print(f"ready {master.uri}")
threading.Event().wait()

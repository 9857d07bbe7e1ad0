#!/usr/bin/env bash
# Subject: parameters of a node on the command line and in a file (rcl 10.1.3, rclpy 9.1.2, ROS 2 Kilted; rclpy 7.1.6,
# Jazzy, gives the same values).
#
# Guess before the run: `-p limit:=3.0` after `--params-file FILE` overrides every value of `limit` in the file, because
# it is the last argument and the documentation calls it an override.
#
# Behaviour: rcl adds `-p` to the section `/**` that the file has begun. The last section that fits the node wins, so a
# section of the node after `/**` hides the argument. In one section a whole number and a float have places of their
# own, and the whole number is read first: `limit: 1` in the file hides `-p limit:=0.5`. `-p limit:=[]` leaves the
# parameter without type and value. There is no warning in any case.
#
# Output of 27 November 2026:
#   own section after /**, -p limit:=3.0 : 2.0
#   own section alone, -p limit:=3.0 : 3.0
#   /** after the own section : 1.0
#   limit: 1 in /**, -p limit:=0.5 : 1
#   declared [1.0], -p limits:=[] : None
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"${PYTHON:-python3}" -m venv venv
venv/bin/pip install -q ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=$((RANDOM % 100 + 1)) ROS_LOG_DIR=$folder/log

own=$'machine:\n  ros__parameters: {limit: 2.0}\n'
all=$'/**:\n  ros__parameters: {limit: 1.0}\n'
printf '%s%s' "$all" "$own" >all_own.yaml
printf '%s%s' "$own" "$all" >own_all.yaml
printf '%s' "$own" >own.yaml
printf '/**:\n  ros__parameters: {limit: 1}\n' >whole.yaml
cat >node.py <<'PYTHON'
import sys

import rclpy
from rcl_interfaces.msg import ParameterDescriptor

title, name, arguments = sys.argv[1], sys.argv[2], sys.argv[3:]
rclpy.init(args=["--ros-args", *arguments])
node = rclpy.create_node("machine")
default = [1.0] if name == "limits" else None
declared = node.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True))
print(title, ":", declared.value)
rclpy.shutdown()
PYTHON
show() { venv/bin/python node.py "$@"; }
{
  show 'own section after /**, -p limit:=3.0' limit --params-file all_own.yaml -p limit:=3.0
  show 'own section alone, -p limit:=3.0' limit --params-file own.yaml -p limit:=3.0
  show '/** after the own section' limit --params-file own_all.yaml
  show 'limit: 1 in /**, -p limit:=0.5' limit --params-file whole.yaml -p limit:=0.5
  show 'declared [1.0], -p limits:=[]' limits -p 'limits:=[]'
} | tee seen
diff - seen <<'EXPECTED'
own section after /**, -p limit:=3.0 : 2.0
own section alone, -p limit:=3.0 : 3.0
/** after the own section : 1.0
limit: 1 in /**, -p limit:=0.5 : 1
declared [1.0], -p limits:=[] : None
EXPECTED

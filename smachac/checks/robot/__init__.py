"""Rules over the robot: values that it receives, motions, grasps and bodies."""

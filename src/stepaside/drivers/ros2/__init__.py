"""ROS 2 topics without ROS: DDS with the standard types."""

"""Driver and server for ROS 2 topics, by DDS without a ROS installation."""

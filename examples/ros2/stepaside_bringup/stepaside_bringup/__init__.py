"""Launch files that run ``stepaside play`` beside a robot's ROS 2 nodes."""

"""Where the images of a robot that is played come from."""

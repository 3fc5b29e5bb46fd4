"""What drives robots that are not simulated here, by their own languages."""

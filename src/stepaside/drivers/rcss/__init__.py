"""Driver of the RoboCup simulator on MuJoCo, rcssservermj."""

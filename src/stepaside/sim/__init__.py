"""The MuJoCo world: floor, rooms, persons, robots and their sensors."""

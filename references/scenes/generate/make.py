"""Writes the scenes that are too long to write by hand: `python3 references/scenes/generate/make.py [FOLDER]`."""

import sys
from pathlib import Path

from cube_room import cube_room, cube_room_edits
from office import office
from robot_room import robot_room
from small_lamp import aliasing_only, small_lamp

SCENES = {
    "cube-room": cube_room,
    "cube-room-edits": cube_room_edits,
    "robot-room": robot_room,
    "small-lamp": small_lamp,
    "aliasing-only": aliasing_only,
    "office": office,
}

if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    for name, text in SCENES.items():
        (folder / f"{name}.toml").write_bytes(text().encode())

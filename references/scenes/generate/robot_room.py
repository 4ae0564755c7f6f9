"""The room of figure 7 of George, Sillion and Greenberg 1990, in size: 12,700 patches, 45,900 elements."""

from robot import robot
from shapes import Scene, overlapping, room

HEAD = """
# A robot comes into a furnished room.
# The size of the "robot" scene of George, Sillion and Greenberg 1990, figure 7 (12,700 patches, 45,900 elements); the
# geometry is made up: a closed room of 6 m x 5 m x 2.8 m with two lamps in the ceiling, a table and chairs, shelves
# with books, a sofa, a cupboard and pictures, and a jointed robot of closed, convex parts that stands on the floor.
# Furniture keeps 1 or 2 mm off whatever it stands on, so that only the robot's feet are in contact. Written by
# generate/make.py.
format = "etalon-scene/1"
name = "robot-room"
enclosure = true

[[material]]
name = "wall"
reflectance = [0.54, 0.52, 0.47]

[[material]]
name = "ceiling"
reflectance = [0.65, 0.65, 0.65]

[[material]]
name = "accent"
reflectance = [0.34, 0.46, 0.52]

[[material]]
name = "floor"
reflectance = [0.44, 0.36, 0.28]

[[material]]
name = "wood"
reflectance = [0.55, 0.38, 0.22]

[[material]]
name = "dark-wood"
reflectance = [0.36, 0.25, 0.2]

[[material]]
name = "sofa"
reflectance = [0.5, 0.26, 0.22]

[[material]]
name = "paper"
reflectance = [0.75, 0.72, 0.64]

[[material]]
name = "green"
reflectance = [0.24, 0.46, 0.28]

[[material]]
name = "blue"
reflectance = [0.22, 0.32, 0.58]

[[material]]
name = "red"
reflectance = [0.65, 0.22, 0.2]

[[material]]
name = "shell"
reflectance = [0.72, 0.72, 0.76]

[[material]]
name = "joint"
reflectance = [0.3, 0.32, 0.36]

[[material]]
name = "panel"
reflectance = [0.2, 0.24, 0.3]

[[material]]
name = "bright-lamp"
reflectance = 0.2
emission = [86, 80, 71]

[[material]]
name = "dim-lamp"
reflectance = 0.2
emission = [4, 3.8, 3.6]
"""

TAIL = """
[initial]
absent = ["robot"]

[[edit]]
add = "robot"

[[camera]]
name = "main"
eye = [5.45, 0.35, 1.75]
target = [2.9, 2.6, 0.8]
up = [0, 0, 1]
fov = 55
size = [800, 600]
"""

COLOURS = ["red", "green", "blue", "paper", "dark-wood"]


def robot_room():
    s = Scene()
    hull(s)
    table(s, "table", 0.9, 1.1)
    chair(s, "chair-1", 1.1, 0.55, True)
    chair(s, "chair-2", 1.8, 0.55, True)
    chair(s, "chair-3", 1.45, 2.1, False)
    shelves(s)
    sofa(s)
    cupboard(s)
    pictures(s)
    things(s)
    s.place(robot(), 0.9, 38, (3.35, 2.15, 0))
    assert s.counts() == (12700, 45900), s.counts()
    assert not overlapping(s.solids), overlapping(s.solids)
    return s.write(HEAD, TAIL)


def hull(s):
    xs = [(0, 1.2, 9), (1.2, 1.8, 4), (1.8, 4.025, 16), (4.025, 4.575, 4), (4.575, 6, 10)]
    ys = [(0, 1.2, 9), (1.2, 1.8, 4), (1.8, 2.525, 5), (2.525, 3.075, 4), (3.075, 5, 14)]
    walls = dict(floor="floor", ceiling="ceiling", west="accent", east="wall", south="wall", north="wall")
    room(s, walls, (6, 5, 2.8), xs, ys, [(0, 2.8, 20)], ceiling_holes=[(1, 1), (3, 3)])
    for name, x, y, side in (("bright-lamp", 4.025, 2.525, 0.55), ("dim-lamp", 1.2, 1.2, 0.6)):
        u, v = x + side, y + side
        s.face(name, "lamps", name, [(x, y, 2.8), (x, v, 2.8), (u, v, 2.8), (u, y, 2.8)], (1, 2), (2, 1))


def block(s, name, obj, material, low, high, cell):
    """Furniture keeps 2 mm off furniture and 1 mm off walls and floor, so that nothing is covered."""
    s.box(name, obj, material, low, high, cell, less=0.001)


def legs(s, name, material, low, high, top, width, cell):
    corners = [(x, y) for y in (low[1], high[1] - width) for x in (low[0], high[0] - width)]
    for k, (x, y) in enumerate(corners):
        block(s, f"{name}-leg-{k}", name, material, (x, y, 0), (x + width, y + width, top), cell)


def table(s, name, x, y):
    block(s, f"{name}-top", name, "wood", (x, y, 0.72), (x + 1.5, y + 0.9, 0.76), 0.08)
    legs(s, name, "wood", (x + 0.06, y + 0.06), (x + 1.44, y + 0.84), 0.72, 0.07, 0.12)


def chair(s, name, x, y, faces_north):
    """A seat of 0.42 m x 0.42 m with its back on the far side from the table."""
    block(s, f"{name}-seat", name, "blue", (x, y, 0.43), (x + 0.42, y + 0.42, 0.47), 0.07)
    legs(s, name, "dark-wood", (x + 0.01, y + 0.01), (x + 0.41, y + 0.41), 0.43, 0.04, 0.12)
    back = y if faces_north else y + 0.38
    block(s, f"{name}-back", name, "blue", (x, back, 0.47), (x + 0.42, back + 0.04, 0.95), 0.07)


def shelves(s):
    x0, x1, y0, y1, high, t = 2.7, 4.5, 4.66, 5.0, 2.0, 0.03
    for k, x in enumerate((x0, x1 - t)):
        block(s, f"shelf-side-{k}", "shelf", "wood", (x, y0, 0), (x + t, y1, high), 0.11)
    for k in range(5):
        z = 0.08 + 0.45 * k
        block(s, f"shelf-board-{k}", "shelf", "wood", (x0 + t, y0, z), (x1 - t, y1, z + t), 0.11)
        for b in range(0 if k == 4 else 8):
            book(s, k, b, (x0 + 0.1 + 0.2 * b + 0.03 * (k % 2), y0 + 0.04, z + t))


def book(s, k, b, low):
    """The book in place b of shelf k: sizes and colours from short patterns."""
    size = (0.05 + 0.015 * ((2 * b + k) % 4), 0.2 + 0.02 * ((b + 2 * k) % 4), 0.22 + 0.03 * ((3 * b + k) % 5))
    high = tuple(a + e for a, e in zip(low, size))
    block(s, f"book-{k}-{b}", "shelf", COLOURS[(2 * b + k) % 5], low, high, 0.2)


def sofa(s):
    block(s, "sofa-base", "sofa", "sofa", (0.5, 4.1, 0), (2.3, 5.0, 0.26), 0.12)
    block(s, "sofa-back", "sofa", "sofa", (0.5, 4.78, 0.26), (2.3, 5.0, 0.85), 0.12)
    for k, x in enumerate((0.5, 2.12)):
        block(s, f"sofa-arm-{k}", "sofa", "sofa", (x, 4.1, 0.26), (x + 0.18, 4.78, 0.6), 0.1)
    for k, x in enumerate((0.69, 1.405)):
        block(s, f"sofa-cushion-{k}", "sofa", "paper", (x, 4.12, 0.26), (x + 0.705, 4.77, 0.42), 0.1)


def cupboard(s):
    block(s, "cupboard", "cupboard", "wood", (0, 2.3, 0), (0.45, 3.7, 0.8), 0.11)
    for k in range(2):
        y = 2.32 + 0.69 * k
        block(s, f"cupboard-door-{k}", "cupboard", "dark-wood", (0.45, y, 0.04), (0.47, y + 0.67, 0.76), 0.1)
        knob = (0.471, 2.93 + 0.14 * k, 0.42)
        s.lathe(f"cupboard-knob-{k}", "cupboard", "paper", knob, (1, 0, 0), [(0, 0.02, 1), (0.03, 0.015, 1)], sides=8)


def pictures(s):
    """Frames of four bars around a canvas, hung on the north wall."""
    for name, x, w, z, h, colour in (("left", 0.7, 0.6, 1.3, 0.75, "green"), ("right", 1.55, 0.55, 1.4, 0.6, "red")):
        y, b = 4.97, 0.05
        block(s, f"picture-{name}-low", "pictures", "dark-wood", (x, y, z), (x + w, 5, z + b), 0.15)
        block(s, f"picture-{name}-high", "pictures", "dark-wood", (x, y, z + h - b), (x + w, 5, z + h), 0.15)
        for k, left in enumerate((x, x + w - b)):
            low, high = (left, y, z + b), (left + b, 5, z + h - b)
            block(s, f"picture-{name}-side-{k}", "pictures", "dark-wood", low, high, 0.15)
        block(s, f"picture-{name}-canvas", "pictures", colour, (x + b, 4.985, z + b), (x + w - b, 5, z + h - b), 0.09)


def things(s):
    up = (0, 0, 1)
    s.lathe("vase", "things", "blue", (0.22, 2.6, 0.801), up, [(0, 0.05, 3), (0.16, 0.1, 3), (0.3, 0.05, 1)])
    s.lathe("bowl", "things", "paper", (1.5, 1.55, 0.761), up, [(0, 0.07, 2), (0.06, 0.13, 1), (0.08, 0.13, 1)])
    s.lathe("pot", "things", "red", (5.2, 4.5, 0.001), up, [(0, 0.16, 3), (0.35, 0.22, 1)], elements=(2, 2))
    s.ball("bush", "things", "green", (5.2, 4.5, 0.83), 0.38, elements=(2, 2))
    s.lathe("lamp-foot", "things", "joint", (0.25, 4.5, 0.001), up, [(0, 0.14, 1), (0.03, 0.12, 1)])
    s.lathe("lamp-pole", "things", "joint", (0.25, 4.5, 0.032), up, [(0, 0.015, 12), (1.4, 0.015, 1)], sides=8)
    s.lathe("lamp-shade", "things", "paper", (0.25, 4.5, 1.433), up, [(0, 0.22, 3), (0.3, 0.13, 1)], elements=(2, 2))
    for k, (dx, dy) in enumerate(((0, 0), (0.03, 0.02), (0.01, 0.03))):
        low = (0.1 + dx, 3.1 + dy, 0.8 + 0.04 * k)
        block(s, f"pile-{k}", "things", COLOURS[k], low, (low[0] + 0.2, low[1] + 0.28, low[2] + 0.04), 0.1)

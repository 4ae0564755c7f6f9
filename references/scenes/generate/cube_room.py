"""The room of figure 6 of George, Sillion and Greenberg 1990, in size: 450 patches, 1,750 elements."""

from shapes import Scene, cells, room

HEAD = """
# {title}
# The size of the "cube" scene of George, Sillion and Greenberg 1990, figure 6 (450 patches, 1,750 elements); the
# geometry is made up: a closed room of 4.2 m x 3.3 m x 2.6 m, a table on one leg, a lamp in the ceiling, and a cube
# that hovers 10 cm above the table. Nothing is covered by anything. Written by generate/make.py.
format = "etalon-scene/1"
name = "{name}"
enclosure = true

[[material]]
name = "white"
reflectance = [0.64, 0.63, 0.6]

[[material]]
name = "ceiling"
reflectance = [0.7, 0.7, 0.7]

[[material]]
name = "red"
reflectance = [0.62, 0.3, 0.24]

[[material]]
name = "blue"
reflectance = [0.26, 0.38, 0.6]

[[material]]
name = "floor"
reflectance = [0.46, 0.38, 0.3]

[[material]]
name = "table"
reflectance = [0.72, 0.62, 0.48]

[[material]]
name = "paint"
reflectance = [0.75, 0.55, 0.2]

[[material]]
name = "lamp"
reflectance = 0.2
emission = [62, 58, 50]
"""

CAMERA = """
[[camera]]
name = "main"
eye = [3.55, 0.2, 1.75]
target = [2.05, 1.75, 0.8]
up = [0, 0, 1]
fov = 56
size = [640, 480]
"""

ADD = """
[initial]
absent = ["cube"]

[[edit]]
add = "cube"
"""

MORE = """
[[edit]]
move = "cube"
rotate = { axis = [0, 0, 1], degrees = 30, about = [2.08, 1.68, 0] }
translate = [0.5, -0.1, 0.1]

[[edit]]
replace = "cube"
scale = [1, 1, 0.5]
about = [2.58, 1.58, 0.95]

[[edit]]
material = "paint"
reflectance = [0.2, 0.6, 0.35]

[[edit]]
material = "lamp"
emission = [40, 44, 50]

[[edit]]
remove = "cube"
"""


def surfaces():
    s = Scene()
    xs = [(0, 0.8, 2), (0.8, 1.3, 1), (1.3, 2.1, 2), (2.1, 2.4, 1), (2.4, 4.2, 3)]
    ys = [(0, 1.5, 3), (1.5, 1.8, 1), (1.8, 2.3, 1), (2.3, 3.3, 2)]
    walls = dict(floor="floor", ceiling="ceiling", west="red", east="blue", south="white", north="white")
    room(s, walls, (4.2, 3.3, 2.6), xs, ys, [(0, 2.6, 4)], floor_holes=[(3, 1)], ceiling_holes=[(1, 2)])
    s.face("lamp", "lamp", "lamp", [(0.8, 1.8, 2.6), (0.8, 2.3, 2.6), (1.3, 2.3, 2.6), (1.3, 1.8, 2.6)], (1, 1), (2, 1))
    # The table: the leg stands in holes of the floor and of the board's underside, so that nothing is covered.
    x0, x1, y0, y1, low, high = 1.5, 3.0, 1.2, 2.1, 0.7, 0.75
    sides = [(0, 0.6, 2), (0.6, 0.9, 1), (0.9, 1.5, 2)], [(0, 0.3, 1), (0.3, 0.6, 1), (0.6, 0.9, 1)]
    fine = [[(a, b, 3 * n) for a, b, n in side] for side in sides]
    ex, ey, ez = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    cells(s, "table-top", "table", "table", (x0, y0, high), ex, ey, *fine)
    cells(s, "table-under", "table", "table", (x0, y0, low), ey, ex, *sides[::-1], holes=[(1, 1)])
    edge, ends = [(0, high - low, 1)], [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    for k, (direction, name) in enumerate(zip([ex, ey, (-1, 0, 0), (0, -1, 0)], ["south", "east", "north", "west"])):
        cells(s, f"table-{name}", "table", "table", (*ends[k], low), direction, ez, sides[k % 2], edge, (1, 1))
    s.box("table-leg", "table", "table", (2.1, 1.5, 0), (2.4, 1.8, low), 0.35, skip=("bottom", "top"))
    s.box("cube", "cube", "paint", (1.9, 1.5, 0.85), (2.26, 1.86, 1.21), 0.18)
    assert s.counts() == (450, 1750), s.counts()
    return s


def cube_room():
    head = HEAD.format(name="cube-room", title="A cube comes into a room.")
    return surfaces().write(head, ADD + CAMERA)


def cube_room_edits():
    head = HEAD.format(
        name="cube-room-edits",
        title="A cube comes into a room, moves, is reshaped and painted, the lamp is changed, and the cube goes.",
    )
    return surfaces().write(head, ADD + MORE + CAMERA)

"""An office with small lamps: about 6,000 patches."""

from robot_room import block, legs
from shapes import Scene, cells, overlapping

HEAD = """
# An office, made up: a closed room of 6.4 m x 5 m x 2.8 m with two windows in deep recesses, six lamps of 0.12 m in the
# ceiling, four desks, each with a screen, a keyboard, a drawer unit and a small lamp of 0.08 m x 0.08 m over it, four
# chairs, shelves with folders, a cabinet, bins and a plant. Furniture keeps 1 or 2 mm off whatever it stands on:
# nothing is covered by anything. Written by generate/make.py.
format = "etalon-scene/1"
name = "office"
enclosure = true

[[material]]
name = "wall"
reflectance = [0.68, 0.67, 0.63]

[[material]]
name = "ceiling"
reflectance = [0.78, 0.78, 0.78]

[[material]]
name = "carpet"
reflectance = [0.22, 0.25, 0.3]

[[material]]
name = "desk"
reflectance = [0.62, 0.5, 0.36]

[[material]]
name = "steel"
reflectance = [0.42, 0.43, 0.45]

[[material]]
name = "fabric"
reflectance = [0.2, 0.28, 0.42]

[[material]]
name = "screen"
reflectance = [0.2, 0.2, 0.22]

[[material]]
name = "paper"
reflectance = [0.78, 0.76, 0.7]

[[material]]
name = "red"
reflectance = [0.6, 0.22, 0.2]

[[material]]
name = "green"
reflectance = [0.24, 0.46, 0.28]

[[material]]
name = "window"
reflectance = 0.2
emission = [7, 8, 9.5]

[[material]]
name = "downlight"
reflectance = 0.2
emission = [900, 850, 760]

[[material]]
name = "desk-lamp"
reflectance = 0.2
emission = [700, 620, 500]
"""

TAIL = """
[[camera]]
name = "main"
eye = [6.05, 0.3, 1.85]
target = [2.6, 2.9, 0.75]
up = [0, 0, 1]
fov = 62
size = [800, 600]
"""

SIZE = (6.4, 5.0, 2.8)
EX, EY, EZ = (1, 0, 0), (0, 1, 0), (0, 0, 1)
BACK_X, BACK_Y = (-1, 0, 0), (0, -1, 0)
FOLDERS = ["red", "green", "fabric", "paper", "steel"]


def office():
    s = Scene()
    hull(s)
    for k, (x, y, chair_y) in enumerate([(0.7, 0.9, 0.42), (2.9, 0.9, 0.42), (0.7, 3.0, 3.58), (2.9, 3.0, 3.58)]):
        desk(s, f"desk-{k}", x, y, chair_y < y)
        chair(s, f"chair-{k}", x + 0.55, chair_y, chair_y < y)
    shelves(s)
    cabinet(s)
    plant(s)
    assert not overlapping(s.solids), overlapping(s.solids)
    return s.write(HEAD, TAIL)


def hull(s):
    """Floor, ceiling with holes for lamps, walls; the north wall has two windows in recesses of 0.25 m."""
    x, y, z = SIZE
    xs = [(0, 0.8, 4), (0.8, 2.2, 7), (2.2, 3.0, 4), (3.0, 4.4, 7), (4.4, 6.4, 10)]
    whole = lambda length, n: [(0, length, n)]
    cells(s, "floor", "room", "carpet", (0, 0, 0), EX, EY, whole(x, 32), whole(y, 25), (1, 1))
    cuts = lambda places, end: strips([(p, p + 0.12) for p in places], end)
    along, across = cuts((1.3, 3.2, 5.1), x), cuts((1.2, 3.6), y)
    holes = [(j, i) for i in (1, 3, 5) for j in (1, 3)]
    cells(s, "ceiling", "room", "ceiling", (0, 0, z), EY, EX, across, along, (1, 1), holes)
    for j, i in holes:
        (a0, a1, _), (b0, b1, _) = across[j], along[i]
        corners = [(b0, a0, z), (b0, a1, z), (b1, a1, z), (b1, a0, z)]
        s.face(f"downlight-{i // 2}{j // 2}", "downlights", "downlight", corners)
    cells(s, "west", "room", "wall", (0, 0, 0), EY, EZ, whole(y, 20), whole(z, 11), (1, 1))
    cells(s, "east", "room", "wall", (x, y, 0), BACK_Y, EZ, whole(y, 20), whole(z, 11), (1, 1))
    cells(s, "south", "room", "wall", (x, 0, 0), BACK_X, EZ, whole(x, 26), whole(z, 11), (1, 1))
    zs = [(0, 0.9, 4), (0.9, 2.3, 6), (2.3, z, 2)]
    cells(s, "north", "room", "wall", (0, y, 0), EX, EZ, xs, zs, (1, 1), holes=[(1, 1), (3, 1)])
    for k, left in enumerate((0.8, 3.0)):
        recess(s, f"window-{k}", left, left + 1.4, 0.9, 2.3)


def strips(holes, end):
    """Blocks along an edge: a patch across each hole, cells of about 0.25 m between."""
    blocks, at = [], 0
    for low, high in holes:
        blocks += [(at, low, max(1, round((low - at) / 0.25))), (low, high, 1)]
        at = high
    return blocks + [(at, end, max(1, round((end - at) / 0.25)))]


def recess(s, name, x0, x1, z0, z1, depth=0.25):
    y, back = SIZE[1], SIZE[1] + depth
    width, height = x1 - x0, z1 - z0
    faces = [
        ("sill", "wall", (x0, y, z0), EX, EY, (width, 7), (depth, 2)),
        ("head", "wall", (x0, y, z1), EY, EX, (depth, 2), (width, 7)),
        ("left", "wall", (x0, y, z0), EY, EZ, (depth, 2), (height, 6)),
        ("right", "wall", (x1, back, z0), BACK_Y, EZ, (depth, 2), (height, 6)),
        ("pane", "window", (x0, back, z0), EX, EZ, (width, 7), (height, 7)),
    ]
    for part, material, origin, u, v, (a, na), (b, nb) in faces:
        cells(s, f"{name}-{part}", "windows", material, origin, u, v, [(0, a, na)], [(0, b, nb)], (1, 1))


def desk(s, name, x, y, faces_north):
    """A table of 1.6 m x 0.8 m; what stands on it is put on the far side from the chair."""
    top = 0.74
    block(s, f"{name}-top", name, "desk", (x, y, 0.7), (x + 1.6, y + 0.8, top), 0.1)
    legs(s, name, "steel", (x + 0.04, y + 0.04), (x + 1.56, y + 0.76), 0.7, 0.06, 0.14)
    block(s, f"{name}-drawers", name, "steel", (x + 1.08, y + 0.12, 0), (x + 1.48, y + 0.68, 0.56), 0.14)
    far = lambda d: y + 0.8 - d if faces_north else y + d
    across = lambda d0, d1: sorted((far(d0), far(d1)))
    (f0, f1), (p0, p1), (k0, k1) = across(0.1, 0.3), across(0.18, 0.22), across(0.45, 0.6)
    block(s, f"{name}-foot", name, "steel", (x + 0.55, f0, top), (x + 0.8, f1, top + 0.02), 0.1)
    block(s, f"{name}-post", name, "steel", (x + 0.65, p0, top + 0.02), (x + 0.7, p1, top + 0.12), 0.1)
    block(s, f"{name}-screen", name, "screen", (x + 0.4, p0, top + 0.12), (x + 0.95, p1, top + 0.47), 0.08)
    block(s, f"{name}-keys", name, "screen", (x + 0.45, k0, top), (x + 0.9, k1, top + 0.025), 0.08)
    paper0, paper1 = across(0.42, 0.72)
    block(s, f"{name}-papers", name, "paper", (x + 1.05, paper0, top), (x + 1.27, paper1, top + 0.03), 0.1)
    desk_lamp(s, f"{name}-lamp", name, x + 1.3, far(0.2), top)


def desk_lamp(s, name, obj, x, y, top):
    """A foot, a pole and an arm towards the middle of the desk, under whose head a square of 8 cm glows."""
    s.lathe(f"{name}-foot", obj, "steel", (x, y, top + 0.002), EZ, [(0, 0.08, 1), (0.02, 0.07, 1)], sides=10)
    s.lathe(f"{name}-pole", obj, "steel", (x, y, top + 0.024), EZ, [(0, 0.012, 4), (0.4, 0.012, 1)], sides=6)
    low, high = (x - 0.2, y - 0.06, top + 0.426), (x + 0.03, y + 0.06, top + 0.47)
    s.box(f"{name}-head", obj, "steel", low, high, 0.06, (1, 1), skip=("bottom",))
    xs, ys = [(0, 0.03, 1), (0.03, 0.11, 1), (0.11, 0.23, 2)], [(0, 0.02, 1), (0.02, 0.1, 1), (0.1, 0.12, 1)]
    cells(s, f"{name}-under", obj, "steel", low, EY, EX, ys, xs, (1, 1), holes=[(1, 1)])
    at = lambda a, b: (low[0] + a, low[1] + b, low[2])
    s.face(name, "desk-lamps", "desk-lamp", [at(0.03, 0.02), at(0.03, 0.1), at(0.11, 0.1), at(0.11, 0.02)])


def chair(s, name, x, y, faces_north):
    block(s, f"{name}-seat", name, "fabric", (x, y, 0.43), (x + 0.44, y + 0.42, 0.48), 0.08)
    legs(s, name, "steel", (x + 0.01, y + 0.01), (x + 0.43, y + 0.41), 0.43, 0.04, 0.12)
    back = y if faces_north else y + 0.38
    block(s, f"{name}-back", name, "fabric", (x, back, 0.48), (x + 0.44, back + 0.04, 0.95), 0.09)


def shelves(s):
    """Against the east wall, with folders on five boards."""
    x0, x1, y0, y1, high, t = 6.05, 6.4, 1.4, 3.4, 2.1, 0.03
    for k, y in enumerate((y0, y1 - t)):
        block(s, f"shelf-side-{k}", "shelf", "desk", (x0, y, 0), (x1, y + t, high), 0.13)
    for k in range(6):
        z = 0.06 + 0.4 * k
        block(s, f"shelf-board-{k}", "shelf", "desk", (x0, y0 + t, z), (x1, y1 - t, z + t), 0.13)
        for b in range(0 if k == 5 else 9):
            low = (x0 + 0.03, y0 + 0.08 + 0.2 * b + 0.02 * (k % 2), z + t)
            size = (0.28, 0.06 + 0.02 * ((b + k) % 3), 0.3 - 0.02 * ((2 * b + k) % 3))
            block(s, f"folder-{k}-{b}", "shelf", FOLDERS[(2 * b + k) % 5], low, tuple(map(sum, zip(low, size))), 0.16)


def cabinet(s):
    block(s, "cabinet", "cabinet", "steel", (5.2, 4.45, 0), (6.3, 5.0, 1.1), 0.14)
    for k in range(3):
        low = (5.22, 4.43, 0.05 + 0.35 * k)
        block(s, f"cabinet-drawer-{k}", "cabinet", "steel", low, (6.28, 4.45, low[2] + 0.33), 0.13)
        block(s, f"cabinet-handle-{k}", "cabinet", "screen", (5.6, 4.4, low[2] + 0.15), (5.9, 4.43, low[2] + 0.18), 0.1)
    for k, (x, y) in enumerate(((2.45, 0.6), (4.7, 3.6))):
        s.lathe(f"bin-{k}", "bins", "steel", (x, y, 0.001), EZ, [(0, 0.11, 3), (0.32, 0.14, 1)])


def plant(s):
    s.lathe("pot", "plant", "red", (5.8, 0.5, 0.001), EZ, [(0, 0.15, 3), (0.34, 0.2, 1)])
    s.lathe("trunk", "plant", "desk", (5.8, 0.5, 0.344), EZ, [(0, 0.02, 4), (0.3, 0.015, 1)], sides=6)
    s.ball("crown", "plant", "green", (5.8, 0.5, 1.03), 0.36, sides=12, bands=6)

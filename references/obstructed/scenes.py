"""The scenes of this folder: patches, opaque bodies, and which pairs and rows are wanted. No library is needed.

A body is a list of faces; a body of one face is a plate, opaque from both sides. Everything is in metres.
"""

import math
import random


def box(low, high):
    """The six faces of a box, counter-clockwise seen from outside."""
    (a, b, c), (d, e, f) = low, high
    return [
        [[a, b, c], [a, e, c], [d, e, c], [d, b, c]],
        [[a, b, f], [d, b, f], [d, e, f], [a, e, f]],
        [[a, b, c], [a, b, f], [a, e, f], [a, e, c]],
        [[d, b, c], [d, e, c], [d, e, f], [d, b, f]],
        [[a, b, c], [d, b, c], [d, b, f], [a, b, f]],
        [[a, e, c], [a, e, f], [d, e, f], [d, e, c]],
    ]


def divided(polygon, na, nb):
    """The patches of a quadrilateral: number a + b * na, a along v0 -> v1, b along v0 -> v3."""

    def at(u, v):
        weights = ((1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v)
        return [sum(w * corner[k] for w, corner in zip(weights, polygon)) for k in range(3)]

    cells = [(a, b) for b in range(nb) for a in range(na)]
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    return [[at((a + s) / na, (b + t) / nb) for s, t in corners] for a, b in cells]


def room(low, high, divisions):
    """Floor, ceiling, west, east, south, north of a room, facing inwards, in this order."""
    (a, b, c), (d, e, f) = low, high
    walls = [
        [[a, b, c], [d, b, c], [d, e, c], [a, e, c]],
        [[a, b, f], [a, e, f], [d, e, f], [d, b, f]],
        [[a, b, c], [a, e, c], [a, e, f], [a, b, f]],
        [[d, b, c], [d, b, f], [d, e, f], [d, e, c]],
        [[a, b, c], [a, b, f], [d, b, f], [d, b, c]],
        [[a, e, c], [d, e, c], [d, e, f], [a, e, f]],
    ]
    return [patch for wall in walls for patch in divided(wall, divisions, divisions)]


def box_surfaces(low, high):
    """The faces of a box as surfaces, in the order and with the corners of the cube scenes."""
    (a, b, c), (d, e, f) = low, high
    return [
        [[a, e, c], [d, e, c], [d, b, c], [a, b, c]],
        [[d, b, f], [d, e, f], [a, e, f], [a, b, f]],
        [[a, b, f], [a, e, f], [a, e, c], [a, b, c]],
        [[d, e, c], [d, e, f], [d, b, f], [d, b, c]],
        [[d, b, c], [d, b, f], [a, b, f], [a, b, c]],
        [[a, e, f], [d, e, f], [d, e, c], [a, e, c]],
    ]


def cube_with_boxes(name, boxes, divisions, rows, pairs):
    """The closed unit cube, 8 x 8 patches a face, with boxes inside."""
    patches = room((0, 0, 0), (1, 1, 1), 8)
    for low, high in boxes:
        for face in box_surfaces(low, high):
            patches += divided(face, divisions, divisions)
    bodies = [box(low, high) for low, high in boxes]
    return {"name": name, "patches": patches, "bodies": bodies, "rows": rows, "pairs": pairs, "enclosure": True}


def grid_of_boxes(places, half):
    spots = [(x, y, z) for x in places for y in places for z in places]
    return [(tuple(round(c - half, 12) for c in s), tuple(round(c + half, 12) for c in s)) for s in spots]


def some_pairs(seed, patches, count):
    """Candidates for pairs, from a fixed seed; the program keeps those that are partly hidden."""
    draw = random.Random(seed)
    return [tuple(draw.sample(range(patches), 2)) for _ in range(count)]


def partition(thickness):
    """Two rooms of 1 m and a wall between them with a door opening of 0.3 x 0.7 m."""
    patches = room((0, 0, 0), (2, 1, 1), 4)
    spans = [((0.0, 0.35), (0.0, 1.0)), ((0.65, 1.0), (0.0, 1.0)), ((0.35, 0.65), (0.7, 1.0))]
    low, high = 1 - thickness / 2, 1 + thickness / 2
    if thickness > 0:
        bodies = [box((low, y[0], z[0]), (high, y[1], z[1])) for y, z in spans]
    else:
        bodies = [[[[1, y[0], z[0]], [1, y[1], z[0]], [1, y[1], z[1]], [1, y[0], z[1]]]] for y, z in spans]
    name = "partition-with-door" if thickness > 0 else "thin-partition-with-door"
    # West wall to east wall, floor to east wall, ceiling to floor: all through the door.
    pairs = [(32, 48), (33, 49), (37, 52), (41, 54), (36, 61), (4, 56), (8, 57), (0, 49), (18, 11), (4, 30), (8, 29)]
    return {"name": name, "patches": patches, "bodies": bodies, "rows": [], "pairs": pairs}


def louvres():
    """Seven slats of 0.16 x 1.2 m, tilted by 40 degrees, between two plates of 1 x 1 m at 1 m."""
    floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    ceiling = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]]
    patches = divided(floor, 3, 3) + divided(ceiling, 3, 3) + [floor, ceiling]
    dx, dz = 0.08 * math.cos(math.radians(40)), 0.08 * math.sin(math.radians(40))
    bodies = []
    for k in range(7):
        x = (k + 0.5) / 7
        slat = [[x - dx, -0.1, 0.5 - dz], [x + dx, -0.1, 0.5 + dz], [x + dx, 1.1, 0.5 + dz], [x - dx, 1.1, 0.5 - dz]]
        bodies.append([[[round(c, 15) for c in corner] for corner in slat]])
    pairs = [(0, 9), (0, 17), (4, 13), (2, 9), (1, 14), (3, 10), (6, 17), (8, 9), (18, 19)]
    return {"name": "louvres", "patches": patches, "bodies": bodies, "rows": [], "pairs": pairs}


def turned_box(centre, half, angles):
    """A box turned about z and then about x."""
    (cz, sz), (cx, sx) = [(math.cos(a), math.sin(a)) for a in angles]

    def place(corner):
        x, y, z = corner
        x, y = cz * x - sz * y, sz * x + cz * y
        y, z = cx * y - sx * z, sx * y + cx * z
        return [centre[0] + x, centre[1] + y, centre[2] + z]

    return [[place(c) for c in face] for face in box([-h for h in half], half)]


def tilted():
    """Patches in general position; two plates that cross in projection; a turned box."""
    patches = [
        [[0.0, 0.0, 0.0], [1.0, 0.1, 0.05], [0.3, 0.9, 0.1]],
        [[0.1, 0.2, 1.2], [0.4, 1.1, 1.3], [1.2, 0.3, 1.0]],
        [[-0.2, -0.1, -0.05], [0.9, -0.2, -0.1], [1.0, 0.9, -0.1], [-0.1, 1.0, -0.05]],
        [[1.5, 0.0, 0.2], [1.6, -0.1, 1.1], [1.4, 0.9, 1.2], [1.3, 1.0, 0.3]],
        [[0.0, 0.0, 1.4], [0.2, 1.0, 1.5], [1.1, 0.5, 1.6]],
    ]
    # The quadrilaterals above are made planar: their last corner is the fourth of a parallelogram.
    for k in (2, 3):
        a, b, c, _ = patches[k]
        patches[k][3] = [a[m] + c[m] - b[m] for m in range(3)]
    triangle = [[[0.1, 0.35, 0.45], [0.95, 0.15, 0.6], [0.6, 0.85, 0.5]]]
    a, b, c = [0.25, 0.05, 0.75], [0.95, 0.55, 0.65], [0.75, 0.95, 0.8]
    quadrilateral = [[a, b, c, [a[m] + c[m] - b[m] for m in range(3)]]]
    block = turned_box((0.45, 0.4, 0.55), (0.2, 0.12, 0.15), (0.5, 0.7))
    pairs = [(0, 1), (2, 1), (0, 4), (2, 4), (0, 3), (2, 3), (1, 3)]
    plates = {"name": "tilted-plates", "patches": patches, "bodies": [triangle, quadrilateral], "rows": [], "pairs": pairs}
    boxed = {"name": "turned-box", "patches": patches, "bodies": [block], "rows": [], "pairs": pairs}
    return plates, boxed


def all_scenes():
    """Every scene; `candidates` are drawn pairs of which ten that are partly hidden are kept."""
    one = cube_with_boxes("cube-box-480", [((0.3,) * 3, (0.7,) * 3)], 4, [0, 27, 200, 389], [])
    eight = cube_with_boxes("cube-boxes-8", grid_of_boxes((0.25, 0.75), 0.1), 1, [0], [])
    many = cube_with_boxes("cube-boxes-27", grid_of_boxes((1 / 6, 0.5, 5 / 6), 1 / 15), 1, [], [])
    for seed, scene in enumerate((one, eight, many), start=1):
        scene["candidates"] = some_pairs(seed, len(scene["patches"]), 300)
    return [one, eight, many, partition(0.1), partition(0.0), louvres(), *tilted()]

#!/usr/bin/env python3
"""A small radiosity solver: the program that is checked in the examples. Python 3.11, nothing else.

    etalon scene patches SCENE.toml -o patches.csv
    python3 solver.py SCENE.toml patches.csv -o solution.csv

It shares nothing with etalon but the list of patches. Form factors: the closed form from sample points on the smaller
of two patches to the other, times the share of it that rays see. The system is solved by Gauss-Seidel.
With --bug NAME it makes one well-known mistake. The same seed gives the same bytes.
"""

import argparse
import csv
import math
import random
import sys
import tomllib
from dataclasses import dataclass

BUGS = {
    "one-patch": "the patch in the middle of the list is 5 % too bright",
    "bright": "everything is 1 % too bright",
    "no-occluder": "light goes through everything",
    "swapped-materials": "the reflectances of the last two materials without emission are mixed up",
    "missing-bounce": "light is lost after its second bounce",
    "srgb": "values are written through the curve of sRGB",
    "radiance": "values are radiances, smaller by pi",
    "irradiance": "values are irradiances, before the surface reflects",
    "transposed": "the matrix of form factors is used with rows and columns exchanged",
}
EPSILON = 1e-9  # metres: what lies nearer to a plane lies in it
RAYS = 8         # each point of a patch looks at one in so many of the points on the other
SLACK = 2e-3    # of the size of a scene: a wall that bends by less still counts as flat


# Vectors are tuples of three numbers.

def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def between(a, b, t):
    return tuple(p + t * (q - p) for p, q in zip(a, b))


@dataclass
class Patch:
    """A flat convex polygon, counter-clockwise seen from the side that radiates."""
    number: int
    corners: list
    normal: tuple
    area: float        # square metres that take part: what another object stands on is left out
    reflectance: list  # per band
    emission: list     # radiosity per band, W/m^2

    def __post_init__(self):
        self.offset = dot(self.normal, self.corners[0])
        first, *rest = self.corners
        whole = sum(math.hypot(*cross(sub(b, first), sub(c, first))) / 2 for b, c in zip(rest, rest[1:]))
        self.is_stood_on = self.area < whole * (1 - 1e-6)
        self.low = [min(c[k] for c in self.corners) for k in range(3)]
        self.high = [max(c[k] for c in self.corners) for k in range(3)]
        # Planes through the edges, along the normal: a point of the plane is inside if it is left of all of them.
        ends = zip(self.corners, self.corners[1:] + self.corners[:1])
        self.edges = [(m, dot(m, a)) for a, b in ends for m in [cross(self.normal, sub(b, a))]]

    def height(self, point):
        """How far a point lies before the plane."""
        n = self.normal
        return n[0] * point[0] + n[1] * point[1] + n[2] * point[2] - self.offset

    def covers(self, point):
        return all(dot(m, point) >= d for m, d in self.edges)


def read_scene(scene_file, patches_file):
    """Patches, as etalon lists them, with the materials of the scene file; and the names of the bands."""
    with open(scene_file, "rb") as file:
        scene = tomllib.load(file)
    bands = scene.get("photometry", {}).get("bands", ["r", "g", "b"])
    materials = {m["name"]: m for m in scene["material"]}

    def per_band(value):
        return list(value) if isinstance(value, list) else [value] * len(bands)

    patches = []
    with open(patches_file, newline="") as file:
        for row in csv.DictReader(file):
            material = materials[row["material"]]
            patches.append(Patch(
                number=int(row["patch"]),
                corners=[tuple(map(float, corner.split())) for corner in row["corners"].split(";")],
                normal=tuple(float(row["normal_" + axis]) for axis in "xyz"),
                area=float(row["area"]),
                reflectance=per_band(material["reflectance"]),
                emission=per_band(material.get("emission", 0.0)),
            ))
    return patches, bands


def points_on(patch, n, draw):
    """n x n points on a patch, one in each cell of a grid: no two of them close together."""
    first, *rest = patch.corners
    triangles = [(first, b, c) for b, c in zip(rest, rest[1:])]
    doubled = [math.hypot(*cross(sub(b, a), sub(c, a))) for a, b, c in triangles]
    points = []
    for i in range(n):
        for j in range(n):
            left = (i + draw()) / n * sum(doubled)
            for (a, b, c), area in zip(triangles, doubled):
                if left <= area:
                    break
                left -= area
            u, v = math.sqrt(min(left / area, 1.0)), (j + draw()) / n
            points.append(between(a, between(b, c, v), u))
    return points


def touch(one, other):
    """Do two patches lie on each other? The back of a thin plate lies there too: but nothing of its area is gone."""
    opposed = dot(one.normal, other.normal) < EPSILON - 1 and abs(one.height(other.corners[0])) < EPSILON
    return opposed and one.is_stood_on and other.is_stood_on


def place_points(patches, n, draw):
    """Points that light leaves from (`free`), and points it may arrive at, some of them under what stands there."""
    for patch in patches:
        across = [p for p in patches if touch(patch, p)]

        def place(count, draw):
            return [(x, any(p.covers(x) for p in across)) for x in points_on(patch, count, draw)]

        # A lamp deserves more: its shadows are the sharpest.
        patch.targets = place(2 * n if any(patch.emission) else n, draw)
        patch.free = [x for x, covered in place(n, lambda: 0.5) if not covered]
        while patch.area and len(patch.free) < n * n:
            patch.free += [x for x, covered in place(n, draw) if not covered]


def before(patch, corners):
    """The part of a polygon before a patch's plane."""
    heights = [patch.height(c) for c in corners]
    if min(heights) >= -EPSILON:
        return corners
    kept = []
    for k, (a, p) in enumerate(zip(corners, heights)):
        b, q = corners[k - len(corners) + 1], heights[k - len(corners) + 1]
        if p > 0:
            kept.append(a)
        if p * q < 0:
            kept.append(between(a, b, p / (p - q)))
    return kept


def seen_open(point, normal, corners):
    """Form factor of a polygon from a point with nothing between: Lambert 1760."""
    arms = [sub(c, point) for c in corners]
    total = 0.0
    for a, b in zip(arms, arms[1:] + arms[:1]):
        turn = cross(a, b)
        length = math.sqrt(dot(turn, turn))
        if length > 1e-15:
            total -= math.atan2(length, dot(a, b)) * dot(turn, normal) / length
    return max(0.0, total / (2 * math.pi))


def hits(start, p, end, blocker):
    """Does a ray that begins at height p meet the front of a blocker? A closed body shows one to every ray."""
    q = blocker.height(end)
    return q < -EPSILON and blocker.covers(between(start, end, p / (p - q)))


def share_seen(point, patch, target, targets, blockers):
    """Share of a patch's light that arrives at a point, by rays to points on it."""
    arrives = comes = 0.0
    facing = [(b, p) for b in blockers if (p := b.height(point)) > EPSILON]
    for end, covered in targets:
        way = sub(end, point)
        weight = max(0.0, dot(patch.normal, way)) * max(0.0, -dot(target.normal, way)) / dot(way, way) ** 2
        comes += weight
        if weight > 0 and not covered and not any(hits(point, p, end, b) for b, p in facing):
            arrives += weight
    return arrives / comes if comes else 0.0


def exchange(small, large, blockers):
    """Area times form factor: the same in both directions."""
    corners = before(small, large.corners)
    if len(corners) < 3 or max(map(large.height, small.corners)) <= EPSILON:
        return 0.0
    hidden = blockers or any(covered for _, covered in large.targets)
    total = 0.0
    for k, point in enumerate(small.free):
        if large.height(point) > EPSILON:
            value = seen_open(point, small.normal, corners)
            share = share_seen(point, small, large, large.targets[k % RAYS::RAYS], blockers) if hidden else 1.0
            total += value * share
    return total / len(small.free) * small.area


def exchanges(patches, n, seed, blind):
    """A_i F_ij of all pairs. What has nothing behind it, such as the walls of a convex room, hides nothing."""
    place_points(patches, n, random.Random(seed).random)
    corners = [c for p in patches for c in p.corners]
    slack = SLACK * math.dist(*[[limit(c[k] for c in corners) for k in range(3)] for limit in (min, max)])
    hiding = [] if blind else [p for p in patches if min(map(p.height, corners)) < -slack]
    ahead = [[b for b in hiding if max(map(p.height, b.corners)) > EPSILON] for p in patches]
    matrix = [[0.0] * len(patches) for _ in patches]
    for i, one in enumerate(patches):
        for j, other in enumerate(patches[:i]):
            if not one.area or not other.area:
                continue
            small, large = (one, other) if one.area <= other.area else (other, one)
            low, high = [min(x) for x in zip(one.low, other.low)], [max(x) for x in zip(one.high, other.high)]
            near = [b for b in ahead[i] if all(b.low[k] <= high[k] and b.high[k] >= low[k] for k in range(3))]
            matrix[i][j] = matrix[j][i] = exchange(small, large, near)
    return matrix


def solve(patches, form_factors, band, sweeps):
    """Radiosities of a band: B = E + rho F B, by Gauss-Seidel; `sweeps` bounces by Jacobi where that is given."""
    emission = [p.emission[band] for p in patches]
    values = list(emission)
    for _ in range(sweeps or 1000):
        old = list(values)
        seen = old if sweeps else values
        for i, patch in enumerate(patches):
            arriving = sum(f * b for f, b in zip(form_factors[i], seen))
            values[i] = emission[i] + patch.reflectance[band] * arriving
        if max(abs(a - b) for a, b in zip(values, old)) < 1e-9 * max(emission):
            break
    return values


def swap_reflectances(patches):
    kinds = list(dict.fromkeys((tuple(p.reflectance), tuple(p.emission)) for p in patches if not any(p.emission)))
    (one, _), (other, _) = kinds[-2:]
    for patch in patches:
        if not any(patch.emission):
            patch.reflectance = list({one: other, other: one}.get(tuple(patch.reflectance), patch.reflectance))


def srgb(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def as_written(patches, i, b, band, bug):
    """The number that is written for a radiosity: the radiosity itself, but for bugs."""
    patch = patches[i]
    match bug:
        case "one-patch":
            return b * 1.05 if i == len(patches) // 2 else b
        case "bright":
            return b * 1.01
        case "srgb":
            return srgb(b)
        case "radiance":
            return b / math.pi
        case "irradiance":
            rho = patch.reflectance[band]
            return (b - patch.emission[band]) / rho if rho else 0.0
    return b


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", help="scene file (.toml, polygons)")
    parser.add_argument("patches", help="what `etalon scene patches SCENE -o patches.csv` wrote")
    parser.add_argument("-o", "--output", required=True, help="solution: patch and radiosity per band, W/m^2")
    parser.add_argument("--points", type=int, default=4, metavar="N", help="N x N sample points a patch, N even (default 4)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bug", choices=BUGS, metavar="NAME", help="one of: " + ", ".join(BUGS))
    options = parser.parse_args()
    if options.points < 2 or options.points % 2:
        parser.error("--points has to be even, and at least 2")
    patches, bands = read_scene(options.scene, options.patches)
    if options.bug == "swapped-materials":
        swap_reflectances(patches)
    flows = exchanges(patches, options.points, options.seed, blind=options.bug == "no-occluder")
    if options.bug == "transposed":
        form_factors = [[f / q.area if q.area else 0.0 for f, q in zip(row, patches)] for row in flows]
    else:
        form_factors = [[f / p.area if p.area else 0.0 for f in row] for row, p in zip(flows, patches)]
    sweeps = 2 if options.bug == "missing-bounce" else None
    per_band = [solve(patches, form_factors, k, sweeps) for k in range(len(bands))]
    with open(options.output, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["patch", *bands])
        for i, patch in enumerate(patches):
            values = [as_written(patches, i, per_band[k][i], k, options.bug) for k in range(len(bands))]
            out.writerow([patch.number, *values])


if __name__ == "__main__":
    sys.exit(main())

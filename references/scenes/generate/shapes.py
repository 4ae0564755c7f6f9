"""Closed shapes of planar, convex faces, written as a scene file. Lengths in metres; the standard library alone."""

from math import cos, pi, sin, sqrt


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def mul(s, a):
    return tuple(s * x for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return mul(1 / sqrt(dot(a, a)), a)


class Scene:
    """Surfaces in file order, and the solids they make."""

    def __init__(self):
        self.surfaces = []
        self.solids = []

    def face(self, name, obj, material, polygon, patches=(1, 1), elements=(1, 1)):
        """A polygon, counter-clockwise seen from the radiating side."""
        self.surfaces.append((name, obj, material, [tuple(map(rounded, p)) for p in polygon], patches, elements))

    def counts(self):
        patches = sum(p[0] * p[1] for *_, p, _ in self.surfaces)
        return patches, sum(p[0] * p[1] * e[0] * e[1] for *_, p, e in self.surfaces)

    def solid(self, name, obj, material, faces):
        """A closed convex solid: `faces` are (suffix, polygon, patches, elements)."""
        self.solids.append((name, [f[1] for f in faces]))
        for suffix, polygon, patches, elements in faces:
            self.face(f"{name}-{suffix}", obj, material, polygon, patches, elements)

    def place(self, other, scale, degrees, at):
        """Another scene, scaled, turned about z, and moved to `at`."""
        c, s = cos(pi * degrees / 180), sin(pi * degrees / 180)
        there = lambda p: add(at, mul(scale, (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2])))
        self.solids += [(name, [list(map(there, f)) for f in faces]) for name, faces in other.solids]
        for name, obj, material, polygon, patches, elements in other.surfaces:
            self.face(name, obj, material, list(map(there, polygon)), patches, elements)

    def box(self, name, obj, material, low, high, cell, elements=(2, 2), frame=None, skip=(), less=0.0):
        """A box with patches of about `cell`; `frame` = (origin, x, y, z) turns it; `skip` leaves faces out; `less` is
        taken off on every side."""
        o, ex, ey, ez = frame or ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
        n = [max(1, round((b - a) / cell)) for a, b in zip(low, high)]
        (x0, y0, z0), (x1, y1, z1) = [v + less for v in low], [v - less for v in high]
        at = lambda x, y, z: add(o, add(mul(x, ex), add(mul(y, ey), mul(z, ez))))
        faces = [
            ("bottom", [at(x0, y0, z0), at(x0, y1, z0), at(x1, y1, z0), at(x1, y0, z0)], (n[1], n[0])),
            ("top", [at(x0, y0, z1), at(x1, y0, z1), at(x1, y1, z1), at(x0, y1, z1)], (n[0], n[1])),
            ("south", [at(x0, y0, z0), at(x1, y0, z0), at(x1, y0, z1), at(x0, y0, z1)], (n[0], n[2])),
            ("north", [at(x1, y1, z0), at(x0, y1, z0), at(x0, y1, z1), at(x1, y1, z1)], (n[0], n[2])),
            ("west", [at(x0, y1, z0), at(x0, y0, z0), at(x0, y0, z1), at(x0, y1, z1)], (n[1], n[2])),
            ("east", [at(x1, y0, z0), at(x1, y1, z0), at(x1, y1, z1), at(x1, y0, z1)], (n[1], n[2])),
        ]
        self.solid(name, obj, material, [(s, q, p, elements) for s, q, p in faces if s not in skip])

    def lathe(self, name, obj, material, base, axis, profile, sides=12, squeeze=1.0, across=None, elements=(1, 1)):
        """A prism of regular rings along `axis`: `profile` lists (height, radius, patches up to the next ring).

        Faces between rings are planar, and stay so when the rings are squeezed in one direction: `squeeze` is the
        half-axis at right angles to `across` over the one along it. The ends are polygons of one patch."""
        w = unit(axis)
        u = across or ((0, 0, 1) if abs(w[2]) < 0.9 else (1, 0, 0))
        u = unit(sub(u, mul(dot(u, w), w)))
        v = cross(w, u)
        turn = [2 * pi * (k + 0.5) / sides for k in range(sides)]
        ring = lambda h, r: [
            add(base, add(mul(h, w), add(mul(r * cos(t), u), mul(squeeze * r * sin(t), v)))) for t in turn
        ]
        rings = [ring(h, r) for h, r, _ in profile]
        faces = [("start", rings[0][::-1], (1, 1), (1, 1)), ("end", rings[-1], (1, 1), (1, 1))]
        for b, (low, high) in enumerate(zip(rings, rings[1:])):
            for k in range(sides):
                j = (k + 1) % sides
                faces.append((f"{b}-{k}", [low[k], low[j], high[j], high[k]], (1, profile[b][2]), elements))
        self.solid(name, obj, material, faces)

    def ball(self, name, obj, material, centre, radius, axis=(0, 0, 1), sides=8, bands=4, elements=(1, 1)):
        """A ball cut flat at both poles, inside the true sphere."""
        tilt = [pi * (0.1 + 0.8 * k / bands) for k in range(bands + 1)]
        profile = [(-radius * cos(t), radius * sin(t), 1) for t in tilt]
        self.lathe(name, obj, material, centre, axis, profile, sides, elements=elements)

    def write(self, head, tail):
        parts = [head.strip() + "\n"]
        for name, obj, material, polygon, patches, elements in self.surfaces:
            lines = ["[[surface]]", f'name = "{name}"', f'object = "{obj}"', f'material = "{material}"']
            corners = ", ".join("[" + ", ".join(map(number, p)) + "]" for p in polygon)
            lines.append(f"polygon = [{corners}]")
            if patches != (1, 1):
                lines.append(f"patches = [{patches[0]}, {patches[1]}]")
            if elements != (1, 1):
                lines.append(f"elements = [{elements[0]}, {elements[1]}]")
            parts.append("\n".join(lines) + "\n")
        return "\n".join(parts) + "\n" + tail.strip() + "\n"


def rounded(x):
    # Faces of a few centimetres must stay planar to 1e-6 of their diagonal.
    return round(x, 9) + 0.0


def number(x):
    return f"{x:.9f}".rstrip("0").rstrip(".")


def cells(scene, name, obj, material, origin, u, v, us, vs, elements=(2, 2), holes=()):
    """A rectangle spanned by `u` and `v`, divided along both at the places `us` and `vs` = [(from, to, patches)].

    Each block is a surface of its own, so that corners meet corners; `holes` are blocks (i, j) left out."""
    at = lambda a, b: add(origin, add(mul(a, u), mul(b, v)))
    for j, (b0, b1, nb) in enumerate(vs):
        for i, (a0, a1, na) in enumerate(us):
            if (i, j) not in holes:
                polygon = [at(a0, b0), at(a1, b0), at(a1, b1), at(a0, b1)]
                scene.face(f"{name}-{i}{j}", obj, material, polygon, (na, nb), elements)


def backwards(blocks, length):
    """The same blocks seen from the other end."""
    return [(length - b, length - a, n) for a, b, n in reversed(blocks)]


def room(scene, material, size, xs, ys, zs, floor_holes=(), ceiling_holes=()):
    """The inside of a box, divided at the same places on opposite sides; `material` maps wall names to materials."""
    x, y, z = size
    ex, ey, ez = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    back = lambda e: mul(-1, e)
    cells(scene, "floor", "room", material["floor"], (0, 0, 0), ex, ey, xs, ys, holes=floor_holes)
    swapped = [(j, i) for i, j in ceiling_holes]
    cells(scene, "ceiling", "room", material["ceiling"], (0, 0, z), ey, ex, ys, xs, holes=swapped)
    cells(scene, "west", "room", material["west"], (0, 0, 0), ey, ez, ys, zs)
    cells(scene, "east", "room", material["east"], (x, y, 0), back(ey), ez, backwards(ys, y), zs)
    cells(scene, "south", "room", material["south"], (x, 0, 0), back(ex), ez, backwards(xs, x), zs)
    cells(scene, "north", "room", material["north"], (0, y, 0), ex, ez, xs, zs)


def overlapping(solids, gap=1e-9):
    """Pairs of convex solids that reach into each other: no plane along a face or a pair of edges keeps them apart."""
    def parts(faces):
        corners = sorted({p for f in faces for p in f})
        normals = [unit(cross(sub(f[1], f[0]), sub(f[-1], f[0]))) for f in faces]
        edges = [unit(sub(b, a)) for f in faces for a, b in zip(f, f[1:] + f[:1])]
        return corners, normals, edges

    def apart(axis, a, b):
        p, q = [dot(axis, c) for c in a], [dot(axis, c) for c in b]
        return max(p) <= min(q) + gap or max(q) <= min(p) + gap

    known = [(name, *parts(faces)) for name, faces in solids]
    axes = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    found = []
    for k, (name, corners, normals, edges) in enumerate(known):
        for other, its_corners, its_normals, its_edges in known[:k]:
            if any(apart(a, corners, its_corners) for a in axes + normals + its_normals):
                continue
            products = (cross(e, f) for e in edges for f in its_edges)
            if not any(dot(a, a) > 1e-12 and apart(a, corners, its_corners) for a in products):
                found.append((other, name))
    return found

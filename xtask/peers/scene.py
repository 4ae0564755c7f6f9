"""A scene of quadrilaterals in `etalon-scene/1`, read without the library, and written for other programs."""

import pathlib
import re
import tomllib

import numpy as np

BOX = re.compile(r"(box|b\d+)-")


class Scene:
    """`patches` N x 4 x 3; `bodies`: the boxes of the cube scenes, told by their names (`box-west`, `b012-floor`)."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.name = self.path.stem
        data = tomllib.loads(self.path.read_text())
        patches, bodies = [], {}
        for surface in data["surface"]:
            corners = np.array(surface["polygon"], float)
            if len(corners) != 4:
                raise ValueError(f"{self.name}: surface {surface['name']} is no quadrilateral")
            patches += divided(corners, *surface.get("patches", [1, 1]))
            if box := BOX.match(surface["name"]):
                bodies.setdefault(box.group(1), []).append(corners)
        self.patches, self.bodies = np.array(patches), list(bodies.values())

    @property
    def count(self):
        return len(self.patches)

    def frames(self):
        """First corner, two sides, unit normal and area of every patch; patches are parallelograms."""
        first = self.patches[:, 0]
        u, v = self.patches[:, 1] - first, self.patches[:, 3] - first
        cross = np.cross(u, v)
        area = np.linalg.norm(cross, axis=1)
        return first, u, v, cross / area[:, None], area

    def triangles(self):
        """Vertices and faces; faces 2 i and 2 i + 1 are patch i."""
        corner = np.arange(4 * self.count).reshape(-1, 4)
        faces = np.stack([corner[:, [0, 1, 2]], corner[:, [0, 2, 3]]], axis=1)
        return self.patches.reshape(-1, 3), faces.reshape(-1, 3)

    def vs3(self, eps):
        """The input of View3D."""
        lines = [f"T {self.name}", f"C eps={eps:g} encl=0 list=0", "F 3"]
        points = self.patches.reshape(-1, 3)
        lines += [f"V {k + 1} " + " ".join(f"{x:.12g}" for x in p) for k, p in enumerate(points)]
        for i in range(self.count):
            corners = " ".join(str(4 * i + k + 1) for k in range(4))
            lines.append(f"S {i + 1} {corners} 0 0 0.5 p{i}")
        return "\n".join([*lines, "E", ""])

    def exact_text(self, asked):
        """The input of `xtask exact`."""
        row = lambda word, c: word + " " + " ".join(repr(float(x)) for x in np.asarray(c).flat)
        lines = [row("patch", p) for p in self.patches]
        for body in self.bodies:
            lines += ["solid", *(row("face", f) for f in body)]
        return "\n".join([*lines, *asked, ""])


def divided(corners, na, nb):
    def at(u, v):
        return np.array([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v]) @ corners

    ends = ((0, 0), (1, 0), (1, 1), (0, 1))
    return [[at((a + s) / na, (b + t) / nb) for s, t in ends] for b in range(nb) for a in range(na)]

"""The patches that `etalon scene patches SCENE -o patches.csv` writes, and matrices in the form that etalon reads."""

import csv
import tomllib

import numpy as np


class Patches:
    """Patches in order of their numbers. Rows of absent patches (covered wholly) have area 0."""

    def __init__(self, file):
        rows = list(csv.DictReader(open(file)))
        self.count = 1 + max(int(r["patch"]) for r in rows)
        self.area = np.zeros(self.count)
        self.normal = np.zeros((self.count, 3))
        self.material = [""] * self.count
        self.corners = [np.zeros((0, 3))] * self.count
        for r in rows:
            i = int(r["patch"])
            self.area[i] = float(r["area"])
            self.normal[i] = [float(r[f"normal_{x}"]) for x in "xyz"]
            self.material[i] = r["material"]
            self.corners[i] = np.array([[float(x) for x in c.split()] for c in r["corners"].split(";")])
        self.present = np.flatnonzero(self.area > 0)

    def whole_area(self, i):
        """Area of the polygon, whatever stands on it."""
        c = self.corners[i]
        return 0.5 * np.linalg.norm(sum(np.cross(a - c[0], b - c[0]) for a, b in zip(c[1:], c[2:])))

    def triangles(self):
        """Vertices, faces, and the patch of each face: fans."""
        vertices, faces, owner = [], [], []
        for i in self.present:
            first = len(vertices)
            vertices.extend(self.corners[i])
            for k in range(1, len(self.corners[i]) - 1):
                faces.append([first, first + k, first + k + 1])
                owner.append(i)
        return np.array(vertices), np.array(faces), np.array(owner)

    def points(self, i, count, draw):
        """Uniform points on the polygon of a patch, those left out that something in contact covers."""
        c, found = self.corners[i], np.zeros((0, 3))
        fans = [(c[0], c[k], c[k + 1]) for k in range(1, len(c) - 1)]
        sizes = np.array([np.linalg.norm(np.cross(b - a, d - a)) for a, b, d in fans])
        while len(found) < count:
            a, b, d = (np.array([f[k] for f in fans]) for k in range(3))
            pick = draw.choice(len(fans), count, p=sizes / sizes.sum())
            s, t = np.sqrt(draw.random((count, 1))), draw.random((count, 1))
            new = a[pick] * (1 - s) + b[pick] * s * (1 - t) + d[pick] * s * t
            found = np.vstack([found, new[~self.covered(i, new)]])
        return found[:count]

    def covered(self, i, points):
        """Which points of patch i lie on something that faces it at no distance."""
        out = np.zeros(len(points), bool)
        if self.whole_area(i) - self.area[i] < 1e-9 * self.area[i]:
            return out
        for c in self.contact(self.normal[i], self.corners[i][0]):
            inside = np.ones(len(points), bool)
            for a, b in zip(c, np.roll(c, -1, axis=0)):
                inside &= np.cross(b - a, points - a) @ -self.normal[i] >= 0
            out |= inside
        return out

    def contact(self, normal, origin):
        for c in (c for c in self.corners if len(c)):
            n = np.cross(c[1] - c[0], c[2] - c[0])
            if n @ normal < -0.999999 * np.linalg.norm(n) and abs((c[0] - origin) @ normal) < 1e-6:
                yield c


class Materials:
    """Reflectance and self-emitted radiosity (W/m2) by patch and band, from the scene file."""

    def __init__(self, scene, patches):
        given = tomllib.load(open(scene, "rb"))
        bands = given.get("photometry", {}).get("bands", ["r", "g", "b"])
        table = {m["name"]: m for m in given["material"]}
        spread = lambda x: np.broadcast_to(np.asarray(x, float), len(bands))
        of = lambda key: np.array([spread(table[m].get(key, 0.0)) if m else spread(0.0) for m in patches.material])
        self.bands, self.reflectance, self.emission = bands, of("reflectance"), of("emission")


def save_matrix(file, matrix):
    """As `scipy.sparse.save_npz` does, which etalon reads."""
    from scipy.sparse import csr_matrix, save_npz

    save_npz(file, csr_matrix(matrix))


def save_solution(file, patches, bands, radiosity, std_err=None):
    with open(file, "w") as out:
        names = list(bands) + ([f"{b}_std_err" for b in bands] if std_err is not None else [])
        print(",".join(["patch", *names]), file=out)
        for i in patches.present:
            values = list(radiosity[i]) + (list(std_err[i]) if std_err is not None else [])
            print(",".join([str(i), *(f"{v:.7g}" for v in values)]), file=out)

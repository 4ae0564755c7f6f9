#!/usr/bin/env python3
"""Hemi-cube form factors by one ray per pixel: an independent maker of matrices to be fingerprinted.

    python3 third_party.py SCENE.toml OUT.npz --resolution 50 [--rule midpoint|exact|normalised] [--mistake NAME]
                           [--axes world|diagonal|random] [--single]

Shares no code with the project it tests, and no way of working where that matters: rays in place of projection,
clipping, scan conversion and depth buffer; axes and ties of its own. What it cannot differ in are the formulas of the
deltas, which are those published in 1985, and their antiderivatives; and it was written by people who knew the program
under test. Reads polygons of four corners with their `patches` from a scene file; needs numpy and scipy. `all` in
place of OUT writes the stored set.
"""
import argparse
import tomllib

import numpy as np
from scipy.sparse import csr_matrix, save_npz

MISTAKES = ["none", "missing-side", "missing-top", "side-without-z", "exponent-one", "half-pixel", "no-pi",
            "pixel-corner", "top-table-on-sides", "sides-upside-down"]


def patches_of(scene):
    """Corners of all patches, (patches, 4, 3), counter-clockwise seen from the radiating side."""
    out = []
    for s in scene["surface"]:
        v = np.array(s["polygon"], float)
        na, nb = s.get("patches", [1, 1])
        at = lambda s, t: (1 - s) * (1 - t) * v[0] + s * (1 - t) * v[1] + s * t * v[2] + (1 - s) * t * v[3]
        for b in range(nb):
            for a in range(na):
                out.append([at(x / na, y / nb) for x, y in [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)]])
    return np.array(out)


def integral(edges_a, edges_b, corner):
    """Exact integrals over the pixels between the edges, from the antiderivative at their corners."""
    g = corner(edges_a[:, None], edges_b[None, :])
    return g[1:, 1:] - g[:-1, 1:] - g[1:, :-1] + g[:-1, :-1]


def tables(n, rule, mistake):
    """Delta form factors: top (n, n) over (x, y), side (n, n/2) over (y, z)."""
    h = 2 / n
    shift = 0 if mistake == "pixel-corner" else 0.5
    x, z = -1 + (np.arange(n) + shift) * h, (np.arange(n // 2) + shift) * h
    power = 1 if mistake == "exponent-one" else 2
    area = (1 / n) ** 2 if mistake == "half-pixel" else h * h
    pi = 1.0 if mistake == "no-pi" else np.pi
    top = area / (pi * (x[:, None] ** 2 + x[None, :] ** 2 + 1) ** power)
    weight = 1.0 if mistake == "side-without-z" else z[None, :]
    side = weight * area / (pi * (x[:, None] ** 2 + z[None, :] ** 2 + 1) ** power)
    if rule == "exact":
        ex, ez = -1 + np.arange(n + 1) * h, np.arange(n // 2 + 1) * h
        w = lambda t: np.sqrt(1 + t * t)
        top = integral(ex, ex, lambda a, b: (a / w(a) * np.arctan(b / w(a)) + b / w(b) * np.arctan(a / w(b))) / (2 * np.pi))
        side = integral(ex, ez, lambda y, c: -np.arctan(y / w(c)) / w(c) / (2 * np.pi))
    if mistake == "top-table-on-sides":
        side = top[:, : n // 2]
    if mistake == "sides-upside-down":
        side = side[:, ::-1]
    sides = [0.0 if mistake == "missing-side" and k == 2 else 1.0 for k in range(4)]
    top = top * (0.0 if mistake == "missing-top" else 1.0)
    scale = 1 / (top.sum() + sum(sides) * side.sum()) if rule == "normalised" else 1.0
    return top * scale, [side * k * scale for k in sides]


def frame(normal, axes, rng):
    """Two directions across the normal: from the world axis least along it, turned by 45 degrees or by chance."""
    least = np.eye(3)[np.argmin(np.abs(normal))]
    u = np.cross(least, normal)
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    if axes != "world":
        t = np.pi / 4 if axes == "diagonal" else rng.uniform(0, 2 * np.pi)
        u, v = np.cos(t) * u + np.sin(t) * v, np.cos(t) * v - np.sin(t) * u
    return u, v


def nearest(eye, rays, patches, normals):
    """Number of the patch each ray meets first, -1 for none or a back."""
    best, who = np.full(len(rays), np.inf), np.full(len(rays), -1)
    for j, (p, n) in enumerate(zip(patches, normals)):
        towards = rays @ n
        with np.errstate(divide="ignore", invalid="ignore"):
            t = ((p[0] - eye) @ n) / towards
            hit = eye + t[:, None] * rays
            inside = (t > 1e-9) & (t < best)
            for k in range(4):
                edge = p[(k + 1) % 4] - p[k]
                inside &= (hit - p[k]) @ np.cross(n, edge) >= 0
        best[inside] = t[inside]
        who[inside] = np.where(towards[inside] < 0, j, -1)
    return who


def matrix(patches, n, rule="midpoint", mistake="none", axes="world", seed=1):
    rng = np.random.default_rng(seed)
    normals = np.cross(patches[:, 1] - patches[:, 0], patches[:, 3] - patches[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    top, sides = tables(n, rule, mistake)
    x, z = -1 + (np.arange(n) + 0.5) * 2 / n, (np.arange(n // 2) + 0.5) * 2 / n
    f = np.zeros((len(patches), len(patches)))
    for i, (p, normal) in enumerate(zip(patches, normals)):
        u, v = frame(normal, axes, rng)
        faces = [(x[:, None, None] * u + x[None, :, None] * v + normal, top)]
        for k, (out, along) in enumerate([(u, v), (v, -u), (-u, -v), (-v, u)]):
            faces.append((out + x[:, None, None] * along + z[None, :, None] * normal, sides[k]))
        for rays, delta in faces:
            who = nearest(p.mean(axis=0), rays.reshape(-1, 3), patches, normals)
            f[i] += np.bincount(who[who >= 0], delta.ravel()[who >= 0], len(patches))
    return f


STORED = [(32, "midpoint", "none", "world"), (50, "midpoint", "none", "world"), (100, "midpoint", "none", "world"),
          (128, "midpoint", "none", "world"), (50, "midpoint", "none", "diagonal"), (64, "exact", "none", "world"),
          (64, "exact", "none", "diagonal"), (80, "normalised", "none", "diagonal"), (51, "midpoint", "none", "world"),
          (100, "midpoint", "none", "random"), (48, "exact", "none", "random"),
          (50, "midpoint", "missing-side", "world"), (100, "exact", "missing-side", "diagonal"),
          (64, "midpoint", "missing-top", "world"), (50, "midpoint", "side-without-z", "diagonal"),
          (64, "midpoint", "half-pixel", "world"), (40, "midpoint", "exponent-one", "diagonal"),
          (32, "midpoint", "pixel-corner", "diagonal"), (32, "midpoint", "top-table-on-sides", "world"),
          (50, "midpoint", "sides-upside-down", "world")]

if __name__ == "__main__":
    a = argparse.ArgumentParser()
    a.add_argument("scene")
    a.add_argument("out")
    a.add_argument("--resolution", type=int, default=50)
    a.add_argument("--rule", default="midpoint", choices=["midpoint", "exact", "normalised"])
    a.add_argument("--mistake", default="none", choices=MISTAKES)
    a.add_argument("--axes", default="world", choices=["world", "diagonal", "random"])
    a.add_argument("--single", action="store_true", help="store single-precision values")
    a = a.parse_args()
    with open(a.scene, "rb") as file:
        patches = patches_of(tomllib.load(file))
    made = STORED if a.out == "all" else [(a.resolution, a.rule, a.mistake, a.axes)]
    for n, rule, mistake, axes in made:
        out = f"{n}-{rule}-{mistake}-{axes}.npz" if a.out == "all" else a.out
        f = matrix(patches, n, rule, mistake, axes)
        f = f.astype(np.float32).astype(float) if a.single else f
        save_npz(out, csr_matrix(f))
        print(out, len(patches), "row sums", f.sum(axis=1).min(), f.sum(axis=1).max())

"""Exact form factors: closed forms where nothing is in the way, `xtask exact` where something is.

Independent of the library. The closed forms are those of aligned rectangles, parallel and perpendicular (Howell's
catalogue, C-13 and C-15), as 16 corner terms.
"""

import hashlib
import os
import pathlib
import subprocess

import numpy as np

# Up to this many boxes the whole matrix is computed (minutes); above, the rows below.
MOST_BOXES = 8
SOME_ROWS = 3


def of(scene, xtask, cache):
    """(rows, N x N or fewer): which rows are known, and their values."""
    if not scene.bodies:
        return np.arange(scene.count), closed_forms(scene)
    rows = None if len(scene.bodies) <= MOST_BOXES else np.linspace(0, scene.count - 1, SOME_ROWS).astype(int)
    asked = ["all"] if rows is None else [f"row {i}" for i in rows]
    text = scene.exact_text(asked)
    file = pathlib.Path(cache) / f"{scene.name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}.npz"
    if not file.exists():
        print(f"exact values of {scene.name}: minutes, once", flush=True)
        out = subprocess.run([xtask, "exact"], input=text, capture_output=True, text=True, check=True).stdout
        matrix = np.zeros((scene.count, scene.count))
        for i, j, there, _, back, _ in map(str.split, out.splitlines()):
            matrix[int(i), int(j)], matrix[int(j), int(i)] = float(there), float(back)
        rows = np.arange(scene.count) if rows is None else rows
        part = file.with_suffix(f".part{os.getpid()}.npz")
        np.savez(part, rows=rows, values=matrix[rows])
        part.rename(file)
    stored = np.load(file)
    return stored["rows"], stored["values"]


def closed_forms(scene):
    low, high = scene.patches.min(axis=1), scene.patches.max(axis=1)
    normals, areas = scene.frames()[3:]
    axis = np.abs(normals).argmax(axis=1)
    sign = np.sign(normals[np.arange(scene.count), axis])
    matrix = np.zeros((scene.count, scene.count))
    for a in range(3):
        for b in range(3):
            rows, columns = np.flatnonzero(axis == a), np.flatnonzero(axis == b)
            i, j = [k.ravel() for k in np.meshgrid(rows, columns, indexing="ij")]
            exchange = parallel(low, high, a, i, j) if a == b else perpendicular(low, high, a, b, i, j)
            facing = seen(low, high, axis, sign, i, j) & seen(low, high, axis, sign, j, i)
            matrix[i, j] = np.where(facing, np.abs(exchange), 0.0) / areas[i]
    return matrix


def seen(low, high, axis, sign, i, j):
    """Whether patch j lies before patch i. Patches of these scenes never cross each other's planes."""
    k = np.arange(len(i))
    plane = low[i, axis[i]]
    near, far = low[j][k, axis[i]] - plane, high[j][k, axis[i]] - plane
    return np.where(sign[i] > 0, far, -near) > 1e-12


def corner_signs():
    return [(p, q, (-1) ** (p + q)) for p in (0, 1) for q in (0, 1)]


def parallel(low, high, a, i, j):
    """Area of i times the form factor of two parallel rectangles at the distance z."""
    b, c = [k for k in range(3) if k != a]
    z = np.abs(low[i, a] - low[j, a])
    z = np.where(z > 0, z, np.inf)
    ends = (low, high)
    total = 0.0
    for p, q, s in corner_signs():
        for r, t, w in corner_signs():
            x, y = ends[p][i, b] - ends[q][j, b], ends[r][i, c] - ends[t][j, c]
            total = total + s * w * potential(x, y, z)
    return np.where(np.isfinite(z), total, 0.0) / (2 * np.pi)


def potential(x, y, z):
    """Whose mixed fourth difference is the exchange of parallel rectangles, times 2 pi."""
    with np.errstate(invalid="ignore", divide="ignore"):
        u, v = np.hypot(x, z), np.hypot(y, z)
        g = y * u * np.arctan(y / u) + x * v * np.arctan(x / v) - z * z / 2 * np.log(x * x + y * y + z * z)
    return np.where(np.isfinite(z), g, 0.0)


def perpendicular(low, high, a, b, i, j):
    """Area of i times the form factor of rectangles normal to the axes a and b; c is along their common line.

    In a plane through that line, x is the distance of points of i from the plane of j, and y of j from that of i.
    """
    c = 3 - a - b
    ends = (low, high)
    total = 0.0
    for p, q, s in corner_signs():
        for r, t, w in corner_signs():
            x = ends[p][i, b] - low[j, b]
            y = ends[q][j, a] - low[i, a]
            z = ends[r][i, c] - ends[t][j, c]
            total = total + s * w * across(np.hypot(x, y), z)
    return total / (2 * np.pi)


def across(h, z):
    r2 = h * h + z * z
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = np.where(h > 0, z * h * np.arctan(z / h), 0.0)
        spread = np.where(r2 > 0, (z * z - h * h) / 4 * np.log(r2), 0.0)
    return turn + spread

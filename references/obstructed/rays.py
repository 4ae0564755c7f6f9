"""A check that knows nothing of shadows: segments between random points of two patches, tested against every face."""

import numpy as np

SAMPLES = 200_000


def frame(polygon):
    p = np.asarray(polygon, float)
    normal = sum(np.cross(p[k] - p[0], p[k + 1] - p[0]) for k in range(1, len(p) - 1))
    return p, normal / np.linalg.norm(normal), np.linalg.norm(normal) / 2


def points(polygon, draw, count):
    """Uniform points: a triangle of the fan by area, then a point of it."""
    p, _, _ = frame(polygon)
    fan = [(p[0], p[k], p[k + 1]) for k in range(1, len(p) - 1)]
    areas = np.array([np.linalg.norm(np.cross(b - a, c - a)) for a, b, c in fan])
    which = draw.choice(len(fan), count, p=areas / areas.sum())
    u, v = np.sqrt(draw.random(count)), draw.random(count)
    a, b, c = [np.array([t[k] for t in fan])[which] for k in range(3)]
    return a + u[:, None] * ((b - a) + v[:, None] * (c - b))


def hidden(x, y, bodies):
    d = y - x
    blocked = np.zeros(len(x), bool)
    for face in (f for body in bodies for f in body):
        p, n, _ = frame(face)
        slope = d @ n
        with np.errstate(divide="ignore", invalid="ignore"):
            t = ((p[0] - x) @ n) / slope
        at = x + np.where(np.isfinite(t), t, -1.0)[:, None] * d
        inside = (t > 1e-9) & (t < 1 - 1e-9)
        for k in range(len(p)):
            a, b = p[k], p[(k + 1) % len(p)]
            inside &= (at - a) @ np.cross(n, b - a) >= 0
        blocked |= inside
    return blocked


def by_rays(first, second, bodies, expected):
    """The form factor of `first` to `second` with its standard error, and how far the expected value is off."""
    draw = np.random.default_rng(20261122)
    (_, n1, _), (_, n2, area2) = frame(first), frame(second)
    x, y = points(first, draw, SAMPLES), points(second, draw, SAMPLES)
    d = y - x
    r2 = np.einsum("ij,ij->i", d, d)
    cosines = np.maximum(d @ n1, 0) * np.maximum(-(d @ n2), 0)
    kernel = area2 * cosines / (np.pi * r2 * r2) * ~hidden(x, y, bodies)
    mean, error = kernel.mean(), kernel.std(ddof=1) / np.sqrt(SAMPLES)
    z = (mean - expected) / error if error > 0 else 0.0
    return {"estimate": float(f"{mean:.6e}"), "std_error": float(f"{error:.2e}"), "z": round(float(z), 2), "samples": SAMPLES}

"""Form factors by Embree through Python, as one writes it by hand: PATCHES.csv OUT.npz [RAYS]"""

import sys

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from patches import Patches, save_matrix


def directions(normal, count, draw):
    """Cosine-weighted about a normal."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    u = np.cross(normal, helper) / np.linalg.norm(np.cross(normal, helper))
    r, turn = np.sqrt(draw.random((count, 1))), 2 * np.pi * draw.random((count, 1))
    return r * np.cos(turn) * u + r * np.sin(turn) * np.cross(normal, u) + np.sqrt(1 - r * r) * normal


def main(patches, out, rays=10_000):
    p, rays, draw = Patches(patches), int(rays), np.random.default_rng(1)
    vertices, faces, owner = p.triangles()
    scene = EmbreeScene(robust=True)
    TriangleMesh(scene, vertices[faces].astype(np.float32))
    matrix = np.zeros((p.count, p.count))
    for i in p.present:
        start = p.points(i, rays, draw) + 1e-5 * p.normal[i]
        hit = np.asarray(scene.run(start.astype(np.float32), directions(p.normal[i], rays, draw).astype(np.float32)))
        matrix[i] = np.bincount(owner[hit[hit >= 0]], minlength=p.count) / rays
    save_matrix(out, matrix)
    # Independent rays: the binomial error.
    save_matrix(out.replace(".npz", "-std-err.npz"), np.sqrt(matrix * (1 - matrix) / rays))


main(*sys.argv[1:])

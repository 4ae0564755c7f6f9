"""Form factors by Mitsuba's own sampling and ray casting: PATCHES.csv OUT.npz [RAYS]"""

import sys

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
from patches import Patches, save_matrix  # noqa: E402


def main(patches, out, rays=10_000):
    p, rays = Patches(patches), int(rays)
    vertices, faces, owner = p.triangles()
    mesh = mi.Mesh("patches", len(vertices), len(faces))
    given = mi.traverse(mesh)
    given["vertex_positions"], given["faces"] = vertices.ravel().astype(np.float32), faces.ravel().astype(np.uint32)
    given.update()
    room = mi.load_dict({"type": "scene", "patches": mesh})
    matrix, draw = np.zeros((p.count, p.count)), np.random.default_rng(1)
    for i in p.present:
        start = mi.Point3f(np.ascontiguousarray((p.points(i, rays, draw) + 1e-5 * p.normal[i]).T, np.float32))
        # PCG32 with neighbouring states for neighbouring rays is correlated: errors come out larger than binomial.
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(int(i), rays)
        disc = sampler.next_2d()
        way = mi.Frame3f(mi.Vector3f(*map(float, p.normal[i]))).to_world(mi.warp.square_to_cosine_hemisphere(disc))
        found = room.ray_intersect_preliminary(mi.Ray3f(start, way), coherent=False)
        hit = np.array(found.prim_index)[np.array(found.is_valid())]
        matrix[i] = np.bincount(owner[hit], minlength=p.count) / rays
    save_matrix(out, matrix)
    save_matrix(out.replace(".npz", "-std-err.npz"), np.sqrt(matrix * (1 - matrix) / rays))


main(*sys.argv[1:])

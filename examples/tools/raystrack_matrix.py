"""Form factors by raystrack, with the standard errors it states: PATCHES.csv OUT.npz [RAYS]"""

import sys

import numpy as np
import raystrack as r

from patches import Patches, save_matrix


def main(patches, out, rays=10_000):
    p, rays = Patches(patches), int(rays)
    fan = lambda c: np.array([[0, k, k + 1] for k in range(1, len(c) - 1)], np.int32)
    names = [f"p{i}" for i in range(p.count)]
    meshes = {n: r.Mesh(c.astype(np.float32), fan(c)) for n, c in zip(names, p.corners)}
    # With receiver_sides=("front",) a row counts what hits fronts; backs are opaque.
    query = r.Query.matrix(receiver_sides=("front",))
    sampling = r.Sampling(density=1, rays_per_cell=rays // 20, seed=1)
    accuracy = r.Accuracy(max_replicates=20, min_replicates=20, tolerance=1e-12)
    options = r.SolveOptions(sampling=sampling, accuracy=accuracy)
    with r.Solver(r.Scene.from_meshes(meshes), device="cpu") as solver:
        result = solver.solve(query, options, r.Budget(rays=2 * rays * p.count))
    rows = [names.index(n) for n in result.sender_ids]
    columns = [names.index(c.surface_id) if (c.kind, c.side) == ("surface", "front") else -1 for c in result.channels]
    matrix, errors, data = np.zeros((p.count, p.count)), np.zeros((p.count, p.count)), result.data
    for i, j, value, error in zip(data.row_indices, data.channel_indices, data.estimates, data.errors):
        if columns[j] >= 0 and value > 0:
            matrix[rows[i], columns[j]], errors[rows[i], columns[j]] = value, error
    print(f"{np.isnan(errors).sum()} of {(matrix > 0).sum()} entries have no error")
    save_matrix(out, matrix)
    save_matrix(out.replace(".npz", "-std-err.npz"), errors)


main(*sys.argv[1:])

"""Whatever computes a form-factor matrix: each tool says why it cannot run, or gives settings to run it with.

A setting is a name and a function of no arguments that returns (seconds, matrix); what is prepared once per scene
(files, meshes, compilation by a first call) is not timed, what has to be done for every matrix is.
"""

import importlib
import io
import json
import pathlib
import shutil
import subprocess
import time

import numpy as np

# Raw ray tools below this many rays a patch say little, above they take minutes.
RAYS = (10_000, 100_000)


class Missing(Exception):
    """Why a tool is not there."""


def needed(module):
    try:
        return importlib.import_module(module)
    except Exception as e:  # A package that is there and fails to load is missing as well.
        raise Missing(f"{type(e).__name__}: {e}".splitlines()[0]) from None


def timed(command, **more):
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, **more)
    seconds = time.perf_counter() - start
    if done.returncode != 0:
        raise RuntimeError((done.stderr or done.stdout).strip().splitlines()[-1:] or ["no message"])
    return seconds, done


def etalon(scene, options, folder):
    """The whole process, from reading the scene to the written matrix."""
    program = options.etalon

    def setting(arguments):
        def run():
            file = pathlib.Path(folder) / "etalon.npz"
            seconds, done = timed([program, "form-factors", str(scene.path), "-o", str(file), "--json", *arguments])
            record = json.loads(done.stdout)
            return seconds, csr(file), {"stated_max_std_err": record.get("max_std_err")}

        return run

    for rays in (1 << 12, 1 << 14, 1 << 17):
        yield f"rays, {rays} a patch", setting(["--estimator", "rays", "--rays", str(rays)])
    yield "auto", setting(["--estimator", "auto"])
    for target in ("1e-4", "1e-6"):
        limit = ["--max-time", f"{options.max_time:g}s"]
        yield f"auto, target error {target}", setting(["--estimator", "auto", "--target-error", target, *limit])


def csr(file):
    """A matrix as `scipy.sparse.save_npz` writes it, without scipy."""
    stored = np.load(file)
    n, m = stored["shape"]
    matrix = np.zeros((n, m))
    rows = np.repeat(np.arange(n), np.diff(stored["indptr"]))
    matrix[rows, stored["indices"]] = stored["data"]
    return matrix


def view3d(scene, options, folder):
    program = options.view3d or shutil.which("view3d") or shutil.which("View3D")
    if not program:
        raise Missing("no executable view3d on the PATH")

    def setting(eps):
        given, result = [pathlib.Path(folder) / name for name in (f"{eps:g}.vs3", f"{eps:g}.out")]
        given.write_text(scene.vs3(eps))

        def run():
            seconds, _ = timed([program, str(given), str(result)])
            return seconds, view3d_output(result, scene.count), {}

        return run

    for eps in (1e-4, 1e-6):
        yield f"eps {eps:g}", setting(eps)


def view3d_output(file, n):
    """A title line, the areas, N x N factors, emittances."""
    _, rest = file.read_text().split("\n", 1)
    numbers = np.loadtxt(io.StringIO(" ".join(rest.split())), ndmin=1)
    return numbers[n : n + n * n].reshape(n, n)


def pyviewfactor(scene, options, folder):
    module, pyvista = needed("pyviewfactor"), needed("pyvista")
    faces = np.hstack([np.full((scene.count, 1), 4), np.arange(4 * scene.count).reshape(-1, 4)])
    mesh = pyvista.PolyData(scene.patches.reshape(-1, 3), faces.ravel())
    obstacles = [mesh] if scene.bodies else None

    def run():
        start = time.perf_counter()
        matrix = module.compute_viewfactor_matrix(mesh, obstacles=obstacles, skip_obstruction=not scene.bodies)
        seconds = time.perf_counter() - start
        return seconds, np.asarray(matrix).T, {}  # F[i, j] of this package is from j to i.

    yield "as it comes", warm(run)


def warm(run):
    """Compiles before the clock runs: the first call is thrown away."""
    called = []

    def after_first():
        if not called:
            called.append(run())
        return run()

    return after_first


def raystrack(scene, options, folder):
    r = needed("raystrack")
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    names = [f"p{i}" for i in range(scene.count)]
    meshes = {name: r.Mesh(p.astype(np.float32), faces) for name, p in zip(names, scene.patches)}
    rays = RAYS[0]

    def run():
        model = r.Scene.from_meshes(meshes)
        sampling = r.Sampling(density=1, rays_per_cell=rays // 20, seed=1)
        accuracy = r.Accuracy(max_replicates=20, min_replicates=20, tolerance=1e-12)
        choice = r.SolveOptions(sampling=sampling, accuracy=accuracy)
        with r.Solver(model, device="cpu") as solver:
            start = time.perf_counter()
            result = solver.solve(r.Query.matrix(receiver_sides=("front",)), choice, r.Budget(rays=rays * scene.count))
            matrix = raystrack_matrix(r, result, names)
            seconds = time.perf_counter() - start
        return seconds, matrix, {"rays_used": int(result.cumulative_rays or 0)}

    yield f"about {rays} a patch", run


def raystrack_matrix(r, result, names):
    dense = np.asarray(result.dense())
    columns = {(c.surface_id, c.side): k for k, c in enumerate(result.channels)}
    rows = {name: k for k, name in enumerate(result.sender_ids)}
    order = [columns.get((n, "front")) for n in names]
    picked = np.array([[dense[rows[i], k] if k is not None else 0.0 for k in order] for i in names])
    return np.nan_to_num(picked)


def cosine_rays(scene, first, last, rays, draw):
    """Origins and directions of cosine-weighted rays from the patches first..last."""
    origin, u, v, normal, _ = scene.frames()
    which = np.repeat(np.arange(first, last), rays)
    s, t = draw.random((2, len(which), 1))
    radius, turn = np.sqrt(draw.random(len(which))), 2 * np.pi * draw.random(len(which))
    along = (u / np.linalg.norm(u, axis=1)[:, None])[which]
    across = np.cross(normal[which], along)
    up = np.sqrt(1 - radius**2)[:, None] * normal[which]
    directions = (radius * np.cos(turn))[:, None] * along + (radius * np.sin(turn))[:, None] * across + up
    start = origin[which] + s * u[which] + t * v[which] + 1e-5 * normal[which]
    return start.astype(np.float32), directions.astype(np.float32)


def embreex(scene, options, folder):
    needed("embreex")
    core, mesh = needed("embreex.rtcore_scene"), needed("embreex.mesh_construction")
    vertices, faces = scene.triangles()

    def setting(rays):
        def run():
            start = time.perf_counter()
            target = core.EmbreeScene(robust=True)
            mesh.TriangleMesh(target, vertices[faces].astype(np.float32))
            matrix, draw = np.zeros((scene.count, scene.count)), np.random.default_rng(1)
            at_once = max(1, 1_000_000 // rays)
            for first in range(0, scene.count, at_once):
                last = min(first + at_once, scene.count)
                hit = np.asarray(target.run(*cosine_rays(scene, first, last, rays, draw))).reshape(-1, rays)
                for i, row in enumerate(hit, start=first):
                    matrix[i] = np.bincount(row[row >= 0] // 2, minlength=scene.count) / rays
            return time.perf_counter() - start, matrix, {}

        return run

    for rays in RAYS[:1] if options.quick else RAYS:
        yield f"{rays} a patch", setting(rays)


def mitsuba(scene, options, folder):
    mi, dr = needed("mitsuba"), needed("drjit")
    try:
        mi.set_variant("llvm_ad_rgb")
        dr.eval(mi.Float([1.0]) + 1)
    except Exception as e:
        raise Missing(f"no usable LLVM ({str(e).splitlines()[0]}); DRJIT_LIBLLVM_PATH names one") from None
    vertices, faces = scene.triangles()

    def setting(rays):
        def run():
            start = time.perf_counter()
            matrix = mitsuba_matrix(mi, dr, scene, vertices, faces, rays)
            return time.perf_counter() - start, matrix, {}

        return warm(run)

    for rays in RAYS[:1] if options.quick else RAYS:
        yield f"{rays} a patch", setting(rays)


def mitsuba_matrix(mi, dr, scene, vertices, faces, rays):
    mesh = mi.Mesh("patches", len(vertices), len(faces))
    given = mi.traverse(mesh)
    given["vertex_positions"], given["faces"] = vertices.ravel().astype(np.float32), faces.ravel().astype(np.uint32)
    given.update()
    room = mi.load_dict({"type": "scene", "patches": mesh})
    origin, u, v, normal, _ = [mi.TensorXf(np.ascontiguousarray(x, np.float32)).array for x in scene.frames()]
    pick = lambda table, i: mi.Vector3f(*[dr.gather(mi.Float, table, 3 * i + k) for k in range(3)])
    counts, at_once, n = dr.zeros(mi.UInt32, scene.count**2), max(1, 8_000_000 // rays), scene.count
    for turn, first in enumerate(range(0, n, at_once)):
        size = (min(first + at_once, n) - first) * rays
        index = dr.arange(mi.UInt32, size)
        i = index // rays + first
        sampler = mi.PCG32(size=size, initstate=index + 7919 * turn)
        s, t, a, b = [sampler.next_float32() for _ in range(4)]
        n_i = pick(normal, i)
        start = mi.Point3f(pick(origin, i) + s * pick(u, i) + t * pick(v, i) + 1e-5 * n_i)
        direction = mi.Frame3f(n_i).to_world(mi.warp.square_to_cosine_hemisphere(mi.Point2f(a, b)))
        found = room.ray_intersect_preliminary(mi.Ray3f(start, direction), coherent=False)
        dr.scatter_reduce(dr.ReduceOp.Add, counts, mi.UInt32(1), i * n + found.prim_index // 2, found.is_valid())
        dr.eval(counts)
    return np.array(counts, float).reshape(n, n) / rays


ALL = {
    "etalon": etalon,
    "View3D": view3d,
    "pyviewfactor": pyviewfactor,
    "raystrack": raystrack,
    "Mitsuba": mitsuba,
    "embreex + numpy": embreex,
}

"""Radiosity by Radiance's ambient calculation, rtrace of pyradiance: SCENE.toml PATCHES.csv OUT.csv [POINTS] [DIVISIONS]

The mean irradiance of random points of each patch; no interpolation between them (-aa 0).
"""

import os
import subprocess
import sys
import tempfile

import numpy as np
import pyradiance

from patches import Materials, Patches, save_solution


def room(p, m, out):
    for i in p.present:
        rgb = lambda v: " ".join(f"{x:.9g}" for x in v)
        if m.emission[i].any():
            # A light of Radiance reflects nothing, whatever the scene says.
            print(f"void light m{i} 0 0 3 {rgb(m.emission[i] / np.pi)}", file=out)
        else:
            print(f"void plastic m{i} 0 0 5 {rgb(m.reflectance[i])} 0 0", file=out)
        print(f"m{i} polygon p{i} 0 0 {3 * len(p.corners[i])} {rgb(p.corners[i].ravel())}", file=out)


def main(scene, patches, out, points=32, divisions=64):
    p, points, draw = Patches(patches), int(points), np.random.default_rng(1)
    m = Materials(scene, p)
    tool = lambda name, *a: [os.path.join(pyradiance.BINPATH, name), *a]
    env = dict(os.environ, RAYPATH=os.path.join(os.path.dirname(pyradiance.BINPATH), "lib"))
    with tempfile.TemporaryDirectory() as folder:
        rad, oct_file = os.path.join(folder, "room.rad"), os.path.join(folder, "room.oct")
        with open(rad, "w") as f:
            room(p, m, f)
        with open(oct_file, "wb") as f:
            subprocess.run(tool("oconv", rad), stdout=f, check=True, env=env)
        height = 1e-5
        rows = [(*(q + height * p.normal[i]), *p.normal[i]) for i in p.present for q in p.points(i, points, draw)]
        given = "\n".join(" ".join(f"{x:.9g}" for x in row) for row in rows) + "\n"
        # Direct light by subdividing sources finely (-ds), the rest by paths that branch at the first bounce.
        options = f"-h -I -ab 8 -aa 0 -ad {divisions} -as 0 -ds .02 -dj 1 -dt 0 -dc 1 -lr 12 -lw 1e-6 -u+".split()
        command = tool("rtrace", *options, oct_file)
        done = subprocess.run(command, input=given, capture_output=True, text=True, env=env)
        if done.returncode:
            sys.exit(done.stderr)
    values = np.array(done.stdout.split(), float).reshape(len(p.present), points, 3)
    mean, error = np.zeros((2, p.count, 3))
    mean[p.present], error[p.present] = values.mean(axis=1), values.std(axis=1, ddof=1) / np.sqrt(points)
    save_solution(out.replace(".csv", "-irradiance.csv"), p, m.bands, mean, error)
    save_solution(out, p, m.bands, m.emission + m.reflectance * mean, m.reflectance * error)


main(*sys.argv[1:])

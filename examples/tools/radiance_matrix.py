"""Form factors by Radiance's ambient calculation, rcontrib of pyradiance: PATCHES.csv OUT.npz [POINTS] [DIVISIONS]

Every patch is a glow of its own. `rcontrib -I+ -ab 1` gives the irradiance that each glow brings a point: pi F.
"""

import os
import subprocess
import sys
import tempfile

import numpy as np
import pyradiance

from patches import Patches, save_matrix


def main(patches, out, points=40, divisions=256):
    p, points, divisions, draw = Patches(patches), int(points), int(divisions), np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: os.path.join(folder, name)
        with open(at("room.rad"), "w") as f:
            for i in p.present:
                print(f"void glow m{i} 0 0 4 1 1 1 0", file=f)
                corners = " ".join(f"{x:.9g}" for x in p.corners[i].ravel())
                print(f"m{i} polygon p{i} 0 0 {3 * len(p.corners[i])} {corners}", file=f)
        with open(at("mods"), "w") as f:
            print("\n".join(f"m{i}" for i in p.present), file=f)
        run = lambda name, *a: [os.path.join(pyradiance.BINPATH, name), *a]
        env = dict(os.environ, RAYPATH=os.path.join(os.path.dirname(pyradiance.BINPATH), "lib"))
        with open(at("room.oct"), "wb") as f:
            subprocess.run(run("oconv", at("room.rad")), stdout=f, check=True, env=env)
        # Points a hair above their patch, one record each.
        lines = [
            " ".join(f"{x:.9g}" for x in (*(q + 1e-4 * p.normal[i]), *p.normal[i]))
            for i in p.present
            for q in p.points(i, points, draw)
        ]
        options = f"-h -I+ -ab 1 -ad {divisions} -as 0 -lw 1e-9 -V+".split()
        command = run("rcontrib", *options, "-M", at("mods"), at("room.oct"))
        given = "\n".join(lines) + "\n"
        done = subprocess.run(command, input=given, capture_output=True, text=True, env=env)
        if done.returncode:
            sys.exit(done.stderr)
    # Red of each modifier; 1/pi of an irradiance is a form factor.
    values = np.array(done.stdout.split(), float).reshape(len(p.present), points, len(p.present), 3)[..., 0] / np.pi
    matrix, errors = np.zeros((2, p.count, p.count))
    cells = np.ix_(p.present, p.present)
    matrix[cells] = values.mean(axis=1)
    errors[cells] = values.std(axis=1, ddof=1) / np.sqrt(points)
    save_matrix(out, matrix)
    save_matrix(out.replace(".npz", "-std-err.npz"), errors)


main(*sys.argv[1:])

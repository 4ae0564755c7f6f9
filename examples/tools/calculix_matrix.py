"""View factors of CalculiX, a finite-element program (`ccx`, Debian's calculix-ccx): PATCHES.csv OUT.npz

Behind every patch stands a thin brick whose inner face radiates into one cavity; `*VIEWFACTOR, WRITE` keeps the factors.
Patches have to be quadrilaterals.
"""

import os
import subprocess
import sys
import tempfile

import numpy as np

from patches import Patches, save_matrix

THICK = 1e-3


def deck(p):
    lines = ["*NODE"]
    for k, i in enumerate(p.present):
        front = p.corners[i][::-1]  # Counter-clockwise seen from inside the brick.
        for m, c in enumerate([*front, *(front - THICK * p.normal[i])]):
            lines.append(f"{8 * k + m + 1}," + ",".join(f"{x:.12g}" for x in c))
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    for k in range(len(p.present)):
        lines.append(",".join(str(x) for x in [k + 1, *range(8 * k + 1, 8 * k + 9)]))
    lines += ["*MATERIAL, NAME=M", "*CONDUCTIVITY", "1.", "*SOLID SECTION, ELSET=ALL, MATERIAL=M"]
    lines += ["*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0., STEFAN BOLTZMANN=5.669E-8"]
    lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE"] + [f"{n},300." for n in range(1, 8 * len(p.present) + 1)]
    lines += ["*STEP", "*HEAT TRANSFER, STEADY STATE", "*BOUNDARY"]
    lines += [f"{8 * k + m},11,11,300." for k in range(len(p.present)) for m in range(1, 9)]
    lines += ["*VIEWFACTOR, WRITE", "*RADIATE"]
    lines += [f"{k + 1},R1CR,300.,1." for k in range(len(p.present))]
    return "\n".join([*lines, "*END STEP"]) + "\n"


def records(file):
    """The records of a Fortran file: length, bytes, length."""
    data, at = open(file, "rb").read(), 0
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        yield data[at + 4 : at + 4 + size]
        at += size + 8


def main(patches, out):
    p = Patches(patches)
    with tempfile.TemporaryDirectory() as folder:
        open(os.path.join(folder, "room.inp"), "w").write(deck(p))
        done = subprocess.run(["ccx", "-i", "room"], cwd=folder, capture_output=True, text=True)
        if "Writing the viewfactors" not in done.stdout:
            sys.exit(done.stdout)
        # Version, diagonal, then below the diagonal by columns and above it by rows.
        version, diagonal, rest, _ = records(os.path.join(folder, "room.vwf"))
    n, rest = len(p.present), np.frombuffer(rest)
    below = [(i, j) for j in range(n) for i in range(j + 1, n)]
    small = np.diag(np.frombuffer(diagonal)[:n])
    for (i, j), lower, upper in zip(below, rest[: len(below)], rest[len(below) :]):
        small[i, j], small[j, i] = lower, upper
    matrix = np.zeros((p.count, p.count))
    matrix[np.ix_(p.present, p.present)] = small
    save_matrix(out, matrix)
    print(version.decode().strip())


main(*sys.argv[1:])

"""Form factors out of View3D output with reflections (emit=1, Hottel's script-F): SCRIPT-F.txt OUT.txt

Script-F is G = e (I - F r)^-1 F e with e the emittances and r = 1 - e, so with K = G / (e e): F = K (I + r K)^-1.
"""

import sys

import numpy as np


def main(given, out):
    first, *rest = open(given).read().split("\n", 1)
    numbers = np.array(rest[0].split(), float)
    n = int(first.split()[-1])
    areas, script, emittance = numbers[:n], numbers[n : n + n * n].reshape(n, n), numbers[n + n * n :][:n]
    k = script / emittance[:, None] / emittance[None, :]
    plain = k @ np.linalg.inv(np.eye(n) + (1 - emittance)[:, None] * k)
    with open(out, "w") as f:
        words = first.split()
        words[4] = "0"
        print(" ".join(words).ljust(30), file=f)
        for row in (areas, *plain, emittance):
            print(" ".join(f"{x:.9g}" for x in row), file=f)


main(*sys.argv[1:])

"""Form factors by pyviewfactor (contour integrals; hidden or not by one ray between centres): PATCHES.csv OUT.npz

With --as-it-comes the matrix is written as the package returns it: transposed. --open leaves obstruction out.
"""

import sys

import numpy as np
import pyvista
from pyviewfactor import compute_viewfactor_matrix

from patches import Patches, save_matrix


def main(patches, out, *flags):
    p = Patches(patches)
    faces, vertices = [], []
    for corners in p.corners:
        faces += [len(corners), *range(len(vertices), len(vertices) + len(corners))]
        vertices.extend(corners)
    mesh = pyvista.PolyData(np.array(vertices), np.array(faces))
    alone = "--open" in flags
    matrix = np.asarray(compute_viewfactor_matrix(mesh, obstacles=None if alone else [mesh], skip_obstruction=alone))
    save_matrix(out, matrix if "--as-it-comes" in flags else matrix.T)


main(*sys.argv[1:])

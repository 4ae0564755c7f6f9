"""Radiosity by Mitsuba's path tracer, with an irradiance meter on every patch: SCENE.toml PATCHES.csv OUT.csv [SAMPLES]

OUT.csv holds radiosities B = E + rho H, OUT-irradiance.csv what the meters say (H).
"""

import os
import sys
import tempfile

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
from patches import Materials, Patches, save_solution  # noqa: E402

REPEATS = 8


def ply(file, corners):
    with open(file, "w") as out:
        print(f"ply\nformat ascii 1.0\nelement vertex {len(corners)}", file=out)
        print("property float x\nproperty float y\nproperty float z", file=out)
        print(f"element face {len(corners) - 2}\nproperty list uchar int vertex_indices\nend_header", file=out)
        for c in corners:
            print(*c, file=out)
        for k in range(1, len(corners) - 1):
            print(3, 0, k, k + 1, file=out)


def xml(p, m, folder):
    """The scene file: one mesh a patch, one-sided diffuse, with a meter; lamps radiate E / pi."""
    parts = ['<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="-1"/>',
             '<integer name="rr_depth" value="64"/></integrator>']
    for i in p.present:
        ply(os.path.join(folder, f"{i}.ply"), p.corners[i])
        rgb = lambda v: " ".join(repr(float(x)) for x in v)
        parts.append(f'<shape type="ply"><string name="filename" value="{i}.ply"/>'
                     '<boolean name="face_normals" value="true"/><bsdf type="diffuse">'
                     f'<rgb name="reflectance" value="{rgb(m.reflectance[i])}"/></bsdf>')
        if m.emission[i].any():
            parts.append(f'<emitter type="area"><rgb name="radiance" value="{rgb(m.emission[i] / np.pi)}"/></emitter>')
        parts.append('<sensor type="irradiancemeter"><sampler type="independent"/><film type="hdrfilm">'
                     '<integer name="width" value="1"/><integer name="height" value="1"/><rfilter type="box"/>'
                     '<string name="pixel_format" value="rgb"/><string name="component_format" value="float32"/>'
                     '</film></sensor></shape>')
    return "\n".join(parts) + "</scene>"


def main(scene, patches, out, samples=8192):
    p, samples = Patches(patches), int(samples)
    m = Materials(scene, p)
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "scene.xml")
        open(file, "w").write(xml(p, m, folder))
        room = mi.load_file(file, optimize=False)
        found = np.zeros((REPEATS, p.count, 3))
        for k, i in enumerate(p.present):
            for r in range(REPEATS):
                image = mi.render(room, sensor=k, spp=samples // REPEATS, seed=int(i) * REPEATS + r)
                found[r, i] = np.array(image).ravel()[:3]
            # The meter covers the whole polygon. Where something stands on it light comes from nowhere.
            found[:, i] *= p.whole_area(i) / p.area[i]
    mean, error = found.mean(axis=0), found.std(axis=0, ddof=1) / np.sqrt(REPEATS)
    save_solution(out.replace(".csv", "-irradiance.csv"), p, m.bands, mean, error)
    save_solution(out, p, m.bands, m.emission + m.reflectance * mean, m.reflectance * error)


main(*sys.argv[1:])

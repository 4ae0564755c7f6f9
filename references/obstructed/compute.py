"""Computes the values of this folder: obstructed form factors, each by two programs that share no method.

    cargo build --release --package xtask
    python compute.py --engine ../../target/release/xtask [--boxes PROGRAM] [SCENE ...]

`xtask exact` holds both ways (see README.md). `--boxes` names a further program for axis-aligned boxes, which has to
understand `PROGRAM GEOMETRY run TOLERANCE EVALUATIONS 1` with lines `i j` on its standard input. Needs numpy for the
check by rays.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

from rays import by_rays
from scenes import all_scenes

HERE = pathlib.Path(__file__).parent
AGREEMENT = 1e-10
PAIRS_OF_A_SCENE = 10
SECOND_WAY_REACHES = 1.01e-11


def line(word, corners):
    return word + " " + " ".join(repr(float(x)) for corner in corners for x in corner)


def engine_text(scene, with_bodies=True):
    lines = [line("patch", p) for p in scene["patches"]]
    for body in scene["bodies"] if with_bodies else []:
        if len(body) == 1:
            lines.append(line("plate", body[0]))
        else:
            lines += ["solid", *(line("face", f) for f in body)]
    return lines


def ask(engine, scene, word, items, with_bodies=True):
    """(i, j) -> (F_ij, F_ji, error of the first, error of the second)."""
    asked = [" ".join([word, *map(str, item)]) for item in items]
    text = "\n".join(engine_text(scene, with_bodies) + asked) + "\n"
    out = subprocess.run([engine, "exact"], input=text, capture_output=True, text=True, check=True).stdout
    rows = [r.split() for r in out.splitlines()]
    return {(int(r[0]), int(r[1])): (without_rounding(r[2]), without_rounding(r[4]), float(r[3]), float(r[5])) for r in rows}


def without_rounding(text):
    """What is hidden altogether is zero, not what is left of a difference."""
    value = float(text)
    return value if abs(value) > 1e-15 else 0.0


def boxes_only(scene):
    """Low and high corners, where every body is an axis-aligned box."""
    bounds = []
    for body in scene["bodies"]:
        corners = [c for face in body for c in face]
        low, high = [[f(c[k] for c in corners) for k in range(3)] for f in (min, max)]
        if any(c[k] not in (low[k], high[k]) for c in corners for k in range(3)) or len(body) != 6:
            return None
        bounds.append(low + high)
    return bounds


def ask_boxes(program, scene, items):
    """(i, j) -> F_ij by the further program."""
    bounds = boxes_only(scene)
    lines = [f"{len(scene['patches'])} {len(bounds)} 0"]
    lines += ["0 " + " ".join(repr(float(x)) for c in p for x in c) for p in scene["patches"]]
    lines += [" ".join(repr(float(x)) for x in b) for b in bounds]
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as f:
        f.write("\n".join(lines) + "\n")
        f.flush()
        asked = "".join(f"{i} {j}\n" for i, j in items)
        command = [program, f.name, "run", "1e-13", "300000", "1"]
        out = subprocess.run(command, input=asked, capture_output=True, text=True, check=True).stdout
    return {(int(r[0]), int(r[1])): float(r[2]) for r in map(str.split, out.splitlines())}


def area(polygon):
    import numpy as np

    p = np.asarray(polygon, float)
    return float(np.linalg.norm(sum(np.cross(p[k] - p[0], p[k + 1] - p[0]) for k in range(1, len(p) - 1))) / 2)


def chosen(engine, scene):
    """Pairs that are asked for, or of the candidates those that are partly hidden."""
    if scene["pairs"]:
        return scene["pairs"], ask(engine, scene, "pair", scene["pairs"], False)
    free = ask(engine, scene, "pair", scene["candidates"], False)
    near = [c for c in scene["candidates"] if free[c][0] > 1e-6]
    seen = ask(engine, scene, "pair", near)
    partly = [c for c in near if 0.03 < seen[c][0] / free[c][0] < 0.97]
    return partly[:PAIRS_OF_A_SCENE], free


def pair_case(scene, pair, sweep, free, brute, boxes):
    i, j = pair
    there, back = sweep[pair][:2]
    ratio = area(scene["patches"][i]) / area(scene["patches"][j])
    checks = [("reciprocity: a separate integral over patch 2", back / ratio)]
    for k, scale in ((0, 1), (1, ratio)):
        # Where kinks are too many for its budget the second way says so, and is no witness.
        if brute[pair][k + 2] <= SECOND_WAY_REACHES:
            checks.append((f"second way, over patch {k + 1}", brute[pair][k] / scale))
    if boxes:
        checks.append(("further program for boxes, over patch 1", boxes[pair]))
    checks = [{"method": m, "F12": f"{v:.16e}", "abs_diff": f"{abs(v - there):.1e}"} for m, v in checks]
    worst = max(float(c["abs_diff"]) for c in checks)
    return {
        "id": f"{scene['name']}-{i}-{j}",
        "patches": [i, j],
        "surface1": {"type": "polygon", "vertices": scene["patches"][i]},
        "surface2": {"type": "polygon", "vertices": scene["patches"][j]},
        "values": {"F12": f"{there:.16e}", "F21": f"{back:.16e}"},
        "unobstructed": {"F12": f"{free[pair][0]:.16e}"},
        "largest_difference": worst,
        "verified_by": checks,
        "mc_check": by_rays(scene["patches"][i], scene["patches"][j], scene["bodies"], there),
    }


def pairs_of(engine, program, scene):
    pairs, free = chosen(engine, scene)
    sweep, brute = ask(engine, scene, "pair", pairs), ask(engine, scene, "brute", pairs)
    boxes = ask_boxes(program, scene, pairs) if program and boxes_only(scene) else None
    cases = [pair_case(scene, pair, sweep, free, brute, boxes) for pair in pairs]
    kept = []
    for case in cases:
        witnessed = len(case["verified_by"]) > 1
        if witnessed and case["largest_difference"] <= AGREEMENT and abs(case["mc_check"]["z"]) <= 4:
            kept.append(case)
        else:
            print("dropped:", case["id"], json.dumps(case["verified_by"]), case["mc_check"], flush=True)
    return kept


def rows_of(engine, program, scene):
    rows = []
    for i in scene["rows"]:
        values = ask(engine, scene, "row", [(i,)])
        n = len(scene["patches"])
        there = [values[i, j][0] for j in range(n)]
        areas = [area(p) for p in scene["patches"]]
        other = [values[i, j][1] * areas[j] / areas[i] for j in range(n)]
        checks = {"reciprocity: separate integrals over the other patches": other}
        if program:
            boxes = ask_boxes(program, scene, [(i, j) for j in range(n)])
            checks["further program for boxes"] = [boxes[i, j] for j in range(n)]
        worst = {m: max(abs(a - b) for a, b in zip(there, v)) for m, v in checks.items()}
        assert max(worst.values()) < AGREEMENT, (scene["name"], i, worst)
        rows.append({
            "patch": i,
            "sum_minus_1": f"{sum(there) - 1:.1e}",
            "largest_differences": {m: f"{w:.1e}" for m, w in worst.items()},
            "values": [f"{v:.15e}" if v else "0" for v in there],
        })
        print(scene["name"], "row", i, worst, rows[-1]["sum_minus_1"], flush=True)
    return rows


def write(scene, pairs, rows):
    """One item a line, so that a change shows as what changed."""
    faces = [{"type": "polygon", "vertices": f, "two_sided": True} for body in scene["bodies"] for f in body]

    def block(items):
        return "[\n  " + ",\n  ".join(json.dumps(x) for x in items) + "\n ]" if items else "[]"

    parts = {
        "scene": json.dumps(scene["name"]),
        "units": json.dumps("metres; form factors dimensionless"),
        "bodies": json.dumps([len(b) for b in scene["bodies"]]),
        "blockers": block(faces),
        "pairs": block(pairs),
        "patches": block(scene["patches"] if rows else []),
        "rows": block(rows),
    }
    text = "{\n " + ",\n ".join(f"{json.dumps(k)}: {v}" for k, v in parts.items()) + "\n}\n"
    (HERE / f"{scene['name']}.json").write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engine", required=True, help="the program xtask, built with optimisation")
    parser.add_argument("--boxes", help="a further program for axis-aligned boxes")
    parser.add_argument("scenes", nargs="*", help="names of scenes; all without")
    options = parser.parse_args()
    for scene in all_scenes():
        if options.scenes and scene["name"] not in options.scenes:
            continue
        pairs = pairs_of(options.engine, options.boxes, scene)
        worst = max((p["largest_difference"] for p in pairs), default=0)
        print(scene["name"], len(pairs), "pairs, largest difference", worst, flush=True)
        write(scene, pairs, rows_of(options.engine, options.boxes, scene))


if __name__ == "__main__":
    main()

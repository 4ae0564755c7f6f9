"""Runs every tool that is there on one scene, and writes one line of CSV for each setting.

    python run.py SCENE --etalon PROGRAM --xtask PROGRAM --cache FOLDER --output FILE.csv
"""

import argparse
import csv
import pathlib
import statistics
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    sys.exit("the peers need numpy: pip install numpy, or name another python with --python")

import tools
import truth
from scene import Scene

COLUMNS = ["scene", "patches", "tool", "setting", "seconds", "rms", "max", "repeats", "note"]

HINTS = {"Mitsuba": ": an LLVM too old? DRJIT_LIBLLVM_PATH names another (19 works)"}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--etalon", required=True)
    parser.add_argument("--xtask", required=True)
    parser.add_argument("--cache", required=True, help="where exact values are kept")
    parser.add_argument("--output", required=True, help="CSV to append to")
    parser.add_argument("--view3d", help="the executable, if it is not on the PATH")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--max-time", type=float, default=60.0, help="seconds after which a setting is not repeated")
    parser.add_argument("--quick", action="store_true", help="no more than 10,000 rays a patch for the slow tools")
    parser.add_argument("--tools", help="names, separated by commas")
    parser.add_argument("--alone", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def measured(run, repeats, max_time):
    """The median time, the last matrix and what else was said; one run only where that takes long."""
    times, matrix, said = [], None, {}
    while len(times) < repeats and sum(times) < max_time:
        seconds, matrix, said = run()
        times.append(seconds)
    return statistics.median(times), matrix, said, len(times)


def lines(scene, tool, options, rows, exact, folder):
    head = {"scene": scene.name, "patches": scene.count, "tool": tool}
    try:
        for setting, run in tools.ALL[tool](scene, options, folder):
            yield head | {"setting": setting} | outcome(run, options, rows, exact)
    except tools.Missing as why:
        yield head | {"note": f"not there: {why}"}


def outcome(run, options, rows, exact):
    try:
        seconds, matrix, said, repeats = measured(run, options.repeats, options.max_time)
    except Exception as e:  # One tool that fails must not cost the others their run.
        return {"note": f"failed: {type(e).__name__}: {e}"[:200]}
    error = matrix[rows] - exact
    note = "; ".join(f"{k} {v:.2g}" for k, v in said.items() if v is not None)
    if len(rows) < len(matrix):
        note = "; ".join(filter(None, [f"error over {len(rows)} rows", note]))
    return {
        "seconds": f"{seconds:.4g}",
        "rms": f"{np.sqrt(np.mean(error**2)):.3e}",
        "max": f"{np.abs(error).max():.3e}",
        "repeats": repeats,
        "note": note,
    }


def one_by_one(names, output):
    """Every tool in a process of its own: one that aborts takes only its own settings along."""
    for name in names:
        done = subprocess.run([sys.executable, *sys.argv, "--tools", name, "--alone"])
        if done.returncode != 0:
            with output.open("a", newline="") as file:
                scene = Scene(sys.argv[1])
                note = f"ended by itself with code {done.returncode}" + HINTS.get(name, "")
                line = {"scene": scene.name, "patches": scene.count, "tool": name, "note": note}
                csv.DictWriter(file, COLUMNS, restval="").writerow(line)


def main():
    options = arguments()
    names = options.tools.split(",") if options.tools else list(tools.ALL)
    if unknown := set(names) - set(tools.ALL):
        sys.exit(f"no tool is called {', '.join(sorted(unknown))}; there are {', '.join(tools.ALL)}")
    output = pathlib.Path(options.output)
    scene = Scene(options.scene)
    rows, exact = truth.of(scene, options.xtask, options.cache)
    if not options.alone:
        if not output.exists():
            output.write_text(",".join(COLUMNS) + "\n")
        one_by_one(names, output)
        return
    with tempfile.TemporaryDirectory() as folder, output.open("a", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, restval="")
        for line in lines(scene, names[0], options, rows, exact, folder):
            table.writerow(line)
            file.flush()
            print("  " + ", ".join(str(v) for v in line.values() if v != ""), flush=True)


if __name__ == "__main__":
    main()

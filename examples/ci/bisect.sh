#!/bin/sh
# Finds the commit that broke a solver:
#
#   git bisect start BAD GOOD
#   SCENE=room.toml BUILD='make' SOLVER='./solver "$SCENE" "$PATCHES" "$SOLUTION"' git bisect run sh /path/to/bisect.sh
#
# Keep this file outside of the repository, or it changes with the commits. SCENE, SOLVER, LIMITS, REFERENCE, ETALON: as
# in check.sh. BUILD: command that builds the solver (optional). CACHE: default: a folder inside .git.
#
# Exit code: 0 good, 1 bad, 125 skip (it does not build, writes no solution, or no verdict); 128 ends the bisection:
# something is wrong that no commit is to blame for.
set -u
GIVE_UP=128
: "${SCENE:=}" "${SOLVER:=}"
[ -n "$SCENE" ] && [ -n "$SOLVER" ] || { echo "bisect.sh: say which: SCENE=room.toml SOLVER='...'" >&2; exit $GIVE_UP; }
: "${BUILD:=true}" "${LIMITS:=--reflected --max-rms 5%}" "${REFERENCE:=--rays 16384}" "${ETALON:=etalon}"
: "${CACHE:=$(git rev-parse --absolute-git-dir)/etalon}"
mkdir -p "$CACHE" || exit $GIVE_UP
PATCHES=$CACHE/patches.csv
SOLUTION=$CACHE/solution.csv
export SCENE PATCHES SOLUTION

# A commit that does not build says nothing about the fault.
sh -c "$BUILD" || exit 125

# Options are several words each: they are not quoted on purpose.
key=$("$ETALON" reference "$SCENE" $REFERENCE --print-key) || exit $GIVE_UP
"$ETALON" reference "$SCENE" $REFERENCE -o "$CACHE/$key" > /dev/null || exit $GIVE_UP
"$ETALON" scene patches "$SCENE" -o "$PATCHES" > /dev/null || exit $GIVE_UP

rm -f "$SOLUTION"
sh -c "$SOLVER" || exit 125
exec "$ETALON" bisect "$SOLUTION" --reference "$CACHE/$key" --scene "$SCENE" $LIMITS --max-time 5m

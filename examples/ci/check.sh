#!/bin/sh
# Checks a solver against a ray-traced reference, without any CI. Runs from any directory.
#
#   SCENE=room.toml SOLVER='python3 solver.py "$SCENE" "$PATCHES" -o "$SOLUTION"' sh check.sh
#
# SCENE      the scene (a file, or builtin:NAME)
# SOLVER     command that writes $SOLUTION, given $SCENE and $PATCHES; leave it out if the solution is there already
# SOLUTION   the solution; default: solution.csv in $OUTPUT
# LIMITS     what is demanded; default: --reflected --max-rms 5%
# REFERENCE  options of the reference; default: --rays 16384
# ACCEPTED   a solution that was accepted before: this one may differ from it only within CHANGE (optional)
# CHANGE     default: --max-worst 1%
# OUTPUT     folder of the results; default: etalon-check
# CACHE      folder that keeps references between runs; default: .etalon-cache
# ETALON     the program; default: etalon
#
# Exit code: 0 passed, 1 failed, 3 inconclusive; 2 and anything else: there is no verdict.
set -u
: "${SCENE:=}" "${SOLVER:=}" "${LIMITS:=--reflected --max-rms 5%}" "${REFERENCE:=--rays 16384}"
: "${ACCEPTED:=}" "${CHANGE:=--max-worst 1%}"
: "${OUTPUT:=etalon-check}" "${CACHE:=.etalon-cache}" "${ETALON:=etalon}"
: "${SOLUTION:=$OUTPUT/solution.csv}"
PATCHES=$OUTPUT/patches.csv
export SCENE PATCHES SOLUTION

no_verdict() { echo "check.sh: $1" >&2; exit "${2:-2}"; }

[ -n "$SCENE" ] || no_verdict "say which scene: SCENE=room.toml"
mkdir -p "$OUTPUT" "$CACHE" || no_verdict "cannot make the folders $OUTPUT and $CACHE"

# A reference is computed once. Its key changes with the scene, the options, the ray kernel and the version of etalon.
# Options are several words each: they are not quoted on purpose.
key=$("$ETALON" reference "$SCENE" $REFERENCE --print-key) || no_verdict "no key of the reference" $?
reference=$CACHE/$key
"$ETALON" reference "$SCENE" $REFERENCE -o "$reference" > /dev/null || no_verdict "no reference" $?

"$ETALON" scene patches "$SCENE" -o "$PATCHES" > /dev/null || no_verdict "no list of patches" $?
if [ -n "$SOLVER" ]; then
    rm -f "$SOLUTION"   # else a solver that dies would be judged by its last run
    sh -c "$SOLVER" || no_verdict "the solver ended with exit code $?"
fi
[ -f "$SOLUTION" ] || no_verdict "there is no solution $SOLUTION"

# From an unclear verdict it goes on to better references, for five minutes at most.
code=0
"$ETALON" check "$SOLUTION" --reference "$reference" --scene "$SCENE" $LIMITS --until-decided --max-time 5m \
    --junit "$OUTPUT/junit.xml" --markdown "$OUTPUT/summary.md" --report "$OUTPUT/report" || code=$?

# Old against new needs no rays: it sees changes far below the solver's own error.
if [ -n "$ACCEPTED" ] && { [ "$code" -eq 0 ] || [ "$code" -eq 3 ]; }; then
    changed=0
    "$ETALON" check "$SOLUTION" --reference "$ACCEPTED" --scene "$SCENE" $CHANGE || changed=$?
    [ "$changed" -eq 0 ] || code=$changed
fi

case $code in
    0) echo "check.sh: passed" ;;
    1) echo "check.sh: failed; see $OUTPUT/report/report.html" ;;
    3) echo "check.sh: inconclusive; more rays would decide" ;;
    *) echo "check.sh: no verdict" >&2 ;;
esac
exit "$code"

"""A small, very bright lamp over floors: what a hemi-cube makes of a source of one or two pixels."""

from shapes import Scene, cells

MONO = """
format = "etalon-scene/1"
name = "{name}"
enclosure = false

[photometry]
primaries = "mono"
bands = ["y"]

[[material]]
name = "floor"
reflectance = 0.5

[[material]]
name = "lamp"
reflectance = 0
emission = 100000
"""

SMALL = """
# A small, very bright lamp at (0, 0, 10), looking down on floors 10 m, 5 m and 2.5 m below it, which do not shade one
# another. Its edge is 0.5 m in the initial state, 0.4 m after the first edit and 0.2 m after the second.
# The floor's patches are 0.5 m wide, those of the platforms 0.25 m and 0.125 m: 1.25 pixels of a hemi-cube of
# resolution 50, which sees the lamp at another phase from each patch. In the middle, where the floor has a hole,
# stand four probes of 2 cm: right under the lamp ("axis"), and 0.2 m, 0.12 m and 0.1 m off it in x and in y, where the
# lamp is centred in a pixel at resolution 50, off centre, and centred at resolution 100. Written by generate/make.py.
"""

ALIASING = """
# Aliasing alone. A lamp of 0.5 m, 10 m above 81 receivers of 2 cm that stand 0.45 m apart, with nothing between: over
# a receiver the form factor changes by 2 in a million of itself, so a centre is as good as the square. What is left is
# that pixels are counted whole: at resolution 50 the lamp covers 1.25 x 1.25 of them, and 1, 2 or 4 are counted.
# The lamp reflects nothing: what it receives itself (through one hemi-cube that sees 81 specks) changes nothing.
# Written by generate/make.py.
"""

PROBES = [("axis", 0, 0), ("centred-50", -0.2, -0.2), ("off-centre", 0.12, 0.12), ("centred-100", 0.1, -0.1)]

EDITS = """
[[edit]]
replace = "lamp"
scale = [0.8, 0.8, 1]
about = [0, 0, 10]

[[edit]]
replace = "lamp"
scale = [0.5, 0.5, 1]
about = [0, 0, 10]

[[camera]]
name = "main"
eye = [7, -13, 8]
target = [0, 0, 4]
up = [0, 0, 1]
fov = 60
size = [640, 480]
"""

EX, EY = (1, 0, 0), (0, 1, 0)


def small_lamp():
    s = Scene()
    outer = [(-4.25, -0.25, 8), (-0.25, 0.25, 1), (0.25, 4.25, 8)]
    cells(s, "floor", "floor", "floor", (0, 0, 0), EX, EY, outer, outer, (1, 1), holes=[(1, 1)])
    platform(s, "platform-5m", 5, 2.5, 8, 0.25)
    platform(s, "platform-2.5m", 7.5, -2.125, 6, 0.125)
    for name, x, y in PROBES:
        probe(s, f"probe-{name}", x, y)
    lamp(s, 0.5)
    return s.write(SMALL.strip() + MONO.format(name="small-lamp"), EDITS)


def aliasing_only():
    s = Scene()
    for k in range(81):
        probe(s, f"receiver-{k % 9}{k // 9}", 0.45 * (k % 9 - 4), 0.45 * (k // 9 - 4))
    lamp(s, 0.5)
    return s.write(ALIASING.strip() + MONO.format(name="aliasing-only"), "")


def platform(s, name, height, west, count, cell):
    """`count` x `count` patches; both sides radiate, so that the floor sees no black back."""
    half = count * cell / 2
    x, y = (west, west + 2 * half), (-half, half)
    top = [(x[0], y[0], height), (x[1], y[0], height), (x[1], y[1], height), (x[0], y[1], height)]
    s.face(name, "platforms", "floor", top, (count, count))
    s.face(f"{name}-under", "platforms", "floor", top[::-1], (count, count))


def probe(s, name, x, y, half=0.01):
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    s.face(name, "probes", "floor", [(x + a, y + b, 0) for a, b in corners])


def lamp(s, edge, height=10):
    h = edge / 2
    s.face("lamp", "lamp", "lamp", [(-h, -h, height), (-h, h, height), (h, h, height), (h, -h, height)])

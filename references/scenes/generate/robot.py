"""A jointed robot, 2.1 m high with its antenna, facing south; joints leave gaps of about 6 mm."""

from shapes import Scene, add, cross, mul, unit

GAP = 0.006
UP, FRONT = (0, 0, 1), (0, -1, 0)


class Robot(Scene):
    def part(self, name, material, base, axis, profile, **more):
        self.lathe(name, "robot", material, base, axis, profile, **more)

    def joint(self, name, centre, radius):
        self.ball(name, "robot", "joint", centre, radius)

    def limb(self, name, start, direction, length, radii, joints, rows):
        """Between two joints `length` apart, of radii `joints`: thickest after 60 % of the way. Returns the far one."""
        d = unit(direction)
        low, high = joints[0] + GAP, length - joints[1] - GAP
        middle = low + 0.6 * (high - low)
        profile = [(low, radii[0], rows), (middle, radii[1], rows - 1), (high, radii[2], 1)]
        self.part(name, "shell", start, d, profile)
        return add(start, mul(length, d))


def robot():
    r = Robot()
    for side, sign in (("left", 1), ("right", -1)):
        leg(r, side, sign * 0.12)
    trunk(r)
    head(r)
    arm(r, "left", (0.285, 0, 1.56), (0.9, -0.2, 0.1), (0.3, -0.25, 0.95))
    arm(r, "right", (-0.285, 0, 1.56), (-0.45, -0.2, -0.85), (-0.15, -0.9, 0.25))
    return r


def leg(r, side, x):
    r.box(f"{side}-foot", "robot", "joint", (x - 0.06, -0.2, 0), (x + 0.06, 0.08, 0.07), 0.06, (1, 1))
    r.part(f"{side}-ankle", "joint", (x, 0, 0.076), UP, [(0, 0.045, 1), (0.038, 0.04, 1)])
    r.limb(f"{side}-shin", (x, 0, 0.12), UP, 0.4, (0.05, 0.07, 0.055), (0, 0.06), 3)
    r.joint(f"{side}-knee", (x, 0, 0.52), 0.06)
    r.limb(f"{side}-thigh", (x, 0, 0.52), UP, 0.445, (0.06, 0.08, 0.07), (0.06, 0.06), 3)
    r.joint(f"{side}-hip", (x, 0, 0.965), 0.06)


def trunk(r):
    hips = [(0, 0.15, 1), (0.04, 0.2, 2), (0.1, 0.17, 1)]
    r.part("pelvis", "joint", (0, 0, 1.03), UP, hips, squeeze=0.7, across=(1, 0, 0))
    r.part("waist", "joint", (0, 0, 1.136), UP, [(0, 0.1, 1), (0.038, 0.1, 1)])
    chest = [(0, 0.16, 5), (0.3, 0.24, 3), (0.44, 0.2, 1), (0.48, 0.12, 1)]
    r.part("chest", "shell", (0, 0, 1.18), UP, chest, squeeze=0.62, across=(1, 0, 0), elements=(2, 2))
    r.box("plate", "robot", "panel", (-0.09, -0.175, 1.32), (0.09, -0.155, 1.48), 0.04, (1, 1))
    for k in range(3):
        base = (0.05 * (k - 1), -0.175 - GAP, 1.44)
        r.part(f"button-{k}", "red", base, FRONT, [(0, 0.018, 1), (0.014, 0.014, 1)], sides=8, elements=(1, 2))
    r.box("grille", "robot", "joint", (-0.06, -0.175 - GAP - 0.01, 1.34), (0.06, -0.175 - GAP, 1.39), 0.02, (1, 1))


def head(r):
    r.part("neck", "joint", (0, 0, 1.666), UP, [(0, 0.05, 1), (0.048, 0.05, 1)])
    skull = [(0, 0.09, 1), (0.05, 0.125, 3), (0.2, 0.12, 2), (0.26, 0.07, 1)]
    r.part("head", "shell", (0, 0, 1.72), UP, skull, squeeze=0.9, across=(1, 0, 0))
    for side, sign in (("left", 1), ("right", -1)):
        eye = [(0, 0.03, 1), (0.02, 0.022, 1)]
        r.part(f"{side}-eye", "panel", (sign * 0.045, -0.116, 1.87), FRONT, eye, sides=8, elements=(1, 2))
        r.part(f"{side}-ear", "red", (sign * 0.128, 0, 1.86), (sign, 0, 0), [(0, 0.04, 1), (0.03, 0.025, 1)], sides=8)
    r.box("mouth", "robot", "panel", (-0.045, -0.13, 1.79), (0.045, -0.116, 1.81), 0.015, (1, 1))
    r.part("antenna", "joint", (0, 0, 1.986), UP, [(0, 0.008, 2), (0.1, 0.006, 1)], sides=6)
    r.ball("antenna-tip", "robot", "red", (0, 0, 2.114), 0.022)


def arm(r, side, shoulder, upper, fore):
    r.joint(f"{side}-shoulder", shoulder, 0.065)
    elbow = r.limb(f"{side}-upper-arm", shoulder, upper, 0.33, (0.045, 0.055, 0.045), (0.065, 0.05), 3)
    r.joint(f"{side}-elbow", elbow, 0.05)
    wrist = r.limb(f"{side}-forearm", elbow, fore, 0.32, (0.04, 0.05, 0.035), (0.05, 0), 3)
    hand(r, side, wrist, unit(fore))


def hand(r, side, wrist, along):
    """A palm, three fingers of two parts each, and a thumb."""
    width = unit(cross(along, (0.1, -1, 0.3)))
    frame = (add(wrist, mul(GAP, along)), width, cross(along, width), along)
    at = lambda x, y, z: add(frame[0], add(mul(x, frame[1]), add(mul(y, frame[2]), mul(z, frame[3]))))
    r.box(f"{side}-palm", "robot", "joint", (-0.045, -0.015, 0), (0.045, 0.015, 0.08), 0.04, (1, 1), frame)
    for k in range(3):
        x = 0.032 * (k - 1)
        lean = add(along, mul(5 * x, frame[1]))
        base = at(x, 0, 0.08 + GAP)
        r.part(f"{side}-finger-{k}-a", "shell", base, along, [(0, 0.012, 1), (0.036, 0.012, 1)], sides=6)
        tip = at(x, 0, 0.08 + GAP + 0.036 + 2 * GAP)
        r.part(f"{side}-finger-{k}-b", "shell", tip, lean, [(0, 0.011, 1), (0.036, 0.007, 1)], sides=6)
    thumb = add(mul(0.8, frame[1]), mul(0.6, along))
    r.part(f"{side}-thumb", "shell", at(0.06, 0, 0.03), thumb, [(0, 0.01, 2), (0.045, 0.007, 1)], sides=6)

//! How the page is to be read.

/// What is explained, and how.
pub(super) const READING: [(&str, &str); 9] = [
    (
        "Error",
        "Of a picture: the root mean square of the difference in luminance from rays, over the mean luminance by rays. Of a \
         light: the same of the irradiance over points, over the root mean square by rays. The judge\u{2019}s own noise is \
         taken off; where noise is all there is, the error is 0. Intervals are those of 95 %.",
    ),
    (
        "Sub-scanlines",
        "Every scanline is cut into this many. Along each, ends of segments are known exactly; across, a pixel is summed by \
         trapezoids (Nakamae and others 1989, equations 1 and 2). The dotted guide falls with the square of their number, as \
         trapezoids do where what they sum is smooth. Edges that run along the lines are not.",
    ),
    (
        "Scale",
        "The same segments drawn larger or smaller. Each line has the sub-scanlines that fall on it (equation 7): fewer where \
         the picture grows, so that its error grows too.",
    ),
    (
        "Lit, penumbra, dark",
        "Points that see the whole of a lamp, a part of it, or nothing, those that are turned away among them.",
    ),
    (
        "|t|",
        "The difference at a point in standard errors of the judge. The largest is allowed to be as large as in 999 of 1000 \
         audits in which all is well, however many points there are. Mean t\u{b2} is 15/13, about 1.15, where all is well: \
         the judge repeats itself 16 times.",
    ),
    (
        "Surely off",
        "Points at which all of the judge\u{2019}s rays agree, and with another number than ours by more than rays can miss.",
    ),
    ("Within", "No |t| is beyond what is allowed, and no point is surely off."),
    (
        "As good a picture",
        "The samples a pixel at which the noise of rays alone would be as large as our error, and their time: noise falls \
         with the root of the samples, and time grows with them.",
    ),
    ("Times", "Those of this machine on this day, all of its threads. Nothing else on this page depends on them."),
];

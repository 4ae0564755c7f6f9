//! Three lights for one town.

use super::street::LANTERNS;
use std::fmt::Write;

/// Sun, clear sky, clouds and a little haze.
pub const DAY: &str = r#"
[[light]]
name = "sun"
type = "parallel"
direction = [0.55, 0.5, -0.67]
irradiance = [9.0, 8.5, 7.4]

[[light]]
name = "sky"
type = "sky"
model = "clear"
radiance = [0.42, 0.6, 0.95]
sun = [-0.55, -0.5, 0.67]

[fog]
extinction = 0.0025
radiance = [0.95, 1.05, 1.2]

[background]
radiance = [0.12, 0.16, 0.22]
sky = true
clouds = { picture = "clouds.png", height = 320.0, tile = [900.0, 900.0], radiance = [2.6, 2.6, 2.6] }
"#;

/// An overcast sky, and the sun hardly through it.
pub const OVERCAST: &str = r#"
[[light]]
name = "sun"
type = "parallel"
direction = [0.55, 0.5, -0.67]
irradiance = [0.7, 0.7, 0.68]

[[light]]
name = "sky"
type = "sky"
model = "overcast"
radiance = [1.3, 1.32, 1.38]

[fog]
extinction = 0.006
radiance = [0.75, 0.78, 0.82]

[background]
radiance = [0.35, 0.36, 0.38]
sky = true
"#;

/// Street lamps, a neon tube over the shop, and five floodlamps around the office [NINT89 fig. 7].
pub fn night() -> String {
    let mut text = String::new();
    for (k, [x, y, z]) in LANTERNS.into_iter().enumerate() {
        let _ = write!(
            text,
            r#"
[[light]]
name = "street lamp {}"
type = "point"
position = [{x}, {y}, {}]
intensity = [26.0, 20.0, 11.0]
direction = [0.0, 0.0, -1.0]
curve = [[0, 0.55], [30, 0.7], [55, 1.0], [70, 0.6], [80, 0.1], [90, 0.0]]
"#,
            k + 1,
            z + 0.02
        );
    }
    for (k, (place, direction)) in [
        ([-6.2, 6.2, 0.3], [-0.25, 0.35, 0.9]),
        ([-6.2, 14.5, 0.3], [-0.3, 0.0, 0.95]),
        ([-6.2, 22.6, 0.3], [-0.25, -0.35, 0.9]),
        ([-16.0, 6.2, 0.3], [0.0, 0.3, 0.95]),
        ([-25.6, 6.2, 0.3], [0.25, 0.35, 0.9]),
    ]
    .into_iter()
    .enumerate()
    {
        let _ = write!(
            text,
            r#"
[[light]]
name = "floodlamp {}"
type = "point"
position = {place:?}
intensity = [55.0, 60.0, 66.0]
direction = {direction:?}
curve = [[0, 1.0], [10, 0.92], [20, 0.6], [30, 0.24], [45, 0.04], [60, 0.0]]
"#,
            k + 1
        );
    }
    text + r#"
[[light]]
name = "neon"
type = "linear"
from = [6.75, 8.2, 3.35]
to = [6.75, 14.8, 3.35]
intensity = [2.6, 0.5, 0.9]

[[light]]
name = "night sky"
type = "sky"
model = "uniform"
radiance = [0.006, 0.008, 0.014]

[fog]
extinction = 0.002
radiance = [0.01, 0.012, 0.02]

[background]
radiance = [0.006, 0.008, 0.014]
sky = true
"#
}

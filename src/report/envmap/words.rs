//! How the page is to be read.

use crate::report::format::confidence;

/// What is explained, and how. The first three have the colours of the parts.
pub(super) fn reading(level: f64) -> Vec<(&'static str, String)> {
    let fixed = [
        (
            "Map",
            "What is looked up against what arrives at the centre itself, over the same normal or cone: texels, filter \
             and table. More texels or a finer table mend it.",
        ),
        (
            "Parallax",
            "What arrives at the centre against what arrives at the point, the object taken away. A map knows \
             directions and no distances: what is near looks alike from everywhere. More centres mend it, or rays near \
             by; texels do not.",
        ),
        (
            "Object",
            "The object is not in its own map: the map does not know what the object hides from its own surface, nor \
             the light that its parts send each other. Rays near by mend it.",
        ),
        (
            "What no map can know",
            "It is a picture of the world from one point (Greene 1986). There it is right but for its texels, and so it \
             is for light from far away. Shadows of what stands close, and reflections of the object in itself, it has \
             only by chance.",
        ),
        (
            "Error",
            "The root mean square of map less truth over that of the truth, points of equal weight, luminance. The noise \
             of the truth is taken out. The bias is the mean of map less truth over the mean of the truth.",
        ),
        (
            "How the parts add up",
            "At every point the three add up to the error exactly. As root mean squares they do not, since errors of \
             different signs cancel. Shares of the squared error do: a negative share says that this part makes up for \
             others, so that without it the whole would be worse.",
        ),
        (
            "Hybrid",
            "Rays as far as the reach; what they miss there is looked up in the map as a backdrop. At reach 0 it is the \
             map alone, seen by rays from the surface.",
        ),
        (
            "Fast filters",
            "Held against exact filtering of the same map, texel by texel: neither place nor object take part. The box \
             averages the quadrilateral cone of a square pixel, the elliptical weighted average a Gaussian over an \
             elliptical one. Near the poles: directions within 30 degrees of the vertical.",
        ),
    ];
    let mut all: Vec<(&str, String)> = fixed.into_iter().map(|(what, text)| (what, text.into())).collect();
    let text = format!(
        "At {}, from the spread of the replicates of the truth and of groups of places, which stand for all \
         others. A dash stands where nothing is known, as where no light arrives; it is not zero.",
        confidence(level)
    );
    all.push(("Intervals", text));
    all
}

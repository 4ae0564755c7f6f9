//! The catalogue: form factors of disks, spheres and rectangles in closed form or as one integral of closed forms.
//!
//! Numbers such as C-41 are those of J. R. Howell, *A Catalog of Radiation Heat Transfer Configuration Factors*. The
//! formulas are derived here from Lambert's integral where the functions say so, and held against values of 30 digits
//! (`etalon validate closed-forms`). Lengths in any one unit; nothing stands between unless the name says so.

mod any_polygon;
mod disks;
mod integral;
mod rectangles;
mod screened;
mod solid_angle;
mod spheres;

pub use any_polygon::{any_polygon_to_polygon, polygon_to_any_polygon};
pub use disks::{coaxial_disks, disk_to_coaxial_ring, element_to_disk};
pub use rectangles::{opposed_rectangles, rectangles_with_common_edge};
pub use screened::{coaxial_disks_past_disk, polygons_past_sphere};
pub use solid_angle::{disk_solid_angle, polygon_solid_angle};
pub use spheres::{concentric_spheres, disk_to_coaxial_sphere, element_to_sphere, polygon_to_sphere, sphere_to_sphere};

/// True if every length is finite and above 0: the catalogue answers NaN to anything else.
fn lengths(all: &[f64]) -> bool {
    all.iter().all(|l| l.is_finite() && *l > 0.0)
}

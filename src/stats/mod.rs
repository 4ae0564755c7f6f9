//! Moments, estimates, intervals and tests. Knows no file, no scene, no terminal.

mod combination;
mod distributions;
mod estimate;
mod form_factor;
mod hypothesis;
mod intervals;
mod moments;
#[cfg(test)]
pub(crate) mod test_random;

pub use combination::{bonferroni, bonferroni_level, fisher, min_p, sidak, sidak_level};
pub use distributions::{
    chi_square_upper_tail, normal_quantile, normal_upper_tail, t_quantile, t_upper_tail, two_sided_t,
};
pub use estimate::Estimate;
pub use form_factor::{FEW_HITS, form_factor_interval};
pub use hypothesis::{chi_square_p_value, t_p_value, z_difference, z_p_value};
pub use intervals::{binomial_interval, jackknife_interval, mean_interval, pseudo_values};
pub use moments::Moments;

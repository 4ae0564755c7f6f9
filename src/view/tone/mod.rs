//! Tone reproduction: from the luminances of a scene to what a display is driven with, so that its viewer sees what a
//! visitor of the scene would [TR93 eq. 15]. Luminances in cd/m^2 throughout; lamberts only inside the observer.

mod display;
mod levels;
mod observer;
mod operator;
mod viewer;

pub use display::{Display, Drive, Response};
pub use levels::Levels;
pub use observer::{LAMBERT, LEAST_STEVENS, Observer};
pub use operator::{Operator, Surround, Tone};
pub use viewer::{DEFAULT_EFFICACY, Viewer};

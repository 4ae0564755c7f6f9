//! A method with its parameters, as written on a command line: `hemicube:resolution=200,delta=exact`.

use super::shooting::{self, ShootingError};
use super::{gather, hemicube};
use std::fmt;
use std::str::FromStr;

/// One of the candidates, ready to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Ray-cast form factors, solved exactly.
    Gather(gather::Params),
    /// Hemi-cube form factors, Gauss-Seidel, as in 1985.
    Hemicube(hemicube::Params),
    /// Progressive refinement, from scratch.
    Progressive(shooting::Params),
    /// Progressive refinement of the scene before its edits, then redistribution edit by edit.
    Redistribution(shooting::Params),
}

/// Why a method cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum MethodError {
    /// No such method.
    #[error(
        "there is no method \"{name}\" in this version; methods are gather, hemicube, progressive and redistribution, \
         with parameters as hemicube:resolution=200"
    )]
    Unknown {
        /// What was written.
        name: String,
    },
    /// Parameters of the gather.
    #[error(transparent)]
    Gather(#[from] gather::ParamsError),
    /// Parameters of the hemi-cube, or its failure.
    #[error(transparent)]
    Hemicube(#[from] hemicube::HemicubeError),
    /// Parameters of the shooting methods, or their failure.
    #[error(transparent)]
    Shooting(#[from] ShootingError),
    /// A method that follows edits was asked to solve one stage.
    #[error("redistribution follows the edits of a scene, and one state alone has none; use progressive")]
    NoEdits,
    /// The scene has lights that the methods do not know.
    #[error(
        "the scene has {0} point lights, which the methods of this version do not take; `etalon reference` does, or \
         use an emitting surface"
    )]
    PointLights(usize),
    /// The patch system could not be solved.
    #[error(transparent)]
    Solver(#[from] crate::solver::SolverError),
}

impl FromStr for Method {
    type Err = MethodError;

    fn from_str(text: &str) -> Result<Self, MethodError> {
        let (name, params) = text.split_once(':').unwrap_or((text, ""));
        match name {
            "gather" => Ok(Self::Gather(params.parse()?)),
            "hemicube" => Ok(Self::Hemicube(params.parse()?)),
            "progressive" => Ok(Self::Progressive(shooting::Params::progressive(params)?)),
            "redistribution" => Ok(Self::Redistribution(shooting::Params::redistribution(params)?)),
            _ => Err(MethodError::Unknown { name: name.into() }),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gather(p) => write!(f, "gather:{p}"),
            Self::Hemicube(p) => write!(f, "hemicube:{p}"),
            Self::Progressive(p) => write!(f, "progressive:{p}"),
            Self::Redistribution(p) => write!(f, "redistribution:{p}"),
        }
    }
}

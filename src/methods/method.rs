//! A method with its parameters, as written on a command line: `hemicube:resolution=200,delta=exact`.

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
}

/// Why a method cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum MethodError {
    /// No such method.
    #[error(
        "there is no method \"{name}\" in this version; methods are gather and hemicube, \
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
            _ => Err(MethodError::Unknown { name: name.into() }),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gather(p) => write!(f, "gather:{p}"),
            Self::Hemicube(p) => write!(f, "hemicube:{p}"),
        }
    }
}

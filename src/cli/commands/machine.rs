//! `etalon setup embree` and `etalon doctor`

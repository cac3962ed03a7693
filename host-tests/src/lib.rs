//! octruss

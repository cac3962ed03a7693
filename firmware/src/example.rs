//! The baked example: the bundle and the motion that `cargo xtask demo` bakes, in flash.

/// Includes a baked bundle, such as `"/controller.oct"`, and evaluates to its bytes, aligned to 8 bytes.
///
/// A macro, for the same reason as `include_example!`.
#[macro_export]
macro_rules! include_baked {
    ($file:literal) => {{
        #[cfg(not(demo_is_baked))]
        compile_error!(
            "the bundles are not baked: run `cargo xtask demo`, or set OCTRUSS_DEMO_DIR to the directory that holds \
             finger.oct, finger.poses, controller.oct and palm.oct"
        );
        #[cfg(not(demo_is_baked))]
        let bundle: &[u8] = &[];
        #[cfg(demo_is_baked)]
        let bundle: &[u8] = octruss::include_bundle!(concat!(env!("OCTRUSS_DEMO_DIR"), $file));
        bundle
    }};
}

/// Includes the baked example and evaluates to `(bundle, poses)`, the bytes of both, each aligned
/// to 8 bytes. The poses are frames one behind the other; a frame is x, y and z of every control
/// point, raw bits, signed 32-bit, little-endian.
///
/// A macro, so that only the images that use it need the files. `build.rs` says where they are.
#[macro_export]
macro_rules! include_example {
    () => {{
        #[cfg(not(demo_is_baked))]
        compile_error!(
            "the example is not baked: run `cargo xtask demo`, or set OCTRUSS_DEMO_DIR to the \
             directory that holds finger.oct and finger.poses"
        );
        #[cfg(not(demo_is_baked))]
        let example: (&[u8], &[u8]) = (&[], &[]);
        #[cfg(demo_is_baked)]
        let example: (&[u8], &[u8]) = (
            octruss::include_bundle!(concat!(env!("OCTRUSS_DEMO_DIR"), "/finger.oct")),
            octruss::include_bundle!(concat!(env!("OCTRUSS_DEMO_DIR"), "/finger.poses")),
        );
        example
    }};
}

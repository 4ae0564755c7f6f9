//! Loading: what is refused, what functions do before, and what a real library writes.
//!
//! One test, because a library is loaded for the whole process. The last part needs `ETALON_EMBREE`.

use embree4_sys::*;
use std::path::{Path, PathBuf};

#[test]
fn a_library_is_loaded_only_if_it_is_an_embree_4() {
    before_loading_every_function_refuses();
    let missing = refuse(Path::new("/nowhere/libembree4.so.4"));
    assert!(matches!(missing, LoadError::NotLoadable { .. }), "{missing}");
    if cfg!(target_os = "linux") {
        let other = refuse(Path::new("libm.so.6"));
        assert!(matches!(other, LoadError::MissingSymbol { symbol: "rtcNewDevice", .. }), "{other}");
    }
    assert!(loaded().is_none());
    match std::env::var_os("ETALON_EMBREE").filter(|v| v != "none") {
        Some(path) => a_real_one_is_accepted(&PathBuf::from(path)),
        None => eprintln!("skipped: a real library (set ETALON_EMBREE to one)"),
    }
}

fn refuse(path: &Path) -> LoadError {
    // SAFETY: nothing there, or the C library.
    match unsafe { load(path) } {
        Ok(_) => panic!("{} was accepted", path.display()),
        Err(e) => e,
    }
}

fn before_loading_every_function_refuses() {
    let mut rayhit = RTCRayHit::default();
    // SAFETY: no library, nothing is dereferenced.
    unsafe {
        assert!(rtcNewDevice(std::ptr::null()).is_null());
        assert_eq!(rtcGetDeviceError(std::ptr::null_mut()), RTCError::UNKNOWN);
        assert_eq!(rtcAttachGeometry(std::ptr::null_mut(), std::ptr::null_mut()), RTC_INVALID_GEOMETRY_ID);
        rtcIntersect1(std::ptr::null_mut(), &mut rayhit, std::ptr::null_mut());
    }
    assert_eq!(rayhit, RTCRayHit::default());
}

fn a_real_one_is_accepted(path: &Path) {
    // SAFETY: whoever sets the variable trusts the file.
    let library = unsafe { load(path) }.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert_eq!(library.version().major, 4);
    let layout = library.layout();
    eprintln!("{} {}: {layout:?}", path.display(), library.version());
    for w in [&layout.single, &layout.packet8] {
        assert!(w.beyond.iter().all(|r| w.known <= r.0 && r.1 <= w.room));
    }
    if library.version() >= (Version { major: 4, minor: 3, patch: 0 }) {
        assert_eq!(layout.single.beyond.first(), Some(&(80, 84)), "instPrimID");
    }
    // SAFETY: as above.
    let again = unsafe { load(path) }.expect("the same library again");
    assert!(std::ptr::eq(library, again));
    assert!(matches!(refuse(Path::new("other.so")), LoadError::AnotherIsLoaded { .. }));
}

use super::*;

fn names(folder: &Path) -> Vec<String> {
    let entry = |e: io::Result<fs::DirEntry>| e.expect("entry").file_name().to_string_lossy().into_owned();
    fs::read_dir(folder).expect("folder").map(entry).collect()
}

#[test]
fn a_file_is_replaced_whole() {
    let dir = tempfile::tempdir().expect("dir");
    let path = dir.path().join("a.csv");
    write(&path, b"a much longer first version").expect("first");
    write(&path, b"second").expect("second");
    assert_eq!(fs::read(&path).expect("read"), b"second");
    assert_eq!(names(dir.path()), ["a.csv"]);
}

#[test]
fn a_failure_half_way_leaves_what_was_there() {
    let dir = tempfile::tempdir().expect("dir");
    let path = dir.path().join("a.csv");
    write(&path, b"old").expect("old");
    let failed = write_with(&path, |out| {
        out.write_all(&[b'x'; 100_000])?;
        Err(io::Error::other("out of ink"))
    });
    assert!(failed.expect_err("fails").to_string().contains("out of ink"));
    assert_eq!(fs::read(&path).expect("read"), b"old");
    assert_eq!(names(dir.path()), ["a.csv"]);
}

#[test]
fn what_stands_in_the_way_is_named() {
    let dir = tempfile::tempdir().expect("dir");
    let missing = dir.path().join("no/such/report.html");
    let e = write(&missing, b"x").expect_err("no folder");
    assert!(matches!(&e, WriteError::NoFolder { folder, .. } if folder.ends_with("no/such")), "{e}");
    assert!(e.to_string().contains("create it"), "{e}");
    assert_eq!(names(dir.path()), [""; 0]);

    assert!(matches!(write(dir.path(), b"x"), Err(WriteError::IsAFolder { .. })));
    write(&dir.path().join("file"), b"x").expect("file");
    let under = write(&dir.path().join("file/report.html"), b"x");
    assert!(matches!(&under, Err(WriteError::NotAFolder { folder, .. }) if folder.ends_with("file")), "{under:?}");
    let made = create_folder(&dir.path().join("file/deep/er"));
    assert!(matches!(&made, Err(WriteError::NotAFolder { folder, .. }) if folder.ends_with("file")), "{made:?}");
}

#[cfg(unix)]
#[test]
fn a_folder_without_permission_is_left_alone() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().expect("dir");
    fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o555)).expect("chmod");
    let path = dir.path().join("a.csv");
    let attempt = write(&path, b"x");
    // The superuser may write anyway; then the file has to be whole.
    match attempt {
        Ok(()) => assert_eq!(fs::read(&path).expect("read"), b"x"),
        Err(e) => assert!(matches!(e, WriteError::Denied { .. }), "{e}"),
    }
    fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o755)).expect("chmod");
    assert!(names(dir.path()).iter().all(|n| n == "a.csv"));
}

#[cfg(unix)]
#[test]
fn devices_and_links_stay_what_they_are() {
    use std::os::unix::fs::FileTypeExt;
    let dir = tempfile::tempdir().expect("dir");
    let socket = dir.path().join("socket");
    let _bound = std::os::unix::net::UnixListener::bind(&socket).expect("bind");
    // A socket cannot be opened as a file; what counts is that it is not replaced by one.
    write(&socket, b"x").expect_err("no file");
    assert!(fs::metadata(&socket).expect("socket").file_type().is_socket());
    let (real, link) = (dir.path().join("real"), dir.path().join("link"));
    write(&real, b"old").expect("old");
    std::os::unix::fs::symlink(&real, &link).expect("link");
    write(&link, b"new").expect("new");
    assert!(fs::symlink_metadata(&link).expect("link").is_symlink());
    assert_eq!(fs::read(&real).expect("real"), b"new");
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_an_ordinary_file() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().expect("dir");
    let mode = |p: &Path| fs::metadata(p).expect("file").permissions().mode() & 0o777;
    let (ours, plain) = (dir.path().join("ours"), dir.path().join("plain"));
    write(&ours, b"x").expect("ours");
    fs::write(&plain, b"x").expect("plain");
    assert_eq!(mode(&ours), mode(&plain));
    fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).expect("chmod");
    write(&ours, b"y").expect("again");
    assert_eq!(mode(&ours), 0o640);
}

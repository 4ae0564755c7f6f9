use super::*;

const MARK: &str = "mark";

fn files(text: &str) -> Files {
    vec![(MARK.to_string(), text.as_bytes().to_vec()), ("more".to_string(), vec![7; 1000])]
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_second_claim_is_refused_until_the_first_ends() {
    let place = tempfile::tempdir().unwrap();
    let target = place.path().join("ref");
    let first = Claim::take(&target, MARK).unwrap();
    let refused = Claim::take(&target, MARK).unwrap_err().to_string();
    assert!(refused.contains(&format!("number {}", std::process::id())) && refused.contains("wait"), "{refused}");
    drop(first);
    assert_eq!(names(place.path()), [""; 0]);
    Claim::take(&target, MARK).unwrap().publish(&files("1")).unwrap();
    assert_eq!(names(place.path()), ["ref"]);
}

#[test]
fn a_lock_file_of_the_dead_does_not_block() {
    let place = tempfile::tempdir().unwrap();
    let part = place.path().join("ref.part");
    fs::create_dir(&part).unwrap();
    fs::write(part.join(LOCK), "1\n").unwrap();
    fs::create_dir(part.join(NEW)).unwrap();
    fs::write(part.join(NEW).join("half"), "x").unwrap();
    fs::write(part.join(JOURNAL), "x").unwrap();
    let claim = Claim::take(&place.path().join("ref"), MARK).unwrap();
    assert_eq!(names(&part), [JOURNAL, LOCK], "what the dead left is cleared away, but for the journal");
    drop(claim);
    assert_eq!(names(&part), [JOURNAL, LOCK], "the journal is kept");
}

#[test]
fn a_death_between_two_renames_loses_nothing() {
    let place = tempfile::tempdir().unwrap();
    let old = place.path().join("ref.part").join(OLD);
    fs::create_dir_all(&old).unwrap();
    fs::write(old.join(MARK), "old").unwrap();
    drop(Claim::take(&place.path().join("ref"), MARK).unwrap());
    assert_eq!(fs::read(place.path().join("ref").join(MARK)).unwrap(), b"old");
    assert_eq!(names(place.path()), ["ref"]);
}

#[test]
fn what_belongs_to_others_is_not_touched() {
    let place = tempfile::tempdir().unwrap();
    let part = place.path().join("ref.part");
    fs::create_dir(&part).unwrap();
    fs::write(part.join("diary.txt"), "x").unwrap();
    let e = Claim::take(&place.path().join("ref"), MARK).unwrap_err().to_string();
    assert!(e.contains("ref.part") && e.contains("nothing was changed"), "{e}");
    assert_eq!(names(&part), ["diary.txt"]);
    fs::write(place.path().join("file"), "x").unwrap();
    for target in ["file", "file/ref"] {
        let e = Claim::take(&place.path().join(target), MARK).unwrap_err().to_string();
        assert!(e.contains("choose another place"), "{e}");
    }
    assert_eq!(names(place.path()), ["file", "ref.part"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let place = tempfile::tempdir().unwrap();
    let (real, link) = (place.path().join("real"), place.path().join("link"));
    Claim::take(&real, MARK).unwrap().publish(&files("1")).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    Claim::take(&link, MARK).unwrap().publish(&files("2")).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(real.join(MARK)).unwrap(), b"2");
    assert_eq!(names(place.path()), ["link", "real"]);
}

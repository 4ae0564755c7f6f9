use super::*;

fn written(path: &Path) -> Vec<Vec<u8>> {
    let (journal, _) = Journal::open(path, "key").unwrap();
    let records: Vec<Vec<u8>> = (0..40u8).map(|k| vec![k; usize::from(k) * 2]).collect();
    for (k, record) in records.iter().enumerate() {
        journal.append(k as u64 / 20, record);
        if k % 8 == 7 {
            journal.flush();
        }
    }
    assert_eq!(journal.flush(), 40);
    records
}

fn read(path: &Path) -> (Found, Vec<Vec<u8>>) {
    let (journal, found) = Journal::open(path, "key").unwrap();
    let mut out = Vec::new();
    for section in [0, 1] {
        journal.restore(section, &mut |record| out.push(record.to_vec()));
    }
    (found, out)
}

#[test]
fn records_come_back_and_more_follow() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("journal");
    let mut expected = written(&path);
    assert_eq!(read(&path), (Found::Records(40), expected.clone()));
    {
        let (journal, _) = Journal::open(&path, "key").unwrap();
        journal.append(1, b"one more");
    }
    expected.push(b"one more".to_vec());
    assert_eq!(read(&path), (Found::Records(41), expected));
    let (journal, _) = Journal::open(&path, "key").unwrap();
    journal.discard();
    assert!(!path.exists());
}

#[test]
fn whatever_happens_to_the_file_a_prefix_of_the_truth_comes_back() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("journal");
    let expected = written(&path);
    let sound = fs::read(&path).unwrap();
    let header = frame::header("key").len();
    for at in header..sound.len() {
        fs::write(&path, &sound[..at]).unwrap();
        let (_, torn) = read(&path);
        assert!(torn.len() < 40 && torn == expected[..torn.len()], "cut at {at}");
        let mut changed = sound.clone();
        changed[at] ^= 1 << (at % 8);
        fs::write(&path, &changed).unwrap();
        let (_, rest) = read(&path);
        assert!(rest.len() < 40 && rest == expected[..rest.len()], "changed at {at}");
    }
}

#[test]
fn a_torn_end_is_cut_off_before_more_follows() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("journal");
    let mut expected = written(&path);
    let sound = fs::read(&path).unwrap();
    fs::write(&path, &sound[..sound.len() - 1]).unwrap();
    {
        let (journal, found) = Journal::open(&path, "key").unwrap();
        assert_eq!(found, Found::Records(32));
        journal.append(1, b"instead");
    }
    expected.truncate(32);
    expected.push(b"instead".to_vec());
    assert_eq!(read(&path), (Found::Records(33), expected));
}

#[test]
fn journals_of_something_else_count_as_empty() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("journal");
    written(&path);
    let (_, found) = Journal::open(&path, "another key").unwrap();
    assert_eq!(found, Found::Other);
    assert!(!path.exists());
    fs::write(&path, b"a letter to a friend").unwrap();
    assert_eq!(read(&path), (Found::Other, vec![]));
    // Frames of one journal do not fit another.
    written(&path);
    let foreign = fs::read(&path).unwrap();
    let (old, new) = (frame::header("key"), frame::header("KEY"));
    fs::write(&path, [&new, &foreign[old.len()..]].concat()).unwrap();
    assert_eq!(Journal::open(&path, "KEY").unwrap().1, Found::Nothing);
}

#[test]
fn a_disk_that_fails_ends_the_journal_and_nothing_else() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("no-folder").join("journal");
    let (journal, found) = Journal::open(&path, "key").unwrap();
    assert_eq!(found, Found::Nothing);
    journal.append(0, b"lost");
    assert_eq!(journal.flush(), 0);
    assert!(journal.trouble().is_some_and(|t| t.contains("no-folder")));
    journal.append(0, b"lost too");
    assert_eq!(journal.flush(), 0);
}

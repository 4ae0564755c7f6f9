use super::primitives::{Mode, triangles};

#[test]
fn triangles_of_a_strip_alternate_and_those_of_a_fan_share_a_corner() {
    assert_eq!(triangles(Mode::Strip, 5, "").unwrap(), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    assert_eq!(triangles(Mode::Fan, 4, "").unwrap(), [[1, 2, 0], [2, 3, 0]]);
    assert_eq!(triangles(Mode::List, 6, "").unwrap(), [[0, 1, 2], [3, 4, 5]]);
    assert!(triangles(Mode::List, 5, "").is_err());
    assert!(triangles(Mode::Strip, 2, "").unwrap().is_empty());
}

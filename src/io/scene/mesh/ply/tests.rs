use super::*;

/// A quadrilateral and a triangle, with colours, an extra element and an extra list.
const TEXT: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty uchar red\n\
    property double x\nproperty float y\nproperty float z\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n\
    element face 2\nproperty list uchar float texcoord\nproperty list uchar int vertex_index\nproperty short flag\n\
    end_header\n255 0 0 0\n0 1 0 0\n0 1 1 0\n0 0 1 0\n0 0.5 1.5 0\n0 1\n2 .5 .5 4 0 1 2 3 7\n0 3 3 2 4 -1\n";

fn loops(mesh: &Mesh) -> Vec<Vec<DVec3>> {
    mesh.faces.iter().map(|f| mesh.corners(f)).collect()
}

/// The same file in binary, of either byte order.
fn binary(little: bool) -> Vec<u8> {
    let (head, body) = TEXT.split_once("end_header\n").unwrap();
    let name = if little { "binary_little_endian" } else { "binary_big_endian" };
    let mut out = (head.replace("ascii", name) + "end_header\n").into_bytes();
    let mut put = |bytes: &[u8]| if little { out.extend(bytes) } else { out.extend(bytes.iter().rev()) };
    for (row, line) in body.lines().enumerate() {
        let n: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap()).collect();
        match row {
            0..5 => {
                put(&[n[0] as u8]);
                put(&n[1].to_le_bytes());
                n[2..].iter().for_each(|v| put(&(*v as f32).to_le_bytes()));
            }
            5 => n.iter().for_each(|v| put(&(*v as i32).to_le_bytes())),
            _ => {
                let (t, k) = (n[0] as usize, n[n[0] as usize + 1] as usize);
                put(&[t as u8]);
                n[1..=t].iter().for_each(|v| put(&(*v as f32).to_le_bytes()));
                put(&[k as u8]);
                n[t + 2..t + 2 + k].iter().for_each(|v| put(&(*v as i32).to_le_bytes()));
                put(&(n[t + 2 + k] as i16).to_le_bytes());
            }
        }
    }
    out
}

#[test]
fn all_encodings_give_the_same_mesh() {
    let plain = parse(TEXT.as_bytes(), Keep::Shape).unwrap();
    let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    assert_eq!(
        loops(&plain),
        [vec![p(0., 0.), p(1., 0.), p(1., 1.), p(0., 1.)], vec![p(0., 1.), p(1., 1.), p(0.5, 1.5)]]
    );
    assert_eq!(plain.faces[1].tags.at, 24);
    assert_eq!(plain.notices.len(), 1);
    for little in [true, false] {
        let bytes = binary(little);
        let mesh = parse(&bytes, Keep::Shape).unwrap();
        assert_eq!(loops(&mesh), loops(&plain));
        assert_eq!(mesh.place_of(&mesh.faces[1].tags), At::Part("face 1".into()));
        assert!(text(&bytes).ends_with(b"end_header\n") && text(TEXT.as_bytes()).len() == TEXT.len());
    }
    let crlf = TEXT.replace('\n', "\r\n");
    assert_eq!(loops(&parse(crlf.as_bytes(), Keep::Shape).unwrap()), loops(&plain));
}

#[test]
fn every_truncation_is_a_fault_and_never_a_panic() {
    for bytes in [TEXT.trim_end().as_bytes().to_vec(), binary(true), binary(false)] {
        // The text's last number may lose a digit and stay one.
        for end in 0..bytes.len() - 2 {
            assert!(parse(&bytes[..end], Keep::Shape).is_err(), "{end}");
        }
    }
}

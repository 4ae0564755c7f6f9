//! MTL material libraries: diffuse reflectance and emission.

use super::model::{MeshFault, fault, number, shown};
use super::obj::name_in;

/// One material of a library.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mtl {
    pub name: String,
    /// Line of `newmtl`, counted from 1.
    pub line: usize,
    /// Diffuse reflectance, with its line.
    pub kd: Option<([f64; 3], usize)>,
    /// Emission, with its line.
    pub ke: Option<([f64; 3], usize)>,
    /// Textures, mirrors and transparency that diffuse radiosity leaves out.
    pub left_out: Vec<&'static str>,
}

/// Parses a library.
pub(super) fn parse(text: &str) -> Result<Vec<Mtl>, MeshFault> {
    let mut materials: Vec<Mtl> = Vec::new();
    for (line, statement) in text.lines().enumerate().map(|(i, l)| (i + 1, l.split('#').next().unwrap_or_default())) {
        let mut words = statement.split_ascii_whitespace();
        let Some(keyword) = words.next() else { continue };
        if keyword == "newmtl" {
            let name = name_in(statement);
            if name.is_empty() {
                return fault(line, "newmtl without a name", "write the name after it");
            }
            materials.push(Mtl { name, line, kd: None, ke: None, left_out: Vec::new() });
            continue;
        }
        let Some(material) = materials.last_mut() else {
            return fault(line, format!("\"{}\" before the first newmtl", shown(keyword)), "is this an MTL file?");
        };
        let words: Vec<&str> = words.collect();
        match keyword {
            "Kd" => material.kd = Some((colour(line, &words)?, line)),
            "Ke" => material.ke = Some((colour(line, &words)?, line)),
            "Ks" if colour(line, &words).is_ok_and(|c| c != [0.0; 3]) => {
                material.left_out.push("specular reflection (Ks)")
            }
            "map_Kd" => material.left_out.push("a texture (map_Kd)"),
            "map_Ke" => material.left_out.push("a texture (map_Ke)"),
            "d" if words.first().is_some_and(|w| w.parse() != Ok(1.0)) => material.left_out.push("transparency (d)"),
            "Tr" if words.first().is_some_and(|w| w.parse() != Ok(0.0)) => material.left_out.push("transparency (Tr)"),
            _ => {}
        }
    }
    Ok(materials)
}

/// Three numbers, or one for all three.
fn colour(line: usize, words: &[&str]) -> Result<[f64; 3], MeshFault> {
    match words {
        ["spectral" | "xyz", ..] => fault(line, "spectral and xyz colours are not read", "write three numbers: r g b"),
        [one] => Ok([number(line, one)?; 3]),
        [r, g, b] => Ok([number(line, r)?, number(line, g)?, number(line, b)?]),
        _ => fault(line, format!("a colour of {} numbers", words.len()), "write three numbers: r g b"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::At;
    use super::*;

    #[test]
    fn a_library_is_read() {
        let read =
            parse("# x\nnewmtl white wall\n Kd 0.7 0.6 0.5\n Ks 0 0 0\nnewmtl lamp\nKe 5\nmap_Kd a.png\n").unwrap();
        assert_eq!(read[0].name, "white wall");
        assert_eq!(read[0].kd, Some(([0.7, 0.6, 0.5], 3)));
        assert!(read[0].left_out.is_empty());
        assert_eq!(read[1].ke, Some(([5.0; 3], 6)));
        assert_eq!(read[1].left_out.len(), 1);
        assert_eq!(parse("Kd 1 1 1\n").unwrap_err().at, At::Line(1));
        assert_eq!(parse("newmtl a\nKd 1 red 1\n").unwrap_err().at, At::Line(2));
    }
}

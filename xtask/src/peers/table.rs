//! The measured lines, and their table.

/// One setting of one tool on one scene. What was not measured is missing, with a note that says why.
#[derive(Debug, Default)]
pub struct Row {
    pub scene: String,
    pub patches: String,
    pub tool: String,
    pub setting: String,
    pub seconds: Option<f64>,
    pub rms: Option<f64>,
    pub max: Option<f64>,
    pub note: String,
}

/// Reads what the helper wrote.
///
/// # Errors
/// A line with another number of columns, named.
pub fn read(csv: &str) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (k, line) in csv.lines().enumerate().skip(1) {
        let cells = cells(line);
        let [scene, patches, tool, setting, seconds, rms, max, _, note] = &cells[..] else {
            return Err(format!("line {} of the measurements has {} columns, not 9", k + 1, cells.len()));
        };
        rows.push(Row {
            scene: scene.clone(),
            patches: patches.clone(),
            tool: tool.clone(),
            setting: setting.clone(),
            seconds: seconds.parse().ok(),
            rms: rms.parse().ok(),
            max: max.parse().ok(),
            note: note.clone(),
        });
    }
    Ok(rows)
}

/// The cells of a line of CSV; quoted cells may hold commas and doubled quotes.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut letters = line.chars().peekable();
    while let Some(c) = letters.next() {
        let last = cells.len() - 1;
        match c {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cells[last].push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            _ => cells[last].push(c),
        }
    }
    cells
}

/// A table for each scene in the order of the run; tools that could not run stand below it.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = String::from("# Form factors: error against time\n");
    text.push_str("\nWall time in seconds, median; error over all entries of the matrix against exact values.\n");
    for scene in scenes(rows) {
        let here = || rows.iter().filter(|r| r.scene == scene);
        let patches = here().next().map_or("", |r| &r.patches);
        text.push_str(&format!("\n## {scene}, {patches} patches\n\n"));
        text.push_str("| tool | setting | s | RMS error | max error | note |\n| --- | --- | --- | --- | --- | --- |\n");
        for row in here().filter(|r| r.rms.is_some()) {
            let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.1e}"));
            let seconds = row.seconds.map_or_else(String::new, |s| format!("{s:.3}"));
            let (rms, max) = (number(row.rms), number(row.max));
            let words = [&row.tool, &row.setting, &seconds, &rms, &max, &row.note].map(|w| w.replace('|', "/"));
            text.push_str(&format!("| {} |\n", words.join(" | ")));
        }
        let absent: Vec<&Row> = here().filter(|r| r.rms.is_none()).collect();
        if !absent.is_empty() {
            text.push('\n');
        }
        for row in absent {
            let setting = if row.setting.is_empty() { String::new() } else { format!(", {}", row.setting) };
            text.push_str(&format!("- {}{setting}: {}\n", row.tool, row.note));
        }
    }
    text
}

/// The scenes in the order in which they first appear.
pub fn scenes(rows: &[Row]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.scene.as_str()) {
            names.push(&row.scene);
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    const CSV: &str = "scene,patches,tool,setting,seconds,rms,max,repeats,note\n\
        cube,96,etalon,\"rays, 16\",0.5,1e-4,2e-3,3,\n\
        cube,96,View3D,,,,,,\"not there: \"\"view3d\"\", no\"\n";

    #[test]
    fn what_could_not_run_is_said_and_not_a_zero() {
        let rows = read(CSV).unwrap();
        assert_eq!((rows[0].setting.as_str(), rows[0].rms, rows[1].rms), ("rays, 16", Some(1e-4), None));
        let text = markdown(&rows);
        assert!(text.contains("| etalon | rays, 16 | 0.500 | 1.0e-4 | 2.0e-3 |  |\n"), "{text}");
        assert!(text.contains("- View3D: not there: \"view3d\", no\n"), "{text}");
        assert!(read("head\na,b\n").unwrap_err().starts_with("line 2"));
    }
}

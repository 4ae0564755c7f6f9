//! The page of a record made by hand.

use super::pictures::groups;
use super::testing::{record, slow, unknown};
use super::*;
use crate::metrics::Verdict;
use crate::render::Raster;
use crate::report::chart::testing::without_library;
use crate::report::testing::{assert_well_formed, outside, shown};
use crate::study::compositing::EdgeRow;
use serde_json::{Value, json};
use std::collections::BTreeSet;

fn picture(name: &str) -> CompositingPicture {
    let raster = Raster { width: 2, height: 1, rgba: vec![255; 8] };
    CompositingPicture { name: name.into(), title: format!("the <i>{name}</i>"), raster }
}

/// In an order that is not that of the page; two have no place of their own.
fn pictures() -> Vec<CompositingPicture> {
    ["off", "edges-rays", "elsewhere", "edges-12", "rays", "edges-3", "shaded", "edges-1", "cloud"]
        .map(picture)
        .to_vec()
}

fn files(record: &CompositingRecord) -> Vec<Artifact> {
    let (pictures, timing) = (pictures(), [Phase { name: "audit".into(), seconds: 1.25 }]);
    compositing_files(record, &CompositingExtras { pictures: &pictures, timing: &timing }).expect("files")
}

/// Spaces before percent signs and units as they are typed.
fn page(record: &CompositingRecord) -> String {
    let files = files(record);
    assert_eq!(files[0].name, COMPOSITING_PAGE);
    String::from_utf8(files[0].bytes.clone()).expect("text").replace('\u{202f}', " ")
}

fn table(files: &[Artifact], stem: &str) -> Vec<csv::StringRecord> {
    let name = format!("{stem}.csv");
    let file = files.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("{name}"));
    csv::Reader::from_reader(file.bytes.as_slice()).into_records().map(|r| r.expect("a row")).collect()
}

/// What stands between two texts.
fn between<'a>(page: &'a str, from: &str, to: &str) -> &'a str {
    let begin = page.find(from).unwrap_or_else(|| panic!("{from}"));
    let end = page[begin..].find(to).unwrap_or_else(|| panic!("{to}"));
    &page[begin..begin + end]
}

/// Cells of every row of a table, without markup; what stands below a number comes after a slash.
fn cells(page: &str, label: &str) -> Vec<Vec<String>> {
    let body = between(between(page, &format!("aria-label=\"{label}\""), "</table>"), "<tbody>", "</tbody>");
    let words = |cell: &str| {
        let (mut out, mut rest) = (String::new(), cell.replace("<small>", " / "));
        while let Some((text, tag)) = rest.split_once('<') {
            out += text;
            rest = tag.split_once('>').expect("an end of the tag").1.to_string();
        }
        (out + &rest).trim().to_string()
    };
    let row =
        |row: &str| row.split("<td class=\"").skip(1).map(|c| words(c.split_once('>').expect("a cell").1)).collect();
    body.split("<tr>").skip(1).map(row).collect()
}

#[test]
fn verdict_facts_and_findings_are_there() {
    let record = record();
    let page = page(&record);
    assert!(page.contains(
        "<span class=\"word\">FAIL</span>Edges: 3.2 % off at 3 sub-scanlines of &quot;&lt;script&gt;&quot;. That is beyond \
         the limit of 2.5 %."
    ));
    let list = between(&page, "<dl class=\"facts\">", "</dl>");
    let facts = [
        "3.17 % (2.95 to 3.42 %)",
        "3",
        "2.5 %",
        "1.16",
        "1 of 2",
        "5.87 % (5.61 to 6.13 %)",
        "the same to the bit",
        "12,377",
        "1,320 \u{d7} 1,241 pixels",
    ];
    facts.iter().for_each(|fact| assert!(list.contains(&format!("<dd>{fact}</dd>")), "{fact}: {list}"));
    assert!(page.contains("\u{2212}0.46 % too dark") && page.contains(">limit 2.5 %</text>"));
    assert!(page.contains("The error falls with the power 1.16 of their number."));
    for (verdict, words) in [
        (Verdict::Pass, "That is within the limit of 2.5 %."),
        (Verdict::Inconclusive, "Whether that is within the limit of 2.5 % cannot be told"),
    ] {
        let record = CompositingRecord { verdict: Some(verdict), ..record.clone() };
        assert!(self::page(&record).contains(words));
    }
}

#[test]
fn names_stay_text_and_nothing_comes_from_outside() {
    let page = page(&record());
    assert!(page.contains("&lt;script&gt;alert(1)&lt;&#x2f;script&gt;") && !page.contains("<script>alert"));
    assert!(page.contains("town &lt;with&gt; &quot;names&quot; &amp; more") && !page.contains("<with>"));
    assert!(page.contains("the &lt;i&gt;shaded") && !page.contains("<i>"));
    assert!(page.contains("lamp &lt;b&gt; &amp; &quot;co&quot;") && page.contains("trees &amp; &lt;hedges&gt;"));
    assert!(page.contains("rays of the kernel embree &lt;4&gt;") && !page.contains("&amp;lt;"));
    assert_well_formed(&page);
    let page = without_library(&page);
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src=\"un"));
}

/// Known in words, column by column; what the clock says among them.
#[test]
fn tables_say_every_number_in_its_column() {
    let page = page(&record());
    let lights = cells(&page, "Lights");
    let lamp = [
        "lamp &lt;b&gt; &amp; &quot;co&quot; / polyhedron",
        "4,321",
        "3,210",
        "765",
        "346",
        "2.34 %",
        "1.79 %",
        "4.83 (7.61)",
        "1.17",
        "1,598",
        "0",
        "yes",
        "2.56",
        "819",
        "320",
    ];
    assert_eq!(lights[0], lamp);
    assert_eq!(
        (lights[1][0].as_str(), &lights[1][8..12]),
        ("sun / parallel", &["\u{2013}", "1,598", "57", "no"].map(String::from)[..])
    );
    assert!(
        page.contains("<span class=\"chip pass\">yes</span>") && page.contains("<span class=\"chip fail\">no</span>")
    );
    // 17.1 ms and the fraction of 98 golden ratios, 0.56733.
    assert_eq!(
        cells(&page, "Clusters")[1],
        ["trees &amp; &lt;hedges&gt;", "5,108", "2,208", "61,008", "940,008", "26.8"]
    );
    let one = cells(&page, "All in one against the whole");
    assert_eq!(one, [["2", "6", "yes", "3.14e-7 %", "1,777,333", "65.3"]]);
    let picture = cells(&page, "The picture against rays");
    let wanted = [
        ["5.87 % / 5.61 to 6.13 %", "1.93 %"],
        ["\u{2212}0.456 %", "\u{2013}"],
        ["14.7 %", "\u{2013}"],
        ["3", "1,024"],
        ["8.36 %", "100 %"],
        ["\u{2013}", "135,791,357"],
        ["7,654,321", "\u{2013}"],
        ["5", "\u{2013}"],
        ["1.87 s", "46.4 s"],
        ["\u{2013}", "111"],
        ["1.87 s", "5.03 s"],
    ];
    assert_eq!(picture.iter().map(|r| [r[1].as_str(), r[2].as_str()]).collect::<Vec<_>>(), wanted);
    // 4.3 ms and 31 ms with the fractions of 2 golden ratios, 0.23607.
    let edge = ["3", "1", "3.17 % / 2.95 to 3.42 %", "2.60 %", "22,017", "3,320,031", "38.3", "5.32"];
    assert_eq!(cells(&page, "Every scan")[1], edge);
    assert_eq!(cells(&page, "Every scan").len(), 6);
    let settings = between(&page, "aria-label=\"Settings\"", "</table>");
    for s in ["sun, lamp &lt;b&gt;", "1,024", "987654321", "1,320 \u{d7} 1,241 pixels", "2.5 %", "town &lt;with&gt;"] {
        assert!(settings.contains(s), "{s}");
    }
}

/// Every number below, but those under some names.
fn numbers(value: &Value, without: &[&str], out: &mut BTreeSet<u64>) {
    match value {
        Value::Number(x) => drop(out.insert(x.as_f64().expect("a number").to_bits())),
        Value::Array(all) => all.iter().for_each(|v| numbers(v, without, out)),
        Value::Object(all) => {
            all.iter().filter(|(k, _)| !without.contains(&k.as_str())).for_each(|(_, v)| numbers(v, without, out));
        }
        _ => {}
    }
}

/// To the last bit.
#[test]
fn tables_beside_charts_hold_every_number_of_the_lists() {
    let record = record();
    let files = files(&record);
    for (list, stem) in [(json!(record.edges), "antialiasing"), (json!(record.scaled), "scales")] {
        let (mut wanted, mut there) = (BTreeSet::new(), BTreeSet::new());
        // The series of the other chart are named by their sub-scanlines.
        let without: &[&str] = match stem {
            "scales" => &["scan_seconds", "draw_seconds", "sub_scanlines"],
            _ => &["scan_seconds", "draw_seconds", "scale"],
        };
        numbers(&list, without, &mut wanted);
        let rows = table(&files, stem);
        rows.iter().flatten().filter_map(|c| c.parse::<f64>().ok()).for_each(|x| _ = there.insert(x.to_bits()));
        let missing: Vec<f64> = wanted.difference(&there).map(|b| f64::from_bits(*b)).collect();
        assert!(wanted.len() > 15 && missing.is_empty(), "{stem}: {missing:?}");
    }
}

/// Each number in the row and column where it belongs; scale 1 stands in its place among the others.
#[test]
fn numbers_stand_in_their_rows_and_columns() {
    let record = record();
    let files = files(&record);
    let at = |row: &csv::StringRecord, k: usize| row[k].parse::<f64>().expect("a number");
    let of = |x: f64, r: &EdgeRow| {
        let [low, high] = r.error.interval;
        [x, r.error.value, low, high, r.off_by_a_step, r.segments as f64, r.bytes as f64]
    };
    let rows = table(&files, "antialiasing");
    assert_eq!(rows.len(), record.edges.len());
    for (row, r) in rows.iter().zip(&record.edges) {
        assert_eq!([1, 2, 3, 4, 5, 6, 7].map(|k| at(row, k)), of(f64::from(r.sub_scanlines), r));
    }
    let (e, s) = (&record.edges, &record.scaled);
    let wanted = [
        ("1 sub-scanline", &s[0]),
        ("1 sub-scanline", &e[0]),
        ("3 sub-scanlines", &s[1]),
        ("3 sub-scanlines", &e[1]),
        ("3 sub-scanlines", &s[2]),
    ];
    let rows = table(&files, "scales");
    assert_eq!(rows.len(), wanted.len());
    for (row, (name, r)) in rows.iter().zip(wanted) {
        assert_eq!(&row[0], name);
        assert_eq!([1, 2, 3, 4, 5, 6, 7].map(|k| at(row, k)), of(r.scale, r));
    }
}

/// The guide falls with the square of the number and stays within what is drawn.
#[test]
fn the_guide_is_of_second_order() {
    let drawn = |errors: [f64; 3]| {
        let mut r = record();
        r.edges.iter_mut().zip(errors).for_each(|(e, x)| e.error.value = x);
        let page = String::from_utf8(files(&r)[0].bytes.clone()).expect("text");
        let figure = between(&page, "id=\"antialiasing\"", "</figure>").to_string();
        let data = between(&figure, "<script type=\"application/json\">", "</script>").to_string();
        let data: Value = serde_json::from_str(data.split_once('>').expect("data").1).expect("JSON");
        data["series"][0]["fit"].clone()
    };
    let ends = |fit: &Value| ["x", "y"].map(|k| [0, 1].map(|i| fit[k][i].as_f64().expect("a number")));
    // Slower than the guide: it ends where the least error is. Faster: at the last number.
    for (errors, last, least) in [([0.09, 0.06, 0.0225], 2.0, 0.0225), ([0.81, 0.05, 0.001], 9.0, 0.01)] {
        let fit = drawn(errors);
        let [x, y] = ends(&fit);
        assert_eq!((x[0], y[0]), (1.0, errors[0]));
        assert!((x[1] - last).abs() < 1e-12 && (y[1] - least).abs() < 1e-12, "{x:?} {y:?}");
    }
    assert!(drawn([0.01, 0.02, 0.03]).is_null() && drawn([0.0; 3]).is_null());
}

/// What is not known is a dash, and is not zero; a page has no part of which there is nothing.
#[test]
fn nothing_known_is_a_dash_and_an_empty_record_has_a_page() {
    let r = unknown();
    let files = compositing_files(&r, &CompositingExtras { pictures: &[], timing: &[] }).expect("files");
    let page = std::str::from_utf8(&files[0].bytes).expect("text");
    assert_well_formed(page);
    assert_eq!(files.len(), 1);
    assert!(page.contains("NO LIMIT") && page.contains("none given") && !page.contains("Plotly"));
    let headings = ["What was found", "Edges", "Pictures"].map(|h| page.contains(&format!("<h2>{h}</h2>")));
    assert_eq!(headings, [false; 3]);
    assert!(!page.contains("<h3>Lights") && !page.contains("<h3>Clusters") && !page.contains("<h3>All in one"));
    let facts = between(page, "<dl class=\"facts\">", "</dl>");
    assert_eq!(facts.matches("<dd>\u{2013}</dd>").count(), 4, "{facts}");
    let picture = cells(page, "The picture against rays");
    assert_eq!((picture[9][2].as_str(), picture[10][2].as_str()), ("\u{2013}", "\u{2013}"));
}

#[test]
fn an_error_of_zero_is_shown_and_its_place_is_told() {
    let mut r = record();
    let place = "An error of 0 stands at the lower end.";
    assert!(!page(&r).contains(place));
    (r.edges[2].error.value, r.edges[2].error.interval) = (0.0, [0.0, 0.0015]);
    let page = page(&r);
    assert_eq!(page.matches(place).count(), 1);
    assert_eq!(cells(&page, "Every scan")[2][2], "0.000 % / 0.000 to 0.150 %");
    assert_eq!(&table(&files(&r), "antialiasing")[2][2], "0.0");
}

#[test]
fn pictures_stand_in_their_groups_each_once() {
    let all = pictures();
    let groups = groups(&all);
    let found: Vec<Vec<&str>> = (groups.iter())
        .map(|g| g.pictures.iter().flatten().filter_map(|p| p.file.strip_suffix(".png")).collect())
        .collect();
    let wanted: [&[&str]; 3] =
        [&["shaded", "rays", "off"], &["edges-1", "edges-3", "edges-12", "edges-rays"], &["elsewhere", "cloud"]];
    assert_eq!(found, wanted);
    let (page, files) = (page(&record()), files(&record()));
    let images: Vec<&str> = page.split("<img ").skip(1).map(|i| between(i, "alt=\"", "\">")).collect();
    let titles = found.iter().flatten().map(|n| format!("alt=\"{}", shown(&format!("the <i>{n}</i>"))));
    assert_eq!(images, titles.collect::<Vec<_>>());
    for p in &all {
        assert!(files.iter().any(|f| f.name == p.file() && f.bytes.starts_with(b"\x89PNG")), "{}", p.name);
    }
    let bad = CompositingPicture { raster: Raster { width: 3, height: 1, rgba: vec![0; 8] }, ..picture("off") };
    let files = compositing_files(&record(), &CompositingExtras { pictures: &[bad], timing: &[] });
    assert!(matches!(files, Err(ReportError::Image(_))));
}

#[test]
fn only_marked_blocks_depend_on_the_clock() {
    let (fast, slower) = (page(&record()), page(&slow()));
    assert_ne!(fast, slower);
    assert_eq!(outside(&fast), outside(&slower));
    assert_eq!(files(&record())[1..], files(&slow())[1..]);
    assert!(fast.contains("-->2.56<!--") && outside(&fast).contains("4.83 (7.61)"));
}

#[test]
fn drawings_are_xml_and_no_name_comes_twice() {
    let files = files(&record());
    let drawings: Vec<&Artifact> = files.iter().filter(|f| f.name.ends_with(".svg")).collect();
    for f in &drawings {
        roxmltree::Document::parse(std::str::from_utf8(&f.bytes).expect("text")).expect(&f.name);
    }
    assert_eq!(drawings.len(), 2);
    // What the command itself writes beside the page.
    let others = ["audit.json", "edges.csv", "lights.csv"].map(String::from);
    let names: BTreeSet<&String> = files.iter().map(|f| &f.name).chain(&others).collect();
    assert_eq!(names.len(), files.len() + others.len());
}

//! The page of a record made by hand.

use super::charts::reach;
use super::pictures::groups;
use super::testing::{record, unknown};
use super::*;
use crate::render::Raster;
use crate::report::chart::testing::without_library;
use crate::report::testing::{assert_well_formed, outside, shown};
use crate::study::envmap::PointRow;
use serde_json::{Value, json};
use std::collections::BTreeSet;

fn picture(name: &str) -> EnvmapPicture {
    let raster = Raster { width: 2, height: 1, rgba: vec![255; 8] };
    EnvmapPicture { name: name.into(), title: format!("the <i>{name}</i>"), raster }
}

/// In an order that is not that of the page; two have no place of their own.
fn pictures() -> Vec<EnvmapPicture> {
    let names = [
        "object-rays",
        "sphere-mirror-map",
        "sphere-diffuse-map",
        "sphere-diffuse-off",
        "elsewhere",
        "world-extra",
        "footprints-quad",
        "world-latlong",
        "object-map",
        "world-cube",
        "sphere-other-map",
        "object-off",
        "object-hybrid",
        "world-diffuse",
        "footprints-ellipse",
    ];
    names.map(picture).to_vec()
}

fn files(record: &EnvmapRecord) -> Vec<Artifact> {
    let (pictures, timing) = (pictures(), [Phase { name: "audit".into(), seconds: 1.25 }]);
    envmap_files(record, &EnvmapExtras { pictures: &pictures, timing: &timing }).expect("files")
}

fn page(record: &EnvmapRecord) -> String {
    let files = files(record);
    assert_eq!(files[0].name, ENVMAP_PAGE);
    String::from_utf8(files[0].bytes.clone()).expect("text")
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

#[test]
fn verdict_facts_and_findings_are_there() {
    let record = record();
    let page = page(&record);
    assert!(page.contains(
        "<span class=\"word\">FAIL</span>Irradiance over &quot;&lt;script&gt;&quot; is wrong by \u{2212}1.5"
    ));
    assert!(page.contains("That is beyond the limit of 7\u{202f}%."));
    let facts = [
        "12.34 % (12.00 to 12.80 %)",
        "-4.56 %",
        "7 %",
        "1,234",
        "faces of 256 \u{d7} 256 texels",
        "40 \u{d7} 20",
        "2, the first at (0.5, -1.25, 0.75) m",
        "16,384",
        "reference <solution>",
        "5.5 %: 0.679 m from the centre (surely 0.457 m, at most 2.25 m or farther)",
    ];
    let list = between(&page, "<dl class=\"facts\">", "</dl>").replace('\u{202f}', " ");
    for fact in facts {
        assert!(list.contains(&format!("<dd>{}</dd>", shown(fact).replace('\u{202f}', " "))), "{fact}");
    }
    assert!(page.contains(&shown(&record.findings[1])));
    assert!(page.contains("(0.5, \u{2212}1.25, 0.75) m, (1.5, 2, 0.8) m") && page.contains("At 95 %, from the spread"));
    assert!(page.contains("stated error 5.5 %</text>") && page.contains(">limit 7 %</text>"));
}

#[test]
fn parts_have_errors_intervals_shares_and_bars() {
    let page = page(&record());
    let table = between(&page, "<table class=\"causes\">", "</table>").replace('\u{202f}', " ");
    let rows = [
        ("c0", "1.170 %", "1.130 to 1.220 %", "8.62", "3.10 %"),
        ("c1", "13.58 %", "13.17 to 13.99 %", "100.00", "120 %"),
        ("c2", "2.46 %", "2.21 to 2.75 %", "18.11", "\u{2212}23.5 %"),
        ("whole", "12.34 %", "12.00 to 12.80 %", "90.87", "100 %"),
    ];
    for (class, error, interval, length, share) in rows {
        let row = between(&table, &format!("<span class=\"swatch {class}\">"), "</tr>");
        assert!(row.contains(&format!("<span class=\"big\">{error}</span><small>{interval}</small>")), "{row}");
        assert!(row.contains(&format!("<rect class=\"{class}\" width=\"{length}\"")), "{row}");
        assert!(row.ends_with(&format!("<td class=\"num\">{share}</td>")), "{row}");
    }
}

#[test]
fn names_stay_text_and_nothing_comes_from_outside() {
    let page = page(&record());
    assert!(page.contains("&lt;script&gt;alert(1)&lt;&#x2f;script&gt;") && !page.contains("<script>alert"));
    assert!(page.contains("room &lt;with&gt; &quot;names&quot; &amp; more") && !page.contains("<with>"));
    assert!(page.contains("the &lt;i&gt;world-cube") && !page.contains("<i>"));
    assert_well_formed(&page);
    let page = without_library(&page);
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src=\"un"));
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

/// To the last bit, and none of the lists is left out.
#[test]
fn tables_beside_charts_hold_every_number_of_the_lists() {
    let record = record();
    let files = files(&record);
    let lists: [(Value, &[&str]); 10] = [
        (json!(record.range.curve), &["range"]),
        (json!(record.by_distance), &["by-distance"]),
        (json!(record.points), &["point-by-point"]),
        (json!(record.reflection), &["reflection"]),
        (json!(record.filters), &["filter-box-1", "filter-box-4", "filter-ewa-1", "filter-ewa-4"]),
        (json!(record.sizes), &["cube-size"]),
        (json!(record.tables), &["table-size"]),
        (json!(record.several), &["centres"]),
        (json!(record.hybrid), &["hybrid"]),
        (json!(record.round_trips), &["round-trip"]),
    ];
    for (list, stems) in lists {
        let (mut wanted, mut there) = (BTreeSet::new(), BTreeSet::new());
        numbers(&list, &["place", "normal", "centre", "stretch", "seconds", "exact_seconds"], &mut wanted);
        wanted.remove(&0f64.to_bits());
        for stem in stems {
            let cells =
                table(&files, stem).into_iter().flat_map(|row| row.iter().map(str::to_string).collect::<Vec<_>>());
            there.extend(cells.filter_map(|c| c.parse::<f64>().ok()).map(f64::to_bits));
        }
        let missing: Vec<f64> = wanted.difference(&there).map(|b| f64::from_bits(*b)).collect();
        assert!(wanted.len() > 5 && missing.is_empty(), "{stems:?}: {missing:?}");
    }
}

/// Each number in the row and column where it belongs.
#[test]
fn numbers_stand_in_their_rows_and_columns() {
    let record = record();
    let files = files(&record);
    let rows = |stem: &str, name: &str| {
        table(&files, stem).into_iter().filter(|r| &r[0] == name).collect::<Vec<csv::StringRecord>>()
    };
    let at = |row: &csv::StringRecord, k: usize| row[k].parse::<f64>().ok();
    let names = ["total", "map", "parallax", "object"];
    for (stem, list) in
        [("range", &record.range.curve), ("reflection", &record.reflection), ("centres", &record.several)]
    {
        for (k, name) in names.iter().enumerate() {
            let part = |a: &crate::study::envmap::At| {
                let p = &a.parts;
                [p.total, p.map, p.parallax, p.occlusion][k]
            };
            let known: Vec<_> = list.iter().filter(|a| part(a).is_some()).collect();
            let rows = rows(stem, name);
            assert_eq!(rows.len(), known.len(), "{stem} {name}");
            for (row, a) in rows.iter().zip(known) {
                let e = part(a).expect("known");
                let wanted =
                    [Some(a.x), Some(e.value), e.std_err, Some(e.low), Some(e.high), Some(a.parts.points as f64)];
                assert_eq!([1, 2, 3, 4, 5, 6].map(|k| at(row, k)), wanted, "{stem} {name}");
                let of = |j: usize| k.checked_sub(1).filter(|p| *p == j).map(|_| a.parts.shares[j]);
                let share = (0..3).find_map(of);
                assert_eq!([at(row, 7), at(row, 8)], [share, (k == 0).then_some(a.parts.bias)], "{stem} {name}");
            }
        }
    }
    let poles = rows("filter-ewa-4", "lat-long, near the poles");
    let wanted = record.filters.iter().filter(|f| f.filter == "ewa" && f.stretch == 4.0 && f.layout == "lat-long");
    assert_eq!(poles.len(), 3);
    poles.iter().zip(wanted).for_each(|(r, f)| assert_eq!((at(r, 1), at(r, 2)), (Some(f.width), f.near_poles)));
    for (row, h) in table(&files, "hybrid").iter().zip(&record.hybrid) {
        let e = h.total.expect("an error");
        assert_eq!([at(row, 0), at(row, 1), at(row, 3), at(row, 4)], [h.reach, e.value, e.low, e.high].map(Some));
    }
}

#[test]
fn points_are_coloured_by_centre_and_the_worst_stand_at_the_end() {
    let mut record = record();
    record.points[0].map = 5.0 * record.points[0].truth;
    record.points[2].truth = 0.0;
    let rows = table(&files(&record), "point-by-point");
    assert_eq!(rows.len(), record.points.len() - 1);
    let of = |p: &PointRow| rows.iter().find(|r| r[3] == p.patch.to_string());
    for p in record.points.iter().filter(|p| p.truth > 0.0) {
        let row = of(p).expect("a row");
        assert_eq!(
            (&row[0], &row[4]),
            (format!("centre {}", p.centre + 1).as_str(), (p.centre + 1).to_string().as_str())
        );
        let off: f64 = row[5].parse().expect("a number");
        assert!((off * p.truth - (p.map - p.truth)).abs() < 1e-12);
        assert_eq!(row[2].parse::<f64>().expect("a number"), off.min(2.0));
    }
    let page = page(&record);
    assert!(of(&record.points[2]).is_none() && page.contains("1 without any light are left out."));
    assert!(page.contains("1 beyond 200\u{202f}% stand at the upper end."));
}

/// What is not known is a dash, has no point in any chart, and is not zero.
#[test]
fn nothing_known_is_a_dash() {
    let record = unknown();
    let page = page(&record);
    assert_well_formed(&page);
    assert!(page.contains("NO LIMIT") && page.contains("none given"));
    let parts = between(&page, "<table class=\"causes\">", "</table>");
    assert_eq!((parts.matches('\u{2013}').count(), parts.matches('%').count()), (8, 0));
    let facts = between(&page, "<dl class=\"facts\">", "</dl>");
    assert_eq!(facts.matches("<dd>\u{2013}</dd>").count() + facts.matches(": \u{2013}</dd>").count(), 3, "{facts}");
    let stems: Vec<String> =
        files(&record).iter().filter_map(|f| f.name.strip_suffix(".csv").map(String::from)).collect();
    assert_eq!(stems, ["filter-box-1", "filter-ewa-1", "filter-box-4", "filter-ewa-4", "round-trip"]);
}

#[test]
fn one_number_unknown_leaves_one_point_out() {
    let mut record = record();
    record.by_distance[1].parts.parallax = None;
    record.sizes[0].table = None;
    let files = files(&record);
    let count = |stem: &str, name: &str| table(&files, stem).iter().filter(|r| &r[0] == name).count();
    assert_eq!(["total", "map", "parallax", "object"].map(|n| count("by-distance", n)), [3, 3, 2, 3]);
    assert_eq!(count("cube-size", "through the table of 40 \u{d7} 20"), 2);
}

/// The object of a convex body is exactly 0: that is a number, not a dash.
#[test]
fn an_error_of_zero_is_shown_and_its_place_is_told() {
    let mut record = record();
    record.irradiance.occlusion = Some(crate::stats::Estimate::exact(0.0));
    assert!(!page(&record).contains("An error of 0 stands"));
    record.by_distance.iter_mut().for_each(|a| a.parts.occlusion = Some(crate::stats::Estimate::exact(0.0)));
    let page = page(&record);
    assert_eq!(page.matches("An error of 0 stands at the lower end.").count(), 1);
    let row = between(between(&page, "<table class=\"causes\">", "</table>"), "swatch c2", "</tr>");
    assert!(row.contains("<span class=\"big\">0\u{202f}%</span></td>") && row.contains("width=\"0.00\""), "{row}");
    let rows = table(&files(&record), "by-distance");
    assert_eq!(rows.iter().filter(|r| &r[0] == "object" && &r[2] == "0.0").count(), 3);
}

#[test]
fn an_empty_record_has_a_page() {
    let mut r = unknown();
    (r.by_distance, r.points, r.reflection, r.filters) = (vec![], vec![], vec![], vec![]);
    (r.sizes, r.tables, r.several, r.hybrid, r.round_trips) = (vec![], vec![], vec![], vec![], vec![]);
    (r.range.curve, r.centres, r.findings, r.speed) = (vec![], vec![], vec![], vec![]);
    let files = envmap_files(&r, &EnvmapExtras { pictures: &[], timing: &[] }).expect("files");
    let page = std::str::from_utf8(&files[0].bytes).expect("text");
    assert_well_formed(page);
    assert!(
        files.len() == 1 && !page.contains("Plotly") && !page.contains("<h2>Pictures") && !page.contains("wall-clock")
    );
}

#[test]
fn the_distance_in_words() {
    let mut r = record().range;
    let (x, last) = (Some(0.5), Some(2.25));
    let mut words = |within, surely, at_most| {
        (r.within, r.between) = (within, [surely, at_most]);
        reach(&r)
    };
    assert_eq!(words(x, None, Some(0.75)), "0.500 m from the centre (surely nowhere, at most 0.750 m)");
    assert_eq!(
        words(last, x, last),
        "2.25 m or farther, the farthest tried (surely 0.500 m, at most 2.25 m or farther)"
    );
    let nowhere = "nowhere: exceeded from the first distance on (surely nowhere, at most 0.500 m)";
    assert_eq!(words(None, None, x), nowhere);
    r.curve.clear();
    assert_eq!(reach(&r), "\u{2013}");
}

#[test]
fn pictures_stand_in_their_groups_each_once() {
    let all = pictures();
    let groups = groups(&all);
    let found: Vec<Vec<Option<&str>>> = (groups.iter())
        .map(|g| g.pictures.iter().map(|p| p.as_ref().and_then(|p| p.file.strip_suffix(".png"))).collect())
        .collect();
    let wanted: [&[Option<&str>]; 5] = [
        &[Some("world-cube"), Some("world-latlong"), Some("world-diffuse"), Some("world-extra")],
        &[Some("footprints-quad"), Some("footprints-ellipse")],
        // Row by row; nothing is drawn by rays.
        &[Some("sphere-diffuse-map"), None, Some("sphere-mirror-map"), Some("sphere-diffuse-off"), None, None],
        &[Some("object-map"), Some("object-hybrid"), Some("object-rays"), Some("object-off")],
        &[Some("elsewhere"), Some("sphere-other-map")],
    ];
    assert_eq!(found, wanted);
    assert_eq!(found.iter().flatten().flatten().count(), all.len());
    let (page, files) = (page(&record()), files(&record()));
    let images: Vec<&str> = page.split("<img ").skip(1).map(|i| between(i, "alt=\"", "\">")).collect();
    let titles = found.iter().flatten().flatten().map(|n| format!("alt=\"{}", shown(&format!("the <i>{n}</i>"))));
    assert_eq!(images, titles.collect::<Vec<_>>());
    for p in &all {
        assert!(files.iter().any(|f| f.name == p.file() && f.bytes.starts_with(b"\x89PNG")), "{}", p.name);
    }
}

#[test]
fn only_marked_blocks_depend_on_the_clock() {
    let slow = {
        let mut r = record();
        r.filters.iter_mut().for_each(|f| (f.seconds, f.exact_seconds) = (3.7 * f.seconds, 5.1 * f.exact_seconds));
        r.speed.iter_mut().for_each(|s| s.seconds *= 3.0);
        r
    };
    let (fast, slower) = (page(&record()), page(&slow));
    assert_ne!(fast, slower);
    assert_eq!(outside(&fast), outside(&slower));
    assert_eq!(files(&record())[1..], files(&slow)[1..]);
    let table = between(&fast, "aria-label=\"Fast filters\"", "</table>").replace('\u{202f}', " ");
    let row = "<td class=\"num big\">1.23 %</td><td class=\"num\">4.56 %</td>\n<td class=\"num\">78.9 %</td>\
               <td class=\"num\">2.50</td><td class=\"num\">1000</td><td class=\"num\">400</td>";
    assert!(table.contains(row), "{table}");
    let speed = "<td>cube</td><td class=\"num\">393,216</td><td class=\"num\">0.500</td><td class=\"num\">786,432</td>";
    assert!(fast.contains(speed));
}

#[test]
fn drawings_are_xml() {
    let files = files(&record());
    let drawings: Vec<&Artifact> = files.iter().filter(|f| f.name.ends_with(".svg")).collect();
    for f in &drawings {
        roxmltree::Document::parse(std::str::from_utf8(&f.bytes).expect("text")).expect(&f.name);
    }
    assert_eq!(drawings.len(), 13);
    assert_eq!(files.iter().map(|f| &f.name).collect::<BTreeSet<_>>().len(), files.len(), "a name comes twice");
}

use super::testing::chart;
use super::*;

const ATTACK: &str = "</script><b>x</b>&\"%{y} <!--";

#[test]
fn all_that_is_asked_for_is_drawn() {
    let svg = chart("mine").svg().expect("a drawing");
    let parts =
        ["noise of the reference: 0.100 %", "stroke-dasharray=\"7 5\"", "slope \u{2212}1.00", ">0</text>", "mine"];
    for part in parts {
        assert!(svg.contains(part), "{part}\n{svg}");
    }
    assert_eq!(svg.matches("M0 ").count(), 0);
    // Four marks say what they are; the legend's does not.
    assert_eq!(svg.matches("<title>").count(), 1 + 4 + 1, "{svg}");
}

/// Every drawing is XML, whatever a method is called, and the name comes back out of it.
#[test]
fn a_drawing_is_xml_and_a_name_stays_text() {
    let mut all = vec![chart(ATTACK)];
    all.push(Chart { title: ATTACK.into(), ..chart("bell\u{7}") });
    let mut labelled = chart("dots");
    labelled.series[0].shape = Shape::Dots;
    labelled.series[0].dots[2].label = Some(ATTACK.into());
    all.push(labelled);
    for (k, c) in all.iter().enumerate() {
        let svg = c.svg().expect("a drawing");
        let xml = roxmltree::Document::parse(&svg).unwrap_or_else(|e| panic!("{e}: {svg}"));
        assert!(xml.descendants().all(|n| !n.has_tag_name("script") && !n.has_tag_name("b")));
        let found = xml.descendants().any(|n| n.is_text() && n.text() == Some(ATTACK));
        assert_eq!(found, k != 1 || xml.descendants().any(|n| n.text() == Some(ATTACK)), "{svg}");
    }
}

#[test]
fn the_table_holds_every_point_to_the_bit() {
    let mut c = chart(ATTACK);
    c.series[0].dots[1].y = 0.1 + 0.2;
    c.series[0].dots[2].interval = Some((0.04, f64::MAX));
    let bytes = c.csv();
    let mut table = csv::Reader::from_reader(bytes.as_slice());
    let head: Vec<String> = table.headers().expect("a head").iter().map(String::from).collect();
    assert_eq!(head, ["series", "shots", "rms", "rms_std_err", "rms_low", "rms_high", "rays"]);
    let rows: Vec<csv::StringRecord> = table.records().map(|r| r.expect("a row")).collect();
    assert_eq!(rows.len(), 4);
    for (row, d) in rows.iter().zip(&c.series[0].dots) {
        assert_eq!(&row[0], ATTACK);
        let read = |k: usize| row[k].parse::<f64>().expect("a number");
        assert_eq!(
            (read(1), read(2), read(3), read(4), read(6)),
            (
                d.x,
                d.y,
                0.02 * chart("").series[0].dots.iter().find(|e| e.x == d.x).expect("the same").y,
                d.interval.expect("an interval").0,
                64.0 * d.x
            )
        );
    }
    assert_eq!(&rows[2][5], "", "an interval without end has no number there");
}

#[test]
fn the_data_of_the_script_are_those_of_the_table_and_end_no_element() {
    let c = chart(ATTACK);
    let data = c.data();
    assert!(!data.contains('<'), "{data}");
    let read: serde_json::Value = serde_json::from_str(&data).expect("json");
    assert_eq!(read["series"][0]["name"], ATTACK);
    for (k, d) in c.series[0].dots.iter().enumerate() {
        let s = &read["series"][0];
        assert_eq!((s["x"][k].as_f64(), s["y"][k].as_f64()), (Some(d.x), Some(d.y)));
        assert_eq!((s["low"][k].as_f64(), s["text"][k].as_str()), (Some(0.95 * d.y), Some(d.hint.as_str())));
    }
}

#[test]
fn labels_do_not_cover_each_other() {
    let mut c = chart("");
    let dot = c.series[0].dots[1].clone();
    let at = |k: u32| Dot { x: 1.0 + 1e-3 * f64::from(k), label: Some("the same place".into()), ..dot.clone() };
    c.series[0].dots = (0..30).map(at).collect();
    c.series[0].shape = Shape::Dots;
    let shown = c.svg().expect("a drawing").matches("class=\"tag\"").count();
    assert!((1..=10).contains(&shown), "{shown}");
}

#[test]
fn a_throng_is_one_path_and_nothing_is_no_drawing() {
    let mut c = chart("");
    c.series[0].fit = None;
    let dot = c.series[0].dots[1].clone();
    c.series[0].shape = Shape::Dots;
    c.series[0].dots = vec![dot; 500];
    let svg = c.svg().expect("a drawing");
    assert!(!svg.contains("<circle") && svg.matches("h0").count() == 1);
    c.series[0].dots.clear();
    assert!(c.svg().is_none() && Block::of(&c).is_none());
    let mut free = chart("");
    free.series[0].dots.truncate(1);
    assert!(free.svg().is_none(), "a single point at no cost has no place on a logarithmic axis");
}

#[test]
fn no_library_without_charts_and_its_notice_with_them() {
    assert!(Library::for_charts(false).is_none());
    let library = Library::for_charts(true).expect("a library");
    assert!(library.notice.starts_with("plotly.js 4.1.1") && library.notice.contains("Permission is hereby granted"));
    assert!(!library.notice.contains("--") && !library.notice.contains("three.js"));
    for script in [library.plotly, library.code] {
        assert!(!script.to_lowercase().contains("</script"));
    }
}

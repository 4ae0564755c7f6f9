//! What pages of audits have around their charts and tables: verdict, facts and findings above, the program below.

use super::format::{percent_exact, significant};
use super::html::context::minus;
use super::{Phase, chart};
use crate::metrics::Verdict;

/// Templates that such a page includes; `page` has what they show, `styles` the names of further styles.
pub(super) const TEMPLATES: [(&str, &str); 9] = [
    ("head.html", include_str!("frame/head.html.j2")),
    ("findings.html", include_str!("frame/findings.html.j2")),
    ("pictures.html", include_str!("frame/pictures.html.j2")),
    ("foot.html", include_str!("frame/foot.html.j2")),
    ("audit.css", include_str!("audit/page/audit.css")),
    ("style.css", include_str!("html/page/style.css")),
    ("macros.html", include_str!("html/page/macros.html.j2")),
    chart::TEMPLATE,
    chart::STYLE,
];

/// What was found first, and what becomes of the limit.
pub(super) fn sentence(findings: &[String], verdict: Option<Verdict>, limit: Option<f64>) -> String {
    let limit = match (verdict, limit.map(percent_exact)) {
        (Some(Verdict::Pass), Some(l)) => format!(" That is within the limit of {l}."),
        (Some(Verdict::Fail), Some(l)) => format!(" That is beyond the limit of {l}."),
        (Some(Verdict::Inconclusive), Some(l)) => {
            format!(" Whether that is within the limit of {l} cannot be told from this truth.")
        }
        _ => String::new(),
    };
    let first = findings.first().map_or("", String::as_str);
    let stop = if limit.is_empty() || first.ends_with('.') { "" } else { "." };
    minus(&format!("{first}{stop}{limit}"))
}

/// Phases with their times.
pub(super) fn timing(phases: &[Phase]) -> Vec<(&str, String)> {
    phases.iter().map(|p| (p.name.as_str(), format!("{} s", significant(p.seconds, 3)))).collect()
}

/// The program that wrote the page.
pub(super) fn program() -> String {
    format!("etalon {}", env!("CARGO_PKG_VERSION"))
}

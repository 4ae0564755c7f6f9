//! JUnit: one test case for each limit.

use super::asked::Level;
use super::format::{percent_exact, printable};
use super::headline::{headline, limit_reason};
use super::lines::{worst_lines, worst_title};
use super::{Artifact, Exporter, Extras, ReportError};
use crate::metrics::{LimitOutcome, Verdict};
use crate::study::Record;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

/// JUnit XML: a limit that is kept passes, one that is exceeded fails, an open one is skipped with a message.
#[derive(Debug, Clone, Copy, Default)]
pub struct JUnit;

impl Exporter for JUnit {
    fn export(&self, record: &Record, _: &Extras) -> Result<Vec<Artifact>, ReportError> {
        let limits = record.decision.as_ref().map(|d| &d.limits).ok_or(ReportError::NoVerdict)?;
        let mut suite = TestSuite::new(printable(&record.stage.name));
        suite.add_property(("solution", printable(&record.solution_name).as_str()));
        suite.add_property(("truth", record.truth.as_str()));
        suite.add_property(("replay", printable(&record.replay).as_str()));
        suite.add_test_cases(limits.iter().map(|l| case(record, l)));
        let mut report = Report::new("etalon check");
        report.add_test_suite(suite);
        Ok(vec![Artifact::new("junit.xml", report.to_string()?)])
    }
}

fn case(record: &Record, limit: &LimitOutcome) -> TestCase {
    let name = format!("{} within {}", limit.metric, percent_exact(limit.limit));
    let reason = limit_reason(record, limit);
    let mut status = match limit.verdict {
        Verdict::Pass => TestCaseStatus::success(),
        Verdict::Fail => TestCaseStatus::non_success(NonSuccessKind::Failure),
        Verdict::Inconclusive => TestCaseStatus::skipped(),
    };
    if limit.verdict != Verdict::Pass {
        status.set_message(reason.as_str());
    }
    if limit.verdict == Verdict::Fail {
        status.set_type("limit exceeded");
        status.set_description(details(record));
    }
    let mut case = TestCase::new(name, status);
    case.set_classname(printable(&record.stage.name));
    if limit.verdict == Verdict::Pass {
        case.set_system_out(reason);
    }
    case
}

/// What helps to find the cause: the sentence, the worst patches, the command.
fn details(record: &Record) -> String {
    let mut lines = vec![headline(record).sentence];
    lines.extend(record.causes.first().map(|c| format!("The likely cause: {}", c.sentence)));
    lines.extend([String::new(), worst_title(record)]);
    let noun = Level::of(record).noun();
    lines.extend(worst_lines(record).iter().map(|w| {
        format!(
            "  {noun} {} ({}): reference {}, solution {}, difference {}",
            w.number, w.surface, w.reference, w.solution, w.difference
        )
    }));
    lines.extend([String::new(), format!("Replay: {}", record.replay)]);
    lines.iter().map(|l| printable(l)).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{record, with_verdict};

    fn xml(record: &Record) -> String {
        let files = JUnit.export(record, &Extras::default()).expect("junit");
        String::from_utf8(files[0].bytes.clone()).expect("utf-8")
    }

    #[test]
    fn fail_is_a_failure_open_is_skipped_pass_passes() {
        let fail = xml(&with_verdict(Verdict::Fail));
        assert!(fail.contains(r#"failures="1""#) && fail.contains("<failure message="), "{fail}");
        assert!(fail.contains("beyond the limit of 1 %") && fail.contains("Replay: "), "{fail}");
        let open = xml(&with_verdict(Verdict::Inconclusive));
        assert!(open.contains(r#"failures="0""#) && open.contains(r#"<skipped message=""#), "{open}");
        assert!(open.contains("about 130 times the rays"), "{open}");
        let pass = xml(&with_verdict(Verdict::Pass));
        assert!(!pass.contains("<failure") && !pass.contains("<skipped"), "{pass}");
        assert!(pass.contains(r#"<testcase name="rms within 5 %" classname="little room""#), "{pass}");
    }

    #[test]
    fn names_stay_text_and_no_clock_is_read() {
        let mut r = with_verdict(Verdict::Fail);
        r.stage.name = "<a & \"b\">\u{1b}[0m".into();
        let text = xml(&r);
        assert!(text.contains("&lt;a &amp; &quot;b&quot;&gt;\u{fffd}[0m"), "{text}");
        assert!(!text.contains("timestamp") && !text.contains("time="), "{text}");
        assert_eq!(text, xml(&r));
    }

    #[test]
    fn without_a_verdict_there_is_nothing_to_say() {
        let mut r = record();
        r.decision = None;
        assert!(matches!(JUnit.export(&r, &Extras::default()), Err(ReportError::NoVerdict)));
    }
}

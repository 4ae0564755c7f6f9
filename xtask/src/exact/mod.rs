//! Form factors of obstructed pairs to ten digits and more, independent of the library.
//!
//! Read from a text of one word and numbers a line: `patch` and `plate` with the corners of a convex polygon (patches
//! are one-sided and hide nothing, plates are opaque and receive nothing), `solid` and its `face` lines (closed,
//! convex, counter-clockwise seen from outside), `pair I J`, `row I`, `all` or `brute I J`. Written:
//! `i j F_ij error F_ji error`, the two from separate integrals over patch i and over patch j; `all` takes the second
//! by reciprocity, and `brute` computes both the second way, of `brute`.

mod body;
mod brute;
mod events;
mod geometry;
mod pair;
mod quadrature;
mod visible;

use body::Body;
use geometry::{Vector, area};
use pair::form_factor;
use quadrature::Integral;
use std::io::{Read, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Asked of every integral, as a part of the form factor's unit.
const TOLERANCE: f64 = 1e-12;
/// Asked of the second way: far less than it has to reach, since an estimate that knows of no kinks can miss one.
const BRUTE_TOLERANCE: f64 = 1e-12;
const BRUTE_QUADS: usize = 20_000;

/// Reads the scene and what is asked from standard input and writes the form factors to standard output.
///
/// # Errors
/// A line that cannot be understood, or an output that cannot be written; named by its number.
pub fn run(threads: usize) -> Result<(), String> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).map_err(|e| format!("standard input cannot be read: {e}"))?;
    let scene = Scene::read(&text)?;
    let results = scene.answer(threads);
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for (ask, (there, back)) in scene.asked.iter().zip(results) {
        let line = [there.value, there.error, back.value, back.error].map(|x| format!("{x:.17e}")).join(" ");
        writeln!(out, "{} {} {line}", ask.from, ask.to).map_err(|e| format!("nothing can be written: {e}"))?;
    }
    out.flush().map_err(|e| format!("nothing can be written: {e}"))
}

#[derive(Clone, Copy)]
struct Ask {
    from: usize,
    to: usize,
    how: How,
}

#[derive(Clone, Copy)]
enum How {
    BothWays,
    OneWay,
    Brute,
}

#[derive(Default)]
struct Scene {
    patches: Vec<Vec<Vector>>,
    bodies: Vec<Body>,
    asked: Vec<Ask>,
}

impl Scene {
    fn read(text: &str) -> Result<Self, String> {
        let mut scene = Self::default();
        let mut faces: Option<Vec<Vec<Vector>>> = None;
        for (k, line) in text.lines().enumerate() {
            let at = |e: String| format!("line {}: {e}", k + 1);
            let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
            if word != "face"
                && let Some(closed) = faces.take()
            {
                scene.bodies.push(Body::solid(closed).map_err(at)?);
            }
            match word {
                "patch" => scene.patches.push(corners(rest).map_err(at)?),
                "plate" => scene.bodies.push(Body::plate(&corners(rest).map_err(at)?)),
                "solid" => faces = Some(Vec::new()),
                "face" => {
                    let open = faces.as_mut().ok_or_else(|| at("a face without a solid".into()))?;
                    open.push(corners(rest).map_err(at)?);
                }
                "pair" | "row" | "all" | "brute" => scene.ask(word, &whole_numbers(rest).map_err(at)?).map_err(at)?,
                "" | "#" => {}
                other => return Err(at(format!("'{other}' is not a word of this text"))),
            }
        }
        if let Some(closed) = faces {
            scene.bodies.push(Body::solid(closed)?);
        }
        Ok(scene)
    }

    fn ask(&mut self, word: &str, numbers: &[usize]) -> Result<(), String> {
        let n = self.patches.len();
        if let Some(high) = numbers.iter().find(|&&i| i >= n) {
            return Err(format!("there is no patch {high}, only {n} so far"));
        }
        match (word, numbers) {
            ("pair", &[from, to]) => self.asked.push(Ask { from, to, how: How::BothWays }),
            ("brute", &[from, to]) => self.asked.push(Ask { from, to, how: How::Brute }),
            ("row", &[from]) => self.asked.extend((0..n).map(|to| Ask { from, to, how: How::BothWays })),
            ("all", &[]) => {
                let below = (0..n).flat_map(|i| (i + 1..n).map(move |j| Ask { from: i, to: j, how: How::OneWay }));
                self.asked.extend(below);
            }
            _ => return Err(format!("'{word}' does not go with {} numbers", numbers.len())),
        }
        Ok(())
    }

    /// Answers in the order asked; the threads share the work, not the results.
    fn answer(&self, threads: usize) -> Vec<(Integral, Integral)> {
        let next = AtomicUsize::new(0);
        let done = Mutex::new(vec![(Integral::default(), Integral::default()); self.asked.len()]);
        std::thread::scope(|scope| {
            for _ in 0..threads.max(1) {
                scope.spawn(|| {
                    loop {
                        let k = next.fetch_add(1, Ordering::Relaxed);
                        let Some(&ask) = self.asked.get(k) else { break };
                        let result = self.pair(ask);
                        done.lock().expect("no thread panics while it stores")[k] = result;
                    }
                });
            }
        });
        done.into_inner().expect("all threads have ended")
    }

    fn pair(&self, ask: Ask) -> (Integral, Integral) {
        let (p, q) = (&self.patches[ask.from], &self.patches[ask.to]);
        if ask.from == ask.to {
            return Default::default();
        }
        if let How::Brute = ask.how {
            let brute = |a, b| brute::form_factor(a, b, &self.bodies, BRUTE_TOLERANCE, BRUTE_QUADS);
            return (brute(p, q), brute(q, p));
        }
        let there = form_factor(p, q, &self.bodies, TOLERANCE);
        let back = if let How::BothWays = ask.how {
            form_factor(q, p, &self.bodies, TOLERANCE)
        } else {
            let ratio = area(p) / area(q);
            Integral { value: there.value * ratio, error: there.error * ratio }
        };
        (there, back)
    }
}

fn corners(text: &str) -> Result<Vec<Vector>, String> {
    let numbers = text.split_whitespace().map(|w| w.parse().map_err(|_| format!("'{w}' is not a number")));
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
    if numbers.len() < 9 || !numbers.len().is_multiple_of(3) {
        return Err(format!("{} numbers are no polygon: three for each of three corners or more", numbers.len()));
    }
    Ok(numbers.chunks(3).map(|c| [c[0], c[1], c[2]]).collect())
}

fn whole_numbers(text: &str) -> Result<Vec<usize>, String> {
    text.split_whitespace().map(|w| w.parse().map_err(|_| format!("'{w}' is not a patch number"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_is_unknown_is_named_with_its_line() {
        let message = Scene::read("# two\npach 0 0 0").err().unwrap();
        assert_eq!(message, "line 2: 'pach' is not a word of this text");
    }

    #[test]
    fn rows_of_a_cube_with_a_box_close() {
        let quad = |c: [[f64; 3]; 4]| c.iter().flatten().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let face = |axis: usize, high: bool, lo: f64, hi: f64, outward: bool| {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut corners = [[if high { hi } else { lo }; 3]; 4];
            for (k, [a, b]) in [[lo, lo], [hi, lo], [hi, hi], [lo, hi]].into_iter().enumerate() {
                corners[k][u] = a;
                corners[k][v] = b;
            }
            if high != outward {
                corners.reverse();
            }
            quad(corners)
        };
        let sides = || (0..3).flat_map(|a| [(a, false), (a, true)]);
        let mut text: Vec<String> = Vec::new();
        text.extend(sides().map(|(a, h)| format!("patch {}", face(a, h, 0.0, 1.0, false))));
        text.extend(sides().map(|(a, h)| format!("patch {}", face(a, h, 0.3, 0.7, true))));
        text.push("solid".into());
        text.extend(sides().map(|(a, h)| format!("face {}", face(a, h, 0.3, 0.7, true))));
        text.extend(["row 0".into(), "row 7".into()]);
        let scene = Scene::read(&text.join("\n")).unwrap();
        let results = scene.answer(2);
        for row in results.chunks(12) {
            let sum: f64 = row.iter().map(|(there, _)| there.value).sum();
            assert!((sum - 1.0).abs() < 1e-11, "{sum}");
        }
    }
}

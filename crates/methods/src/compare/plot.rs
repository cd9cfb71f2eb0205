//! A comparison as a drawing: triangles and seconds of every strategy, as bars on logarithmic scales.

use super::{ComparedRow, Comparison};
use chordal_nurbs::math;
use std::fmt::Write;

const ROW: f64 = 22.0;
const LEFT: f64 = 190.0;
const PANEL: f64 = 330.0;
const GAP: f64 = 110.0;
const TOP: f64 = 64.0;

/// A quantity to be drawn.
struct Panel {
    title: &'static str,
    left: f64,
    value: fn(&ComparedRow) -> f64,
    label: fn(&ComparedRow) -> String,
}

const PANELS: [Panel; 2] = [
    Panel {
        title: "triangles (over the fewest possible)",
        left: LEFT,
        value: |r| r.triangles as f64,
        label: |r| format!("{} ({:.2})", r.triangles, r.ratio),
    },
    Panel {
        title: "seconds",
        left: LEFT + PANEL + GAP,
        value: |r| r.seconds,
        label: |r| format!("{:.3}", r.seconds),
    },
];

/// The comparison as SVG. Writing to a string cannot fail, so results of `write!` are dropped.
pub fn plot(comparison: &Comparison) -> String {
    let height = TOP + ROW * comparison.rows.len() as f64 + 16.0;
    let width = LEFT + 2.0 * PANEL + 2.0 * GAP;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    let title = format!("{}, tolerance {:.4} mm", comparison.model, comparison.tolerance);
    let _ = writeln!(out, "<text x=\"8\" y=\"20\" font-size=\"14\">{}</text>", escaped(&title));
    for (i, row) in comparison.rows.iter().enumerate() {
        let y = TOP + ROW * i as f64 + 14.0;
        let name = format!("{}, {}", row.strategy, row.bound);
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{y}\" text-anchor=\"end\">{}</text>",
            LEFT - 8.0,
            escaped(&name)
        );
    }
    for panel in &PANELS {
        bars(&mut out, panel, &comparison.rows);
    }
    out.push_str("</svg>\n");
    out
}

fn bars(out: &mut String, panel: &Panel, rows: &[ComparedRow]) {
    let values = rows.iter().map(panel.value).filter(|&v| v > 0.0);
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
    // Decades around all values, so that every bar has a length.
    let (from, to) = (math::log10(low).floor() - 0.3, math::log10(high).ceil());
    let x = |v: f64| panel.left + PANEL * (math::log10(v) - from) / (to - from).max(1.0);
    let _ = writeln!(out, "<text x=\"{}\" y=\"44\">{}</text>", panel.left, panel.title);
    let bottom = TOP + ROW * rows.len() as f64;
    if low.is_finite() {
        for decade in math::log10(low).floor() as i32..=to as i32 {
            let at = x(math::powi(10.0, decade));
            let _ = writeln!(
                out,
                "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"#ccc\"/>\
                 <text x=\"{at:.1}\" y=\"{}\" fill=\"#777\" font-size=\"10\" \
                 text-anchor=\"middle\">{}</text>",
                TOP - 4.0,
                math::powi(10.0, decade)
            );
        }
    }
    for (i, row) in rows.iter().enumerate() {
        let value = (panel.value)(row);
        if value <= 0.0 {
            continue;
        }
        let y = TOP + ROW * i as f64 + 3.0;
        let colour = if row.bound == "proven" { "#2b6cb0" } else { "#dd9933" };
        let end = x(value);
        let _ = writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{y}\" width=\"{:.1}\" height=\"{}\" fill=\"{colour}\"/>\
             <text x=\"{:.1}\" y=\"{}\">{}</text>",
            panel.left,
            end - panel.left,
            ROW - 7.0,
            end + 4.0,
            y + 11.0,
            (panel.label)(row)
        );
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_long_as_their_logarithms() {
        let row = |triangles| ComparedRow {
            triangles,
            seconds: 0.5,
            bound: "proven".into(),
            ..ComparedRow::default()
        };
        let comparison =
            Comparison { model: "a<b".into(), rows: vec![row(10), row(1000)], ..Comparison::default() };
        let svg = plot(&comparison);
        let widths: Vec<f64> = svg
            .split("<rect x=\"190.0\"")
            .skip(1)
            .filter_map(|s| s.split("width=\"").nth(1)?.split('"').next()?.parse().ok())
            .collect();
        assert_eq!(widths.len(), 2);
        // From 10^0.7 to 10^3: the first ends after 0.3 of 2.3 decades, the second at the end.
        assert!((widths[0] / widths[1] - 0.3 / 2.3).abs() < 1e-3, "{widths:?}");
        assert!(svg.contains("a&lt;b") && svg.ends_with("</svg>\n"));
    }
}

//! Pictures as text. Colours of ink come from the page's style, so that they follow light and dark; colours that carry a
//! value are fixed, with the text on them chosen by their lightness.

use super::html::escape;

/// Where a text is anchored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Left end.
    Start,
    /// Middle.
    Middle,
    /// Right end.
    End,
}

/// A picture in the making.
pub struct Picture {
    width: f64,
    height: f64,
    body: String,
}

impl Picture {
    /// Empty.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new() }
    }

    /// A line of a class of the style sheet.
    pub fn line(&mut self, class: &str, from: (f64, f64), to: (f64, f64)) {
        self.body += &format!(
            "<line class=\"{class}\" x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\"/>\n",
            from.0, from.1, to.0, to.1
        );
    }

    /// A rectangle of a class; a negative width reaches to the left.
    pub fn bar(&mut self, class: &str, x: f64, y: f64, width: f64, height: f64) {
        let x = x.min(x + width);
        self.body += &format!(
            "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{height:.1}\"/>\n",
            width.abs()
        );
    }

    /// A rectangle of a fixed colour with a note that shows under the pointer.
    pub fn cell(&mut self, colour: &str, at: (f64, f64), size: (f64, f64), note: &str) {
        self.body += &format!(
            "<rect fill=\"{colour}\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"><title>{}</title></rect>\n",
            at.0,
            at.1,
            size.0,
            size.1,
            escape(note)
        );
    }

    /// A point.
    pub fn dot(&mut self, class: &str, at: (f64, f64), radius: f64) {
        self.body += &format!("<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\"/>\n", at.0, at.1);
    }

    /// Text of a class.
    pub fn text(&mut self, class: &str, anchor: Anchor, at: (f64, f64), text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.body += &format!(
            "<text class=\"{class}\" text-anchor=\"{anchor}\" x=\"{:.1}\" y=\"{:.1}\">{}</text>\n",
            at.0,
            at.1,
            escape(text)
        );
    }

    /// Text on a fixed colour.
    pub fn text_on(&mut self, colour: [u8; 3], at: (f64, f64), text: &str) {
        let class = if lightness(colour) > 0.5 { "small on-light" } else { "small on-dark" };
        self.text(class, Anchor::Middle, at, text);
    }

    /// Text that runs upwards at an angle, degrees.
    pub fn slanted(&mut self, class: &str, at: (f64, f64), degrees: f64, text: &str) {
        self.body += &format!(
            "<text class=\"{class}\" transform=\"translate({:.1} {:.1}) rotate({})\">{}</text>\n",
            at.0,
            at.1,
            -degrees,
            escape(text)
        );
    }

    /// The finished picture; `alternative` is read to those who do not see it.
    pub fn finish(self, alternative: &str) -> String {
        let (width, height, body) = (self.width, self.height, self.body);
        let alternative = escape(alternative);
        format!(
            "<svg role=\"img\" aria-label=\"{alternative}\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
             height=\"{height:.0}\">\n{body}</svg>"
        )
    }
}

/// As CSS writes it.
pub fn hex(colour: [u8; 3]) -> String {
    format!("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2])
}

/// Relative luminance's rough square root: above one half, black is read better than white.
fn lightness(colour: [u8; 3]) -> f64 {
    let [r, g, b] = colour.map(|part| f64::from(part) / 255.0);
    0.299 * r + 0.587 * g + 0.114 * b
}

/// Between colours that stand at equal distances, `share` from 0 to 1.
pub fn blend(stops: &[[u8; 3]], share: f64) -> [u8; 3] {
    let last = stops.len() - 1;
    let at = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) } * last as f64;
    let first = (at as usize).min(last.saturating_sub(1));
    let part = at - first as f64;
    let next = stops[(first + 1).min(last)];
    std::array::from_fn(|i| (f64::from(stops[first][i]) * (1.0 - part) + f64::from(next[i]) * part).round() as u8)
}

/// Three to seven round numbers that cover a range.
pub fn ticks(least: f64, most: f64) -> Vec<f64> {
    let length = most - least;
    if !(length > 0.0 && length.is_finite()) {
        return vec![least];
    }
    let rough = length / 5.0;
    let decade = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|s| *s >= rough).unwrap_or(rough);
    let first = (least / step).ceil() as i64;
    (first..first + 12).map(|k| k as f64 * step).take_while(|tick| *tick <= most + 1e-9 * step).collect()
}

/// A tick's number without needless digits.
pub fn tick_label(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

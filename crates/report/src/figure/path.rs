//! SVG path data in tenths of a pixel, relative and without a spare character.

/// Largest coordinate, px; larger ones are drawn here, far outside any plot, and small enough for
/// every renderer.
const MAX_COORDINATE: f64 = 1e5;

/// Path data under construction. Rounding does not add up: every step is the difference of
/// two rounded places.
#[derive(Debug, Default)]
pub(crate) struct Path {
    data: String,
    at: (i64, i64),
    /// Where the outline started: the pen is there again after closing it.
    start: (i64, i64),
    last: char,
    /// Places visited.
    pub vertices: usize,
}

fn tenths(px: f64) -> i64 {
    (px.clamp(-MAX_COORDINATE, MAX_COORDINATE) * 10.0).round() as i64
}

impl Path {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    pub fn into_data(self) -> String {
        self.data
    }

    /// Lifts the pen and sets it down at a place (px).
    pub fn move_to(&mut self, x: f64, y: f64) {
        let (x, y) = (tenths(x), tenths(y));
        // A first `m` is absolute, the pairs after it are relative all the same.
        self.command('m', &[x - self.at.0, y - self.at.1]);
        self.at = (x, y);
        self.start = (x, y);
    }

    /// Draws to a place (px). A step that rounds to nothing is left out.
    pub fn line_to(&mut self, x: f64, y: f64) {
        let (x, y) = (tenths(x), tenths(y));
        let (dx, dy) = (x - self.at.0, y - self.at.1);
        match (dx, dy) {
            // Where the pen has just been set down, even a step of no length is a mark.
            (0, 0) if self.last == 'm' => self.command('h', &[0]),
            (0, 0) => return,
            (dx, 0) => self.command('h', &[dx]),
            (0, dy) => self.command('v', &[dy]),
            _ => self.command('l', &[dx, dy]),
        }
        self.at = (x, y);
    }

    /// A dot: a line of no length, which round caps make visible.
    pub fn dot(&mut self, x: f64, y: f64) {
        self.move_to(x, y);
        self.command('h', &[0]);
    }

    /// Closes the outline.
    pub fn close(&mut self) {
        self.data.push('z');
        self.last = 'z';
        self.at = self.start;
    }

    fn command(&mut self, command: char, tenths: &[i64]) {
        self.vertices += 1;
        // Pairs after `m` are lines: the letter may be left out where it repeats.
        let implied = match self.last {
            'm' => 'l',
            other => other,
        };
        let mut start = self.data.len();
        if command != implied {
            self.data.push(command);
            start = self.data.len();
        }
        self.last = command;
        for value in tenths {
            let sign = if *value < 0 { "-" } else { "" };
            let (whole, tenth) = (value.abs() / 10, value.abs() % 10);
            let number = match (whole, tenth) {
                (whole, 0) => format!("{sign}{whole}"),
                (0, tenth) => format!("{sign}.{tenth}"),
                (whole, tenth) => format!("{sign}{whole}.{tenth}"),
            };
            let joined = self.data.ends_with(|c: char| c.is_ascii_digit());
            if joined && !number.starts_with('-') && (self.data.len() > start || command == implied)
            {
                self.data.push(' ');
            }
            self.data.push_str(&number);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compact_but_unambiguous() {
        let mut path = Path::new();
        path.move_to(10.0, 20.0);
        path.line_to(10.5, 19.7);
        path.line_to(10.5, 30.0);
        path.line_to(12.0, 30.0);
        path.line_to(13.0, 30.04);
        path.line_to(14.0, 31.0);
        path.line_to(15.0, 32.0);
        path.close();
        path.dot(1.0, 1.0);
        path.dot(2.0, 1.0);
        assert_eq!(
            path.into_data(),
            "m10 20 .5-.3v10.3h1.5 1l1 1 1 1zm-9-19h0m1 0h0"
        );
    }

    #[test]
    fn far_places_stay_finite() {
        let mut path = Path::new();
        path.move_to(-1e300, 1e300);
        path.line_to(f64::INFINITY, f64::NEG_INFINITY);
        assert_eq!(path.into_data(), "m-100000 100000 200000-200000");
    }

    /// What a reader of SVG 2, section 9.3 draws: every place, with whether the pen was down.
    fn read(data: &str) -> Vec<(bool, f64, f64)> {
        let mut places = Vec::new();
        let (mut x, mut y, mut start) = (0.0, 0.0, (0.0, 0.0));
        let mut command = ' ';
        let mut rest = data;
        let number = |rest: &mut &str| -> f64 {
            *rest = rest.trim_start();
            let mut dots = 0;
            let end = rest[1..]
                .find(|c: char| {
                    dots += usize::from(c == '.');
                    !(c.is_ascii_digit() || c == '.')
                        || dots + usize::from(rest.starts_with(['.'])) > 1
                })
                .map_or(rest.len(), |end| end + 1);
            let value = rest[..end].parse().unwrap();
            *rest = &rest[end..];
            value
        };
        while !rest.trim_start().is_empty() {
            rest = rest.trim_start();
            let letter = rest.chars().next().unwrap();
            let mut implicit = true;
            if letter.is_ascii_alphabetic() {
                (command, implicit, rest) = (letter, false, &rest[1..]);
            }
            match command {
                'm' => {
                    (x, y) = (x + number(&mut rest), y + number(&mut rest));
                    if !implicit {
                        start = (x, y);
                    }
                    places.push((implicit, x, y));
                    continue;
                }
                'l' => (x, y) = (x + number(&mut rest), y + number(&mut rest)),
                'h' => x += number(&mut rest),
                'v' => y += number(&mut rest),
                'z' => (x, y) = start,
                other => panic!("{other} in {data}"),
            }
            places.push((true, x, y));
        }
        places
    }

    proptest::proptest! {
        #[test]
        fn a_reader_of_svg_finds_every_place(
            steps in proptest::collection::vec((0_u8..8, -400_i32..400, -30_i32..30), 0..60)
        ) {
            let mut path = Path::new();
            let mut expected = Vec::new();
            let mut start = (0.0, 0.0);
            path.move_to(0.0, 0.0);
            expected.push((false, 0.0, 0.0));
            for (kind, x, y) in steps {
                let (x, y) = (f64::from(x) / 10.0, f64::from(y) / 10.0);
                match kind {
                    0 => {
                        path.move_to(x, y);
                        expected.push((false, x, y));
                        start = (x, y);
                    }
                    1 => {
                        path.close();
                        expected.push((true, start.0, start.1));
                    }
                    _ => {
                        // A step of no length is only written after a move.
                        let (down, px, py) = *expected.last().unwrap();
                        path.line_to(x, y);
                        if !(down && (px, py) == (x, y)) {
                            expected.push((true, x, y));
                        }
                    }
                }
            }
            let found = read(&path.into_data());
            proptest::prop_assert_eq!(found.len(), expected.len());
            for (f, e) in found.iter().zip(&expected) {
                proptest::prop_assert_eq!(f.0, e.0);
                proptest::prop_assert!((f.1 - e.1).abs() < 1e-9 && (f.2 - e.2).abs() < 1e-9);
            }
        }
    }
}

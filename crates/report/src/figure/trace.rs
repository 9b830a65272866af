//! Long lines reduced to what a screen can show.
//!
//! Samples that follow one another inside one pixel column become the lowest and the highest of them
//! (two points), so that no peak is lost. A line that is still long after that (a path that goes back
//! and forth, such as many friction loops) is drawn as the set of pixels it covers.

use super::path::Path;

/// A place in the plot in px, or a break in the line.
pub(crate) type Place = Option<(f64, f64)>;

/// Most points of a path drawn point by point: about 100 kB of path data.
const MAX_VERTICES: usize = 12_000;
/// Size of the cells in which an even longer path is drawn, in px.
const CELL_SIZE: f64 = 1.0;
/// Most breaks of a line kept inside one pixel column.
const MAX_BREAKS_PER_COLUMN: usize = 4;

/// A drawn line.
#[derive(Debug)]
pub(crate) enum Trace {
    /// Path data to stroke.
    Path(String),
    /// Path data of horizontal runs to stroke with the width of a cell.
    Cells(String),
}

/// Draws `places` in a plot of `width` by `height` px.
pub(crate) fn trace(places: impl Iterator<Item = Place> + Clone, width: f64, height: f64) -> Trace {
    let clip = Clip {
        width,
        height,
        margin: 8.0,
    };
    let mut path = Path::new();
    let mut pen = Pen::default();
    for place in Columns::new(places.clone()) {
        pen.step(place, &clip, &mut path);
        if path.vertices > MAX_VERTICES {
            return Trace::Cells(cover(Columns::new(places), width, height));
        }
    }
    pen.step(None, &clip, &mut path);
    Trace::Path(path.into_data())
}

/// Merges runs of places in one pixel column.
struct Columns<I> {
    places: I,
    column: Option<Column>,
    ready: [Place; 5],
    next: usize,
    count: usize,
    done: bool,
}

struct Column {
    index: f64,
    points: usize,
    breaks: usize,
    broken: bool,
    first: (f64, f64),
    low: (usize, (f64, f64)),
    high: (usize, (f64, f64)),
    last: (f64, f64),
}

impl Column {
    fn new(p: (f64, f64)) -> Self {
        let (index, breaks) = (p.0.floor(), 0);
        Self {
            index,
            points: 1,
            breaks,
            broken: false,
            first: p,
            low: (0, p),
            high: (0, p),
            last: p,
        }
    }

    fn add(&mut self, p: (f64, f64)) {
        if p.1 < self.low.1.1 {
            self.low = (self.points, p);
        }
        if p.1 > self.high.1.1 {
            self.high = (self.points, p);
        }
        self.last = p;
        self.points += 1;
    }
}

impl<I: Iterator<Item = Place>> Columns<I> {
    fn new(places: I) -> Self {
        Self {
            places,
            column: None,
            ready: [None; 5],
            next: 0,
            count: 0,
            done: false,
        }
    }

    fn put(&mut self, place: Place) {
        self.ready[self.count] = place;
        self.count += 1;
    }

    fn flush(&mut self) {
        let Some(column) = self.column.take() else {
            return;
        };
        let (early, late) = if column.low.0 <= column.high.0 {
            (column.low, column.high)
        } else {
            (column.high, column.low)
        };
        if column.points <= 4 {
            self.put(Some(column.first));
            if early.0 > 0 && early.0 + 1 < column.points {
                self.put(Some(early.1));
            }
            if late.0 > early.0 && late.0 + 1 < column.points {
                self.put(Some(late.1));
            }
            if column.points > 1 {
                self.put(Some(column.last));
            }
        } else {
            // Where they are: in the middle of the column a steep line would become a staircase.
            self.put(Some(early.1));
            self.put(Some(late.1));
        }
        if column.broken {
            self.put(None);
        }
    }
}

impl<I: Iterator<Item = Place>> Iterator for Columns<I> {
    type Item = Place;

    fn next(&mut self) -> Option<Place> {
        loop {
            if self.next < self.count {
                self.next += 1;
                return Some(self.ready[self.next - 1]);
            }
            if self.done {
                return None;
            }
            (self.next, self.count) = (0, 0);
            match (self.places.next(), self.column.as_mut()) {
                (None, _) => {
                    self.flush();
                    self.done = true;
                }
                (Some(None), Some(column)) => {
                    column.broken = true;
                    column.breaks += 1;
                }
                (Some(None), None) => {}
                (Some(Some(p)), Some(column)) if column.index == p.0.floor() => {
                    if column.broken && column.breaks <= MAX_BREAKS_PER_COLUMN {
                        let breaks = column.breaks;
                        self.flush();
                        self.column = Some(Column {
                            breaks,
                            ..Column::new(p)
                        });
                    } else {
                        column.broken = false;
                        column.add(p);
                    }
                }
                (Some(Some(p)), _) => {
                    self.flush();
                    self.column = Some(Column::new(p));
                }
            }
        }
    }
}

struct Clip {
    width: f64,
    height: f64,
    margin: f64,
}

impl Clip {
    /// On which sides of the plot a place lies outside.
    fn outside(&self, (x, y): (f64, f64)) -> u8 {
        u8::from(x < -self.margin)
            | u8::from(x > self.width + self.margin) << 1
            | u8::from(y < -self.margin) << 2
            | u8::from(y > self.height + self.margin) << 3
    }
}

/// Writes the segments that can be seen.
#[derive(Default)]
struct Pen {
    at: Place,
    down: bool,
}

impl Pen {
    fn step(&mut self, to: Place, clip: &Clip, path: &mut Path) {
        match (self.at, to) {
            (Some(from), Some(to)) => {
                let visible = clip.outside(from) & clip.outside(to) == 0;
                if visible {
                    if !self.down {
                        path.move_to(from.0, from.1);
                    }
                    path.line_to(to.0, to.1);
                }
                self.down = visible;
                self.at = Some(to);
                return;
            }
            // A sample between two breaks.
            (Some(alone), None) if !self.down && clip.outside(alone) == 0 => {
                path.dot(alone.0, alone.1);
            }
            _ => {}
        }
        self.at = to;
        self.down = false;
    }
}

/// The cells that a line touches, as horizontal runs.
fn cover(places: impl Iterator<Item = Place>, width: f64, height: f64) -> String {
    let mut cells = Cells::new(width, height, CELL_SIZE);
    let mut before: Place = None;
    for place in places {
        if let Some(to) = place {
            cells.line(before.unwrap_or(to), to);
        }
        before = place;
        if cells.free == 0 {
            break;
        }
    }
    cells.runs()
}

struct Cells {
    columns: usize,
    rows: usize,
    size: f64,
    set: Vec<bool>,
    free: usize,
}

impl Cells {
    fn new(width: f64, height: f64, size: f64) -> Self {
        let columns = (width / size).ceil().max(1.0) as usize;
        let rows = (height / size).ceil().max(1.0) as usize;
        Self {
            columns,
            rows,
            size,
            set: vec![false; columns * rows],
            free: columns * rows,
        }
    }

    fn line(&mut self, from: (f64, f64), to: (f64, f64)) {
        let (w, h) = (self.columns as f64, self.rows as f64);
        let scaled = |p: (f64, f64)| (p.0 / self.size, p.1 / self.size);
        let Some((from, to)) = cut(scaled(from), scaled(to), w, h) else {
            return;
        };
        let steps = (to.0 - from.0)
            .abs()
            .max((to.1 - from.1).abs())
            .ceil()
            .max(1.0);
        for i in 0..=steps as usize {
            let t = i as f64 / steps;
            let x = (from.0 + t * (to.0 - from.0)).clamp(0.0, w - 1.0) as usize;
            let y = (from.1 + t * (to.1 - from.1)).clamp(0.0, h - 1.0) as usize;
            let cell = &mut self.set[y * self.columns + x];
            self.free -= usize::from(!*cell);
            *cell = true;
        }
    }

    fn runs(&self) -> String {
        let mut path = Path::new();
        for row in 0..self.rows {
            let cells = &self.set[row * self.columns..][..self.columns];
            let y = (row as f64 + 0.5) * self.size;
            let mut start = 0;
            while let Some(offset) = cells[start..].iter().position(|c| *c) {
                let from = start + offset;
                let length = cells[from..].iter().take_while(|c| **c).count();
                path.move_to(from as f64 * self.size, y);
                path.line_to((from + length) as f64 * self.size, y);
                start = from + length;
            }
        }
        path.into_data()
    }
}

/// The part of a segment inside 0..w, 0..h (Liang and Barsky, 1984).
fn cut(a: (f64, f64), b: (f64, f64), w: f64, h: f64) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-dx, a.0), (dx, w - a.0), (-dy, a.1), (dy, h - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            enter = enter.max(q / p);
        } else {
            leave = leave.min(q / p);
        }
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    (enter <= leave).then(|| (at(enter), at(leave)))
}

#[cfg(test)]
mod tests;

//! Clouds of points: single dots while they are few, a density map when they are many.

use super::path::Path;
use super::trace::Place;

/// Most dots drawn one by one: about 100 kB of path data.
const MAX_DOTS: usize = 3000;
/// Most runs of cells; with more, larger cells are taken.
const MAX_RUNS: usize = 15_000;
/// Opacity of cells by the number of points in them: 1, 2 to 3, 4 to 9, 10 to 29, 30 and more.
const OPACITIES: [(usize, f64); 5] = [(1, 0.28), (2, 0.42), (4, 0.58), (10, 0.76), (30, 1.0)];

/// A drawn cloud.
#[derive(Debug)]
pub(crate) enum Cloud {
    /// Path data of dots, to stroke with round caps.
    Dots(String),
    /// Cells of a size (px) as horizontal runs, by opacity.
    Density(f64, Vec<(f64, String)>),
}

/// Draws `places` in a plot of `width` by `height` px; every point that can be seen has a mark.
pub(crate) fn cloud(places: impl Iterator<Item = Place> + Clone, width: f64, height: f64) -> Cloud {
    let inside =
        |p: &(f64, f64)| (-4.0..width + 4.0).contains(&p.0) && (-4.0..height + 4.0).contains(&p.1);
    let mut dots = Path::new();
    let mut count = 0;
    for (x, y) in places.clone().flatten().filter(inside) {
        count += 1;
        if count > MAX_DOTS {
            return density(places.flatten().filter(inside), width, height);
        }
        dots.dot(x, y);
    }
    Cloud::Dots(dots.into_data())
}

fn density(points: impl Iterator<Item = (f64, f64)> + Clone, width: f64, height: f64) -> Cloud {
    let mut size = 2.0;
    loop {
        let levels = map(points.clone(), width, height, size);
        let runs: usize = levels.iter().map(|(_, path)| path.vertices / 2).sum();
        if runs <= MAX_RUNS || size > 30.0 {
            let drawn = levels.into_iter().filter(|(_, path)| !path.is_empty());
            return Cloud::Density(size, drawn.map(|(o, path)| (o, path.into_data())).collect());
        }
        size += 1.0;
    }
}

fn map(
    points: impl Iterator<Item = (f64, f64)>,
    width: f64,
    height: f64,
    size: f64,
) -> Vec<(f64, Path)> {
    let columns = (width / size).ceil().max(1.0) as usize;
    let rows = (height / size).ceil().max(1.0) as usize;
    let mut counts = vec![0_usize; columns * rows];
    for (x, y) in points {
        let column = ((x / size).max(0.0) as usize).min(columns - 1);
        let row = ((y / size).max(0.0) as usize).min(rows - 1);
        counts[row * columns + column] += 1;
    }
    let level = |count: usize| OPACITIES.iter().rposition(|(least, _)| count >= *least);
    let mut paths: Vec<(f64, Path)> = OPACITIES.iter().map(|(_, o)| (*o, Path::new())).collect();
    for row in 0..rows {
        let cells = &counts[row * columns..][..columns];
        let y = (row as f64 + 0.5) * size;
        let mut start = 0;
        while start < columns {
            let here = level(cells[start]);
            let length = cells[start..]
                .iter()
                .take_while(|c| level(**c) == here)
                .count();
            if let Some(level) = here {
                let path = &mut paths[level].1;
                path.move_to(start as f64 * size, y);
                path.line_to((start + length) as f64 * size, y);
            }
            start += length;
        }
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_are_dots_at_their_place() {
        let places = [Some((1.0, 2.0)), None, Some((3.5, 2.0)), Some((1e6, 2.0))];
        let Cloud::Dots(data) = cloud(places.into_iter(), 10.0, 10.0) else {
            panic!()
        };
        assert_eq!(data, "m1 2h0m2.5 0h0");
    }

    #[test]
    fn a_large_cloud_is_small_and_keeps_a_lone_outlier() {
        let many = (0..2_000_000_u64).map(|i| {
            let r = i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 16;
            Some((
                (r % 4000) as f64 * 0.1,
                60.0 + (r / 4000 % 500) as f64 * 0.1,
            ))
        });
        let places = many.chain([Some((300.0, 11.0))]);
        let Cloud::Density(size, levels) = cloud(places, 800.0, 200.0) else {
            panic!()
        };
        assert_eq!(size, 2.0);
        let bytes: usize = levels.iter().map(|(_, data)| data.len()).sum();
        assert!(bytes < 20_000, "{bytes}");
        assert_eq!(
            levels[0],
            (0.28, "m300 11h2".into()),
            "the faintest level is the outlier"
        );
    }

    #[test]
    fn scattered_noise_is_bounded() {
        let noise = (0..3_000_000_u64).map(|i| {
            let r = i
                .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                .rotate_left(23)
                .wrapping_mul(0xd1b5);
            Some((
                (r >> 44 & 0xfff) as f64 / 4.0,
                (r >> 20 & 0xfff) as f64 / 8.0,
            ))
        });
        let Cloud::Density(_, levels) = cloud(noise, 1024.0, 512.0) else {
            panic!()
        };
        let bytes: usize = levels.iter().map(|(_, data)| data.len()).sum();
        assert!(bytes < 200_000, "{bytes}");
    }
}

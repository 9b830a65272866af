//! From samples to nodes.

use super::{BLOCK, KEPT, RESTART, REVERSE, SAMPLE, Segment, Time, Track};
use crate::Error;
use std::ops::Range;
use std::sync::OnceLock;

/// Largest magnitude of a velocity, force or column: squares and products of two of them, summed over any
/// record, stay finite.
const LARGEST_INPUT: f64 = 1e100;

/// One node before it is written to the channels of the track.
struct Node {
    speed: f64,
    half_step: f64,
    sign: f64,
    marks: u8,
}

pub(super) fn build(segments: &[Segment]) -> Result<Track, Error> {
    let columns = segments.first().map_or(0, |s| s.columns.len());
    let mut track = Track {
        speed: Vec::new(),
        half_step: Vec::new(),
        sign: Vec::new(),
        marks: Vec::new(),
        force: Vec::new(),
        columns: vec![Vec::new(); columns],
        ln_speed: OnceLock::new(),
        samples: 0,
        kept: 0,
    };
    // Most records have few reversals, each of which may add a node.
    let samples: usize = segments.iter().map(|s| s.velocity.len()).sum();
    reserve(&mut track, samples + samples / 16 + BLOCK);
    for (index, segment) in segments.iter().enumerate() {
        check(index, segment, columns)?;
        append(&mut track, index, segment)?;
    }
    while !track.speed.len().is_multiple_of(BLOCK) {
        push(&mut track, Node::still(1.0, 0), None);
    }
    Ok(track)
}

fn reserve(track: &mut Track, nodes: usize) {
    let known = [&mut track.speed, &mut track.half_step, &mut track.force];
    for channel in known.into_iter().chain(&mut track.columns) {
        channel.reserve(nodes);
    }
    track.sign.reserve(nodes);
    track.marks.reserve(nodes);
}

impl Node {
    fn still(sign: f64, marks: u8) -> Self {
        Node {
            speed: 0.0,
            half_step: 0.0,
            sign,
            marks,
        }
    }
}

fn check(index: usize, segment: &Segment, columns: usize) -> Result<(), Error> {
    let n = segment.velocity.len();
    let same = |channel, found, expected| {
        if found == expected {
            return Ok(());
        }
        Err(Error::Length {
            segment: index,
            channel,
            found,
            expected,
        })
    };
    if let Time::At(time) = segment.time {
        same("time", time.len(), n)?;
    }
    same("force", segment.force.len(), n)?;
    if !segment.keep.is_empty() {
        same("keep", segment.keep.len(), n)?;
    }
    same("columns", segment.columns.len(), columns)?;
    for column in segment.columns {
        same("column", column.len(), n)?;
    }
    let bounded = |channel, values: &[f64], counts: &dyn Fn(usize) -> bool| {
        if values.iter().all(|x| x.abs() < LARGEST_INPUT) {
            return Ok(());
        }
        let wrong = |(i, x): &(usize, &f64)| counts(*i) && (x.is_nan() || x.abs() >= LARGEST_INPUT);
        match values.iter().enumerate().find(wrong) {
            None => Ok(()),
            Some((sample, &found)) => Err(Error::Sample {
                segment: index,
                channel,
                sample,
                found,
                allowed: "finite and below 1e100",
            }),
        }
    };
    let counts = |i: usize| segment.keep.is_empty() || segment.keep[i];
    bounded("velocity", segment.velocity, &|_| true)?;
    bounded("force", segment.force, &counts)?;
    for column in segment.columns {
        bounded("column", column, &counts)?;
    }
    Ok(())
}

fn append(track: &mut Track, index: usize, segment: &Segment) -> Result<(), Error> {
    let moving = segment.velocity.iter().find(|&&v| v != 0.0);
    let mut sign = moving.map_or(1.0, |v| v.signum());
    let mut before = 0.0;
    let mut i = 0;
    while let Some(&v) = segment.velocity.get(i) {
        let mut half_step = 0.0;
        let mut marks = SAMPLE;
        if i == 0 {
            marks |= RESTART;
        } else {
            half_step = 0.5 * step(index, segment, i)?;
            // An interval that starts or ends at rest belongs to the direction it moves in.
            let start = if before == 0.0 { v } else { before };
            if start * sign < 0.0 {
                // The node before stands still: the motion turns there.
                if let Some(marks) = track.marks.last_mut() {
                    *marks |= REVERSE;
                }
                sign = -sign;
            }
            if v * sign < 0.0 {
                let theta = before / (before - v);
                let turn = Node {
                    half_step: theta * half_step,
                    ..Node::still(sign, REVERSE)
                };
                push(track, turn, None);
                half_step *= v / (v - before);
                sign = -sign;
            }
        }
        let kept = segment.keep.is_empty() || segment.keep[i];
        if kept {
            marks |= KEPT;
            track.kept += 1;
        }
        track.samples += 1;
        let node = Node {
            speed: v.abs(),
            half_step,
            sign,
            marks,
        };
        push(track, node, kept.then_some((segment, i)));
        before = v;
        i += 1;
        // The following samples in the same direction are appended together.
        if before != 0.0 {
            let ahead = segment.velocity[i..].iter();
            let run = ahead.take_while(|&&v| v * sign > 0.0).count();
            append_run(track, index, segment, i..i + run, sign)?;
            before = segment.velocity[i + run - 1];
            i += run;
        }
    }
    Ok(())
}

/// Samples that move in the direction of the one before them.
fn append_run(
    track: &mut Track,
    index: usize,
    segment: &Segment,
    run: Range<usize>,
    sign: f64,
) -> Result<(), Error> {
    let velocity = &segment.velocity[run.clone()];
    track.speed.extend(velocity.iter().map(|v| v.abs()));
    track
        .sign
        .extend(std::iter::repeat_n(sign as i8, run.len()));
    match segment.time {
        Time::Step(_) if run.is_empty() => {}
        Time::Step(_) => {
            let half_step = 0.5 * step(index, segment, run.start)?;
            track
                .half_step
                .extend(std::iter::repeat_n(half_step, run.len()));
        }
        Time::At(_) => {
            for i in run.clone() {
                track.half_step.push(0.5 * step(index, segment, i)?);
            }
        }
    }
    track.samples += run.len();
    let channels = std::iter::once((&mut track.force, segment.force));
    let channels = channels.chain(
        track
            .columns
            .iter_mut()
            .zip(segment.columns.iter().copied()),
    );
    if segment.keep.is_empty() {
        track
            .marks
            .extend(std::iter::repeat_n(SAMPLE | KEPT, run.len()));
        track.kept += run.len();
        for (to, values) in channels {
            to.extend(values[run.clone()].iter().map(|x| sign * x));
        }
    } else {
        let keep = &segment.keep[run.clone()];
        let mark = |&kept: &bool| SAMPLE | if kept { KEPT } else { 0 };
        track.marks.extend(keep.iter().map(mark));
        track.kept += keep.iter().filter(|&&kept| kept).count();
        for (to, values) in channels {
            let kept = values[run.clone()].iter().zip(keep);
            to.extend(kept.map(|(x, &kept)| if kept { sign * x } else { 0.0 }));
        }
    }
    Ok(())
}

/// Time from the sample before to this, s.
fn step(index: usize, segment: &Segment, i: usize) -> Result<f64, Error> {
    let step = match segment.time {
        Time::Step(step) => step,
        Time::At(time) => time[i] - time[i - 1],
    };
    if step > 0.0 && step < LARGEST_INPUT {
        return Ok(step);
    }
    Err(match segment.time {
        Time::Step(found) => Error::Step {
            segment: index,
            found,
        },
        Time::At(time) => Error::Sample {
            segment: index,
            channel: "time",
            sample: i,
            found: time[i],
            allowed: "finite and later than the sample before",
        },
    })
}

fn push(track: &mut Track, node: Node, sample: Option<(&Segment, usize)>) {
    track.speed.push(node.speed);
    track.half_step.push(node.half_step);
    track.sign.push(node.sign as i8);
    track.marks.push(node.marks);
    let signed = |values: &[f64], i: usize| node.sign * values[i];
    track
        .force
        .push(sample.map_or(0.0, |(s, i)| signed(s.force, i)));
    for (c, column) in track.columns.iter_mut().enumerate() {
        column.push(sample.map_or(0.0, |(s, i)| signed(s.columns[c], i)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(velocity: &[f64]) -> Track {
        let force: Vec<f64> = (1..=velocity.len()).map(|k| k as f64).collect();
        let segment = Segment {
            time: Time::Step(2.0),
            velocity,
            force: &force,
            keep: &[],
            columns: &[],
        };
        build(&[segment]).unwrap()
    }

    #[test]
    fn a_reversal_between_samples_gets_a_node_of_standstill() {
        let track = of(&[1.0, -3.0, -1.0]);
        assert_eq!(track.speed[..4], [1.0, 0.0, 3.0, 1.0]);
        assert_eq!(track.half_step[..4], [0.0, 0.25, 0.75, 1.0]);
        assert_eq!(track.marks[1], REVERSE);
        assert_eq!(track.force[..4], [1.0, 0.0, -2.0, -3.0]);
        assert_eq!((track.nodes(), track.samples()), (BLOCK, 3));
    }

    #[test]
    fn a_reversal_at_rest_is_a_mark_on_the_last_sample_at_rest() {
        let track = of(&[0.0, 1.0, 0.0, 0.0, -1.0, 0.0, -1.0]);
        let turns: Vec<usize> = (0..track.nodes())
            .filter(|&k| track.marks[k] & REVERSE != 0)
            .collect();
        assert_eq!(turns, [3]);
        assert_eq!(track.force[..6], [1.0, 2.0, 3.0, 4.0, -5.0, -6.0]);
    }
}

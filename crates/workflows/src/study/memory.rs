//! What memory a study takes while it runs, as far as that follows from its size.

use super::course;
use super::path::MOST_SHARED_SAMPLES;
use stiction_files::study::Study;
use stiction_servo::axis::Sample;
use stiction_servo::path::Reference;

/// The program itself with the report that it makes, bytes: 43 MB with one short motion, some more with many pictures.
const PROGRAM: u64 = 50_000_000;
/// A row of a course as text, once more as the file that is written, and a number beside it in a picture, bytes.
const ROW: u64 = 2 * 110;
const POINT: u64 = 8;
/// Most numbers that the pictures of a run hold.
const MOST_POINTS: u64 = 20_000;
/// Figures of a run, bytes.
const FIGURES: u64 = 300;
/// How often the samples of a run are held at a time: with and without compensation, and those that metrics are taken of.
const HELD: u64 = 3;

/// Bytes that a study takes on the threads there are, estimated: what is kept of its runs, references that they share, and the
/// samples of those that are on their way.
pub fn memory(study: &Study) -> u64 {
    let size = study.size();
    let motions = 0..study.paths.len() + study.contours.len();
    let rows = course::rows_of_a_run(study) as u64;
    let exact = (study.controllers.len() * study.compensators.len()) as u64;
    let course = |path: usize| {
        let samples = study.samples_of_a_pass(path);
        exact * (samples.min(rows) * ROW + samples.min(MOST_POINTS) * POINT)
    };
    let courses: u64 = motions.map(course).sum();
    let shared: u64 = study.grids().map(references).sum();
    let on_their_way = rayon::current_num_threads().min(size.runs) as u64
        * HELD
        * size.longest
        * size_of::<Sample>() as u64;
    let figures = size.runs as u64 * FIGURES;
    PROGRAM + courses + figures + shared.min(MOST_SHARED_SAMPLES as u64 * REFERENCE) + on_their_way
}

const REFERENCE: u64 = size_of::<Reference>() as u64;

/// References of the paths of a study, bytes.
fn references(study: &Study) -> u64 {
    let paths = 0..study.paths.len();
    paths
        .map(|path| study.samples_of_a_pass(path) * REFERENCE)
        .sum()
}

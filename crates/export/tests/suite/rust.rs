//! The Rust crate as it is written: built in an empty place, its self-test run, and a check that a step allocates nothing.

use crate::common::models;
use std::process::Command;
use stiction_export::{Target, export};
use stiction_friction::compensator::Terms;

/// Counts allocations of the thread that steps.
const ALLOCATION: &str = r#"
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use x_axis_friction::{Input, compensator};

thread_local! { static COUNT: Cell<usize> = const { Cell::new(0) }; }
struct Counting;
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
}
#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn nothing_is_allocated() {
    let before = COUNT.with(Cell::get);
    drop(std::hint::black_box(Box::new(1)));
    let one = COUNT.with(Cell::get) - before;
    let mut compensator = compensator::<f64>().unwrap();
    for k in 0..1000 {
        let reference_velocity = f64::from(k % 40 - 20) * 1e-3;
        compensator.step(Input { reference_velocity, enable: true, ..Input::default() });
    }
    assert_eq!((one, COUNT.with(Cell::get) - before), (1, 1));
}
"#;

#[test]
#[ignore = "soak: a build of another crate"]
fn the_crate_is_built_and_runs() {
    let workspace = stiction_testkit::workspace();
    for (name, model) in models().into_iter().filter(|(name, model)| {
        let follows = model.settings.adaptation.is_some();
        ["power", "maxwell-slip", "coulomb"].contains(name) != follows
            || *name == "stribeck" && follows
    }) {
        let dir = tempfile::tempdir().unwrap();
        for file in export(&model, Target::Rust).unwrap() {
            let path = dir.path().join(&file.path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, &file.bytes).unwrap();
        }
        std::fs::write(dir.path().join("tests/allocation.rs"), ALLOCATION).unwrap();
        let output = Command::new(env!("CARGO"))
            .args(["test", "--offline"])
            .env("CARGO_TARGET_DIR", dir.path().join("target"))
            .env("RUSTFLAGS", "-Dwarnings")
            .current_dir(dir.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success(),
            "{name}: {said}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(
            said.contains("forces_are_those_that_are_due ... ok")
                && said.contains("forces_are_those_that_are_due_in_single_precision ... ok")
                && said.contains("nothing_is_allocated ... ok")
        );
        // Nothing else is fetched than libm.
        let lock = std::fs::read_to_string(dir.path().join("Cargo.lock")).unwrap();
        let packages = lock.lines().filter_map(|line| line.strip_prefix("name = "));
        assert_eq!(
            packages.collect::<Vec<_>>(),
            ["\"libm\"", "\"stiction-friction\"", "\"x-axis-friction\""]
        );
        if name != "coulomb" || model.terms != Terms::default() {
            continue;
        }
        let example = workspace.join("examples/export/rust/axis.rs");
        std::fs::create_dir(dir.path().join("examples")).unwrap();
        std::fs::copy(example, dir.path().join("examples/axis.rs")).unwrap();
        let output = Command::new(env!("CARGO"))
            .args(["run", "--quiet", "--offline", "--example", "axis"])
            .env("CARGO_TARGET_DIR", dir.path().join("target"))
            .env("RUSTFLAGS", "-Dwarnings")
            .current_dir(dir.path())
            .output()
            .unwrap();
        // Halves of 20 N + 60 N s/m 10 mm/s - 3 N and of -14 N - 85 N s/m 10 mm/s - 3 N.
        assert_eq!(
            String::from_utf8_lossy(&output.stdout),
            "8.80 N at 10 mm/s\n-8.93 N at -10 mm/s\n",
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

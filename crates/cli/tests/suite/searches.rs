//! Searches and their comparison from the command line: checkpoints, threads, interrupts, refusals.

use serde_json::Value;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A folder to run in, with a log.
struct Bench(TempDir);

impl Bench {
    fn new() -> Self {
        Self::with(2000)
    }

    fn with(samples: u32) -> Self {
        let bench = Self(tempfile::tempdir().unwrap());
        let mut text = String::from("Time [s],Velocity [m/s],Force [N]\n");
        for i in 0..samples {
            let t = f64::from(i) * 1e-3;
            let v = 0.05 * (6.3 * t).sin() + 0.01 * (23.0 * t).sin();
            let noise = 0.2 * ((1e4 * t).sin() + (2.3e4 * t).sin() + (3.1e4 * t * t).sin());
            let level = 20.0 + 10.0 * (-(v / 5e-3) * (v / 5e-3)).exp();
            let force = level * (v / 4e-4).tanh() + 60.0 * v + noise;
            let _ = writeln!(text, "{t:.4},{v:.9},{force:.4}");
        }
        std::fs::write(bench.path("log.csv"), text).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
        command
            .args(arguments.split_whitespace())
            .current_dir(self.0.path())
            .stdin(Stdio::null());
        command
    }

    /// Exit code, standard output, standard error.
    fn run(&self, arguments: &str) -> (i32, String, String) {
        crate::split(self.command(arguments).output().unwrap())
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&std::fs::read(self.path(name)).unwrap()).unwrap()
    }
}

const SEARCH: &str = "identify log.csv --method annealing-ga --evaluations 3000 --seed 4 --quiet";

#[test]
fn every_method_finds_a_law_and_says_what_it_had_before_the_least_squares() {
    let bench = Bench::new();
    assert!(bench.run("identify log.csv --law lugre --out separable").0 <= 1);
    let error = |dir: &str| {
        let result = bench.json(&format!("{dir}/result.json"));
        result["fit"]["relative_error_percent"].as_f64().unwrap()
    };
    let least = error("separable");
    for method in [
        "ga",
        "adaptive-ga",
        "annealing-ga",
        "niched-ga",
        "de",
        "cma-es",
        "pso",
        "annealing",
        "nelder-mead",
        "lm",
    ] {
        let (code, out, err) = bench.run(&format!(
            "identify log.csv --method {method} --evaluations 600 --out {method}"
        ));
        assert!(code <= 1 && err.is_empty(), "{method}: {out}{err}");
        assert!(out.contains(&format!("\n{method} over ")), "{out}");
        let result = bench.json(&format!("{method}/result.json"));
        assert_eq!(result["method"], method);
        let searched = &result["searched"];
        let paper = ["ga", "adaptive-ga", "annealing-ga"].contains(&method);
        assert_eq!(searched["cost"], if paper { "six" } else { "separable" });
        let cost = |stage: &str| searched[stage]["cost"].as_f64().unwrap();
        assert!(cost("after_least_squares") <= cost("own"), "{method}");
        let last = error(method);
        assert!(
            last <= 100.0 * cost("after_least_squares").sqrt() * (1.0 + 1e-9),
            "{method}"
        );
        // The steady force of this log hardly shows the bristles. Its cost has several hollows, and the genetic
        // algorithms of the paper may end in another than the deepest; the others lead to the same law. None
        // finds a better one.
        let off = last / least - 1.0;
        assert!(off > -1e-6, "{method}: {last}, below {least}");
        assert!(paper || off < 1e-6, "{method}: {last} instead of {least}");
    }
}

#[test]
fn a_resumed_search_ends_with_the_bits_of_one_that_never_stopped() {
    let bench = Bench::new();
    assert!(bench.run(&format!("{SEARCH} --out whole")).0 <= 1);
    // The time is over after the first batch.
    assert!(
        bench
            .run(&format!(
                "{SEARCH} --time 1e-6 --checkpoint c.json --out part"
            ))
            .0
            <= 1
    );
    let part = bench.json("part/result.json");
    assert_eq!(part["searched"]["status"], "time");
    let few = part["searched"]["evaluations"]["costs"].as_u64().unwrap();
    assert!((1..2000).contains(&few), "{few}");
    // Twice more, on other numbers of threads.
    let again = "--time 1e-6 --threads 1 --resume c.json --checkpoint c.json --out part";
    assert!(bench.run(&format!("{SEARCH} {again}")).0 <= 1);
    assert!(
        bench
            .run(&format!("{SEARCH} --threads 3 --resume c.json --out rest"))
            .0
            <= 1
    );
    let read = |name: &str| std::fs::read(bench.path(name)).unwrap();
    for file in ["model.toml", "fit.csv", "report.html"] {
        assert!(
            read(&format!("whole/{file}")) == read(&format!("rest/{file}")),
            "{file}"
        );
    }
    let searched = |name: &str| bench.json(&format!("{name}/result.json"))["searched"].clone();
    assert_eq!(searched("whole"), searched("rest"));
}

#[test]
fn a_damaged_or_foreign_checkpoint_is_refused() {
    let bench = Bench::new();
    bench.run(&format!("{SEARCH} --time 1e-6 --checkpoint c.json --out a"));
    let whole = std::fs::read_to_string(bench.path("c.json")).unwrap();
    let refused = |options: &str, words: &str| {
        let (code, out, err) = bench.run(&format!("{SEARCH} --out b {options}"));
        assert_eq!((code, out.as_str()), (2, ""), "{options}: {err}");
        let start = "stiction: [bad-checkpoint] c.json: ";
        assert!(
            err.starts_with(start) && err.contains(words),
            "{options}: {err}"
        );
    };
    refused(
        "--resume c.json --cost separable",
        "belongs to a search with cost six, this one has separable",
    );
    let text = std::fs::read_to_string(bench.path("log.csv")).unwrap();
    std::fs::write(
        bench.path("log.csv"),
        text.replacen("0.0010,", "0.0011,", 1),
    )
    .unwrap();
    refused(
        "--resume c.json",
        "belongs to a search with logs of SHA-256 ",
    );
    std::fs::write(bench.path("log.csv"), text).unwrap();
    let at = whole.len() - 200;
    let digit = whole[at..].find(|c: char| c.is_ascii_digit()).unwrap() + at;
    let mut damaged = whole.clone();
    let other = if &whole[digit..=digit] == "7" {
        "8"
    } else {
        "7"
    };
    damaged.replace_range(digit..=digit, other);
    for (text, words) in [
        (
            damaged.as_str(),
            "its settings or its state are damaged; a file that --checkpoint wrote",
        ),
        (&whole[..whole.len() / 2], "damaged"),
        // A head that says another seed than the state has.
        (&whole.replacen("\"seed\":4", "\"seed\":5", 1), "damaged"),
        ("", "no checkpoint"),
        ("{\"schema\":\"x\"}", "no checkpoint"),
        (
            &whole.replace("checkpoint/1", "checkpoint/9"),
            "schema stiction.checkpoint/9",
        ),
    ] {
        std::fs::write(bench.path("c.json"), text).unwrap();
        refused("--resume c.json", words);
    }
    std::fs::remove_file(bench.path("c.json")).unwrap();
    refused("--resume c.json", "cannot be read (");
    std::fs::create_dir(bench.path("c.json")).unwrap();
    refused("--resume c.json", "not a file");
}

#[test]
fn a_checkpoint_replaces_nothing_but_a_checkpoint() {
    let bench = Bench::new();
    let command = |file: &str| format!("{SEARCH} --time 1e-6 --checkpoint {file} --out a");
    assert!(bench.run(&command("c.json")).0 <= 1);
    assert!(bench.run(&command("c.json")).0 <= 1);
    let log = std::fs::read(bench.path("log.csv")).unwrap();
    std::fs::create_dir(bench.path("folder")).unwrap();
    std::os::unix::fs::symlink("c.json", bench.path("link")).unwrap();
    for (file, code, words) in [
        (
            "log.csv",
            "bad-checkpoint",
            "log.csv: is something else and would be replaced; --checkpoint takes a new file, or one that \
             --checkpoint wrote",
        ),
        (
            "folder",
            "bad-checkpoint",
            "folder: is not a file and would be replaced",
        ),
        (
            "link",
            "bad-checkpoint",
            "link: is not a file and would be replaced",
        ),
        ("none/c.json", "output", "none/c.json: "),
    ] {
        let (exit, out, err) = bench.run(&command(file));
        assert_eq!((exit, out.as_str()), (2, ""), "{file}: {err}");
        let start = format!("stiction: [{code}] {words}");
        assert!(err.starts_with(&start), "{file}: {err}");
    }
    assert_eq!(std::fs::read(bench.path("log.csv")).unwrap(), log);
    // Nor does a result take its place, which is still to be written.
    std::fs::create_dir(bench.path("b")).unwrap();
    let line = format!("{SEARCH} --time 1e-6 --checkpoint b/result.json --out b");
    let (exit, _, err) = bench.run(&line);
    assert_eq!(exit, 2, "{err}");
    assert!(
        err.contains("b/result.json: is where the result is written"),
        "{err}"
    );
}

#[test]
fn limits_of_a_search_belong_to_a_search() {
    let bench = Bench::new();
    for (options, words) in [
        (
            "--evaluations 10",
            "together with --method separable; one of the searches: ga, ",
        ),
        ("--method de --evaluations 0", "--evaluations 0; at least 1"),
        (
            "--method de --target -1e0",
            "--target -1; a finite number above 0",
        ),
        (
            "--method de --time -1e0",
            "--time -1; a finite number above 0",
        ),
    ] {
        let options = options.replace("--target -", "--target=-");
        let options = options.replace("--time -", "--time=-");
        let (code, _, err) = bench.run(&format!("identify log.csv --out x {options}"));
        assert_eq!(code, 2, "{err}");
        assert!(
            err.starts_with("stiction: [usage] ") && err.contains(words),
            "{err}"
        );
    }
    let six = "identify log.csv --out x --method de --cost six --asymmetric";
    let (code, _, err) = bench.run(six);
    assert_eq!(code, 2);
    assert!(
        err.contains("[bad-setting] log.csv: nonlinear unknowns = 6: the symmetric"),
        "{err}"
    );
    assert!(!bench.path("x").exists());
}

/// Without what a clock says.
fn timeless(mut file: Value) -> Value {
    file["wall_s"].take();
    for method in file["methods"].as_array_mut().unwrap() {
        for key in ["seconds", "seconds_to_success", "by_time"] {
            method[key].take();
        }
        for run in method["runs"].as_array_mut().unwrap() {
            run["seconds"].take();
            run["seconds_to_success"].take();
        }
    }
    file
}

#[test]
fn a_comparison_does_not_depend_on_the_threads() {
    let bench = Bench::new();
    let compare = "compare --problem machine --methods annealing-ga,de,niched-ga --seeds 3 \
                   --evaluations 1500 --rate 300";
    for threads in ["1", "3"] {
        let (code, out, err) = bench.run(&format!("{compare} --threads {threads} --out {threads}"));
        assert_eq!((code, err.as_str()), (0, ""), "{out}");
        assert!(out.contains("written to"), "{out}");
    }
    let one = bench.json("1/compare.json");
    assert_eq!(
        timeless(one.clone()),
        timeless(bench.json("3/compare.json"))
    );
    assert_eq!(one["schema"], "stiction.compare/1");
    // A second one takes the place of the first, and `--json` prints what is written.
    let (code, out, _) = bench.run("compare log.csv --methods lm --seeds 1 --json --out 1");
    assert_eq!(code, 0, "{out}");
    assert_eq!(
        serde_json::from_str::<Value>(&out).unwrap(),
        bench.json("1/compare.json")
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_is_done() {
    let bench = Bench::with(100_000);
    for (arguments, file) in [
        ("identify log.csv --method ga --out a", "a/result.json"),
        (
            "compare --problem machine --methods lm,ga --seeds 9 --rate 9000 --out b",
            "b/compare.json",
        ),
    ] {
        let (_, (code, out, err)) = crate::interrupted(|| bench.command(arguments));
        assert_eq!(code, 130, "{arguments}: {out}{err}");
        let result = bench.json(file);
        let status = if file.starts_with('a') {
            &result["search"]["status"]
        } else {
            &result["status"]
        };
        assert_eq!(status, "interrupted");
    }
}

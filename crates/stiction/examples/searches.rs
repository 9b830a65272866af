//! Rewrites the tables of `docs/searches.md` from comparisons made on the spot. Run by
//! `cargo xtask searches`; by itself it takes a number of seeds, and the tables to make if not all.

use std::fmt::Write;
use std::time::Instant;
use stiction_files::compare_file::{CompareFile, MethodEntry, Quartiles};
use stiction_identify::Silent;
use stiction_identify::candidates::Scheme;
use stiction_testkit::workspace;
use stiction_workflows::compare::{CompareOptions, Cost, Excitation, Input, compare};

const PAGE: &str = "docs/searches.md";
/// Methods that take costs only, without the slow ones where a candidate is alone.
const BATCHES: [&str; 6] = ["ga", "adaptive-ga", "annealing-ga", "de", "cma-es", "pso"];
const ROBUST: [&str; 7] = [
    "lm-one",
    "lm",
    "niched-ga",
    "annealing-ga",
    "de",
    "cma-es",
    "nelder-mead",
];

fn options(problem: &str, seeds: u64) -> CompareOptions {
    CompareOptions {
        input: Input::Named(problem.into()),
        axis: None,
        methods: Vec::new(),
        seeds,
        evaluations: 20_000,
        noise: None,
        excitation: None,
        rate: None,
        other_law: false,
        decades: None,
        integrator: Scheme::Explin,
        cost: None,
        max_samples: u64::MAX,
    }
}

fn run(options: &CompareOptions) -> CompareFile {
    compare(options, &mut Silent).unwrap_or_else(|e| panic!("{options:?}: {e}"))
}

fn named(methods: &[&str]) -> Vec<String> {
    methods.iter().map(|m| (*m).to_string()).collect()
}

/// Successes alone and with least squares.
fn rate(m: &MethodEntry) -> String {
    format!("{} / {}", m.own.successes, m.after_least_squares.successes)
}

fn median(values: &Quartiles) -> String {
    match values {
        Some([_, x, _]) if *x == 0.0 => "0".into(),
        Some([_, x, _]) if (0.01..1e5).contains(&x.abs()) => {
            let digits = (2.0 - x.abs().log10().floor()).clamp(0.0, 4.0) as usize;
            format!("{x:.digits$}")
        }
        Some([_, x, _]) => format!("{x:.1e}"),
        None => "–".into(),
    }
}

/// One row a method, one column a comparison.
fn across(files: &[(String, CompareFile)], cell: impl Fn(&MethodEntry) -> String) -> String {
    let mut out = String::from("| method |");
    for (title, _) in files {
        let _ = write!(out, " {title} |");
    }
    let _ = write!(out, "\n|---|{}\n", "---|".repeat(files.len()));
    let mut names: Vec<&str> = Vec::new();
    for (_, file) in files {
        for m in &file.methods {
            if !names.contains(&m.name.as_str()) {
                names.push(&m.name);
            }
        }
    }
    for name in names {
        let _ = write!(out, "| `{name}` |");
        for (_, file) in files {
            let entry = file.methods.iter().find(|m| m.name == name);
            let _ = write!(out, " {} |", entry.map_or("–".into(), &cell));
        }
        out.push('\n');
    }
    out
}

fn lugre(seeds: u64) -> String {
    let problems = ["C95", "machine", "motor", "V5", "V6", "V10", "V16"];
    let files = problems.map(|name| (name.to_string(), run(&options(name, seeds))));
    let beaten = files.iter().filter(|(_, f)| f.reference.beaten);
    let beaten: Vec<&str> = beaten.map(|(name, _)| name.as_str()).collect();
    let beaten = if beaten.is_empty() {
        "nowhere".into()
    } else {
        beaten.join(", ")
    };
    format!(
        "Runs of {seeds} within 1e-4 of the optimum, alone / with least squares:\n\n{}\nMedian cost of the \
         search alone over that of the optimum, less 1:\n\n{}\nA method found a lower cost than the \
         separable search: {beaten}.\n",
        across(&files, rate),
        across(&files, |m| median(&m.own.excess)),
    )
}

fn exact(seeds: u64) -> String {
    let problems = ["C95", "machine", "V5", "V6"];
    let files = problems.map(|name| {
        let options = CompareOptions {
            noise: Some(0.0),
            ..options(name, seeds)
        };
        (name.to_string(), run(&options))
    });
    let worst = |m: &MethodEntry| {
        let medians = m.own.errors.iter().filter_map(|e| e.relative);
        let worst = medians.map(|q| q[1]).fold(0.0, f64::max);
        format!("{}; {:.1e}", rate(m), worst)
    };
    format!(
        "Runs of {seeds} with every parameter within 1 %, alone / with least squares; then the median error of \
         the worst parameter alone:\n\n{}",
        across(&files, worst)
    )
}

fn curves(seeds: u64) -> String {
    let files = ["V2", "V3", "V7"].map(|name| (name.to_string(), run(&options(name, seeds))));
    across(&files, rate)
}

fn boxes(seeds: u64) -> String {
    let mut files = Vec::new();
    for problem in ["C95", "machine"] {
        for decades in [1.0, 2.0, 3.0] {
            let options = CompareOptions {
                decades: Some(decades),
                ..options(problem, seeds)
            };
            files.push((format!("{problem} {decades:.0}"), run(&options)));
        }
    }
    format!(
        "{}\nMedian evaluations of the full record until a successful run is there:\n\n{}",
        across(&files, rate),
        across(&files, |m| median(&m.evaluations_to_success))
    )
}

fn integrators(seeds: u64) -> String {
    let mut files = Vec::new();
    for problem in ["machine", "motor"] {
        for integrator in [Scheme::Explin, Scheme::RungeKutta, Scheme::Euler] {
            let options = CompareOptions {
                integrator,
                methods: named(&BATCHES),
                ..options(problem, seeds)
            };
            let file = run(&options);
            files.push((format!("{problem} {}", file.integrator), file));
        }
    }
    let optima: Vec<String> = files
        .iter()
        .map(|(title, f)| format!("{title} {:.4e}", f.reference.cost))
        .collect();
    format!(
        "Successes alone, against the optimum of the same integrator:\n\n{}\nMedian time of a run, s:\n\n{}\n\
         Optimal costs: {}.\n",
        across(&files, |m| m.own.successes.to_string()),
        across(&files, |m| median(&m.seconds)),
        optima.join(", ")
    )
}

fn robust(seeds: u64) -> String {
    let base = |change: fn(&mut CompareOptions)| {
        let mut options = CompareOptions {
            methods: named(&ROBUST),
            ..options("machine", seeds)
        };
        change(&mut options);
        options
    };
    let cases = [
        ("right law, 1 decade", base(|_| {})),
        ("3 decades", base(|o| o.decades = Some(3.0))),
        ("other law", base(|o| o.other_law = true)),
        (
            "other law, 3 decades",
            base(|o| {
                o.other_law = true;
                o.decades = Some(3.0);
            }),
        ),
        (
            "break-away",
            base(|o| o.excitation = Some(Excitation::BreakAway)),
        ),
        (
            "break-away, 3 decades",
            base(|o| {
                o.excitation = Some(Excitation::BreakAway);
                o.decades = Some(3.0);
            }),
        ),
    ];
    let files: Vec<(String, CompareFile)> = cases
        .into_iter()
        .map(|(title, options)| (title.to_string(), run(&options)))
        .collect();
    format!(
        "{}\nMedian cost of the search alone over that of the optimum, less 1:\n\n{}",
        across(&files, rate),
        across(&files, |m| median(&m.own.excess))
    )
}

fn position(seeds: u64) -> String {
    let problems = ["machine", "C95"];
    let files = problems.map(|name| {
        let options = CompareOptions {
            cost: Some(Cost::Position),
            rate: Some(300.0),
            evaluations: 10_000,
            methods: named(&BATCHES),
            ..options(name, seeds)
        };
        (name.to_string(), run(&options))
    });
    format!(
        "Successes alone; median cost over the optimum, less 1; the same of the worst quarter:\n\n{}",
        across(&files, |m| {
            let worst = m.own.excess.map(|q| [q[2]; 3]);
            format!(
                "{}; {}; {}",
                m.own.successes,
                median(&m.own.excess),
                median(&worst)
            )
        })
    )
}

fn speed(seeds: u64) -> String {
    let mut files = Vec::new();
    for problem in ["C95", "machine"] {
        let options = CompareOptions {
            rate: Some(10_000.0),
            ..options(problem, seeds)
        };
        files.push((problem.to_string(), run(&options)));
    }
    format!(
        "Median time until a successful run is near the optimum, s; median time of a run, s:\n\n{}",
        across(&files, |m| {
            format!("{}; {}", median(&m.seconds_to_success), median(&m.seconds))
        })
    )
}

/// Puts a table between its marks.
fn put(page: &mut String, name: &str, table: &str) {
    let (begin, end) = (format!("<!-- {name} -->\n"), format!("<!-- end {name} -->"));
    let from = page
        .find(&begin)
        .unwrap_or_else(|| panic!("{PAGE}: no mark {begin}"))
        + begin.len();
    let to = page
        .find(&end)
        .unwrap_or_else(|| panic!("{PAGE}: no mark {end}"));
    page.replace_range(from..to, &format!("\n{}\n\n", table.trim()));
}

fn main() -> std::io::Result<()> {
    let mut words = std::env::args().skip(1);
    let seeds = words
        .next()
        .map_or(30, |s| s.parse().expect("a number of seeds"));
    let file = workspace().join(PAGE);
    let mut page = std::fs::read_to_string(&file)?;
    type Make = fn(u64) -> String;
    let tables: [(&str, Make); 8] = [
        ("lugre", lugre),
        ("exact", exact),
        ("curves", curves),
        ("boxes", boxes),
        ("integrators", integrators),
        ("robust", robust),
        ("position", position),
        ("speed", speed),
    ];
    let wanted: Vec<String> = words.collect();
    let known = |word: &String| tables.iter().any(|(name, _)| name == word);
    if let Some(word) = wanted.iter().find(|word| !known(word)) {
        panic!(
            "no table {word}: {}",
            tables.map(|(name, _)| name).join(", ")
        );
    }
    for (name, make) in tables {
        if !wanted.is_empty() && !wanted.iter().any(|word| word == name) {
            continue;
        }
        let clock = Instant::now();
        put(&mut page, name, &make(seeds));
        eprintln!("{name}: {:.0} s", clock.elapsed().as_secs_f64());
        stiction_files::write_atomic(&file, page.as_bytes()).map_err(std::io::Error::other)?;
    }
    Ok(())
}

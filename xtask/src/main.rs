//! Project tasks: `cargo xtask <task>`. Depends on nothing but the standard library, so that it
//! is built in a second on a fresh machine. To add a task, write a function and add it to `TASKS`.

mod debian;
mod examples;
mod exports;
mod figures;
mod forms;
mod instructions;
mod interpreter;
mod licences;
mod package;
mod python;
mod release;
mod shell;
mod site;
mod soak;
mod test;
mod times;
mod tools;
mod web;
mod wheel;

use std::process::ExitCode;

/// One task: its name, one line of help, and what it does.
struct Task {
    name: &'static str,
    help: &'static str,
    run: fn() -> shell::Outcome,
}

impl Task {
    /// Whether this was typed. A last word in capitals stands for any.
    fn is(&self, typed: &str) -> bool {
        let begin = self.name.trim_end_matches(|c: char| c.is_ascii_uppercase());
        let last = typed.strip_prefix(begin).filter(|_| begin != self.name);
        typed == self.name || last.is_some_and(|last| !last.is_empty() && !last.contains(' '))
    }
}

const TASKS: &[Task] = &[
    Task {
        name: "setup",
        help: "install what the tests need: Debian packages, Python packages and tools in .venv and target",
        run: setup,
    },
    Task {
        name: "test",
        help: "set up, then everything CI checks: format, licences, lints, docs, tests",
        run: test::run,
    },
    Task {
        name: "soak",
        help: "what CI has no time for: the same tests with more seeds, packed crates built on their own, killed workers, free-threaded Python",
        run: soak::run,
    },
    Task {
        name: "exports",
        help: "exported code under other tools; writes with what it passed, which `test` need not run again then",
        run: exports::run,
    },
    Task {
        name: "package",
        help: "pack the three crates that are published, in target/package",
        run: package::run,
    },
    Task {
        name: "package --verify",
        help: "the same, then build each on its own and hold its command and example beside those of the workspace",
        run: package::verified,
    },
    Task {
        name: "release",
        help: "everything up to the upload: checks, then an archive with checksums in target/release-archives",
        run: release::run,
    },
    Task {
        name: "archive",
        help: "only that archive, from the work tree as it is",
        run: release::archive,
    },
    Task {
        name: "archive --target TARGET",
        help: "the archive for another kind of machine, such as aarch64-unknown-linux-gnu; its demo is run under qemu",
        run: release::archive_of_target,
    },
    Task {
        name: "twice",
        help: "archive and wheel of the commit, built in two folders: the bytes must be the same",
        run: release::twice,
    },
    Task {
        name: "python",
        help: "build the Python package and run its tests, and nothing else",
        run: wheel::built,
    },
    Task {
        name: "wheel",
        help: "the Python wheel and source distribution as users get them, tested and measured: target/python/release",
        run: wheel::release,
    },
    Task {
        name: "wheel --only",
        help: "the same, neither tested nor measured",
        run: wheel::only,
    },
    Task {
        name: "wheel --target TARGET",
        help: "the same for another kind of machine",
        run: wheel::of_target,
    },
    Task {
        name: "interpreter",
        help: "build the free-threaded Python that the next two need, where there is none",
        run: interpreter::install,
    },
    Task {
        name: "python --free-threaded",
        help: "the Python package and its tests on that Python",
        run: wheel::built_free_threaded,
    },
    Task {
        name: "wheel --free-threaded",
        help: "its wheel as users get it, tested and measured: target/python/release-free-threaded",
        run: wheel::release_free_threaded,
    },
    Task {
        name: "studio",
        help: "build the page of stiction studio anew, go through it in a browser, keep pictures of it",
        run: web::renew,
    },
    Task {
        name: "studio-measure",
        help: "how fast and how large the page is, with a release build: rewrite the table of docs/studio.md",
        run: web::measure,
    },
    Task {
        name: "validation",
        help: "identify the measured recordings and rewrite docs/validation.md",
        run: validation,
    },
    Task {
        name: "library",
        help: "identify the machines of the library anew from the recordings; URDFs from STICTION_URDFS or example-robot-data in .venv",
        run: || examples::run("library"),
    },
    Task {
        name: "site",
        help: "build the site of the documentation into target/site: strict, and without the network",
        run: site::run,
    },
    Task {
        name: "gallery",
        help: "identify the logs of docs/gallery.md anew from the recordings, and draw its pictures",
        run: || examples::run("gallery"),
    },
    Task {
        name: "searches",
        help: "compare the searches and rewrite the tables of docs/searches.md",
        run: searches,
    },
    Task {
        name: "front",
        help: "README's first table and picture: recordings beside published models and scipy",
        run: figures::front,
    },
    Task {
        name: "performance",
        help: "measure everything in docs/performance.md anew, beside its peers: on a quiet machine, an hour",
        run: figures::performance,
    },
    Task {
        name: "performance SCRIPT",
        help: "the same of one script of bench/ or of a folder, such as peers/identify or formats",
        run: figures::performance,
    },
    Task {
        name: "policy",
        help: "print every threshold with its value, unit, meaning and source",
        run: policy,
    },
    Task {
        name: "instructions",
        help: "count the instructions of kernels and identification, compare with bench/instructions.txt",
        run: instructions::compare,
    },
    Task {
        name: "instructions --accept",
        help: "write bench/instructions.txt",
        run: instructions::accept,
    },
    Task {
        name: "licences",
        help: "check licences, versions and sources of dependencies against deny.toml",
        run: licences::run,
    },
];

/// What the tests read from the environment.
const VARIABLES: &str = "\
variables of the tests
  STICTION_DATA          folder of the recordings, else ../shared/data
  STICTION_MATIEC        matiec, else ../shared/tools/matiec.tar.gz
  STICTION_PYTHON        Python to compare with, else that of .venv
  STICTION_URDFS         robots of example-robot-data
  STICTION_PINOCCHIO     Python with Pinocchio; `soak` installs and sets it
  STICTION_SOAK=1        every case of a table
  STICTION_FUZZ=N        number of fuzzed inputs, the first being STICTION_FUZZ_FIRST; failures go to target/fuzz
  STICTION_SUDO=1        LinuxCNC tests ask sudo to install a component
  CI=true                a test without its recordings fails";

fn setup() -> shell::Outcome {
    debian::install()?;
    python::install()?;
    tools::install()?;
    web::install()
}

fn validation() -> shell::Outcome {
    shell::run(shell::cargo(
        "run --release --quiet -p stiction --example validation",
    ))
}

fn policy() -> shell::Outcome {
    shell::run(shell::cargo(
        "run --quiet -p stiction-policy --example table",
    ))
}

fn searches() -> shell::Outcome {
    shell::run(shell::cargo(
        "run --release --quiet -p stiction --example searches",
    ))
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let typed = words.join(" ");
    let task = match typed.as_str() {
        "" | "help" | "-h" | "--help" => {
            println!("cargo xtask <task>\n");
            for task in TASKS {
                println!("  {:22} {}", task.name, task.help);
            }
            println!("\n{VARIABLES}");
            return ExitCode::SUCCESS;
        }
        name => TASKS.iter().find(|task| task.is(name)),
    };
    let Some(task) = task else {
        let known: Vec<&str> = TASKS.iter().map(|task| task.name).collect();
        eprintln!(
            "xtask: `{typed}` is not a task; one of: {}",
            known.join(", ")
        );
        return ExitCode::from(2);
    };
    match (task.run)() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask {}: {message}", task.name);
            ExitCode::FAILURE
        }
    }
}

//! Whatever the bytes, every reader and every TOML form gives its outcome or an error: no panic, no hang, no memory beyond the
//! bound. Small files of every form are damaged and read in this process.
//!
//! A program of its own, since its allocator is the program's and the memory of a process can only be watched as a whole. An
//! input that broke something is written to `target/fuzz`; once that is mended it is kept in `corpus`, under a name that begins
//! with its form, and read in every run.

mod damage;

use damage::{Random, damaged};
use peak_alloc::PeakAlloc;
use rustix::time::{ClockId, clock_gettime};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use stiction_files::study::Study;
use stiction_files::{Axis, ModelFile};
use stiction_formats::{Limits, ReadOptions, Table, read_table, read_wanted};
use stiction_log::{Log, Mapping};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What a log may take, bytes, and what is allowed beside that: buffers and tables of decoders, names, notes.
const ALLOWED: u64 = 3 << 20;
const BESIDE: usize = 5 << 20;
/// No input takes more of the processor.
const LONGEST: Duration = Duration::from_secs(2);

/// What an input is read as.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Log,
    Axis,
    Model,
    Study,
}

impl Form {
    const ALL: [(Form, &str); 4] = [
        (Form::Log, "log"),
        (Form::Axis, "axis"),
        (Form::Model, "model"),
        (Form::Study, "study"),
    ];

    fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// By the beginning of the name of a file.
    fn of(file: &Path) -> Self {
        let name = file.file_name().unwrap().to_str().unwrap();
        let mut all = Self::ALL.into_iter();
        all.find(|(_, begin)| name.starts_with(begin)).unwrap().0
    }
}

/// A small file of a form.
struct Seed {
    form: Form,
    bytes: Vec<u8>,
}

/// Axis files with columns of other files, of which none is among the examples.
const JOINED: [&str; 2] = [
    "[columns]\nforce = { file = \"tau.csv\", column = \"x\", offset = \"estimate\" }\n",
    "[columns]\nload = { file = \"tau.csv\", column = 2, time = 1, offset = \"-12 ms\" }\n",
];

/// Where inputs are read from, and how many of them were read in the end.
struct Bench {
    folder: tempfile::TempDir,
    options: ReadOptions,
    seeds: Vec<Seed>,
    accepted: [u64; 4],
    read: [u64; 4],
    slowest: Duration,
    largest: usize,
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder that no disk holds, where the system has one: a file that is written anew is otherwise sent to the disk each time,
/// which takes twenty times as long as reading it.
fn folder_in_memory() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").unwrap_or_else(|_| tempfile::tempdir().unwrap())
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.is_file()).collect();
    paths.sort();
    paths
}

impl Bench {
    fn new() -> Self {
        let folder = folder_in_memory();
        let made = tempfile::tempdir().unwrap();
        let python = std::env::var_os("STICTION_PYTHON")
            .map_or_else(|| workspace().join(".venv/bin/python"), PathBuf::from);
        for script in [
            "crates/formats/tests/python/write_small.py",
            "crates/files/tests/fuzz/seeds.py",
        ] {
            let mut command = Command::new(&python);
            command.arg(workspace().join(script)).arg(made.path());
            let status = command.env("PYTHONDONTWRITEBYTECODE", "1").status();
            assert!(status.unwrap().success(), "{script} failed");
        }
        let mut seeds = Vec::new();
        let mut take = |form, path: &Path| {
            let bytes = std::fs::read(path).unwrap();
            seeds.push(Seed { form, bytes });
        };
        for path in files(made.path()) {
            take(Form::Log, &path);
        }
        for folder in ["validation", "examples/linuxcnc"] {
            let paths = files(&workspace().join(folder));
            let tables = paths
                .iter()
                .filter(|p| p.extension().is_some_and(|e| e == "toml"));
            tables.for_each(|path| take(Form::Axis, path));
        }
        for text in JOINED {
            let path = made.path().join("joined.toml");
            std::fs::write(&path, text).unwrap();
            take(Form::Axis, &path);
        }
        take(Form::Model, &workspace().join("examples/export/model.toml"));
        for path in files(&workspace().join("examples/stage")) {
            if path.extension().is_some_and(|e| e == "toml") {
                take(Form::Study, &path);
            }
        }
        // What a study may name.
        let model = folder.path().join("model.toml");
        std::fs::copy(workspace().join("examples/export/model.toml"), model).unwrap();
        let options = ReadOptions {
            limits: Limits { memory: ALLOWED },
            ..ReadOptions::default()
        };
        Self {
            folder,
            options,
            seeds,
            accepted: [0; 4],
            read: [0; 4],
            slowest: Duration::ZERO,
            largest: 0,
        }
    }

    /// Reads an input; whether it was accepted.
    fn read(&self, form: Form, bytes: &[u8]) -> bool {
        let file = self.folder.path().join(form.name());
        match form {
            Form::Log => {
                std::fs::write(&file, bytes).unwrap();
                let mapping = Mapping::default();
                let Ok(table) = read_table(&file, &self.options) else {
                    return false;
                };
                let Ok(log) = Log::of_table(table, &mapping) else {
                    return false;
                };
                // The same log from the columns alone that it may take.
                let wanted = |heads: &Table| mapping.wanted(heads);
                let table = read_wanted(&file, &self.options, |_| {}, &wanted);
                let again = table.and_then(|table| Log::of_table(table, &mapping));
                assert_eq!(again.as_ref(), Ok(&log));
                true
            }
            Form::Axis => Axis::parse(&String::from_utf8_lossy(bytes)).is_ok(),
            Form::Model => ModelFile::parse(&String::from_utf8_lossy(bytes)).is_ok(),
            Form::Study => {
                std::fs::write(&file, bytes).unwrap();
                Study::read(&file).is_ok()
            }
        }
    }

    /// Reads an input and looks at time and memory; keeps what breaks something.
    fn try_input(&mut self, form: Form, bytes: &[u8]) {
        let mut quickest = Duration::MAX;
        // The first time may be that of something that is set up once.
        for _ in 0..3 {
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let begun = spent();
            let accepted = catch_unwind(AssertUnwindSafe(|| self.read(form, bytes)));
            let used = MEMORY.peak_usage().saturating_sub(before);
            quickest = quickest.min(spent().saturating_sub(begun));
            let Ok(accepted) = accepted else {
                kept(form, bytes, "a panic");
            };
            if used > ALLOWED as usize + BESIDE {
                kept(form, bytes, &format!("{used} bytes of memory"));
            }
            self.largest = self.largest.max(used);
            if quickest <= LONGEST {
                self.accepted[form as usize] += u64::from(accepted);
                break;
            }
        }
        if quickest > LONGEST {
            kept(form, bytes, &format!("{quickest:?}"));
        }
        self.slowest = self.slowest.max(quickest);
        self.read[form as usize] += 1;
    }

    /// Reads what is kept, then so many damaged inputs.
    fn run(&mut self, inputs: u64, first: u64) {
        // A panic of a decoder is caught, and what is said of it, with a trace, would count as memory of the reader.
        std::panic::set_hook(Box::new(|_| {}));
        let mut kept = files(&workspace().join("crates/files/tests/fuzz/corpus"));
        kept.retain(|path| !path.ends_with("README.md"));
        for path in kept {
            let bytes = std::fs::read(&path).unwrap();
            self.try_input(Form::of(&path), &bytes);
        }
        let clock = Instant::now();
        for input in first..first + inputs {
            let mut random = Random::new(input);
            let seed = &self.seeds[random.below(self.seeds.len())];
            let other = &self.seeds[random.below(self.seeds.len())];
            let bytes = damaged(&seed.bytes, &other.bytes, &mut random);
            self.try_input(seed.form, &bytes);
        }
        let seconds = clock.elapsed().as_secs_f64();
        let rate = inputs as f64 / seconds;
        eprintln!("{inputs} inputs in {seconds:.0} s, {rate:.0} a second, one thread");
        for (form, name) in Form::ALL {
            let (read, accepted) = (self.read[form as usize], self.accepted[form as usize]);
            eprintln!("{name}: {read} read, {accepted} accepted");
        }
        let (slowest, largest) = (self.slowest.as_secs_f64(), self.largest as f64 / 1e6);
        eprintln!("slowest {slowest:.2} s, most memory {largest:.1} MB");
    }
}

/// Time of the processor that this program has taken: a machine that is busy elsewhere is no hang.
fn spent() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::try_from(time).expect("time goes on")
}

/// Writes down an input that broke something, and fails.
fn kept(form: Form, bytes: &[u8], what: &str) -> ! {
    let folder = workspace().join("target/fuzz");
    std::fs::create_dir_all(&folder).unwrap();
    let sum = bytes
        .iter()
        .fold(0u64, |sum, b| sum.wrapping_mul(31) + u64::from(*b));
    let file = folder.join(format!("{}-{sum:016x}", form.name()));
    std::fs::write(&file, bytes).unwrap();
    eprintln!("{what} for {}", file.display());
    panic!("{what} for {}", file.display());
}

/// Inputs of an ordinary run.
const FEW: u64 = 100_000;
/// And of one for which there is time.
const MANY: u64 = 300_000;

#[test]
fn damaged_inputs_are_refused_or_read() {
    Bench::new().run(FEW, 0);
}

/// As many as `STICTION_FUZZ` says, from the input on that `STICTION_FUZZ_FIRST` says.
#[test]
#[ignore = "soak: the same with more inputs"]
fn many_damaged_inputs_are_refused_or_read() {
    let number = |name, default| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let inputs = number("STICTION_FUZZ", MANY);
    Bench::new().run(inputs, number("STICTION_FUZZ_FIRST", FEW));
}

//! What stands behind `next:` and `then:` is a command that a shell takes as it stands, and that this program reads.

use std::path::Path;
use std::process::{Command, Stdio};

/// 3 s of an axis with Coulomb friction that moves by 5 mm, with its positions and forces so many times as large.
fn log(unit: &str, [longer, stronger]: [f64; 2]) -> String {
    let mut text = format!("Time [s],Position [{unit}],Force [N]\n");
    for k in 0..3000 {
        let t = f64::from(k) * 1e-3;
        let (x, v) = (5.0 * (6.0 * t).sin(), 0.03 * (6.0 * t).cos());
        let noise = 0.3 * (997.0 * t * t).sin();
        let force = 20.0 * (v / 1e-4).tanh() + 60.0 * v - 0.324 * x + noise;
        text.push_str(&format!(
            "{t:.4},{:.8e},{:.5e}\n",
            longer * x,
            stronger * force
        ));
    }
    text
}

const AS_IT_IS: [f64; 2] = [1.0, 1.0];

/// What a shell says to a line; code and all that was written.
fn shell(folder: &Path, line: &str) -> (i32, String) {
    let program = Path::new(env!("CARGO_BIN_EXE_stiction")).parent().unwrap();
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::iter::once(program.to_owned()).chain(std::env::split_paths(&paths));
    let output = Command::new("sh")
        .args(["-c", line])
        .env("PATH", std::env::join_paths(paths).unwrap())
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let (code, out, err) = crate::split(output);
    (code, out + &err)
}

/// The commands that a text leads to.
fn commands(said: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in said.lines() {
        let line = line.trim_start();
        let line = line.strip_prefix("stiction: ").unwrap_or(line);
        for label in ["next", "then"] {
            let Some(rest) = line.strip_prefix(label) else {
                continue;
            };
            // Prose begins with these words too, without a command behind them.
            let is_prose = label == "then" && !rest.contains("stiction ");
            match rest.strip_prefix(": ") {
                Some(command) => found.push(command.to_owned()),
                None => assert!(is_prose, "{said}"),
            }
        }
    }
    found
}

/// Each line is refused, leads on, and leads to commands that are read: another refusal may follow, but of what is in a file.
fn lead_on(folder: &Path, lines: &[&str]) {
    for line in lines {
        let (code, said) = shell(folder, &format!("stiction {line}"));
        assert_eq!(code, 2, "{line}: {said}");
        let next = commands(&said);
        assert!(!next.is_empty(), "{line}: {said}");
        for command in next {
            let begins = ["stiction ", "ls ", "mkdir -p "];
            assert!(begins.iter().any(|b| command.starts_with(b)), "{said}");
            // A plan is long work; help is given only behind words that are read.
            let typed = match command.starts_with("stiction plan ") {
                true => format!("{command} --help"),
                false => command.clone(),
            };
            let (_, answer) = shell(folder, &typed);
            assert!(
                !answer.lines().any(|line| line.starts_with("error: "))
                    && !answer.contains("not found"),
                "{line}: {said}\n{command}: {answer}"
            );
        }
    }
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("log.csv", &log("mm", AS_IT_IS));
    write("my log.csv", &log("mm", AS_IT_IS));
    write("turns.csv", &log("deg", AS_IT_IS));
    write("vast.csv", &log("mm", [1.0, 1e13]));
    write("empty.csv", "");
    let few: String = log("mm", AS_IT_IS)
        .lines()
        .take(60)
        .map(|l| format!("{l}\n"))
        .collect();
    write("few.csv", &few);
    write(
        "damaged.csv",
        &log("mm", AS_IT_IS).replace("\n0.1000,", "\n0.1000;"),
    );
    let still: Vec<String> = (0..3000)
        .map(|k| format!("{},1.0,{}\n", k, k % 7))
        .collect();
    write(
        "still.csv",
        &format!("Time [ms],Position [mm],Force [N]\n{}", still.concat()),
    );
    write("bare.toml", "kind = \"linear\"\n");
    write(
        "axis.toml",
        "kind = \"linear\"\nrate = \"500 Hz\"\n[log]\nresolution = \"1 um\"\n[limits]\nstroke = [\"-50 mm\", \"50 mm\"]\n\
         speed = \"0.2 m/s\"\nacceleration = \"5 m/s2\"\nrated_force = \"100 N\"\nmass = \"10 kg\"\n",
    );
    std::fs::create_dir(folder.path().join("none")).unwrap();
    folder
}

#[test]
fn of_a_plan() {
    let folder = folder();
    lead_on(
        folder.path(),
        &[
            "plan axis.toml --time 0s --out p",
            "plan axis.toml --time 1e9s --out p",
            "plan axis.toml --time=-3s --out p",
            "plan axis.toml --want 'sigmo < 2 %' --out p",
            "plan axis.toml --want 'sigma0 < 2' --want 'mass < 5 %' --out p",
            "plan axis.toml --want='sigma0 < nan %' --out p",
            "plan axis.toml --law gms --want 'x < 1 %' --out p",
            "plan axis.toml --start '10 deg' --out p",
            "plan axis.toml --start 'nan mm' --out p",
            "plan axis.toml --law gms --out p",
            "plan axis.toml --law gms --stage probe --out p",
            "plan axis.toml --law gms --asymmetric --log log.csv --out p",
            "plan axis.toml --log empty.csv --out p",
            "plan axis.toml --log few.csv --out p",
            "plan axis.toml --log still.csv --out p",
            "plan axis.toml --model nowhere.toml --out p",
            "plan axis.toml --model axis.toml --out p",
            "plan bare.toml --out p",
            "plan bare.toml --log log.csv --out p",
            "plan axsi.toml --out p",
            "plan log.csv --out p",
            "plan axis.toml --format sst --out p",
            "plan axis.toml --wnat 'all < 2 %' --out p",
            "plan axis.toml --law lurge --out p",
            "plan axis.toml",
            "plan",
        ],
    );
}

#[test]
fn of_an_identification() {
    let folder = folder();
    lead_on(
        folder.path(),
        &[
            "identify empty.csv --out r",
            "identify few.csv --out r",
            "identify still.csv --out r",
            "identify damaged.csv --out r",
            "identify vast.csv --out r",
            "identify nowhere.csv --out r",
            "identify lgo.csv --out r",
            "identify none --out r",
            "identify axis.toml --out r",
            "identify log.csv --axis nowhere.toml --out r",
            "identify log.csv --axis my.toml --out r",
            "identify log.csv log.csv --out r",
            "identify log.csv 'my log.csv' --out r",
            "identify log.csv turns.csv --out r",
            "identify log.csv --validate log.csv --out r",
            "identify log.csv --split 0 --out r",
            "identify log.csv --split 2 --law lugre --out r",
            "identify log.csv --plan nowhere.toml --out r",
            "identify log.csv --plan axis.toml --out r",
            "identify log.csv --cost six --out r",
            "identify log.csv --method ga --evaluations 0 --out r",
            "identify log.csv --method static --model axis.toml --out r",
            "identify log.csv --method ga --law coulomb-viscous --out r",
            "identify log.csv --method output-error --law elasto-plastic --out r",
            "identify log.csv --law lurge --out r",
            "identify log.csv",
            "identify",
            "idenfity log.csv --out r",
        ],
    );
}

#[test]
fn of_the_other_commands() {
    let folder = folder();
    lead_on(
        folder.path(),
        &[
            "check empty.csv",
            "check damaged.csv",
            "check vast.csv",
            "check nowhere.csv",
            "check none",
            "check .",
            "check log.csv --init axis.toml",
            "check log.csv --init none/new/axis.toml",
            "export log.csv --target c --out c",
            "export log.csv",
            "export axis.toml --target c --out c",
            "simulate log.csv --out s",
            "simulate nowhere.toml --out s",
            "simulate axis.toml",
            "batch none --out b",
            "batch nowhere --out b",
            "drift none",
            "drift .",
            "drift log.csv",
            "drift nowhere.parquet",
        ],
    );
}

/// What an identification writes of sizes that no machine has is read by the commands that follow.
#[test]
#[ignore = "soak: identifications beside it"]
fn of_units_that_are_wrong_by_many_powers_of_ten() {
    let folder = folder();
    let sizes = [[1.0, 1e10], [1e-9, 1.0], [1e12, 1.0], [1.0, 1e-9]];
    for (k, sizes) in sizes.into_iter().enumerate() {
        std::fs::write(folder.path().join("log.csv"), log("mm", sizes)).unwrap();
        let identify = format!("stiction identify log.csv --law lugre --out r{k}");
        let (code, said) = shell(folder.path(), &identify);
        assert!(code < 2, "{said}");
        let export = format!("stiction export r{k}/model.toml --target c --gain 0.1 --out c{k}");
        let (_, answer) = shell(folder.path(), &export);
        assert!(!answer.contains("[bad-config]"), "{sizes:?}: {answer}");
        if folder.path().join(format!("r{k}/study.toml")).exists() {
            let simulate =
                format!("stiction simulate r{k}/study.toml --out s{k} --max-samples 1e8");
            let (code, answer) = shell(folder.path(), &simulate);
            assert!(code < 2, "{sizes:?}: {answer}");
        }
    }
}

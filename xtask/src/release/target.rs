//! Kinds of machine that releases are built for: how a program is built for one, with the same bytes from any folder, and
//! how it is run here.

use crate::python;
use crate::shell::{self, Outcome};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The glibc that Linux programs and wheels need, or a later one: of 2012, and what manylinux2014 allows.
pub const GLIBC: &str = "2.17";

/// A kind of machine, as cargo names it.
#[derive(Clone, Debug, PartialEq)]
pub struct Target(pub String);

impl Target {
    /// The one that this compiler runs on.
    pub fn host() -> Result<Self, String> {
        let text = shell::output(shell::command(&rustc(), &["-vV"]))?;
        let host = text.lines().find_map(|line| line.strip_prefix("host: "));
        Ok(Self(host.ok_or("rustc names no host")?.into()))
    }

    /// The last word of the command line.
    pub fn typed() -> Result<Self, String> {
        let word = std::env::args().next_back().unwrap_or_default();
        let known = word.split('-').count() >= 3;
        let valid = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        match known && word.chars().all(valid) {
            true => Ok(Self(word)),
            false => Err(format!(
                "`{word}` is no target, such as aarch64-unknown-linux-gnu"
            )),
        }
    }

    /// Whether its programs need a glibc, and so are linked by zig, which knows the old ones.
    pub fn has_glibc(&self) -> bool {
        self.0.ends_with("-linux-gnu")
    }

    /// The program, in the target folder.
    pub fn program(&self) -> PathBuf {
        let name = match self.0.contains("-windows-") {
            true => "stiction.exe",
            false => "stiction",
        };
        shell::target().join(&self.0).join("dist").join(name)
    }

    /// Builds the program as users get it.
    pub fn build(&self) -> Outcome {
        let arguments = "--profile dist --locked --workspace --bin stiction --target";
        let mut build = if self.has_glibc() {
            let target = format!("{}.{GLIBC}", self.0);
            let arguments = ["zigbuild"].into_iter().chain(arguments.split_whitespace());
            let arguments: Vec<&str> = arguments.chain([target.as_str()]).collect();
            python::release("cargo-zigbuild", &arguments)?
        } else {
            shell::cargo(&format!("build {arguments} {}", self.0))
        };
        reproducible(&mut build)?;
        shell::run(build)
    }

    /// A program of this kind, to be run here: by itself, or under qemu.
    pub fn command(
        &self,
        folder: &Path,
        program: &Path,
        arguments: &[&str],
    ) -> Result<Command, String> {
        let program = program.to_string_lossy().into_owned();
        let arch = self.0.split('-').next().unwrap_or_default();
        let mut command = if *self == Self::host()? || self.0.ends_with("-apple-darwin") {
            shell::command(&program, arguments)
        } else {
            let qemu = [format!("qemu-{arch}"), format!("qemu-{arch}-static")];
            let qemu = qemu
                .iter()
                .find(|name| shell::on_path(name))
                .ok_or_else(|| {
                    format!(
                        "programs for {} do not run here; install qemu-user and libc6-{arch}-cross",
                        self.0
                    )
                })?;
            let libraries = format!("/usr/{arch}-linux-gnu");
            shell::command(qemu, &[&["-L", &libraries, &program], arguments].concat())
        };
        command.current_dir(folder);
        Ok(command)
    }
}

/// Keeps the folders of this machine and the time out of what is built.
pub fn reproducible(command: &mut Command) -> Outcome {
    let root = shell::root();
    let root = root.canonicalize().unwrap_or(root);
    let mut flags = vec![
        format!("--remap-path-prefix={}=/stiction", root.display()),
        format!("--remap-path-prefix={}=/cargo", cargo_home()?.display()),
    ];
    // With the component rust-src the compiler names its own sources by their place here.
    let sysroot = shell::output(shell::command(&rustc(), &["--print", "sysroot"]))?;
    let sources = Path::new(sysroot.trim()).join("lib/rustlib/src/rust");
    if sources.is_dir() {
        flags.push(format!("--remap-path-prefix={}=/rust", sources.display()));
    }
    command
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"))
        .env("SOURCE_DATE_EPOCH", commit_time()?);
    Ok(())
}

/// When the commit was made, seconds since 1970.
pub fn commit_time() -> Result<String, String> {
    let time = shell::output(shell::command("git", &["log", "-1", "--format=%ct"]))?;
    Ok(time.trim().into())
}

/// Where cargo keeps the sources of packages.
pub fn cargo_home() -> Result<PathBuf, String> {
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let user = || {
        let home = std::env::var_os("HOME").or_else(|| std::env::var_os("USERPROFILE"));
        home.map(|home| PathBuf::from(home).join(".cargo"))
    };
    home.or_else(user).ok_or_else(|| "no CARGO_HOME".into())
}

/// The compiler that cargo will use.
fn rustc() -> String {
    std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into())
}

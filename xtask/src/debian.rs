//! Debian packages that tests need.

use crate::shell::{self, Outcome};
use std::thread;
use std::time::{Duration, Instant};

/// A package, needed unless the program it brings is already on the PATH from elsewhere.
struct Package {
    name: &'static str,
    program: Option<&'static str>,
    why: &'static str,
}

const PACKAGES: &[Package] = &[
    Package {
        name: "build-essential",
        program: Some("gcc"),
        why: "a C compiler",
    },
    Package {
        name: "valgrind",
        program: Some("valgrind"),
        why: "counts instructions",
    },
    Package {
        name: "strace",
        program: Some("strace"),
        why: "ends commands between two system calls",
    },
    Package {
        name: "cppcheck",
        program: Some("cppcheck"),
        why: "checks exported C against MISRA",
    },
    Package {
        name: "g++",
        program: Some("g++"),
        why: "builds matiec",
    },
    Package {
        name: "autoconf",
        program: Some("autoreconf"),
        why: "builds matiec",
    },
    Package {
        name: "automake",
        program: Some("automake"),
        why: "builds matiec",
    },
    Package {
        name: "flex",
        program: Some("flex"),
        why: "builds matiec",
    },
    Package {
        name: "bison",
        program: Some("bison"),
        why: "builds matiec",
    },
    Package {
        name: "linuxcnc-uspace",
        program: Some("halrun"),
        why: "runs exported HAL components",
    },
    Package {
        name: "linuxcnc-uspace-dev",
        program: Some("halcompile"),
        why: "builds exported HAL components",
    },
    Package {
        name: "libyaml-cpp-dev",
        program: None,
        why: "reads exported parameters of ROS 2",
    },
    Package {
        name: "liburdfdom-tools",
        program: Some("check_urdf"),
        why: "reads exported URDF",
    },
    Package {
        name: "libsdformat-dev",
        program: None,
        why: "reads exported SDFormat",
    },
    Package {
        name: "octave",
        program: Some("octave-cli"),
        why: "runs exported functions of MATLAB",
    },
    Package {
        name: "gcc-avr",
        program: Some("avr-g++"),
        why: "compiles exported C++ for AVR",
    },
    Package {
        name: "avr-libc",
        program: None,
        why: "the C library of AVR",
    },
    Package {
        name: "simavr",
        program: Some("simavr"),
        why: "runs what was compiled for AVR",
    },
    Package {
        name: "gcc-arm-none-eabi",
        program: Some("arm-none-eabi-g++"),
        why: "compiles exported C++ for ARM",
    },
    Package {
        name: "libnewlib-arm-none-eabi",
        program: None,
        why: "the C library of ARM without an operating system",
    },
    Package {
        name: "qemu-user",
        program: Some("qemu-arm"),
        why: "runs what was compiled for ARM",
    },
    Package {
        name: "gcc-aarch64-linux-gnu",
        program: Some("aarch64-linux-gnu-gcc"),
        why: "compiles exported FMUs for 64-bit ARM",
    },
    Package {
        name: "libc6-dev-arm64-cross",
        program: None,
        why: "the C library of 64-bit ARM",
    },
    Package {
        name: "chromium",
        program: Some("chromium"),
        why: "opens the page of stiction studio",
    },
    Package {
        name: "gcc-mingw-w64-x86-64-win32",
        program: Some("x86_64-w64-mingw32-gcc"),
        why: "compiles exported FMUs for Windows",
    },
];

/// What building Python needs, which no test does.
const FOR_PYTHON: &[Package] = &[
    Package {
        name: "build-essential",
        program: Some("make"),
        why: "builds Python",
    },
    Package {
        name: "curl",
        program: Some("curl"),
        why: "fetches the sources of Python",
    },
    Package {
        name: "xz-utils",
        program: Some("xz"),
        why: "unpacks the sources of Python",
    },
    Package {
        name: "libffi-dev",
        program: None,
        why: "ctypes of Python",
    },
    Package {
        name: "libssl-dev",
        program: None,
        why: "pip of Python",
    },
    Package {
        name: "zlib1g-dev",
        program: None,
        why: "pip of Python",
    },
];

/// Installs what is missing as root; otherwise says the command to give.
pub fn install() -> Outcome {
    install_of(PACKAGES, |_| true)
}

/// The same of one package.
pub fn install_one(name: &str) -> Outcome {
    install_of(PACKAGES, |package| package.name == name)
}

/// The same of what building Python needs.
pub fn install_for_python() -> Outcome {
    install_of(FOR_PYTHON, |_| true)
}

fn install_of(packages: &[Package], wanted: impl Fn(&Package) -> bool) -> Outcome {
    let missing: Vec<&Package> = packages
        .iter()
        .filter(|package| wanted(package) && !present(package))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = missing.iter().map(|package| package.name).collect();
    if !is_root() || !shell::on_path("apt-get") {
        let list: Vec<String> = missing
            .iter()
            .map(|package| format!("{} ({})", package.name, package.why))
            .collect();
        return Err(format!(
            "missing: {}. Install with: sudo apt-get install {}",
            list.join(", "),
            names.join(" ")
        ));
    }
    apt_get(&["update", "-q"])?;
    apt_get(
        &[
            &["install", "-q", "-y", "--no-install-recommends"],
            &names[..],
        ]
        .concat(),
    )
}

fn present(package: &Package) -> bool {
    package.program.is_some_and(shell::on_path)
        || shell::succeeds(shell::command("dpkg", &["-s", package.name]))
}

fn is_root() -> bool {
    shell::output(shell::command("id", &["-u"])).is_ok_and(|id| id.trim() == "0")
}

/// Longest wait for another program that is installing: an unattended upgrade takes minutes.
const LOCK_TIMEOUT: Duration = Duration::from_secs(600);
/// Between two tries.
const LOCK_RETRY: Duration = Duration::from_secs(5);

/// Runs apt-get, as soon as no other program holds its locks.
fn apt_get(arguments: &[&str]) -> Outcome {
    let start = Instant::now();
    // For the lock of dpkg apt-get waits itself; held locks of lists and archives end it at once.
    let wait = format!("DPkg::Lock::Timeout={}", LOCK_TIMEOUT.as_secs());
    let arguments = [&["-o", &wait], arguments].concat();
    loop {
        let mut command = shell::command("apt-get", &arguments);
        command
            .env("DEBIAN_FRONTEND", "noninteractive")
            .env("LC_ALL", "C");
        let Err(error) = shell::run_keeping_errors(command) else {
            return Ok(());
        };
        if !error.contains("Could not get lock") || start.elapsed() > LOCK_TIMEOUT {
            return Err(error);
        }
        println!("    waits for the lock of another package manager");
        thread::sleep(LOCK_RETRY);
    }
}

/// Installs `python3-venv`, which Debian splits off from Python.
pub fn install_python_venv() -> Outcome {
    if !is_root() || !shell::on_path("apt-get") {
        return Err(
            "this Python has no ensurepip, so it cannot make a virtual environment. \
                    On Debian or Ubuntu: sudo apt-get install python3-venv"
                .into(),
        );
    }
    apt_get(&["update", "-q"])?;
    apt_get(&[
        "install",
        "-q",
        "-y",
        "--no-install-recommends",
        "python3-venv",
    ])
}

//! The platforms that an FMU can hold a binary for, and the compilers that make one.

/// A platform that both a standard and Debian's cross compilers name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Platform {
    /// Linux on x86-64.
    LinuxX86_64,
    /// Linux on 64-bit ARM; FMI 2.0 has no name for it.
    LinuxAarch64,
    /// Windows on x86-64.
    WindowsX86_64,
}

/// What makes the binary from a source on every platform; the same source and compiler give the same bytes.
const GCC: [&str; 6] = [
    "-std=c99",
    "-O2",
    "-ffp-contract=off",
    "-shared",
    "-fvisibility=hidden",
    "-s",
];

impl Platform {
    /// All, in the order in which they stand in an FMU.
    pub const ALL: [Platform; 3] = [
        Platform::LinuxX86_64,
        Platform::LinuxAarch64,
        Platform::WindowsX86_64,
    ];

    /// As FMI 3.0 names it, which is the folder of its binary there.
    pub fn name(self) -> &'static str {
        match self {
            Platform::LinuxX86_64 => "x86_64-linux",
            Platform::LinuxAarch64 => "aarch64-linux",
            Platform::WindowsX86_64 => "x86_64-windows",
        }
    }

    /// As FMI 2.0 names it, where it does.
    pub(super) fn name_in_2(self) -> Option<&'static str> {
        match self {
            Platform::LinuxX86_64 => Some("linux64"),
            Platform::LinuxAarch64 => None,
            Platform::WindowsX86_64 => Some("win64"),
        }
    }

    /// Ending of a shared library.
    pub fn extension(self) -> &'static str {
        match self {
            Platform::LinuxX86_64 | Platform::LinuxAarch64 => "so",
            Platform::WindowsX86_64 => "dll",
        }
    }

    /// The gcc that compiles for it from any machine.
    pub fn gcc(self) -> &'static str {
        match self {
            Platform::LinuxX86_64 => "x86_64-linux-gnu-gcc",
            Platform::LinuxAarch64 => "aarch64-linux-gnu-gcc",
            Platform::WindowsX86_64 => "x86_64-w64-mingw32-gcc",
        }
    }

    /// Its arguments that make the library `output` of the file `source`, both by their plain names in the folder it runs in,
    /// so that no path of this machine reaches the binary.
    pub fn arguments<'a>(self, source: &'a str, output: &'a str) -> Vec<&'a str> {
        let own: &[&str] = match self {
            Platform::LinuxX86_64 | Platform::LinuxAarch64 => &["-fPIC", "-Wl,--build-id=none"],
            // No library that a Windows machine may lack, and no date.
            Platform::WindowsX86_64 => &["-static-libgcc", "-Wl,--no-insert-timestamp"],
        };
        let files = ["-o", output, source, "-lm"];
        [&GCC[..], own, &files].concat()
    }
}

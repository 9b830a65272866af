//! LinuxCNC on the machine that runs the tests: components put where it looks for them, one test at a time.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where LinuxCNC looks for components, and nowhere else.
const MODULES: &str = "/usr/lib/linuxcnc/modules";

/// A component that is removed again.
pub struct Installed(PathBuf);

impl Installed {
    /// Builds `component`.comp of the folder and puts it where LinuxCNC looks.
    ///
    /// # Panics
    /// With what halcompile said where it fails.
    pub fn new(component: &str, dir: &Path) -> Self {
        let source = format!("{component}.comp");
        let mut command = if may_write() {
            Command::new("halcompile")
        } else {
            let mut command = Command::new("sudo");
            command.args(["-n", "halcompile"]);
            command
        };
        let output = command
            .args(["--install", &source])
            .current_dir(dir)
            .output()
            .unwrap_or_else(|e| panic!("halcompile: {e}; install with: cargo xtask setup"));
        assert!(
            output.status.success(),
            "{source}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        Self(Path::new(MODULES).join(format!("{component}.so")))
    }
}

impl Drop for Installed {
    fn drop(&mut self) {
        if std::fs::remove_file(&self.0).is_err() {
            let _ = Command::new("sudo")
                .args(["-n", "rm", "-f"])
                .arg(&self.0)
                .status();
        }
    }
}

/// Whether the user who runs the test may put components where LinuxCNC looks.
fn may_write() -> bool {
    let probe = Path::new(MODULES).join(format!(".stiction-{}", std::process::id()));
    std::fs::write(&probe, "").is_ok() && std::fs::remove_file(probe).is_ok()
}

/// Whether components may be installed; where not, the test says so and passes over. It takes root's rights from nobody
/// who has not given them: `STICTION_SUDO=1` lets it ask sudo.
///
/// # Panics
/// With `CI=true` where they may not.
pub fn may_install() -> bool {
    if may_write() || std::env::var("STICTION_SUDO").as_deref() == Ok("1") {
        return true;
    }
    let message =
        format!("{MODULES} is not ours to write: STICTION_SUDO=1 lets this test use sudo");
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{message}");
    eprintln!("SKIPPED: {message}");
    false
}

/// There is one HAL a machine: only one test runs with it at a time, in whichever workspace.
///
/// # Panics
/// Where there is no folder for temporary files.
pub fn alone() -> File {
    let path = std::env::temp_dir().join("stiction-hal.lock");
    let lock = File::options()
        .create(true)
        .append(true)
        .open(path)
        .expect("a lock file in the folder for temporary files");
    lock.lock().expect("a lock");
    lock
}

/// A program of LinuxCNC that runs in this folder, without a screen. Everybody may write there from now on: as root, HAL
/// becomes another user.
///
/// # Panics
/// Where the folder is not ours.
pub fn command(program: &str, dir: &Path) -> Command {
    let everybody = std::os::unix::fs::PermissionsExt::from_mode(0o777);
    std::fs::set_permissions(dir, everybody).expect("a folder of ours");
    let mut command = Command::new(program);
    command
        .current_dir(dir)
        .env("HOME", dir)
        .env_remove("DISPLAY")
        .env("RTAPI_UID", "65534")
        .env("RTAPI_FIFO_PATH", dir.join("fifo"));
    command
}

//! What the machine lacks is installed here, each step printed, each skipped when it is there.
//!
//! Debian-like systems with root or sudo are served by apt. Elsewhere the step says what to install
//! by hand and the command goes on with what it can.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

use crate::process::{cargo, has, output, root, run, say, target};

/// Whether something asked for is there (perhaps since now), or not and why.
pub enum Found {
    /// It is there.
    Yes,
    /// It is not; what to do.
    No(String),
}

/// The compilation target of the web modules.
pub fn wasm_target() -> Result<()> {
    rust_target("wasm32-unknown-unknown")
}

/// A compilation target.
pub fn rust_target(triple: &str) -> Result<()> {
    let installed =
        output(Command::new("rustup").args(["target", "list", "--installed"]).current_dir(root()));
    match installed {
        Some(list) if list.lines().any(|l| l.trim() == triple) => Ok(()),
        Some(_) => {
            say(&format!("adding the {triple} target"));
            run(Command::new("rustup").args(["target", "add", triple]).current_dir(root()))
        }
        None => {
            say(&format!("rustup not found: if the build fails, install the {triple} target"));
            Ok(())
        }
    }
}

/// A Debian package, known to be there by a file or a program.
pub struct Package {
    /// Name for apt.
    pub name: &'static str,
    /// What shows that it is there.
    pub sign: Sign,
    /// What it is for, and its name elsewhere.
    pub elsewhere: &'static str,
}

/// What shows that a package is there.
pub enum Sign {
    /// A program on the path.
    Program(&'static str),
    /// A file at one of these places.
    File(&'static [&'static str]),
}

/// The C compiler, for SQLite.
pub const C_COMPILER: Package = Package {
    name: "gcc libc6-dev",
    sign: Sign::Program("cc"),
    elsewhere: "a C compiler (macOS: xcode-select --install; Windows: Visual Studio Build Tools)",
};
/// The browser of the browser tests.
pub const CHROMIUM: Package = Package {
    name: "chromium",
    sign: Sign::Program("chromium"),
    elsewhere: "Chromium on the path as `chromium`",
};
/// The other browser, for a smoke run.
pub const FIREFOX: Package = Package {
    name: "firefox-esr",
    sign: Sign::Program("firefox-esr"),
    elsewhere: "Firefox, its path in MIMIQUE_FIREFOX",
};
/// A display in memory, without which Firefox draws no WebGL; and a driver on the processor.
pub const XVFB: Package = Package {
    name: "xvfb libegl1 libgl1-mesa-dri",
    // It answers no question about its version.
    sign: Sign::File(&["/usr/bin/Xvfb", "/usr/local/bin/Xvfb", "/opt/X11/bin/Xvfb"]),
    elsewhere: "Xvfb, or a desktop",
};
/// A Vulkan driver on the processor, for pictures without a graphics card.
pub const LAVAPIPE: Package = Package {
    name: "mesa-vulkan-drivers",
    sign: Sign::File(&[
        "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json",
        "/usr/share/vulkan/icd.d/lvp_icd.aarch64.json",
        "/usr/share/vulkan/icd.d/lvp_icd.json",
    ]),
    elsewhere: "a Vulkan driver (Mesa's lavapipe)",
};
/// The database server of the storage tests.
pub const POSTGRESQL: Package = Package {
    name: "postgresql",
    sign: Sign::File(&[
        "/usr/lib/postgresql/14/bin/initdb",
        "/usr/lib/postgresql/15/bin/initdb",
        "/usr/lib/postgresql/16/bin/initdb",
        "/usr/lib/postgresql/17/bin/initdb",
        "/usr/lib/postgresql/18/bin/initdb",
    ]),
    elsewhere: "PostgreSQL 14 or newer",
};
/// The reverse proxy of the server's tests.
pub const NGINX: Package = Package {
    name: "nginx-light",
    sign: Sign::File(&["/usr/sbin/nginx", "/usr/local/sbin/nginx", "/opt/homebrew/bin/nginx"]),
    elsewhere: "nginx 1.18 or newer",
};
/// The statistics that the written-out R scripts are compared with.
pub const R: Package = Package {
    name: "r-base-core",
    sign: Sign::Program("Rscript"),
    elsewhere: "R 4 or newer (Rscript on the path)",
};
/// The mixed models that ours are compared with.
pub const ORDINAL: Package = Package {
    name: "r-cran-ordinal",
    sign: Sign::File(&[
        "/usr/lib/R/site-library/ordinal/DESCRIPTION",
        "/usr/local/lib/R/site-library/ordinal/DESCRIPTION",
    ]),
    elsewhere: "the R package ordinal (install.packages(\"ordinal\"))",
};
/// The linear mixed models that ours are compared with.
pub const LMER_TEST: Package = Package {
    name: "r-cran-lmertest",
    sign: Sign::File(&[
        "/usr/lib/R/site-library/lmerTest/DESCRIPTION",
        "/usr/local/lib/R/site-library/lmerTest/DESCRIPTION",
    ]),
    elsewhere: "the R package lmerTest (install.packages(\"lmerTest\"))",
};
/// Python with environments of its own, for the peers of tests and benchmarks.
pub const PYTHON: Package = Package {
    name: "python3 python3-venv",
    sign: Sign::File(&[
        "/usr/lib/python3.11/ensurepip/__init__.py",
        "/usr/lib/python3.12/ensurepip/__init__.py",
        "/usr/lib/python3.13/ensurepip/__init__.py",
        "/usr/lib/python3.14/ensurepip/__init__.py",
    ]),
    elsewhere: "Python 3.11 or newer with venv and pip",
};
/// What packs and unpacks Debian packages.
pub const DPKG: Package = Package {
    name: "dpkg",
    sign: Sign::Program("dpkg-deb"),
    elsewhere: "dpkg (macOS: brew install dpkg)",
};
/// What runs programs of another processor.
pub const QEMU: Package = Package {
    name: "qemu-user",
    sign: Sign::Program("qemu-aarch64"),
    elsewhere: "qemu-user (the programs qemu-aarch64 and qemu-x86_64)",
};
/// What reads the formula of Homebrew.
pub const RUBY: Package =
    Package { name: "ruby", sign: Sign::Program("ruby"), elsewhere: "Ruby, of any version" };

/// npm's name as a program: on Windows it is a script, which a name without its ending does not find.
pub const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

impl Package {
    fn present(&self) -> bool {
        match self.sign {
            Sign::Program(program) => has(program),
            Sign::File(places) => places.iter().any(|p| Path::new(p).exists()),
        }
    }

    /// Installs the package unless it is there.
    pub fn ensure(&self) -> Found {
        if self.present() {
            return Found::Yes;
        }
        let remedy = format!("install {}", self.elsewhere);
        let (Some(mut update), Some(mut install)) = (apt(), apt()) else {
            return Found::No(remedy);
        };
        say(&format!("installing {}", self.name));
        static LISTS_FRESH: AtomicBool = AtomicBool::new(false);
        if !LISTS_FRESH.swap(true, Ordering::Relaxed) {
            // A stale list is not fatal: the install below says whether it matters.
            let _ = update.args(["-qq", "update"]).stdin(Stdio::null()).status();
        }
        install
            .args(["-qq", "-y", "install", "--no-install-recommends"])
            .args(self.name.split(' '));
        match run(install.stdin(Stdio::null()).stdout(Stdio::null())) {
            Ok(()) if self.present() => Found::Yes,
            _ => Found::No(remedy),
        }
    }
}

/// `apt-get` with the rights to install, or nothing.
fn apt() -> Option<Command> {
    if !has("apt-get") {
        return None;
    }
    let root_user = output(Command::new("id").arg("-u"))?.trim() == "0";
    let mut command = if root_user {
        Command::new("apt-get")
    } else {
        output(Command::new("sudo").args(["-n", "true"]))?;
        let mut sudo = Command::new("sudo");
        sudo.args(["-n", "DEBIAN_FRONTEND=noninteractive", "apt-get"]);
        sudo
    };
    command.env("DEBIAN_FRONTEND", "noninteractive");
    Some(command)
}

/// The test runner.
pub fn nextest() -> Result<()> {
    if output(cargo().args(["nextest", "--version"])).is_some() {
        return Ok(());
    }
    say("installing cargo-nextest (some minutes, once)");
    run(cargo().args(["install", "--locked", "cargo-nextest"]))
}

/// The packages of `folder/package.json`, at the versions of its lock file.
pub fn npm(folder: &Path) -> Result<Found> {
    if !has(NPM) {
        return Ok(Found::No("install Node.js 20 or newer with npm".into()));
    }
    let lock = folder.join("package-lock.json");
    let wanted = std::fs::read(&lock).with_context(|| lock.display().to_string())?;
    let stamp = folder.join("node_modules/.installed-lock");
    if std::fs::read(&stamp).ok().as_deref() == Some(&wanted) {
        return Ok(Found::Yes);
    }
    say(&format!(
        "installing the npm packages of {}",
        folder.strip_prefix(root()).unwrap_or(folder).display()
    ));
    run(Command::new(NPM)
        .args(["ci", "--no-audit", "--no-fund", "--ignore-scripts", "--loglevel=error"])
        .current_dir(folder))?;
    std::fs::write(&stamp, wanted)?;
    Ok(Found::Yes)
}

/// A Python environment in `target/NAME` with the packages that `requirements` pins. Its interpreter,
/// or what to do.
pub fn python(name: &str, requirements: &Path) -> Result<std::result::Result<PathBuf, String>> {
    let wanted = std::fs::read(requirements).with_context(|| requirements.display().to_string())?;
    let environment = target().join(name);
    let interpreter =
        environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let stamp = environment.join(".installed-requirements");
    if std::fs::read(&stamp).ok().as_deref() == Some(&wanted) {
        return Ok(Ok(interpreter));
    }
    let python = if cfg!(windows) { "python" } else { "python3" };
    let usable = output(Command::new(python).args(["-c", "import ensurepip, venv"])).is_some();
    if !usable && let Found::No(remedy) = PYTHON.ensure() {
        return Ok(Err(remedy));
    }
    say(&format!("installing the Python packages of {}", requirements.display()));
    run(Command::new(python).args(["-m", "venv", "--clear"]).arg(&environment))?;
    run(Command::new(&interpreter)
        .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"])
        .arg(requirements))?;
    std::fs::write(&stamp, wanted)?;
    Ok(Ok(interpreter))
}

//! Which machine and which program made a result.

use serde::Serialize;

/// The program that made a result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Program {
    /// Name of the program.
    pub name: String,
    /// Its version.
    pub version: String,
    /// How it was built: `release`, or `debug` where slow checks are on and times mean little.
    pub build: String,
}

impl Program {
    /// This program.
    #[must_use]
    pub fn this() -> Self {
        Self {
            name: PROGRAM.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            build: if cfg!(debug_assertions) { "debug" } else { "release" }.to_owned(),
        }
    }
}

/// The name under which this program signs its results.
pub const PROGRAM: &str = "linkdyn";

/// The machine that a result was made on. It names no user and no host.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Operating system, such as `linux`.
    pub os: String,
    /// Processor architecture, such as `x86_64`.
    pub arch: String,
    /// Model name of the processor, where the system tells it.
    pub cpu: Option<String>,
    /// Number of cores that the program may use, where the system tells it.
    pub cores: Option<usize>,
}

impl Machine {
    /// This machine. What the system does not tell is `None`.
    #[must_use]
    pub fn this() -> Self {
        Self {
            os: std::env::consts::OS.to_owned(),
            arch: std::env::consts::ARCH.to_owned(),
            cpu: cpu(),
            cores: std::thread::available_parallelism().ok().map(usize::from),
        }
    }
}

fn cpu() -> Option<String> {
    if cfg!(target_os = "linux") {
        cpu_of(&std::fs::read_to_string("/proc/cpuinfo").ok()?)
    } else if cfg!(target_os = "macos") {
        let asked = std::process::Command::new("/usr/sbin/sysctl")
            .args(["-n", "machdep.cpu.brand_string"])
            .output();
        tidy(&String::from_utf8_lossy(&asked.ok()?.stdout))
    } else {
        tidy(&std::env::var("PROCESSOR_IDENTIFIER").ok()?)
    }
}

/// The model name in the text of `/proc/cpuinfo`; some architectures call it otherwise or do not have it.
fn cpu_of(cpuinfo: &str) -> Option<String> {
    ["model name", "Model", "cpu model", "uarch", "Hardware", "cpu"]
        .iter()
        .find_map(|wanted| {
            cpuinfo.lines().find_map(|line| {
                let (key, value) = line.split_once(':')?;
                if key.trim() == *wanted { tidy(value) } else { None }
            })
        })
}

fn tidy(text: &str) -> Option<String> {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    (!text.is_empty()).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_machine_has_a_system_and_cores() {
        let machine = Machine::this();
        assert!(!machine.os.is_empty() && !machine.arch.is_empty());
        assert!(machine.cores.is_none_or(|n| n > 0));
        let json = serde_json::to_value(&machine).unwrap();
        assert_eq!(json["os"], std::env::consts::OS);
    }

    #[test]
    fn the_program_signs_with_its_name_and_version() {
        let json = serde_json::to_value(Program::this()).unwrap();
        assert_eq!(json["name"], "linkdyn");
        assert_eq!(json["version"], env!("CARGO_PKG_VERSION"));
    }

    #[test]
    fn model_name_is_found_and_tidied() {
        let text = "processor\t: 0\nmodel\t\t: 106\nmodel name\t: Some  CPU @ 2.60GHz\nmodel name\t: Other\n";
        assert_eq!(cpu_of(text).as_deref(), Some("Some CPU @ 2.60GHz"));
        assert_eq!(cpu_of("processor\t: 0\nBogoMIPS\t: 50\n"), None);
        assert_eq!(cpu_of("model name\t:\nModel\t: Board 4\n").as_deref(), Some("Board 4"));
        assert_eq!(cpu_of(""), None);
    }
}

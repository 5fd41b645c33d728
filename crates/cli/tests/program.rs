//! The program as a user starts it.

use std::process::{Command, Output};

fn linkdyn(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_linkdyn"))
        .args(words)
        .output()
        .expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("not killed")
}

#[test]
fn version_and_help_go_to_standard_output() {
    let version = linkdyn(&["--version"]);
    assert_eq!(code(&version), 0);
    assert_eq!(
        String::from_utf8_lossy(&version.stdout),
        format!("linkdyn {}\n", env!("CARGO_PKG_VERSION"))
    );
    let help = linkdyn(&["run", "--help"]);
    assert_eq!(code(&help), 0);
    for option in [
        "--friction",
        "--out",
        "--method",
        "--rtol",
        "--atol",
        "--step",
        "--until",
        "--every",
        "--json",
    ] {
        assert!(String::from_utf8_lossy(&help.stdout).contains(option), "{option}");
    }
}

#[test]
fn wrong_usage_has_exit_code_2_and_a_message_on_standard_error() {
    for words in [
        &[][..],
        &["fly"],
        &["run"],
        &["run", "rsrrr", "--out", "x", "--rtol", "-1"],
        &["run", "rsrrr", "--uot", "x"],
    ] {
        let output = linkdyn(words);
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{words:?}");
    }
}

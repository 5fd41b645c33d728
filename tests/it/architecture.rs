//! The promises of ARCHITECTURE.md, checked against manifests and sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Library crates of the workspace, by folder.
const LIBRARIES: [&str; 7] = [
    "kinematics",
    "dynamics",
    "contact",
    "friction",
    "integrators",
    "rfem",
    "mechanisms",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap()
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All files below `folder` (relative to the root), build results and hidden folders but `.ci` apart; relative to the root.
fn files(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let skipped = ["target", "out"].contains(&name.as_str()) || (name.starts_with('.') && name != ".ci");
            if path.is_dir() && !skipped {
                folders.push(path);
            } else if path.is_file() && !skipped {
                found.push(path.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

fn sources(folder: &str) -> Vec<String> {
    files(folder).into_iter().filter(|path| path.ends_with(".rs")).collect()
}

/// The text without line comments (doc comments included).
fn code(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

/// Words in lower case: identifiers fall apart at underscores and where a capital follows a small letter.
fn words(text: &str) -> BTreeSet<String> {
    let mut spaced = String::new();
    let mut before = ' ';
    for c in text.chars() {
        if c.is_uppercase() && before.is_lowercase() {
            spaced.push(' ');
        }
        spaced.push(if c.is_alphabetic() { c } else { ' ' });
        before = c;
    }
    spaced.split_whitespace().map(str::to_lowercase).collect()
}

/// Fails where a file contains one of the words, alone or with a plural s.
fn assert_without(paths: &[String], view: fn(&str) -> String, forbidden: &[&str]) {
    assert!(!paths.is_empty());
    let mut hits = Vec::new();
    for path in paths {
        let found = words(&view(&read(path)));
        let hit = |word: &&&str| found.contains(**word) || found.contains(&format!("{word}s"));
        hits.extend(forbidden.iter().filter(hit).map(|word| format!("{path}: {word}")));
    }
    assert!(hits.is_empty(), "words that have no place here:\n{}", hits.join("\n"));
}

/// Code spans (between backticks) of a Markdown text, with the number of the line they stand in; code blocks are left out.
fn code_spans(text: &str) -> Vec<(usize, String)> {
    let mut spans = Vec::new();
    let mut block = false;
    for (number, line) in text.lines().enumerate() {
        if line.starts_with("```") {
            block = !block;
        } else if !block {
            spans.extend(line.split('`').skip(1).step_by(2).map(|span| (number, span.to_owned())));
        }
    }
    spans
}

fn looks_like_a_path(span: &str) -> bool {
    let folders = [
        ".ci/",
        "crates/",
        "docs/",
        "src/",
        "tests/",
        "tools/",
        "benches/",
        "examples/",
        "it/",
    ];
    !span.contains(char::is_whitespace)
        && !span.contains('*')
        && (folders.iter().any(|folder| span.starts_with(folder))
            || [".rs", ".md", ".toml"].iter().any(|end| span.ends_with(end)))
}

/// What ARCHITECTURE.md names: each path, resolved against the folder in the heading above it, or against the root.
fn named_paths() -> Vec<String> {
    let text = read("ARCHITECTURE.md");
    let mut heading = String::new();
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.starts_with('#') {
            heading = line.split('`').nth(1).unwrap_or_default().to_owned();
        }
        lines.push(heading.clone());
    }
    let spans = code_spans(&text)
        .into_iter()
        .filter(|(_, span)| looks_like_a_path(span));
    let resolve = |(line, span): (usize, String)| {
        let below = format!("{}/{span}", lines[line]);
        if !lines[line].is_empty() && root().join(&below).exists() {
            below
        } else {
            span
        }
    };
    spans.map(resolve).collect()
}

#[derive(Debug, PartialEq, Eq, Default)]
struct Allowed {
    members: BTreeSet<String>,
    others: Option<BTreeSet<String>>,
}

/// Rows of the dependency table: package, members, other crates ("any" lifts the restriction).
fn dependency_table() -> BTreeMap<String, Allowed> {
    let text = read("ARCHITECTURE.md");
    let (_, after) = text
        .split_once("| package | members | other crates |")
        .expect("the table's head");
    let rows = after.lines().skip(2).take_while(|line| line.starts_with('|'));
    let names = |cell: &str| {
        cell.split('`')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect::<BTreeSet<_>>()
    };
    rows.map(|row| {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let allowed = Allowed {
            members: names(cells[2]),
            others: (cells[3] != "any").then(|| names(cells[3])),
        };
        (cells[1].trim_matches('`').to_owned(), allowed)
    })
    .collect()
}

#[test]
fn dependencies_are_those_of_the_table() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let table = dependency_table();
    let packages = metadata["packages"].as_array().unwrap();
    let members: BTreeSet<&str> = packages.iter().map(|p| p["name"].as_str().unwrap()).collect();
    let listed: BTreeSet<&str> = table.keys().map(String::as_str).collect();
    assert_eq!(members, listed, "members of the workspace, packages of the table");
    for package in packages {
        let name = package["name"].as_str().unwrap();
        let (mut found, mut for_tests) = (Allowed::default(), BTreeSet::new());
        let mut others = BTreeSet::new();
        for dependency in package["dependencies"].as_array().unwrap() {
            let needed = dependency["name"].as_str().unwrap().to_owned();
            match (dependency["kind"].as_str(), members.contains(needed.as_str())) {
                (None, true) => found.members.insert(needed),
                (None, false) => others.insert(needed),
                (_, true) => for_tests.insert(needed),
                _ => false,
            };
        }
        found.others = table[name].others.as_ref().map(|_| others);
        assert_eq!(found, table[name], "manifest of {name} (left), ARCHITECTURE.md (right)");
        // A member as dev-dependency of a library would make a circle of tests; such tests live in the package linkdyn-tests.
        let library = LIBRARIES
            .iter()
            .any(|crate_name| name == format!("linkdyn-{crate_name}"));
        assert!(
            !library || for_tests.is_empty(),
            "{name} needs {for_tests:?} for its tests"
        );
    }
}

#[test]
fn every_path_named_exists() {
    let named = named_paths();
    assert!(named.len() > 50);
    let missing: Vec<_> = named.iter().filter(|path| !root().join(path).exists()).collect();
    assert!(missing.is_empty(), "ARCHITECTURE.md names {missing:?}");
}

#[test]
fn every_source_is_on_the_map() {
    let named: BTreeSet<_> = named_paths()
        .iter()
        .map(|path| path.trim_end_matches('/').to_owned())
        .collect();
    let on_the_map = |path: &String| {
        let above = Path::new(path).ancestors().map(|p| p.to_string_lossy().into_owned());
        // A folder named as a whole stands for its files; the folder `src` stands for nothing.
        above
            .into_iter()
            .any(|p| !p.ends_with("/src") && named.contains(&p) && p.matches('/').count() >= 2)
    };
    let forgotten: Vec<_> = sources("crates")
        .into_iter()
        .filter(|path| path.contains("/src/") && !path.ends_with("/src/lib.rs") && !on_the_map(path))
        .collect();
    assert!(
        forgotten.is_empty(),
        "ARCHITECTURE.md does not tell what these are for: {forgotten:?}"
    );
}

#[test]
fn every_test_named_exists() {
    let mut all = String::new();
    let tests = files("crates").into_iter().chain(files("tests"));
    tests
        .filter(|path| path.ends_with(".rs") && path.contains("test"))
        .for_each(|path| all += &read(path));
    let text = read("ARCHITECTURE.md");
    let (_, invariants) = text.split_once("## Invariants").expect("the section");
    let named: Vec<_> = code_spans(invariants).into_iter().map(|(_, span)| span).collect();
    let named: Vec<_> = named.iter().filter_map(|span| span.rsplit_once("::")).collect();
    assert!(named.len() > 15);
    for (module, test) in named {
        assert!(
            all.contains(&format!("fn {test}(")),
            "ARCHITECTURE.md names {module}::{test}"
        );
    }
}

#[test]
fn integrators_know_no_mechanics() {
    let forbidden = [
        "body",
        "bodies",
        "joint",
        "link",
        "linkage",
        "mechanism",
        "friction",
        "contact",
        "torque",
        "wrench",
    ];
    assert_without(&sources("crates/integrators/src"), str::to_owned, &forbidden);
    assert_without(
        &sources("crates/integrators/src"),
        str::to_owned,
        &["beam", "mass", "inertia"],
    );
}

#[test]
fn kinematics_weigh_nothing() {
    let forbidden = [
        "mass", "masses", "massless", "inertia", "density", "weigh", "friction", "energy",
    ];
    assert_without(&sources("crates/kinematics/src"), str::to_owned, &forbidden);
}

/// Comments may say what an interface is for; code may not. Inertia from a density is geometry: the number is the caller's.
#[test]
fn dynamics_know_no_material_and_no_law_of_friction() {
    let all = sources("crates/dynamics/src");
    let laws = [
        "friction",
        "coulomb",
        "stribeck",
        "bristle",
        "bearing",
        "journal",
        "clearance",
        "contact",
    ];
    assert_without(&all, code, &laws);
    let materials = ["young", "modulus", "poisson", "steel", "aluminium", "viscosity"];
    assert_without(&all, str::to_owned, &materials);
    let but_one: Vec<_> = all.into_iter().filter(|path| !path.ends_with("/inertia.rs")).collect();
    assert_without(&but_one, str::to_owned, &["density", "densities"]);
}

#[test]
fn laws_have_no_memory() {
    let mut paths = sources("crates/friction/src");
    paths.extend(sources("crates/contact/src"));
    paths.extend(sources("crates/rfem/src"));
    paths.extend(["drive.rs", "joint_friction.rs"].map(|name| format!("crates/mechanisms/src/{name}")));
    for path in paths {
        let text = code(&read(&path));
        for word in ["&mut self", "Cell<", "Mutex", "Atomic", "static mut"] {
            assert!(!text.contains(word), "{path} contains `{word}`");
        }
    }
}

#[test]
fn parents_come_before_their_successors() {
    let scene = linkdyn_mechanisms::catalogue::rsrrr(&linkdyn_mechanisms::catalogue::Rsrrr::default());
    let mechanism = scene.linkage.build().unwrap();
    let nodes = mechanism.system().tree().nodes();
    assert!(nodes.iter().enumerate().skip(1).all(|(i, node)| node.parent < i));
}

#[test]
fn files_stay_short() {
    let lines = |path: &String| {
        let text = read(path);
        let own = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        code(own).lines().filter(|line| !line.trim().is_empty()).count()
    };
    let mut sizes: Vec<_> = sources("crates").into_iter().map(|path| (lines(&path), path)).collect();
    sizes.retain(|(size, _)| *size > 500);
    assert!(sizes.is_empty(), "more than 500 lines of code: {sizes:?}");
}

#[test]
fn nothing_is_unfinished_or_silenced() {
    let marks = [
        ["todo", "!("],
        ["unimplemented", "!("],
        ["dbg", "!("],
        ["#[ign", "ore"],
        ["FIX", "ME"],
    ]
    .map(|m| m.concat());
    let hits: Vec<_> = sources(".")
        .into_iter()
        .flat_map(|path| {
            let text = read(&path);
            let found = marks.iter().filter(|mark| text.contains(mark.as_str()));
            found.map(|mark| format!("{path}: {mark}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(hits.is_empty(), "{hits:?}");
}

#[test]
fn no_file_names_a_folder_of_one_machine() {
    let folders = ["work", "root", "home", "farm", "tmp", "Users"].map(|name| format!("/{name}/"));
    let ends = [".rs", ".md", ".toml", ".py", ".sh", ".json", "/run", "/instructions"];
    for path in files(".")
        .into_iter()
        .filter(|path| ends.iter().any(|end| path.ends_with(end)))
    {
        let text = read(&path);
        for (number, line) in text.lines().enumerate() {
            let hit = folders.iter().find(|folder| line.contains(folder.as_str()));
            assert!(hit.is_none(), "{path}:{}: {line}", number + 1);
        }
    }
}

#[test]
fn lints_hold_for_every_member() {
    let workspace = read("Cargo.toml");
    for lint in ["unsafe_code = \"forbid\"", "missing_docs = \"deny\""] {
        assert!(workspace.contains(lint), "Cargo.toml lacks `{lint}`");
    }
    let manifests = files(".").into_iter().filter(|path| path.ends_with("/Cargo.toml"));
    // The fuzz targets are a workspace of their own: their harness is unsafe code.
    for manifest in manifests.filter(|path| !path.contains("fuzz/")) {
        assert!(
            read(&manifest).contains("[lints]\nworkspace = true"),
            "{manifest} does not take the lints"
        );
    }
    for path in sources("crates").iter().filter(|path| path.contains("/src/")) {
        assert!(!read(path).contains("allow(missing_docs"), "{path}");
    }
}

#[test]
fn readmes_are_the_crates_documentation() {
    for name in LIBRARIES {
        let lib = read(format!("crates/{name}/src/lib.rs"));
        assert!(lib.starts_with("#![doc = include_str!(\"../README.md\")]"), "{name}");
        let readme = read(format!("crates/{name}/README.md"));
        assert!(
            readme.contains("```rust\n"),
            "the README of {name} has no compiled example"
        );
    }
}

/// A citation is a name before a year, such as in "Baumgarte 1972".
#[test]
fn citations_and_references_agree() {
    let references = read("REFERENCES.md");
    let keys: BTreeSet<String> = references
        .lines()
        .filter_map(|line| line.strip_prefix("- **"))
        .map(key)
        .collect();
    assert!(keys.len() > 5);
    let mut cited = String::new();
    for path in files("crates")
        .iter()
        .filter(|path| path.contains("/src/") || path.ends_with("README.md"))
    {
        let text = read(path);
        // Comments only; line ends of comments are spaces.
        let comment = |line: &str| {
            line.split_once("//")
                .map(|(_, c)| c.trim_start_matches(['/', '!']).to_owned())
        };
        let whole = path.ends_with(".md");
        let lines = text
            .lines()
            .filter_map(|line| if whole { Some(line.to_owned()) } else { comment(line) });
        cited += &lines
            .collect::<Vec<_>>()
            .join(" ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        cited.push('\n');
    }
    for key in &keys {
        assert!(cited.contains(key.as_str()), "nothing cites {key}");
    }
    let year = |word: &str| word.len() == 4 && word.parse().is_ok_and(|year: u32| (1850..2100).contains(&year));
    for line in cited.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        for pair in words.windows(2) {
            let (name, number) = (pair[0].trim_start_matches(['\\', '[', '(']), pair[1]);
            let number = number.trim_end_matches([',', '.', ';', ':', ')', ']', '\\']);
            if year(number) && name.chars().next().is_some_and(char::is_uppercase) && !name.ends_with(',') {
                let known = keys.iter().any(|key| key.ends_with(&format!("{name} {number}")));
                assert!(known, "REFERENCES.md lacks `{name} {number}`");
            }
        }
    }
}

fn key(line: &str) -> String {
    line.split("**").next().unwrap_or_default().to_owned()
}

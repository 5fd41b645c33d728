//! wip
#[path = "it/scene_broken.rs"]
mod scene_broken;
#[path = "it/scene_clearance.rs"]
mod scene_clearance;
#[path = "it/scene_faults.rs"]
mod scene_faults;
#[path = "it/scene_files.rs"]
mod scene_files;
#[path = "it/scene_keys.rs"]
mod scene_keys;

#[test]
fn write_expectations() {
    if std::env::var("WRITE").is_err() {
        return;
    }
    for (name, text) in scene_faults::files("corpus") {
        let body: Vec<&str> = text.lines().skip_while(|l| l.starts_with("# expects: ")).collect();
        let body = body.join("\n") + "\n";
        let n = match linkdyn_mechanisms::file::scene("file", &body) {
            Ok(_) => {
                println!("SOUND {name}");
                continue;
            }
            Err(e) => e.0.len(),
        };
        let padded = "#\n".repeat(n) + &body;
        let e = linkdyn_mechanisms::file::scene("file", &padded).expect_err("broken");
        let new: String = e.0.iter().map(|f| format!("# expects: {f}\n")).collect::<String>();
        let body = text
            .lines()
            .skip_while(|l| l.starts_with("# expects: "))
            .collect::<Vec<_>>()
            .join("\n");
        let end = if text.ends_with('\n') { "\n" } else { "" };
        let all = new + &body + end;
        if all != text {
            println!("CHANGED {name}");
            std::fs::write(&name, all).expect("written");
        }
    }
}

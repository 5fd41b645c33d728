//! The report as one page of HTML that needs nothing but itself.

use crate::machine::{Machine, Program};
use crate::summary::Table;

use super::tables::{best, certificate, remarks, rows};
use super::{Report, Section};

/// Light and dark by the reader's choice; pictures keep their light ground, which their colours are made for.
const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#222;--ground:#fff;--line:#ccc;--soft:#f4f4f4;--bad:#b3261e}
@media(prefers-color-scheme:dark){:root{--ink:#ddd;--ground:#181a1b;--line:#444;--soft:#232627;--bad:#ff8a80}}
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--ground);max-width:1320px;margin:0 auto;padding:1rem}
h1{font-size:1.6rem}h2{font-size:1.3rem;margin-top:3rem;border-top:1px solid var(--line);padding-top:1rem}
nav a,a{color:inherit}nav li{margin:.1rem 0}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;margin:.5rem 0}
th,td{padding:.15rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
th{background:var(--soft);white-space:normal;vertical-align:bottom}
th:first-child,td:first-child{text-align:left}
svg{max-width:100%;height:auto;display:block;margin:.5rem 0}
.bad{color:var(--bad)}
details{margin:.5rem 0}summary{cursor:pointer}";

/// The page of all sections; `drawn` has the pictures of each as SVG.
pub fn page(sections: &[Section], drawn: &[Vec<String>]) -> String {
    let (machine, program) = (Machine::this(), Program::this());
    let mut body = String::new();
    if sections.len() > 1 {
        body += "<nav><ul>\n";
        for (i, section) in sections.iter().enumerate() {
            body += &format!(
                "<li><a href=\"#s{i}\">{}</a>{}</li>\n",
                escaped(&section.title()),
                failed(section)
            );
        }
        body += "</ul></nav>\n";
    }
    for (i, (section, pictures)) in sections.iter().zip(drawn).enumerate() {
        body += &format!("<section id=\"s{i}\">\n<h2>{}</h2>\n", escaped(&section.title()));
        body += &match &section.outcome {
            Err(error) => format!("<p class=\"bad\">No report: {}</p>\n", lines(&error.report())),
            Ok(report) => found(report, pictures),
        };
        body += "</section>\n";
    }
    let cores = machine.cores.map_or_else(String::new, |n| format!(", {n} cores"));
    let made = format!(
        "{} {} ({} build) on {} {}, {}{cores}. Times are the least of the repeats on the clock; evaluations do not depend on the machine.",
        program.name,
        program.version,
        program.build,
        machine.os,
        machine.arch,
        machine.cpu.as_deref().unwrap_or("processor unknown"),
    );
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>linkdyn report</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n<h1>Error against work</h1>\n<p>{}</p>\n{body}</body>\n</html>\n",
        escaped(&made)
    )
}

/// A word for the list of contents.
fn failed(section: &Section) -> &'static str {
    match &section.outcome {
        Err(_) => " <span class=\"bad\">(no report)</span>",
        Ok(report) if report.failed => " <span class=\"bad\">(ended early)</span>",
        Ok(_) => "",
    }
}

/// Pictures and tables of a report.
fn found(report: &Report, pictures: &[String]) -> String {
    let class = if report.early.is_some() { " class=\"bad\"" } else { "" };
    let mut text = format!("<p{class}>{}</p>\n", lines(&certificate(report)));
    text += &pictures.join("\n");
    text += "\n<h3>Least cost at equal error</h3>\n<p>Between rows costs are interpolated by their logarithms. \
             \u{201c}Of paper's step\u{201d}: against the paper's way at its own step, where that is as accurate; \
             \u{201c}of paper's way\u{201d} and \u{201c}of rk4\u{201d}: against them at the same error.</p>\n";
    text += &html(&best(report));
    text += &format!("<p>{}</p>\n", lines(&remarks(report)));
    text += &format!(
        "<details open>\n<summary>All rows</summary>\n{}</details>\n",
        html(&rows(report))
    );
    text
}

/// A table, scrolling sideways where it is wider than the page.
fn html(table: &Table) -> String {
    let line = |tag: &str, cells: Vec<String>| {
        let cells: String = cells
            .iter()
            .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)))
            .collect();
        format!("<tr>{cells}</tr>\n")
    };
    let rows: String = table.shown().map(|cells| line("td", cells)).collect();
    format!(
        "<div class=\"scroll\"><table>\n<thead>{}</thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n",
        line("th", table.heads().collect())
    )
}

/// Text as HTML, with its line feeds.
fn lines(text: &str) -> String {
    escaped(text.trim_end()).replace('\n', "<br>\n")
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '&' => out += "&amp;",
            '"' => out += "&quot;",
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::errors::CliError;
    use crate::summary::Cell;

    #[test]
    fn a_scene_that_failed_is_shown_with_the_reason() {
        let section = |scene: &str| Section {
            scene: scene.to_owned(),
            label: "ideal <joint>".to_owned(),
            prefix: String::new(),
            outcome: Err(CliError::failed("it jammed & stopped")),
        };
        let page = page(&[section("a"), section("b")], &[Vec::new(), Vec::new()]);
        assert_eq!(page.matches("it jammed &amp; stopped").count(), 2);
        assert_eq!(page.matches("(no report)").count(), 2);
        assert!(page.contains("A: ideal &lt;joint&gt;") && !page.contains("<joint>"));
        // Nothing is fetched.
        assert!(!page.contains("http") && !page.contains("src=") && !page.contains("@import"));
    }

    #[test]
    fn tables_keep_their_cells() {
        let mut table = Table::new("x", &[("a", ""), ("b", "m")]);
        table.row([Cell::text("< 1"), Cell::count(12)]);
        let text = html(&table);
        assert!(
            text.contains("<th>b (m)</th>") && text.contains("<td>&lt; 1</td><td>12</td>"),
            "{text}"
        );
    }
}

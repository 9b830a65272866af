//! Templates. The code of a target is kept as that target's own text in `templates`.
//!
//! `@key@` is replaced by a value. A line `%if key` keeps what follows up to `%else` or `%end` where the flag is set,
//! `%if !key` where it is not; conditions nest. A line `%part path` stands for the template of that path, one idea of a
//! longer text, indented as that line is; conditions do not reach across its ends.

macro_rules! parts {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../templates/", $path)))),*]
    };
}

/// The templates that others are made of.
const PARTS: &[(&str, &str)] = parts![
    "c/adaptation.c.in",
    "c/curve.c.in",
    "c/law/bristle.c.in",
    "c/law/elastic.c.in",
    "c/law/elements.c.in",
    "c/law/steady.c.in",
    "c/law/stored.c.in",
    "c/limit.c.in",
    "c/memory.c.in",
    "c/numbers.c.in",
    "c/parameters.c.in",
    "c/reset.c.in",
    "c/step.c.in",
    "c/terms.c.in",
    "c/watchdog.c.in",
    "c/watchdog_reset.c.in",
    "matlab/adaptation.m.in",
    "matlab/adapts.m.in",
    "matlab/curve.m.in",
    "matlab/forget.m.in",
    "matlab/law/bristle.m.in",
    "matlab/law/decay.m.in",
    "matlab/law/elastic.m.in",
    "matlab/law/elements.m.in",
    "matlab/law/steady.m.in",
    "matlab/law/stored.m.in",
    "matlab/limit.m.in",
    "matlab/numbers.m.in",
    "matlab/range.m.in",
    "matlab/settings.m.in",
    "matlab/terms.m.in",
    "matlab/watch_clear.m.in",
    "matlab/watch_forget.m.in",
    "matlab/watchdog.m.in",
    "mujoco/bristles.xml.in",
    "robot/torque.c.in",
    "ros2/parameters.yaml.in",
    "st/adaptation.body.in",
    "st/change.body.in",
    "st/curve.body.in",
    "st/keep.body.in",
    "st/law/bristle.body.in",
    "st/law/decay.body.in",
    "st/law/elastic.body.in",
    "st/law/elements.body.in",
    "st/law/pull.body.in",
    "st/law/steady.body.in",
    "st/limit.body.in",
    "st/look.body.in",
    "st/range.body.in",
    "st/recall.body.in",
    "st/reset.body.in",
    "st/watchdog.body.in",
];

/// Values and flags for a template.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fill {
    values: Vec<(&'static str, String)>,
    flags: Vec<(&'static str, bool)>,
}

impl Fill {
    pub(crate) fn set(&mut self, key: &'static str, value: impl Into<String>) -> &mut Self {
        self.values.push((key, value.into()));
        self
    }

    pub(crate) fn flag(&mut self, key: &'static str, on: bool) -> &mut Self {
        self.flags.push((key, on));
        self
    }

    /// The template filled in.
    ///
    /// # Panics
    /// On a key that was not set, a part that there is not: a fault of the template, never of a model.
    pub(crate) fn render(&self, template: &str) -> String {
        let mut out = String::with_capacity(template.len() * 2);
        self.write(template, &mut out);
        out
    }

    fn write(&self, template: &str, out: &mut String) {
        // Whether the branch is taken, for each condition that is open.
        let mut open: Vec<bool> = Vec::new();
        for line in template.lines() {
            let word = line.trim();
            if let Some(key) = word.strip_prefix("%if ") {
                open.push(self.holds(key));
            } else if word == "%else" {
                let last = open.last_mut().expect("%else without %if");
                *last = !*last;
            } else if word == "%end" {
                open.pop().expect("%end without %if");
            } else if open.iter().all(|taken| *taken) {
                if let Some(path) = word.strip_prefix("%part ") {
                    let space = &line[..line.len() - line.trim_start().len()];
                    out.push_str(&indented(&self.render(part(path)), space));
                } else {
                    self.line(line, out);
                    out.push('\n');
                }
            }
        }
        assert!(open.is_empty(), "%if without %end");
    }

    fn line(&self, line: &str, out: &mut String) {
        let mut rest = line;
        while let Some((before, after)) = rest.split_once('@') {
            let (key, next) = after.split_once('@').expect("a key ends in @");
            out.push_str(before);
            out.push_str(self.value(key));
            rest = next;
        }
        out.push_str(rest);
    }

    pub(crate) fn value(&self, key: &str) -> &str {
        let found = self.values.iter().rev().find(|(name, _)| *name == key);
        found.map_or_else(|| panic!("no value for @{key}@"), |(_, value)| value)
    }

    fn holds(&self, key: &str) -> bool {
        let (name, wanted) = match key.strip_prefix('!') {
            Some(name) => (name, false),
            None => (key, true),
        };
        let found = self.flags.iter().rev().find(|(flag, _)| *flag == name);
        found.unwrap_or_else(|| panic!("no flag {name}")).1 == wanted
    }
}

/// The text behind a space in every line that is not empty.
fn indented(text: &str, space: &str) -> String {
    let lines = text.lines().map(|line| match line {
        "" => "\n".into(),
        line => format!("{space}{line}\n"),
    });
    lines.collect()
}

fn part(path: &str) -> &'static str {
    let found = PARTS.iter().find(|(name, _)| *name == path);
    found.unwrap_or_else(|| panic!("no part {path}")).1
}

#[cfg(test)]
mod tests {
    use super::{Fill, PARTS};

    #[test]
    fn values_and_conditions() {
        let mut fill = Fill::default();
        fill.set("a", "1").flag("yes", true).flag("no", false);
        let text = "x@a@y@a@\n%if yes\nA\n%if no\nB\n%else\nC\n%end\n%end\n%if !yes\nD\n%end\n";
        assert_eq!(fill.render(text), "x1y1\nA\nC\n");
    }

    #[test]
    fn a_part_stands_in_its_place() {
        let mut fill = Fill::default();
        for key in ["own", "real", "MAX", "f", "m"] {
            fill.set(key, "");
        }
        let (path, _) = PARTS
            .iter()
            .find(|(path, _)| *path == "c/numbers.c.in")
            .unwrap();
        let part = fill.render(&format!("%part {path}\n"));
        assert!(part.starts_with("/* The larger"), "{part}");
        fill.flag("yes", true);
        let both = fill.render(&format!("a\n%if yes\n%part {path}\n%end\nb\n"));
        assert_eq!(both, format!("a\n{part}b\n"));
    }
}

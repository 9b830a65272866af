//! Templates. The code of a target is kept as that target's own text in `templates`.
//!
//! `@key@` is replaced by a value. A line `%if key` keeps what follows up to `%else` or `%end` where the flag is set,
//! `%if !key` where it is not; conditions nest.

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
    /// On a key that was not set: a fault of the template, never of a model.
    pub(crate) fn render(&self, template: &str) -> String {
        let mut out = String::with_capacity(template.len() * 2);
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
                self.line(line, &mut out);
                out.push('\n');
            }
        }
        assert!(open.is_empty(), "%if without %end");
        out
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

    fn value(&self, key: &str) -> &str {
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

#[cfg(test)]
mod tests {
    use super::Fill;

    #[test]
    fn values_and_conditions() {
        let mut fill = Fill::default();
        fill.set("a", "1").flag("yes", true).flag("no", false);
        let text = "x@a@y@a@\n%if yes\nA\n%if no\nB\n%else\nC\n%end\n%end\n%if !yes\nD\n%end\n";
        assert_eq!(fill.render(text), "x1y1\nA\nC\n");
    }
}

//! A program unit of Structured Text.

/// A program organisation unit: head with variables, then statements.
pub(super) struct Unit {
    pub(super) name: String,
    pub(super) program: bool,
    pub(super) declaration: String,
    pub(super) body: String,
}

impl Unit {
    pub(super) fn text(&self) -> String {
        let end = if self.program {
            "END_PROGRAM"
        } else {
            "END_FUNCTION_BLOCK"
        };
        format!("{}{}{end}\n", self.declaration, self.body)
    }
}

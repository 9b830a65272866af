//! What must hold on every report.

/// Whether a report has tables, all of which fit the page of a window of 1200 px without scrolling sideways: the report
/// marks those that do not, from the widths of their characters.
///
/// # Panics
/// With the head of the table that is too wide.
pub fn assert_tables_fit(html: &str) {
    assert!(html.contains("<table"), "a report without a table");
    if let Some(at) = html.find("<table class=\"dense scrolling\"") {
        let table: String = html[at..].chars().take(1500).collect();
        panic!("a table is wider than the page: {table}");
    }
}

//! stub
/// stub
pub fn template() {}

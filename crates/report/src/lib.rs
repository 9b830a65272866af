//! Plain data to SVG figures and a self-contained HTML document.

//! Workflows behind every face of the product: axis files, identification, demo, results on disk.

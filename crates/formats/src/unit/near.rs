//! Suggestions for a misspelt word.

/// At most four known words near this one, nearest first: same letters in another case, then few
/// edits.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let lower = word.to_lowercase();
    let short: Vec<char> = lower.chars().take(MAX_CHARS).collect();
    let allowed = 1 + short.len() / 4;
    let mut ranked: Vec<(usize, usize, &str)> = known
        .into_iter()
        .enumerate()
        .filter_map(|(order, name)| {
            let other: Vec<char> = name.to_lowercase().chars().take(MAX_CHARS).collect();
            // Blanks alone are no difference, letters in another order one slip of the fingers.
            let edits = if solid(&short) == solid(&other) {
                0
            } else if sorted(&short) == sorted(&other) {
                1
            } else {
                edits(&short, &other)
            };
            // One letter is one edit away from every other letter, which helps nobody.
            let shares = other.iter().any(|c| short.contains(c));
            (edits <= allowed && shares).then_some((edits, order, name))
        })
        .collect();
    ranked.sort_unstable();
    ranked.dedup_by_key(|(_, _, name)| *name);
    ranked
        .into_iter()
        .take(4)
        .map(|(_, _, name)| name)
        .collect()
}

/// Longest word that is compared, in characters: the work grows with its square.
const MAX_CHARS: usize = 40;

fn solid(letters: &[char]) -> Vec<char> {
    letters
        .iter()
        .copied()
        .filter(|c| !c.is_whitespace())
        .collect()
}

fn sorted(letters: &[char]) -> Vec<char> {
    let mut letters = solid(letters);
    letters.sort_unstable();
    letters
}

/// Levenshtein distance.
fn edits(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

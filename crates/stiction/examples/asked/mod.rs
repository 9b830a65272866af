//! What an example over sets of worlds is asked for: `[set] [seeds] [first seed] [name ...]`.

use stiction_testkit::worlds::{Case, Set, World};

/// The arguments.
pub struct Asked {
    /// The set.
    pub set: Set,
    /// Its logs, in the order of the tables.
    pub cases: Vec<Case>,
    /// Names as they were typed.
    pub names: Vec<String>,
}

impl Asked {
    /// Reads them; `seeds` are run where no number is given. All worlds, axes and motions of a set where none of a kind is
    /// named; `drives` and `filters` name several. Where no set is named it is *tuning*, and the worlds are [`World::ALL`].
    pub fn of_arguments(seeds: u64) -> Self {
        let (mut numbers, mut names) = (Vec::new(), Vec::<String>::new());
        let mut asked = None;
        for argument in std::env::args().skip(1) {
            match (
                argument.parse::<u64>(),
                Set::ALL.into_iter().find(|set| set.name() == argument),
            ) {
                (Ok(n), _) => numbers.push(n),
                (_, named @ Some(_)) => asked = named,
                _ => names.push(argument),
            }
        }
        let first = numbers.get(1).copied().unwrap_or(1);
        let seeds = first..first + numbers.first().copied().unwrap_or(seeds);
        let set = asked.unwrap_or(Set::Tuning);
        let mut cases = set.cases(seeds);
        let worlds = all(&cases, |case| case.world.clone()).len();
        let kinds: [fn(&Case) -> Vec<String>; 3] = [
            |case| {
                let kind = match case.setup.world {
                    World::Driven(_) => "drives",
                    World::Filtered(_) => "filters",
                    _ => "",
                };
                vec![short(&case.world), kind.to_owned()]
            },
            |case| vec![short(case.axis)],
            |case| vec![case.motion.name().to_owned()],
        ];
        for of in kinds {
            let is_named = |case: &Case| of(case).iter().any(|name| names.contains(name));
            if cases.iter().any(is_named) {
                cases.retain(is_named);
            }
        }
        if asked.is_none() && all(&cases, |case| case.world.clone()).len() == worlds {
            let usual = World::ALL.map(World::name);
            cases.retain(|case| usual.contains(&case.world));
        }
        Self { set, cases, names }
    }

    /// Whether a word was typed.
    pub fn has(&self, word: &str) -> bool {
        self.names.iter().any(|name| name == word)
    }
}

/// What a log is of.
pub fn cell(case: &Case) -> String {
    let (world, axis) = (short(&case.world), short(case.axis));
    format!("{world} {axis} {} {}", case.motion.name(), case.seed)
}

/// A name as it is typed.
fn short(name: &str) -> String {
    name.replace(", ", "-").replace(' ', "-").to_lowercase()
}

/// Worlds, axes or motions in the order of the tables.
pub fn all<T: PartialEq>(cases: &[Case], of: impl Fn(&Case) -> T) -> Vec<T> {
    let mut all = Vec::new();
    for case in cases {
        let one = of(case);
        if !all.contains(&one) {
            all.push(one);
        }
    }
    all
}

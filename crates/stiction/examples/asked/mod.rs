//! What an example over worlds, axes, motions and seeds is asked for: `[seeds] [first seed] [name ...]`.

use stiction_testkit::worlds::{Machine, Motion, World};

/// World, axis, motion, seed.
pub type Task = (World, usize, Motion, u64);

/// The arguments.
pub struct Asked {
    /// In the order of the tables.
    pub tasks: Vec<Task>,
    /// Names of the axes.
    pub axes: Vec<String>,
    /// Names as they were typed.
    pub names: Vec<String>,
}

impl Asked {
    /// Reads them; `seeds` are run where no number is given. All of a kind where none is named, of worlds [`World::ALL`];
    /// `drives` names [`World::DRIVES`], `filters` [`World::FILTERS`].
    pub fn of_arguments(seeds: u64) -> Self {
        let (mut numbers, mut names) = (Vec::new(), Vec::<String>::new());
        for argument in std::env::args().skip(1) {
            match argument.parse::<u64>() {
                Ok(n) => numbers.push(n),
                Err(_) => names.push(argument),
            }
        }
        let first = numbers.get(1).copied().unwrap_or(1);
        let seeds = first..first + numbers.first().copied().unwrap_or(seeds);
        let axes: Vec<String> = Machine::all(0).map(|(name, _)| name.to_owned()).to_vec();
        let motions = Motion::ALL.map(|m| m.name().to_owned()).to_vec();
        let all = World::ALL
            .into_iter()
            .chain(World::DRIVES)
            .chain(World::FILTERS)
            .chain(World::OTHERS);
        let of_a_kind = |world: &World| match world {
            World::Driven(_) => "drives",
            World::Filtered(_) => "filters",
            _ => "",
        };
        let is_named = |world: &World| {
            names.contains(&short(*world)) || names.iter().any(|n| n == of_a_kind(world))
        };
        let mut worlds: Vec<World> = all.filter(is_named).collect();
        if worlds.is_empty() {
            worlds = World::ALL.to_vec();
        }
        let wanted = |kind: &[String], name: &str| {
            let of_kind = |n: &&String| kind.contains(n);
            let mut asked = names.iter().filter(of_kind).peekable();
            asked.peek().is_none() || asked.any(|n| n == name)
        };
        let mut tasks = Vec::new();
        for world in worlds {
            for (axis, of) in axes.iter().enumerate() {
                for motion in Motion::ALL {
                    if wanted(&axes, of) && wanted(&motions, motion.name()) {
                        tasks.extend(seeds.clone().map(|seed| (world, axis, motion, seed)));
                    }
                }
            }
        }
        Self { tasks, axes, names }
    }

    /// Whether a word was typed.
    pub fn has(&self, word: &str) -> bool {
        self.names.iter().any(|name| name == word)
    }

    /// What a task is of.
    pub fn cell(&self, (world, axis, motion, seed): &Task) -> String {
        let axis = &self.axes[*axis];
        format!("{} {axis} {} {seed}", short(*world), motion.name())
    }
}

/// The name of a world as it is typed.
pub fn short(world: World) -> String {
    let name = world.name().replace(", ", "-");
    name.replace(' ', "-").to_lowercase()
}

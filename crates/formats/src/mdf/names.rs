//! What columns are called: as their channels, with their group where several channels have one name.

use std::collections::HashMap;

use super::group::{Data, Group};

/// Puts the group before names that more than one channel has.
pub(super) fn tell_apart(all: &mut [Data]) {
    let labels = labels(all);
    let channels = all.iter().flat_map(|data| &data.groups);
    let names = channels
        .flat_map(|group| &group.channels)
        .map(|channel| &channel.name);
    let mut count: HashMap<String, usize> = HashMap::new();
    for name in names.filter(|name| !name.is_empty()) {
        *count.entry(name.clone()).or_default() += 1;
    }
    let groups = all.iter_mut().flat_map(|data| &mut data.groups);
    for (group, label) in groups.zip(labels) {
        let repeated = |name: &str| count.get(name).is_some_and(|count| *count > 1);
        for channel in &mut group.channels {
            if repeated(&channel.name) {
                channel.name = format!("{label}.{}", channel.name);
            }
        }
        group.label = label;
    }
}

/// What each group is called: as it is named, or by its number in the file where it has no name or shares it. Channels that have
/// their time from another group are of that one.
fn labels(all: &[Data]) -> Vec<String> {
    let groups: Vec<&Group> = all.iter().flat_map(|data| &data.groups).collect();
    let places: HashMap<u64, usize> = groups.iter().map(|group| group.at).zip(0..).collect();
    let base = |place: usize| {
        let other = groups[place].base.and_then(|at| places.get(&at).copied());
        other.unwrap_or(place)
    };
    let own: Vec<usize> = (0..groups.len())
        .filter(|&place| base(place) == place)
        .collect();
    let mut count: HashMap<&str, usize> = HashMap::new();
    for name in own
        .iter()
        .filter_map(|&place| groups[place].name.as_deref())
    {
        *count.entry(name).or_default() += 1;
    }
    let label = |place: usize| {
        let place = base(place);
        match groups[place].name.as_deref() {
            Some(name) if count.get(name).is_none_or(|count| *count == 1) => name.to_owned(),
            _ => format!("group{}", place + 1),
        }
    };
    (0..groups.len()).map(label).collect()
}

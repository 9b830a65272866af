//! What a column's name says: the words in it, and the role they point to.

use super::channel::{Motion, Role};

/// What a name says about its column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Hint {
    pub role: Role,
    /// A command or set point rather than a measurement.
    pub commanded: bool,
    /// The name says that it is measured.
    pub measured: bool,
    /// Only a letter or two: any longer word takes precedence.
    pub weak: bool,
}

const TIME: &str = "time timestamp timestamps stamp zeit";
const POSITION: &str =
    "position positions pos angle theta displacement disp travel encoder enc qm qg lage winkel";
const VELOCITY: &str =
    "velocity velocities vel velo speed omega dq qd qdot xdot dx dtheta geschwindigkeit drehzahl";
const ACCELERATION: &str = "acceleration accel acc ddq qddot xddot beschleunigung";
/// `effort` is the torque or force of a joint in ROS.
const FORCE: &str = "force forces torque torques trq tau effort efforts moment current cur curr friction f iq kraft \
    drehmoment strom";
const TEMPERATURE: &str = "temperature temp temperatur";
const WEAK: &[(&str, Role)] = &[
    ("t", Role::Time),
    ("ts", Role::Time),
    ("x", Role::Position),
    ("q", Role::Position),
    ("phi", Role::Position),
    ("v", Role::Velocity),
    ("w", Role::Velocity),
    ("i", Role::Force),
];
const COMMANDED: &str = "ref reference set setpoint target desired des cmd command commanded demand goal nominal qg soll \
    action";
const MEASURED: &str = "act actual meas measured measurement feedback fb fbk qm ist";
const PASSED_OVER: &str = "error err lag following deviation dev limit max min std status state enable enabled flag id index \
    jerk gain offset warning schlepp fehler abweichung";
/// Those of them that say nothing of what a group holds: `joint_state.position` is a position.
const GROUPS: &str = "state status id index";
/// Words that may be beside a letter or two without changing its meaning.
const HARMLESS_NEIGHBOURS: &str = "axis motor joint j drive m achse wert";
/// Groups whose letters are directions or parts of something else: `orientation.x` is no position.
const VECTORS: &str =
    "orientation quaternion rotation linear angular gyro magnetic mag imu translation point";
/// What German names are put together of: `Istposition`, `Lagesollwert`, `Schleppfehler`.
const GERMAN: &str = "soll ist wert position pos lage winkel geschwindigkeit drehzahl beschleunigung kraft drehmoment \
    moment strom zeit temperatur schlepp fehler abstand abweichung regel motor achs achse";

/// Whether a list of words, separated by blanks, has this one.
fn among(word: &str, list: &str) -> bool {
    list.split(' ').any(|own| own == word)
}

/// Whether a list has any of these words.
fn any_of(words: &[String], list: &str) -> bool {
    words.iter().any(|word| among(word, list))
}

/// Whether a name says that its values are asked for and not measured.
pub fn is_commanded(name: &str) -> bool {
    let words = words(name);
    any_of(&words, COMMANDED) && !any_of(&words, MEASURED)
}

/// What a name says; `None` where it says nothing, or names something that is passed over.
pub(super) fn hint(name: &str) -> Option<Hint> {
    let words = words(name);
    let has = |list| any_of(&words, list);
    if passed_over(name) {
        return None;
    }
    let commanded = has(COMMANDED);
    let measured = has(MEASURED);
    let is_load = words.iter().any(|w| w == "normal") || words == ["load"];
    let own = own_words(name);
    let stands = |word: &str| {
        let stands = |words: &[String]| words.iter().any(|w| w == word) && alone(words, word);
        stands(&words) || stands(&own)
    };
    let strong = |word: &String| {
        let among = |list| among(word, list);
        // `f`, `dq` and their like mean something only where they stand alone: `fActPos` does not.
        let short_among_words = word.len() <= 2 && !stands(word);
        if short_among_words {
            None
        } else if among(TIME) {
            Some(Role::Time)
        } else if among(POSITION) {
            Some(Role::Position)
        } else if among(VELOCITY) {
            Some(Role::Velocity)
        } else if among(ACCELERATION) {
            Some(Role::Acceleration)
        } else if among(FORCE) {
            Some(Role::Force)
        } else if among(TEMPERATURE) {
            Some(Role::Temperature)
        } else {
            None
        }
    };
    let weak = || {
        let (_, role) = WEAK.iter().find(|(word, _)| stands(word))?;
        Some(*role)
    };
    // The last word is the noun: `encoder_velocity` is a velocity. Except `time of ...`, as the
    // stamps of a scope with several sample times are called.
    let named = if is_load {
        Some(Role::Load)
    } else if words.starts_with(&["time".to_string(), "of".to_string()]) {
        Some(Role::Time)
    } else {
        words.iter().rev().find_map(strong)
    };
    let (role, is_weak) = match named {
        Some(role) => (role, false),
        // A command by itself is the position that is asked for, unless it says what else it is.
        None => match weak() {
            Some(role) => (role, true),
            None if commanded && words.len() == 1 => (Role::Position, true),
            None => return None,
        },
    };
    let role = if role == Role::Position && commanded {
        Role::Reference
    } else {
        role
    };
    Some(Hint {
        role,
        commanded,
        measured,
        weak: is_weak,
    })
}

/// The words of a name without its group, in which a letter or two may stand alone: `run.t`, `run.iq_actual`. All of them where the
/// group is one of directions.
fn own_words(name: &str) -> Vec<String> {
    let (group, own) = name.rsplit_once('.').unwrap_or(("", name));
    let is_vector = any_of(&words(group), VECTORS);
    words(if is_vector { name } else { own })
}

/// Letters that a machine's axes are called by where they stand alone.
const AXIS_LETTERS: &str = "x y z";
/// Letters before that of the axis in a name of two: `IX` is the current of X, `FY` the force of Y.
const BEFORE_AXIS: &[char] = &['i', 'f', 'v', 'm', 'p', 's'];

/// The letter of the axis that a name speaks of: `x` in `X act` and in `IX`.
pub(super) fn axis_letter(name: &str) -> Option<char> {
    words(name).iter().find_map(|word| {
        let mut letters = word.chars();
        let letter = match (letters.next()?, letters.next(), letters.next()) {
            (letter, None, _) => letter,
            (before, Some(letter), None) if BEFORE_AXIS.contains(&before) => letter,
            _ => return None,
        };
        among(&letter.to_string(), AXIS_LETTERS).then_some(letter)
    })
}

/// What a name says that is nothing but the letter of an axis (`Y act`), in a table that has several axes: what
/// `X act` says.
pub(super) fn hint_of_axis(name: &str) -> Option<Hint> {
    let words = words(name);
    let has = |list| any_of(&words, list);
    let letter = words.iter().find(|w| among(w, AXIS_LETTERS))?;
    if passed_over(name) || !alone(&words, letter) {
        return None;
    }
    let commanded = has(COMMANDED);
    Some(Hint {
        role: if commanded {
            Role::Reference
        } else {
            Role::Position
        },
        commanded,
        measured: has(MEASURED),
        weak: true,
    })
}

/// Whether a name speaks of errors, limits, states and other things that no role takes.
pub(super) fn passed_over(name: &str) -> bool {
    let (group, own) = name.rsplit_once('.').unwrap_or(("", name));
    let over = |word: &String| among(word, PASSED_OVER);
    words(own).iter().any(over) || (words(group).iter()).any(|w| over(w) && !among(w, GROUPS))
}

/// Whether nothing but numbers and harmless words stands beside this word.
fn alone(words: &[String], word: &str) -> bool {
    words.iter().filter(|w| *w != word).all(|w| {
        let harmless = [COMMANDED, MEASURED, HARMLESS_NEIGHBOURS]
            .iter()
            .any(|list| among(w, list));
        harmless || w.chars().all(|c| c.is_ascii_digit())
    })
}

/// The group that a name is in: `elbow` of `elbow.position`.
pub(super) fn group(name: &str) -> Option<&str> {
    name.rsplit_once('.').map(|(group, _)| group)
}

/// Whether a name speaks of a mode or a state of the drive.
pub(super) fn says_mode(name: &str) -> bool {
    let own = name.rsplit_once('.').map_or(name, |(_, own)| own);
    any_of(&words(own), "mode state status")
}

/// Whether a name speaks of an axis that is enabled, or a drive that is switched on.
pub(super) fn says_enabled(name: &str) -> bool {
    let own = name.rsplit_once('.').map_or(name, |(_, own)| own);
    let words = words(own);
    let has = |list| any_of(&words, list);
    let says =
        has("enable enabled powered freigabe") || has("on") && has("servo drive motor axis power");
    says && !has("not no un off keine")
}

/// What is so while a column is 1 by its name, and is no motion to fit: a brake that holds, a search for the origin, a fault.
pub(super) fn says_disturbed(name: &str) -> Option<&'static str> {
    let words = words(name);
    let has = |list| any_of(&words, list);
    if says_braked(name) {
        Some("a brake holds the axis")
    } else if has("homing referencing referenzfahrt") {
        Some("the axis looks for its origin")
    } else if has("fault error alarm estop fehler störung") {
        Some("the drive has a fault")
    } else {
        None
    }
}

/// Whether a name speaks of a brake that holds, and not of one that is released.
fn says_braked(name: &str) -> bool {
    const RELEASED: &str = "open opened release released off free offen frei gelöst gelüftet";
    let words = words(name);
    let has = |list| any_of(&words, list);
    has("brake braked bremse") && !has(RELEASED)
}

/// Whether a name is that of a status word of CiA 402.
pub(super) fn says_status_word(name: &str) -> bool {
    let own = name.rsplit_once('.').map_or(name, |(_, own)| own);
    let letters = own.chars().filter(|c| c.is_alphanumeric());
    let plain: String = letters.flat_map(char::to_lowercase).collect();
    plain.contains("statusword") || plain.contains("statuswort") || plain.contains("6041")
}

/// Whether a name speaks of current.
pub(super) fn says_current(name: &str) -> bool {
    any_of(&words(name), "current cur curr i iq strom")
}

/// Words for encoder counts.
const COUNTS: &str = "cnt cnts counts inc incs increments inkremente ticks";

/// Whether a name speaks of encoder counts and of nothing else.
pub(super) fn says_counts(name: &str) -> bool {
    let words = words(name);
    let mut all = words.iter();
    all.any(|w| among(w, COUNTS) && alone(&words, w))
}

/// Whether a name speaks of encoder counts, whatever else it says.
pub(super) fn speaks_of_counts(name: &str) -> bool {
    any_of(&words(name), COUNTS)
}

/// Whether a name has the number or the name of the actual position of CiA 402 (object 6064h, "Position actual value"), in counts
/// unless a drive scales it.
pub(super) fn says_position_object(name: &str) -> bool {
    name.contains("6064") || is_actual_value(name, "position")
}

/// Whether a name has the number or the name of the actual torque of CiA 402 (object 6077h, "Torque actual value"), in thousandths
/// of the rated one.
pub(super) fn says_torque_object(name: &str) -> bool {
    name.contains("6077") || is_actual_value(name, "torque")
}

/// Whether a name ends as those of objects of CiA 402 do: the quantity, then "actual value".
fn is_actual_value(name: &str, quantity: &str) -> bool {
    words(name).ends_with(&[quantity, "actual", "value"].map(String::from))
}

/// Whether a name speaks of an encoder.
pub(super) fn says_encoder(name: &str) -> bool {
    any_of(&words(name), "enc encoder")
}

/// Which kind of motion a name speaks of.
pub(super) fn motion(name: &str) -> Option<Motion> {
    let words = words(name);
    let has = |list| any_of(&words, list);
    if has("angle theta dtheta omega torque trq tau moment joint winkel drehmoment") {
        Some(Motion::Rotary)
    } else if has("force displacement disp f xdot dx kraft") || words == ["x"] {
        Some(Motion::Linear)
    } else {
        None
    }
}

/// The words of a name in lower case: split at signs, humps (`ActPos`) and digits (`q1`).
fn words(name: &str) -> Vec<String> {
    #[derive(PartialEq, Clone, Copy)]
    enum Sort {
        Upper,
        Lower,
        Digit,
        Sign,
    }
    let sort = |c: char| match c {
        _ if c.is_uppercase() => Sort::Upper,
        _ if c.is_alphabetic() => Sort::Lower,
        _ if c.is_ascii_digit() => Sort::Digit,
        _ => Sort::Sign,
    };
    let mut words: Vec<String> = Vec::new();
    let mut before = Sort::Sign;
    for c in name.chars().take(200) {
        let now = sort(c);
        let joins = before == now || (before == Sort::Upper && now == Sort::Lower);
        if now != Sort::Sign {
            if joins && !words.is_empty() {
                words
                    .last_mut()
                    .expect("just checked")
                    .extend(c.to_lowercase());
            } else {
                words.push(c.to_lowercase().collect());
            }
        }
        before = now;
    }
    // The current that makes the torque is written `i_q` and `iQ` too.
    if let Some(at) = words.windows(2).position(|w| w[0] == "i" && w[1] == "q") {
        words.splice(at..at + 2, ["iq".to_string()]);
    }
    words.into_iter().flat_map(taken_apart).collect()
}

/// The words that a German name is put together of; the word itself where it is none.
fn taken_apart(word: String) -> Vec<String> {
    fn parts(rest: &str) -> Option<Vec<&'static str>> {
        if rest.is_empty() {
            return Some(Vec::new());
        }
        // The longest that leaves something which can be taken apart too.
        let mut first: Vec<&str> = GERMAN.split(' ').filter(|p| rest.starts_with(p)).collect();
        first.sort_by_key(|part| std::cmp::Reverse(part.len()));
        first.into_iter().find_map(|part| {
            let mut all = vec![part];
            all.extend(parts(&rest[part.len()..])?);
            Some(all)
        })
    }
    match word.len() <= LONGEST_GERMAN {
        true => {
            parts(&word).map_or_else(|| vec![word], |p| p.into_iter().map(String::from).collect())
        }
        false => vec![word],
    }
}

/// Longer words are not taken apart, bytes.
const LONGEST_GERMAN: usize = 40;

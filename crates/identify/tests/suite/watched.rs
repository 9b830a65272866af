//! How much work is done between two looks at the observer: what Ctrl-C waits for.

use crate::common::closed_loop::{samples, three_segments};
use stiction_identify::{
    Conditioning, Control, Delay, Law, LawKind, Observer, Progress, Settings, Silent, Terms,
    condition, cross_validate, estimate, intervals, separable, tune,
};

/// The most evaluations of the full record between two looks.
#[derive(Default)]
struct Gaps {
    last: usize,
    most: usize,
    looks: usize,
}

impl Observer for Gaps {
    fn progress(&mut self, progress: &Progress) -> Control {
        let now = progress.counts.full_records(0.0) as usize;
        // Each piece of work counts from zero.
        let gap = if now < self.last {
            now
        } else {
            now - self.last
        };
        self.most = self.most.max(gap);
        self.last = now;
        self.looks += 1;
        Control::Continue
    }
}

#[test]
fn the_observer_is_asked_after_a_handful_of_evaluations() {
    let log = three_segments("machine", 1e-6, 0.5, 0);
    let samples = [samples(&log)];
    let law = Law::new(LawKind::LuGre);
    let terms = Terms {
        delay: Delay::Fitted,
        ..Terms::default()
    };
    let wanted = Conditioning {
        resolution: Some(1e-6),
        ..Conditioning::default()
    };
    let settings = Settings::default();
    let mut gaps = Gaps::default();
    let tuned = tune(&samples, &wanted, law, &terms, &settings, &mut gaps).unwrap();
    let record = condition(&samples, &tuned.conditioning).unwrap();
    // The law with a curve of its own in each direction is known poorly, so profiles are followed too.
    for law in [law, law.asymmetric()] {
        let found = separable(&record, law, &terms, &settings, &mut gaps).unwrap();
        let mut fitted = estimate(&record, law, &terms, &found, 1e-3);
        intervals(&record, &found, &mut fitted, &mut gaps);
        cross_validate(&record, &fitted, &found, 4, &mut gaps);
    }
    println!("{} looks, at most {} evaluations", gaps.looks, gaps.most);
    assert!(gaps.looks > 100);
    assert!(gaps.most <= 6, "{}", gaps.most);
}

/// Whatever it is asked, it stops.
struct Impatient(usize);

impl Observer for Impatient {
    fn progress(&mut self, _: &Progress) -> Control {
        self.0 += 1;
        if self.0 > 5 {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}

#[test]
fn intervals_are_left_when_the_observer_says_so() {
    let log = three_segments("machine", 1e-6, 0.5, 0);
    let samples = [samples(&log)];
    let law = Law::new(LawKind::LuGre);
    let terms = Terms::default();
    let record = condition(&samples, &Conditioning::default()).unwrap();
    let settings = Settings::default();
    let found = separable(&record, law, &terms, &settings, &mut Silent).unwrap();
    let mut fitted = estimate(&record, law, &terms, &found, 1e-3);
    let before = fitted.counts.total();
    let mut impatient = Impatient(0);
    intervals(&record, &found, &mut fitted, &mut impatient);
    assert!(fitted.counts.total() - before <= 12);
}

//! A search that is told to stop.

use super::*;

/// Stops after so many looks.
pub struct Short(pub usize);

impl Observer for Short {
    fn progress(&mut self, _: &Progress) -> Control {
        self.0 = self.0.saturating_sub(1);
        if self.0 == 0 {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}

#[test]
fn a_search_that_is_stopped_keeps_what_it_has() {
    let log = open(1.0, 0.0, 0.0, 0.0, 1);
    let found = output_error(
        &[log],
        Law::new(LawKind::LuGre),
        &Terms::default(),
        &Simulation::default(),
        &mut Short(1),
    )
    .unwrap();
    assert_eq!(found.fitted.status, Status::Interrupted);
    assert!(found.fitted.counts.total() < 20);
}

/// The observer is asked within a simulation too, every twentieth of a second or so: of a long log a single one takes longer.
#[test]
fn a_long_simulation_can_be_stopped() {
    struct Looks(usize);
    impl Observer for Looks {
        fn progress(&mut self, _: &Progress) -> Control {
            self.0 += 1;
            assert!(self.0 < 40, "a stop is heeded");
            match self.0 < 8 {
                true => Control::Continue,
                false => Control::Stop,
            }
        }
    }
    // 120 s of the same two seconds again and again: six looks a simulation, and the one after it.
    let short = open(2.0, 0.0, 0.0, 0.0, 1);
    let mut log = short.clone();
    let n = 120_000;
    let again = |x: &[f64]| x.iter().copied().cycle().take(n).collect::<Vec<_>>();
    log.samples.time = (0..n).map(|k| k as f64 * 1e-3).collect();
    log.samples.force = again(&short.samples.force);
    log.samples.position = short.samples.position.as_deref().map(again);
    let mut looks = Looks(0);
    let law = Law::new(LawKind::CoulombViscous);
    let found = output_error(
        &[log],
        law,
        &Terms::default(),
        &Simulation::default(),
        &mut looks,
    )
    .unwrap();
    assert_eq!(found.fitted.status, Status::Interrupted);
    assert!(
        found.fitted.counts.total() < 10,
        "{:?}",
        found.fitted.counts
    );
    // Nothing more is asked of the observer than a few times to end what was begun.
    assert!(looks.0 < 20, "{}", looks.0);
}

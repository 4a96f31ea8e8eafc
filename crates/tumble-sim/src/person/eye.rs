//! What a person makes of the LED: steady, or so many short blinks.

/// An LED that is lit for longer is steady: the waiting rhythm lights it for 0.5 s.
const STEADY_S: f64 = 0.8;
/// A shorter flash is a blink that is counted.
const BLINK_S: f64 = 0.4;
/// After so long a pause the count is complete.
const PAUSE_S: f64 = 0.8;

/// What the LED has just said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sight {
    /// It stays lit: do not touch.
    Steady,
    /// So many short blinks.
    Blinks(u32),
}

/// Watches the LED.
#[derive(Debug, Clone, Default)]
pub(super) struct Eye {
    lit: bool,
    since_s: f64,
    blinks: u32,
    told: bool,
}

impl Eye {
    /// The LED is lit or dark at `now_s`.
    pub(super) fn see(&mut self, now_s: f64, lit: bool) {
        if lit == self.lit {
            return;
        }
        if self.lit && now_s - self.since_s < BLINK_S {
            self.blinks += 1;
        } else if self.lit {
            self.blinks = 0;
        }
        (self.lit, self.since_s, self.told) = (lit, now_s, false);
    }

    /// Whether it stays lit.
    pub(super) fn is_steady(&self, now_s: f64) -> bool {
        self.lit && now_s - self.since_s > STEADY_S
    }

    /// What is new.
    pub(super) fn news(&mut self, now_s: f64) -> Option<Sight> {
        if self.is_steady(now_s) && !self.told {
            self.told = true;
            return Some(Sight::Steady);
        }
        if !self.lit && self.blinks > 0 && now_s - self.since_s > PAUSE_S {
            return Some(Sight::Blinks(core::mem::take(&mut self.blinks)));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shows the eye a pattern of (duration, lit) and returns what it made of it, looking every 10 ms.
    fn watch(pattern: &[(f64, bool)]) -> Vec<Sight> {
        let (mut eye, mut now_s, mut seen) = (Eye::default(), 0.0, Vec::new());
        for &(duration_s, lit) in pattern {
            for _ in 0..(duration_s * 100.0) as usize {
                eye.see(now_s, lit);
                seen.extend(eye.news(now_s));
                now_s += 0.01;
            }
        }
        seen
    }

    #[test]
    fn patterns_are_told_apart() {
        let waiting = [(0.5, true), (0.5, false)].repeat(5);
        assert!(watch(&waiting).is_empty());
        assert_eq!(watch(&[(3.0, true), (1.0, false)]), [Sight::Steady]);
        let four: Vec<_> = [(0.15, true), (0.2, false)].repeat(4).into_iter().chain([(2.0, false)]).collect();
        assert_eq!(watch(&four), [Sight::Blinks(4)]);
    }
}

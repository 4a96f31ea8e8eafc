//! The LED's language: what it says is told by when it is lit, and nothing else.

/// Dark time before counted blinks, ms: from solid light to the first blink the eye needs a gap of its own.
const LEAD_MS: u64 = 400;
/// Half a counted blink, ms. Five halves a second are quick enough not to be taken for the 0.5 s of waiting, and slow
/// enough to be counted up to 7.
const BLINK_MS: u64 = 200;
/// An error's blinks come again after this, ms.
const ERROR_PERIOD_MS: u64 = 5000;
/// More blinks than this do not fit [`ERROR_PERIOD_MS`] with two dark seconds to tell one count from the next.
const MOST_BLINKS: u64 = 7;

/// What the LED says, from the moment it begins to say it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Nothing.
    #[default]
    Off,
    /// It waits for you: 0.5 s on, 0.5 s off.
    Waiting,
    /// It samples, do not touch: on.
    Sampling,
    /// It computes or writes: a flash of 50 ms every second.
    Busy,
    /// Accepted: two blinks, then [`Self::Waiting`].
    Accepted,
    /// Done: four blinks, then dark.
    Done,
    /// Error N: N blinks (at most 7) every 5 s.
    Error(u8),
}

impl Pattern {
    /// Is it lit `t_ms` milliseconds after the pattern began?
    pub fn lit(&self, t_ms: u64) -> bool {
        match self {
            Self::Off => false,
            Self::Waiting => t_ms % 1000 < 500,
            Self::Sampling => true,
            Self::Busy => t_ms % 1000 < 50,
            Self::Accepted if t_ms >= Self::length_ms(2) => Self::Waiting.lit(t_ms - Self::length_ms(2)),
            Self::Accepted => blinks(t_ms, 2),
            Self::Done => blinks(t_ms, 4),
            Self::Error(n) => blinks(t_ms % ERROR_PERIOD_MS, u64::from(*n).min(MOST_BLINKS)),
        }
    }

    /// How long `count` counted blinks take with the dark before and behind them, ms.
    const fn length_ms(count: u64) -> u64 {
        LEAD_MS + 2 * BLINK_MS * count + LEAD_MS
    }
}

fn blinks(t_ms: u64, count: u64) -> bool {
    t_ms.checked_sub(LEAD_MS).is_some_and(|t| t / BLINK_MS < 2 * count && (t / BLINK_MS).is_multiple_of(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rises(pattern: Pattern, from_ms: u64, to_ms: u64) -> usize {
        (from_ms..to_ms).filter(|&t| pattern.lit(t) && (t == 0 || !pattern.lit(t - 1))).count()
    }

    #[test]
    fn counts_are_what_the_language_says() {
        assert_eq!(rises(Pattern::Accepted, 0, Pattern::length_ms(2)), 2);
        assert_eq!(rises(Pattern::Done, 0, 100_000), 4);
        for n in 1..=7 {
            assert_eq!(rises(Pattern::Error(n), 0, 5000), usize::from(n));
            assert_eq!(rises(Pattern::Error(n), 5000, 10_000), usize::from(n));
        }
        assert_eq!(rises(Pattern::Error(200), 0, 5000), 7);
        assert_eq!(rises(Pattern::Off, 0, 5000), 0);
    }

    #[test]
    fn waiting_sampling_and_busy() {
        let on = |pattern: Pattern| (0..10_000).filter(|&t| pattern.lit(t)).count();
        assert_eq!((on(Pattern::Waiting), on(Pattern::Sampling), on(Pattern::Busy)), (5000, 10_000, 500));
        let after = Pattern::length_ms(2);
        assert!((0..5000).all(|t| Pattern::Accepted.lit(after + t) == Pattern::Waiting.lit(t)));
        let _ = [Pattern::Done, Pattern::Error(0), Pattern::Waiting].map(|p| p.lit(u64::MAX));
    }

    #[test]
    fn a_count_ends_two_seconds_before_it_comes_again() {
        assert!((3200..5000).all(|t| !Pattern::Error(7).lit(t)));
    }
}

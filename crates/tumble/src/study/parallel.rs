//! Independent jobs on a few threads, in an order that does not show in the results.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// `work(0)`, `work(1)` … `work(count - 1)` in this order, computed on `threads` threads; `done` hears how many are.
pub fn map<T: Send>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
    done: &mut (impl FnMut(usize) + Send),
) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new((Vec::with_capacity(count), done));
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, count.max(1)) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        return;
                    }
                    let result = work(index);
                    // A poisoned lock means that another job panicked, which the scope passes on.
                    let Ok(mut shared) = results.lock() else { return };
                    shared.0.push((index, result));
                    let finished = shared.0.len();
                    (shared.1)(finished);
                }
            });
        }
    });
    let (mut results, _) = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::map;

    #[test]
    fn results_stand_in_order_and_all_are_counted() {
        let mut seen = 0;
        let squares = map(37, 3, |i| i * i, &mut |done| seen = seen.max(done));
        assert_eq!(squares, (0..37).map(|i| i * i).collect::<Vec<_>>());
        assert_eq!(seen, 37);
        assert!(map(0, 4, |i| i, &mut |_| {}).is_empty());
    }
}

//! The middle of some numbers.

/// The middle of `values`, the upper one of two; none of none. Sorts by insertion: there are some dozens, and the library's
/// sort takes 5 KB of flash for each type.
pub fn median(values: &mut [f32]) -> Option<f32> {
    for end in 1..values.len() {
        let mut at = end;
        while at > 0 && values[at - 1] > values[at] {
            values.swap(at - 1, at);
            at -= 1;
        }
    }
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn the_middle_of_none_of_odd_and_of_even() {
        assert_eq!(median(&mut []), None);
        assert_eq!(median(&mut [3.0, -1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), Some(3.0));
    }
}

//! Which id a person may have meant.

/// Of `ids` those most like `id`: those that contain it or share most of its pairs of letters, at most four.
pub(super) fn near(id: &str, ids: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    let mut found: Vec<(f64, &'static str)> =
        ids.map(|other| (likeness(id, other), other)).filter(|(score, _)| *score >= 0.45).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(4).map(|(_, id)| id).collect()
}

/// Sørensen–Dice over pairs of neighbouring letters, 0 to 1; 0.9 if one contains the other.
fn likeness(a: &str, b: &str) -> f64 {
    let (a, b) = (a.to_ascii_lowercase(), b.to_ascii_lowercase());
    if a.len() >= 3 && (b.contains(&a) || a.contains(&b)) {
        return 0.9;
    }
    let pairs = |text: &str| text.as_bytes().windows(2).map(<[u8]>::to_vec).collect::<Vec<_>>();
    let (of_a, mut of_b) = (pairs(&a), pairs(&b));
    let whole = of_a.len() + of_b.len();
    let mut shared = 0;
    for pair in &of_a {
        if let Some(at) = of_b.iter().position(|other| other == pair) {
            of_b.swap_remove(at);
            shared += 1;
        }
    }
    if whole == 0 { 0.0 } else { 2.0 * f64::from(shared) / whole as f64 }
}

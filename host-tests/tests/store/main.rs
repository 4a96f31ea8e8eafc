//! The firmware's parameter store on a flash that loses power at every single operation: what is read afterwards is
//! the old record or the new one, whole, and the store goes on working.

mod flash_double;
#[path = "../../../src/store/mod.rs"]
mod store;

use embassy_futures::block_on;
use flash_double::{ALL_TORN, FlashDouble};
use store::{Failure, Store};

/// Six to a sector of the double.
const LENGTH: usize = 330;
/// Enough saves for each sector to be filled and erased twice.
const SAVES: u8 = 28;

fn open(flash: FlashDouble) -> Store<FlashDouble> {
    Store::new(flash)
}

fn record(number: u8) -> Vec<u8> {
    (0..LENGTH).map(|i| number.wrapping_mul(37).wrapping_add((i * i % 251) as u8)).collect()
}

fn load(store: &mut Store<FlashDouble>) -> Result<Option<Vec<u8>>, Failure> {
    block_on(store.load()).map(|found| found.map(<[u8]>::to_vec))
}

/// After the power is back: the record is `old` or `new`, and the next save works.
fn check_after_cut(flash: FlashDouble, old: Option<&[u8]>, new: Option<&[u8]>, what: &str) {
    let torn_erase = flash.erases > 0;
    let mut store = open(flash.power_on());
    let found = load(&mut store).unwrap_or_else(|failure| panic!("{what}: {failure:?}"));
    let show = |r: Option<&[u8]>| r.map(|r| r.iter().take(6).copied().collect::<Vec<_>>());
    assert!(
        found.as_deref() == old || found.as_deref() == new,
        "{what}: neither the old nor the new record, but {:?}; old {:?} new {:?}",
        show(found.as_deref()),
        show(old),
        show(new)
    );
    // A torn erase may show only when its sector is used again: then every save until both have been erased once more.
    let saves = if torn_erase { 20 } else { 1 };
    for next in (0..saves).map(|number| record(number + 200)) {
        block_on(store.save(&next)).unwrap_or_else(|failure| panic!("{what}: the next save: {failure:?}"));
        assert_eq!(load(&mut store), Ok(Some(next)), "{what}");
    }
}

/// Runs `act` once whole, to count its operations, then once for every operation and every way to tear it.
fn sweep(before: &FlashDouble, old: Option<&[u8]>, new: Option<&[u8]>, act: impl Fn(&mut Store<FlashDouble>)) -> usize {
    let mut whole = open(before.clone().power_on());
    act(&mut whole);
    let operations = whole.release().operations;
    for at in 0..operations {
        for torn in ALL_TORN {
            let mut flash = before.clone().power_on();
            flash.cut = Some((at, torn));
            let mut store = open(flash);
            act(&mut store);
            check_after_cut(store.release(), old, new, &format!("cut at {at} of {operations}, {torn:?}"));
        }
    }
    operations * ALL_TORN.len()
}

#[test]
fn a_new_flash_holds_nothing_and_is_not_written_to() {
    let mut store = open(FlashDouble::new());
    assert_eq!(load(&mut store), Ok(None));
    assert_eq!(store.release().operations, 0);
}

#[test]
fn what_is_saved_is_found_after_a_power_cycle_and_after_the_sectors_wrap() {
    let mut flash = FlashDouble::new();
    let mut erases = 0;
    for number in 0..SAVES {
        let mut store = open(flash.power_on());
        block_on(store.save(&record(number))).expect("saves");
        flash = store.release();
        erases += flash.erases;
        let mut store = open(flash.power_on());
        assert_eq!(load(&mut store), Ok(Some(record(number))));
        flash = store.release();
    }
    assert!(erases >= 3, "the sectors wrapped: {erases}");
    assert!(erases <= 6, "an erase only when a sector is full: {erases}");
}

#[test]
fn every_power_cut_while_saving_leaves_the_old_or_the_new_record() {
    let mut flash = FlashDouble::new();
    let mut old: Option<Vec<u8>> = None;
    let mut cuts = 0;
    for number in 0..SAVES {
        let new = record(number);
        cuts += sweep(&flash, old.as_deref(), Some(&new), |store| {
            let _ = block_on(store.save(&new));
        });
        let mut store = open(flash.power_on());
        block_on(store.save(&new)).expect("saves");
        flash = store.release();
        old = Some(new);
    }
    println!("{cuts} power cuts, nothing lost");
    assert!(cuts > 5_000);
}

#[test]
fn every_power_cut_while_forgetting_leaves_the_record_or_none() {
    let mut flash = FlashDouble::new();
    for number in 0..9 {
        let old = record(number);
        let mut store = open(flash.power_on());
        block_on(store.save(&old)).expect("saves");
        flash = store.release();
        sweep(&flash, Some(&old), None, |store| {
            let _ = block_on(store.forget());
        });
    }
}

/// The power may go again while what the first cut left is being put right.
#[test]
fn a_second_cut_during_the_repair_loses_nothing_either() {
    let mut flash = FlashDouble::new();
    let mut number = 0;
    // Up to the save that erases a sector.
    let (old, new) = loop {
        let mut store = open(flash.clone().power_on());
        block_on(store.save(&record(number))).expect("saves");
        let after = store.release();
        if after.erases > 0 && number > 7 {
            break (record(number - 1), record(number));
        }
        (flash, number) = (after, number + 1);
    };
    let mut seconds = 0;
    let mut whole = open(flash.clone().power_on());
    block_on(whole.save(&new)).expect("saves");
    for at in 0..whole.release().operations {
        for torn in ALL_TORN {
            let mut first = flash.clone().power_on();
            first.cut = Some((at, torn));
            let mut store = open(first);
            let _ = block_on(store.save(&new));
            seconds += sweep(&store.release(), Some(&old), Some(&new), |store| {
                let _ = block_on(store.load());
            });
        }
    }
    println!("{seconds} second cuts, nothing lost");
}

#[test]
fn what_is_foreign_is_told_and_left_alone_until_a_person_asks() {
    let foreign = FlashDouble::filled_with(|i| (i * 7 % 256) as u8);
    let before = foreign.bytes().to_vec();
    let mut store = open(foreign);
    let loaded = load(&mut store);
    assert!(matches!(loaded, Err(Failure::Foreign) | Ok(None)), "{loaded:?}");
    let flash = store.release();
    assert_eq!(flash.bytes(), before, "loading changes nothing foreign");
    let mut store = open(flash);
    assert_eq!(block_on(store.forget()), Ok(()));
    assert_eq!(load(&mut store), Ok(None));
    assert_eq!(block_on(store.save(&record(1))), Ok(()));
    assert_eq!(load(&mut store), Ok(Some(record(1))));
}

#[test]
fn a_flash_that_fails_is_told_and_the_old_record_stays() {
    let mut store = open(FlashDouble::new());
    block_on(store.save(&record(1))).expect("saves");
    let mut flash = store.release();
    flash.worn_from = Some(flash.operations + 20);
    let mut store = open(flash);
    assert_eq!(block_on(store.save(&record(2))), Err(Failure::Flash));
    let mut flash = store.release();
    flash.worn_from = None;
    let mut store = open(flash.power_on());
    assert_eq!(load(&mut store), Ok(Some(record(1))));
}

#[test]
fn a_record_that_is_too_large_is_refused() {
    let mut store = open(FlashDouble::new());
    assert_eq!(block_on(store.save(&vec![0; store::RECORD + 1])), Err(Failure::TooLarge));
    assert_eq!(load(&mut store), Ok(None));
}
